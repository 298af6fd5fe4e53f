"""Thousands of random cases of gouge and collision against dense sampling: "safe" must never be said wrongly."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from toolaxis.contact.clearance import clearances, clears
from toolaxis.contact.gouge import gouges, penetration
from toolaxis.contact.surroundings import Surroundings
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

LIMIT = 0.002
SOME, POSES = range(20), 20
COMPONENTS = ("cutter", "shank", "holder")


class Sampled(NamedTuple):
    """A face with its dense samples: parameters on a grid, points, and the greatest distance to the next one."""

    face: Face
    uv: np.ndarray
    points: np.ndarray
    step: float


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


def _phi(tool, points, tip, axis, component):
    w = points - tip
    z = w @ axis
    rho = np.linalg.norm(w - z[..., None] * axis, axis=-1)
    return _cutter(tool, rho, z) if component == "cutter" else _turned(tool.outlines[component], rho, z)


def _least(tool, faces, tip, axis, component):
    """Least phi over faces, and where: the lowest samples, each followed by a search around it."""
    grids = [_phi(tool, f.points, tip, axis, component) for f in faces]
    best, place = np.inf, None
    for k in np.argsort([grid.min() for grid in grids]):
        if grids[k].min() - faces[k].step > min(best, 8.0):
            continue
        for start in _starts(grids[k]):
            value, point = _zoom(tool, faces[k], (tip, axis, component), faces[k].uv[start])
            if value < best:
                best, place = value, point
    return (best, place) if place is not None else (min(grid.min() for grid in grids), np.zeros(3))


def _starts(values):
    """The two lowest samples that are not neighbours."""
    side, kept = round(np.sqrt(len(values))), []
    for k in np.argsort(values)[:400]:
        i, j = divmod(int(k), side)
        if all(max(abs(i - m), abs(j - n)) > 3 for m, n in kept) and len(kept) < 2:
            kept.append((i, j))
    return [i * side + j for i, j in kept]


def _zoom(tool, sampled, pose, centre):
    tip, axis, component = pose
    (u0, u1), (v0, v1) = sampled.face.surface.domain
    half = 1.5 * np.array([u1 - u0, v1 - v0]) / (np.sqrt(len(sampled.points)) - 1)
    best, place, lull = np.inf, None, 0
    for step in range(80):
        uv = np.clip(centre + STENCILS[step % 2] * half, [u0, v0], [u1, v1])
        points = sampled.face.evaluate(uv).point
        values = _phi(tool, points, tip, axis, component)
        k = int(np.argmin(values))
        lull = 0 if values[k] < best - 1e-7 else lull + 1
        if lull or np.abs(uv[k] - centre).max() < 0.3 * half.max():
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

def _bicubic(rng, size, height):
    x, y = np.meshgrid(np.linspace(0, size[0], 6), np.linspace(0, size[1], 6), indexing="ij")
    return np.stack([x, y, height * rng.standard_normal(x.shape)], axis=-1)


def _turn(rng):
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def _cylinder(rng, radius, length):
    """A quarter of a cylinder, exact and rational."""
    net = np.array([[[radius, 0, z], [radius, radius, z], [0, radius, z]] for z in (0.0, length)]).transpose(1, 0, 2)
    return Face.from_bspline(net @ _turn(rng).T, (2, 1), weights=np.outer([1, np.sqrt(0.5), 1], [1, 1]))


def _sampled(face, side=60):
    (u0, u1), (v0, v1) = face.surface.domain
    uv = np.stack(np.meshgrid(np.linspace(u0, u1, side), np.linspace(v0, v1, side), indexing="ij"), axis=-1)
    uv = uv.reshape(-1, 2)
    points = face.evaluate(uv).point
    net = points.reshape(side, side, 3)
    step = max(np.linalg.norm(np.diff(net, axis=0), axis=2).max(), np.linalg.norm(np.diff(net, axis=1), axis=2).max())
    return Sampled(face, uv, points, float(step))


def _tool(rng):
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


def _unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def _contacts(rng, face, tool, lean):
    """Contacts with a standing tool, tips by the formula written out."""
    (u0, u1), (v0, v1) = face.surface.domain
    uv = rng.uniform([u0, v0], [u1, v1], (POSES, 2))
    d = face.evaluate(uv)
    n = _unit(np.cross(d.su, d.sv))
    axis = _unit(n + lean * rng.standard_normal((POSES, 3)))
    across = n - np.sum(n * axis, axis=1)[:, None] * axis
    tips = d.point + tool.corner_radius * (n - axis)
    return tips + (tool.flat_radius * _unit(across) if tool.flat_radius > 0 else 0), axis, n


# ---- the two statements --------------------------------------------------------------------------------------------

def _judge_gouges(seed):
    """Rows (true depth, bound, exceeds, rounded) of one scene: contacts as they come, and lowered by 0.007 or 0.03."""
    rng = np.random.default_rng([1, seed])
    face = Face.from_bspline(_bicubic(rng, rng.uniform(20, 80, 2), rng.uniform(0, 2)))
    tool, sampled = _tool(rng), _sampled(face)
    tips, axis, n = _contacts(rng, face, tool, rng.uniform(0.05, 0.5))
    tips = tips - rng.choice([0.0, 0.0, 0.007, 0.03], POSES)[:, None] * n
    least = [_least(tool, [sampled], tip, t, "cutter")[0] for tip, t in zip(tips, axis, strict=True)]
    depth = np.maximum(0.0, -np.array(least))
    return np.column_stack([depth, penetration(tool, tips, axis, (face,)), gouges(tool, tips, axis, (face,), LIMIT),
                            np.full(POSES, tool.corner_radius > 0)])


def _judge_collisions(seed):
    """Rows (true distances, bounds, safe) of one scene; nearest places set to -0.005, 0.02 or left as they come."""
    rng = np.random.default_rng([2, seed])
    tool = _tool(rng)
    moved = [_cylinder(rng, rng.uniform(5, 40), rng.uniform(20, 60)),
             Face.from_bspline((_bicubic(rng, rng.uniform(20, 60, 2), rng.uniform(0, 3)) - [20, 20, 0]) @ _turn(rng)),
             Face.from_bspline((_bicubic(rng, rng.uniform(20, 60, 2), 0) - [20, 20, 0])[::5, ::5] @ _turn(rng), (1, 1))]
    faces = [_sampled(face) for face in moved]
    axis = _unit(rng.standard_normal((POSES, 3)))
    tips = np.empty((POSES, 3))
    truth = np.empty((POSES, 3))
    for k in range(POSES):
        component = COMPONENTS[rng.integers(3)]
        start = _unit(rng.standard_normal(3) - axis[k]) * 120
        tips[k], truth[k] = _planted(tool, faces, (start, axis[k], component), rng.choice([-0.005, 0.02, 0.3]))
    around = Surroundings(tuple(moved), np.zeros((3, 3)))
    return np.column_stack([truth, clearances(tool, tips, axis, around, 5.0).distance,
                            clears(tool, tips, axis, around).safe])


def _planted(tool, faces, pose, wanted):
    """A tip near the start at which a component's distance is about the wanted one, and all true distances there."""
    tip, axis, component = pose
    for _ in range(3):
        value, place = _least(tool, faces, tip, axis, component)
        h = 1e-6
        steps = [(place - h * d, place + h * d) for d in np.eye(3)]
        rise = [_phi(tool, a, tip, axis, component) - _phi(tool, b, tip, axis, component) for a, b in steps]
        slope = np.array(rise) / (2 * h)
        tip = tip + (wanted - value) * slope / max(np.linalg.norm(slope), 0.5)
    return tip, [_least(tool, faces, tip, axis, c)[0] for c in COMPONENTS]


def _check_gouges(rows):
    depth, bound, exceeds, rounded = rows.T
    assert (bound >= depth - 1e-7).all()
    tight = bound <= depth + 0.0005 + 0.05 * np.maximum(0, depth - 0.1)
    assert tight[rounded == 1].mean() > 0.999
    assert tight[rounded == 0].mean() > 0.85  # the search above stops short in valleys of sharp edges
    assert not (~exceeds.astype(bool) & (depth > LIMIT + 1e-7)).any()
    shallow = depth < LIMIT - 0.0005
    assert exceeds[shallow].mean() < 0.01
    assert bound[(depth < 1e-5) & (rounded == 1)].max() < 0.001
    assert (bound[(depth < 1e-5) & (rounded == 0)] < 0.001).mean() > 0.98
    assert 0.05 < exceeds.mean() < 0.95


def _check_collisions(rows):
    truth, bound, safe = rows[:, :3], rows[:, 3:6], rows[:, 6].astype(bool)
    outside = truth > 0
    assert (bound <= np.minimum(truth, 5.0) + 1e-6)[outside].all()
    assert (bound[~outside] < 1e-6).all()  # how deep, counts to the next border of one convex piece
    apart = (truth > 0) & (truth < 5)
    assert (bound[apart] >= truth[apart] - 0.002).mean() > 0.999
    least = truth.min(axis=1)
    assert not (safe & (least < -1e-6)).any()
    assert safe[least >= 0.02 - 1e-6].mean() >= 0.99
    assert ((least < -0.003) & (least > -0.007)).mean() > 0.1
    assert ((least > 0.015) & (least < 0.025)).mean() > 0.1


def test_gouges_are_never_missed():
    _check_gouges(np.vstack([_judge_gouges(seed) for seed in SOME]))


def test_collisions_are_never_missed():
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in SOME[:12]]))


@pytest.mark.long
def test_gouges_are_never_missed_in_5000_cases():
    _check_gouges(np.vstack([_judge_gouges(seed) for seed in range(250)]))


@pytest.mark.long
def test_collisions_are_never_missed_in_5000_cases():
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in range(250)]))
