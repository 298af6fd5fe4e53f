"""The yardstick of strip widths: 64 points of a section, three Newton steps each, for one axis and contact.

The pass is a parabola through three tips; each point of the lifted section looks along it for the nearest position of
the corner's ring, and the half width ends between the last point inside and the first outside.  It is no exact width:
it stands here to compare rates, and its distance from the exact one is printed beside them.
"""

from math import sqrt
from typing import TypeAlias

import numpy as np

from toolaxis.numeric.jit import jit_fma
from toolaxis.numeric.vectors import perpendicular
from toolaxis.shape.face import Face

Sizes: TypeAlias = tuple[np.ndarray, float]
"""Cutter, and height of the section's points above the surface, mm."""

POINTS, STEPS = 64, 3
#: Distance of the points along the section and of the three tips along the pass, mm.
SPACING, REACH = 0.125, 1.0


def sections(face: Face, uv: np.ndarray, cutter: np.ndarray, lift: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lifted points to either side of each contact (n, 3, 64), nodes of the pass (n, 3, 6), and |Sv| (n,)."""
    d = face.evaluate(uv)
    pace = np.linalg.norm(d.sv, axis=1)
    away = SPACING * np.r_[-np.arange(1, POINTS // 2 + 1), np.arange(1, POINTS // 2 + 1)]
    across = np.stack(np.broadcast_arrays(uv[:, :1], uv[:, 1:] + away / pace[:, None]), axis=-1).reshape(-1, 2)
    points = (face.evaluate(across).point + lift * face.normal(across)).reshape(len(uv), POINTS, 3)
    ahead = uv[:, None] + REACH / np.linalg.norm(d.su, axis=1)[:, None, None] * np.array([[-1, 0], [0, 0], [1, 0]])
    ahead = ahead.reshape(-1, 2)
    normal = face.normal(ahead)
    nodes = np.column_stack([face.evaluate(ahead).point + cutter[5] * normal, normal]).reshape(len(uv), 3, 6)
    return np.ascontiguousarray(points.transpose(0, 2, 1)), nodes, pace


def frames(axes: np.ndarray) -> np.ndarray:
    """Two perpendiculars and the axis, (k, 3, 3)."""
    return np.array([[*perpendicular(axis), axis] for axis in axes])


@jit_fma
def _parabola(nodes: np.ndarray, frame: np.ndarray, cutter: np.ndarray, tips: np.ndarray) -> None:
    """Tip, first and second derivative of the pass in the tool's frame into tips (3, 3)."""
    for k in range(3):
        x = y = z = u = v = h = 0.0
        for c in range(3):
            x += frame[0, c] * nodes[k, c]
            y += frame[1, c] * nodes[k, c]
            z += frame[2, c] * nodes[k, c]
            u += frame[0, c] * nodes[k, 3 + c]
            v += frame[1, c] * nodes[k, 3 + c]
        h = cutter[0] / sqrt(u * u + v * v)
        tips[k, 0], tips[k, 1], tips[k, 2] = x + h * u, y + h * v, z - cutter[1]
    for c in range(3):
        low, middle, high = tips[0, c], tips[1, c], tips[2, c]
        tips[0, c], tips[1, c], tips[2, c] = middle, 0.5 * (high - low), high - 2.0 * middle + low


@jit_fma
def _gaps(points: np.ndarray, frame: np.ndarray, cutter: np.ndarray, tips: np.ndarray, gaps: np.ndarray) -> None:
    """Distances of all points from the ring of the corner, without a branch."""
    e0, e1, e2, e3, e4, e5 = frame[0, 0], frame[0, 1], frame[0, 2], frame[1, 0], frame[1, 1], frame[1, 2]
    e6, e7, e8, a, r = frame[2, 0], frame[2, 1], frame[2, 2], cutter[0], cutter[1]
    t0, t1, t2, m0, m1, m2 = tips[0, 0], tips[0, 1], tips[0, 2], tips[1, 0], tips[1, 1], tips[1, 2]
    n0, n1, n2 = tips[2, 0], tips[2, 1], tips[2, 2]
    for i in range(POINTS):
        x, y, z = points[0, i], points[1, i], points[2, i]
        p = e0 * x + e1 * y + e2 * z - t0
        q = e3 * x + e4 * y + e5 * z - t1
        s = e6 * x + e7 * y + e8 * z - t2 - r
        w = 0.0
        for _ in range(STEPS):
            du, dv, dh = m0 + n0 * w, m1 + n1 * w, m2 + n2 * w
            x, y, z = p - 0.5 * w * (m0 + du), q - 0.5 * w * (m1 + dv), s - 0.5 * w * (m2 + dh)
            rho = sqrt(x * x + y * y)
            over, t = 1.0 / rho, rho - a
            slope = -(x * du + y * dv) * over
            bend = (du * du + dv * dv - x * n0 - y * n1 - slope * slope) * over
            least = 0.1 * (du * du + dv * dv + dh * dh)
            w -= (t * slope - z * dh) / max(slope * slope + t * bend + dh * dh - z * n2, least)
        x, y, z = p - w * (m0 + 0.5 * n0 * w), q - w * (m1 + 0.5 * n1 * w), s - w * (m2 + 0.5 * n2 * w)
        t = sqrt(x * x + y * y) - a
        gaps[i] = sqrt(t * t + z * z) - r


@jit_fma
def widths(points: np.ndarray, nodes: np.ndarray, axes: np.ndarray, sizes: Sizes, out: np.ndarray) -> None:
    """Half widths to either side, mm, of k axes (as frames) at n contacts into out (k, n, 2)."""
    cutter, lift = sizes
    tips, gaps, half = np.empty((3, 3)), np.empty(POINTS), POINTS // 2
    for j in range(len(points)):
        for k in range(len(axes)):
            _parabola(nodes[j], axes[k], cutter, tips)
            _gaps(points[j], axes[k], cutter, tips, gaps)
            for side in range(2):
                i, before = 0, -lift
                while i < half - 1 and gaps[side * half + i] <= 0.0:
                    before = gaps[side * half + i]
                    i += 1
                out[k, j, side] = SPACING * (i + before / (before - gaps[side * half + i]))


def widths_numpy(points: np.ndarray, nodes: np.ndarray, axes: np.ndarray, sizes: Sizes, out: np.ndarray) -> None:
    """The same on whole arrays, all axes at a time."""
    (a, r), lift, half = sizes[0][:2], sizes[1], POINTS // 2
    for j in range(len(points)):
        line = np.einsum("kab,nb->kan", axes, nodes[j, :, :3])
        lean = np.einsum("kab,nb->kan", axes[:, :2], nodes[j, :, 3:])
        line[:, :2] += a * lean / np.sqrt((lean**2).sum(axis=1, keepdims=True))
        line[:, 2] -= r
        m = 0.5 * (line[..., 2] - line[..., 0])[..., None]
        n = (line[..., 2] - 2 * line[..., 1] + line[..., 0])[..., None]
        p = axes @ points[j] - line[..., 1:2]
        p[:, 2] -= r
        w = np.zeros((len(axes), 1, POINTS))
        for _ in range(STEPS):
            d, x = m + n * w, p - w * (m + 0.5 * n * w)
            rho = np.sqrt(x[:, 0] ** 2 + x[:, 1] ** 2)
            t, slope = rho - a, -(x[:, 0] * d[:, 0] + x[:, 1] * d[:, 1]) / rho
            pace = d[:, 0] ** 2 + d[:, 1] ** 2
            bend = (pace - x[:, 0] * n[:, 0] - x[:, 1] * n[:, 1] - slope**2) / rho
            down = np.maximum(slope**2 + t * bend + d[:, 2] ** 2 - x[:, 2] * n[:, 2], 0.1 * (pace + d[:, 2] ** 2))
            w -= ((t * slope - x[:, 2] * d[:, 2]) / down)[:, None]
        x = p - w * (m + 0.5 * n * w)
        gaps = (np.hypot(np.hypot(x[:, 0], x[:, 1]) - a, x[:, 2]) - r).reshape(-1, 2, half)
        first = np.where((gaps > 0).any(axis=2), np.argmax(gaps > 0, axis=2), half - 1)
        after = np.take_along_axis(gaps, first[..., None], 2)[..., 0]
        before = np.take_along_axis(gaps, np.maximum(first - 1, 0)[..., None], 2)[..., 0]
        before = np.where(first > 0, before, -lift)
        out[:, j] = SPACING * (first + before / (before - after))
