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
    bound = lift / 2 if lift > 0 else 1e-3 * face.diagonal
    loops = [loop for loop in outline_loops(face, bound) if len(loop) > 2]
    if not loops:
        return []
    outlines = [_lift_points(face, np.concatenate([loop, loop[:1]]), lift) for loop in loops]
    # In a plane that is turned by 45 degrees, and has parameters in mm, the lines lie level and at the pitch.
    scale = _parameter_scale(face)
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2.0)
    level_loops = tuple((loop * scale) @ turn.T for loop in loops)
    heights = np.concatenate(level_loops)[:, 1]
    low, high = np.min(heights), np.max(heights)
    step = max(pitch, (high - low) / _MOST)
    share = np.linspace(0.0, 1.0, _POINTS)
    lines = []
    for y in np.arange(low + step / 2, high, step):
        for x0, x1 in chords(level_loops, float(y)):
            x = x0 + share * (x1 - x0)
            level_line = np.stack([x, np.full(_POINTS, y)], axis=1)
            uv = (level_line @ turn) / scale
            lines.append(_lift_points(face, uv, lift))
    return [*outlines, *lines]


def _parameter_scale(face: Face) -> Array:
    """Mean lengths of the units of u and of v on a face, mm; 1 where such a length is zero."""
    u0, u1, v0, v1 = face.bounds
    inside = face.grid(6, 6)
    if not len(inside):
        inside = np.array([[(u0 + u1) / 2, (v0 + v1) / 2]])
    d = face.evaluate(inside)
    mean_u = np.linalg.norm(d.su, axis=1).mean()
    mean_v = np.linalg.norm(d.sv, axis=1).mean()
    scale = np.array([mean_u, mean_v])
    return np.where(scale > 0, scale, 1.0)


def _lift_points(face: Face, uv: Array, lift: float) -> Array:
    """Points above parameters of a face, (n, 3)."""
    (u0, u1), (v0, v1) = face.surface.domain
    rows = np.clip(uv, (u0, v0), (u1, v1))
    return np.asarray(face.evaluate(rows).point + lift * face.normal(rows))
