"""The judge follows cutter locations with the machine: ranges, travel, axes out of reach."""

from math import radians

import numpy as np
import pytest

from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.machine import Machine
from toolaxis.verify.axis_limits import machine_faults

DRIVE = Drive(100.0, 1000.0, 10000.0)


def machine(low: float = -10.0, z: float = 300.0) -> Machine:
    linear = tuple(LinearAxis(name, way, DRIVE, -200.0, z if name == "Z" else 200.0)
                   for name, way in zip("XYZ", np.eye(3), strict=True))
    table = (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE),
             RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), DRIVE, radians(low), radians(60)))
    return Machine("small", linear, table)


TIPS = np.array([[0.0, 0, 0], [50, 0, 0], [50, 20, 10]])
AXES = np.tile([0.0, -np.sin(0.5), np.cos(0.5)], (3, 1))


def test_what_the_machine_can_do_has_no_fault() -> None:
    assert machine_faults(machine(), TIPS, AXES, np.zeros(3), 100.0) == []


def test_a_point_beyond_the_travel() -> None:
    far = TIPS + np.array([[0, 0, 0], [0, 0, 0], [180.0, 0, 0]])
    (fault,) = machine_faults(machine(), far, AXES, np.zeros(3), 100.0)
    assert fault == "X of small would leave its travel by 30.000 mm at point 3"
    assert machine_faults(machine(), far, AXES, np.array([-40.0, 0, 0]), 100.0) == []
    assert machine_faults(machine(), far, AXES, None, 100.0) == [], "without a place there is no travel to judge"


def test_the_tool_s_length_counts() -> None:
    (fault,) = machine_faults(machine(), TIPS, AXES, np.zeros(3), 310.0)
    assert fault.startswith("Z of small would leave its travel by 10.000 mm at point 1")


@pytest.mark.parametrize(("axis", "words"), [((0, -np.sin(1.3), np.cos(1.3)), "A of small would stand 14.485 deg"),
                                             ((0, 0, -1.0), "A of small would stand")])
def test_an_axis_beyond_the_ranges(axis: tuple[float, float, float], words: str) -> None:
    (fault,) = machine_faults(machine(), TIPS, np.tile(axis, (3, 1)), np.zeros(3), 100.0)
    assert fault.startswith(words) and "beyond its range at point" in fault


def test_an_axis_that_no_position_gives() -> None:
    one = Machine("one", machine().linear, (), (RotaryAxis("B", np.array([0, 1.0, 0]), np.zeros(3), DRIVE),))
    (fault,) = machine_faults(one, TIPS, AXES, None, None)
    assert fault.startswith("one has no position for the axis [0.0, -0.4794, 0.8776] of point 1")
