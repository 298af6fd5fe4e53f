"""How many passes a face takes, as a real number, without making them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.path.greatest_step_over import limit_half_widths, limit_screen
from toolaxis.path.parametrization import Chart, Cut, IsoChart, columns, rows, tip_points
from toolaxis.path.trim_intervals import Intervals, RowPoints, row_points, table
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_ROW_GAPS = 48
_ROUNDS = 8
#: Gaps between exact widths on a pass; they scale the second-order ones.
_EXACT_GAPS = 12
_HALVINGS = 4
_CANDIDATES = 2
_SETTLED = 3
#: At a pole strips end at the same place, to this share of their width, from this many times as far away; how often
#: the farthest such pass is looked for half-way.
_SAME, _FARTHER, _HALVED = 1e-6, 1.5, 9
#: Edges that rise by less than this share of the range are level: rounding must not hide where a loop turns.
_LEVEL = 1e-6

# Nodes and weights of Gauss and Kronrod with 7 and 15 points on [-1, 1], for the upper half.
_NODES = np.array([0.0, 0.207784955007898467600689403773245, 0.405845151377397166906606412076961,
                   0.586087235467691130294144691693729, 0.741531185599394439863864773280788,
                   0.864864423359769072789712788640926, 0.949107912342758524526189684047851,
                   0.991455371120812639206854697526329])
_KRONROD = np.array([0.209482141084727828012999174891714, 0.204432940075298892414161999234649,
                     0.190350578064785409913256402421014, 0.169004726639267902826583426598550,
                     0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
                     0.063092092629978553290700663189204, 0.022935322010529224963732008058970])
_GAUSS = np.array([0.417959183673469387755102040816327, 0.0, 0.381830050505118944950369775488975, 0.0,
                   0.279705391489276667901467771423780, 0.0, 0.129484966168869693270611432679082, 0.0])
_POINTS = 2 * len(_NODES) - 1


class Count(NamedTuple):
    """What the passes over a face come to.

    passes : float, real-valued number of passes;  length : float, mm, of the tip's motion inside the face.
    """

    passes: float
    length: float


def count(face: Face, tool: Tool, axis: ArrayLike, scallop: float, feed: str = "u", allowance: float = 0.0) -> float:
    """Real-valued number of passes with exact strip widths.

    Parameters
    ----------
    face : Face
    tool : Tool
    axis : (3,) array_like
        From tip to spindle.
    scallop : float
        Scallop height, mm.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    allowance : float
        Stock left on the surface, mm.

    Returns
    -------
    float; inf where the axis leaves no strip somewhere.

    Raises
    ------
    InvalidInput
        When an argument is out of range.

    Notes
    -----
    The integral over the step parameter of 1 / min over the pass of both half widths together, to 0.1 %: that of the
    neighbour before it and that of the neighbour behind it which meet there, from the first pass to the last, whose
    strips end on the borders, and one.  A pass is what lies inside the loops and, past a slanting border, what its
    strip still reaches.  Where few passes lie on widths that vary by much, those made may differ by a twentieth of a
    pass, for the integral sees the widths between them too.

    **Source**: [zhu2016] Eqs. (3) to (6) in the limit of vanishing patches, with the difference between the strip of
    one pass and the distance of two, which are not the same where half widths are not.

    **Properties**: (1) range over width where the width is constant; (2) agrees with passes really made, less the
    unused share of the last; (3) moving, mirroring or swapping parameters changes nothing.
    """
    return measure(IsoChart(face, feed), Cut(tool, axis, scallop, allowance)).passes  # type: ignore[arg-type]


def measure(chart: Chart, cut: Cut, accuracy: float = 5e-4, most: int | None = None) -> Count:
    """Number and length of the passes over a chart.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    accuracy : float
        Estimated relative error at which refinement ends.
    most : int, optional
        How many passes are looked at before it ends in any case, but no fewer than there are.

    Returns
    -------
    Count; inf where the axis leaves no strip somewhere.
    """
    beyond = _OutsideLoops(chart, cut)
    ends = _outermost(chart, cut, beyond)
    edges = panels(chart)
    done = np.zeros(2)  # passes, and their length
    if ends.step[0] < ends.step[1]:
        edges = np.unique(np.clip(edges, *ends.step))
        done = np.array([1.0, ends.length.mean()])
    low = edges[:-1]
    high = edges[1:]
    looked_at = 0
    for level in range(_ROUNDS):
        fine, coarse = _integrals(chart, cut, beyond, low, high)
        looked_at += _POINTS * len(low)
        if not np.isfinite(fine).all():
            return Count(np.inf, np.inf)
        total = done + fine.sum(axis=0)
        share = accuracy * total / max(len(low), 4)
        good = (np.abs(fine - coarse) <= share).all(axis=1)
        enough = most is not None and looked_at >= max(most, total[0])
        if good.all() or enough or level == _ROUNDS - 1:
            return Count(float(total[0]), float(total[1]))
        done += fine[good].sum(axis=0)
        low = low[~good]
        high = high[~good]
        middle = (low + high) / 2
        low = np.concatenate([low, middle])
        high = np.concatenate([middle, high])
    raise AssertionError("refinement must end")


def panels(chart: Chart) -> Array:
    """Ends of the stretches of the step parameter in which the count is smooth, more or less, (m,).

    Parameters
    ----------
    chart : Chart
    """
    _, _, s0, s1 = chart.bounds
    turns = [s0, s1, *chart.breaks[1]]
    for loop in chart.loops:
        step = loop[:, 1]
        rise = np.roll(step, -1) - step
        rise = np.where(np.abs(rise) > _LEVEL * (s1 - s0), rise, 0.0)
        turns += step[np.roll(rise, 1) * rise <= 0].tolist()
    least = 0.02 * (s1 - s0)
    keep = [s0]
    for place in np.sort(np.array(turns)):
        if place - keep[-1] > least and s1 - place > least:
            keep.append(float(place))
    return np.array([*keep, s1])


def _integrals(chart: Chart, cut: Cut, beyond: "_OutsideLoops", low: Array, high: Array) -> tuple[Array, Array]:
    """Passes and length on each panel by 15 and by 7 points, (n, 2) each."""
    nodes = np.concatenate([-_NODES[:0:-1], _NODES])
    middle = (low + high) / 2
    half = (high - low) / 2
    steps = middle[:, None] + half[:, None] * nodes
    found = _narrowest(chart, cut, beyond, steps.ravel())
    apart = _spacing(chart, cut, found)
    strips = np.where(apart > 0, 1.0 / np.where(apart > 0, apart, 1.0), np.inf)
    rate = np.where(found.length > 0, strips, 0.0)
    rates = np.stack([rate, rate * found.length], axis=1)
    table = rates.reshape(len(low), len(nodes), 2) * half[:, None, None]
    fine, coarse = (np.einsum("k,nkc->nc", np.concatenate([weights[:0:-1], weights]), table)
                    for weights in (_KRONROD, _GAUSS))
    return fine, coarse


class _Rows(NamedTuple):
    """Passes, (n,) each: step, least strip width and where it is, and length of the tip's motion; 0, 0, 0 off the face.
    """

    step: Array
    width: Array
    place: Array
    length: Array


def _spacing(chart: Chart, cut: Cut, found: _Rows) -> Array:
    """Distance of two passes that just fit, half of it before and half of it behind each step, (n,).

    It differs from the least width as, at the narrowest place, the upper half width of the one and the lower half
    width of the other do from both half widths of a pass between them; near the borders two are taken that still lie
    within.
    """
    _, _, s0, s1 = chart.bounds
    width = np.where(found.width > 0, found.width, s1 - s0)
    low = np.clip(found.step - width / 2, s0, np.maximum(s1 - width, s0))
    high = np.minimum(low + width, s1)
    steps = np.concatenate([low, (low + high) / 2, high])
    halves = limit_half_widths(chart, cut, np.tile(found.place, 3), steps)
    known = np.where((halves > 0) & (halves < np.inf), halves, np.nan)
    before, between, behind = known.reshape(3, -1, 2)
    change = before[:, 1] + behind[:, 0] - between.sum(axis=1)
    return np.asarray(found.width + np.where(np.abs(change) < found.width / 2, change, 0.0))


def _outermost(chart: Chart, cut: Cut, beyond: "_OutsideLoops") -> _Rows:
    """The first and the last pass: their strips end on the borders."""
    border = np.array(chart.bounds[2:])
    inwards = np.array([1.0, -1.0])
    narrow = _narrowest(chart, cut, beyond, border).width
    found = _narrowest(chart, cut, beyond, border + inwards * np.minimum(narrow, border[1] - border[0]) / 2)
    place = found.place.copy()
    on = rows(chart, border)
    for k in (0, 1):  # a place on the border itself, where the face comes to it
        low = on.low[on.line == k].min(initial=np.inf)
        high = on.high[on.line == k].max(initial=-np.inf)
        if low < high:
            place[k] = np.clip(place[k], low, high)
    step = found.step
    for _ in range(_SETTLED):
        halves = limit_half_widths(chart, cut, place, step)
        towards_border = np.where(halves > 0, halves, 0.0)[[0, 1], [0, 1]]
        step = border + inwards * towards_border
    return found._replace(step=_off_poles(chart, cut, place, step))


def _off_poles(chart: Chart, cut: Cut, place: Array, step: Array) -> Array:
    """The outermost passes, (2,), moved away from a pole as far as all of their strips still end at it.

    There each of many passes ends at the border; where strips end elsewhere with another pass, nothing is moved.
    """
    a0, a1, s0, s1 = chart.bounds
    border = np.array([s0, s1])
    inwards = np.array([1.0, -1.0])
    own = np.abs(step - border)
    tried = np.append(own, _FARTHER * own)
    halves = limit_half_widths(chart, cut, np.tile(place, 2), np.tile(border, 2) + np.tile(inwards, 2) * tried)
    # How far strips go past the border, of the passes and of others farther away.
    past, past_farther = (halves[np.arange(4), [0, 1, 0, 1]] - tried).reshape(2, 2)
    along = np.linspace(a0, a1, _EXACT_GAPS + 1)
    away = own.copy()
    for k in np.flatnonzero((own > 0) & (np.abs(past_farther - past) <= _SAME * own)):
        near = own[k]
        far = max(own[k], (s1 - s0) / 2)
        for _ in range(_HALVED):
            middle = (near + far) / 2
            there = np.full(len(along), border[k] + inwards[k] * middle)
            ends = limit_half_widths(chart, cut, along, there)[:, k] - middle
            if (np.abs(ends - past[k]) <= _SAME * middle).all():
                near = middle
            else:
                far = middle
        away[k] = near
    return np.asarray(np.where(away == own, step, border + inwards * away))


class _OutsideLoops:
    """Places beyond the loops at which a pass still has to cut, for its strip reaches material.

    A pass runs on past a slanting border until its strip holds nothing any more.
    """

    def __init__(self, chart: Chart, cut: Cut) -> None:
        a0, a1, _, _ = chart.bounds
        self._chart = chart
        self._cut = cut
        self._along = np.linspace(a0, a1, _ROW_GAPS + 1)
        self._material: Array | None = None  # from which to which step there is material, at each place along
        if not chart.rectangular:
            self._material = table(columns(chart, self._along), len(self._along))

    def added(self, points: RowPoints, line: Index, guess: Array, steps: Array) -> tuple[RowPoints, Index, Array]:
        """Row points, their rows and approximate widths, with those places added."""
        if self._material is None:
            return points, line, guess
        row, column = (part.ravel() for part in np.indices((len(steps), len(self._along))))
        along = self._along[column]
        step = steps[row]
        width = self._chart.screen(self._cut, along, step)
        begins = self._material[column, :, 0]
        ends = self._material[column, :, 1]
        low = (step - width / 2)[:, None]
        high = (step + width / 2)[:, None]
        holds = ((begins < high) & (ends > low)).any(axis=1)
        within = ((begins <= step[:, None]) & (ends >= step[:, None])).any(axis=1)
        extra = np.flatnonzero(holds & ~within)
        own = points.interval.max(initial=-1) + 1 + np.arange(len(extra))
        more = RowPoints(np.append(points.interval, own), np.append(points.along, along[extra]))
        return more, np.append(line, row[extra]), np.append(guess, width[extra])


def _narrowest(chart: Chart, cut: Cut, beyond: _OutsideLoops, steps: Array) -> _Rows:
    """Least exact strip width over each pass, and the length of the tip's motion on it.

    Exact widths at some places scale the second-order ones between them; these tell where the least ones are, and
    there the exact ones are taken again.
    """
    a0, a1, _, _ = chart.bounds
    found = rows(chart, steps)
    few = row_points(found, (a1 - a0) / _EXACT_GAPS)
    if not len(few.interval):
        return _Rows(steps, np.zeros(len(steps)), np.full(len(steps), a0), np.zeros(len(steps)))
    few_line = found.line[few.interval]
    exact = _widths(chart, cut, few.along, steps[few_line])
    second = limit_screen(chart, cut, few.along, steps[few_line])
    comparable = (exact > 0) & (second > 0) & np.isfinite(second)
    ratio = np.where(comparable, exact / np.where(comparable, second, 1.0), 1.0)
    points = _with_breaks(found, row_points(found, (a1 - a0) / _ROW_GAPS), chart.breaks[0])
    line = found.line[points.interval]
    screened = limit_screen(chart, cut, points.along, steps[line])
    guess = screened * np.interp(_flat(found, points), _flat(found, few), ratio)
    place, row, own = _candidates(*beyond.added(points, line, guess, steps))
    width = np.append(exact, _widths(chart, cut, place, steps[row]))
    row = np.append(few_line, row)
    place = np.append(few.along, place)
    known = _Places(row, place, width, *_ranges(found, np.append(few.interval, own), place))
    width, place = _descend_to_narrowest(chart, cut, steps, known, (a1 - a0) / _EXACT_GAPS)
    return _Rows(steps, width, place, _tip_lengths(chart, cut, points, line, steps))


def _ranges(found: Intervals, own: Index, place: Array) -> tuple[Array, Array]:
    """From where to where places may move, by the numbers of their intervals: those beyond all intervals stay."""
    within = own < len(found.low)
    low = place.copy()
    high = place.copy()
    low[within] = found.low[own[within]]
    high[within] = found.high[own[within]]
    return low, high


def _tip_lengths(chart: Chart, cut: Cut, points: RowPoints, line: Index, steps: Array) -> Array:
    """Length of the tip's motion on each pass, (n,) mm, from row points and their passes."""
    _, tip, _ = tip_points(chart, cut, points.along, steps[line])
    chords = np.linalg.norm(np.diff(tip, axis=0), axis=1)
    same = np.diff(points.interval) == 0
    length = np.bincount(line[1:], weights=np.where(same, chords, 0.0), minlength=len(steps))
    return np.asarray(length, dtype=float)


class _Places(NamedTuple):
    """Places on passes, (n,) each: which pass, where, exact width, and the range in which the place may move."""

    row: Index
    place: Array
    width: Array
    low: Array
    high: Array


def _descend_to_narrowest(chart: Chart, cut: Cut, steps: Array, known: _Places, apart: float) -> tuple[Array, Array]:
    """Least width of each row and where it is, from the best known place downhill in halved steps.

    0 and the first along parameter where a row has no place.
    """
    order = np.lexsort((known.width, known.row))
    _, begins = np.unique(known.row[order], return_index=True)
    first = order[begins]
    row = known.row[first]
    place = known.place[first]
    width = known.width[first]
    low = known.low[first]
    high = known.high[first]
    for level in range(1, _HALVINGS + 1):
        shift = apart / 2**level
        before = np.maximum(place - shift, low)
        after = np.minimum(place + shift, high)
        left, right = _widths(chart, cut, np.append(before, after), np.tile(steps[row], 2)).reshape(2, -1)
        if level == _HALVINGS:
            inner = (before < place) & (after > place)
            width = np.where(inner, _vertex(left, width, right), np.minimum(width, left))
            width = np.minimum(width, right)
        else:
            lesser = np.minimum(left, right)
            lower = lesser < width
            place = np.where(lower, np.where(left <= right, before, after), place)
            width = np.where(lower, lesser, width)
    least = np.zeros(len(steps))
    where = np.full(len(steps), chart.bounds[0])
    least[row] = width
    where[row] = place
    return least, where


def _vertex(left: Array, middle: Array, right: Array) -> Array:
    """Least value of the parabola through the squares of three values at even distances, if it is a valley."""
    a = left**2
    b = middle**2
    c = right**2
    bend = a - 2 * b + c
    valley = (b <= a) & (b <= c) & (bend > 0)
    least = b - 0.125 * (c - a) ** 2 / np.where(valley, bend, 1.0)
    lowest = np.minimum(np.minimum(left, right), middle)
    return np.asarray(np.where(valley, np.sqrt(np.maximum(least, 0.25 * b)), lowest))


def _widths(chart: Chart, cut: Cut, along: Array, step: Array) -> Array:
    """Exact strip widths (n,); 0 where there is none on one side."""
    halves = limit_half_widths(chart, cut, along, step)
    return np.asarray(np.where((halves > 0).all(axis=1), halves.sum(axis=1), 0.0))


def _flat(found: Intervals, points: RowPoints) -> Array:
    """Places on all intervals, one after the other, as increasing numbers."""
    low = found.low[points.interval]
    high = found.high[points.interval]
    share = (points.along - low) / np.maximum(high - low, np.finfo(float).tiny)
    return np.asarray(2 * points.interval + share)


def _with_breaks(found: Intervals, points: RowPoints, breaks: Array) -> RowPoints:
    """Row points with the places added where the surface is not smooth."""
    inside = (breaks > found.low[:, None]) & (breaks < found.high[:, None])
    added, which = np.nonzero(inside)
    interval = np.append(points.interval, added)
    along = np.append(points.along, breaks[which])
    order = np.lexsort((along, interval))
    return RowPoints(interval[order], along[order])


def _candidates(points: RowPoints, line: Index, guess: Array) -> tuple[Array, Index, Index]:
    """Places of the deepest local minima of each row, moved to the vertex of the parabola; their rows and intervals."""
    same = np.diff(points.interval) == 0
    before = np.append(np.inf, np.where(same, guess[:-1], np.inf))
    after = np.append(np.where(same, guess[1:], np.inf), np.inf)
    low = np.flatnonzero((guess <= before) & (guess <= after))
    order = low[np.lexsort((guess[low], line[low]))]
    first = np.searchsorted(line[order], line[order])
    chosen = order[np.arange(len(order)) - first < _CANDIDATES]
    place = points.along[chosen].copy()
    inner = np.isfinite(before[chosen]) & np.isfinite(after[chosen])
    i = chosen[inner]
    tiny = np.finfo(float).tiny
    left = np.maximum(points.along[i] - points.along[i - 1], tiny)
    right = np.maximum(points.along[i + 1] - points.along[i], tiny)
    square = guess**2  # nearly a parabola where the lean crosses the feed at a right angle
    slope_left = (square[i] - square[i - 1]) / left
    slope_right = (square[i + 1] - square[i]) / right
    bend = (slope_right - slope_left) / (left + right)
    slope = (slope_left * right + slope_right * left) / (left + right)
    shift = np.where(bend > 0, -slope / np.where(bend > 0, 2 * bend, 1.0), 0.0)
    place[inner] += np.clip(shift, -left, right)
    return place, line[chosen], points.interval[chosen]
