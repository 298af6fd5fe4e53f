"""Head and table in the search: the axis at which they meet is refused with the reason, another is found."""

from math import cos, degrees, radians, sin

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.collision.machine_collision import MachineSurroundings, nearest_meeting
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.limits import Cone
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.search.fixed_axis import best_axis, evaluate_axis
from toolaxis.shape.bounding.bounding_tree import forest

DRIVE = Drive(100.0, 1000.0, 10000.0)
TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
TABLE = MachineBody("table", "C", "cylinder", np.array([[0.0, 0, -60], [0, 0, 0]]), 300.0)
HEAD = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 0], [0, 0, 150]]), 70.0)


def machine(*bodies: MachineBody) -> Machine:
    linear = tuple(LinearAxis(name, way, DRIVE, -900, 900) for name, way in zip("XYZ", np.eye(3), strict=True))
    return Machine("small", linear, (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE),),
                   (RotaryAxis("B", np.array([0, 1.0, 0]), np.zeros(3), DRIVE, -2.2, 2.2),), bodies=bodies)


def mounting(*bodies: MachineBody) -> Mounting:
    return Mounting(machine(*bodies), (-20.0, -15.0, 25.0), TOOL.gauge_length)


@pytest.fixture(scope="module")
def slope() -> ta.Face:
    """A face that looks about 70 degrees to the side, wavy."""
    x, s = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 25, 5), indexing="ij")
    y, z = s * cos(radians(70)), s * sin(radians(70))
    return ta.Face.from_bspline(np.stack([x, y, z + 1.5 * np.sin(x / 12)], axis=-1), flip=False)


def test_the_axis_that_lays_the_head_on_the_table_is_refused(slope: ta.Face) -> None:
    side = (0.0, -sin(radians(74)), cos(radians(74)))
    free, met = (evaluate_axis(slope, TOOL, side, 0.2, mounting(*bodies)) for bodies in ((), (TABLE, HEAD)))
    assert free.axis is not None, free.reasons
    assert met.axis is None and "the head collides with the table by" in met.reasons[0]
    assert " at C " in met.reasons[0] and "B " in met.reasons[0]


def test_another_axis_is_found_and_keeps_its_distance(slope: ta.Face) -> None:
    near = Cone(np.array([0.0, -sin(radians(62)), cos(radians(62))]), radians(25))
    free = best_axis(slope, TOOL, 0.2, mounting(), limits=near)
    found = best_axis(slope, TOOL, 0.2, mounting(TABLE, HEAD), limits=near)
    assert free.axis is not None and found.axis is not None, found.reasons
    tilts = [degrees(np.arccos(one.axis[2])) for one in (free, found)]
    assert tilts[1] < tilts[0] - 0.5
    rows = mounting(TABLE, HEAD).solutions(found.axis)
    tips = ta.passes(slope, TOOL, found.axis, 0.2, feed=found.feed).cl
    around = MachineSurroundings(TOOL, (forest((slope,)),), 0.9)
    assert any(nearest_meeting(mounting(TABLE, HEAD), row, tips, around) is None for row in rows)


def test_where_every_axis_lays_the_head_on_the_table_the_reason_says_so(slope: ta.Face) -> None:
    near = Cone(np.array([0.0, -1.0, 0.0]), radians(8))
    found = best_axis(slope, TOOL, 0.2, mounting(TABLE, HEAD), limits=near)
    assert found.axis is None
    assert "the head collides with the table by" in found.reasons[0] and "to reach the face" in found.reasons[0]


def test_bodies_forbid_nothing_that_they_do_not_touch(slope: ta.Face) -> None:
    """High above the table the axes allowed are those of the machine without bodies."""
    rows = np.random.default_rng(3).normal(size=(300, 3))
    bare, built = (Mounting(machine(*bodies), (-20.0, -15.0, 500.0), TOOL.gauge_length).reaching([(0.0, 0, 0)], 1.0)
                   for bodies in ((), (TABLE, HEAD)))
    assert (bare.allowed(rows) == built.allowed(rows)).all()
    assert not built.allowed([(0.0, 0.0, -1.0)])[0]
    low = Mounting(machine(TABLE, HEAD), (-20.0, -15.0, 10.0), TOOL.gauge_length).reaching([(0.0, 0, 0)], 1.0)
    tilt = np.degrees(np.arccos(rows[:, 2] / np.linalg.norm(rows, axis=1)))
    allowed = low.allowed(rows)
    # the head's rim stands 10 + 90 cos b - 70 sin b above the table
    assert allowed[tilt < 55].all() and not allowed[(tilt > 62) & (tilt < 100)].any()
