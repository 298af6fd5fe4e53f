"""What the mismatch of faces takes off a depth near an edge.

At a point it is the greatest of height * f(d) over the pieces of edges of its face, d the distance from the piece and f
one up to `REACH` and falling evenly to zero at twice that.  That is steady, so a cell has as good bounds of it as it is
small.  It is taken off depths only: a distance beyond the stock that is left on the faces stays as it is.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_fma_inline
from toolaxis.numeric.triples import Triple
from toolaxis.shape.seams import GREATEST, REACH

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Pieces of edges (k, 7), those of each face (faces + 1, 2), and the stock left on the faces: the fields of
#: `toolaxis.shape.seams.Mismatch`.
Relief: TypeAlias = tuple[Array, Indices, float]


def no_relief(faces: int) -> Relief:
    """Where nothing is taken off.

    Parameters
    ----------
    faces : int
        How many there are.
    """
    return np.empty((0, 7)), np.zeros((faces + 1, 2), dtype=np.int64), 0.0


@jit_fma_inline
def relieve_distance(distance: float, relief: float, stock: float) -> float:
    """A signed distance with what is taken off the depth below the stock that is left, mm."""
    return max(distance, min(distance + relief, stock))


@jit_fma_inline
def relieve_bounds(relief: Relief, ball: tuple[int, Triple, float], bounds: tuple[float, float, float],
                   ) -> tuple[float, float]:
    """Bounds of a signed distance over a cell, less deep by what is taken off there, mm.

    Most cells are spared the look at the edges: those that no relief brings up to what is wanted, and those too large
    or too far above for one that counts.

    Parameters
    ----------
    relief : tuple
    ball : (int, (float, float, float), float)
        Index of the face, -1 for several; centre and radius of a ball around the cell.
    bounds : (float, float, float)
        Lower and upper bound, and what is wanted.
    """
    face, centre, radius = ball
    lower, upper, wanted = bounds
    stock = relief[2]
    if face < 0:
        return lower, relieve_distance(upper, GREATEST, stock)
    helps = lower < min(wanted, stock) and lower + GREATEST >= wanted and radius < 2.0 * REACH
    if not helps and upper >= stock:
        return lower, upper
    less, more = relief_over(relief, face, centre, radius)
    return relieve_distance(lower, less, stock), relieve_distance(upper, more, stock)


@jit_fma_inline
def fading_share(distance: float) -> float:
    """Share of a height that counts at a distance from its edge."""
    return min(max(2.0 - distance / REACH, 0.0), 1.0)


@jit_fma_inline
def relief_over(relief: Relief, face: int, centre: Triple, radius: float) -> tuple[float, float]:
    """Least and greatest relief of the points of a face in a ball, mm.

    Parameters
    ----------
    relief : tuple
    face : int
        Index of the face; -1 for points of any face.
    centre : (float, float, float)
        mm
    radius : float
        mm
    """
    segment, span, _ = relief
    row = face if face >= 0 else span.shape[0] - 1
    least, greatest = 0.0, 0.0
    for k in range(span[row, 0], span[row, 1]):
        height = segment[k, 6]
        if height <= least:
            continue
        wx, wy, wz = centre[0] - segment[k, 0], centre[1] - segment[k, 1], centre[2] - segment[k, 2]
        dx, dy, dz = segment[k, 3] - segment[k, 0], segment[k, 4] - segment[k, 1], segment[k, 5] - segment[k, 2]
        size = dx * dx + dy * dy + dz * dz
        share = 0.0
        if size > 0.0:
            share = min(max((wx * dx + wy * dy + wz * dz) / size, 0.0), 1.0)
        wx, wy, wz = wx - share * dx, wy - share * dy, wz - share * dz
        square = wx * wx + wy * wy + wz * wz
        if square > (2.0 * REACH + radius) ** 2:
            continue
        away = np.sqrt(square)
        greatest = max(greatest, height * fading_share(away - radius))
        least = max(least, height * fading_share(away + radius))
    if face < 0:
        least = 0.0
    return least, greatest


def relief_over_numpy(relief: Relief, face: Indices, centre: Array, radius: Array) -> tuple[Array, Array]:
    """The plain twin of `relief_over`, for many balls.

    Parameters
    ----------
    relief : tuple
    face : (n,) array of int
    centre : (n, 3) array
        mm
    radius : (n,) array
        mm
    """
    segment, span, _ = relief
    least, greatest = np.zeros(len(face)), np.zeros(len(face))
    for row in np.unique(face):
        rows, (first, end) = np.flatnonzero(face == row), span[row]
        if first == end:
            continue
        some = segment[first:end]
        course = some[:, 3:6] - some[:, :3]
        size = (course**2).sum(axis=1)
        apart = centre[rows, None] - some[:, :3]
        share = np.clip(np.einsum("nkc,kc->nk", apart, course) / np.where(size > 0, size, 1.0), 0.0, 1.0)
        away = np.linalg.norm(apart - share[..., None] * course, axis=2)
        near, far = (np.clip(2.0 - (away + sign * radius[rows, None]) / REACH, 0.0, 1.0) for sign in (-1, 1))
        greatest[rows] = (some[:, 6] * near).max(axis=1)
        least[rows] = (some[:, 6] * far).max(axis=1) if row >= 0 else 0.0
    return least, greatest
