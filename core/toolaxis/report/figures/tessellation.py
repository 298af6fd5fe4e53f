"""Faces as triangles for looking at: as few as keep within a bound of the surface, and how far off they are."""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import inside, slabs, stations, walk
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Samples each way at which the bend of a face is looked at, and at least so many between two knots.
_SAMPLES, _SAMPLES_OF_SPAN = 17, 4
#: Segments each way at most.
_MOST_SEGMENTS = 160
#: What chords may take of the bound along one parameter; the middles of cells take the rest.
_CHORD_SHARE = 0.4
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
    grid = _lay_lines(face, bound)
    if face.trims:
        uv, corners = _triangulate_loops(face, grid, bound)
    else:
        uv, corners = _triangulate_grid(grid)
    points = face.evaluate(uv).point
    a, b, c = points[corners.T]
    sizes = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    largest = max(float(sizes.max(initial=0.0)), 1e-300)
    corners = corners[sizes > 1e-9 * largest]
    off = _greatest_distance(face, uv, points, corners)
    seen_from_outside = corners[:, ::-1] if face.flip else corners
    return Triangles(points, seen_from_outside, off)


class _GridLines(NamedTuple):
    """Parameters of the lines along which a face is divided, ascending, and the mean length of the unit of u and v."""

    u: Array
    v: Array
    scale: Array

    @property
    def points(self) -> Array:
        """Where the lines cross, (n, 2) in (u, v)."""
        return grid_rows(self.u, self.v)

    @property
    def steps(self) -> Array:
        """The least distance of neighbouring lines in u and in v."""
        return np.array([np.diff(self.u).min(), np.diff(self.v).min()])


def _lay_lines(face: Face, bound: float) -> _GridLines:
    """Lines along u and v between which chords keep within a bound, mm."""
    u0, u1, v0, v1 = face.bounds
    spans_u = _spans(face.surface.knots_u, u0, u1)
    spans_v = _spans(face.surface.knots_v, v0, v1)
    u = _sample_spans(spans_u)
    v = _sample_spans(spans_v)
    d = face.evaluate(grid_rows(u, v))
    bends_u = _lengths(d.suu).reshape(len(u), len(v))
    bends_v = _lengths(d.svv).reshape(len(u), len(v))
    counts_u = _count_lines(spans_u, u, bends_u.max(axis=1), bound)
    counts_v = _count_lines(spans_v, v, bends_v.max(axis=0), bound)
    # A cell's middle is off by a quarter of its twist.
    twist = float(_lengths(d.suv).max()) * (u1 - u0) * (v1 - v0)
    finer = max(1.0, np.sqrt(twist / (4 * _CHORD_SHARE * bound * counts_u[-1] * counts_v[-1])))
    units = np.array([float(_lengths(d.su).mean()), float(_lengths(d.sv).mean())])
    lines_u = _place_lines(spans_u, finer * counts_u)
    lines_v = _place_lines(spans_v, finer * counts_v)
    return _GridLines(lines_u, lines_v, np.maximum(units, 1e-12))


def _lengths(vectors: Array) -> Array:
    """Lengths of the rows, (n,)."""
    return np.asarray(np.linalg.norm(vectors, axis=1))


def _spans(knots: Array, low: float, high: float) -> Array:
    """Ends of the spans between knots in a range, none shorter than a face's lines may lie apart."""
    least = (high - low) / _MOST_SEGMENTS
    ends = [low]
    for knot in knots:
        if knot >= ends[-1] + least and knot <= high - least:
            ends.append(float(knot))
    return np.array([*ends, high])


def _sample_spans(ends: Array) -> Array:
    """Parameters in all spans, their ends among them."""
    count = max(_SAMPLES_OF_SPAN, _SAMPLES // (len(ends) - 1))
    within = [np.linspace(low, high, count, endpoint=False) for low, high in pairwise(ends)]
    return np.concatenate([*within, ends[-1:]])


def _count_lines(ends: Array, parameters: Array, bends: Array, bound: float) -> Array:
    """How many segments, no whole numbers, lie before the end of each span, for the bends at parameters in them.

    A chord is off by an eighth of the bend over it: a share of the bound.
    """
    greatest = []
    for low, high in pairwise(ends):
        is_within = (parameters >= low) & (parameters <= high)
        greatest.append(bends[is_within].max())
    density = np.sqrt(np.array(greatest) / (8 * _CHORD_SHARE * bound))
    least = max(_GRADED * float(density.max()), 2.0 / (ends[-1] - ends[0]))
    counts = np.maximum(density, least) * np.diff(ends)
    return np.concatenate([[0.0], np.cumsum(counts)])


def _place_lines(ends: Array, counts: Array) -> Array:
    """Lines with as many segments in each span as are counted there."""
    total = counts[-1]
    whole = int(min(np.ceil(total - 1e-9), _MOST_SEGMENTS))
    return np.interp(np.linspace(0.0, total, whole + 1), counts, ends)


def _triangulate_grid(grid: _GridLines) -> tuple[Array, Index]:
    """Points and triangles of a whole grid."""
    across = len(grid.v)
    i, j = (index.ravel() for index in np.indices((len(grid.u) - 1, across - 1)))
    a = i * across + j
    b = a + across
    c = b + 1
    d = a + 1
    first_halves = np.stack([a, b, c], axis=1)
    second_halves = np.stack([a, c, d], axis=1)
    return grid.points, np.concatenate([first_halves, second_halves])


def outline_loops(face: Face, bound: float) -> list[Array]:
    """The loops of a face with fewer points, (m, 2) each in (u, v); what is left out is within a bound, mm, in space.

    Parameters
    ----------
    face : Face
    bound : float
    """
    grid = _lay_lines(face, bound)
    step_u, step_v = map(float, grid.steps)
    loops = []
    for loop in face.outline:
        dense = walk(loop, stations(loop, (step_u, step_v)))
        # In space and in the parameters too: the two sides of a seam are one line in space.
        both = np.hstack([face.evaluate(dense).point, dense * grid.scale])
        loops.append(dense[simplify_loop(both, bound)])
    return loops


def _triangulate_loops(face: Face, grid: _GridLines, bound: float) -> tuple[Array, Index]:
    """Points and triangles of a face with loops: a Delaunay triangulation that has the outline's edges.

    It is made in the plane of the parameters, in units of about a mm.
    """
    loops = [loop * grid.scale for loop in outline_loops(face, 0.5 * bound)]
    crossings = grid.points * grid.scale
    inner = crossings[inside(slabs(tuple(loops)), crossings)]
    least = 0.25 * float((grid.steps * grid.scale).min())
    origin = np.concatenate(loops).min(axis=0)
    for attempt in range(_ROUNDS + 1):
        border = np.concatenate(loops)
        points = np.concatenate([border, inner[_is_away(inner, loops, least)]])
        corners = _triangulate_points(points - origin)
        if not len(corners):
            return border / grid.scale, corners
        if attempt == _ROUNDS:
            break
        halved = _halve_missing_edges(loops, corners)
        if sum(map(len, halved)) == len(border):
            break
        loops = halved
    is_inside = inside(slabs(tuple(loops)), points[corners].mean(axis=1))
    return points / grid.scale, _turn_anticlockwise(points, corners[is_inside])


def _triangulate_points(points: Array) -> Index:
    """Corners of the Delaunay triangles of points in the plane; none where all lie on one line, as in a sliver."""
    from scipy.spatial import Delaunay, QhullError

    try:
        return np.asarray(Delaunay(points).simplices.astype(np.int64))
    except QhullError:
        return np.empty((0, 3), dtype=np.int64)


def _turn_anticlockwise(points: Array, corners: Index) -> Index:
    """Triangles in the plane that run anticlockwise, without those that have no width.

    Points along a straight side of the outline make such triangles, which a bent face makes wide in space.
    """
    a, b, c = points[corners.T]
    bx, by = (b - a).T
    cx, cy = (c - a).T
    twice_area = bx * cy - by * cx
    runs_clockwise = twice_area < 0
    corners[runs_clockwise] = corners[runs_clockwise][:, ::-1]
    size = np.abs(twice_area)
    is_wide = size > 1e-9 * size.max(initial=0.0)
    return corners[is_wide]


def _is_away(points: Array, loops: list[Array], least: float) -> NDArray[np.bool_]:
    """Which points keep about a distance from loops: one on a border makes a triangle without width along it."""
    from scipy.spatial import cKDTree

    step = 0.5 * least
    dense = [walk(loop, stations(loop, (step, step))) for loop in loops]
    distances = cKDTree(np.concatenate(dense)).query(points)[0]
    return np.asarray(distances > least)


def _halve_missing_edges(loops: list[Array], corners: Index) -> list[Array]:
    """Loops with a vertex in the middle of each edge that is no side of a triangle.

    The first points of the triangulation are the vertices of the loops, in their order.
    """
    halved = []
    first = 0
    for loop in loops:
        halved.append(_halve_edges(loop, corners, first))
        first += len(loop)
    return halved


def _halve_edges(loop: Array, corners: Index, first: int) -> Array:
    """A loop with a vertex in the middle of each edge that is no side of a triangle.

    first : number of its first vertex among the points of the triangulation
    """
    most = int(corners.max()) + 1

    def number(ends: Index) -> Index:
        """One number for each pair of points, in whatever order."""
        lower, upper = np.sort(ends, axis=1).T
        return np.asarray(lower * most + upper)

    vertex = first + np.arange(len(loop))
    edges = np.stack([vertex, np.roll(vertex, -1)], axis=1)
    is_missing = ~np.isin(number(edges), number(np.concatenate(_sides(corners))))
    middles = 0.5 * (loop + np.roll(loop, -1, axis=0))
    after = np.flatnonzero(is_missing) + 1
    return np.insert(loop, after, middles[is_missing], axis=0)


def _sides(corners: Index) -> list[Index]:
    """The ends of the first, second and third side of triangles, (m, 2) each."""
    return [corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]


def _greatest_distance(face: Face, uv: Array, points: Array, corners: Index) -> float:
    """How far the middles of triangles and sides are from the surface, mm: along the normal at the same parameters."""
    if not len(corners):
        return 0.0
    worst = 0.0
    for rows in (corners, *_sides(corners)):
        middle_uv = uv[rows].mean(axis=1)
        to_surface = face.evaluate(middle_uv).point - points[rows].mean(axis=1)
        along_normal = (to_surface * face.normal(middle_uv)).sum(axis=1)
        worst = max(worst, float(np.abs(along_normal).max()))
    return worst
