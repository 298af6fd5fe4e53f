"""Two parameters to cut by: one runs along the passes, the other steps from pass to pass."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.placement import tips
from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.second_order import contact_forms, screen_many
from toolaxis.contact.strip.width import step_widths
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.trim_intervals import Intervals, intervals
from toolaxis.path.width_correction import lean_ratios_of, lean_table, screening_cutter
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]

#: Share of the range across passes that is kept from a pole, where they have no direction.
_POLE = 1e-3

#: Strips that end nearer to a pole than this share of their width reach it: at the pole itself there is no normal.
_AT = 1e-6

#: Lines are kept this share of the range off its ends: there the noise of a loop along the end, and no more than that,
#: would decide which parts of a line are inside.
_EDGE = 1e-5

#: As many bounds of distances as take as long as a contact with its tip.
_POINT = 5

#: Ratios by which widths that were measured on what stands for a face are corrected, least and greatest.
_CORRECTED = (0.4, 2.5)

#: Places each way from which the size of a chart is taken.
_EXTENT = 9


@dataclass(frozen=True, eq=False)
class Cut:
    """What cuts and how: the conditions that are the same for every pass over a face.

    Attributes
    ----------
    tool : Tool
    axis : (3,) array
        Unit vector from tip to spindle.
    scallop : float
        Scallop height, mm.
    allowance : float
        Stock left on the surface, mm.
    greatest_step_over : float
        Greatest distance of neighbouring passes, mm, whatever the scallop height allows; infinite for none.

    Raises
    ------
    InvalidInput
        When the axis is no single direction, or scallop, allowance or step-over are out of range.
    """

    tool: Tool
    axis: Array
    scallop: float
    allowance: float = 0.0
    greatest_step_over: float = np.inf

    def __post_init__(self) -> None:
        rows = as_rows(self.axis, 3, "axis")
        if len(rows) != 1:
            raise InvalidInput(f"axis has shape {np.shape(self.axis)}: passes need one fixed axis of 3 numbers")
        object.__setattr__(self, "axis", unit(rows[0]))
        if not 0 < self.scallop < self.tool.radius:
            raise InvalidInput(f"scallop height is {self.scallop} mm: it must be above zero and below the cutter "
                               f"radius {self.tool.radius} mm")
        if not (np.isfinite(self.allowance) and self.allowance >= -self.tool.corner_radius):
            raise InvalidInput(f"allowance is {self.allowance} mm: it must be finite and not below minus the corner "
                               f"radius {self.tool.corner_radius} mm")
        if not self.greatest_step_over > 0:
            raise InvalidInput(f"greatest step-over is {self.greatest_step_over} mm: it must be above zero")

    def axes(self, face: Face, uv: Array) -> Array:
        """The axis at contacts, (3,) or (n, 3) unit vectors: one for all of them here.

        Parameters
        ----------
        face : Face
        uv : (n, 2) array
        """
        return self.axis

    @cached_property
    def numbers(self) -> CutterParameters:
        """Sizes of the cutter as screening takes them."""
        return screening_cutter(self.tool, self.scallop, self.allowance)

    @cached_property
    def leans(self) -> Array:
        """Ratio of exact to second-order widths on a plane, see `lean_table`."""
        return lean_table(self.tool, self.scallop)


class Chart(Protocol):
    """A parametrisation (along, step) of a face; passes run along the first at fixed values of the second."""

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Range of the face: along0, along1, step0, step1."""

    @property
    def loops(self) -> tuple[Array, ...]:
        """Loops that bound the face, (m, 2) rows of (along, step)."""

    @property
    def breaks(self) -> tuple[Array, Array]:
        """Inner values of along and of step across which the surface is not smooth."""

    @property
    def face(self) -> Face:
        """The face."""

    @property
    def rectangular(self) -> bool:
        """Whether the face fills its bounds."""

    def closed(self, step: Array) -> NDArray[np.bool_]:
        """Whether passes at these steps end where they began, (n,): then there is nowhere to run out to."""

    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each; beyond the face too."""

    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""

    def feed_at(self, uv: Array) -> "str | Array":
        """The feed of passes at parameters, as `strip_width` takes it: "u", "v", or unit vectors (n, 3)."""

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter, towards its lower and its upper end."""

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean."""

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2)."""


@dataclass(frozen=True, eq=False)
class IsoChart:
    """A face in its own parameters.

    Attributes
    ----------
    face : Face
    feed : str
        "u" or "v": the parameter that varies along the passes.

    Raises
    ------
    InvalidInput
        When the feed is neither.
    """

    face: Face
    feed: str = "u"

    def __post_init__(self) -> None:
        if self.feed not in ("u", "v"):
            raise InvalidInput(f"feed is {self.feed!r}: it must be 'u' or 'v'")

    @property
    def _order(self) -> list[int]:
        return [0, 1] if self.feed == "u" else [1, 0]

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Range of the face: along0, along1, step0, step1; where passes shrink to a pole, up to shortly before."""
        a0, a1, s0, s1 = self._range
        return a0, a1, max(s0, self._poles[0]), min(s1, self._poles[1])

    @property
    def _range(self) -> tuple[float, float, float, float]:
        u0, u1, v0, v1 = self.face.bounds
        return (u0, u1, v0, v1) if self.feed == "u" else (v0, v1, u0, u1)

    @cached_property
    def _poles(self) -> tuple[float, float]:
        """Steps shortly after a lower and before an upper border that is a point; infinite where there is none."""
        return self._find_poles(1)

    @cached_property
    def _poles_along(self) -> tuple[float, float]:
        """The same of the along parameter: there all passes meet."""
        return self._find_poles(0)

    def _find_poles(self, which: int) -> tuple[float, float]:
        a0, a1, s0, s1 = self._range
        low_end, high_end = (s0, s1) if which else (a0, a1)
        line = np.linspace(a0, a1, 5) if which else np.linspace(s0, s1, 5)
        one, other = np.tile(line, 3), np.repeat([low_end, (low_end + high_end) / 2, high_end], 5)
        points = self.face.evaluate(self.uv(one, other) if which else self.uv(other, one)).point
        low, high = (np.ptp(points[row], axis=0).max() < 1e-9 * np.ptp(points, axis=0).max()
                     for row in (slice(0, 5), slice(10, 15)))
        near = _POLE * (high_end - low_end)
        return low_end + near if low else -np.inf, high_end - near if high else np.inf

    @cached_property
    def loops(self) -> tuple[Array, ...]:
        """Loops that bound the face, (m, 2) rows of (along, step)."""
        return tuple(np.ascontiguousarray(loop[:, self._order]) for loop in self.face.outline)

    @cached_property
    def breaks(self) -> tuple[Array, Array]:
        """Inner knots along and across."""
        a0, a1, s0, s1 = self.bounds
        breaks = self.face.surface.breaks
        along, step = (breaks[i] for i in self._order)
        return along[(along > a0) & (along < a1)], step[(step > s0) & (step < s1)]

    @property
    def rectangular(self) -> bool:
        """Whether the face fills its bounds."""
        return not self.face.trims

    def closed(self, step: Array) -> NDArray[np.bool_]:
        """Whether passes at these steps end where they began, (n,): then there is nowhere to run out to."""
        a0, a1, _, _ = self.bounds
        low, middle, high = (self.face.evaluate(self.uv(np.full(len(step), a), step)).point
                             for a in (a0, (a0 + a1) / 2, a1))
        return np.asarray(np.linalg.norm(high - low, axis=1) < 1e-6 * np.linalg.norm(middle - low, axis=1))

    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each; beyond the face too."""
        return np.stack([along, step], axis=1)[:, self._order]

    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""
        return np.asarray(uv[:, self._order])

    def feed_at(self, uv: Array) -> str:
        """The feed of passes at parameters, as `strip_width` takes it: the same everywhere."""
        return self.feed

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter, towards its lower and its upper end; at a pole those before it.

        A strip that reaches a pole ends there.  Of a face for which a spline stands in, they are near, not exact.
        """
        step = np.clip(step, *self._poles)
        along = np.clip(along, *self._poles_along)
        found = np.asarray(step_widths(self.face, cut.tool, self.uv(along, step), cut.axis, cut.scallop, self.feed,
                                       cut.allowance, march=self._stand_in is None))
        if self._stand_in is not None:
            found = _corrected(found, self.screen(cut, along, step), self._stand_in.screen(cut, along, step))
        for side in (0, 1):
            if np.isfinite(self._poles[side]):
                room = np.abs(self._range[2 + side] - step)
                found[:, side] = np.where(found[:, side] > (1 - _AT) * room, np.maximum(found[:, side], room),
                                          found[:, side])
        return found

    @cached_property
    def _stand_in(self) -> "IsoChart | None":
        """The chart of what stands for the face where strips are measured; None where that is the face itself."""
        surface = self.face.surface.stand_in
        return None if surface is None else IsoChart(replace(self.face, surface=surface), self.feed)

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean."""
        forms = contact_forms(self.face, self.uv(along, step), self.feed, True)
        half = screen_many(forms, cut.axis[None], cut.numbers, cut.scallop)[0]
        return np.asarray(2 * half * lean_ratios_of(cut.leans, forms, cut.axis))

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2).

        A point at scallop height is cut from contacts within the half width of a pass that runs across this one.
        """
        across = "v" if self.feed == "u" else "u"
        return np.asarray(step_widths(self.face, cut.tool, self.uv(along, step), cut.axis, cut.scallop, across,
                                      cut.allowance))


def _corrected(halves: Array, exact: Array, rough: Array) -> Array:
    """Half widths (n, 2) measured on what stands for a face, by the ratio of the second-order widths (n,) of both.

    Where nothing was measured the second-order width of the face is taken.
    """
    known = (exact > 0) & (rough > 0)
    ratio = np.where(known, exact / np.where(known, rough, 1.0), 1.0)
    none = ~(halves > 0).all(axis=1) & (exact > 0)
    return np.where(none[:, None], exact[:, None] / 2, halves * np.clip(ratio, *_CORRECTED)[:, None])


def extents(chart: Chart) -> tuple[float, float]:
    """Greatest lengths, mm, of lines over the range of a chart along the passes and across them; no bounds.

    Parameters
    ----------
    chart : Chart
    """
    a0, a1, s0, s1 = chart.bounds
    along, step = np.meshgrid(np.linspace(a0, a1, _EXTENT), np.linspace(s0, s1, _EXTENT), indexing="ij")
    uv = chart.uv(along.ravel(), step.ravel())
    points = chart.face.evaluate(uv).point.reshape(_EXTENT, _EXTENT, 3)
    return _greatest_length(points, 0), _greatest_length(points, 1)


def _greatest_length(points: Array, axis: int) -> float:
    """Length of the longest line along an axis of a grid of points, mm."""
    gaps = np.linalg.norm(np.diff(points, axis=axis), axis=-1)
    return float(gaps.sum(axis=axis).max())


def rows(chart: Chart, steps: Array) -> Intervals:
    """Where passes at given step parameters run over the face.

    Parameters
    ----------
    chart : Chart
    steps : (n,) array
    """
    _, _, s0, s1 = chart.bounds
    edge = _EDGE * (s1 - s0)
    return intervals(chart.loops, np.clip(steps, s0 + edge, s1 - edge), fixed=1)


def columns(chart: Chart, along: Array) -> Intervals:
    """Where lines across the passes run over the face.

    Parameters
    ----------
    chart : Chart
    along : (n,) array
    """
    a0, a1, _, _ = chart.bounds
    edge = _EDGE * (a1 - a0)
    return intervals(chart.loops, np.clip(along, a0 + edge, a1 - edge), fixed=0)


def tip_points(chart: Chart, cut: Cut, along: ArrayLike, step: ArrayLike) -> tuple[Array, Array, Array]:
    """Contacts, tool tips and normals at along and step.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    along, step : (n,) array_like

    Returns
    -------
    contact, tip, normal : (n, 3) arrays, mm
    """
    uv = chart.uv(np.asarray(along, dtype=float), np.asarray(step, dtype=float))
    spend(_POINT * len(uv))
    at = chart.face.evaluate(uv)
    point, normal = at.point, chart.face.normal(uv, at)
    return point, tips(point, normal, cut.axes(chart.face, uv), cut.tool, cut.allowance), normal
