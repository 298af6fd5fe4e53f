"""Time along a curved path by ramps between windows: on the safe side of `curve`, and hundreds of times as fast.

A controller with splines follows a smooth curve that passes all points within a tolerance.  The path is cut into
windows.  In each, curvature takes what it needs of the axes' accelerations and jerks at the window's greatest speed,
and the rest is for seven-segment ramps from one window to the next; of several numbers of windows the fastest counts.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, make_interp_spline, make_lsq_spline

from toolaxis.errors import InvalidInput
from toolaxis.feed.constraints import AxisBounds
from toolaxis.feed.polyline import look_ahead
from toolaxis.feed.profile import travel_time
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]

#: Degree of the curves.
_DEGREE = 5
#: Points to a knot at first, and places in a window at least and in all at most.
_POINTS, _PLACES, _MOST = 12, 4, 4096
#: Shares of jerk, at the greatest speed of a window, that the curve itself and its change of speed may take.
_CURVE, _CROSS = 1 / 3, 1 / 3
#: Share of an acceleration that the curve itself may take.
_BEND = 1 / 2
#: As good as nothing, for divisions.
_NOTHING = 1e-12


class Ramps(NamedTuple):
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


def ramps(points: ArrayLike, tips: ArrayLike, feed: float, bounds: AxisBounds, tolerance: float = 1e-3) -> Ramps:
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
    joints, rows = as_rows(points, len(bounds.velocity), "joint coordinates"), as_rows(tips, 3, "tips")
    if len(joints) != len(rows) or len(rows) <= _DEGREE:
        raise InvalidInput(f"{len(joints)} joint positions for {len(rows)} tips: six or more of each are needed")
    if not feed > 0:
        raise InvalidInput(f"feed is {feed} mm/s: it must be above zero")
    steps = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    if not (steps > 0).all():
        raise InvalidInput(f"points {int(np.argmin(steps))} and the next coincide: leave one out")
    along = np.concatenate([[0.0], np.cumsum(steps)])
    curve, knots = _smooth(along, joints, tolerance)
    count = int(np.clip(4 * knots, 16 * _PLACES, _MOST))
    s = (np.arange(count) + 0.5) * (along[-1] / count)
    sizes = [np.abs(curve(s, order)) + _NOTHING for order in (1, 2, 3)]
    return _fastest([_windowed(curve, float(along[-1]), 2**k, sizes, feed, bounds)
                     for k in range(0, 20, 2) if 2**k * _PLACES <= count])


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


def _windowed(curve: BSpline, length: float, number: int, sizes: list[Array], feed: float,
              bounds: AxisBounds) -> Ramps:
    """Ramps between a number of windows of one length."""
    count = len(sizes[0])
    which = np.arange(count) * number // count
    starts = np.searchsorted(which, np.arange(number))
    first, second, third = (np.maximum.reduceat(size, starts, axis=0) for size in sizes)
    top = np.minimum(feed, (bounds.velocity / first).min(axis=1))
    top = np.minimum(top, np.sqrt((_BEND * bounds.acceleration / second).min(axis=1)))
    top = np.minimum(top, np.cbrt((_CURVE * bounds.jerk / third).min(axis=1)))
    speed = top[:, None]
    a = np.minimum((bounds.acceleration - second * speed**2) / first, _CROSS * bounds.jerk / (3 * second * speed))
    a = a.min(axis=1)
    j = ((bounds.jerk - third * speed**3 - 3 * second * speed * a[:, None]) / first).min(axis=1)
    caps = np.concatenate([[0.0], np.minimum(top[:-1], top[1:]), [0.0]])
    borders = np.linspace(0.0, length, number + 1)
    return Ramps(curve, borders, look_ahead(np.diff(borders), a, j, caps), (top, a, j))


def _fastest(tries: list[Ramps]) -> Ramps:
    """The one that takes least; all are timed in one go."""
    ends = np.concatenate([one.speeds[:-1] for one in tries]), np.concatenate([one.speeds[1:] for one in tries])
    limits = [np.concatenate([one.limits[k] for one in tries]) for k in range(3)]
    times = travel_time(np.concatenate([np.diff(one.borders) for one in tries]), limits[0], limits[1], limits[2], ends)
    sizes = [len(one.speeds) - 1 for one in tries]
    return tries[int(np.argmin(np.add.reduceat(times, np.cumsum([0, *sizes[:-1]]))))]
