"""The smallest cap of the unit sphere that holds given directions."""

from itertools import combinations
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import angle_between

Array = NDArray[np.float64]


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
        away = np.sum((vectors - centre) ** 2, axis=1)
        far = int(np.argmax(away))
        if away[far] <= square * (1 + 1e-12) + 1e-18:
            break
        support, centre, square = _ball(vectors, np.append(support, far))
    size = float(np.linalg.norm(centre))
    if size <= 1e-7:
        return Cap(np.zeros(3), pi / 2, support)
    middle = centre / size
    return Cap(middle, float(angle_between(vectors[support], middle).max()), support)


def _ball(vectors: Array, rows: NDArray[np.intp]) -> tuple[NDArray[np.intp], Array, float]:
    """Smallest ball around at most five points: the smallest circumscribed ball of a subset that holds them all."""
    best: tuple[NDArray[np.intp], Array, float] = (rows, np.zeros(3), np.inf)
    for count in range(1, min(len(rows), 4) + 1):
        for chosen in combinations(range(len(rows)), count):
            some = vectors[rows[list(chosen)]]
            edges = some[1:] - some[0]
            offset = np.linalg.lstsq(2 * edges, np.sum(edges**2, axis=1), rcond=None)[0] if count > 1 else np.zeros(3)
            square = float(offset @ offset)
            inside = np.sum((vectors[rows] - some[0] - offset) ** 2, axis=1) <= square * (1 + 1e-10) + 1e-18
            if square < best[2] and inside.all():
                best = rows[list(chosen)], some[0] + offset, square
    return best
