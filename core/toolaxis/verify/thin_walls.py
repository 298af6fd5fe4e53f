"""Thin walls: how far a ray may be followed inwards before it is nearer to the other side of the part."""

from math import sqrt
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.rays import SPACING, Rays, face_rays

Array = NDArray[np.float64]

#: A face looks the other way where the cosine of the angle between its normal and the ray's is below this: a ray near
#: an edge leaves the part through a face that looks ever so little down.
AGAINST = -0.04
#: Places on a side of a face where walls are looked for, steps to the middle of one, and rays looked at at once.
_SIDE, _STEPS, _AT_ONCE = 100, 6, 512
#: Change of a way below which it is no other, mm: a hundredth of the error of a depth.
_SETTLED = 1e-8


def wall_depth(foot: Array, normal: Array, faces: tuple[Face, ...], depth: float) -> Array:
    """How far rays may be followed inwards: the depth, or to the middle between their face and one that looks the
    other way.

    Parameters
    ----------
    foot, normal : (m, 3) array
        Feet of the rays, mm, and normals out of the material.
    faces : tuple of Face
        Those that may be on the other side, the rays' own among them.
    depth : float
        Greatest depth, mm.

    Returns
    -------
    (m,) array, mm
    """
    limit = np.full(len(foot), depth)
    for face in faces:
        near = np.flatnonzero(((foot > face.box[0] - depth) & (foot < face.box[1] + depth)).all(axis=1))
        for first in range(0, len(near), _AT_ONCE):
            rows = near[first:first + _AT_ONCE]
            start = _first_guess(face, foot[rows], normal[rows], depth)
            some = rows[np.isfinite(start)]
            if len(some):
                middle = _middle(face, foot[some], normal[some], start[np.isfinite(start)])
                limit[some] = np.minimum(limit[some], middle)
    return limit


def _first_guess(face: Face, foot: Array, normal: Array, depth: float) -> Array:
    """About how far along rays a face looks the other way, mm; infinite where it does not."""
    start = np.full(len(foot), np.inf)
    rays = _places(face)
    radius = np.hypot(0.5 * depth, 1.5 * rays.spacing)
    near = _tree_of(face).query_ball_point(foot - 0.5 * depth * normal, radius)
    counts = np.array([len(places) for places in near])
    if not counts.any():
        return start
    ray, place = np.repeat(np.arange(len(foot)), counts), np.concatenate(near).astype(np.int64)
    inwards = dot(foot[ray] - rays.point[place], normal[ray])
    wall = (inwards > 0) & (dot(rays.normal[place], normal[ray]) < AGAINST)
    ray, inwards = ray[wall], inwards[wall]
    order = np.lexsort((inwards, ray))
    ray, inwards = ray[order], inwards[order]
    which, first, count = np.unique(ray, return_index=True, return_counts=True)
    median = 0.5 * (inwards[first + (count - 1) // 2] + inwards[first + count // 2])
    start[which] = np.minimum(median, depth)
    return start


def _places(face: Face) -> Rays:
    """Places all over a face, fewer on a large one than it is judged at."""
    return face_rays(face, max(SPACING, sqrt(face.area) / _SIDE))


_TREES: WeakKeyDictionary[Face, Any] = WeakKeyDictionary()


def _tree_of(face: Face) -> Any:
    """The places of a face in a tree, which many rays ask."""
    from scipy.spatial import cKDTree

    if face not in _TREES:
        _TREES[face] = cKDTree(_places(face).point)
    return _TREES[face]


def _middle(face: Face, foot: Array, normal: Array, start: Array) -> Array:
    """How far along rays the middle of a wall is whose other side a face is, mm; infinite where it is no wall there.

    Where the nearest place of the face lies across the wall, its plane tells how far the middle is; a few steps lead to
    the place that is nearest to the middle itself.
    """
    way, left = start.copy(), np.arange(len(foot))
    at, outwards, distance = np.empty_like(foot), np.empty_like(foot), np.empty(len(foot))
    for step in range(_STEPS + 1):
        found = nearest(face, foot[left] - way[left, None] * normal[left])
        at[left], outwards[left], distance[left] = found.point, face.normal(found.uv), found.distance
        if step == _STEPS:
            break
        against = dot(outwards[left], normal[left])
        across = against < AGAINST
        far = dot(outwards[left], at[left] - foot[left]) / np.maximum(1.0 - against, 1.0)
        further = np.maximum(np.where(across, far, 1.5 * way[left]), 0.0)
        moved = np.abs(further - way[left]) > _SETTLED
        way[left] = further
        # Where the way stays as it was, so does the place, and all that comes of it.
        left = left[moved]
        if not len(left):
            break
    beyond = dot(outwards, at - foot + way[:, None] * normal)
    # The way to the face must be square to it and as long as the way to the ray's foot: else the face ends before.
    sound = (dot(outwards, normal) < AGAINST) & (distance <= 1.02 * np.abs(beyond) + 1e-6)
    sound &= np.abs(beyond - way) <= 0.02 * way + 1e-6
    return np.asarray(np.where(sound, way, np.inf))
