"""Distances of tools from faces by dense sampling and own formulas, and random scenes: the oracle of safety tests."""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

#: Limits of the gouge, mm: a tight one, and the machining tolerance unless another is given; and for each how deep
#: contacts are lowered, some of them only just beyond it.
LIMITS = (0.002, Tolerance().gouge)
LOWERED = {0.002: (0.0, 0.0, 0.007, 0.03), 0.01: (0.0, 0.007, 0.0102, 0.03)}
POSES = 20
COMPONENTS = ("cutter", "shank", "holder")


class Sampled(NamedTuple):
    """A face with its dense samples: parameters on a grid, points, the greatest distance to the next one, and the
    distance of neighbours in u and v; which parameters belong to it."""

    face: Face
    uv: np.ndarray
    points: np.ndarray
    step: float
    gap: np.ndarray
    inside: Callable[[np.ndarray], np.ndarray] = lambda uv: np.ones(len(uv), bool)


# ---- the oracle: own distances, own search -------------------------------------------------------------------------

def _segment(rho, z, a, b):
    """Distance of meridian points from a segment."""
    along = b - a
    t = np.clip(((rho - a[0]) * along[0] + (z - a[1]) * along[1]) / (along @ along), 0, 1)
    return np.hypot(rho - a[0] - t * along[0], z - a[1] - t * along[1])


def _cutter(tool, rho, z):
    """Signed distance to the cutter: its border is a segment, an arc, a segment and the top."""
    a, r, beta, top = tool.flat_radius, tool.corner_radius, tool.half_angle, tool.flute_length
    end = np.array([a + r * np.cos(beta), r * (1 - np.sin(beta))])
    rim = np.array([end[0] + (top - end[1]) * np.tan(beta), top])
    border = np.minimum(_segment(rho, z, end, rim), _segment(rho, z, np.array([0.0, top]), rim))
    if a > 0:
        border = np.minimum(border, _segment(rho, z, np.zeros(2), np.array([a, 0.0])))
    angle = np.arctan2(rho - a, r - z)
    on_arc = (angle >= 0) & (angle <= np.pi / 2 - beta)
    border = np.where(on_arc, np.minimum(border, np.abs(np.hypot(rho - a, z - r) - r)), border)
    wide = np.where(z < end[1], a + np.sqrt(np.maximum(r**2 - (z - r) ** 2, 0)), end[0] + (z - end[1]) * np.tan(beta))
    return np.where((z > 0) & (z < top) & (rho < wide), -border, border)


def _turned(rows, rho, z):
    """Signed distance to a turned body (depths inside count to the next wall or end)."""
    outline = np.vstack([[0.0, rows[0, 1]], rows, [0.0, rows[-1, 1]]])
    border = np.min([_segment(rho, z, a, b) for a, b in pairwise(outline) if (a != b).any()], axis=0)
    wide = np.full(np.shape(rho), -1.0)
    for a, b in pairwise(rows):
        here = (z >= a[1]) & (z <= b[1]) if b[1] > a[1] else np.zeros(np.shape(rho), bool)
        wide = np.where(here, a[0] + (b[0] - a[0]) * (z - a[1]) / max(b[1] - a[1], 1e-300), wide)
    return np.where(rho < wide, -border, border)


def phi(tool, points, tip, axis, component):
    w = points - tip
    z = w @ axis
    across = w - z[..., None] * axis
    rho = np.sqrt(across[..., 0] ** 2 + across[..., 1] ** 2 + across[..., 2] ** 2)
    return _cutter(tool, rho, z) if component == "cutter" else _turned(tool.outlines[component], rho, z)


def least_phi(tool, faces, tip, axis, component):
    """Least phi over faces, and where: the lowest samples, each followed by a search around it."""
    grids = [phi(tool, f.points, tip, axis, component) for f in faces]
    best, place = np.inf, None
    for k in np.argsort([grid.min() for grid in grids]):
        if grids[k].min() - faces[k].step > min(best, 8.0):
            continue
        for start in _starts(grids[k], faces[k].uv / faces[k].gap):
            value, point = _zoom(tool, faces[k], (tip, axis, component), faces[k].uv[start])
            if value < best:
                best, place = value, point
    return (best, place) if place is not None else (min(grid.min() for grid in grids), np.zeros(3))


def _starts(values, place):
    """The two lowest samples that are not neighbours."""
    kept = []
    for k in np.argsort(values)[:400]:
        if all(np.abs(place[k] - place[m]).max() > 3.5 for m in kept):
            kept.append(int(k))
        if len(kept) == 2:
            break
    return kept


def _zoom(tool, sampled, pose, centre):
    tip, axis, component = pose
    (u0, u1), (v0, v1) = sampled.face.surface.domain
    half = 1.5 * sampled.gap
    best, place, lull = np.inf, None, 0
    for step in range(80):
        uv = np.clip(centre + STENCILS[step % 2] * half, [u0, v0], [u1, v1])
        uv = uv[sampled.inside(uv)]
        points = sampled.face.evaluate(uv).point
        values = phi(tool, points, tip, axis, component)
        k = int(np.argmin(values))
        lull = 0 if values[k] < best - 1e-7 else lull + 1
        if lull or (np.abs(uv[k] - centre) / half).max() < 0.3:
            half = half * 0.5
        if values[k] < best:
            best, place, centre = float(values[k]), points[k], uv[k]
        if lull > 8:
            break
    return best, place


def _star(turn):
    """A star of points in all directions, near and far, for valleys with sharp bottoms."""
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False) + turn
    rays = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.vstack([[[0, 0]], (rays * np.geomspace(0.02, 1, 5)[:, None, None]).reshape(-1, 2)])


STENCILS = (_star(0.0), _star(0.05))

# ---- random scenes -------------------------------------------------------------------------------------------------

def bicubic(rng, size, height):
    x, y = np.meshgrid(np.linspace(0, size[0], 6), np.linspace(0, size[1], 6), indexing="ij")
    return np.stack([x, y, height * rng.standard_normal(x.shape)], axis=-1)


def a_turn(rng):
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def cylinder(rng, radius, length):
    """A quarter of a cylinder, exact and rational."""
    net = np.array([[[radius, 0, z], [radius, radius, z], [0, radius, z]] for z in (0.0, length)]).transpose(1, 0, 2)
    return Face.from_bspline(net @ a_turn(rng).T, (2, 1), weights=np.outer([1, np.sqrt(0.5), 1], [1, 1]))


def samples_of(face, side=60):
    (u0, u1), (v0, v1) = face.surface.domain
    uv = np.stack(np.meshgrid(np.linspace(u0, u1, side), np.linspace(v0, v1, side), indexing="ij"), axis=-1)
    uv = uv.reshape(-1, 2)
    points = face.evaluate(uv).point
    net = points.reshape(side, side, 3)
    step = max(np.linalg.norm(np.diff(net, axis=0), axis=2).max(), np.linalg.norm(np.diff(net, axis=1), axis=2).max())
    return Sampled(face, uv, points, float(step), np.array([u1 - u0, v1 - v0]) / (side - 1))


def a_tool(rng):
    radius, stick = rng.uniform(2, 8), rng.uniform(25, 60)
    rows = np.cumsum(rng.uniform(2, 14, 4))
    holder = np.column_stack([rng.uniform(6, 25, 4), rows - rows[0]])
    body = {"stickout": stick, "flute_length": rng.uniform(1.2, 2.5) * radius, "holder": holder,
            "shank": [(radius * rng.uniform(0.7, 1), 0), (radius * rng.uniform(0.7, 1.2), stick)]}
    kind = rng.integers(4)
    if kind == 0:
        return Tool.torus(2 * radius, rng.uniform(0.1, 0.9) * radius, **body)
    if kind == 1:
        return Tool.ball(2 * radius, **body)
    if kind == 2:
        return Tool.flat(2 * radius, **body)
    return Tool.tapered(2 * radius, rng.uniform(0.2, 1) * radius, rng.uniform(2, 12), **body)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def told_at_most(tool, inside):
    """How deep a cutter may be told to reach where the skin lies so far inside it: its corner counts as a dip."""
    r, wedge = tool.corner_radius, np.sin((np.pi / 2 + tool.half_angle) / 2)
    return np.where(inside <= r, inside, r + (inside - r) / wedge)


def contacts(rng, face, tool, lean):
    """Contacts with a standing tool anywhere on a face."""
    (u0, u1), (v0, v1) = face.surface.domain
    return contacts_at(rng, face, tool, lean, rng.uniform([u0, v0], [u1, v1], (POSES, 2)))


def contacts_at(rng, face, tool, lean, uv):
    """Tips by the formula written out, axes and normals."""
    d = face.evaluate(uv)
    n = unit(np.cross(d.su, d.sv))
    axis = unit(n + lean * rng.standard_normal((len(uv), 3)))
    # Past the flank the corner has no point with such a normal, and the tool would not touch: that one leans little.
    past = np.sum(n * axis, axis=1) <= np.sin(tool.half_angle)
    axis = np.where(past[:, None], unit(n + 0.1 * axis), axis)
    across = n - np.sum(n * axis, axis=1)[:, None] * axis
    tips = d.point + tool.corner_radius * (n - axis)
    return tips + (tool.flat_radius * unit(across) if tool.flat_radius > 0 else 0), axis, n
