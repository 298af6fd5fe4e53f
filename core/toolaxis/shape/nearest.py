"""The nearest point of a trimmed face to given points."""

from functools import partial
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.golden_section import least_between
from toolaxis.numeric.polygons import stations, walk
from toolaxis.numeric.vectors import as_rows, dot, lengths
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Nearest samples from which the search sets out, inside and on the border.
STARTS = 4
#: Steps at most, the least share of Newton's step that is tried, and the share of a parameter's range below which
#: a step is nothing.
_STEPS, _LEAST_SHARE, _NOTHING = 30, 0.005, 1e-13


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
        self.grid = face.grid(samples, samples)
        self.borders = [stations(loop, ((u1 - u0) / samples, (v1 - v0) / samples)) for loop in face.outline]
        self._inside = _tree(face, self.grid)
        self._along = [_tree(face, walk(loop, at)) for loop, at in zip(face.outline, self.borders, strict=True)]

    def starts_inside(self, targets: Array) -> NDArray[np.int64]:
        """Numbers of the nearest points inside to each target, (n, k)."""
        return _starts(self._inside, targets)

    def starts_along(self, loop: int, targets: Array) -> NDArray[np.int64]:
        """Numbers of the nearest points of a loop to each target, (n, k)."""
        return _starts(self._along[loop], targets)


_KNOWN: WeakKeyDictionary[Face, dict[int, _FaceSamples]] = WeakKeyDictionary()


def _samples_of(face: Face, samples: int) -> _FaceSamples:
    known = _KNOWN.setdefault(face, {})
    if samples not in known:
        known[samples] = _FaceSamples(face, samples)
    return known[samples]


def _tree(face: Face, uv: Array) -> Any:
    from scipy.spatial import cKDTree

    return cKDTree(face.evaluate(uv).point) if len(uv) else None


def _starts(tree: Any, targets: Array) -> NDArray[np.int64]:
    """Numbers of the nearest points of a tree to each target, (n, k)."""
    count = min(STARTS, tree.n)
    return np.asarray(tree.query(targets, k=count)[1], dtype=np.int64).reshape(len(targets), count)


def _answer(face: Face, targets: Array, uv: Array) -> NearestPoints:
    point = face.evaluate(uv).point
    return NearestPoints(uv, point, np.linalg.norm(point - targets, axis=1))


def _pick(found: list[NearestPoints]) -> NearestPoints:
    row, choice = np.arange(len(found[0].distance)), np.argmin([x.distance for x in found], axis=0)
    return NearestPoints(*(np.stack(parts)[choice, row] for parts in zip(*found, strict=True)))


def _from_inside(face: Face, targets: Array, samples: int) -> NearestPoints | None:
    known = _samples_of(face, samples)
    if not len(known.grid):
        return None
    return _pick([_descend(face, targets, known.grid[column]) for column in known.starts_inside(targets).T])


def _descend(face: Face, targets: Array, uv: Array) -> NearestPoints:
    """Newton steps down the squared distance, halved until they descend, as long as they stay on the face."""
    u0, u1, v0, v1 = face.bounds
    low, high = np.array([u0, v0]), np.array([u1, v1])
    best, share, rows = _answer(face, targets, uv), np.ones(len(uv)), np.arange(len(uv))
    for _ in range(_STEPS):
        start = best.uv[rows]
        trial = np.clip(start + share[rows, None] * _newton(face, targets[rows], start), low, high)
        found = _answer(face, targets[rows], trial)
        better = (found.distance < best.distance[rows]) & face.contains(trial)
        for mine, theirs in zip(best, found, strict=True):
            mine[rows[better]] = theirs[better]
        share[rows] = np.where(better, 1.0, 0.5 * share[rows])
        moved = (np.abs(trial - start) > _NOTHING * (high - low)).any(axis=1)
        rows = rows[moved & (share[rows] >= _LEAST_SHARE)]
        if not len(rows):
            break
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
    found, known = [], _samples_of(face, samples)
    for number, loop in enumerate(face.outline):
        position, start = known.borders[number], known.starts_along(number, targets)
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
