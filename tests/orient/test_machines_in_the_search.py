"""A machine in the search: axes on its steps, inside its ranges and its travel, and the reason where there is none."""

from math import radians

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.limits import Cone
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import best_axis, evaluate_axis

DRIVE = Drive(100.0, 1000.0, 10000.0)
HOLDER = [(10.0, 0.0), (10.0, 40.0)]


def machine(increment: float = 0.0, z: tuple[float, float] = (-500.0, 500.0), tilt: float = 60.0) -> Machine:
    linear = (LinearAxis("X", np.array([1.0, 0, 0]), DRIVE, -300, 300),
              LinearAxis("Y", np.array([0, 1.0, 0]), DRIVE, -300, 300),
              LinearAxis("Z", np.array([0, 0, 1.0]), DRIVE, *z))
    table = (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE, increment=increment),
             RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), DRIVE, radians(-10), radians(tilt), increment))
    return Machine("small", linear, table)


@pytest.fixture(scope="module")
def wave() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 3 * np.sin(x / 15) + 2 * np.cos(y / 12)], axis=-1))


TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=HOLDER)


def test_an_axis_stands_on_the_machine_s_steps(wave: ta.Face) -> None:
    held = Mounting(machine(radians(5.0)))
    found = best_axis(wave, TOOL, 0.2, held)
    assert found.axis is not None and found.outcome == "feasible"
    angles = held.solutions(found.axis)
    assert len(angles) and np.allclose(held.axis_at(angles[0]), found.axis, atol=1e-12)
    assert np.allclose(angles / radians(5.0), np.round(angles / radians(5.0)), atol=1e-9)
    free = best_axis(wave, TOOL, 0.2, limits=Cone(np.array([0, 0, 1.0]), radians(60)))  # the flank's lobe is narrow
    assert found.length == pytest.approx(free.length, rel=0.1) and found.length >= 0.99 * free.length


def test_a_machine_by_its_name_and_with_a_cone(wave: ta.Face) -> None:
    found = best_axis(wave, TOOL, 0.2, "dmg-dmu-60t", limits=Cone(np.array([0, 0, 1.0]), radians(25)))
    assert found.axis is not None and found.axis[2] >= np.cos(radians(25)) - 1e-9
    assert len(Mounting(ta.load_machine("dmg-dmu-60t")).solutions(found.axis))


def test_out_of_the_rotary_ranges(wave: ta.Face) -> None:
    up = evaluate_axis(wave, TOOL, (0, -0.96, 0.28), 0.2, Mounting(machine(tilt=20.0)))
    assert up.outcome == "infeasible"
    assert "no position of small reaches the axis: it is 53.74 deg beyond the rotary ranges" in up.reasons[0]


def test_a_part_beyond_the_travel_has_no_axis_and_the_reason_says_so(wave: ta.Face) -> None:
    found = best_axis(wave, TOOL, 0.2, Mounting(machine(), (800.0, 0.0, 0.0)))
    assert found.axis is None and found.outcome in ("not_found", "infeasible")
    assert "leave its travel by" in found.reasons[0]


def test_passes_inside_and_links_outside_the_travel_are_refused(wave: ta.Face) -> None:
    # the gauge point stands 90 mm above the tip; the part's top at 5 mm, links cross 5 mm above it
    axis = (0.0, -0.2, 0.98)
    enough, low = (evaluate_axis(wave, TOOL, axis, 0.2, Mounting(machine(z=(-500.0, top)), (0.0, 0.0, 0.0)))
                   for top in (125.0, 98.0))
    assert enough.axis is not None, enough.reasons
    assert low.axis is None and "Z of small would leave its travel by" in low.reasons[0]
    assert "links" in low.reasons[0]


def test_travel_is_not_judged_where_the_place_is_not_known(wave: ta.Face) -> None:
    job = task(wave, TOOL, 0.2, Mounting(machine(z=(0.0, 1.0))))
    assert job.feasibility.witness(np.array([0.0, -0.2, 0.98]) / np.linalg.norm([0.0, -0.2, 0.98])) is None


def test_wrong_machines_are_refused(wave: ta.Face) -> None:
    with pytest.raises(InvalidInput, match="machine 'lathe' is neither a file nor one of the library"):
        best_axis(wave, TOOL, 0.2, "lathe")
    with pytest.raises(InvalidInput, match="machine is a float"):
        best_axis(wave, TOOL, 0.2, 3.0)  # type: ignore[arg-type]
