"""Time along a curved path with every axis inside velocity, acceleration and jerk.

The square b of the path speed is sought at stations along the path, greatest where the axes allow it: see
`interior_point`.  The speeds are then turned into pieces of constant path jerk, and the whole is slowed down by the
small factor by which the sampled axes still exceed their limits: what is returned keeps them.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, make_interp_spline

from toolaxis.feed.interior_point import SpeedProblem, greatest_speeds
from toolaxis.feed.jerk_profile import profile
from toolaxis.feed.limits import AxisBounds, check_path
from toolaxis.feed.smooth_curve import fit_smooth_curve

Array = NDArray[np.float64]

#: Stations at either end that belong to the constant jerk from rest.
_END = 10

#: Times in each piece at which the axes are compared with their limits.
_SAMPLES = 5

#: Even stations along a curve near points, stations in a gap between its knots at least, and how often speeds are
#: sought again, lower at places where limits were exceeded by more than a share.
_EVEN, _IN_GAP, _ROUNDS, _EXCESS = 200, 4, 3, 0.005
#: Stations nearer than this share of the even distance are one.
_ONE = 1e-3
#: Share of a curve, at either end, that the first jerk from rest is told from.
_OUTER = 0.01

#: Share of the limits that the speeds are planned with; the rest is for what happens between stations.
_PLANNED = 0.999

#: Stretch above which a plan is made again with three times the stations, the most there are then, and plans at most.
_REFINE, _MOST, _PLANS = 1.005, 50_000, 3


@dataclass(frozen=True, eq=False)
class CurveSchedule:
    """Motion along a curve in pieces of constant path jerk.

    Attributes
    ----------
    curve : BSpline
        Axis positions over the path parameter, mm or rad.
    times : (k + 1,) array
        Where the pieces begin and end, s.
    states : (k + 1, 3) array
        Path parameter, its velocity and its acceleration there.
    stretch : float
        By what factor the sampled limits asked to slow the plan down.
    """

    curve: BSpline
    times: Array
    states: Array
    stretch: float

    @property
    def duration(self) -> float:
        """s."""
        return float(self.times[-1])

    def path_at(self, times: ArrayLike) -> Array:
        """Path parameter and its first three derivatives in time, (n, 4).

        Parameters
        ----------
        times : (n,) array_like
            s.
        """
        t = np.atleast_1d(np.asarray(times, dtype=float))
        piece = np.searchsorted(self.times, t, side="right") - 1
        piece = np.clip(piece, 0, len(self.times) - 2)
        gone = t - self.times[piece]
        s, v, a = self.states[piece].T
        jerk = np.diff(self.states[:, 2])[piece] / np.diff(self.times)[piece]
        way = s + gone * (v + gone * (a / 2 + gone * jerk / 6))
        velocity = v + gone * (a + gone * jerk / 2)
        return np.stack([way, velocity, a + gone * jerk, jerk], axis=1)

    def at(self, times: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Positions, velocities, accelerations and jerks of the axes, (n, m) each.

        Parameters
        ----------
        times : (n,) array_like
            s.
        """
        s, v, a, j = self.path_at(times).T[:, :, None]
        q, qs, qss, qsss = (self.curve(s[:, 0], order) for order in range(4))
        velocity = qs * v
        acceleration = qs * a + qss * v**2
        jerk = qs * j + 3 * qss * v * a + qsss * v**3
        return q, velocity, acceleration, jerk


def schedule_curve(points: ArrayLike, tips: ArrayLike, feed: float, bounds: AxisBounds,
                   stations: int | None = None) -> CurveSchedule:
    """The fastest motion from rest to rest along a smooth curve through axis positions.

    Parameters
    ----------
    points : (n, m) array_like
        Axis positions, mm or rad, n of at least 6, on a curve without corners.
    tips : (n, 3) array_like
        Tool tips there, mm.
    feed : float
        Programmed velocity of the tip, mm/s; infinite for as fast as the axes go.
    bounds : AxisBounds
    stations : int, optional
        How many places along the path are optimised; from the number of points, and more where the path needs it,
        unless given.

    Raises
    ------
    InvalidInput
        When shapes do not fit, points coincide, or the feed is not above zero.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (9), with 3 s' s'' f_s + s'^3 f_ss in its third line.
    Property: no axis exceeds its velocity, acceleration or jerk by more than a millionth at the sampled times.
    """
    joints, rows, along = check_path(points, tips, feed, len(bounds.velocity))
    curve = make_interp_spline(along, joints, 5)
    tip = make_interp_spline(along, rows, 5)
    length = float(along[-1])
    limits = _limits_at(np.linspace(0.0, length, 400), curve, tip, feed, bounds)
    count = stations or _enough(length, limits, len(rows))
    plans: list[CurveSchedule] = []
    while True:
        problem = _problem(_stations(length, count, limits), curve, tip, feed, bounds)
        start = _slow(problem.stations, length, limits)
        motion = _join_pieces(problem.stations, greatest_speeds(problem, start), curve, length)
        slowed = _slow_down(motion, _excess(motion, tip, feed, bounds).by)
        plans.append(slowed)
        count *= 3
        may_refine = stations is None and count < _MOST and len(plans) < _PLANS
        if not may_refine or slowed.stretch <= _REFINE:
            return min(plans, key=lambda plan: plan.duration)


def schedule_near(points: ArrayLike, feed: float, bounds: AxisBounds, tolerance: float) -> CurveSchedule:
    """The fastest motion from rest to rest along a smooth curve that passes points within a tolerance.

    Parameters
    ----------
    points : (n, 3) array_like
        Positions of the linear axes, mm, n of at least 6, on a curve without corners, no two neighbours the same; the
        tip goes as far as they do.
    feed : float
        Programmed velocity of the tip, mm/s; infinite for as fast as the axes go.
    bounds : AxisBounds
    tolerance : float
        How far the curve may pass the points, mm.

    Raises
    ------
    InvalidInput
        When points coincide, or the feed is not above zero.

    Notes
    -----
    **Source** and **property** are those of `schedule_curve`.  Stations are even, and denser where the curve has more
    knots; where sampled axes exceed their limits, speeds are capped there and sought again.
    """
    joints, _, along = check_path(points, points, feed, len(bounds.velocity))
    curve = fit_smooth_curve(along, joints, tolerance)
    length = float(along[-1])
    outer = np.linspace(0.0, _OUTER * length, 50)
    at_ends = _limits_at(np.concatenate([outer, length - outer]), curve, curve, feed, bounds)
    stations = _denser(_stations(length, _EVEN, at_ends), curve)
    problem = _problem(stations, curve, curve, feed, bounds)
    probes = np.concatenate([np.linspace(0.0, length, 400), curve.t])
    everywhere = _limits_at(probes, curve, curve, feed, bounds)
    start = _slow(problem.stations, length, everywhere)
    best: CurveSchedule | None = None
    for _ in range(_ROUNDS):
        b = greatest_speeds(problem, start)
        motion = _join_pieces(problem.stations, b, curve, length)
        found = _excess(motion, curve, feed, bounds)
        slowed = _slow_down(motion, found.by)
        if best is None or slowed.duration < best.duration:
            best = slowed
        if slowed.stretch <= 1 + _EXCESS:
            break
        allowed = b / found.around(problem.stations) ** 2
        problem = replace(problem, most=np.minimum(problem.most, allowed))
    assert best is not None
    return best


def _denser(stations: Array, curve: BSpline) -> Array:
    """Stations with more of them where the knots of a curve lie close, both ends as they are."""
    knots = np.unique(curve.t)
    inner = stations[_END:-_END]
    even = float(np.diff(inner).max())
    gaps = np.diff(knots)
    close = np.flatnonzero(gaps < _IN_GAP * even)
    shares = np.arange(_IN_GAP) / _IN_GAP
    more = (knots[close, None] + gaps[close, None] * shares).ravel()
    more = more[(more > inner[0]) & (more < inner[-1])]
    both = np.sort(np.concatenate([inner, more]))
    kept = np.concatenate([[True], np.diff(both) > _ONE * even])
    return np.concatenate([stations[:_END], both[kept], stations[-_END:]])


def _limits_at(probe: Array, curve: BSpline, tip: BSpline, feed: float, bounds: AxisBounds) -> Array:
    """Path velocity, acceleration and jerk that no axis minds at any of the places, (3,)."""
    qs, qss, qsss = (np.abs(curve(probe, order)).max(axis=0) + 1e-12 for order in (1, 2, 3))
    pace = float(np.linalg.norm(tip(probe, 1), axis=1).max())
    # Each term of an axis's acceleration and jerk gets a share of its limit: see `CurveSchedule.at`.
    a = 0.25 * float((bounds.acceleration / qs).min())
    j = 0.25 * float((bounds.jerk / qs).min())
    by_feed = 0.7 * feed / pace
    by_velocity = 0.7 * float((bounds.velocity / qs).min())
    by_acceleration = 0.5 * float(np.sqrt((bounds.acceleration / qss).min()))
    by_jerk = 0.5 * float(np.cbrt((bounds.jerk / qsss).min()))
    by_mixed_term = 0.25 * float((bounds.jerk / (3 * qss)).min()) / a
    return np.array([min(by_feed, by_velocity, by_acceleration, by_jerk, by_mixed_term), a, j])


def _first(limits: Array) -> float:
    """Way under the first jerk from rest where all axes go along, mm."""
    v, a, j = limits * np.array([1 / 0.7, 4.0, 4.0])
    time = min(np.sqrt(v / j), a / j)
    return float(j / 6 * time**3)


def _enough(length: float, limits: Array, points: int) -> int:
    """Stations enough for those at the ends to lie well inside the first jerk."""
    for_ends = 2 * _END * np.cbrt(length / (0.2 * _first(limits)))
    return int(np.clip(max(points, for_ends), 400, 200_000))


def _stations(length: float, count: int, limits: Array) -> Array:
    """Stations: steps grow with the 2/3 power of the distance to an end, as under constant jerk, then are even.

    They grow over as much of the path as it takes to put the first of them well inside the first jerk, up to an eighth.
    """
    inside = 0.1 * _first(limits)
    low = 0.0
    high = length / 8
    for _ in range(60):
        ramp = (low + high) / 2
        ends = (_END * (4 * ramp + length) / count) ** 3 / (27 * ramp * ramp)
        if ends < inside:
            high = ramp
        else:
            low = ramp
    half = 2 * high + length / 2
    u = np.linspace(0.0, 2 * half, count)
    near = np.minimum(u, 2 * half - u)
    way = np.where(near < 3 * high, near**3 / (27 * high**2), near - 2 * high)
    return np.asarray(np.where(u <= half, way, length - way))


def _problem(s: Array, curve: BSpline, tip: BSpline, feed: float, bounds: AxisBounds) -> SpeedProblem:
    """The linear forms at the stations, those at the ends folded into the first and the last unknown."""
    length = s[-1]
    inner = s[_END:-_END]
    acceleration = _acceleration_forms(inner, curve) / (_PLANNED * bounds.acceleration[:, None])
    wide = s[_END - 1:len(s) - _END + 1]
    jerk = _jerk_forms(wide, curve) / (_PLANNED * bounds.jerk[:, None])
    # Under the constant jerk from rest the squared speed grows with the way to the power of 4/3.
    jerk[0, :, 1] += jerk[0, :, 0] * (wide[0] / wide[1]) ** (4 / 3)
    jerk[-1, :, 1] += jerk[-1, :, 2] * ((length - wide[-1]) / (length - wide[-2])) ** (4 / 3)
    jerk[0, :, 0] = jerk[-1, :, 2] = 0.0
    with np.errstate(divide="ignore"):
        by_axes = (bounds.velocity / np.abs(curve(inner, 1))).min(axis=1)
        by_feed = feed / np.linalg.norm(tip(inner, 1), axis=1)
    most = (_PLANNED * np.minimum(by_axes, by_feed)) ** 2
    for end, zone, way in ((0, s[:_END + 1], inner[0]), (-1, s[-_END - 1:], length - inner[-1])):
        start = _PLANNED * float((bounds.jerk / np.maximum(np.abs(curve(zone, 1)), 1e-12)).min())
        most[end] = min(most[end], start ** (2 / 3) * (6 * way) ** (4 / 3) / 4)
    return SpeedProblem(inner, most, acceleration, jerk)


def _acceleration_forms(stations: Array, curve: BSpline) -> Array:
    """Accelerations of the axes half-way between stations, from the squared speeds at both: (n - 1, m, 2)."""
    middle = (stations[1:] + stations[:-1]) / 2
    step = np.diff(stations)[:, None]
    qs = curve(middle, 1)
    qss = curve(middle, 2)
    return np.stack([-qs / (2 * step) + qss / 2, qs / (2 * step) + qss / 2], axis=-1)


def _jerk_forms(stations: Array, curve: BSpline) -> Array:
    """Jerks of the axes over the speed at inner stations, from the squared speeds at three: (n - 2, m, 3)."""
    steps = np.diff(stations)[:, None]
    left = steps[:-1]
    right = steps[1:]
    qs, qss, qsss = (curve(stations[1:-1], order) for order in (1, 2, 3))
    low = 1 / (2 * left)
    high = 1 / (2 * right)
    curl = 2 / (left + right)
    before = low * (qs * curl - 1.5 * qss)
    here = qsss - (low + high) * qs * curl + 1.5 * qss * (low - high)
    behind = high * (qs * curl + 1.5 * qss)
    return np.stack([before, here, behind], axis=-1)


def _slow(inner: Array, length: float, limits: Array) -> Array:
    """Squared speeds at stations of a slow motion of seven segments."""
    motion = profile(length, *limits)
    grid = np.linspace(0, motion.duration, 2000)
    times = np.interp(inner, motion.at(grid)[:, 0], grid)
    for _ in range(8):
        state = motion.at(times)
        late = (state[:, 0] - inner) / np.maximum(state[:, 1], 1e-9)
        times = np.clip(times - late, 0, motion.duration)
    speeds = motion.at(times)[:, 1]
    return np.asarray(np.maximum(speeds, 1e-9) ** 2)


def _join_pieces(inner: Array, b: Array, curve: BSpline, length: float) -> CurveSchedule:
    """The motion in pieces of constant path jerk through the squared speeds, from rest to rest at the length."""
    v = np.sqrt(b)
    step = np.diff(inner)
    first = 3 * inner[0] / v[0]  # under constant jerk from rest the speed at the end is three times the mean
    last = 3 * (length - inner[-1]) / v[-1]
    spans = 2 * step / (v[1:] + v[:-1])
    nodes = first + np.concatenate([[0.0], np.cumsum(spans)])
    times = np.concatenate([[0.0], nodes[:-1] + spans / 2, [nodes[-1] + last]])
    a = np.concatenate([[0.0], np.diff(b) / (2 * step), [0.0]])
    # Two shapes of acceleration, small beside the plan's, make the motion end at the length and at rest.
    x = times / times[-1]
    shapes = [x * (1 - x), x * (1 - x) * (1 - 2 * x)]
    ends = np.array([_integrate_motion(times, shape)[-1, :2] for shape in shapes]).T
    missing = np.array([length, 0.0]) - _integrate_motion(times, a)[-1, :2]
    a = a + np.linalg.solve(ends, missing) @ np.array(shapes)
    return CurveSchedule(curve, times, _integrate_motion(times, a), 1.0)


def _integrate_motion(times: Array, a: Array) -> Array:
    """Way, velocity and acceleration from rest for accelerations that are linear between times, (k, 3)."""
    t = np.diff(times)
    jerk = np.diff(a) / t
    faster = t * (a[:-1] + a[1:]) / 2
    v = np.concatenate([[0.0], np.cumsum(faster)])
    farther = t * (v[:-1] + t * (a[:-1] / 2 + t * jerk / 6))
    s = np.concatenate([[0.0], np.cumsum(farther)])
    return np.stack([s, v, a], axis=1)


class _Excess(NamedTuple):
    """Places along a path, (n,), and by what factor a motion is too fast there, (n,)."""

    at: Array
    by: Array

    def around(self, stations: Array) -> Array:
        """The greatest factor next to each station, (n,), 1 at least."""
        behind = np.clip(np.searchsorted(stations, self.at), 1, len(stations) - 1)
        worst = np.ones(len(stations))
        for side in (behind - 1, behind):
            np.maximum.at(worst, side, self.by)
        beside = np.concatenate([[1.0], worst, [1.0]])
        return np.asarray(np.maximum(np.maximum(beside[:-2], beside[2:]), worst))


def _excess(plan: CurveSchedule, tip: BSpline, feed: float, bounds: AxisBounds) -> _Excess:
    """By what factor a motion is too fast for axes and feed, sampled in all its pieces."""
    times = plan.times
    inside = np.linspace(0, 1, _SAMPLES, endpoint=False) + 0.5 / _SAMPLES
    shares = np.concatenate([[0.0], inside, [1 - 1e-9]])  # jerk jumps where a piece ends: just before that
    between = times[:-1, None] + np.diff(times)[:, None] * shares
    sampled = np.append(between.reshape(-1), times[-1])
    _, v, a, j = plan.at(sampled)
    s, speed, _, _ = plan.path_at(sampled).T
    by_feed = np.linalg.norm(tip(s, 1), axis=1) * speed / feed
    by_velocity = (np.abs(v) / bounds.velocity).max(axis=1)
    by_acceleration = (np.abs(a) / bounds.acceleration).max(axis=1)
    by_jerk = (np.abs(j) / bounds.jerk).max(axis=1)
    return _Excess(s, np.maximum.reduce([by_feed, by_velocity, np.sqrt(by_acceleration), np.cbrt(by_jerk)]))


def _slow_down(plan: CurveSchedule, factors: Array) -> CurveSchedule:
    """A motion slowed down as a whole by the greatest of the factors."""
    stretch = max(1.0, float(factors.max()))
    return CurveSchedule(plan.curve, plan.times * stretch, plan.states / stretch ** np.arange(3), stretch)
