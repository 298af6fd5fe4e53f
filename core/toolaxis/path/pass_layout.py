"""Where each pass begins and ends: over the face, past its free borders, around holes and what may not be touched."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.path.overrun import overrun_length
from toolaxis.path.parametrization import Chart, Cut, columns, extents, tip_points
from toolaxis.path.step_over import PITCH, Spacing, lines, space
from toolaxis.path.traced_pieces import TracedPieces
from toolaxis.path.trim_intervals import Intervals, filter_intervals, merge_intervals, table
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Reach = Callable[[Array], Bools]

_BISECTIONS = 14
#: Passes run out this much farther than the cutter reaches at scallop height.
_RUN_OUT = 1.05
#: Places at which it is asked what can be reached, over the whole range: this many, or as many as lie `PITCH` apart
#: where that makes fewer; how exactly the ends are found, in radii of the cutter, and as a share of the range.
_REACH_SAMPLES = 192
_ENDS, _LEAST_ENDS = 2e-4, 2e-7
#: Where between two passes it is looked what they leave, as shares of their distance, and at how many places in all.
_BETWEEN, _MOST_PLACES, _MOST_ASKED = (0.3, 0.4, 0.5, 0.6, 0.7), 200_000, 2_000_000
#: Points of a pass from which its length is told.
_ALONG = 65


@dataclass(frozen=True, eq=False)
class Layout:
    """Passes before they are traced.

    Attributes
    ----------
    chart : Chart
    cut : Cut
    spacing : Spacing
    pieces : (m, 3) array
        along0, along1, step of each piece, sorted by pass, then along.
    owner : (m,) array of int
        Pass of each piece.
    traced : TracedPieces
        Pieces that were traced, of this layout and of those that it was made from.
    """

    chart: Chart
    cut: Cut
    spacing: Spacing
    pieces: Array
    owner: NDArray[np.intp]
    traced: TracedPieces = field(default_factory=TracedPieces)

    @property
    def steps(self) -> Array:
        """Step parameter of each pass, (k,)."""
        return self.spacing.steps

    @property
    def used(self) -> float:
        """Number of passes less the unused share of the last strip: comparable with the count."""
        return len(self.spacing.steps) - self.spacing.unused


def lay_out(chart: Chart, cut: Cut, reach: Reach | None = None, progress: Progress = NO_PROGRESS) -> Layout:
    """Place passes on a face and decide where each of them cuts.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    reach : callable, optional
        Takes (n, 2) parameters, beyond the face too, and tells which contacts the cutter may visit, (n,) bool; what
        it forbids is cut out of the passes and need not be covered.
    progress : Progress

    Raises
    ------
    InvalidInput
        When the axis leaves no strip somewhere.
    """
    across = lines(chart, cut)
    column = columns(chart, across.along)
    if reach is not None:
        column = _reachable(chart, cut, across.along, column, reach)
    material = table(column, len(across.along))
    spacing = space(chart, cut, across, material, progress)
    found = _extend_pieces(chart, cut, spacing.steps, _stretches_on_material(chart, spacing, material))
    if reach is not None:
        found = _cut_out(chart, cut, spacing.steps, found, reach)
    pieces = np.column_stack([found.low, found.high, spacing.steps[found.line]])
    return Layout(chart, cut, spacing, pieces, found.line)


def _overlaps(material: Array, low: Array, high: Array) -> Bools:
    """Whether bands low..high on columns (..., k, 2) hold material."""
    return np.asarray(((material[..., 0] < high[..., None]) & (material[..., 1] > low[..., None])).any(axis=-1))


def _stretches_on_material(chart: Chart, spacing: Spacing, material: Array) -> Intervals:
    """Stretches of each pass on which its strip holds material, with their ends found by bisection."""
    along = spacing.lines.along
    halves = np.array([spacing.lines.spread_widths(h) for h in spacing.halves]).reshape(-1, len(along), 2)
    low = spacing.steps[:, None] - halves[..., 0]
    high = spacing.steps[:, None] + halves[..., 1]
    need = _overlaps(material[None], low, high)
    # Between neighbouring columns of which one holds material: from the inside and from the outside towards its end.
    line, i = np.nonzero(need[:, 1:] != need[:, :-1])
    inside = along[np.where(need[line, i], i, i + 1)]
    outside = along[np.where(need[line, i], i + 1, i)]
    if len(line):
        for _ in range(_BISECTIONS):
            middle = (inside + outside) / 2
            share = (middle - along[i]) / (along[i + 1] - along[i])
            band = [side[line, i] * (1 - share) + side[line, i + 1] * share for side in (low, high)]
            full = _overlaps(table(columns(chart, middle), len(middle)), *band)
            inside = np.where(full, middle, inside)
            outside = np.where(full, outside, middle)
    from_start = np.flatnonzero(need[:, 0])
    to_end = np.flatnonzero(need[:, -1])
    lines_of_ends = np.concatenate([line, from_start, to_end])
    places = np.concatenate([outside, np.full(len(from_start), along[0]), np.full(len(to_end), along[-1])])
    order = np.lexsort((places, lines_of_ends))
    line = lines_of_ends[order]
    place = places[order]
    return Intervals(line[::2], place[::2], place[1::2])


def _extend_pieces(chart: Chart, cut: Cut, steps: Array, found: Intervals) -> Intervals:
    """Run pieces out as far as the cutter reaches at scallop height, and join those that then meet."""
    a0, a1, s0, s1 = chart.bounds
    step = np.clip(steps[found.line], s0, s1)
    ends = (found.low, found.high)
    before, after = (_run_out(chart, cut, (np.clip(end, a0, a1), step), side) for side, end in enumerate(ends))
    closed = chart.closed(step)
    before = np.where(closed & (found.low <= a0), 0.0, before)
    after = np.where(closed & (found.high >= a1), 0.0, after)
    return merge_intervals(Intervals(found.line, found.low - before, found.high + after))


def _run_out(chart: Chart, cut: Cut, place: tuple[Array, Array], side: int) -> Array:
    """How far pieces go on past places (along, step) on their lower (0) or upper (1) side."""
    reach = chart.run_outs(cut, *place)[:, side]
    reach = np.where(np.isfinite(reach) & (reach > 0), reach, 0.0)
    return _RUN_OUT * np.maximum(reach, overrun_length(chart, cut, *place, forward=side == 1))


def _reachable(chart: Chart, cut: Cut, along: Array, column: Intervals, reach: Reach) -> Intervals:
    """What can be cut of the lines across the passes."""
    _, _, s0, s1 = chart.bounds
    how = sampling(extents(chart)[1], s1 - s0, cut)
    return filter_intervals(column, lambda line, place: reach(chart.uv(along[line], place)), *how)


def _cut_out(chart: Chart, cut: Cut, steps: Array, found: Intervals, reach: Reach) -> Intervals:
    """What can be cut of the passes."""
    a0, a1, _, _ = chart.bounds
    how = sampling(extents(chart)[0], a1 - a0, cut)
    kept = filter_intervals(found, lambda line, place: reach(chart.uv(place, steps[line])), *how)
    long_ = kept.high - kept.low > 1e-9 * (a1 - a0)
    return Intervals(kept.line[long_], kept.low[long_], kept.high[long_])


def sampling(length: float, span: float, cut: Cut) -> tuple[float, float]:
    """How far apart it is asked what can be reached, and how exactly its ends are found, in the parameter.

    Parameters
    ----------
    length : float
        Of the range, mm.
    span : float
        Of the range, in the parameter.
    cut : Cut
    """
    radius = cut.tool.radius / max(length, np.finfo(float).tiny)
    return span * max(1 / _REACH_SAMPLES, PITCH * radius), span * max(_LEAST_ENDS, min(_ENDS * radius, 1.0))


def places_between(placed: Layout) -> Array:
    """Parameters (n, 2) of the face between neighbouring passes, among them those at which their strips meet.

    There lies what passes leave too high where widths were measured on what only stands for the face.

    Parameters
    ----------
    placed : Layout
    """
    spacing = placed.spacing
    chart = placed.chart
    if len(spacing.steps) < 2:
        return np.empty((0, 2))
    measured = spacing.lines.measured
    along = np.linspace(measured[0], measured[-1], _count_along(placed))
    before = np.array([np.interp(along, measured, half) for half in spacing.halves[:-1, :, 1]])
    behind = np.array([np.interp(along, measured, half) for half in spacing.halves[1:, :, 0]])
    first = spacing.steps[:-1, None]
    last = spacing.steps[1:, None]
    meeting = np.clip(np.nan_to_num((first + before + last - behind) / 2), first, last)
    steps = [meeting, *(np.broadcast_to(first + share * (last - first), meeting.shape) for share in _BETWEEN)]
    places = [chart.uv(np.tile(along, len(meeting)), one.ravel()) for one in steps]
    found = np.concatenate([uv[chart.face.contains(uv)] for uv in places])
    return found[::max(1, len(found) // _MOST_PLACES)]


def _count_along(placed: Layout) -> int:
    """How many places along passes are no farther apart than the narrowest strip on a plane is wide, or as many as
    there may be of them."""
    cut = placed.cut
    strip = 2 * np.sqrt(2 * (cut.tool.corner_radius or cut.tool.radius) * cut.scallop)
    most = _MOST_ASKED // ((1 + len(_BETWEEN)) * len(placed.spacing.steps))
    least = 2 * len(placed.spacing.lines.measured) - 1
    length, _ = extents(placed.chart)
    return max(least, min(most, int(np.ceil(length / strip))))


def pass_length(placed: Layout) -> float:
    """About how far the tip goes along the passes of a layout, mm.

    Parameters
    ----------
    placed : Layout
    """
    if not len(placed.pieces):
        return 0.0
    low, high, steps = placed.pieces.T
    share = np.linspace(0.0, 1.0, _ALONG)
    along = low[:, None] + share * (high - low)[:, None]
    _, tips, _ = tip_points(placed.chart, placed.cut, along.ravel(), np.repeat(steps, _ALONG))
    chords = np.diff(tips.reshape(-1, _ALONG, 3), axis=1)
    return float(np.linalg.norm(chords, axis=2).sum())
