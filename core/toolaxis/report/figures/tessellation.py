"""Faces as triangles for looking at: as few as keep within a bound of the surface, and how far off they are."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import inside, slabs, stations, walk
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Samples each way at which the bend of a face is looked at, at least so many between two knots; segments each way at
#: most.
_LOOKED, _OF_SPAN, _MOST = 17, 4, 160
#: Segments on flat stretches are no longer than by this factor, or triangles become slivers.
_GRADED = 0.3
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
    The number of triangles between two knots follows from the second derivatives at a grid of points there: a joined
    face may turn a corner within a thirtieth of its length.  What came of it is measured, see `Triangles.off`.  Sides
    follow the thinned outline, but for a few that lie closer together than triangles are wide.
    """
    lines, scale = _lay_lines(face, bound)
    if face.trims:
        uv, corners = _triangulate_loops(face, lines, scale, bound)
    else:
        uv, corners = _whole(*lines)
    points = face.evaluate(uv).point
    a, b, c = points[corners.T]
    sizes = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    largest = max(float(sizes.max(initial=0.0)), 1e-300)
    corners = corners[sizes > 1e-9 * largest]
    return Triangles(points, corners[:, ::-1] if face.flip else corners, _off(face, uv, points, corners))


def _lay_lines(face: Face, bound: float) -> tuple[tuple[Array, Array], Array]:
    """Lines along u and v between which chords keep within a bound, and lengths of the unit of u and of v, mm."""
    u0, u1, v0, v1 = face.bounds
    spans = _spans(face.surface.knots_u, u0, u1), _spans(face.surface.knots_v, v0, v1)
    u, v = (_sample_spans(ends) for ends in spans)
    d = face.evaluate(grid_rows(u, v))
    bends = [np.linalg.norm(row, axis=1).reshape(len(u), len(v)) for row in (d.suu, d.svv)]
    counts = (_count_lines(spans[0], u, bends[0].max(axis=1), bound),
              _count_lines(spans[1], v, bends[1].max(axis=0), bound))
    # A cell's middle is off by a quarter of its twist.
    twist = float(np.linalg.norm(d.suv, axis=1).max()) * (u1 - u0) * (v1 - v0)
    finer = max(1.0, np.sqrt(twist / (4 * 0.4 * bound * counts[0][-1] * counts[1][-1])))
    lengths = np.array([float(np.linalg.norm(row, axis=1).mean()) for row in (d.su, d.sv)])
    lines = _place_lines(spans[0], finer * counts[0]), _place_lines(spans[1], finer * counts[1])
    return lines, np.maximum(lengths, 1e-12)


def _spans(knots: Array, low: float, high: float) -> Array:
    """Ends of the spans between knots in a range, none shorter than a face's lines may lie apart."""
    least, ends = (high - low) / _MOST, [low]
    for knot in knots:
        if knot >= ends[-1] + least and knot <= high - least:
            ends.append(float(knot))
    return np.array([*ends, high])


def _sample_spans(ends: Array) -> Array:
    """Places in all spans, their ends among them."""
    count = max(_OF_SPAN, _LOOKED // (len(ends) - 1))
    return np.concatenate([*(np.linspace(low, high, count, endpoint=False) for low, high in pairwise(ends)), ends[-1:]])


def _count_lines(ends: Array, places: Array, bends: Array, bound: float) -> Array:
    """How many segments, no whole numbers, lie before the end of each span, for the greatest bends at places in them.

    A chord is off by an eighth of the bend over it: a share of the bound.
    """
    within = [bends[(places >= low) & (places <= high)].max() for low, high in pairwise(ends)]
    density = np.sqrt(np.array(within) / (8 * 0.4 * bound))
    density = np.maximum(density, max(_GRADED * float(density.max()), 2.0 / (ends[-1] - ends[0])))
    return np.concatenate([[0.0], np.cumsum(density * np.diff(ends))])


def _place_lines(ends: Array, counts: Array) -> Array:
    """Lines with as many segments in each span as are counted there."""
    whole = int(min(np.ceil(counts[-1] - 1e-9), _MOST))
    return np.interp(np.linspace(0.0, counts[-1], whole + 1), counts, ends)


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
    lines, scale = _lay_lines(face, bound)
    step = float(np.diff(lines[0]).min()), float(np.diff(lines[1]).min())
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
    step = np.array([np.diff(line).min() for line in grid]) * scale
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
    twice = bx * cy - by * cx
    corners[twice < 0] = corners[twice < 0][:, ::-1]
    # Points along a straight side of the outline make triangles without width, which a bent face makes wide in space.
    wide = np.abs(twice) > 1e-9 * np.abs(twice).max(initial=0.0)
    return points / scale, corners[wide]


def _away(points: Array, loops: list[Array], least: float) -> NDArray[np.bool_]:
    """Which points keep about a distance from loops: one on a border makes a triangle without width along it."""
    from scipy.spatial import cKDTree

    dense = np.concatenate([walk(loop, stations(loop, (0.5 * least, 0.5 * least))) for loop in loops])
    return np.asarray(cKDTree(dense).query(points)[0] > least)


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
