"""Polylines with fewer points: none that is left out is farther from the line than a bound (Douglas and Peucker)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def simplify_polyline(points: Array, bound: float) -> NDArray[np.int64]:
    """Which points of a polyline to keep.

    Parameters
    ----------
    points : (n, k) array
    bound : float
        Greatest distance of a point that is left out from the segment that takes its place, in the points' unit.

    Returns
    -------
    (m,) array of int
        Rising; the first and the last point are kept.  Two points or fewer are all kept.

    Notes
    -----
    **Properties**: 1. every point lies within the bound of the line that is left; 2. a bound below zero keeps all.
    """
    rows = np.asarray(points, dtype=float)
    count = len(rows)
    if count <= 2 or bound < 0:
        return np.arange(count)
    kept = np.zeros(count, dtype=bool)
    kept[[0, -1]] = True
    waiting = [(0, count - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        off = _distances(rows[first + 1:last], rows[first], rows[last])
        worst = int(np.argmax(off))
        if off[worst] > bound:
            middle = first + 1 + worst
            kept[middle] = True
            waiting += [(first, middle), (middle, last)]
    return np.flatnonzero(kept)


def simplify_loop(points: Array, bound: float) -> NDArray[np.int64]:
    """Which vertices of a closed polygon to keep: three at least.

    Parameters
    ----------
    points : (n, k) array
        The last one does not repeat the first.
    bound : float
        As for `simplify_polyline`.
    """
    rows = np.asarray(points, dtype=float)
    if len(rows) <= 3:
        return np.arange(len(rows))
    far = int(np.argmax(((rows - rows[0])**2).sum(axis=1)))
    if far == 0:
        return np.arange(3)
    there = simplify_polyline(rows[:far + 1], bound)
    back = far + simplify_polyline(np.vstack([rows[far:], rows[:1]]), bound)[:-1]
    kept = np.unique(np.concatenate([there, back]))
    if len(kept) < 3:
        off = _distances(rows, rows[0], rows[far])
        off[[0, far]] = -1.0
        kept = np.unique([0, far, int(np.argmax(off))])
    return kept


def _distances(points: Array, start: Array, end: Array) -> Array:
    """Distances of points to a segment, (n,)."""
    way = end - start
    square = float(way @ way)
    share = np.clip((points - start) @ way / square, 0.0, 1.0) if square > 0 else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - start - share[:, None] * way, axis=1))
