"""How far a ray may be followed inwards before another place of the part is nearer than its foot: in thin walls, and
beside edges."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import NearestPoints, NearestSamples, nearest, nearest_sample

Array = NDArray[np.float64]

#: By what share another place has to be nearer than a ray's foot, so that a face that goes on nearly smoothly does not
#: count, and by how much, mm.
_NEARER, _ROUNDING = 0.02, 1e-6
#: Share of a depth that samples of a face may lie apart to tell for all of it: what is square to the way to the nearest
#: place at this share of its length is farther by half of the share's square, half of `_NEARER`.
_DENSE = 0.14


def depth_to_other_places(foot: Array, normal: Array, faces: tuple[Face, ...], depth: Array) -> Array:
    """How far rays may be followed inwards until another place of the part is nearer than their foot.

    What is cut beyond that depth lies below the other place, and is told there; behind a wall there is only air.

    Parameters
    ----------
    foot, normal : (m, 3) array
        Feet of the rays, mm, and directions out of the material.
    faces : tuple of Face
        Of the part, the rays' own among them.
    depth : (m,) array
        Greatest depths, mm.

    Returns
    -------
    (m,) array, mm; never less than the depth where another place begins to be nearer, which counts from 2 % on, and
    from 3 % where samples of a face tell

    Notes
    -----
    A ball that touches the foot of a ray from inside shrinks until no place lies in it; the nearest place to its middle
    tells how small it is next. Middles of such balls are the medial axis. [ma2012] J. Ma, S. W. Bae, S. Choi, "3D
    medial axis point approximation using nearest neighbors and the normal field", The Visual Computer 28 (2012),
    pp. 7-19, section 3.
    """
    limit = depth.copy()
    for face in faces:
        left = np.arange(len(foot))
        unsure = [left[:0]]
        while len(left):
            found = _find_nearer(face, (foot, normal, limit), left, nearest_sample)
            unsure.append(found.unsure)
            left = _shorten(limit, (foot, normal), found)
        left = np.concatenate(unsure)
        while len(left):
            left = _shorten(limit, (foot, normal), _find_nearer(face, (foot, normal, limit), left, nearest))
    return limit


class _Nearer(NamedTuple):
    """Rays that have a place nearer than their feet (k,), these places (k, 3), and rays of which samples are too far
    apart to tell that there is none."""

    ray: NDArray[np.int64]
    place: Array
    unsure: NDArray[np.int64]


def _find_nearer(face: Face, rays: tuple[Array, Array, Array], asked: NDArray[np.int64],
                 search: Callable[[Face, Array], NearestPoints | NearestSamples]) -> _Nearer:
    """Which of some rays, by feet, normals and depths, have a place of a face nearer to their ends than their feet."""
    foot, normal, depth = (each[asked] for each in rays)
    point, least = foot - depth[:, None] * normal, (1.0 - _NEARER) * depth - _ROUNDING
    away = np.maximum(np.maximum(face.box[0] - point, point - face.box[1]), 0.0)
    near = np.linalg.norm(away, axis=1) < least
    rows, least = asked[near], least[near]
    if not len(rows):
        return _Nearer(rows, np.zeros((0, 3)), rows)
    found = search(face, point[near])
    nearer = found.distance < least
    unsure = np.zeros(len(rows), dtype=bool)
    if isinstance(found, NearestSamples):
        coarse = found.apart > _DENSE * found.distance
        unsure = ~nearer & coarse & (found.distance - found.apart < least)
    return _Nearer(rows[nearer], found.point[nearer], rows[unsure])


def _shorten(limit: Array, rays: tuple[Array, Array], found: _Nearer) -> NDArray[np.int64]:
    """Take depths back to where a ball through foot and nearer place has its middle; the rays to be asked again."""
    way = rays[0][found.ray] - found.place
    limit[found.ray] = 0.5 * dot(way, way) / dot(way, rays[1][found.ray])
    return found.ray
