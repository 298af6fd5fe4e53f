"""Passes for a roughness: a lean for each place of a face, the passes that it allows, and the splines along them."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.frame import Frame, axis_from_lead_tilt, contact_frame
from toolaxis.contact.placement import tips
from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.grids import grid_rows
from toolaxis.path.moving_axis import MovingChart, MovingCut
from toolaxis.path.parametrization import Cut
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.rotary_spline import RotarySpline
from toolaxis.strategies.roughness.roughness import arithmetic_roughness, profile_heights
from toolaxis.strategies.roughness.section_width import section_parameters, section_points

Array = NDArray[np.float64]

#: Evaluation lengths, mm, of roughnesses up to these, mm: ISO 4288.
_LENGTHS = ((0.02e-3, 0.4), (0.1e-3, 1.25), (2e-3, 4.0), (10e-3, 12.5), (np.inf, 40.0))
#: Share of the evaluation length that middles of profiles keep from borders.
_INSET = 0.51
#: Places of a profile, and positions of each pass within so many mm before and behind it.
_PROFILE, _POSITIONS, _WINDOW = 241, 21, 2.0


@dataclass(frozen=True, eq=False)
class LeadField:
    """A lead that changes over the face.

    Attributes
    ----------
    feed : str
        "u" or "v".
    along, step : (k,), (l,) array
        Grid of the parameters.
    leads : (k, l) array
        rad; between the grid's lines bilinear, beyond them as on the border.
    """

    feed: str
    along: Array
    step: Array
    leads: Array

    def lead_at(self, uv: Array) -> Array:
        """Leads at contacts, (n,) rad.

        Parameters
        ----------
        uv : (n, 2) array
        """
        rows = uv if self.feed == "u" else uv[:, ::-1]
        place = []
        for values, grid in ((rows[:, 0], self.along), (rows[:, 1], self.step)):
            at = np.interp(values, grid, np.arange(len(grid)))
            low = np.clip(at.astype(int), 0, len(grid) - 2)
            place.append((low, at - low))
        (i, x), (j, y) = place
        low, high = (self.leads[i, j + k] * (1 - x) + self.leads[i + 1, j + k] * x for k in (0, 1))
        return np.asarray(low * (1 - y) + high * y)

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        there = contact_frame(face, uv, self.feed) if frame is None else frame
        return axis_from_lead_tilt(there, self.lead_at(uv), 0.0)


@dataclass(frozen=True, eq=False)
class FieldChart(MovingChart):
    """A face in its own parameters, whose passes are laid for a field of leads whatever cuts them then.

    Attributes
    ----------
    face, feed
        As for `MovingChart`.
    laid : MovingCut of LeadField
    """

    laid: MovingCut[LeadField] = field(kw_only=True)
    _known: dict[bytes, Array] = field(default_factory=dict, repr=False)

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter that the field of leads leaves.

        Parameters
        ----------
        cut : Cut
            Not looked at.
        along, step : (n,) array
        """
        key = np.concatenate([along, step]).tobytes()
        if key not in self._known:
            self._known[key] = super().half_widths(self.laid, along, step)
        return self._known[key]

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far the cutter reaches before and behind a contact, (n, 2), with the field of leads.

        Parameters
        ----------
        cut : Cut
            Not looked at.
        along, step : (n,) array
        """
        return super().run_outs(self.laid, along, step)


@dataclass(frozen=True, eq=False)
class SplineAxes:
    """The axis of a machine whose rotary axes are splines along each pass.

    Attributes
    ----------
    feed : str
        "u" or "v".
    lean : float
        The mean one, rad.
    machine : Machine
    turn : (3, 3) array
        From the part's directions to the table's.
    pieces : (m, 3) array
        along0, along1, step of each pass or part of one, steps not falling.
    splines : tuple of RotarySpline
        One for each.
    """

    feed: str
    lean: float
    machine: Machine
    turn: Array
    pieces: Array
    splines: tuple[RotarySpline, ...]

    def owners(self, along: Array, step: Array) -> NDArray[np.intp]:
        """The piece that each place belongs to: of the pass nearest to it, that which holds it or is nearest, (n,).

        Parameters
        ----------
        along, step : (n,) array
        """
        beside = np.abs(self.pieces[:, 2] - step[:, None])
        off = np.maximum(np.maximum(self.pieces[:, 0] - along[:, None], along[:, None] - self.pieces[:, 1]), 0.0)
        nearest = beside <= beside.min(axis=1, keepdims=True)
        return np.asarray(np.where(nearest, off, np.inf).argmin(axis=1))

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        along, step = (uv if self.feed == "u" else uv[:, ::-1]).T
        owner, axes = self.owners(along, step), np.empty((len(uv), 3))
        for k in np.unique(owner):
            some = owner == k
            axes[some] = tool_axes(self.machine, self.splines[k].angles(along[some])) @ self.turn
        return axes


def evaluation_length(roughness: float) -> float:
    """Length over which Ra is evaluated, mm.

    Parameters
    ----------
    roughness : float
        Ra, mm.

    Notes
    -----
    **Source**: ISO 4288, five cut-off lengths; 4 mm for the 1.6 um of [dong2023] Sec. 6.
    """
    return next(length for most, length in _LENGTHS if roughness <= most)


def spots(face: Face, feed: str, length: float, counts: tuple[int, int] = (10, 9)) -> Array:
    """Places at which roughness is looked at, evenly over a face, whose whole profiles lie on it, (n, 2).

    Parameters
    ----------
    face : Face
    feed : str
    length : float
        Evaluation length, mm.
    counts : two of int
        Along u and along v: 90 as in the paper's tables unless given.

    Raises
    ------
    InvalidInput
        When no profile of this length lies on the face.
    """
    u0, u1, v0, v1 = face.bounds
    d = face.evaluate(face.grid(9, 9))
    pace = np.linalg.norm(d.sv if feed == "u" else d.su, axis=1).min()
    inset = np.array([0.0, _INSET * length / pace] if feed == "u" else [_INSET * length / pace, 0.0])
    ranges = [(low + gap, high - gap) if high - low > 2 * gap else ((low + high) / 2,) * 2
              for low, high, gap in ((u0, u1, inset[0]), (v0, v1, inset[1]))]
    u, v = (low + (high - low) * (np.arange(n) + 0.5) / n for (low, high), n in zip(ranges, counts, strict=True))
    uv = grid_rows(u, v)
    ends = section_parameters(face, uv, np.linspace(-0.5, 0.5, 9) * length, feed)
    on = face.contains(ends.reshape(-1, 2)).reshape(len(uv), -1).all(axis=1)
    on &= ((ends >= [u0, v0]) & (ends <= [u1, v1])).all(axis=(1, 2))
    if not on.any():
        raise InvalidInput(f"face {face.label} holds no profile of {length:g} mm across the feed along {feed}: its "
                           "roughness cannot be evaluated; take the other feed")
    return np.asarray(uv[on])


def roughness_at(face: Face, cut: MovingCut[Any], steps: Array, uv: Array, length: float) -> Array:
    """Ra across the feed that passes leave at places of a face, (n,) mm.

    Parameters
    ----------
    face : Face
    cut : MovingCut
        What cuts, with its axes at every place of the passes.
    steps : (k,) array
        Step parameter of each pass, growing.
    uv : (n, 2) array
    length : float
        Evaluation length, mm.

    Notes
    -----
    **Source**: [dong2023] Sec. 4.1.
    """
    if not len(uv):
        return np.empty(0)
    ahead = 0 if cut.feed == "u" else 1
    offsets = np.linspace(-0.5, 0.5, _PROFILE) * length
    at = section_parameters(face, uv, offsets, cut.feed)
    points, normal = section_points(face, at)
    low, high = at[..., 1 - ahead].min(axis=1), at[..., 1 - ahead].max(axis=1)
    first = np.clip(np.searchsorted(steps, low) - 2, 0, max(len(steps) - 1, 0))
    last = np.clip(np.searchsorted(steps, high) + 1, 0, len(steps) - 1)
    passes = []
    for k in range(int((last - first).max()) + 1):
        step = steps[np.minimum(first + k, last)]
        along = np.array([np.interp(s, *_growing(row[:, 1 - ahead], row[:, ahead])) for s, row in
                          zip(step, at, strict=True)])
        passes.append(_positions(face, cut, along, step))
    heights = profile_heights(cut.tool, points, normal, passes, cut.allowance)
    return arithmetic_roughness(heights)


def _growing(x: Array, y: Array) -> tuple[Array, Array]:
    return (x, y) if x[-1] >= x[0] else (x[::-1], y[::-1])


def _positions(face: Face, cut: MovingCut[Any], along: Array, step: Array) -> tuple[Array, Array]:
    """Tips and axes of passes around places, (n, k, 3) each."""
    ahead = 0 if cut.feed == "u" else 1
    middle = np.stack([along, step] if ahead == 0 else [step, along], axis=1)
    d = face.evaluate(middle)
    speed = np.linalg.norm(d.su if ahead == 0 else d.sv, axis=1)
    t = np.linspace(-_WINDOW, _WINDOW, _POSITIONS)
    every = np.repeat(middle, len(t), axis=0)
    every[:, ahead] += (t / np.maximum(speed, 1e-9)[:, None]).ravel()
    point, normal = section_points(face, every[None])
    axes = cut.axes(face, every)
    shape = (len(along), len(t), 3)
    return tips(point[0], normal[0], axes, cut.tool, cut.allowance).reshape(shape), axes.reshape(shape)
