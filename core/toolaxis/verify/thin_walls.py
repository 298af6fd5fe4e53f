"""How far a ray may be followed inwards before another place of the part is nearer than its foot: in thin walls, and
beside edges."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

#: By what share another place has to be nearer than a ray's foot, so that a face that goes on nearly smoothly does not
#: count, and by how much, mm.
_NEARER, _ROUNDING = 0.02, 1e-6


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
    (m,) array, mm; never less than the depth where another place begins to be nearer, which counts from 2 % on

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
        while len(left):
            left, nearest_to = _find_nearer(face, foot, normal, limit, left)
            way = foot[left] - nearest_to
            limit[left] = 0.5 * dot(way, way) / dot(way, normal[left])
    return limit


def _find_nearer(face: Face, foot: Array, normal: Array, depth: Array,
                 asked: NDArray[np.int64]) -> tuple[NDArray[np.int64], Array]:
    """Which of some rays, at their depths, have a place of a face nearer than their feet, and these places, (k, 3)."""
    point, least = foot[asked] - depth[asked, None] * normal[asked], (1.0 - _NEARER) * depth[asked] - _ROUNDING
    away = np.maximum(np.maximum(face.box[0] - point, point - face.box[1]), 0.0)
    rows = np.flatnonzero(np.linalg.norm(away, axis=1) < least)
    if not len(rows):
        return rows, np.zeros((0, 3))
    found = nearest(face, point[rows])
    nearer = found.distance < least[rows]
    return asked[rows[nearer]], found.point[nearer]
