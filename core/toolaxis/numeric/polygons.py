"""Points in polygons with holes: even-odd crossing counts over edges sorted into horizontal slabs.

The border counts as inside, holes' borders too, within `BORDER` of the greatest coordinates.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_unfused_inline
from toolaxis.numeric.parts import number_parts

Array = NDArray[np.float64]

#: Half width of the border, as a share of the polygon's greatest x and y: rounding of a crossing, and no more.
BORDER = 1e-14
_MOST_SLABS = 4096


def signed_area(loop: Array) -> float:
    """Area of a polygon, positive when it runs anticlockwise.

    Parameters
    ----------
    loop : (m, 2) array
        Vertices; the last one may repeat the first.
    """
    x = loop[:, 0] - loop[0, 0]
    y = loop[:, 1] - loop[0, 1]
    next_x = np.roll(x, -1)
    next_y = np.roll(y, -1)
    return float(0.5 * np.sum(x * next_y - next_x * y))


def polygon_area(loops: Sequence[Array]) -> float:
    """Area of a polygon with holes.

    Parameters
    ----------
    loops : sequence of (m, 2) arrays
        The outer one first, then the holes, either way around.
    """
    outer, *holes = loops
    inner = sum(abs(signed_area(hole)) for hole in holes)
    return abs(signed_area(outer)) - inner


@dataclass(frozen=True)
class EdgeIndex:
    """Edges of closed loops sorted into horizontal slabs.

    Attributes
    ----------
    edges : (m, 4) array
        x0, y0, x1, y1 of each edge.
    start, member : arrays of int
        Edges that touch slab k are ``member[start[k]:start[k + 1]]``.
    low, height : float
        Lower end of the first slab and height of each.
    border : (float, float)
        Distances along x and along y within which a point is on an edge.
    """

    edges: Array
    start: NDArray[np.int64]
    member: NDArray[np.int64]
    low: float
    height: float
    border: tuple[float, float]


def slabs(loops: tuple[Array, ...]) -> EdgeIndex:
    """Sort the edges of closed loops for `inside`.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Closed loops; the closing edge is added where the last vertex does not repeat the first.
    """
    edges = _edges(loops)
    ends_x = edges[:, [0, 2]]
    ends_y = edges[:, [1, 3]]
    wide = BORDER * float(np.abs(ends_x).max(initial=0.0))
    tall = BORDER * float(np.abs(ends_y).max(initial=0.0))
    lower = ends_y.min(axis=1) - tall
    upper = ends_y.max(axis=1) + tall
    low, high = 0.0, 1.0
    if len(edges):
        low = float(lower.min())
        high = float(upper.max())
    count = max(1, min(_MOST_SLABS, 2 * len(edges)))
    height = max((high - low) / count, np.finfo(float).tiny)
    first = _slab_numbers(lower, low, height, count)
    last = _slab_numbers(upper, low, height, count)
    touched = last - first + 1
    owner, number = number_parts(touched)
    slab = first[owner] + number
    order = np.argsort(slab, kind="stable")
    member = owner[order].astype(np.int64)
    sizes = np.bincount(slab, minlength=count)
    start = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    return EdgeIndex(np.ascontiguousarray(edges), start, member, low, height, (wide, tall))


def _edges(loops: tuple[Array, ...]) -> Array:
    """Both ends of every edge that has a length, (m, 4): x0, y0, x1, y1."""
    edges = np.concatenate([np.hstack([loop, np.roll(loop, -1, axis=0)]) for loop in loops])
    x0, y0, x1, y1 = edges.T
    return np.asarray(edges[(x0 != x1) | (y0 != y1)])


def _slab_numbers(heights: Array, low: float, height: float, count: int) -> NDArray[np.int64]:
    """Numbers of the slabs in which heights lie; rounding puts none beyond the first or the last."""
    numbers = ((heights - low) / height).astype(np.int64)
    return np.asarray(np.clip(numbers, 0, count - 1))


@jit_unfused_inline
def lies_inside(edges: Array, table: tuple[NDArray[np.int64], NDArray[np.int64]],
                grid: tuple[float, float, float, float], x: float, y: float) -> bool:
    """Whether one point lies inside an odd number of loops; a part of kernels.

    Parameters
    ----------
    edges : (m, 4) array
    table : pair of arrays
        Of an `EdgeIndex`: start and member.
    grid : tuple of float
        Its low and height, and the two numbers of its border.
    x, y : float
    """
    start, member = table
    low, height, wide, tall = grid
    count = start.shape[0] - 1
    position = (y - low) / height
    odd = False
    if position >= 0.0 and y <= low + (count + 1) * height:
        slab = min(int(position), count - 1)
        for m in range(start[slab], start[slab + 1]):
            e = member[m]
            x0 = edges[e, 0]
            y0 = edges[e, 1]
            x1 = edges[e, 2]
            y1 = edges[e, 3]
            if min(y0, y1) - tall <= y <= max(y0, y1) + tall:
                if min(x0, x1) - wide <= x <= max(x0, x1) + wide:
                    dx = x1 - x0
                    dy = y1 - y0
                    off_line = dx * (y - y0) - dy * (x - x0)
                    if abs(off_line) <= abs(dx) * tall + abs(dy) * wide:
                        return True
                crosses = (y0 > y) != (y1 > y)
                if crosses and x0 + (x1 - x0) * (y - y0) / (y1 - y0) > x:
                    odd = not odd
    return odd


@jit
def _inside(edges: Array, table: tuple[NDArray[np.int64], NDArray[np.int64]],
            grid: tuple[float, float, float, float], points: Array, out: NDArray[np.bool_]) -> None:
    for k in range(points.shape[0]):
        out[k] = lies_inside(edges, table, grid, points[k, 0], points[k, 1])


def inside(table: EdgeIndex, points: Array) -> NDArray[np.bool_]:
    """Whether points lie inside an odd number of loops.

    Parameters
    ----------
    table : EdgeIndex
    points : (n, 2) array

    Returns
    -------
    (n,) array of bool
    """
    points = np.ascontiguousarray(points, dtype=float)
    if not _compiled.available:
        return inside_numpy(table, points)
    out = np.empty(len(points), dtype=np.bool_)
    _inside(table.edges, (table.start, table.member), (table.low, table.height, *table.border), points, out)
    return out


def inside_numpy(table: EdgeIndex, points: Array) -> NDArray[np.bool_]:
    """The plain twin of `inside`: every point against every edge.

    Parameters and result as there.
    """
    odd = np.zeros(len(points), dtype=bool)
    on_border = np.zeros(len(points), dtype=bool)
    finite = np.asarray(np.isfinite(points).all(axis=1))
    x, y = np.where(finite[:, None], points, 0.0).T
    wide, tall = table.border
    for x0, y0, x1, y1 in table.edges:
        dx = x1 - x0
        dy = y1 - y0
        near = (y >= min(y0, y1) - tall) & (y <= max(y0, y1) + tall)
        near &= (x >= min(x0, x1) - wide) & (x <= max(x0, x1) + wide)
        off_line = np.abs(dx * (y - y0) - dy * (x - x0))
        on_border |= near & (off_line <= abs(dx) * tall + abs(dy) * wide)
        if dy != 0:
            crosses = (y0 > y) != (y1 > y)
            crossing = x0 + dx * (y - y0) / dy
            odd ^= crosses & (crossing > x)
    return np.asarray((odd | on_border) & finite)


def chords(loops: tuple[Array, ...], y: float) -> Array:
    """The stretches of a horizontal line inside closed loops.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
    y : float
        Height of the line; loops are met as if it lay a little above any vertex it passes through.

    Returns
    -------
    (k, 2) array of the ends of each stretch along x, in order
    """
    crossings = []
    for loop in loops:
        ends = np.roll(loop, -1, axis=0)
        crosses = (loop[:, 1] > y) != (ends[:, 1] > y)
        x0, y0 = loop[crosses].T
        x1, y1 = ends[crosses].T
        crossings.append(x0 + (x1 - x0) * (y - y0) / (y1 - y0))
    return np.sort(np.concatenate(crossings)).reshape(-1, 2)


def walk(loop: Array, position: Array) -> Array:
    """Points on a closed polygon, (n, 2).

    Parameters
    ----------
    loop : (m, 2) array
    position : (n,) array
        Number of the edge plus the share of it that is passed; counted on round and round.
    """
    edge = np.floor(position)
    share = (position - edge)[:, None]
    start = edge.astype(np.int64) % len(loop)
    end = (start + 1) % len(loop)
    return np.asarray((1 - share) * loop[start] + share * loop[end])


def stations(loop: Array, step: tuple[float, float]) -> Array:
    """Positions for `walk` all round a polygon: every vertex, and points between no farther apart than a step.

    Parameters
    ----------
    loop : (m, 2) array
    step : (float, float)
        Greatest distance of neighbours along x and along y.

    Returns
    -------
    (k,) array, rising from 0 to below m
    """
    lengths = np.abs(np.roll(loop, -1, axis=0) - loop)
    steps = (lengths / np.asarray(step)).max(axis=1)
    # An edge that is whole steps long but for rounding gets no further point.
    pieces = np.maximum(np.ceil(steps - 1e-9), 1).astype(np.int64)
    edge, number = number_parts(pieces)
    return np.asarray(edge + number / pieces[edge])
