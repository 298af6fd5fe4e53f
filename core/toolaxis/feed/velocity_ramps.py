"""Time along a curved path by ramps between windows, for many set-ups of a machine at once: an estimate, too long.

The fastest motion is that of `time_optimal.schedule_near`; a search compares many set-ups by this one.  A control with
splines follows a smooth curve that passes all points within a tolerance.  The path is cut into
windows.  In each, curvature takes what it needs of the axes' accelerations and jerks at the window's greatest speed,
and the rest is for seven-segment ramps from one window to the next; of several numbers of windows the fastest counts.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_lsq_spline

from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import AxisBounds, check_path
from toolaxis.feed.polyline import look_ahead
from toolaxis.feed.smooth_curve import DEGREE, fit_smooth_curve

Array = NDArray[np.float64]

#: Places in a window at least, and in all at most.
_PLACES, _MOST = 4, 4096
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
    length : float
        Of the path parameter, mm.
    derivatives : three (n, d) or (k, n, d) arrays
        First, second and third derivative along the path at even places of the parameter.
    stretch : (k, n) array, optional
        What the path goes for one mm of the parameter; 1 unless given.
    """

    length: float
    derivatives: tuple[Array, Array, Array]
    stretch: Array | None = None


def durations(bend: CurveShape, joint_from_path: ArrayLike, feed: float, bounds: AxisBounds) -> Array:
    """Time along a curve with the axes set up in k ways, (k,) s.

    Parameters
    ----------
    bend : CurveShape
    joint_from_path : (k, m, d) array_like
        What the axes move for a motion along the curve's coordinates.
    feed : float
        Programmed velocity of the tip, mm/s; infinite for as fast as the axes go.
    bounds : AxisBounds

    Notes
    -----
    **Property**: never less than the fastest motion takes; up to a fourth more on passes of even bends, and half as
    much again where a pass bends much at some places.
    """
    matrices = np.asarray(joint_from_path, dtype=float)
    best = np.full(len(matrices), np.inf)
    places = bend.derivatives[0].shape[-2]
    for begin in range(0, len(matrices), _BATCH):
        some = slice(begin, begin + _BATCH)
        for number in _numbers(places):
            windows = _ramps_in_windows(matrices[some], bend, number, feed, bounds)
            best[some] = np.minimum(best[some], _times(windows))
    return best


def bend_of(points: ArrayLike, tips: ArrayLike, feed: float, width: int = 3, tolerance: float = 1e-3) -> CurveShape:
    """The smooth curve that a controller follows past points.

    Parameters
    ----------
    points : (n, width) array_like
        Coordinates, mm or rad, n of at least 6, on a curve without corners.
    tips : (n, 3) array_like
        Tool tips there, mm, no two neighbours the same.
    feed : float
        As for `durations`.
    width : int
        Number of coordinates.
    tolerance : float
        How far the curve may pass the points, mm or rad.

    Raises
    ------
    InvalidInput
        When shapes do not fit, points coincide, or the feed is not above zero.
    """
    joints, _, along = check_path(points, tips, feed, width)
    curve = fit_smooth_curve(along, joints, tolerance)
    length = along[-1]
    knots = len(np.unique(curve.t))
    places = int(np.clip(_PLACES * knots, 16 * _PLACES, _MOST))
    s = (np.arange(places) + 0.5) * (length / places)
    first, second, third = (np.asarray(curve(s, order)) for order in (1, 2, 3))
    return CurveShape(float(length), (first, second, third))


def bends_of(points: ArrayLike, along: ArrayLike) -> CurveShape:
    """Smooth curves near points that belong to the same parameters, one for each of k ways to go, with few knots.

    Parameters
    ----------
    points : (k, n, 3) array_like
        Tool tips, mm, n of at least 8.
    along : (n,) array_like
        Parameters, ascending, mm.
    """
    rows = np.asarray(points, dtype=float)
    places = np.asarray(along, dtype=float)
    ways, n, _ = rows.shape
    begin = places[0]
    end = places[-1]
    inner = places[_APART:-_APART:_APART]
    knots = np.concatenate([np.full(DEGREE + 1, begin), inner, np.full(DEGREE + 1, end)])
    by_place = rows.swapaxes(0, 1).reshape(n, -1)
    curve = make_lsq_spline(places, by_place, knots, DEGREE)
    number = int(np.clip(n, 16 * _PLACES, _MOST))
    step = (end - begin) / number
    s = begin + (np.arange(number) + 0.5) * step
    first, second = (np.asarray(curve(s, order)).reshape(number, ways, 3).swapaxes(0, 1) for order in (1, 2))
    stretch = np.linalg.norm(first, axis=2)
    pace = np.maximum(stretch, _NOTHING)[..., None]
    way = first / pace
    along_way = (way * second).sum(axis=2, keepdims=True)
    across = second - along_way * way
    bent = across / pace**2
    change = np.gradient(bent, s, axis=1) / pace
    return CurveShape(float(end - begin), (way, bent, change), stretch)


def greatest_speeds(bend: CurveShape, joint_from_path: ArrayLike, feed: float, bounds: AxisBounds) -> Array:
    """Speed along k curves that their bends allow at even places of the parameter, (k, n) mm/s.

    Parameters
    ----------
    bend, joint_from_path, feed, bounds
        As for `durations`.
    """
    matrices = np.asarray(joint_from_path, dtype=float)
    joints = _joint_derivatives(bend, matrices)
    return _tops(joints, feed, bounds, 1.0, 1.0)


class _JointDerivatives(NamedTuple):
    """Sizes of the axes' derivatives along the path in k set-ups at n places, above 0, (k, n, m) each."""

    first: Array
    second: Array
    third: Array


def _joint_derivatives(bend: CurveShape, matrices: Array) -> _JointDerivatives:
    """What the axes move along a curve with set-ups (k, m, d)."""
    turned = matrices.swapaxes(1, 2)
    first, second, third = (np.abs(rows @ turned) + _NOTHING for rows in bend.derivatives)
    return _JointDerivatives(first, second, third)


def _tops(joints: _JointDerivatives, feed: float, bounds: AxisBounds, of_acceleration: float,
          of_jerk: float) -> Array:
    """Greatest speeds at which a curve takes no more than shares of accelerations and jerks."""
    by_velocity = (bounds.velocity / joints.first).min(axis=2)
    square = (of_acceleration * bounds.acceleration / joints.second).min(axis=2)
    cube = (of_jerk * bounds.jerk / joints.third).min(axis=2)
    top = np.minimum(feed, by_velocity)
    top = np.minimum(top, np.sqrt(square))
    return np.asarray(np.minimum(top, np.cbrt(cube)))


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
    places = bend.derivatives[0].shape[-2]
    window = np.arange(places) * number // places
    starts = np.searchsorted(window, np.arange(number))
    joints = _joint_derivatives(bend, matrices)
    first, second, third = (np.maximum.reduceat(each, starts, axis=1) for each in joints)
    top = _tops(_JointDerivatives(first, second, third), feed, bounds, _BEND, _CURVE)
    speed = top[..., None]
    # What the bend leaves of the limits at the greatest speed is for the ramps.
    by_acceleration = (bounds.acceleration - second * speed**2) / first
    by_jerk = _CROSS * bounds.jerk / (3 * second * speed)
    a = np.minimum(by_acceleration, by_jerk).min(axis=2)
    left = bounds.jerk - third * speed**3 - 3 * second * speed * a[..., None]
    j = (left / first).min(axis=2)
    caps = np.zeros((len(top), number + 1))
    caps[:, 1:-1] = np.minimum(top[:, :-1], top[:, 1:])
    run = np.full(a.shape, bend.length / number)
    starting = np.append(caps[:, :-1].reshape(-1), 0.0)
    chain = look_ahead(run.reshape(-1), a.reshape(-1), j.reshape(-1), starting)
    caps[:, :-1] = chain[:-1].reshape(len(top), number)  # each set-up begins and ends at rest: one chain serves all
    return _Windows(run, caps, (top, a, j))


def _times(windows: _Windows) -> Array:
    """Time of each set-up, (k,) s."""
    ends = (windows.speeds[:, :-1], windows.speeds[:, 1:])
    times = travel_time(windows.run, *windows.limits, ends)
    return np.asarray(times.sum(axis=1))
