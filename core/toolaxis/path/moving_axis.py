"""Passes on which the axis moves: the axis at each place of a face is a field, and what cuts by it takes it from there.

The axis is that of the contact, so it does not depend on the sense in which a pass is cut: on a zigzag every other
pass is dragged.
"""

import dataclasses
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.frame import Frame, axis_from_lead_tilt, contact_frame, frame_from_normal
from toolaxis.contact.placement import tips
from toolaxis.contact.strip.cutter_parameters import CAP, CutterParameters, cutter_parameters
from toolaxis.contact.strip.swept_volume_moving_axis import least_distance_to_positions
from toolaxis.contact.strip.width import step_widths
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.shape.face import Face
from toolaxis.shape.surface import Derivatives

Array = NDArray[np.float64]

#: Positions of the cutter before and behind a contact, and their greatest distance from it in radii of the tool.
_POSITIONS, _WINDOW = 16, 1.6
#: Places that are tried at once for the end of a strip, how often the gap between them is narrowed, and the shares of
#: the half width with a standing axis between which it is looked for first.
_PLACES, _ROUNDS, _NEAR = 6, 5, (0.6, 1.3)


class AxisField(Protocol):
    """The tool axis at each place of a face."""

    @property
    def feed(self) -> str:
        """"u" or "v": the parameter that varies along the passes that the field is for."""

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts, beyond the face too, (n, 3).

        Parameters
        ----------
        face : Face
        uv : (n, 2) array
        frame : Frame, optional
            Feed, left and normal there, where they are known.
        """


@dataclass(frozen=True)
class ConstantLeadField:
    """The axis leans by one angle along the feed and does not tilt (Sturz milling).

    Attributes
    ----------
    lead : float
        From the normal towards the growing parameter of the passes, rad.
    feed : str
        "u" or "v": that parameter.
    """

    lead: float
    feed: str

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        return axis_from_lead_tilt(contact_frame(face, uv, self.feed) if frame is None else frame, self.lead, 0.0)


Field = TypeVar("Field", bound=AxisField)


@dataclass(frozen=True, eq=False)
class MovingCut(Cut, Generic[Field]):
    """What cuts with an axis that moves.

    Attributes
    ----------
    tool, scallop, allowance
        As for `Cut`.
    axis : (3,) array
        About the mean of the axes: what links and the sense of climbing go by.
    field : AxisField
    """

    field: Field = dataclasses.field(kw_only=True)

    @property
    def feed(self) -> str:
        """"u" or "v": the parameter that varies along the passes."""
        return self.field.feed

    def axes(self, face: Face, uv: Array) -> Array:
        """Unit axes at contacts, (n, 3).

        Parameters
        ----------
        face : Face
        uv : (n, 2) array
        """
        return self.field.axes(face, uv)


@dataclass(frozen=True, eq=False)
class MovingChart(IsoChart):
    """A face in its own parameters, for passes on which the axis moves."""

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter: what the cutter leaves on its way past, its axis moving.

        Parameters
        ----------
        cut : MovingCut
        along, step : (n,) array
        """
        assert isinstance(cut, MovingCut)
        step = np.clip(step, *self._poles)
        uv = self.uv(along, step)
        frozen = step_widths(self.face, cut.tool, uv, cut.axes(self.face, uv), cut.scallop, self.feed, cut.allowance)
        positions = self._positions(cut, along, step)
        cutter = cutter_parameters(cut.tool, cut.scallop, cut.allowance)
        cap = CAP * cut.tool.radius / np.maximum(self._pace(along, step), 1e-9)
        out = np.empty_like(frozen)
        for side in (0, 1):
            sense = 2 * side - 1
            low, high = (np.minimum(share * frozen[:, side], cap) for share in _NEAR)
            early = self._off(cut, cutter, (along, (step + sense * low)[None]), positions)[:, 0] > 0
            low, high = np.where(early, 0.0, low), np.where(early, low, high)
            for _ in range(_ROUNDS):
                share = np.linspace(0.0, 1.0, _PLACES + 1)[1:]
                places = low[:, None] + (high - low)[:, None] * share
                free = self._off(cut, cutter, (along, step + sense * places.T), positions) > 0
                first = np.where(free.any(axis=1), np.argmax(free, axis=1), _PLACES - 1)
                gap = (high - low) / _PLACES
                low, high = low + gap * first, low + gap * (first + 1)
            out[:, side] = np.where(frozen[:, side] > 0, low, 0.0)
        return out

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2)."""
        across = "v" if self.feed == "u" else "u"
        uv = self.uv(along, step)
        return np.asarray(step_widths(self.face, cut.tool, uv, cut.axes(self.face, uv), cut.scallop, across,
                                      cut.allowance))

    def _pace(self, along: Array, step: Array) -> Array:
        """mm per unit of the step parameter, (n,)."""
        d = self.face.evaluate(self.uv(along, step))
        return np.asarray(np.linalg.norm(d.sv if self.feed == "u" else d.su, axis=1))

    def _positions(self, cut: MovingCut[Any], along: Array, step: Array) -> tuple[Array, Array]:
        """Tips and axes along the pass around each contact, (n, k, 3) each."""
        d = self.face.evaluate(self.uv(along, step))
        speed = np.linalg.norm(d.su if self.feed == "u" else d.sv, axis=1)
        reach = _WINDOW * (cut.tool.radius + cut.scallop) / np.maximum(speed, 1e-9)
        t = np.linspace(-1.0, 1.0, 2 * _POSITIONS + 1)
        around = along[:, None] + reach[:, None] * t
        uv = self.uv(around.ravel(), np.repeat(step, len(t)))
        near, normal = self._evaluate_at(uv)
        frame = frame_from_normal(normal, near.su if self.feed == "u" else near.sv)
        axes = cut.field.axes(self.face, uv, frame)
        tip = tips(near.point, normal, axes, cut.tool, cut.allowance)
        shape = (len(along), len(t), 3)
        return tip.reshape(shape), axes.reshape(shape)

    def _off(self, cut: Cut, cutter: CutterParameters, at: tuple[Array, Array],
             positions: tuple[Array, Array]) -> Array:
        """Distance to the passing cutter at scallop height over places (m, n) beside each contact, (n, m) mm."""
        along, steps = at
        uv = self.uv(np.repeat(along, len(steps)), steps.T.ravel())
        d, normal = self._evaluate_at(uv)
        points = d.point + (cut.scallop + cut.allowance) * normal
        return least_distance_to_positions(cutter, points.reshape(len(along), len(steps), 3), *positions)

    def _evaluate_at(self, uv: Array) -> tuple[Derivatives, Array]:
        """Derivatives and normals at parameters."""
        d = self.face.evaluate(uv)
        return d, self.face.normal(uv, d)
