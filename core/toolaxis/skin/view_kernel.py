"""Which of several faces lies at places of a plane, and its points there: all faces in one table, and the kernels."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.jit import jit, jit_unfused, jit_unfused_inline
from toolaxis.numeric.polygons import EdgeIndex, lies_inside
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.skin.band_kernel import TRIED, BandTable, add_height, blend_into_spline, find_foot, height_of
from toolaxis.skin.place_kernel import PlaceFrame, find_place, turn_place_into_plane
from toolaxis.skin.point_grid import PointGrid, find_nearest

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Cells each way over the box around a face, each with the parameters from which its places are looked for.
CELLS = 48


class PolygonTable(NamedTuple):
    """Polygons as `toolaxis.numeric.polygons.slabs` sorts them, one behind the other.

    edges : (m, 4) array;  start, member : arrays of int
    first : (k + 1, 3) array of int, where edges, start and member of each begin
    grid : (k, 4) array, low, height and border of each
    """

    edges: Array
    start: Index
    member: Index
    first: Index
    grid: Array


class SplineTable(NamedTuple):
    """Surfaces, one behind the other.

    knots : (n,) array;  control : (m, 4) array
    first : (k, 3) array of int, where knots in u, knots in v and control points of each begin
    size : (k, 5) array of int, control points along u and v, degrees, and 1 where it is rational
    ends : (k, 2, 3) array, as of `PlaceFrame`
    begin : (k, c, c, 6) array, from which parameters places in the cells of each box are looked for, as
        `toolaxis.skin.seen_face.SeenFace.begin_in_cells` says it
    """

    knots: Array
    control: Array
    first: Index
    size: Index
    ends: Array
    begin: Array


class ViewTable(NamedTuple):
    """Faces in a plane.

    rows : (2, 3) array, coordinates in the plane are rows @ (p - origin);  origin : (3,) array, mm
    boxes : (k, 2, 2) array, lower and upper corner of each face
    covered : (k + 1,) array of int, where the polygons begin under which each face is covered; the last: how many
    polygons : PolygonTable, the outlines of the faces, what covers them, and the outline around all
    splines : SplineTable
    borders : PointGrid, points along the borders of the faces;  beside : (n,) array of int, the face of each
    """

    rows: Array
    origin: Array
    boxes: Array
    covered: Index
    polygons: PolygonTable
    splines: SplineTable
    borders: PointGrid
    beside: Index


class Memory(NamedTuple):
    """Memory for one place after the other: what is in it does not count.

    uv : (2,);  basis : (6, 26);  turn : (7, 3) arrays;  nearest, square : (`TRIED`,) arrays, the first of int
    one, away : (1,) arrays, the first of int
    """

    uv: Array
    basis: Array
    turn: Array
    nearest: Index
    square: Array
    one: Index
    away: Array


def tabulate_polygons(polygons: Sequence[EdgeIndex]) -> PolygonTable:
    """Polygons in one table.

    Parameters
    ----------
    polygons : sequence of EdgeIndex
    """
    counts = [(len(one.edges), len(one.start), len(one.member)) for one in polygons]
    first = np.concatenate([np.zeros((1, 3), dtype=np.int64), np.cumsum(counts, axis=0)])
    grid = np.array([[one.low, one.height, *one.border] for one in polygons])
    edges, start, member = (np.concatenate([getattr(one, name) for one in polygons])
                            for name in ("edges", "start", "member"))
    return PolygonTable(edges, start, member, first.astype(np.int64), grid)


def tabulate_splines(surfaces: Sequence[NurbsSurface], ends: Sequence[Array], begin: Sequence[Array]) -> SplineTable:
    """Surfaces in one table.

    Parameters
    ----------
    surfaces : sequence of NurbsSurface
    ends, begin : sequence of array
        Of each, as the rows of the table.
    """
    knots: list[Array] = []
    first, size = [], []
    at = control = 0
    for one in surfaces:
        ku, kv, net, pu, pv, rational = one.data
        first.append((at, at + len(ku), control))
        size.append((net.shape[0], net.shape[1], pu, pv, int(rational)))
        knots += [ku, kv]
        at, control = at + len(ku) + len(kv), control + net.shape[0] * net.shape[1]
    return SplineTable(np.concatenate(knots), np.concatenate([one.control.reshape(-1, 4) for one in surfaces]),
                       np.array(first, dtype=np.int64), np.array(size, dtype=np.int64), np.stack(ends), np.stack(begin))


@jit_unfused_inline
def _lies_in(polygons: PolygonTable, k: int, x: float, y: float) -> bool:
    """Whether a point lies in polygon k."""
    edges, start, member, first, grid = polygons
    return bool(lies_inside(edges[first[k, 0]:first[k + 1, 0]],
                            (start[first[k, 1]:first[k + 1, 1]], member[first[k, 2]:first[k + 1, 2]]),
                            (grid[k, 0], grid[k, 1], grid[k, 2], grid[k, 3]), x, y))


@jit
def _new_memory() -> Memory:
    return Memory(np.empty(2), np.empty((6, 26)), np.empty((7, 3)), np.empty(TRIED, dtype=np.int64), np.empty(TRIED),
                  np.empty(1, dtype=np.int64), np.empty(1))


@jit_unfused
def _nearest_face(table: ViewTable, x: float, y: float, memory: Memory) -> int:
    """The face whose border is nearest to a place."""
    find_nearest(table.borders, x, y, np.inf, memory.one, memory.away)
    return int(table.beside[memory.one[0]])


@jit_unfused
def _owner_at(table: ViewTable, x: float, y: float, memory: Memory) -> int:
    """Which face lies at a place; -1 beyond the outline around all."""
    boxes, covered, polygons = table.boxes, table.covered, table.polygons
    for k in range(boxes.shape[0]):
        if not (boxes[k, 0, 0] <= x <= boxes[k, 1, 0] and boxes[k, 0, 1] <= y <= boxes[k, 1, 1]):
            continue
        if not _lies_in(polygons, k, x, y):
            continue
        seen = True
        for c in range(covered[k], covered[k + 1]):
            if _lies_in(polygons, c, x, y):
                seen = False
                break
        if seen:
            return k
    if _lies_in(polygons, polygons.first.shape[0] - 2, x, y):  # between faces that do not quite meet
        return _nearest_face(table, x, y, memory)
    return -1


@jit_unfused
def _evaluate_face(table: ViewTable, k: int, place: Array, out: Array, memory: Memory) -> None:
    """The six vectors (6, 3) of a face at a place, with the place."""
    knots, control, first, size, ends, begin = table.splines
    cells = begin.shape[1]
    low, high = table.boxes[k, 0], table.boxes[k, 1]
    wide, long = max(high[0] - low[0], 1e-300) / cells, max(high[1] - low[1], 1e-300) / cells
    a = min(max(int((place[0] - low[0]) / wide), 0), cells - 1)
    b = min(max(int((place[1] - low[1]) / long), 0), cells - 1)
    # places beyond the box are led no farther than the cell reaches
    x = min(max(place[0] - low[0] - (a + 0.5) * wide, -wide), wide)
    y = min(max(place[1] - low[1] - (b + 0.5) * long, -long), long)
    uv = memory.uv
    uv[0] = begin[k, a, b, 0] + begin[k, a, b, 2] * x + begin[k, a, b, 3] * y
    uv[1] = begin[k, a, b, 1] + begin[k, a, b, 4] * x + begin[k, a, b, 5] * y
    nu, nv, pu, pv = size[k, 0], size[k, 1], size[k, 2], size[k, 3]
    behind_u, behind_v = first[k, 0] + nu + pu + 1, first[k, 1] + nv + pv + 1
    net = control[first[k, 2]:first[k, 2] + nu * nv].reshape((nu, nv, 4))
    data = (knots[first[k, 0]:behind_u], knots[first[k, 1]:behind_v], net, pu, pv, size[k, 4] == 1)
    find_place(data, PlaceFrame(table.rows, table.origin, ends[k]), place, uv, out, memory.basis)
    turn_place_into_plane(table.rows, out, memory.turn)


@jit
def find_owners(table: ViewTable, places: Array, owner: NDArray[np.intp]) -> None:
    """Which face lies at places: its number, -1 beyond the outline around all.

    Parameters
    ----------
    table : ViewTable
    places : (n, 2) array
    owner : (n,) array of int
        Receives the numbers.
    """
    memory = _new_memory()
    for i in range(places.shape[0]):
        owner[i] = _owner_at(table, places[i, 0], places[i, 1], memory)


@jit
def find_nearest_faces(table: ViewTable, places: Array, owner: NDArray[np.intp]) -> None:
    """The face whose border is nearest to each place.

    Parameters
    ----------
    table : ViewTable
    places : (n, 2) array
    owner : (n,) array of int
        Receives the numbers.
    """
    memory = _new_memory()
    for i in range(places.shape[0]):
        owner[i] = _nearest_face(table, places[i, 0], places[i, 1], memory)


@jit
def evaluate_owned(table: ViewTable, places: Array, owner: NDArray[np.intp], out: Array) -> None:
    """The six vectors S, Sx, Sy, Sxx, Sxy, Syy of faces at places x, y of the plane.

    Parameters
    ----------
    table : ViewTable
    places : (n, 2) array
    owner : (n,) array of int
        The face at each place.
    out : (n, 6, 3) array
        Receives the vectors.
    """
    memory = _new_memory()
    for i in range(places.shape[0]):
        _evaluate_face(table, owner[i], places[i], out[i], memory)


@jit
def evaluate_view(table: ViewTable, band: BandTable, spline: SurfaceData, places: Array, out: Array) -> None:
    """The six vectors at places in the outline, and beyond it, where faces go on and then a spline does.

    Parameters
    ----------
    table : ViewTable
    band : BandTable
    spline : SurfaceData
        Its parameters are places of the plane.
    places : (n, 2) array
    out : (n, 6, 3) array
        Receives the vectors.
    """
    memory, foot_place, at_foot = _new_memory(), np.empty(2), np.empty((6, 3))
    for i in range(places.shape[0]):
        x, y = places[i, 0], places[i, 1]
        owner = _owner_at(table, x, y, memory)
        if owner >= 0:
            _evaluate_face(table, owner, places[i], out[i], memory)
            continue
        surface_derivatives(spline, x, y, out[i], memory.basis)
        foot = find_foot(band, x, y, memory.nearest, memory.square)
        if foot.near:
            foot_place[0], foot_place[1] = foot.x, foot.y
            _evaluate_face(table, _nearest_face(table, foot.x, foot.y, memory), foot_place, at_foot, memory)
            face, here = height_of(band, table.origin, at_foot), height_of(band, table.origin, out[i])
            add_height(band, blend_into_spline(band, foot, face, here, x, y), out[i])
