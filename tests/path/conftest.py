"""Faces to cut and a scallop measured by brute force: nothing of it is taken from the code under test."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]


def _greville(count: int, degree: int) -> Array:
    knots = np.concatenate([np.zeros(degree), np.linspace(0, 1, count - degree + 1), np.ones(degree)])
    return np.array([knots[i + 1 : i + degree + 1].mean() for i in range(count)])


def wavy(seed: int, size: tuple[float, float] = (40.0, 30.0), height: float = 2.5) -> Face:
    """A gently curved face with x = size u and y = size v exactly."""
    rng = np.random.default_rng(seed)
    c, p = rng.uniform(-1, 1, 4), rng.uniform(0, 2 * np.pi, 2)
    u, v = np.meshgrid(_greville(6, 3), _greville(5, 3), indexing="ij")
    z = height * (c[0] * np.sin(np.pi * u + p[0]) + c[1] * np.cos(np.pi * v + p[1]) + 0.5 * c[2] * u * v + c[3] * u)
    return Face.from_bspline(np.stack([size[0] * u, size[1] * v, z], axis=-1))


def holed(face: Face) -> Face:
    """The face inside a circle of its parameter plane, with a round hole about the middle."""
    t = np.linspace(0, 2 * np.pi, 240, endpoint=False)
    circle = np.column_stack([np.cos(t), np.sin(t)])
    return face.trimmed((0.5 + 0.45 * circle, 0.5 + 0.12 * circle[::-1]))


def flat(width: float, depth: float) -> Face:
    """A plane in z = 0, u along x and v along y, both from 0 to 1."""
    return Face.from_bspline(np.array([[[0, 0, 0], [0, depth, 0]], [[width, 0, 0], [width, depth, 0]]], float), (1, 1))


def leaning(lead_deg: float, turn_deg: float = 0.0) -> Array:
    """Unit axis that leans from +z by lead towards +x, turned about z."""
    a, b = np.radians([lead_deg, turn_deg])
    return np.array([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)])


def _distance(q: Array, axis: Array, tool: Tool) -> Array:
    """Signed distance of points, relative to the tip, to a cutter with an endless cylindrical side."""
    z = q @ axis
    across = np.linalg.norm(q - z[:, None] * axis, axis=1) - tool.flat_radius
    low = tool.corner_radius - z
    return np.where(low > 0, np.hypot(np.maximum(across, 0), low), across) - tool.corner_radius


def _swept(p: Array, start: Array, move: Array, axis: Array, tool: Tool) -> float:
    """Distance of a point to the cutter moved along segments: convex along each, so golden section finds the least."""
    low, high, g = np.zeros(len(start)), np.ones(len(start)), (np.sqrt(5) - 1) / 2
    for _ in range(24):
        a, b = high - g * (high - low), low + g * (high - low)
        near, far = (_distance(p - start - t[:, None] * move, axis, tool) for t in (a, b))
        left = near < far
        low, high = np.where(left, low, a), np.where(left, b, high)
    return float(_distance(p - start - ((low + high) / 2)[:, None] * move, axis, tool).min())


def scallops(path: ToolPath, face: Face, tool: Tool, uv: Array, most: float) -> Array:
    """Least t in [0, most] with p + t n inside a cutter somewhere on the cutting motion, for each uv."""
    i = np.flatnonzero(path.kind == Motion.CUT)
    start, move, axis = path.cl[i - 1], path.cl[i] - path.cl[i - 1], path.axis[0]
    point, normal, out = face.evaluate(uv).point, face.normal(uv), np.full(len(uv), most)
    middle, half = (path.cc[i] + path.cc[i - 1]) / 2, np.linalg.norm(path.cc[i] - path.cc[i - 1], axis=1) / 2
    for k, (p, n) in enumerate(zip(point, normal, strict=True)):
        near = np.linalg.norm(middle - p, axis=1) < tool.radius + half
        low, high = 0.0, most
        if not near.any() or _swept(p + most * n, start[near], move[near], axis, tool) > 0:
            continue
        for _ in range(12):
            t = (low + high) / 2
            if _swept(p + t * n, start[near], move[near], axis, tool) <= 0:
                high = t
            else:
                low = t
        out[k] = high
    return out


@pytest.fixture(scope="session")
def make() -> dict[str, Callable[..., object]]:
    """Makers of faces and axes, and the brute-force scallop."""
    return {"wavy": wavy, "holed": holed, "flat": flat, "leaning": leaning, "scallops": scallops}
