"""A machine with a part on its table: reach, travel, steps and words, against forward kinematics and by hand."""

from math import pi, radians

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.kinematics import forward, rotary_angles
from toolaxis.machine.library import library, load_machine, machine_from_toml, machine_to_toml
from toolaxis.machine.limits import AllOf, Cone, refusal
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting

DRIVE = Drive(100.0, 1000.0, 10000.0)


def stepped(increment: float = radians(5.0)) -> Machine:
    """A tilting and a turning table in steps, with 200 mm of travel each way, but 120 in -X."""
    linear = tuple(LinearAxis(name, way, DRIVE, -120.0 if name == "X" else -200.0, 200.0)
                   for name, way in zip("XYZ", np.eye(3), strict=True))
    table = (RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), DRIVE, -pi, pi, increment),
             RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), DRIVE, radians(-31.0), radians(93.0), increment))
    return Machine("stepped", linear, table)


def axes_around(count: int, seed: int = 3) -> np.ndarray:
    rows = np.random.default_rng(seed).normal(size=(count, 3))
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def test_allowed_is_reach_where_nothing_has_to_be_reached() -> None:
    mounting, axes = Mounting(stepped()), axes_around(300)
    assert (mounting.allowed(axes) == rotary_angles(stepped(), axes).within.any(axis=1)).all()
    assert 0 < mounting.allowed(axes).sum() < 300
    assert ((mounting.excess(axes) == 0) == mounting.allowed(axes)).all()


def test_travel_forbids_what_no_solution_brings_inside() -> None:
    points = np.array([[100.0, 0, 0], [-100, 0, 0], [0, 120, 30]])
    place = np.array([30.0, -20.0, 40.0])
    mounting = Mounting(stepped(), place, 80.0).reaching(points)
    axes = axes_around(400, 8)
    found = rotary_angles(stepped(), axes, table_from_part=place)
    expected = np.zeros(len(axes), dtype=bool)
    for k, axis in enumerate(axes):
        for branch in np.flatnonzero(found.within[k]):
            inside = True
            for point in points:
                joints = mounting_joints(found.joints[k, branch], point, axis, place)
                inside &= in_travel(joints)
            expected[k] |= inside
    assert (mounting.allowed(axes) == expected).all()
    assert expected.any() and (found.within.any(axis=1) & ~expected).any()
    only_travel = found.within.any(axis=1) & ~expected
    assert (mounting.excess(axes)[only_travel] > 0).all()
    assert "would leave its travel by" in mounting.why(axes[only_travel][0])


def in_travel(linear: np.ndarray) -> bool:
    return bool((np.abs(linear) <= 200.0).all() and linear[0] >= -120.0)


def mounting_joints(rotary: np.ndarray, point: np.ndarray, axis: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Linear coordinates by solving the forward kinematics for them: they enter it linearly."""
    def tip(linear: np.ndarray) -> np.ndarray:
        tips, axes = forward(stepped(), np.concatenate([linear, rotary])[None], 80.0, place)
        assert np.allclose(axes[0], axis, atol=1e-9)
        return tips[0]

    start = tip(np.zeros(3))
    slopes = np.stack([tip(one) - start for one in np.eye(3)], axis=1)
    return np.linalg.solve(slopes, point - start)


def test_axes_on_steps_are_those_around_the_given_one() -> None:
    machine = stepped()
    mounting = Mounting(machine)
    for axis in axes_around(60, 4):
        near = mounting.on_steps(axis)
        if not mounting.allowed(axis)[0]:
            assert not len(near)
            continue
        for one in near:
            angles = mounting.solutions(one)
            assert len(angles) and np.allclose(angles / radians(5.0), np.round(angles / radians(5.0)), atol=1e-9)
            assert np.allclose(mounting.axis_at(angles[0]), one, atol=1e-12)
        away = np.arccos(np.clip(near @ axis, -1, 1))
        assert (np.diff(away) >= -1e-12).all() and away[0] <= radians(5.0)
    fine = Mounting(stepped(radians(0.001)))
    near = fine.on_steps((0.1, -0.5, 0.8))
    assert len(near) == 1
    angles = fine.solutions(near[0])
    assert np.allclose(angles / radians(0.001), np.round(angles / radians(0.001)), atol=1e-6)


def test_solutions_end_inside_the_range_where_a_step_would_not() -> None:
    mounting = Mounting(stepped())
    tilt = radians(92.0)  # rounds to 90; 93 would round to 95, beyond the range
    for value in (tilt, radians(93.0)):
        axis = mounting.axis_at(np.array([0.3, value]))
        angles = mounting.solutions(axis)
        assert len(angles) and np.degrees(angles[:, 1]).max() == pytest.approx(90)


def test_words() -> None:
    mounting = Mounting(stepped(), (0.0, 0.0, 0.0), 80.0)
    assert mounting.why((0, 0, 1)) == ""
    assert "45.00 deg beyond the rotary ranges" in Mounting(stepped()).why(-mounting.axis_at([0.0, radians(42.0)]))
    far = mounting.reaching([(500.0, 0, 0)])
    assert far.why((0, 0, 1)) == "X of stepped would leave its travel by 300.0 mm to reach the face"
    near = mounting.reaching([(200.02, 0, 0)])
    assert near.why((0, 0, 1)) == "X of stepped would leave its travel by 0.1 mm to reach the face"
    both = AllOf((Cone(np.array([0, 0, 1.0]), 0.1), far))
    assert "X of stepped" in refusal(both, (0, 0, 1)) and refusal(both.parts[0], (0, 0, 1)) == ""
    assert "deg outside the limits" in refusal(both.parts[0], (0, 1, 0))
    assert mounting.out_of_travel([(0, 0, 100.0), (-230.0, 0, 0)], (0, 0, 1)).startswith("X of stepped")
    assert Mounting(stepped()).out_of_travel([(9999.0, 0, 0)], (0, 0, 1)) == "", "travel is not judged without a place"


def test_holding_leaves_out_solutions_that_leave_the_travel() -> None:
    place = np.array([60.0, 40.0, 30.0])
    mounting = Mounting(stepped(), place, 80.0)
    axis = mounting.axis_at([radians(10.0), radians(30.0)])
    assert len(mounting.solutions(axis)) == 2
    one_sided = [p for p in axes_around(200, 2) * 260.0 if len(mounting.hold_side([p], axis)) == 1]
    assert one_sided
    for point in one_sided[:5]:
        (angles,) = mounting.hold_side([point], axis)
        linear = mounting_joints(angles, point, axis, place)
        assert in_travel(linear)


@pytest.mark.parametrize("name", sorted(library()))
def test_a_machine_is_written_and_read_back(name: str) -> None:
    machine = load_machine(name)
    again = machine_from_toml(machine_to_toml(machine))
    assert (again.name, again.source, again.assumed, again.chain) == (machine.name, machine.source, machine.assumed,
                                                                      machine.chain)
    assert np.array_equal(again.gauge, machine.gauge) and np.allclose(again.spindle, machine.spindle, atol=1e-15)
    for a, b in zip((*again.linear, *again.rotary), (*machine.linear, *machine.rotary), strict=True):
        assert (a.name, a.low, a.high, a.drive) == (b.name, b.low, b.high, b.drive)
        assert np.allclose(a.direction, b.direction, atol=1e-15)
    for a, b in zip(again.rotary, machine.rotary, strict=True):
        assert a.increment == b.increment and np.array_equal(a.point, b.point)


def test_what_a_machine_file_does_not_know_stays_unknown() -> None:
    linear = tuple(LinearAxis(name, way, Drive(1.0)) for name, way in zip("XYZ", np.eye(3), strict=True))
    machine = Machine("bare \"3\"", linear, (RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), Drive(1.0), -1, 1),))
    again = machine_from_toml(machine_to_toml(machine))
    assert again.name == machine.name
    assert [axis.drive for axis in (*again.linear, *again.rotary)] == [Drive(1.0)] * 4


@pytest.mark.parametrize(("wrong", "words"), [
    ({"machine": "dmg"}, "machine is a str"), ({"machine": stepped(), "tool_length": -1.0}, "tool length is -1"),
    ({"machine": stepped(), "table_from_part": (1.0, 2.0)}, "work offset")])
def test_wrong_mountings_are_refused(wrong: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        Mounting(**wrong)  # type: ignore[arg-type]
