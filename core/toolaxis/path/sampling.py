"""Representative points of a face: clustered binary space partition in location, normal and curvature."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.numeric.feature_partition import partition
from toolaxis.shape.differential import curvatures
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_GRID = 48
_ENOUGH = 700
#: Where lines across a face stand for its passes, as shares of the way across; points of each.
_ACROSS, _POINTS = (0.02, 0.15, 0.3, 0.5, 0.7, 0.85, 0.98), 161


@dataclass(frozen=True, eq=False)
class Samples:
    """Sample points with the patches they stand for.

    Attributes
    ----------
    uv : (n, 2) array
        Sample points: the mean parameters of the patch's inside points, or the inside point nearest to that where it
        falls off the face.
    rectangles : (n, 4) array
        u0, u1, v0, v1 of each patch; together they tile the parameter range of the face.
    extents : (n, 4) array
        u0, u1, v0, v1 of the part of each patch that lies on the face.
    """

    uv: Array
    rectangles: Array
    extents: Array

    def __len__(self) -> int:
        return len(self.uv)

    def owner(self, uv: Array) -> NDArray[np.int64]:
        """Sample whose patch holds each parameter, or the nearest patch where none does.

        Parameters
        ----------
        uv : (n, 2) array

        Returns
        -------
        (n,) array of int
        """
        low = self.rectangles[:, [0, 2]]
        high = self.rectangles[:, [1, 3]]
        span = high.max(axis=0) - low.min(axis=0)
        size = np.maximum(span, np.finfo(float).tiny)
        places = uv[:, None]
        outside = np.maximum(low - places, places - high) / size
        distance = np.maximum(outside, 0.0).sum(axis=2)
        return np.asarray(distance.argmin(axis=1), dtype=np.int64)


def sample_points(face: Face, tool: Tool, tolerance: float = 0.1,
                  weights: tuple[float, float, float] = (1 / 3, 1 / 3, 1 / 3)) -> Samples:
    """Sample points that stand for a face.

    Parameters
    ----------
    face : Face
    tool : Tool
        Its radius makes curvatures comparable with the other features.
    tolerance : float
        Greatest weighted distance in features of a grid point to the centroid of its patch.
    weights : (float, float, float)
        Of location / box diagonal, normal, and principal curvatures times the cutter radius.

    Returns
    -------
    Samples

    Raises
    ------
    InvalidInput
        When the tolerance is not above zero or a weight is negative or all are zero.
    UnsupportedGeometry
        When no grid point falls on the face.

    Notes
    -----
    **Source**: [zhu2016] Sec. 3.2; the features' normalisation, left open there, and the choice of the parameter to
    cut in are ours.

    **Properties**: (1) patches tile the parameter range; (2) every grid point is within the tolerance of its
    centroid; (3) sample points lie on the face; (4) moving the face moves nothing in (u, v).
    """
    if not tolerance > 0:
        raise InvalidInput(f"tolerance of sample points is {tolerance}: it must be above zero")
    if len(weights) != 3 or min(weights) < 0 or not sum(weights) > 0:
        raise InvalidInput(f"weights are {weights}: three numbers of zero or more, not all zero, are needed")
    uv, cell = _grid(face)
    groups = _features(face, tool, uv, weights)
    patches = partition(uv, groups, tolerance, np.array(face.bounds))
    extents = np.array([_extent(uv[p.members], cell, p.rectangle) for p in patches])
    means = np.array([uv[p.members].mean(axis=0) for p in patches])
    for i in np.flatnonzero(~face.contains(means)):
        inside = uv[patches[i].members]
        away = (inside - means[i]) / cell
        square = (away**2).sum(axis=1)
        means[i] = inside[np.argmin(square)]
    rectangles = np.array([p.rectangle for p in patches])
    return Samples(means, rectangles, extents)


def _features(face: Face, tool: Tool, uv: Array, weights: tuple[float, float, float]) -> tuple[Array, Array, Array]:
    """Weighted location, normal and principal curvatures at places of a face, without units."""
    of_location, of_normal, of_curvature = weights
    d = face.evaluate(uv)
    normal = face.normal(uv, d)
    k = curvatures(d, normal)
    location = of_location * d.point / face.diagonal
    bends = of_curvature * tool.radius * np.column_stack([k.k1, k.k2])
    return location, of_normal * normal, bends


def _grid(face: Face) -> tuple[Array, Array]:
    """Even grid of inside points, and the size of its cells."""
    u0, u1, v0, v1 = face.bounds
    coarse = face.grid(9, 9)
    if not len(coarse):
        coarse = np.array([[(u0 + u1) / 2, (v0 + v1) / 2]])
    probe = face.evaluate(coarse)
    long_u = np.linalg.norm(probe.su, axis=1).mean() * (u1 - u0)
    long_v = np.linalg.norm(probe.sv, axis=1).mean() * (v1 - v0)
    aspect = 1.0
    if long_u > 0 and long_v > 0:
        aspect = np.sqrt(long_u / long_v)
    nu = _lines(aspect)
    nv = _lines(1 / aspect)
    for _ in range(5):
        uv = face.grid(nu, nv)
        if len(uv) >= _ENOUGH:
            break
        nu = 2 * nu
        nv = 2 * nv
    if not len(uv):
        raise UnsupportedGeometry(f"face {face.label} has no point on a {nu} x {nv} grid of its parameters: "
                                  "its trim loops enclose next to nothing; leave it out or repair it")
    return uv, np.array([(u1 - u0) / nu, (v1 - v0) / nv])


def _lines(aspect: float) -> int:
    """Lines of the grid one way, on a face that is so much longer this way than the other."""
    wanted = round(_GRID * aspect)
    return int(np.clip(wanted, _GRID / 4, 4 * _GRID))


def _extent(inside: Array, cell: Array, rectangle: Array) -> Array:
    """The rectangle, drawn in to half a cell beyond the points on each side where the face does not fill it."""
    low = inside.min(axis=0)
    high = inside.max(axis=0)
    near = rectangle[[0, 2]]
    far = rectangle[[1, 3]]
    is_open_below = low - near > 1.01 * cell
    is_open_above = far - high > 1.01 * cell
    u0, v0 = np.where(is_open_below, low - cell / 2, near)
    u1, v1 = np.where(is_open_above, high + cell / 2, far)
    return np.array([u0, u1, v0, v1])


def sample_passes(face: Face, along: int) -> list[Array]:
    """A few iso-parametric lines on a face that stand for its passes.

    Parameters
    ----------
    face : Face
    along : int
        0 for lines along u, 1 for lines along v.

    Returns
    -------
    list of (n, 2) array
        Parameters of each stretch inside the face, ascending.
    """
    u0, u1, v0, v1 = face.bounds
    begin, end = (u0, u1) if along == 0 else (v0, v1)
    low, high = (v0, v1) if along == 0 else (u0, u1)
    across = 1 - along
    found = []
    for share in _ACROSS:
        uv = np.empty((_POINTS, 2))
        uv[:, along] = np.linspace(begin, end, _POINTS)
        uv[:, across] = low + share * (high - low)
        inside = np.concatenate([[False], face.contains(uv), [False]])
        starts = np.flatnonzero(~inside[:-1] & inside[1:])
        stops = np.flatnonzero(inside[:-1] & ~inside[1:])
        found += [uv[first:after] for first, after in zip(starts, stops, strict=True)]
    return found
