"""Nearest points of a face on whole arrays: the plain twin of the kernels, and for surfaces that these cannot take."""

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.golden_section import least_between
from toolaxis.numeric.polygons import walk
from toolaxis.numeric.vectors import dot, lengths
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Steps at most, the least share of Newton's step that is tried, and the share of a parameter's range below which
#: a step is nothing.
STEPS, LEAST_SHARE, NOTHING = 30, 0.005, 1e-13


class _FacePoints(NamedTuple):
    """Points of a face by their parameters, (n, 2), and their distances from the targets, (n,) mm."""

    uv: Array
    distance: Array


def nearest_inside_numpy(face: Face, targets: Array, grid: Array, starts: Index) -> tuple[Array, Array]:
    """Parameters (n, 2) of the nearest points inside a face, and their distances, mm.

    Parameters
    ----------
    face : Face
    targets : (n, 3) array
        mm
    grid : (m, 2) array
        Parameters of points inside.
    starts : (n, k) array of int
        From which of them each search sets out.
    """
    return _pick([_descend(face, targets, grid[column]) for column in starts.T])


def nearest_along_numpy(face: Face, targets: Array, loop: tuple[Array, Array], starts: Index) -> tuple[Array, Array]:
    """Parameters (n, 2) of the nearest points of a loop of a face, and their distances, mm.

    Parameters
    ----------
    face : Face
    targets : (n, 3) array
        mm
    loop : (m, 2) array, (k,) array
        Its corners, and positions of points along it, for `walk`.
    starts : (n, j) array of int
        On both sides of which of them it is looked for the nearest point.
    """
    corners, position = loop
    whole = len(corners)
    found = []
    gap = partial(_gap, face, targets, corners)
    for column in starts.T:
        here = position[column]
        before = np.where(column > 0, position[column - 1], position[-1] - whole)
        after = np.append(position, whole)[column + 1]
        for low, high in ((before, here), (here, after)):
            nearest, _ = least_between(gap, low, high)
            uv = walk(corners, nearest)
            found.append(_FacePoints(uv, _distances(face, targets, uv)))
    return _pick(found)


def _gap(face: Face, targets: Array, loop: Array, at: Array) -> Array:
    return _distances(face, targets, walk(loop, at))


def _distances(face: Face, targets: Array, uv: Array) -> Array:
    return lengths(face.evaluate(uv).point - targets)


def _pick(found: Sequence[_FacePoints]) -> _FacePoints:
    """The nearest of several points for each target."""
    distances = np.stack([points.distance for points in found])
    parameters = np.stack([points.uv for points in found])
    choice = np.argmin(distances, axis=0)
    row = np.arange(len(choice))
    return _FacePoints(parameters[choice, row], distances[choice, row])


def _descend(face: Face, targets: Array, uv: Array) -> _FacePoints:
    """Newton steps down the squared distance, halved until they descend, as long as they stay on the face."""
    u0, u1, v0, v1 = face.bounds
    low = np.array([u0, v0])
    high = np.array([u1, v1])
    least_move = NOTHING * (high - low)
    best = uv.copy()
    distance = _distances(face, targets, uv)
    share = np.ones(len(uv))
    rows = np.arange(len(uv))  # of the searches that still move
    for _ in range(STEPS):
        start = best[rows]
        step = share[rows, None] * _newton_step(face, targets[rows], start)
        trial = np.clip(start + step, low, high)
        found = _distances(face, targets[rows], trial)
        is_better = (found < distance[rows]) & face.contains(trial)
        improved = rows[is_better]
        best[improved] = trial[is_better]
        distance[improved] = found[is_better]
        share[rows] = np.where(is_better, 1.0, 0.5 * share[rows])
        has_moved = (np.abs(trial - start) > least_move).any(axis=1)
        rows = rows[has_moved & (share[rows] >= LEAST_SHARE)]
        if not len(rows):
            break
    return _FacePoints(best, distance)


def _newton_step(face: Face, targets: Array, uv: Array) -> Array:
    """Steps of Newton's method, of Gauss and Newton's where the former would climb, (n, 2)."""
    d = face.evaluate(uv)
    gap = d.point - targets
    # Half the gradient of the squared distance.
    slope_u = dot(gap, d.su)
    slope_v = dot(gap, d.sv)
    # The first fundamental form is Gauss and Newton's matrix; with the bend of the face it is Newton's.
    e = dot(d.su, d.su)
    f = dot(d.su, d.sv)
    g = dot(d.sv, d.sv)
    h_uu = e + dot(gap, d.suu)
    h_uv = f + dot(gap, d.suv)
    h_vv = g + dot(gap, d.svv)
    descends = (h_uu > 0) & (h_uu * h_vv - h_uv * h_uv > 1e-12 * e * g)
    h_uu = np.where(descends, h_uu, e * (1 + 1e-9))
    h_uv = np.where(descends, h_uv, f)
    h_vv = np.where(descends, h_vv, g * (1 + 1e-9))
    determinant = h_uu * h_vv - h_uv * h_uv
    step = np.stack([h_uv * slope_v - h_vv * slope_u, h_uv * slope_u - h_uu * slope_v], axis=1)
    divisor = np.where(determinant > 0, determinant, np.inf)
    return np.asarray(step / divisor[:, None])
