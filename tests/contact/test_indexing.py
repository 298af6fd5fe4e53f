"""Moves between indexed positions: closed forms, and stations sampled densely along them."""

from dataclasses import replace
from math import hypot, radians

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.collision.index_moves import Stop, hull_of, trouble_between, turning
from toolaxis.collision.machine_collision import MachineSurroundings, nearest_meeting
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.kinematics import forward
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.shape.bounding.bounding_tree import forest

DRIVE = Drive(100.0, 1000.0, 10000.0)
TOOL = ta.Tool.torus(diameter=12, corner_radius=1, stickout=60, holder=[(10, 0), (10, 40)])


def machine(top: float, *bodies: MachineBody) -> Machine:
    linear = tuple(LinearAxis(name, way, DRIVE, -900, top if name == "Z" else 900)
                   for name, way in zip("XYZ", np.eye(3), strict=True))
    table = (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE),
             RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), DRIVE, -2, 2))
    return Machine("trunnion", linear, table, bodies=bodies)


def plate(x: float, y: float, z: float) -> ta.Face:
    a, b = np.meshgrid(np.linspace(-x, x, 4), np.linspace(-y, y, 4), indexing="ij")
    return ta.Face.from_bspline(np.stack([a, b, np.full_like(a, z)], axis=-1))


PLATE = plate(20, 20, 10)
AROUND = MachineSurroundings(TOOL, (forest((PLATE,)),), 1.0)
TABLE = MachineBody("table", "C", "box", np.array([[-50.0, -150, -40], [50, 150, 0]]))
HEAD = MachineBody("head", "Z", "cylinder", np.array([[0.0, 0, 0], [0, 0, 200]]), 40.0)


def mounted(top: float, *bodies: MachineBody) -> Mounting:
    return Mounting(machine(top, *bodies), (0.0, 0.0, 0.0), TOOL.gauge_length)


@pytest.mark.parametrize(("top", "free"), [(280.0, True), (220.0, False)])
def test_a_table_that_swings_up_to_the_tool(top: float, free: bool) -> None:
    """Its far edge turns on a circle of hypot(150, 40) about A; the tip stands 100 mm below the gauge point."""
    assert (top - 100 > hypot(150, 40) + 6) == free
    swing = turning(mounted(top, TABLE, HEAD), np.array([0.0, 0, top]), ((0.0, 0.0), (0.0, 1.9)), AROUND)
    assert (swing == "") == free
    if not free:
        assert "while the axes turn the cutter " in swing and "table" in swing and " at C 0 A " in swing


def test_the_axes_may_turn_in_any_order() -> None:
    """At A 90 the plate's corner only comes up where C has not turned yet: no straight way from angles to angles is."""
    long = MachineBody("table", "C", "box", np.array([[-30.0, -200, -20], [30, 200, 0]]))
    top = 100 + 150.0
    way = ((0.0, 0.0), (radians(90), radians(90)))
    mounting = mounted(top, long, HEAD)
    ends = [nearest_meeting(mounting, np.array(end), tips(mounting, np.array(end), top), AROUND) for end in way]
    assert ends == [None, None]
    assert turning(mounting, np.array([0.0, 0, top]), way, AROUND) != ""


def tips(mounting: Mounting, rotary: np.ndarray, top: float) -> np.ndarray:
    return forward(mounting.machine, np.array([[0.0, 0, top, *rotary]]), TOOL.gauge_length, mounting.table_from_part)[0]


def test_what_is_proven_clear_is_clear_wherever_the_axes_stand() -> None:
    """Random turns and heights: stations sampled in the whole rectangle of angles, by the check for standing axes."""
    rng, clear, met = np.random.default_rng(8), 0, 0
    cradle = MachineBody("cradle", "A", "box", np.array([[-160.0, -60, -90], [160, 60, -50]]))
    for _ in range(16):
        top = rng.uniform(150, 290)
        mounting = mounted(top, TABLE, cradle, HEAD)
        one, other = rng.uniform(-1.9, 1.9, 2), np.array([rng.uniform(-3, 3), rng.uniform(1.1, 1.9)])
        at = np.array([*rng.uniform(-60, 60, 2), top])
        if turning(mounting, at, (one, other), AROUND):
            met += 1
            continue
        clear += 1
        for share in rng.uniform(0, 1, (8, 2)):
            rotary = one + share * (other - one)
            tip, _ = forward(mounting.machine, np.concatenate([at, rotary])[None], TOOL.gauge_length,
                             mounting.table_from_part)
            assert nearest_meeting(mounting, rotary, tip, AROUND, with_tool=True) is None
    assert clear > 4 and met > 4, (clear, met)


def test_up_over_and_down() -> None:
    """A post beside the part stands in the way over, where X and Y may bend off; higher up it does not."""
    wall = MachineBody("post", "bed", "box", np.array([[60.0, -20, -50], [80, 20, 300]]))
    mounting = mounted(350.0, TABLE, HEAD, wall)
    a, b = Stop(np.array([-15.0, 0, 40]), np.zeros(2)), Stop(np.array([25.0, 0, 40]), np.zeros(2))
    assert trouble_between(mounting, a, b, AROUND) != "", "the head is 40 mm wide"
    assert trouble_between(mounted(350.0, TABLE, HEAD), a, b, AROUND) == ""
    far = MachineBody("post", "bed", "box", np.array([[100.0, -20, -50], [120, 20, 300]]))
    assert trouble_between(mounted(350.0, TABLE, HEAD, far), a, b, AROUND) == ""
    behind = Stop(np.array([200.0, 0, 40]), np.zeros(2))
    found = trouble_between(mounted(350.0, TABLE, HEAD, far), a, behind, AROUND)
    assert found.startswith("on the approach the ") and "post" in found
    assert trouble_between(mounted(600.0, TABLE, HEAD, far), a, behind, AROUND) == ""


def test_x_and_y_may_go_over_in_any_way() -> None:
    """A post in the corner of the rectangle, beside the straight line."""
    corner = MachineBody("post", "bed", "box", np.array([[150.0, -10, -50], [170, 10, 300]]))
    mounting = mounted(350.0, TABLE, HEAD, corner)
    a, b = Stop(np.array([0.0, 0, 40]), np.zeros(2)), Stop(np.array([160.0, 160, 40]), np.zeros(2))
    assert "post" in trouble_between(mounting, a, b, AROUND)
    straight = np.array([forward(mounting.machine, np.array([[160.0 * s, 160 * s, 350, 0, 0]]), TOOL.gauge_length,
                                 mounting.table_from_part)[0][0] for s in np.linspace(0, 1, 9)])
    assert nearest_meeting(mounting, np.zeros(2), straight, AROUND) is None


def test_the_hull_of_a_part_holds_it() -> None:
    x, y = np.meshgrid(np.linspace(0, 60, 6), np.linspace(0, 40, 6), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 8 * np.sin(x / 9) * np.cos(y / 7)], axis=-1))
    found, points = hull_of(forest((face,))), face.evaluate(face.grid(40, 40)).point
    ways = np.random.default_rng(1).normal(size=(60, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    far = (found.support(ways) * ways).sum(axis=1)
    assert (far >= (points @ ways.T).max(axis=0) - 1e-9).all()
    assert (far <= (points @ ways.T).max(axis=0) + 3.0).all()


def test_index_moves_are_judged_where_the_height_of_the_retract_is_known() -> None:
    assert mounted(300.0, TABLE, HEAD).judges_index_moves
    assert not mounted(np.inf, TABLE, HEAD).judges_index_moves
    assert not mounted(300.0, HEAD).judges_index_moves
    assert not replace(mounted(300.0, TABLE, HEAD), tool_length=None).judges_index_moves
