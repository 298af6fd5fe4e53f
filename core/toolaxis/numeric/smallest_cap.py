"""The smallest cap of the unit sphere that holds given directions."""

from functools import cache
from itertools import combinations
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import angle_between

Array = NDArray[np.float64]

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


class Cap(NamedTuple):
    """The smallest cap of the unit sphere around unit vectors: centre (3,), radius in rad, and the vectors on its rim.

    A radius of pi / 2 with a centre of zeros means that no open hemisphere holds them.
    """

    centre: Array
    radius: float
    rim: NDArray[np.intp]


def smallest_cap(vectors: Array) -> Cap:
    """The smallest cap around unit vectors.

    Parameters
    ----------
    vectors : (n, 3) array

    Notes
    -----
    It is where their smallest enclosing ball meets the sphere; the ball's centre is 0 when no hemisphere holds them.

    **Properties**: 1. every vector is inside, to 1e-9; 2. at least two are on the rim unless all are equal.
    """
    support = np.array([0], dtype=np.intp)
    centre, square = vectors[0], 0.0
    for _ in range(200):
        # Of points at the same distance from the origin the farthest one is the one that is least far along the centre.
        far = int(np.argmin(vectors @ centre))
        if np.sum((vectors[far] - centre) ** 2) <= square * (1 + 1e-12) + 1e-18:
            break
        support, centre, square = _ball(vectors, np.append(support, far))
    size = float(np.linalg.norm(centre))
    if size <= 1e-7:
        return Cap(np.zeros(3), pi / 2, support)
    middle = centre / size
    return Cap(middle, float(angle_between(vectors[support], middle).max()), support)


def _ball(vectors: Array, rows: NDArray[np.intp]) -> tuple[NDArray[np.intp], Array, float]:
    """Smallest ball around at most five points: the smallest circumscribed ball of a subset that holds them all."""
    points = vectors[rows]
    best: tuple[NDArray[np.intp], Array, float] = (rows, np.zeros(3), np.inf)
    for count in range(1, min(len(rows), 4) + 1):
        subsets = _subsets(len(rows), count)
        some = points[subsets]
        centres = some[:, 0] + _offsets(some)
        squares = np.sum((some[:, 0] - centres) ** 2, axis=1)
        away = np.sum((points - centres[:, None]) ** 2, axis=2)
        inside = (away <= squares[:, None] * (1 + 1e-10) + 1e-18).all(axis=1)
        squares = np.where(inside, squares, np.inf)
        k = int(np.argmin(squares))
        if squares[k] < best[2]:
            best = rows[subsets[k]], centres[k], float(squares[k])
    return best


@cache
def _subsets(size: int, count: int) -> NDArray[np.intp]:
    """All choices of some of the numbers from 0, (m, count)."""
    return np.array(list(combinations(range(size), count)), dtype=np.intp)


def _offsets(some: Array) -> Array:
    """From the first of k unit vectors, (m, k, 3), to the centre of the smallest ball with all of them on it, (m, 3).

    Four that lie on one circle have it of three of them, all others of the whole sphere.
    """
    count = some.shape[1]
    if count == 1:
        return np.zeros((len(some), 3))
    if count == 4:
        return -some[:, 0]
    first = some[:, 1] - some[:, 0]
    if count == 2:
        return np.asarray(0.5 * first)
    second = some[:, 2] - some[:, 0]
    normal = _across(first, second)
    across = (np.sum(second**2, axis=1)[:, None] * _across(normal, first)
              + np.sum(first**2, axis=1)[:, None] * _across(second, normal))
    size = np.sum(normal**2, axis=1)[:, None]
    # Two of three that are the same have a ball as a pair.
    return np.asarray(np.divide(across, 2 * size, out=np.full_like(across, np.inf), where=size > 0))


def _across(a: Array, b: Array) -> Array:
    """Cross products, (m, 3): in a few rows much quicker than numpy's."""
    return np.asarray(a[:, _NEXT] * b[:, _LAST] - a[:, _LAST] * b[:, _NEXT])
