"""Thin walls: how far a ray may be followed inwards before it leaves the part on the other side."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.verify.rays import Rays, default_spacing, face_rays

Array = NDArray[np.float64]

#: Share of a wall's thickness to which gouges are followed: each half belongs to its own side.
SHARE = 0.5
#: Share of its diagonal by which a face may leave its box; pairs of a ray and a place of a face that are held together.
BOX, PAIRS = 1e-3, 500_000


def wall_depth(foot: Array, normal: Array, faces: tuple[Face, ...], depth: float) -> Array:
    """How far rays may be followed inwards: the depth, or less where a face that looks the other way is nearer.

    Parameters
    ----------
    foot, normal : (m, 3) array
        Feet of the rays, mm, and normals out of the material.
    faces : tuple of Face
        Those that may be on the other side.
    depth : float
        Greatest depth, mm.

    Returns
    -------
    (m,) array, mm
    """
    limit = np.full(len(foot), depth)
    for face in faces:
        reach = depth + 2.0 * default_spacing(face) + BOX * face.diagonal
        low, high = face.box[0] - reach, face.box[1] + reach
        rows = np.flatnonzero(((foot > low) & (foot < high)).all(axis=1))
        if len(rows):
            limit[rows] = np.minimum(limit[rows], _through(foot[rows], normal[rows], face_rays(face), depth))
    return limit


def _through(foot: Array, normal: Array, rays: Rays, depth: float) -> Array:
    """The same for one face: infinite where it is not on the other side."""
    from scipy.spatial import cKDTree

    limit = np.full(len(foot), np.inf)
    tree, middle = cKDTree(rays.point), foot - 0.5 * depth * normal
    radius = float(np.hypot(0.5 * depth, 1.5 * rays.spacing))
    count = tree.query_ball_point(middle, radius, return_length=True)
    for some in np.split(np.arange(len(foot)), np.flatnonzero(np.diff(np.cumsum(count) // PAIRS)) + 1):
        for i, near in zip(some, tree.query_ball_point(middle[some], radius), strict=True):
            way = foot[i] - rays.point[near]
            inwards = way @ normal[i]
            aside = np.linalg.norm(way - inwards[:, None] * normal[i], axis=1)
            wall = (inwards > 0) & (aside <= 1.5 * rays.spacing) & (rays.normal[near] @ normal[i] < -0.2)
            if wall.any():
                limit[i] = SHARE * float(inwards[wall].min())
    return limit
