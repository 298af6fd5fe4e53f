"""The nearest point of a trimmed face to given points."""

from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.golden_section import least_between
from toolaxis.numeric.polygons import stations, walk
from toolaxis.numeric.vectors import as_rows, dot, lengths
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Nearest samples from which the search sets out, inside and on the border.
STARTS = 4


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
    targets = as_rows(points, 3, "point")
    best = _from_border(face, targets, samples)
    inner = _from_inside(face, targets, samples)
    if inner is None:
        return best
    closer = inner.distance < best.distance
    return NearestPoints(*(np.where(closer if x.ndim == 1 else closer[:, None], x, y)
                           for x, y in zip(inner, best, strict=True)))


def _starts(samples: Array, targets: Array) -> NDArray[np.int64]:
    """Numbers of the nearest samples to each target, (n, k)."""
    from scipy.spatial import cKDTree

    count = min(STARTS, len(samples))
    return np.asarray(cKDTree(samples).query(targets, k=count)[1], dtype=np.int64).reshape(len(targets), count)


def _answer(face: Face, targets: Array, uv: Array) -> NearestPoints:
    point = face.evaluate(uv).point
    return NearestPoints(uv, point, np.linalg.norm(point - targets, axis=1))


def _pick(found: list[NearestPoints]) -> NearestPoints:
    row, choice = np.arange(len(found[0].distance)), np.argmin([x.distance for x in found], axis=0)
    return NearestPoints(*(np.stack(parts)[choice, row] for parts in zip(*found, strict=True)))


def _from_inside(face: Face, targets: Array, samples: int) -> NearestPoints | None:
    grid = face.grid(samples, samples)
    if not len(grid):
        return None
    start = _starts(face.evaluate(grid).point, targets)
    return _pick([_descend(face, targets, grid[column]) for column in start.T])


def _descend(face: Face, targets: Array, uv: Array) -> NearestPoints:
    """Newton steps down the squared distance, halved until they descend, as long as they stay on the face."""
    u0, u1, v0, v1 = face.bounds
    low, high = np.array([u0, v0]), np.array([u1, v1])
    best, share = _answer(face, targets, uv), np.ones(len(uv))
    for _ in range(30):
        trial = np.clip(best.uv + share[:, None] * _newton(face, targets, best.uv), low, high)
        found = _answer(face, targets, trial)
        better = (found.distance < best.distance) & face.contains(trial)
        if not better.any() and (share < 0.01).all():
            break
        share = np.where(better, 1.0, 0.5 * share)
        best = NearestPoints(*(np.where(better if x.ndim == 1 else better[:, None], x, y)
                               for x, y in zip(found, best, strict=True)))
    return best


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


def _from_border(face: Face, targets: Array, samples: int) -> NearestPoints:
    u0, u1, v0, v1 = face.bounds
    found = []
    for loop in face.outline:
        position = stations(loop, ((u1 - u0) / samples, (v1 - v0) / samples))
        start = _starts(face.evaluate(walk(loop, position)).point, targets)
        gap = partial(_gap, face, targets, loop)
        for column in start.T[:2]:
            before = np.where(column > 0, position[column - 1], position[-1] - len(loop))
            after = np.append(position, len(loop))[column + 1]
            for low, high in ((before, position[column]), (position[column], after)):
                at, _ = least_between(gap, low, high)
                found.append(_answer(face, targets, walk(loop, at)))
    return _pick(found)


def _gap(face: Face, targets: Array, loop: Array, at: Array) -> Array:
    return lengths(face.evaluate(walk(loop, at)).point - targets)
