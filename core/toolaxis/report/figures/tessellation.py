"""Faces as triangles for looking at: as few as keep within a bound of the surface, and how far off they are."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import inside, slabs, stations, walk
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Samples each way at which the bend of a face is looked at, and segments each way at most.
_LOOKED, _MOST = 17, 160
#: How often edges of the outline that are not sides of triangles are halved.
_ROUNDS = 6


@dataclass(frozen=True, eq=False)
class Triangles:
    """A face as triangles.

    Attributes
    ----------
    points : (n, 3) array
        On the surface, mm.
    corners : (m, 3) array of int
        Rows of points; anticlockwise as seen from outside the material.
    off : float
        Greatest distance from the surface at the middles of the triangles and of their sides, mm.
    """

    points: Array
    corners: Index
    off: float


def triangles(face: Face, bound: float) -> Triangles:
    """A face as triangles that keep within a bound of its surface.

    Parameters
    ----------
    face : Face
    bound : float
        mm; also for the outline.

    Notes
    -----
    The number of triangles follows from the second derivatives at a grid of points; what came of it is measured, see
    `Triangles.off`.  Sides follow the thinned outline, but for a few that lie closer together than triangles are wide.
    """
    u0, u1, v0, v1 = face.bounds
    counts, scale = _counts(face, bound)
    u = np.linspace(u0, u1, counts[0] + 1)
    v = np.linspace(v0, v1, counts[1] + 1)
    if face.trims:
        uv, corners = _triangulate_loops(face, (u, v), scale, bound)
    else:
        uv, corners = _whole(u, v)
    points = face.evaluate(uv).point
    a, b, c = points[corners.T]
    sizes = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    largest = max(float(sizes.max(initial=0.0)), 1e-300)
    corners = corners[sizes > 1e-9 * largest]
    return Triangles(points, corners[:, ::-1] if face.flip else corners, _off(face, uv, points, corners))


def _counts(face: Face, bound: float) -> tuple[tuple[int, int], Array]:
    """Segments along u and v, and lengths of the unit of u and of v, mm."""
    u0, u1, v0, v1 = face.bounds
    u = np.linspace(u0, u1, _LOOKED)
    v = np.linspace(v0, v1, _LOOKED)
    d = face.evaluate(grid_rows(u, v))
    spans = np.array([u1 - u0, v1 - v0])
    bends = np.array([np.linalg.norm(row, axis=1).max() for row in (d.suu, d.svv)]) * spans**2
    twist = float(np.linalg.norm(d.suv, axis=1).max()) * float(np.prod(spans))
    # A chord is off by an eighth of the bend over it, a cell's middle by a quarter of the twist: shares of the bound.
    both = np.maximum(np.sqrt(bends / (8 * 0.4 * bound)), 1.0)
    both *= max(1.0, np.sqrt(twist / (4 * 0.4 * bound * float(np.prod(both)))))
    whole = np.clip(np.ceil(both), 2, _MOST).astype(int)
    lengths = np.array([float(np.linalg.norm(row, axis=1).mean()) for row in (d.su, d.sv)])
    return (int(whole[0]), int(whole[1])), np.maximum(lengths, 1e-12)


def _whole(u: Array, v: Array) -> tuple[Array, Index]:
    """Points and triangles of a whole grid."""
    i, j = (index.ravel() for index in np.indices((len(u) - 1, len(v) - 1)))
    a = i * len(v) + j
    b = a + len(v)
    c = b + 1
    d = a + 1
    halves = [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    return grid_rows(u, v), np.concatenate(halves)


def outline_loops(face: Face, bound: float) -> list[Array]:
    """The loops of a face with fewer points, (m, 2) each in (u, v); what is left out is within a bound, mm, in space.

    Parameters
    ----------
    face : Face
    bound : float
    """
    u0, u1, v0, v1 = face.bounds
    counts, scale = _counts(face, bound)
    step = ((u1 - u0) / counts[0], (v1 - v0) / counts[1])
    loops = []
    for loop in face.outline:
        dense = walk(loop, stations(loop, step))
        # In space and in the parameters too: the two sides of a seam are one line in space.
        both = np.hstack([face.evaluate(dense).point, dense * scale])
        loops.append(dense[simplify_loop(both, bound)])
    return loops


def _triangulate_loops(face: Face, grid: tuple[Array, Array], scale: Array, bound: float) -> tuple[Array, Index]:
    """Points and triangles of a face with loops: a Delaunay triangulation that has the outline's edges."""
    from scipy.spatial import Delaunay, QhullError

    loops = [loop * scale for loop in outline_loops(face, 0.5 * bound)]
    inner = grid_rows(*grid) * scale
    step = np.array([line[1] - line[0] for line in grid]) * scale
    inner = inner[inside(slabs(tuple(loops)), inner)]
    origin = np.concatenate(loops).min(axis=0)
    for attempt in range(_ROUNDS + 1):
        border = np.concatenate(loops)
        apart = _away(inner, loops, 0.25 * float(step.min()))
        points = np.concatenate([border, inner[apart]])
        try:
            corners = Delaunay(points - origin).simplices.astype(np.int64)
        except QhullError:  # a sliver in which all points lie on one line
            return border / scale, np.empty((0, 3), dtype=np.int64)
        if attempt == _ROUNDS:
            break
        firsts = np.cumsum([0, *map(len, loops)])[:-1]
        halved = [_halve_edges(loop, corners, first) for loop, first in zip(loops, firsts, strict=True)]
        if all(len(new) == len(old) for new, old in zip(halved, loops, strict=True)):
            break
        loops = halved
    kept = inside(slabs(tuple(loops)), points[corners].mean(axis=1))
    corners = corners[kept]
    a, b, c = points[corners.T]
    bx, by = (b - a).T
    cx, cy = (c - a).T
    clockwise = bx * cy - by * cx < 0
    corners[clockwise] = corners[clockwise][:, ::-1]
    return points / scale, corners


def _away(points: Array, loops: list[Array], least: float) -> NDArray[np.bool_]:
    """Which points keep a distance from the vertices of loops."""
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(np.concatenate(loops)).query(points)[0] > least)


def _halve_edges(loop: Array, corners: Index, first: int) -> Array:
    """A loop with a vertex in the middle of each edge that is no side of a triangle."""
    most = int(corners.max()) + 1

    def number(ends: Index) -> Index:
        """One number for each pair of points, in whatever order."""
        lower, upper = np.sort(ends, axis=1).T
        return np.asarray(lower * most + upper)

    vertex = first + np.arange(len(loop))
    edges = np.stack([vertex, np.roll(vertex, -1)], axis=1)
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    missing = ~np.isin(number(edges), number(sides))
    middle = 0.5 * (loop + np.roll(loop, -1, axis=0))
    return np.insert(loop, np.flatnonzero(missing) + 1, middle[missing], axis=0)


def _off(face: Face, uv: Array, points: Array, corners: Index) -> float:
    """How far the middles of triangles and sides are from the surface, mm: along the normal at the same parameters."""
    if not len(corners):
        return 0.0
    worst = 0.0
    for rows in (corners, corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]):
        at = uv[rows].mean(axis=1)
        apart = face.evaluate(at).point - points[rows].mean(axis=1)
        off = (apart * face.normal(at)).sum(axis=1)
        worst = max(worst, float(np.abs(off).max()))
    return worst
