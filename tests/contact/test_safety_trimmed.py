"""Gouge and collision on trimmed faces against dense sampling: no loop, as rounded as it may be, hides a part."""

from operator import itemgetter

import numpy as np
import pytest
import shapely
from dense import (
    COMPONENTS,
    LIMITS,
    LOWERED,
    POSES,
    Sampled,
    a_tool,
    a_turn,
    bicubic,
    contacts_at,
    least_phi,
    phi,
    told_at_most,
    unit,
)

from toolaxis.contact.clearance import queries as distances
from toolaxis.contact.clearance.clearance import clearances, clears
from toolaxis.contact.clearance.gouge import gouges, penetration
from toolaxis.contact.clearance.surroundings import Surroundings
from toolaxis.shape.face import Face

GOUGES, COLLISIONS, TWINS = range(12), range(3), range(3)
DOMAINS = ((0.0, 1.0), (0.0, 1.0), (1000.0, 1003.0), (0.0, 1e-3), (-7.3, -7.299), (-500.0, 500.0))
SIDE, PER_EDGE = 48, 40

# ---- loops in the unit square --------------------------------------------------------------------------------------

def _lines(rng, count):
    """Places at which knots, base cells or nothing of a surface lie, apart from each other."""
    grid = np.arange(25) / 24 if rng.random() < 0.7 else np.r_[0, np.sort(rng.uniform(0.05, 0.95, 11)), 1]
    return np.sort(rng.choice(grid, count, replace=False))


def _box(u0, u1, v0, v1):
    return np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])


def _rectangle(rng):
    return (_box(*_lines(rng, 2), *_lines(rng, 2)),)


def _whole(rng):
    return (_box(0, 1, 0, 1),)


def _stairs(rng):
    (a, b, c, d), (e, f, g, h) = _lines(rng, 4), _lines(rng, 4)
    return (np.array([[a, e], [d, e], [d, f], [c, f], [c, g], [b, g], [b, h], [a, h]]),)


def _notch(rng):
    (a, b, c), (e, f, g, h) = _lines(rng, 3), _lines(rng, 4)
    return (np.array([[a, e], [c, e], [c, f], [b, f], [b, g], [c, g], [c, h], [a, h]]),)


def _hole(rng):
    (a, b, c, d), (e, f, g, h) = _lines(rng, 4), _lines(rng, 4)
    return _box(a, d, e, h), _box(b, c, f, g)[::-1]


def _slanted(rng):
    (a, b, c), (e, f, g) = _lines(rng, 3), _lines(rng, 3)
    return (np.array([[a, e], [c, e], [c, f], [b, g], [a, f]]),)


def _curved(rng):
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    round_ = np.stack([np.cos(t), np.sin(t)], axis=1)
    return _box(0, 1, 0, 1) if rng.random() < 0.5 else 0.5 + 0.5 * round_, 0.5 + rng.uniform(0.05, 0.4) * round_


def _sliver(rng):
    (a, b), e = _lines(rng, 2), rng.choice(np.arange(24)) / 24
    loop = _box(a, b, e, e + 10 ** rng.uniform(-4, -1.5))
    return (loop[:, ::-1] if rng.random() < 0.5 else loop,)


SHAPES = (_rectangle, _whole, _stairs, _notch, _hole, _slanted, _curved, _sliver)


def _perturbed(rng, loops):
    """Some vertices moved by nothing to 1e-6; the outer loop stays in the square, holes in the outer loop."""
    size = rng.choice([0.0, *10.0 ** np.arange(-17, -5)])
    moved = [loop + size * rng.standard_normal(loop.shape) * rng.integers(0, 2, loop.shape) for loop in loops]
    return [np.clip(loop, 0, 1) for loop in moved]


# ---- faces and their samples ---------------------------------------------------------------------------------------

def _trimmed(rng, turn=None):
    """A face on a domain of its own, and its samples: the inside by another library, and the loops themselves."""
    (u0, u1), (v0, v1) = DOMAINS[rng.integers(len(DOMAINS))], DOMAINS[rng.integers(len(DOMAINS))]
    knots = [low + (high - low) * np.r_[0, 0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1, 1] for low, high in ((u0, u1), (v0, v1))]
    net = bicubic(rng, rng.uniform(20, 80, 2), rng.uniform(0, 2))
    if turn is not None:
        net = (net - [20, 20, 0]) @ turn
    unit_loops = _perturbed(rng, SHAPES[rng.integers(len(SHAPES))](rng))
    loops = tuple(np.clip([u0, v0] + loop * [u1 - u0, v1 - v0], [u0, v0], [u1, v1]) for loop in unit_loops)
    return _with_samples(Face.from_bspline(net, (3, 3), knots, trims=loops), loops)


def _with_samples(face, loops):
    (u0, u1), (v0, v1) = face.surface.domain
    low, size = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
    area = shapely.Polygon((loops[0] - low) / size, [(hole - low) / size for hole in loops[1:]]).buffer(-1e-9)
    shapely.prepare(area)

    def inside(uv):
        return shapely.contains_xy(area, (uv - low) / size)

    corner, far = (loops[0].min(axis=0), loops[0].max(axis=0))
    uv = np.stack(np.meshgrid(*np.linspace(corner, far, SIDE).T, indexing="ij"), axis=-1)
    uv[[0, -1], :, 0] += 1e-7 * (far - corner)[0] * np.array([1, -1])[:, None]
    uv[:, [0, -1], 1] += 1e-7 * (far - corner)[1] * np.array([1, -1])
    points = face.evaluate(uv.reshape(-1, 2)).point.reshape(SIDE, SIDE, 3)
    step = max(np.linalg.norm(np.diff(points, axis=k), axis=2).max() for k in (0, 1))
    held = inside(uv.reshape(-1, 2))
    return Sampled(face, uv.reshape(-1, 2)[held], points.reshape(-1, 3)[held], float(step), (far - corner) / (SIDE - 1),
                   inside), [np.vstack([loop, loop[:1]]) for loop in loops]


def _on(loop, place):
    knots = np.arange(len(loop))
    return np.stack([np.interp(place, knots, loop[:, k]) for k in (0, 1)], axis=1)


def _lowest(trimmed, tool, pose):
    """Least phi over the inside and the loops, and where."""
    (sampled, loops), best, place = trimmed, np.inf, None
    if len(sampled.points):
        best, place = least_phi(tool, [sampled], *pose)
    for loop in loops:
        at, gap = np.linspace(0, len(loop) - 1, PER_EDGE * (len(loop) - 1) + 1), 1 / PER_EDGE
        for _ in range(16):
            points = sampled.face.evaluate(_on(loop, at)).point
            values = phi(tool, points, *pose)
            k = int(np.argmin(values))
            if values[k] < best:
                best, place = float(values[k]), points[k]
            if values[k] > best + 2 * sampled.step:
                break
            at, gap = np.clip(at[k] + np.linspace(-1.5, 1.5, 13) * gap, 0, len(loop) - 1), gap / 4
    return best, place


# ---- the two statements --------------------------------------------------------------------------------------------

def _contact_scene(seed, limit):
    """A trimmed face, a tool and contacts on the face, most of them lowered."""
    rng = np.random.default_rng([3, seed])
    trimmed, tool = _trimmed(rng), a_tool(rng)
    sampled, loops = trimmed
    uv = np.vstack([sampled.uv[rng.integers(len(sampled.uv), size=POSES // 2)] if len(sampled.uv) else np.empty((0, 2)),
                    *[_on(loop, rng.uniform(0, len(loop) - 1, POSES)) for loop in loops]])[:POSES]
    tips, axis, n = contacts_at(rng, sampled.face, tool, rng.uniform(0.05, 0.5), uv)
    return trimmed, tool, tips - rng.choice(LOWERED[limit], len(uv))[:, None] * n, axis


def _judge_gouges(seed, limit):
    """Rows (true depth, told at most, bound, exceeds, rounded) of one scene."""
    trimmed, tool, tips, axis = _contact_scene(seed, limit)
    least = [_lowest(trimmed, tool, (tip, t, "cutter"))[0] for tip, t in zip(tips, axis, strict=True)]
    face, depth = (trimmed[0].face,), np.maximum(0.0, -np.array(least))
    return np.column_stack([depth, told_at_most(tool, depth), penetration(tool, tips, axis, face),
                            gouges(tool, tips, axis, face, limit), np.full(len(tips), tool.corner_radius > 0)])


def _planted_scene(seed, poses=POSES):
    """Two trimmed faces, a tool, and poses whose nearest place to one component was set to what is asked."""
    rng = np.random.default_rng([4, seed])
    tool, faces = a_tool(rng), [_trimmed(rng, a_turn(rng)) for _ in range(2)]
    axis = unit(rng.standard_normal((poses, 3)))
    tips, truth = np.empty((poses, 3)), np.empty((poses, 3))
    for k in range(poses):
        component, wanted = COMPONENTS[rng.integers(3)], rng.choice([-0.005, 0.02, 0.3])
        tip = unit(rng.standard_normal(3) - axis[k]) * 120
        for _ in range(3):
            value, place = min((_lowest(one, tool, (tip, axis[k], component)) for one in faces), key=itemgetter(0))
            ends = [phi(tool, place + side * 1e-6 * np.eye(3), tip, axis[k], component) for side in (-1, 1)]
            slope = (ends[0] - ends[1]) / 2e-6
            tip = tip + (wanted - value) * slope / max(np.linalg.norm(slope), 0.5)
        tips[k] = tip
        truth[k] = [min(_lowest(one, tool, (tip, axis[k], c))[0] for one in faces) for c in COMPONENTS]
    return [one[0].face for one in faces], tool, (tips, axis), truth


def _judge_collisions(seed):
    """Rows (true distances, bounds, safe) of one scene."""
    faces, tool, (tips, axis), truth = _planted_scene(seed)
    around = Surroundings(tuple(faces), np.zeros((len(faces), 3)))
    return np.column_stack([truth, clearances(tool, tips, axis, around, 5.0).distance,
                            clears(tool, tips, axis, around).safe])


def _check_gouges(rows, limit):
    depth, most, bound, exceeds, rounded = rows.T
    assert (bound >= depth - 1e-7).all()
    assert not (~exceeds.astype(bool) & (depth > limit + 1e-7)).any()
    tight = bound <= most + 0.0005 + 0.05 * np.maximum(0, most - 0.1)
    assert tight[rounded == 1].mean() > 0.99
    assert tight[rounded == 0].mean() > 0.8
    assert exceeds[most < limit - 0.0005].mean() < 0.03
    assert 0.05 < exceeds.mean() < 0.95


def _check_collisions(rows):
    truth, bound, safe = rows[:, :3], rows[:, 3:6], rows[:, 6].astype(bool)
    outside = truth > 0
    assert (bound <= np.minimum(truth, 5.0) + 1e-6)[outside].all()
    assert (bound[~outside] < 1e-6).all()
    apart = outside & (truth < 5)
    assert (bound[apart] >= truth[apart] - 0.002).mean() > 0.99
    least = truth.min(axis=1)
    assert not (safe & (least < -1e-6)).any()
    assert safe[least >= 0.02 - 1e-6].mean() >= 0.98
    assert ((least < -0.003) & (least > -0.007)).mean() > 0.05
    assert ((least > 0.015) & (least < 0.025)).mean() > 0.05


@pytest.mark.parametrize("limit", LIMITS)
def test_gouges_of_trimmed_faces_are_never_missed(limit):
    _check_gouges(np.vstack([_judge_gouges(seed, limit) for seed in GOUGES]), limit)


def test_collisions_with_trimmed_faces_are_never_missed():
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in COLLISIONS]))


@pytest.mark.parametrize("limit", LIMITS)
def test_plain_code_answers_alike(monkeypatch, limit):
    """The twin without the compiler, on the same faces."""
    def ask(found):
        for seed in TWINS:
            trimmed, tool, tips, axis = _contact_scene(seed, limit)
            face = (trimmed[0].face,)
            found.append((penetration(tool, tips, axis, face), gouges(tool, tips, axis, face, limit)))
        return found

    compiled = ask([])
    monkeypatch.setattr(distances._compiled, "available", False)
    for (one, exceeds), (other, also) in zip(compiled, ask([]), strict=True):
        assert np.abs(one - other).max() <= 0.001 + 0.05 * one.max()
        assert (exceeds == also)[np.abs(one - limit) > 0.001].all()


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("first", range(0, 250, 25))
def test_gouges_of_trimmed_faces_are_never_missed_in_5000_cases(first, limit):
    _check_gouges(np.vstack([_judge_gouges(seed, limit) for seed in range(first, first + 25)]), limit)


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, 250, 25))
def test_collisions_with_trimmed_faces_are_never_missed_in_5000_cases(first):
    _check_collisions(np.vstack([_judge_collisions(seed) for seed in range(first, first + 25)]))
