"""Hatch lines on faces, as polylines in space: a clean-up zone for views that draw lines, not pixels."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import chords
from toolaxis.report.figures.tessellation import outline_loops
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Points along each line, and lines across a face at most.
_POINTS, _MOST = 9, 400


def hatch_lines(face: Face, pitch: float, lift: float = 0.0) -> list[Array]:
    """Slanting lines over a face, and its outline, a little above it.

    Parameters
    ----------
    face : Face
    pitch : float
        Distance of the lines, about, mm.
    lift : float
        How far above the face they lie, mm.

    Returns
    -------
    list of (k, 3) arrays
        The closed outlines first, each with its first point again at its end; then the lines.
    """
    u0, u1, v0, v1 = face.bounds
    inner = face.grid(6, 6)
    d = face.evaluate(inner if len(inner) else np.array([[(u0 + u1) / 2, (v0 + v1) / 2]]))
    scale = np.array([np.linalg.norm(rate, axis=1).mean() for rate in (d.su, d.sv)])
    scale = np.where(scale > 0, scale, 1.0)
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2.0)
    loops = [loop for loop in outline_loops(face, lift / 2 if lift > 0 else 1e-3 * face.diagonal) if len(loop) > 2]
    turned = tuple((loop * scale) @ turn.T for loop in loops)
    made = [_lift_points(face, np.concatenate([loop, loop[:1]]), lift) for loop in loops]
    if not made:
        return []
    low, high = (f(np.concatenate(turned)[:, 1]) for f in (np.min, np.max))
    step = max(pitch, (high - low) / _MOST)
    share = np.linspace(0.0, 1.0, _POINTS)
    for y in np.arange(low + step / 2, high, step):
        for x0, x1 in chords(turned, float(y)):
            row = np.stack([x0 + share * (x1 - x0), np.full(_POINTS, y)], axis=1)
            made.append(_lift_points(face, (row @ turn) / scale, lift))
    return made


def _lift_points(face: Face, uv: Array, lift: float) -> Array:
    """Points above parameters of a face, (n, 3)."""
    (u0, u1), (v0, v1) = face.surface.domain
    rows = np.clip(uv, (u0, v0), (u1, v1))
    return np.asarray(face.evaluate(rows).point + lift * face.normal(rows))
