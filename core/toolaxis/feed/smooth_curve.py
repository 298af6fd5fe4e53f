"""The smooth curve that a control follows near the points of a program: splines of few knots within a tolerance."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline, make_lsq_spline

Array = NDArray[np.float64]

#: Degree of the curves, points to a knot at first, and how often gaps between knots are halved.
DEGREE, _APART, _HALVED = 5, 16, 8
#: Weight of both ends of a curve, which it must not miss.
_ENDS = 1e4


def fit_smooth_curve(places: Array, poses: Array, room: ArrayLike, left: int = 2) -> BSpline:
    """A smooth curve near poses with few knots: more of them where it needs them to keep near.

    Parameters
    ----------
    places : (n,) array
        Parameters of the poses, ascending, n of at least 6.
    poses : (n, d) array
    room : (n, d) array_like, or one number for all
        By how much the curve may miss them, both ends apart, which it meets; where gaps between knots hold too few
        points to be halved, it may miss them by more.
    left : int
        Points that a gap between knots must keep.
    """
    inner, weight = places[_APART:-_APART:_APART], np.ones(len(places))
    weight[[0, -1]] = _ENDS
    for _ in range(_HALVED):
        knots = np.concatenate([np.full(DEGREE + 1, places[0]), inner, np.full(DEGREE + 1, places[-1])])
        curve = make_lsq_spline(places, poses, knots, DEGREE, weight)
        missed = (np.abs(curve(places) - poses) > room).any(axis=1)
        edges = np.concatenate([places[:1], inner, places[-1:]])
        gap = np.clip(np.searchsorted(edges, places, side="right") - 1, 0, len(inner))
        counts = np.bincount(gap, minlength=len(inner) + 1)
        bad = np.flatnonzero((np.bincount(gap, missed, len(inner) + 1) > 0) & (counts >= 2 * left))
        if not len(bad):
            break
        first = np.searchsorted(gap, bad)
        inner = np.sort(np.concatenate([inner, places[first + counts[bad] // 2]]))
    return curve
