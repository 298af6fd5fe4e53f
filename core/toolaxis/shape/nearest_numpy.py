"""Nearest points of a face on whole arrays: the plain twin of the kernels, and for surfaces that these cannot take."""

from collections.abc import Sequence
from functools import partial

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
    found = []
    gap = partial(_gap, face, targets, corners)
    for column in starts.T:
        before = np.where(column > 0, position[column - 1], position[-1] - len(corners))
        after = np.append(position, len(corners))[column + 1]
        for low, high in ((before, position[column]), (position[column], after)):
            at, _ = least_between(gap, low, high)
            uv = walk(corners, at)
            found.append((uv, _distances(face, targets, uv)))
    return _pick(found)


def _gap(face: Face, targets: Array, loop: Array, at: Array) -> Array:
    return _distances(face, targets, walk(loop, at))


def _distances(face: Face, targets: Array, uv: Array) -> Array:
    return lengths(face.evaluate(uv).point - targets)


def _pick(found: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    row, choice = np.arange(len(found[0][1])), np.argmin([distance for _, distance in found], axis=0)
    return np.stack([uv for uv, _ in found])[choice, row], np.stack([distance for _, distance in found])[choice, row]


def _descend(face: Face, targets: Array, uv: Array) -> tuple[Array, Array]:
    """Newton steps down the squared distance, halved until they descend, as long as they stay on the face."""
    u0, u1, v0, v1 = face.bounds
    low, high = np.array([u0, v0]), np.array([u1, v1])
    best, distance = uv.copy(), _distances(face, targets, uv)
    share, rows = np.ones(len(uv)), np.arange(len(uv))
    for _ in range(STEPS):
        start = best[rows]
        trial = np.clip(start + share[rows, None] * _newton(face, targets[rows], start), low, high)
        found = _distances(face, targets[rows], trial)
        better = (found < distance[rows]) & face.contains(trial)
        best[rows[better]], distance[rows[better]] = trial[better], found[better]
        share[rows] = np.where(better, 1.0, 0.5 * share[rows])
        moved = (np.abs(trial - start) > NOTHING * (high - low)).any(axis=1)
        rows = rows[moved & (share[rows] >= LEAST_SHARE)]
        if not len(rows):
            break
    return best, distance


def _newton(face: Face, targets: Array, uv: Array) -> Array:
    """Steps of Newton's method, of Gauss and Newton's where the former would climb."""
    d = face.evaluate(uv)
    gap = d.point - targets
    fu, fv = dot(gap, d.su), dot(gap, d.sv)
    e, f, g = dot(d.su, d.su), dot(d.su, d.sv), dot(d.sv, d.sv)
    a, b, c = e + dot(gap, d.suu), f + dot(gap, d.suv), g + dot(gap, d.svv)
    full = (a > 0) & (a * c - b * b > 1e-12 * e * g)
    a, b, c = np.where(full, a, e * (1 + 1e-9)), np.where(full, b, f), np.where(full, c, g * (1 + 1e-9))
    determinant = a * c - b * b
    step = np.stack([b * fv - c * fu, b * fu - a * fv], axis=1)
    return np.asarray(step / np.where(determinant > 0, determinant, np.inf)[:, None])
