"""Thin walls: how far a ray may be followed inwards before it leaves the part on the other side."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.verify.rays import Rays

Array = NDArray[np.float64]

#: Share of a wall's thickness to which gouges are followed: each half belongs to its own side.
SHARE = 0.5


def wall_depth(foot: Array, normal: Array, faces: tuple[Rays, ...], depth: float) -> Array:
    """How far rays may be followed inwards: the depth, or less where a face that looks the other way is nearer.

    Parameters
    ----------
    foot, normal : (m, 3) array
        Feet of the rays, mm, and normals out of the material.
    faces : tuple of Rays
        Points and normals of the faces that may be on the other side.
    depth : float
        Greatest depth, mm.

    Returns
    -------
    (m,) array, mm
    """
    from scipy.spatial import cKDTree

    limit = np.full(len(foot), depth)
    for rays in faces:
        tree = cKDTree(rays.point)
        radius = np.hypot(0.5 * depth, 1.5 * rays.spacing)
        for i, rows in enumerate(tree.query_ball_point(foot - 0.5 * depth * normal, radius)):
            way = foot[i] - rays.point[rows]
            inwards = way @ normal[i]
            aside = np.linalg.norm(way - inwards[:, None] * normal[i], axis=1)
            wall = (inwards > 0) & (aside <= 1.5 * rays.spacing) & (rays.normal[rows] @ normal[i] < -0.2)
            if wall.any():
                limit[i] = min(limit[i], SHARE * float(inwards[wall].min()))
    return limit
