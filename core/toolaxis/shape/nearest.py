"""The nearest point of a trimmed face to given points."""

from functools import cached_property
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, ref

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.numeric.polygons import slabs, stations, walk
from toolaxis.numeric.shares import work_on_rows
from toolaxis.numeric.vectors import as_rows
from toolaxis.shape.face import Face
from toolaxis.shape.nearest_kernel import FaceLoop, FaceRange, nearest_along, nearest_inside
from toolaxis.shape.nearest_numpy import nearest_along_numpy, nearest_inside_numpy
from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Nearest samples from which the search sets out, inside and on the border.
STARTS, STARTS_ALONG = 4, 2
#: How far loops may leave the domain of a surface by rounding, as a share of its range; by how much bounds are rounded.
_ROUNDED, _ROUNDED_UP = 1e-9, 1.0 + 1e-9
#: Targets of a share.
_AT_ONCE = 256


class NearestPoints(NamedTuple):
    """Nearest points of a face to n points: parameters (n, 2), positions (n, 3) and distances (n,), mm."""

    uv: Array
    point: Array
    distance: Array


def nearest(face: Face, points: ArrayLike, samples: int = 48) -> NearestPoints:
    """The nearest point of a face, its border included, to each point.

    Parameters
    ----------
    face : Face
    points : (n, 3) array_like
        mm
    samples : int
        Samples along each side of the face from which the search sets out; features smaller than that may be missed.

    Returns
    -------
    NearestPoints

    Raises
    ------
    InvalidInput
        When a point is not finite or of another shape.

    Notes
    -----
    **Properties**: (1) the distance is never above that to the nearest sample; (2) inside the face the way to the
    point is normal to the surface; (3) it follows rigid motions and mirrors.
    """
    targets = np.ascontiguousarray(as_rows(points, 3, "point"))
    known = _samples_of(face, samples)
    uv, least = np.zeros((len(targets), 2)), np.full(len(targets), np.inf)

    def _find(rows: slice) -> None:
        _search(face, known, targets[rows], (uv[rows], least[rows]))

    work_on_rows(_find, len(targets), _AT_ONCE)
    point = face.evaluate(uv).point
    return NearestPoints(uv, point, np.linalg.norm(point - targets, axis=1))


class NearestSamples(NamedTuple):
    """The nearest sample of a face to n points.

    point : (n, 3) mm;  distance : (n,) mm;  apart : (n,) mm, how far from that sample the face may go on before another
    sample is nearer.
    """

    point: Array
    distance: Array
    apart: Array


def nearest_sample(face: Face, points: Array, samples: int = 96) -> NearestSamples:
    """The nearest of a face's samples to each point, in about a tenth of the time that `nearest` takes.

    Parameters
    ----------
    face : Face
    points : (n, 3) array
        mm
    samples : int
        Samples along each side of the face.
    """
    cloud = _samples_of(face, samples).cloud
    distance, at = cloud.tree.query(points)
    return NearestSamples(cloud.point[at], distance, cloud.apart[at])


class _Cloud(NamedTuple):
    """All samples of a face: a tree of them, their positions (m, 3), and the sizes of their cells (m,), mm."""

    tree: Any
    point: Array
    apart: Array


class _FaceSamples:
    """Points of a face from which searches set out, kept with it: many ask for the nearest points of one face.

    Attributes
    ----------
    grid : (m, 2) array
        Parameters of points inside.
    borders : list of (k,) array
        Positions of points along each loop.
    """

    def __init__(self, face: Face, samples: int) -> None:
        u0, u1, v0, v1 = face.bounds
        self._face, self._cell = ref(face), ((u1 - u0) / samples, (v1 - v0) / samples)
        self.grid = face.grid(samples, samples)
        self.borders = [stations(loop, self._cell) for loop in face.outline]

    @cached_property
    def compiled(self) -> "_KernelFace | None":
        """The face in the kernels' form; None where they cannot take it."""
        face = self._held()
        own_numbers = type(face.surface) is NurbsSurface
        return _KernelFace(face, self.borders) if _compiled.available and own_numbers else None

    @cached_property
    def _inside(self) -> Any:
        return _tree(self._held(), self.grid)

    @cached_property
    def _along(self) -> list[Any]:
        face = self._held()
        return [_tree(face, walk(loop, at)) for loop, at in zip(face.outline, self.borders, strict=True)]

    def _held(self) -> Face:
        """The face: whoever asks for its samples holds it, while they do not, so that both go together."""
        face = self._face()
        assert face is not None
        return face

    @cached_property
    def cloud(self) -> _Cloud:
        """All samples; half a cell belongs to one inside, and all of the cells around to one on the border."""
        from scipy.spatial import cKDTree

        face = self._held()
        border = [walk(loop, at) for loop, at in zip(face.outline, self.borders, strict=True)]
        places = face.evaluate(np.concatenate([self.grid, *border]))
        size = np.linalg.norm(places.su, axis=1) * self._cell[0] + np.linalg.norm(places.sv, axis=1) * self._cell[1]
        size[:len(self.grid)] /= 2.0
        return _Cloud(cKDTree(places.point), places.point, size)

    def starts_inside(self, targets: Array) -> Index:
        """Numbers of the nearest points inside to each target, (n, k)."""
        return _starts(self._inside, targets)

    def starts_along(self, loop: int, targets: Array) -> Index:
        """Numbers of the nearest points of a loop to each target, (n, k)."""
        return np.ascontiguousarray(_starts(self._along[loop], targets)[:, :STARTS_ALONG])


class _KernelFace:
    """A face in the form that kernels take.

    Attributes
    ----------
    range : FaceRange
    loops : list of FaceLoop
    """

    def __init__(self, face: Face, borders: list[Array]) -> None:
        table = slabs(face.outline)
        self.range = FaceRange(face.bounds, bool(face.trims), table.edges, table.start, table.member,
                               (table.low, table.height, *table.border))
        slopes = _greatest_slopes(face)
        self.loops = [_loop_for_kernels(loop, at, slopes) for loop, at in zip(face.outline, borders, strict=True)]


def _greatest_slopes(face: Face) -> Array:
    """Bounds of |Su| and |Sv| on the whole surface, (2,) mm; infinite where loops leave it."""
    surface = face.surface
    domain = np.array(surface.domain)
    slack = _ROUNDED * np.ptp(domain, axis=1)
    corners = np.concatenate(face.outline)
    if ((corners < domain[:, 0] - slack) | (corners > domain[:, 1] + slack)).any():
        return np.full(2, np.inf)
    lines = [np.unique(np.concatenate([ends, inner])) for ends, inner in zip(domain, surface.breaks, strict=True)]
    bounds = derivative_bounds(bezier_nets(surface.data, *lines), np.diff(lines[0]), np.diff(lines[1]), 1)
    return np.asarray(_ROUNDED_UP * bounds.max(axis=(0, 1)))


def _loop_for_kernels(loop: Array, position: Array, slopes: Array) -> FaceLoop:
    ends = np.append(position, len(loop))
    way = np.abs(np.diff(walk(loop, ends), axis=0))
    return FaceLoop(np.ascontiguousarray(loop), ends, _ROUNDED_UP * (way @ slopes))


_KNOWN: WeakKeyDictionary[Face, dict[int, _FaceSamples]] = WeakKeyDictionary()


def _samples_of(face: Face, samples: int) -> _FaceSamples:
    known = _KNOWN.setdefault(face, {})
    if samples not in known:
        known[samples] = _FaceSamples(face, samples)
    return known[samples]


def _tree(face: Face, uv: Array) -> Any:
    from scipy.spatial import cKDTree

    return cKDTree(face.evaluate(uv).point) if len(uv) else None


def _starts(tree: Any, targets: Array) -> Index:
    """Numbers of the nearest points of a tree to each target, (n, k)."""
    count = min(STARTS, tree.n)
    return np.asarray(tree.query(targets, k=count)[1], dtype=np.int64).reshape(len(targets), count)


def _search(face: Face, known: _FaceSamples, targets: Array, out: tuple[Array, Array]) -> None:
    """Parameters (n, 2) of the nearest points, and their distances (n,): the border's where it is as near."""
    uv, distance = _search_inside(face, known, targets)
    _search_along(face, known, targets, out, distance)
    closer = distance < out[1]
    out[0][closer], out[1][closer] = uv[closer], distance[closer]


def _search_inside(face: Face, known: _FaceSamples, targets: Array) -> tuple[Array, Array]:
    """Nearest points inside; infinitely far where there is no sample to set out from."""
    uv, least = np.zeros((len(targets), 2)), np.full(len(targets), np.inf)
    if not len(known.grid):
        return uv, least
    starts = known.starts_inside(targets)
    if known.compiled is None:
        return nearest_inside_numpy(face, targets, known.grid, starts)
    nearest_inside(face.surface.data, known.compiled.range, targets, known.grid, starts, (uv, least))
    return uv, least


def _search_along(face: Face, known: _FaceSamples, targets: Array, out: tuple[Array, Array], enough: Array) -> None:
    """Nearest points of the border, as far as they are as near as is enough."""
    for number, loop in enumerate(face.outline):
        starts = known.starts_along(number, targets)
        if known.compiled is not None:
            nearest_along(face.surface.data, known.compiled.loops[number], targets, starts, out, enough)
            continue
        uv, distance = nearest_along_numpy(face, targets, (loop, known.borders[number]), starts)
        nearer = distance < out[1]
        out[0][nearer], out[1][nearer] = uv[nearer], distance[nearer]
