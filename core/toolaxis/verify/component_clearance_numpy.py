"""The plain twin of the clearance kernel."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.verify.material_removal_numpy import Motion, least_over_motion_numpy
from toolaxis.verify.revolved_solids import meridian_numpy

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_PAIRS = 200_000


def clear_numpy(body: tuple[Array, Motion], tables: tuple[Any, Array, Index], blocks: tuple[Array, Index, Index],
                out: tuple[Array, Index, Array, NDArray[np.bool_]], levels: tuple[float, Array, int, int]) -> None:
    """Distances of blocks of points from all motions, as far as they may be among the least.

    Parameters
    ----------
    body : (k, 7) array, and four (n, 3) arrays
        The solids; start, step, axis and turn of their motions.
    tables : groups (not used here), slack (n,), arrival (n,)
    blocks : ball (b, 4), first (b + 1,), and the order of the blocks
    out : value, by, point, counts; the first two are changed in place
    levels : least known distance, and for each point the margin above it within which its distance is wanted, mm;
        blocks from and to
    """
    ball, first, which = blocks
    _, slack, arrival = tables
    value, by, point, counts = out
    best, margin, low, high = levels
    solids, motion = body
    start, step, axis, turn = motion
    middle, lean = start + 0.5 * step, axis + 0.5 * turn
    lean = lean / np.linalg.norm(lean, axis=1, keepdims=True)
    for b in which[low:high]:
        w = ball[b, :3] - middle
        z = np.einsum("ij,ij->i", w, lean)
        rho = np.linalg.norm(w - z[:, None] * lean, axis=1)
        i = np.arange(first[b], first[b + 1])
        for solid in solids:
            bound = meridian_numpy(solid, rho, z)[0] - slack - ball[b, 3]
            order = np.argsort(bound, kind="stable")
            for k in np.array_split(order, max(1, len(order) * len(i) // _PAIRS)):
                k = k[bound[k] <= min(float(value[i].max()), best + float(margin[i].max()))]
                if len(k):
                    _approach((solid, motion), (i, k), point, (value, by), arrival)
        best = min(best, float(value[i][counts[i]].min(initial=np.inf)))


def _approach(body: tuple[Array, Motion], pair: tuple[Index, Index], point: Array, out: tuple[Array, Index],
              arrival: Index) -> None:
    i, k = pair
    solid, (start, step, axis, turn) = body
    row, column = np.repeat(i, len(k)), np.tile(k, len(i))
    ray = np.hstack([point[row], np.zeros((len(row), 3))])
    pairs = (solid, (start[column], step[column], axis[column], turn[column]), ray)
    least = least_over_motion_numpy(pairs, np.zeros(len(row)))[0].reshape(len(i), len(k))
    pick = np.argmin(least, axis=1)
    nearest = least[np.arange(len(i)), pick]
    better = nearest < out[0][i]
    out[0][i[better]], out[1][i[better]] = nearest[better], arrival[k[pick[better]]]
