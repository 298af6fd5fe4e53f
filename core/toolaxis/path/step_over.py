"""How far the next pass may lie: strips laid one against the other from border to border.

The front is, at every value of the along parameter, the first place on the face that no strip has reached yet.  The
next pass goes as far as its strip still reaches back to the front everywhere; the last one is drawn back until its
strip ends on the border.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.path.greatest_step_over import limit_half_widths
from toolaxis.path.parametrization import Chart, Cut, columns, extents, rows
from toolaxis.path.trim_intervals import first_from, last_of, table
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Numbers of gaps between measured lines that are tried in turn, and those that narrow faces may ask for besides.
_GAPS, _NARROW_GAPS = (24, 48, 96, 192), (384, 768)
#: On so many passes the pieces that lie on the face are measured.  Of their length all together this share may lie in
#: shorter pieces than the one that counts as short, and so many measured lines cross that one.
_ASKED, _SHORTEST, _CROSSED = 64, 0.1, 4
#: All lines together are about this many, or as many as lie `PITCH` apart where that makes fewer.
_FINE = 1024
#: In radii of the cutter: what is smaller along or across passes changes nothing of where they go.
PITCH = 0.02
#: Relative error of interpolated half widths that is accepted at the narrowest places of a pass, and elsewhere.
_INTERPOLATION, _ELSEWHERE = 5e-4, 3e-3
_NARROW = 1.1
#: By how much half widths between two measured lines may lie beyond those on them, as a share of these.
_BEYOND = 0.1
#: Where those of two neighbours differ by more than this ratio, and interpolation is not exact, they jump in between.
_JUMPS = 1.2
#: Strips overlap by up to this share of the narrowest one, half as much on average.
_ACCURACY = 4e-4
_MOST_PASSES = 20_000
#: How far from a pass strips on its lines may matter, in radii of the cutter.
_NEAR = 4.0
#: Places that are tried for a pass.
_TRIED = 60
#: How near both sides of a jump of the slack are looked at, in what a place may be off otherwise: so noise in the
#: surface's numbers does not move a pass.
_JUMP = 1e-3
#: A step that leaves more of the bracket and of the slack is slow.  Not one half, which a bisection leaves exactly:
#: there noise would decide.
_HALF = 0.51
#: So many passes in a row that together do not get on by as many times this share of the scallop height are none.
_STUCK, _LEAST = 20, 0.05
#: Places that are tried for the only pass of a face.
_PLACES = 65


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines across the passes: few on which strips are measured, many between on which they are laid.

    Attributes
    ----------
    measured : (n,) array
        Values of the along parameter at which half widths are computed.
    along : (m,) array
        All lines; the measured ones are among them.
    index, weight : (m, 4) array
        Measured lines, and their weights, that interpolate to each line by a cubic.
    before : (m,) array
        The measured line before each line; the last but one for the last.
    exact : bool
        Whether half widths between measured lines were found to be as interpolation tells.
    """

    measured: Array
    along: Array
    before: NDArray[np.intp]
    index: NDArray[np.intp]
    weight: Array
    exact: bool = True

    def spread(self, values: Array) -> Array:
        """Values (n, ...) on the measured lines, interpolated to all lines (m, ...)."""
        return np.asarray(np.einsum("mk,mk...->m...", self.weight, values[self.index]))

    def spread_widths(self, halves: Array) -> Array:
        """Half widths (n, 2) on the measured lines, interpolated to all lines (m, 2).

        A line keeps near those of its two neighbours: beside one strip that is many times as wide as the others a cubic
        would fall below zero, and no pass could follow.  Where they jump, as from a fillet to the plane beside it, it
        is not known on which side of the jump a line lies, and it takes the narrower one.
        """
        one = halves[self.before]
        other = halves[self.before + 1]
        narrower = np.minimum(one, other)
        wider = np.maximum(one, other)
        least = (1 - _BEYOND) * narrower
        most = (1 + _BEYOND) * wider
        found = np.clip(self.spread(halves), least, most)
        if self.exact:
            return np.asarray(found)
        jumps = (narrower > 0) & (wider > _JUMPS * narrower)
        return np.where(jumps, narrower, found)


def lines(chart: Chart, cut: Cut) -> Lines:
    """Lines across the passes of a chart: as many measured ones as the half widths need to be interpolated.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    """
    _, _, s0, s1 = chart.bounds
    wanted = np.ceil(extents(chart)[0] / (PITCH * cut.tool.radius))
    number = int(np.clip(wanted, 1, _FINE))
    tried = _gaps(chart)
    fine = _grid(chart, tried[-1], number)
    places = len(fine.measured)
    steps = s0 + (s1 - s0) * np.array([1, 3, 5]) / 6
    along, step = np.meshgrid(fine.measured, steps, indexing="ij")
    halves = limit_half_widths(chart, cut, along.ravel(), step.ravel())
    exact = halves.reshape(places, len(steps), 2)
    material = table(columns(chart, fine.measured), places)[:, None]
    begins_before = material[..., 0] <= steps[:, None]
    ends_behind = material[..., 1] >= steps[:, None]
    counts = (begins_before & ends_behind).any(axis=2)
    width = np.where(counts, exact.sum(axis=2), np.inf)
    is_narrow = width <= _NARROW * width.min(axis=0)
    allowed = np.where(is_narrow, _INTERPOLATION, _ELSEWHERE)[..., None] * exact
    for gaps in tried[:-1]:
        coarse = _grid(chart, gaps, number)
        where = np.searchsorted(fine.measured, coarse.measured)
        if not np.allclose(fine.measured[where], coarse.measured, rtol=1e-9, atol=0):
            continue
        guess = _interpolate(coarse.measured, exact[where], fine.measured)
        good = np.abs(guess - exact) <= allowed
        if good[counts].all():
            return coarse
    return replace(fine, exact=False)


def _gaps(chart: Chart) -> tuple[int, ...]:
    """Numbers of gaps to try: where passes cross narrow arms of a face, several measured lines have to cross each too.
    """
    a0, a1, s0, s1 = chart.bounds
    share = (np.arange(_ASKED) + 0.5) / _ASKED
    pieces = rows(chart, s0 + (s1 - s0) * share)
    length = np.sort(pieces.high - pieces.low)
    if not len(length):
        return _GAPS
    first_to_count = np.searchsorted(np.cumsum(length), _SHORTEST * length.sum())
    short = length[first_to_count]
    enough = _CROSSED * (a1 - a0) / short
    if not enough > _GAPS[-1]:
        return _GAPS
    further = int(np.searchsorted(_NARROW_GAPS, enough)) + 1
    return _GAPS + _NARROW_GAPS[:further]


def _grid(chart: Chart, gaps: int, number: int) -> Lines:
    """About so many even gaps, with the surface's breaks among the measured lines, and about so many lines in all."""
    a0, a1, _, _ = chart.bounds
    inner = chart.breaks[0]
    even = np.linspace(a0, a1, gaps + 1)
    to_break = np.abs(even[:, None] - inner).min(axis=1, initial=np.inf)
    apart = to_break > 1e-9 * (a1 - a0)
    measured = np.sort(np.concatenate([even[apart], inner]))
    between = max(number // len(measured), 2)
    share = np.arange(between) / between
    gap = np.diff(measured)
    along = measured[:-1, None] + gap[:, None] * share
    along = np.append(along.ravel(), measured[-1])
    index, weight = _stencil(measured, along)
    return Lines(measured, along, _before(measured, along), index, weight)


def _before(nodes: Array, places: Array) -> NDArray[np.intp]:
    """The node before each place; the last but one behind the last."""
    before = np.searchsorted(nodes, places, side="right") - 1
    return np.clip(before, 0, len(nodes) - 2)


def _stencil(nodes: Array, places: Array) -> tuple[NDArray[np.intp], Array]:
    """Four nodes around each place, and the weights of the cubic through them."""
    first = np.clip(_before(nodes, places) - 1, 0, len(nodes) - 4)
    index = first[:, None] + np.arange(4)
    four = nodes[index]
    weight = np.ones((len(places), 4))
    for k in range(4):
        own = four[:, k]
        for other in set(range(4)) - {k}:
            weight[:, k] *= (places - four[:, other]) / (own - four[:, other])
    return index, weight


def _interpolate(nodes: Array, values: Array, places: Array) -> Array:
    index, weight = _stencil(nodes, places)
    return np.asarray(np.einsum("mk,mk...->m...", weight, values[index]))


@dataclass(frozen=True, eq=False)
class Spacing:
    """Places of the passes.

    Attributes
    ----------
    steps : (k,) array
        Step parameter of each pass, increasing.
    unused : float
        Share of the last strip that was not needed, 0 to 1.
    lines : Lines
    halves : (k, n, 2) array
        Half widths in the step parameter, towards its lower and its upper end, on the measured lines.
    """

    steps: Array
    unused: float
    lines: Lines
    halves: Array


def _root(function: Callable[[float], float], guess: float, sign: float, tolerance: float) -> float:
    """Place where a function of slope near `sign` vanishes, or jumps past zero, from the side on which it is positive.
    """
    place = guess
    value = function(guess)
    slope = sign
    above: float | None = None
    below: float | None = None
    width = np.inf
    last = np.inf
    for _ in range(_TRIED):
        if 0 <= value <= tolerance:
            return place
        if value > 0:
            above = place
        else:
            below = place
        new = place + (0.5 * tolerance - value) / slope
        if above is not None and below is not None:
            before = width
            width = abs(above - below)
            if width <= _JUMP * tolerance:
                return above
            is_slow = width > _HALF * before and abs(value) > _HALF * last
            is_inside = min(above, below) < new < max(above, below)
            if is_slow or not is_inside:
                new = (above + below) / 2
        step = new - place
        last = abs(value)
        after = function(new)
        if step:
            rate = sign * (after - value) / step
            slope = sign * min(max(rate, 0.3), 3.0)
        place = new
        value = after
    return place if above is None or value >= 0 else above


class _Strips:
    """Half widths along passes, remembered for the last place asked for.

    They are zero on lines that have nothing to be covered near the pass: there the surface may go on in any way.  So it
    may beside the material, where a line at the pass helps only to interpolate: without a strip it borrows the nearest
    lines' narrowest one.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    across : Lines
    material : (m, k, 2) array
        What is to be covered on each of all lines, padded with inf.
    """

    def __init__(self, chart: Chart, cut: Cut, across: Lines, material: Array) -> None:
        _, _, s0, s1 = chart.bounds
        scale = extents(chart)[1]
        self.chart = chart
        self.cut = cut
        self.across = across
        self._material = material[np.searchsorted(across.along, across.measured)]
        self._step = np.nan
        self._far = _NEAR * cut.tool.radius * (s1 - s0) / scale
        self._needed = np.arange(len(across.measured))
        self._least_advance = _STUCK * _LEAST * cut.scallop * (s1 - s0) / scale
        self.measured: Array = np.empty((0, 2))
        self.halves: Array = np.empty((0, 2))

    def watch_front(self, front: Array, step: float) -> Bools:
        """Measure from now on only where something is to be covered near a pass: on lines (m,) bool, and beside them.

        Parameters
        ----------
        front : (m,) array
            The first place on each line that is to be covered; infinite where there is none.
        step : float
            About where the pass will be.
        """
        place = max(step, float(front.min()))
        near = np.asarray(front <= place + self._far)
        self._watch(near)
        return near

    def watch_material(self, material: Array, step: float) -> None:
        """Measure from now on where the face lies near a pass, covered or not.

        Parameters
        ----------
        material : (m, k, 2) array
        step : float
        """
        low = material[..., 0] - self._far
        high = material[..., 1] + self._far
        is_near = (low <= step) & (high >= step)
        self._watch(np.asarray(is_near.any(axis=1)))

    def _watch(self, near: Bools) -> None:
        watched = near if near.any() else np.ones_like(near)
        needed = np.zeros(len(self.across.measured), dtype=bool)
        needed[self.across.index[watched]] = True
        needed[1:] |= needed[:-1]
        needed[:-1] |= needed[1:]
        self._needed = np.flatnonzero(needed)
        self._step = np.nan

    def at(self, step: float) -> Array:
        """Half widths (m, 2) at one step parameter, on all lines."""
        if step == self._step:
            return self.halves
        along = self.across.measured[self._needed]
        found = limit_half_widths(self.chart, self.cut, along, np.full(len(along), step))
        some = self._material[self._needed]
        holds = (some[..., 0] <= step) & (some[..., 1] >= step)
        beside = np.asarray(~holds.any(axis=1))
        self.measured = np.zeros((len(self.across.measured), 2))
        self.measured[self._needed] = _borrow(found, beside)
        self._step = step
        self.halves = self.across.spread_widths(self.measured)
        return self.halves

    def check(self, cutting: Bools) -> None:
        """Refuse the last place asked for if a line on which it has to cut has no strip."""
        has_strip = np.isfinite(self.measured) & (self.measured > 0)
        good = np.asarray(has_strip.all(axis=1))
        if good.all():
            return
        used = np.zeros(len(good), dtype=bool)
        used[self.across.index[cutting, 1:3]] = True
        bad = np.flatnonzero(~good & used)
        if bad.size:
            axis = ", ".join(f"{round(float(x), 4) + 0.0:g}" for x in self.cut.axis)
            raise InvalidInput(f"the axis ({axis}) leaves no usable strip on {self._place(int(bad[0]))}: it gouges "
                               "there, or is normal to the surface; choose another axis")

    def check_progress(self, place: float, steps: Sequence[float]) -> None:
        """Refuse the last place asked for if passes get no farther, as lines with no strip, or next to none, keep them.

        Parameters
        ----------
        place : float
        steps : sequence of float
            Places of the passes before.
        """
        stands = bool(steps) and not place > steps[-1]
        creeps = len(steps) >= _STUCK and place - steps[-_STUCK] < self._least_advance
        if stands or creeps:
            narrowest = np.nan_to_num(self.measured[self._needed]).min(axis=1)
            least = int(self._needed[narrowest.argmin()])
            raise InvalidInput(f"passes do not advance on {self._place(least)}: their lines meet there, as in a pole, "
                               "or strips are next to nothing; cut along the other parameter")

    def _place(self, row: int) -> str:
        """A measured line at the last place asked for, in words."""
        along = self.across.measured[[row]]
        u, v = self.chart.uv(along, np.array([self._step]))[0] + 0.0
        return f"face {self.chart.face.label} at u {u:.4g}, v {v:.4g}"


def _borrow(halves: Array, beside: Bools) -> Array:
    """Half widths (n, 2) of neighbouring lines, those beside the material that have none replaced by their neighbours'.
    """
    has_strip = np.isfinite(halves) & (halves > 0)
    none = ~has_strip.all(axis=1)
    empty = np.flatnonzero(none & beside)
    good = np.flatnonzero(~none)
    if not len(empty) or not len(good):
        return halves
    place = np.searchsorted(good, empty)
    before = good[np.maximum(place - 1, 0)]
    after = good[np.minimum(place, len(good) - 1)]
    found = halves.copy()
    found[empty] = np.minimum(halves[before], halves[after])
    return found


def space(chart: Chart, cut: Cut, across: Lines, material: Array, progress: Progress = NO_PROGRESS) -> Spacing:
    """Lay passes over a face as far apart as the scallop height allows.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    across : Lines
    material : (m, k, 2) array
        What has to be covered on each line, padded with inf.
    progress : Progress

    Returns
    -------
    Spacing

    Raises
    ------
    InvalidInput
        When the axis leaves no strip somewhere.

    Notes
    -----
    **Properties**: (1) between neighbours the two half widths add up to their distance or more wherever there is
    material; (2) one place at least is tight, to 0.04 % of the strip; (3) the first and the last strip end on the
    border.
    """
    _, _, s0, s1 = chart.bounds
    strips, top = _Strips(chart, cut, across, material), last_of(material)
    front = first_from(material, np.full(len(across.along), s0))
    steps: list[float] = []
    halves: list[Array] = []
    guess, unused = s0, 0.0
    while np.isfinite(front).any():
        active = np.isfinite(front)
        greedy, place = _next(strips, front, top, min(guess, s1))
        strips.watch_material(material, place)
        half = strips.at(place)
        strips.check(active & (front <= place + half[:, 1]))
        unused = max(greedy - place, 0.0) / max(float(half.sum(axis=1)[active].min()), 1e-12 * (s1 - s0))
        if not steps and unused > 0:
            place = _only_place((max(place, s0), min(greedy, s1)), (greedy + place) / 2, material[active])
            strips.watch_material(material, place)
        half = strips.at(place)
        strips.check_progress(place, steps)
        steps.append(place)
        halves.append(strips.measured)
        front = np.where(active, first_from(material, np.maximum(front, place + half[:, 1] * (1 + 1e-9))), np.inf)
        guess = _forecast(steps, halves, front, across)
        progress.report("passes", min(max((place - s0) / (s1 - s0), 0.0), 1.0), 1.0)
        if len(steps) > _MOST_PASSES:
            limited = np.isfinite(cut.greatest_step_over)
            raise InvalidInput(_too_many(chart.face.label) if limited else (
                f"more than {_MOST_PASSES} passes on face {chart.face.label}: "
                "the scallop height is too small for its size"))
    return Spacing(np.array(steps), float(min(unused, 1.0)), across,
                   np.array(halves).reshape(len(steps), len(across.measured), 2))


def _too_many(label: str) -> str:
    return f"more than {_MOST_PASSES} passes on face {label}: the greatest step-over is too small for its size"


def _only_place(room: tuple[float, float], middle: float, material: Array) -> float:
    """Where in its room the only pass is put: as near to the middle as may be without leaving what is to be cut.

    A strip may reach far beyond its pass, as that of a flank does; a pass off the face, or where the tool may not
    stand, would be cut out again.

    Parameters
    ----------
    room : (float, float)
        Least and greatest step.
    middle : float
        The step that is wanted; it may lie outside.
    material : (m, k, 2) array
        What is to be cut on each line.
    """
    low, high = min(room), max(room)
    wanted = min(max(middle, low), high)
    tried = np.append(np.linspace(low, high, _PLACES), wanted)
    held = _holds(material, tried)
    best = tried[held == held.max()]
    return float(best[np.argmin(np.abs(best - wanted))])


def _holds(material: Array, steps: Array) -> NDArray[np.intp]:
    """How many lines have something to be cut at each step."""
    inside = (material[..., None, :, 0] <= steps[:, None]) & (material[..., None, :, 1] >= steps[:, None])
    return np.asarray(inside.any(axis=-1).sum(axis=0))


def _forecast(steps: list[float], halves: list[Array], front: Array, across: Lines) -> float:
    """Where the next pass will be, were the half widths to go on changing as they did between the last two."""
    last = halves[-1][:, 0]
    rate = np.zeros(len(across.measured))
    if len(steps) > 1:
        before = halves[-2][:, 0]
        known = (last != 0) & (before != 0)
        change = np.where(known, last - before, 0.0)
        rate = np.clip(change / (steps[-1] - steps[-2]), -0.5, 0.5)
    now = across.spread(last)
    slope = across.spread(rate)
    # The step s with s - front = now + slope (s - last step): its own half width reaches back to the front.
    places = (front + now - slope * steps[-1]) / (1 - slope)
    finite = places[np.isfinite(places)]
    return float(finite.min()) if len(finite) else steps[-1]


def _next(strips: _Strips, front: Array, top: Array, guess: float) -> tuple[float, float]:
    """Farthest place of the next pass, and where it is put: the same unless it is the last one."""
    active = np.isfinite(front)
    near = strips.watch_front(front, guess)

    def slack(step: float) -> float:
        return float((front + strips.at(step)[:, 0] - step)[near].min())

    def beyond(step: float) -> float:
        return float((step + strips.at(step)[:, 1] - top)[active].min())

    width = strips.at(guess).sum(axis=1)[near]
    tolerance = _ACCURACY * float(np.min(width[width > 0], initial=np.inf))
    if not np.isfinite(tolerance):
        return guess, guess
    greedy = _root(slack, guess, -1.0, tolerance)
    over = beyond(greedy)
    if over < 0:
        return greedy, greedy
    return greedy, min(_root(beyond, greedy - over, 1.0, tolerance), greedy)
