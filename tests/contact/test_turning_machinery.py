"""Bodies of a machine while its rotary axes turn along a path: a closed form, and positions taken one by one."""

from math import cos, degrees, radians, sin

import numpy as np
import pytest
from scipy.optimize import brentq

import toolaxis as ta
from toolaxis.collision.machine_collision import MachineSurroundings, nearest_meeting
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.kinematics import forward, linear_coordinates
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.strategies.common.machine_collision import MachineMotions, meeting_in_motion, motions

DRIVE = Drive(100.0, 1000.0, 10000.0)
TOOL = ta.Tool.torus(diameter=12, corner_radius=1, stickout=60, holder=[(10, 0), (10, 40)])
HEAD = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 0], [0, 0, 150]]), 60.0)
TABLE = MachineBody("table", "C", "box", np.array([[-200.0, -200, -40], [200, 200, 0]]))


def linear() -> tuple[LinearAxis, ...]:
    return tuple(LinearAxis(name, way, DRIVE, -900, 900) for name, way in zip("XYZ", np.eye(3), strict=True))


def plate() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0 * x], axis=-1))


def around(required: float) -> MachineSurroundings:
    return MachineSurroundings(TOOL, (forest((plate(),)),), required)


def along(mounting: Mounting, tips: np.ndarray, rotary: np.ndarray) -> MachineMotions:
    at = linear_coordinates(mounting.machine, tips, rotary, TOOL.gauge_length, mounting.table_from_part)
    _, axes = forward(mounting.machine, np.hstack([at, rotary]), TOOL.gauge_length, mounting.table_from_part)
    return motions(tips, axes, rotary, at, np.arange(len(tips)))


def test_a_head_that_tilts_down_to_the_table() -> None:
    """The lower rim of the head stands 50 + 100 cos b - 60 sin b above the table; the table turns meanwhile."""
    machine = Machine("head-table", linear(), (RotaryAxis("C", np.array([0.0, 0, 1]), np.zeros(3), DRIVE),),
                      (RotaryAxis("B", np.array([0.0, 1, 0]), np.zeros(3), DRIVE, -2.2, 2.2),), bodies=(TABLE, HEAD))
    mounting = Mounting(machine, (0.0, 0.0, 50.0), TOOL.gauge_length)

    def gap(tilt: float) -> float:
        return 50 + 100 * cos(tilt) - 60 * sin(tilt)

    least = brentq(lambda tilt: gap(tilt) - 5.0, radians(40), radians(90))
    for end, free in ((least - 0.002, True), (least + 0.002, False)):
        share = np.linspace(0, 1, 201)
        rotary = np.stack([2 * share, radians(-30) + share * (end + radians(30))], axis=1)
        found = meeting_in_motion(mounting, along(mounting, np.tile([20.0, 15, 0], (201, 1)), rotary), around(5.0))
        assert (found is None) == free
        if found is not None:
            meeting, angles = found
            assert (meeting.one, meeting.other, meeting.motion) == ("head", "table", 200)
            assert degrees(angles[1]) == pytest.approx(degrees(end), abs=0.3)
            assert meeting.distance == pytest.approx(5.0, abs=0.3)


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.long) for k in (1, 3, 4))])
def test_what_is_free_at_every_position_is_free_on_the_way_and_nothing_else(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = (MachineBody("table", "C", "box", np.array([[-150.0, -90, -40], [150, 90, 0]])),
              MachineBody("cradle", "A", "box", np.array([[-260.0, -80, -90], [260, 80, -45]])),
              MachineBody("head", "Z", "box", np.array([[-70.0, -60, 0], [70, 90, 200]])),
              MachineBody("slide", "Y", "box", np.array([[-90.0, 150, 100], [90, 220, 400]])))
    machine = Machine("trunnion", linear(), (RotaryAxis("C", np.array([0.0, 0, 1]), np.zeros(3), DRIVE), RotaryAxis(
        "A", np.array([1.0, 0, 0]), np.array([0.0, 0, 30]), DRIVE, -2, 2)), bodies=bodies)
    mounting = Mounting(machine, (-20.0, -15.0, 10.0), TOOL.gauge_length)
    ends, tilt = rng.uniform(-3, 3, 2), rng.uniform(-1.2, 1.2, 2)
    share = np.linspace(0, 1, 121)[:, None]
    rotary = np.array([ends[0], tilt[0]]) + share * np.array([ends[1] - ends[0], tilt[1] - tilt[0]])
    way = along(mounting, 15 + 15 * np.sin(rng.uniform(1, 6, 3) * share + rng.uniform(0, 6, 3)), rotary)
    least = min(_distance(mounting, row) for row in _positions(way))
    assert meeting_in_motion(mounting, way, around(least + 0.3 if least > 0 else 0.0)) is not None
    if least > 0:
        assert meeting_in_motion(mounting, way, around(0.7 * least - 0.3)) is None


def _positions(way: MachineMotions) -> list[tuple[np.ndarray, np.ndarray]]:
    return [(way.linear[k, 0], way.rotary[k, 0]) for k in range(0, len(way.arrival), 5)]


def _distance(mounting: Mounting, joints: tuple[np.ndarray, np.ndarray]) -> float:
    """At rest, by the distances that passes with a fixed axis are held to."""
    tip, _ = forward(mounting.machine, np.concatenate(joints)[None], TOOL.gauge_length, mounting.table_from_part)
    found = nearest_meeting(mounting, joints[1], tip, around(300.0), most=300.0)
    assert found is not None
    return found.distance


def test_a_cutter_that_leans_over_the_table_beside_the_part() -> None:
    """The tip stays 20 mm above the table; the corner, centred 5 mm aside and 1 mm up, comes down as the tool leans."""
    slim = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 0], [0, 0, 50]]), 5.0)
    machine = Machine("head-table", linear(), (RotaryAxis("C", np.array([0.0, 0, 1]), np.zeros(3), DRIVE),),
                      (RotaryAxis("B", np.array([0.0, 1, 0]), np.zeros(3), DRIVE, -2.2, 2.2),), bodies=(TABLE, slim))
    mounting = Mounting(machine, (0.0, 0.0, 20.0), TOOL.gauge_length)
    share = np.linspace(0, 1, 101)
    way = along(mounting, np.tile([20.0, 15, 0], (101, 1)), np.stack([2 * share, radians(60) * share], axis=1))
    least = 20 - 5 * sin(radians(60)) + cos(radians(60)) - 1
    assert meeting_in_motion(mounting, way, around(least - 0.1)) is None
    found = meeting_in_motion(mounting, way, around(least + 0.1))
    assert found is not None and (found[0].one, found[0].other, found[0].motion) == ("cutter", "table", 100)
    assert found[0].distance == pytest.approx(least, abs=0.1)
