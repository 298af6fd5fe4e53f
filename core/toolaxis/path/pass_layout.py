"""Where each pass begins and ends: over the face, past its free borders, around holes and what may not be touched."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

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
Index = NDArray[np.intp]
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
    stretches = _stretches_on_material(chart, spacing, material)
    found = _extend_pieces(chart, cut, spacing.steps, stretches)
    if reach is not None:
        found = _cut_out(chart, cut, spacing.steps, found, reach)
    steps = spacing.steps[found.line]
    pieces = np.column_stack([found.low, found.high, steps])
    return Layout(chart, cut, spacing, pieces, found.line)


def _overlaps(material: Array, low: Array, high: Array) -> Bools:
    """Whether bands low..high on columns (..., k, 2) hold material."""
    begins_below = material[..., 0] < high[..., None]
    ends_above = material[..., 1] > low[..., None]
    return np.asarray((begins_below & ends_above).any(axis=-1))


def _stretches_on_material(chart: Chart, spacing: Spacing, material: Array) -> Intervals:
    """Stretches of each pass on which its strip holds material, with their ends found by bisection."""
    along = spacing.lines.along
    spread = [spacing.lines.spread_widths(h) for h in spacing.halves]
    halves = np.array(spread).reshape(-1, len(along), 2)
    steps = spacing.steps[:, None]
    strips = _StripSides(steps - halves[..., 0], steps + halves[..., 1])
    need = _overlaps(material[None], strips.low, strips.high)
    # A stretch ends between two neighbouring columns of which one holds material.
    line, before = np.nonzero(need[:, 1:] != need[:, :-1])
    end = along[before]
    if len(line):
        end = _ends_of_material(chart, along, strips, line, before, need[line, before])
    from_start = np.flatnonzero(need[:, 0])
    to_end = np.flatnonzero(need[:, -1])
    starts = np.full(len(from_start), along[0])
    ends = np.full(len(to_end), along[-1])
    line = np.concatenate([line, from_start, to_end])
    place = np.concatenate([end, starts, ends])
    order = np.lexsort((place, line))
    line = line[order]
    place = place[order]
    return Intervals(line[::2], place[::2], place[1::2])


class _StripSides(NamedTuple):
    """Sides of the strips of k passes at the lines across them, (k, l) each."""

    low: Array
    high: Array


def _ends_of_material(chart: Chart, along: Array, strips: _StripSides, line: Index, before: Index,
                      full: Bools) -> Array:
    """Where strips of passes cease or begin to hold material between a column, which holds some (full) or none, and
    the next one."""
    behind = before + 1
    inside = along[np.where(full, before, behind)]
    outside = along[np.where(full, behind, before)]
    gap = along[behind] - along[before]
    # Bisection, from the inside and from the outside towards the end.
    for _ in range(_BISECTIONS):
        middle = (inside + outside) / 2
        share = (middle - along[before]) / gap
        low, high = (side[line, before] * (1 - share) + side[line, behind] * share for side in strips)
        material = table(columns(chart, middle), len(middle))
        holds = _overlaps(material, low, high)
        inside = np.where(holds, middle, inside)
        outside = np.where(holds, outside, middle)
    return outside


def _extend_pieces(chart: Chart, cut: Cut, steps: Array, found: Intervals) -> Intervals:
    """Run pieces out as far as the cutter reaches at scallop height, and join those that then meet."""
    a0, a1, s0, s1 = chart.bounds
    step = np.clip(steps[found.line], s0, s1)
    begin = np.clip(found.low, a0, a1)
    end = np.clip(found.high, a0, a1)
    before = _run_out(chart, cut, begin, step, side=0)
    after = _run_out(chart, cut, end, step, side=1)
    closed = chart.closed(step)
    before = np.where(closed & (found.low <= a0), 0.0, before)
    after = np.where(closed & (found.high >= a1), 0.0, after)
    longer = Intervals(found.line, found.low - before, found.high + after)
    return merge_intervals(longer)


def _run_out(chart: Chart, cut: Cut, along: Array, step: Array, side: int) -> Array:
    """How far pieces go on past places on their lower (0) or upper (1) side."""
    reach = chart.run_outs(cut, along, step)[:, side]
    is_known = np.isfinite(reach) & (reach > 0)
    reach = np.where(is_known, reach, 0.0)
    overrun = overrun_length(chart, cut, along, step, forward=side == 1)
    return _RUN_OUT * np.maximum(reach, overrun)


def _reachable(chart: Chart, cut: Cut, along: Array, column: Intervals, reach: Reach) -> Intervals:
    """What can be cut of the lines across the passes."""
    _, _, s0, s1 = chart.bounds
    _, length = extents(chart)
    apart, exactness = sampling(length, s1 - s0, cut)

    def may_visit(line: Index, place: Array) -> Bools:
        return reach(chart.uv(along[line], place))

    return filter_intervals(column, may_visit, apart, exactness)


def _cut_out(chart: Chart, cut: Cut, steps: Array, found: Intervals, reach: Reach) -> Intervals:
    """What can be cut of the passes."""
    a0, a1, _, _ = chart.bounds
    length, _ = extents(chart)
    apart, exactness = sampling(length, a1 - a0, cut)

    def may_visit(line: Index, place: Array) -> Bools:
        return reach(chart.uv(place, steps[line]))

    kept = filter_intervals(found, may_visit, apart, exactness)
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
    apart = max(1 / _REACH_SAMPLES, PITCH * radius)
    exactness = max(_LEAST_ENDS, min(_ENDS * radius, 1.0))
    return span * apart, span * exactness


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
    apart = last - first
    meeting = np.nan_to_num((first + before + last - behind) / 2)
    meeting = np.clip(meeting, first, last)
    steps = [meeting]
    for share in _BETWEEN:
        between = first + share * apart
        steps.append(np.broadcast_to(between, meeting.shape))
    every_along = np.tile(along, len(meeting))
    places = []
    for one in steps:
        uv = chart.uv(every_along, one.ravel())
        places.append(uv[chart.face.contains(uv)])
    found = np.concatenate(places)
    stride = max(1, len(found) // _MOST_PLACES)
    return found[::stride]


def _count_along(placed: Layout) -> int:
    """How many places along passes are no farther apart than the narrowest strip on a plane is wide, or as many as
    there may be of them."""
    cut = placed.cut
    spacing = placed.spacing
    radius = cut.tool.corner_radius or cut.tool.radius
    strip = 2 * np.sqrt(2 * radius * cut.scallop)
    rows = (1 + len(_BETWEEN)) * len(spacing.steps)
    most = _MOST_ASKED // rows
    least = 2 * len(spacing.lines.measured) - 1
    length, _ = extents(placed.chart)
    wanted = int(np.ceil(length / strip))
    return max(least, min(most, wanted))


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
    length = high - low
    along = low[:, None] + share * length[:, None]
    every_step = np.repeat(steps, _ALONG)
    _, tips, _ = tip_points(placed.chart, placed.cut, along.ravel(), every_step)
    chords = np.diff(tips.reshape(-1, _ALONG, 3), axis=1)
    return float(np.linalg.norm(chords, axis=2).sum())
