"""Distance of points to a cutter whose axis moves along the pass."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.swept_cutter import meridian_distance
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_fma_inline
from toolaxis.work import spend

Array = NDArray[np.float64]

_GOLDEN = 0.6180339887498949
#: Steps of the golden section between the positions around the least one: to a thousandth of their distance.
_STEPS = 15
#: As many bounds of distances as take as long as the distances of no points, and of one.
_QUESTION, _POINT = 20, 5


def least_distance_to_positions(cutter: CutterParameters, points: Array, tips: Array, axes: Array) -> Array:
    """Least signed distance of points to a cutter on its way past, (n, m) mm.

    The least one of the positions is found first, and then the least between its neighbours, on parabolas through the
    three tips and the three axes.

    Parameters
    ----------
    cutter : CutterParameters
    points : (n, m, 3) array
        mm
    tips, axes : (n, k, 3) array
        Positions at even places in the order of the pass, k of at least 3, axes of unit length: those of row i are for
        the points of row i.

    Notes
    -----
    **Properties**: 1. never above the least over the positions themselves; 2. on a plane, where the axis stands still,
    the distance to the cutter swept along the pass.
    """
    rows, at, turn = (np.ascontiguousarray(part, dtype=float) for part in (points, tips, axes))
    spend(_QUESTION + _POINT * rows.shape[0] * rows.shape[1])
    if _compiled.available:
        out = np.empty(rows.shape[:2])
        _least(cutter, rows, (at, turn), out)
        return out
    return _least_numpy(cutter, rows, at, turn)


def cutter_distances(cutter: CutterParameters, apart: Array, axes: Array) -> Array:
    """Signed distances of points relative to the tip, (..., 3), to the cutter, with axes of any length; mm.

    Parameters
    ----------
    cutter : CutterParameters
    apart, axes : (..., 3) array
    """
    z = (apart * axes).sum(axis=-1) / np.linalg.norm(axes, axis=-1)
    rho = np.sqrt(np.maximum((apart**2).sum(axis=-1) - z**2, 0.0))
    a, r, cos_side, sin_side, top = cutter[:5]
    x, y = rho - a, z - r
    arc = (x >= 0) & (y * cos_side + x * sin_side <= 0)
    planes = np.maximum(np.maximum(-z, x * cos_side - y * sin_side - r), z - top)
    return np.asarray(np.where(arc, np.hypot(x, y) - r, planes))


def _least_numpy(cutter: CutterParameters, points: Array, tips: Array, axes: Array) -> Array:
    """The plain twin."""
    off = cutter_distances(cutter, points[:, :, None] - tips[:, None], axes[:, None])
    middle = np.clip(np.argmin(off, axis=2), 1, off.shape[2] - 2)
    row = np.arange(len(points))[:, None]
    near = [[each[row, middle + k] for k in (-1, 0, 1)] for each in (tips, axes)]

    def _at(t: Array) -> Array:
        weights = (t * (t - 1) / 2)[..., None], ((1 - t) * (1 + t))[..., None], (t * (t + 1) / 2)[..., None]
        tip, axis = (sum(w * one for w, one in zip(weights, three, strict=True)) for three in near)
        return cutter_distances(cutter, points - tip, axis)

    low, high = np.full(middle.shape, -1.0), np.full(middle.shape, 1.0)
    best = off.min(axis=2)
    for _ in range(_STEPS):
        a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        left, right = _at(a), _at(b)
        best = np.minimum(best, np.minimum(left, right))
        low, high = np.where(left < right, low, a), np.where(left < right, b, high)
    return np.asarray(best)


@jit_fma_inline
def _between(cutter: CutterParameters, point: Array, near: tuple[Array, Array], t: float) -> float:
    """Distance to the cutter at t from -1 to 1 on the parabolas through three positions."""
    tips, axes = near
    before, here, after = t * (t - 1.0) / 2.0, (1.0 - t) * (1.0 + t), t * (t + 1.0) / 2.0
    square = height = size = 0.0
    for c in range(3):
        axis = before * axes[0, c] + here * axes[1, c] + after * axes[2, c]
        apart = point[c] - (before * tips[0, c] + here * tips[1, c] + after * tips[2, c])
        square += apart * apart
        height += apart * axis
        size += axis * axis
    height /= np.sqrt(size)
    rho = np.sqrt(max(square - height * height, 0.0))
    return meridian_distance(cutter, rho, height)[0]


@jit
def _least(cutter: CutterParameters, points: Array, positions: tuple[Array, Array], out: Array) -> None:
    tips, axes = positions
    count = tips.shape[1]
    for i in range(points.shape[0]):
        for j in range(points.shape[1]):
            point, best, middle = points[i, j], np.inf, 1
            for k in range(count):
                x, y, z = point[0] - tips[i, k, 0], point[1] - tips[i, k, 1], point[2] - tips[i, k, 2]
                height = x * axes[i, k, 0] + y * axes[i, k, 1] + z * axes[i, k, 2]
                rho = np.sqrt(max(x * x + y * y + z * z - height * height, 0.0))
                off = meridian_distance(cutter, rho, height)[0]
                if off < best:
                    best, middle = off, min(max(k, 1), count - 2)
            near = (tips[i, middle - 1:middle + 2], axes[i, middle - 1:middle + 2])
            low, high = -1.0, 1.0
            for _ in range(_STEPS):
                a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
                left, right = _between(cutter, point, near, a), _between(cutter, point, near, b)
                best = min(best, min(left, right))
                if left < right:
                    high = b
                else:
                    low = a
            out[i, j] = best
