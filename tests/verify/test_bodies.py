"""The judge of a machine's bodies: distances against closed forms, the planner's bounds and dense sampling."""

from dataclasses import replace
from itertools import pairwise
from math import radians

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.collision.machine_collision import MachineSurroundings, nearest_meeting
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.kinematics import forward
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.verify.machine_motion import MachineModel, least_room
from toolaxis.verify.rigid_bodies import body_thing, cutter_line, revolve_rigid_body

DRIVE = Drive(100.0, 1000.0, 10000.0)
TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
TABLE = MachineBody("table", "C", "cylinder", np.array([[0.0, 0, -60], [0, 0, 0]]), 300.0)
BLOCK = MachineBody("vice", "C", "box", np.array([[60.0, -40, 0], [120, 40, 80]]))
HEAD = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 0], [0, 0, 150]]), 70.0)
ROUND = MachineBody("nose", "B", "points", np.array([[0.0, 0, 0], [40, 0, 60], [-40, 0, 60], [0, 40, 60],
                                                     [0, -40, 60]]), 5.0)


def machine(*bodies: MachineBody) -> Machine:
    linear = tuple(LinearAxis(name, way, DRIVE, -900, 900) for name, way in zip("XYZ", np.eye(3), strict=True))
    return Machine("small", linear, (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE),),
                   (RotaryAxis("B", np.array([0, 1.0, 0]), np.array([0.0, 0, 90]), DRIVE, -2.2, 2.2),), bodies=bodies)


def rig(*bodies: MachineBody, faces: tuple[ta.Face, ...] = ()) -> MachineModel:
    place = np.eye(4)
    place[:3, 3] = (-20.0, -15.0, 25.0)
    return MachineModel(machine(*bodies), place, TOOL.gauge_length, TOOL.profile, TOOL.outlines, faces)


def test_distances_from_a_box_are_exact() -> None:
    rng = np.random.default_rng(2)
    places = rng.uniform([20, -90, -40], [160, 90, 130], (3000, 3))
    low, high = BLOCK.points
    beyond = np.maximum(low - places, places - high)
    exact = np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
    thing = body_thing(BLOCK)
    assert thing.inside is not None
    for some in np.array_split(np.arange(3000), 300):  # the nearest of each lot is exact, the others no greater
        found = thing.inside(places[some])
        assert found.min() == pytest.approx(exact[some].min(), abs=1e-9)
        assert (found <= exact[some] + 1e-9).all()


def test_distances_from_turned_bodies_are_exact() -> None:
    rng = np.random.default_rng(3)
    places = rng.uniform(-400, 400, (4000, 3)) * [1, 1, 0.3]
    radius = np.linalg.norm(places[:, :2], axis=1)
    beyond = np.stack([radius - 300, np.maximum(-60 - places[:, 2], places[:, 2])], axis=1)
    exact = np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
    table = body_thing(TABLE)
    assert table.inside is not None
    assert table.inside(places) == pytest.approx(exact, abs=1e-9)
    tip, axis = np.array([1.0, 2, 3]), np.array([0.0, 0.6, 0.8])
    ball = revolve_rigid_body("cutter", "B", cutter_line(ta.Tool.ball(diameter=8).profile), tip, axis)
    assert ball.inside is not None
    near = tip + 4 * axis + 6 * np.array([[1.0, 0, 0], [0, -0.8, 0.6], [0, -0.6, -0.8]])
    assert ball.inside(near) == pytest.approx([2.0] * 3, abs=0.01)


def test_points_lie_on_the_skin_and_near_each_other() -> None:
    for body in (TABLE, BLOCK, HEAD):
        thing = body_thing(body)
        assert thing.inside is not None and len(thing.points) < 40_000
        assert np.abs(thing.inside(thing.points)).max() < 1e-9
        corners = np.array(np.meshgrid(*BLOCK.points.T)).reshape(3, -1).T
    for corner in corners:
        assert np.linalg.norm(body_thing(BLOCK).points - corner, axis=1).min() < 1e-9


def test_things_move_as_the_tool_does() -> None:
    one, rng = rig(HEAD), np.random.default_rng(5)
    cutter = one.tool[0]
    for joints in np.column_stack([rng.uniform(-90, 90, (20, 3)), rng.uniform(-3, 3, 20), rng.uniform(-2, 2, 20)]):
        turn, shift = one.placed(cutter, joints)
        seen = turn @ (np.asarray(one.machine.gauge) - [0, 0, one.tool_length]) + shift
        part, aside = one.placed(body_thing(TABLE), joints)
        on_part = (part.T @ (seen - aside) - one.place[:3, 3]) @ one.place[:3, :3]
        tips, axes = forward(one.machine, joints[None], one.tool_length, one.place)
        assert on_part == pytest.approx(tips[0], abs=1e-9)
        assert one.joints(tips, axes, joints[3:])[0][0] == pytest.approx(joints, abs=1e-7)


@pytest.mark.parametrize("head", [pytest.param(HEAD, marks=pytest.mark.long), ROUND], ids=["cylinder", "hull"])
def test_the_judge_measures_what_planning_bounds(head: MachineBody) -> None:
    """Planning never promises more than the judge finds, and little less."""
    rng = np.random.default_rng(7)
    one, mounting = rig(TABLE, BLOCK, head), Mounting(machine(TABLE, BLOCK, head), (-20.0, -15, 25), TOOL.gauge_length)
    away = ta.Face.from_bspline(np.array([[[0.0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]), degree=(1, 1))
    compared = 0
    for _ in range(12):
        rotary = np.array([rng.uniform(-3, 3), rng.uniform(-1.2, 1.2)])
        start, end = (np.array([rng.uniform(-150, 150), rng.uniform(-150, 150), rng.uniform(80, 260), *rotary])
                      for _ in range(2))
        joints = np.stack([start, end])
        tips, _ = forward(one.machine, joints, one.tool_length, one.place)
        planned = nearest_meeting(mounting, rotary, tips, MachineSurroundings(TOOL, (forest((away,)),), 30.0))
        judged = least_room(one, joints, 30.0, one.pairs)
        if planned is None or planned.distance < 0:
            assert (planned is None) == (judged.distance >= 30.0 - 1e-6) or planned is None
            assert planned is None or judged.distance < 0.5
            continue
        compared += 1
        assert planned.distance <= judged.distance + 1e-3
        assert judged.distance <= planned.distance + judged.uncertainty
    assert compared > 1


def test_nothing_is_passed_over_between_two_looks() -> None:
    one = rig(TABLE, BLOCK, HEAD)
    joints = np.array([[-250.0, 0, 200, 0.0, 0.3], [250, 0, 200, 1.0, 0.3], [200, 50, 260, 2.5, -0.4]])
    found = least_room(one, joints, 5.0, one.pairs)
    dense = np.concatenate([np.linspace(a, b, 400) for a, b in pairwise(joints)])
    least = min(least_room(one, row[None], 5.0, one.pairs).distance for row in dense[::25])
    assert found.distance <= max(least, 5.0) + 0.5


def test_a_plan_on_a_machine_with_bodies_is_judged_with_them() -> None:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 1.5 * np.sin(x / 12)], axis=-1))
    made = ta.plan([face], TOOL, 0.2, machine=machine(TABLE, HEAD), offset=(-20.0, -15, 25), workers=1)
    assert made.outcome == "complete"
    verdict = ta.verify(made)
    room = verdict.operations[0].clearance["machine"]
    assert verdict.passed and room.distance >= 1.0
    tall = MachineBody("clamp", "C", "box", np.array([[-20.0, 45, 25], [20, 75, 175]]))
    in_the_way = machine(TABLE, HEAD, tall)
    moved = ta.verify(_on(made, in_the_way))
    assert not moved.passed
    assert any("the clamp" in reason and "on small, needed 1.0 mm" in reason for reason in moved.reasons)


def _on(made: Plan, other: Machine) -> Plan:
    assert made.machine is not None
    return replace(made, machine=replace(made.machine, machine=other))


def test_turning_between_operations_is_judged_too() -> None:
    one = rig(replace(TABLE, points=np.array([[0.0, 0, -400], [0, 0, 0]])), HEAD)
    pairs = [(a, b) for a, b in one.pairs if {a.name, b.name} == {"head", "table"}]
    before, after = np.array([0.0, 0, -20, 0, 0]), np.array([0.0, 0, -20, 0, radians(100)])
    found = least_room(one, np.stack([before, after]), 5.0, pairs)
    lowest = 90 - 20 - np.hypot(90, 70)  # the rim of the head turns about a point 90 mm above it
    assert found.distance == pytest.approx(lowest, abs=1.0)
    move = one.between(before, after)
    assert move is not None and move[:, 2].tolist() == [-20, 900, 900, -20], "one straight line to a tilted spindle"
    assert move[:, 4].tolist() == [0, 0, after[4], after[4]]
    assert one.between(None, after) is None
    first = one.between(None, before)
    assert first is not None and first[:, 2].tolist() == [900, -20]
    up = least_room(one, move[1:3], 1.0, pairs)
    assert up.distance == 100.0, "beyond what is measured"
