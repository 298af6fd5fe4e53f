"""Time along a curved path by ramps between windows: on the safe side of `curve`, and hundreds of times as fast.

A controller with splines follows a smooth curve that passes all points within a tolerance.  The path is cut into
windows.  In each, curvature takes what it needs of the axes' accelerations and jerks at the window's greatest speed,
and the rest is for seven-segment ramps from one window to the next; of several numbers of windows the fastest counts.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, make_interp_spline, make_lsq_spline

from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import AxisBounds, check_path
from toolaxis.feed.polyline import look_ahead

Array = NDArray[np.float64]

#: Degree of the curves.
_DEGREE = 5
#: Points to a knot at first, and places in a window at least and in all at most.
_POINTS, _PLACES, _MOST = 12, 4, 4096
#: Points to a knot of curves that need not pass near points.
_APART = 9
#: Shares of jerk, at the greatest speed of a window, that the curve itself and its change of speed may take.
_CURVE, _CROSS = 1 / 3, 1 / 3
#: Share of an acceleration that the curve itself may take.
_BEND = 1 / 2
#: Set-ups that are timed in one go.
_BATCH = 512
#: As good as nothing, for divisions.
_NOTHING = 1e-12


class CurveShape(NamedTuple):
    """A smooth curve and how it bends, or several over one parameter.

    Attributes
    ----------
    curve : BSpline
        Coordinates over the path parameter, mm or rad.
    length : float
        Of the path parameter, mm.
    derivatives : three (n, d) or (k, n, d) arrays
        First, second and third derivative along the path at even places of the parameter.
    stretch : (k, n) array, optional
        What the path goes for one mm of the parameter; 1 unless given.
    """

    curve: BSpline
    length: float
    derivatives: tuple[Array, Array, Array]
    stretch: Array | None = None


class VelocityRamps(NamedTuple):
    """Speeds along windows of a curve.

    Attributes
    ----------
    curve : BSpline
        Axis positions over the path parameter, mm or rad.
    borders : (k + 1,) array
        Path parameters where the windows meet.
    speeds : (k + 1,) array
        Path speed there, mm/s; 0 at both ends.
    limits : three (k,) arrays
        Velocity, acceleration and jerk along the path in each window.
    """

    curve: BSpline
    borders: Array
    speeds: Array
    limits: tuple[Array, Array, Array]

    @property
    def times(self) -> Array:
        """Time of each window, (k,) s."""
        return travel_time(np.diff(self.borders), *self.limits, (self.speeds[:-1], self.speeds[1:]))

    @property
    def duration(self) -> float:
        """s."""
        return float(self.times.sum())


def ramps(points: ArrayLike, tips: ArrayLike, feed: float, bounds: AxisBounds,
          tolerance: float = 1e-3) -> VelocityRamps:
    """Speeds from rest to rest along a smooth curve through axis positions.

    Parameters
    ----------
    points : (n, m) array_like
        Axis positions, mm or rad, n of at least 6, on a curve without corners.
    tips : (n, 3) array_like
        Tool tips there, mm, no two neighbours the same.
    feed : float
        Programmed velocity of the tip, mm/s; infinite for as fast as the axes go.
    bounds : AxisBounds
    tolerance : float
        How far the curve may pass the points, mm or rad; 0 to pass through them.

    Raises
    ------
    InvalidInput
        When shapes do not fit, points coincide, or the feed is not above zero.

    Notes
    -----
    Properties: (1) no axis exceeds a limit; (2) never faster than the optimum that `curve` seeks, and on passes of
    finishing within some percent of it.
    """
    bend = bend_of(points, tips, feed, len(bounds.velocity), tolerance)
    tries = [_ramps_in_windows(np.eye(len(bounds.velocity))[None], bend, number, feed, bounds)
             for number in _numbers(bend.derivatives[0].shape[-2])]
    best = tries[int(np.argmin([float(_times(one).sum()) for one in tries]))]
    number = best.limits[0].shape[1]
    return VelocityRamps(bend.curve, np.linspace(0.0, bend.length, number + 1), best.speeds[0],
                         (best.limits[0][0], best.limits[1][0], best.limits[2][0]))


def durations(bend: CurveShape, joint_from_path: ArrayLike, feed: float, bounds: AxisBounds) -> Array:
    """Time along one curve, or k curves, with the axes set up in k ways, (k,) s: that of `ramps` for each.

    Parameters
    ----------
    bend : CurveShape
    joint_from_path : (k, m, d) array_like
        What the axes move for a motion along the curve's coordinates.
    feed : float
        As for `ramps`.
    bounds : AxisBounds
    """
    matrices = np.asarray(joint_from_path, dtype=float)
    best = np.full(len(matrices), np.inf)
    for begin in range(0, len(matrices), _BATCH):
        some = slice(begin, begin + _BATCH)
        part = bend
        if bend.derivatives[0].ndim == 3:
            first, second, third = (rows[some] for rows in bend.derivatives)
            part = bend._replace(derivatives=(first, second, third),
                                 stretch=None if bend.stretch is None else bend.stretch[some])
        for number in _numbers(bend.derivatives[0].shape[-2]):
            best[some] = np.minimum(best[some], _times(_ramps_in_windows(matrices[some], part, number, feed, bounds)))
    return best


def bend_of(points: ArrayLike, tips: ArrayLike, feed: float, width: int = 3, tolerance: float = 1e-3) -> CurveShape:
    """The smooth curve that a controller follows past points.

    Parameters
    ----------
    points, tips, feed, tolerance
        As for `ramps`.
    width : int
        Number of coordinates.

    Raises
    ------
    InvalidInput
        As `ramps`.
    """
    joints, _, along = check_path(points, tips, feed, width)
    curve, knots = _smooth(along, joints, tolerance)
    count = int(np.clip(4 * knots, 16 * _PLACES, _MOST))
    s = (np.arange(count) + 0.5) * (along[-1] / count)
    first, second, third = (np.asarray(curve(s, order)) for order in (1, 2, 3))
    return CurveShape(curve, float(along[-1]), (first, second, third))


def bends_of(points: ArrayLike, along: ArrayLike) -> CurveShape:
    """Smooth curves near points that belong to the same parameters, one for each of k ways to go, with few knots.

    Parameters
    ----------
    points : (k, n, 3) array_like
        Tool tips, mm, n of at least 8.
    along : (n,) array_like
        Parameters, ascending, mm.
    """
    rows, places = np.asarray(points, dtype=float), np.asarray(along, dtype=float)
    count, n, _ = rows.shape
    inner = places[_APART:-_APART:_APART]
    knots = np.concatenate([np.full(_DEGREE + 1, places[0]), inner, np.full(_DEGREE + 1, places[-1])])
    curve = make_lsq_spline(places, rows.swapaxes(0, 1).reshape(n, -1), knots, _DEGREE)
    count_of = int(np.clip(n, 16 * _PLACES, _MOST))
    s = places[0] + (np.arange(count_of) + 0.5) * ((places[-1] - places[0]) / count_of)
    first, second = (np.asarray(curve(s, order)).reshape(len(s), count, 3).swapaxes(0, 1) for order in (1, 2))
    stretch = np.linalg.norm(first, axis=2)
    pace = np.maximum(stretch, _NOTHING)[..., None]
    way = first / pace
    bent = (second - (way * second).sum(axis=2, keepdims=True) * way) / pace**2
    return CurveShape(curve, float(places[-1] - places[0]), (way, bent, np.gradient(bent, s, axis=1) / pace), stretch)


def _smooth(along: Array, joints: Array, tolerance: float) -> tuple[BSpline, int]:
    """A curve within the tolerance of the points, with few knots, and their number; else one through the points."""
    apart = _POINTS
    while apart > 2 and tolerance > 0:
        inner = along[apart:-apart:apart]
        knots = np.concatenate([np.full(_DEGREE + 1, along[0]), inner, np.full(_DEGREE + 1, along[-1])])
        curve = make_lsq_spline(along, joints, knots, _DEGREE)
        if np.abs(curve(along) - joints).max() <= tolerance:
            return curve, len(inner) + 1
        apart //= 2
    return make_interp_spline(along, joints, _DEGREE), len(along)


def greatest_speeds(bend: CurveShape, joint_from_path: ArrayLike, feed: float, bounds: AxisBounds) -> Array:
    """Speed along k curves that their bends allow at even places of the parameter, (k, n) mm/s.

    Parameters
    ----------
    bend, joint_from_path, feed, bounds
        As for `durations`.
    """
    matrices = np.asarray(joint_from_path, dtype=float).swapaxes(1, 2)
    first, second, third = (np.abs(rows @ matrices) + _NOTHING for rows in bend.derivatives)
    return _tops(first, second, third, feed, bounds)


def _tops(first: Array, second: Array, third: Array, feed: float, bounds: AxisBounds) -> Array:
    """Greatest speeds at which a curve takes no more than its shares of the axes' limits; its derivatives above 0."""
    top = np.minimum(feed, (bounds.velocity / first).min(axis=2))
    top = np.minimum(top, np.sqrt((_BEND * bounds.acceleration / second).min(axis=2)))
    return np.asarray(np.minimum(top, np.cbrt((_CURVE * bounds.jerk / third).min(axis=2))))


class _Windows(NamedTuple):
    """Ramps of k set-ups: lengths of windows (k, w), speeds (k, w + 1) and limits (k, w)."""

    run: Array
    speeds: Array
    limits: tuple[Array, Array, Array]


def _numbers(count: int) -> list[int]:
    """Numbers of windows that are tried."""
    return [4**k for k in range(10) if 4**k * _PLACES <= count]


def _ramps_in_windows(matrices: Array, bend: CurveShape, number: int, feed: float, bounds: AxisBounds) -> _Windows:
    """Ramps between a number of windows of one length."""
    count = bend.derivatives[0].shape[-2]
    starts = np.searchsorted(np.arange(count) * number // count, np.arange(number))
    first, second, third = (np.maximum.reduceat(np.abs(rows @ matrices.swapaxes(1, 2)) + _NOTHING, starts, axis=1)
                            for rows in bend.derivatives)
    top = _tops(first, second, third, feed, bounds)
    speed = top[..., None]
    a = np.minimum((bounds.acceleration - second * speed**2) / first, _CROSS * bounds.jerk / (3 * second * speed))
    a = a.min(axis=2)
    j = ((bounds.jerk - third * speed**3 - 3 * second * speed * a[..., None]) / first).min(axis=2)
    caps = np.zeros((len(top), number + 1))
    caps[:, 1:-1] = np.minimum(top[:, :-1], top[:, 1:])
    run = np.full(a.shape, bend.length / number)
    if bend.stretch is not None:
        run = np.add.reduceat(bend.stretch, starts, axis=1) * (bend.length / count)
    chain = look_ahead(run.reshape(-1), a.reshape(-1), j.reshape(-1), np.append(caps[:, :-1].reshape(-1), 0.0))
    caps[:, :-1] = chain[:-1].reshape(len(top), number)  # each set-up begins and ends at rest: one chain serves all
    return _Windows(run, caps, (top, a, j))


def _times(windows: _Windows) -> Array:
    """Time of each set-up, (k,) s."""
    ends = (windows.speeds[:, :-1], windows.speeds[:, 1:])
    return np.asarray(travel_time(windows.run, *windows.limits, ends).sum(axis=1))
