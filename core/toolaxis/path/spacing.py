"""How far the next pass may lie: strips laid one against the other from border to border.

The front is, at every value of the along parameter, the first place on the face that no strip has reached yet.  The
next pass goes as far as its strip still reaches back to the front everywhere; the last one is drawn back until its
strip ends on the border.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.path.chart import Chart, Cut, columns
from toolaxis.path.material import first_from, last_of, table
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

_SAMPLES = 128
_PER_SPAN = 6
_MOST_SAMPLES = 512
#: Strips overlap by up to this share of the narrowest one, half as much on average.
_ACCURACY = 4e-4
_MOST_PASSES = 100_000


@dataclass(frozen=True, eq=False)
class Spacing:
    """Places of the passes.

    Attributes
    ----------
    steps : (k,) array
        Step parameter of each pass, increasing.
    unused : float
        Share of the last strip that was not needed, 0 to 1.
    along : (n,) array
        Where the strips were measured.
    halves : (k, n, 2) array
        Half widths in the step parameter, towards its lower and its upper end.
    """

    steps: Array
    unused: float
    along: Array
    halves: Array


def along_samples(chart: Chart) -> Array:
    """Values of the along parameter at which strips are measured: even, with the surface's breaks among them."""
    a0, a1, _, _ = chart.bounds
    inner = chart.breaks[0]
    count = min(max(_SAMPLES, _PER_SPAN * (len(inner) + 1)), _MOST_SAMPLES)
    even = np.linspace(a0, a1, count + 1)
    apart = np.abs(even[:, None] - inner).min(axis=1, initial=np.inf) > 0.2 * (a1 - a0) / count
    apart[[0, -1]] = True
    return np.sort(np.concatenate([even[apart], inner[(inner > a0) & (inner < a1)]]))


def lowest(values: Array, along: Array) -> float:
    """Minimum of a sampled function, with the vertex of the parabola through the least sample and its neighbours.

    Parameters
    ----------
    values, along : (n,) array
        inf where the function does not count.
    """
    i = int(np.argmin(values))
    least = float(values[i])
    if not 0 < i < len(values) - 1 or not np.isfinite(values[i - 1 : i + 2]).all():
        return least
    left, right = along[i] - along[i - 1], along[i + 1] - along[i]
    slope_left, slope_right = (values[i] - values[i - 1]) / left, (values[i + 1] - values[i]) / right
    bend = (slope_right - slope_left) / (left + right)
    slope = (slope_left * right + slope_right * left) / (left + right)
    return least if bend <= 0 else float(least - slope**2 / (4 * bend))


def _root(function: Callable[[float], float], guess: float, sign: float, tolerance: float) -> float:
    """Place where a function of slope near `sign` vanishes, from the side on which it is positive."""
    place, value, slope = guess, function(guess), sign
    for _ in range(40):
        if 0 <= value <= tolerance:
            return place
        step = (0.5 * tolerance - value) / slope
        new = place + step
        after = function(new)
        if step:
            slope = sign * min(max(sign * (after - value) / step, 0.3), 3.0)
        place, value = new, after
    return place


class _Strips:
    """Half widths along passes, remembered for the last place asked for."""

    def __init__(self, chart: Chart, cut: Cut, along: Array) -> None:
        self.chart, self.cut, self.along = chart, cut, along
        self._step, self._halves = np.nan, np.empty((0, 2))

    def at(self, step: float, active: Bools) -> Array:
        """Half widths (n, 2) at one step parameter."""
        if step != self._step:
            halves = self.chart.half_widths(self.cut, self.along, np.full(len(self.along), step))
            self._step, self._halves = step, halves
            bad = np.flatnonzero(~(np.isfinite(halves).all(axis=1) & (halves > 0).all(axis=1)) & active)
            if bad.size:
                where = self.chart.uv(self.along[bad[:1]], np.array([step]))[0]
                raise InvalidInput(f"strip width is {halves[bad[0]].tolist()} at uv {where.tolist()} of face "
                                   f"{self.chart.face.label}: the axis {self.cut.axis.tolist()} gouges or stands "
                                   "upright there; choose one that is free over the whole face")
        return self._halves


def space(chart: Chart, cut: Cut, material: Array | None = None, progress: Progress = NO_PROGRESS) -> Spacing:
    """Lay passes over a face as far apart as the scallop height allows.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    material : (n, k, 2) array, optional
        What has to be covered on each line of `along_samples` across the passes; the face itself unless given.
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
    along = along_samples(chart)
    column = table(columns(chart, along), len(along)) if material is None else material
    _, _, s0, s1 = chart.bounds
    strips, top = _Strips(chart, cut, along), last_of(column)
    front = first_from(column, np.full(len(along), s0))
    steps: list[float] = []
    halves: list[Array] = []
    guess = float(front.min(initial=np.inf))
    unused = 0.0
    while np.isfinite(front).any():
        greedy, place = _next(strips, front, top, min(guess, s1))
        half = strips.at(place, np.isfinite(front))
        tight = lowest(np.where(np.isfinite(front), half.sum(axis=1), np.inf), along)
        unused = max(greedy - place, 0.0) / tight
        if not steps and unused > 0:
            place = min(max((greedy + place) / 2, s0), s1)
            half = strips.at(place, np.isfinite(front))
        steps.append(place)
        halves.append(half)
        reached = front >= place - half[:, 0] - _ACCURACY * tight
        front = np.where(reached, first_from(column, np.maximum(np.where(np.isfinite(front), front, s0),
                                                                place + half[:, 1] * (1 + 1e-9))), np.inf)
        guess = _forecast(steps, halves, front, along)
        progress.report("passes", min(max((place - s0) / (s1 - s0), 0.0), 1.0), 1.0)
        if len(steps) > _MOST_PASSES:
            raise InvalidInput(f"more than {_MOST_PASSES} passes on face {chart.face.label}: "
                               "the scallop height is too small for its size")
    return Spacing(np.array(steps), float(min(unused, 1.0)), along,
                   np.array(halves).reshape(len(steps), len(along), 2))


def _forecast(steps: list[float], halves: list[Array], front: Array, along: Array) -> float:
    """Where the next pass will be, were the half widths to go on changing as they did between the last two."""
    rate = np.zeros(len(along))
    if len(steps) > 1:
        rate = np.clip((halves[-1][:, 0] - halves[-2][:, 0]) / (steps[-1] - steps[-2]), -0.5, 0.5)
    place = (front + halves[-1][:, 0] - rate * steps[-1]) / (1 - rate)
    return lowest(place, along)


def _next(strips: _Strips, front: Array, top: Array, guess: float) -> tuple[float, float]:
    """Farthest place of the next pass, and where it is put: the same unless it is the last one."""
    active = np.isfinite(front)

    def slack(step: float) -> float:
        return lowest(np.where(active, front + strips.at(step, active)[:, 0] - step, np.inf), strips.along)

    def beyond(step: float) -> float:
        return lowest(np.where(active, step + strips.at(step, active)[:, 1] - top, np.inf), strips.along)

    half = strips.at(guess, active)
    tolerance = _ACCURACY * float(half.sum(axis=1)[active].min())
    greedy = _root(slack, guess, -1.0, tolerance)
    over = beyond(greedy)
    if over < 0:
        return greedy, greedy
    return greedy, min(_root(beyond, greedy - over, 1.0, tolerance), greedy)
