"""What trim loops leave of a rectangle of parameters inside one leaf of a face's cells."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
# centre u, v and half widths
Rect: TypeAlias = tuple[float, float, float, float]


@jit_fma_inline
def clip_edges(edges: Array, rect: Rect, corners: Array) -> int:
    """Ends of the parts of trim edges that run through the inner part of a rectangle.

    Parameters
    ----------
    edges : (k, 4) array
        u, v of both ends.
    rect : (float, float, float, float)
        Centre and half widths.
    corners : (2 k + 4, 2) array
        Receives the ends.

    Returns
    -------
    int
        How many ends were written.
    """
    count = 0
    for k in range(edges.shape[0]):
        enter, leave = 0.0, 1.0
        for axis in range(2):
            start, along = edges[k, axis] - rect[axis], edges[k, 2 + axis] - edges[k, axis]
            half = rect[2 + axis] * (1.0 - 1e-9)
            if along == 0.0:
                if abs(start) >= half:
                    leave = -1.0
            else:
                first, second = (-half - start) / along, (half - start) / along
                enter, leave = max(enter, min(first, second)), min(leave, max(first, second))
        if enter < leave:
            for share in (enter, leave):
                for axis in range(2):
                    corners[count, axis] = edges[k, axis] + share * (edges[k, 2 + axis] - edges[k, axis])
                count += 1
    return count


@jit
def inside_leaf(edges: Array, reference: Array, u: float, v: float) -> bool:
    """Whether a point of a leaf's rectangle lies inside the loops: crossings of the way from the reference point.

    Parameters
    ----------
    edges : (k, 4) array
        Trim edges through the leaf.
    reference : (3,) array
        u, v and whether that point is inside (1 or 0).
    u, v : float
    """
    within = bool(reference[2] > 0.5)
    x0, y0 = reference[0], reference[1]
    dx, dy = u - x0, v - y0
    for k in range(edges.shape[0]):
        first = dx * (edges[k, 1] - y0) - dy * (edges[k, 0] - x0) > 0.0
        second = dx * (edges[k, 3] - y0) - dy * (edges[k, 2] - x0) > 0.0
        if first != second:
            ex, ey = edges[k, 2] - edges[k, 0], edges[k, 3] - edges[k, 1]
            here = ex * (y0 - edges[k, 1]) - ey * (x0 - edges[k, 0]) > 0.0
            there = ex * (v - edges[k, 1]) - ey * (u - edges[k, 0]) > 0.0
            if here != there:
                within = not within
    return within


@jit_fma_inline
def edge_touches(edges: Array, rect: Rect) -> bool:
    """Whether an edge comes into a small rectangle, or within rounding of it.

    Parameters
    ----------
    edges : (k, 4) array
        u, v of both ends.
    rect : (float, float, float, float)
        Centre and half widths.
    """
    for k in range(edges.shape[0]):
        enter, leave = 0.0, 1.0
        for axis in range(2):
            start, along = edges[k, axis] - rect[axis], edges[k, 2 + axis] - edges[k, axis]
            half = rect[2 + axis] + 4e-15 * (abs(edges[k, axis]) + abs(edges[k, 2 + axis]))
            if along == 0.0:
                if abs(start) > half:
                    leave = -1.0
            else:
                first, second = (-half - start) / along, (half - start) / along
                enter, leave = max(enter, min(first, second)), min(leave, max(first, second))
        if enter <= leave:
            return True
    return False


@jit_fma_inline
def shrunk(region: Array, count: int, axis: int, least: float) -> tuple[float, float]:
    """Middle and half width of corners along u or v; the corners become shares of it.

    Parameters
    ----------
    region : (k, 2) array
    count : int
    axis : int
    least : float
        Added to the half width.
    """
    low, high = np.inf, -np.inf
    for k in range(count):
        low, high = min(low, region[k, axis]), max(high, region[k, axis])
    middle, half = (low + high) / 2.0, (high - low) / 2.0 + least
    for k in range(count):
        region[k, axis] = (region[k, axis] - middle) / half
    return middle, half


@jit
def trim_cell(edges: Array, reference: Array, rect: Rect, region: Array) -> tuple[int, float, float, float, float]:
    """Corners of what trims leave of a rectangle, and the box around them.

    Parameters
    ----------
    edges, reference
        Those of the leaf, see `inside_leaf`.
    rect : (float, float, float, float)
        Centre and half widths.
    region : (k, 2) array
        Receives the corners, as shares of the box's half widths.

    Returns
    -------
    count : int
        Number of corners, 0 where no edge runs through and the rectangle is inside, -1 where nothing is left.
    u, v, du, dv : float
        The box.
    """
    u, v, du, dv = rect
    count = clip_edges(edges, rect, region)
    if count == 0:
        return (0 if inside_leaf(edges, reference, u, v) else -1), u, v, du, dv
    for i in (-1.0, 1.0):
        for j in (-1.0, 1.0):
            x, y = u + i * du, v + j * dv
            # An edge in the border zone was not clipped, and rounding decides on which side of it the corner lies.
            if inside_leaf(edges, reference, x, y) or edge_touches(edges, (x, y, 3e-9 * du, 3e-9 * dv)):
                region[count, 0], region[count, 1] = x, y
                count += 1
    u, du = shrunk(region, count, 0, 1e-9 * du)
    v, dv = shrunk(region, count, 1, 1e-9 * dv)
    return count, u, v, du, dv
