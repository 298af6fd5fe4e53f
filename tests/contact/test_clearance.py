"""Clearance bounds: exact cases, components and faces, motions, what they must follow, and the plain twin."""

import numpy as np
import pytest

from toolaxis.contact.clearance import queries as distances
from toolaxis.contact.clearance.clearance import (
    CUTOFF,
    RESOLUTION,
    clearance,
    clearances,
    clears,
    segment_clearances,
    segment_clears,
)
from toolaxis.contact.clearance.surroundings import IGNORED, Surroundings
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.shape.adjacency import Edge
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(12, 1, flute_length=20, stickout=50, shank=[(5, 0), (5, 50)],
                  holder=[(10, 0), (10, 20), (25, 20), (25, 60)])
UP = np.array([0.0, 0.0, 1.0])


def _sheet(corner, along, across, **more):
    p, u, v = (np.asarray(x, dtype=float) for x in (corner, along, across))
    return Face.from_bspline(np.array([[p, p + v], [p + u, p + u + v]]), (1, 1), **more)


def _wall(x, low, high):
    """A wall normal to x between two heights."""
    return _sheet([x, -40, low], [0, 80, 0], [0, 0, high - low])


def _floor(size=80.0):
    return _sheet([-size / 2, -size / 2, 0], [size, 0, 0], [0, size, 0])


def _wavy(seed=1):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-30, 30, 6), np.linspace(-30, 30, 6), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 2 * rng.standard_normal(x.shape)], axis=-1))


@pytest.mark.parametrize(("wall", "exact"), [
    (_wall(9, 2, 15), (3, np.hypot(4, 5), CUTOFF)),  # the shank is 5 thick above 20
    (_wall(5.5, 22, 40), (2, 0.5, CUTOFF)),
    (_wall(15, 40, 65), (CUTOFF, CUTOFF, 5)),
    (_wall(27, -5, 90), (CUTOFF, CUTOFF, 2)),
    (_wall(18, 55, 69), (CUTOFF, CUTOFF, 1)),  # under the collar
    (_wall(9, 2, 15).trimmed(([[0, 0], [0.4, 0], [0.4, 1], [0, 1]],)),
     (np.hypot(9, 8) - 6, np.hypot(np.hypot(9, 8) - 5, 5), CUTOFF)),
])
def test_walls_at_known_distances(wall, exact):
    found = clearances(TOOL, [[0, 0, 0]], UP, Surroundings((wall,), np.zeros((1, 3))))
    exact = np.minimum(exact, CUTOFF)
    assert (found.distance[0] <= exact + 1e-9).all()
    assert found.distance[0] == pytest.approx(exact, abs=RESOLUTION + 1e-9)
    assert found.checked == ("cutter", "shank", "holder")


def test_collision_is_negative():
    for wall in (_wall(5.9, 2, 15), _wall(4.9, 25, 40), _wall(24, 75, 100)):
        found = clearances(TOOL, [[0, 0, 0]], UP, Surroundings((wall,), np.zeros((1, 3)))).distance[0]
        assert found.min() == pytest.approx(-0.1 if found.min() > -0.5 else -1.0, abs=0.05)
        assert not clears(TOOL, [[0, 0, 0]], UP, Surroundings((wall,), np.zeros((1, 3)))).safe[0]


def test_public_form():
    floor, wall = _floor(), _wall(20, -1, 30)
    uv, axis = np.array([[0.5, 0.5], [0.6, 0.5]]), unit([-0.1, 0, 1])
    found = clearance(floor, TOOL, uv, axis, [floor, wall])
    assert found[0] - found[1] == pytest.approx(8.0, abs=0.002)
    assert found.shape == (2,)
    assert (clearance(floor, TOOL, uv, axis, [wall]) >= found).all()
    assert clearance(floor, TOOL, uv, axis, []) == pytest.approx(CUTOFF)
    assert clearance(floor, Tool.ball(8), uv, axis, [floor]) == pytest.approx(CUTOFF)


def test_part_leaves_its_skin_to_gouge():
    floor, wall = _floor(), _wall(20, -1, 30)
    edge = Edge((1, 2), "tangent", np.array([[20, -30, 0], [20, 30, 0.0]]))
    pair = Part.from_faces([floor, wall], [edge])
    uv, axis = np.array([[0.5, 0.5]]), UP
    assert clearance(floor, TOOL, uv, axis, pair)[0] == pytest.approx(CUTOFF)  # holder 25 - 20 over the wall
    assert clearance(floor, TOOL, uv, axis, [floor, wall])[0] == pytest.approx(20 - 6, abs=4.1)


def test_places_and_faces():
    walls = (_wall(9, 2, 15), _wall(-8, 2, 15), _wall(30, 60, 90))
    found = clearances(TOOL, [[0, 0, 0]], UP, Surroundings(walls, np.zeros((3, 3))), 30.0)
    assert found.face[0].tolist() == [1, 1, 2]
    assert found.distance[0] == pytest.approx([2, np.hypot(3, 5), 5], abs=0.002)
    assert found.place[0, 0, 0] == pytest.approx(-8)
    assert found.place[0, 2, 0] == pytest.approx(30)


def test_required_distances_by_face_and_component():
    walls = (_wall(9, 2, 15), _wall(-8, 2, 15))
    tip = [[0, 0, 0]]
    for required, safe in (((2.9, 1.9), True), ((3.1, 1.9), False), ((2.9, 2.1), False)):
        table = np.column_stack([required, [1, 1], [1, 1]])
        verdict = clears(TOOL, tip, UP, Surroundings(walls, table))
        assert verdict.safe[0] == safe
        if not safe:
            assert verdict.component[0] == 0
            assert verdict.face[0] == (0 if required[0] > 3 else 1)
    table[:, 0] = IGNORED
    assert clears(TOOL, tip, UP, Surroundings(walls, table)).safe[0]
    touching = Surroundings((_wall(5.9995, 2, 15),), [[-0.002, 0.5, 0.5]])
    assert clears(TOOL, tip, UP, touching).safe[0]
    assert not clears(TOOL, tip, UP, touching.requiring([[-0.0001, 0.5, 0.5]])).safe[0]


def test_surroundings_of_a_tolerance():
    faces = (_floor(), _wall(20, 0, 10), _wall(-20, 0, 10))
    around = Surroundings.of(faces, Tolerance(gouge=0.003), skin=faces[:1], touching=faces[1:2])
    assert around.required[:, 0].tolist() == [IGNORED, -0.003, 0.1]
    assert (around.required[:, 1:] == [0.5, 1.0]).all()


def test_motion_between_points():
    """A link that passes a post between its ends."""
    post = _sheet([-0.5, 9, -5], [1, 0, 0], [0, 0, 12])
    tips = np.array([[-60.0, 0, 0], [60, 0, 0], [60, 40, 0], [-60, 40, 0]])
    around = Surroundings((post,), np.full((1, 3), 0.1))
    found = segment_clearances(TOOL, tips, UP, around)
    assert found.distance[:, 0] == pytest.approx([3.0, CUTOFF, CUTOFF], abs=0.002)
    assert clearances(TOOL, tips, UP, around).distance.min() == pytest.approx(CUTOFF)
    assert segment_clears(TOOL, tips, UP, around).safe.all()
    assert segment_clears(TOOL, tips, UP, around.requiring([[3.01, 0, 0]])).safe.tolist() == [False, True, True]


def test_motion_against_dense_steps():
    face, rng = _wavy(), np.random.default_rng(3)
    axis = unit([0.3, -0.2, 1.0])
    tips = rng.uniform([-25, -25, 4], [25, 25, 12], (15, 3))
    around = Surroundings((face,), np.zeros((1, 3)))
    found = segment_clearances(TOOL, tips, axis, around).distance
    for k in range(14):
        steps = tips[k] + np.linspace(0, 1, 400)[:, None] * (tips[k + 1] - tips[k])
        dense = clearances(TOOL, steps, axis, around).distance.min(axis=0)
        outside = dense > 0
        assert (found[k] <= dense + RESOLUTION)[outside].all()
        assert (found[k] >= dense - 0.01)[outside].all()  # steps of a tenth of a mm
        assert (found[k][~outside] < RESOLUTION).all()


def _star_trims():
    """A wavy outer loop and a slanting slot, both polygons."""
    t = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    radius = 0.38 + 0.06 * np.cos(5 * t)
    outer = np.stack([0.5 + radius * np.cos(t), 0.5 + radius * np.sin(t)], axis=1)
    return outer, np.array([[0.4, 0.35], [0.62, 0.6], [0.58, 0.64], [0.36, 0.39]])


def test_trimmed_faces_against_dense_borders():
    """Nothing that trims leave is missed, and nothing that they cut away is found."""
    face, rng = _wavy(5).trimmed(_star_trims()), np.random.default_rng(8)
    share = np.linspace(0, 1, 60)[:, None]
    border = [a + share * (b - a) for loop in face.trims for a, b in zip(loop, np.roll(loop, -1, 0), strict=True)]
    points = face.evaluate(np.vstack([face.grid(400, 400), *border])).point
    tips, axis = rng.uniform([-30, -30, -4], [30, 30, 6], (150, 3)), unit(UP + 0.6 * rng.standard_normal((150, 3)))
    found = clearances(TOOL, tips, axis, Surroundings((face,), np.zeros((1, 3)))).distance
    exact = np.empty((150, 3))
    for k, (tip, t) in enumerate(zip(tips, axis, strict=True)):
        w = points - tip
        z = w @ t
        flat = np.column_stack([np.linalg.norm(w - z[:, None] * t, axis=1), np.zeros_like(z), z])
        exact[k] = [TOOL.distance(flat, name).value.min() for name in ("cutter", "shank", "holder")]
    apart = (exact > 0) & (exact < CUTOFF)
    assert apart.sum() > 60
    assert (found[apart] <= exact[apart] + 1e-9).all()
    assert (found[apart] >= exact[apart] - 0.01).all()  # samples stand 0.15 mm apart
    assert (found[exact < 0] < 1e-9).all()


def test_moves_mirrors_and_scales_with_the_part():
    faces, rng = (_wavy(), _wall(20, -5, 60)), np.random.default_rng(4)
    tips, axis = rng.uniform([-10, -10, 3], [10, 10, 9], (30, 3)), unit(UP + 0.2 * rng.standard_normal((30, 3)))
    plain = clearances(TOOL, tips, axis, Surroundings(faces, np.zeros((2, 3)))).distance
    for linear, scale in ((rotation([1, 2, 3], 2.0), 1.0), (np.diag([1, -1, 1.0]), 1.0), (0.4 * np.eye(3), 0.4)):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = linear, [30, -7, 1]
        small = Tool.torus(12 * scale, scale, flute_length=20 * scale, stickout=50 * scale,
                           shank=scale * np.array(TOOL.shank), holder=scale * np.array(TOOL.holder))
        around = Surroundings(tuple(f.transformed(matrix) for f in faces), np.zeros((2, 3)))
        moved = clearances(small, tips @ linear.T + matrix[:3, 3], axis @ (linear / scale).T, around, CUTOFF * scale)
        assert np.abs(moved.distance / scale - plain)[plain > 0].max() < 2 * RESOLUTION / scale


def test_unknown_components_are_not_called_checked():
    found = clearances(Tool.ball(8), [[0, 0, 3]], UP, Surroundings((_floor(),), np.zeros((1, 3))))
    assert found.checked == ("cutter",)
    assert found.distance[0] == pytest.approx([3, CUTOFF, CUTOFF], abs=RESOLUTION)
    empty = clearances(TOOL, [[0, 0, 3]], UP, Surroundings((), np.zeros((0, 3))))
    assert empty.checked == ()
    assert clears(TOOL, [[0, 0, 3]], UP, Surroundings((), np.zeros((0, 3)))).safe.all()


def test_many_steps_in_a_holder():
    """More frusta than fit into one question."""
    z = np.repeat(np.arange(81.0), 2)[1:-1] / 2
    rows = np.column_stack([10 + 5 * np.repeat(np.arange(80) % 2, 2), z])
    comb = Tool.ball(8, stickout=50, holder=rows)
    for x in (16.0, 15.5):
        found = clearances(comb, [[0, 0, 0]], UP, Surroundings((_wall(x, 0, 200),), np.zeros((1, 3)))).distance[0]
        assert found == pytest.approx([10, 10, x - 15], abs=2)
        assert found[2] == pytest.approx(x - 15, abs=RESOLUTION)


def test_plain_twin_says_the_same(monkeypatch):
    rng, ring = np.random.default_rng(6), np.linspace(0, 2 * np.pi, 30, endpoint=False)
    cut = _wavy(2).trimmed((np.stack([.5 + .4 * np.cos(ring), .5 + .3 * np.sin(ring)], axis=1),))
    around = Surroundings((cut, _wall(20, -5, 60)), [[0.3, 0.5, 1], [0.1, 0.5, 1.0]])
    tips, axis = rng.uniform([-10, -10, 2], [10, 10, 9], (25, 3)), unit(UP + 0.2 * rng.standard_normal((25, 3)))

    def ask():
        return clearances(TOOL, tips, axis, around).distance, clears(TOOL, tips, axis, around).safe

    one = ask()
    monkeypatch.setattr(distances._compiled, "available", False)
    other = ask()
    assert np.abs(one[0] - other[0])[one[0] > 0].max() <= RESOLUTION
    assert (one[1] == other[1]).all()
    assert 0 < one[1].mean() < 1


def test_motions_close_together_are_told_as_each_by_itself():
    rng, count = np.random.default_rng(8), 30
    tree = forest([_wavy(2), _wall(14, -5, 60)])
    begin = rng.uniform([-12, -12, 0], [12, 12, 9], (40, 3))
    tips = begin[:, None] + np.cumsum(rng.normal(0, 0.1, (40, count, 3)), axis=1)
    axes = np.repeat(unit(UP + 0.2 * rng.standard_normal((40, 3))), count, axis=0)
    ways = np.where(rng.random((40, 1, 1)) < 0.5, 0.0, rng.normal(0, 0.8, tips.shape))
    moves = np.stack([tips.reshape(-1, 3), ways.reshape(-1, 3), axes], axis=1)
    required, limit = np.array([[0.3, 0.5, 1.0], [0.1, 0.5, 1.0]]), 2.0

    decided = distances.keeps_limits(tree, TOOL, moves, required)
    bounded = distances.lower_bounds(tree, TOOL, moves, limit, RESOLUTION)
    alone = [(distances.keeps_limits(tree, TOOL, moves[[i]], required),
              distances.lower_bounds(tree, TOOL, moves[[i]], limit, RESOLUTION)) for i in range(len(moves))]
    blocked = np.array([one.blocked[0] >= 0 for one, _ in alone])
    assert (blocked == (decided.blocked >= 0)).all() and 0.2 < blocked.mean() < 0.8
    lower = np.concatenate([one.lower for _, one in alone])
    clear = lower > -0.1
    assert np.abs(lower - bounded.lower)[clear].max() <= RESOLUTION
    assert (lower < limit).mean() > 0.3
    assert decided.looked.sum() < 0.5 * sum(one.looked[0] for one, _ in alone)


def test_bad_input():
    with pytest.raises(InvalidInput, match="one row"):
        Surroundings((_floor(),), np.zeros((2, 3)))
    with pytest.raises(InvalidInput, match=r"\[0, 2\]"):
        Surroundings((_floor(),), [[0, 0, np.nan]])
