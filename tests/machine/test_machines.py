"""One contract for every machine that comes with toolaxis, and the conventions that its numbers follow."""

import re
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.kinematics import (
    forward,
    inverse,
    linear_coordinates,
    part_from_machine,
    rotary_angles,
    tool_axes,
)
from toolaxis.machine.library import library, load_machine
from toolaxis.machine.machine import Machine
from toolaxis.machine.reach import reach_excess, travel_excess
from toolaxis.numeric.rotations import one_turn, two_turns
from toolaxis.numeric.vectors import rotation

NAMES = ("mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "nutating-head", "head-head-portal", "ab-trunnion",
         "three-axes-fixture")


def _oracle(machine: Machine, joints: np.ndarray, tool_length: float, offset: np.ndarray) -> tuple[np.ndarray, ...]:
    """Tip and axis of one pose by 4 x 4 matrices, the table and the head moved as bodies."""
    def about(axis: RotaryAxis, angle: float) -> np.ndarray:
        matrix = np.eye(4)
        matrix[:3, :3] = rotation(axis.direction, angle)
        matrix[:3, 3] = axis.point - matrix[:3, :3] @ axis.point
        return matrix

    table = np.eye(4)
    for axis, angle in zip(machine.table, joints[3:], strict=False):
        table = about(axis, -angle) @ table  # the part turns the other way round, the axis next to it first
    head = np.eye(4)
    for axis, angle in zip(machine.head, joints[3 + len(machine.table):], strict=True):
        head = head @ about(axis, angle)
    slide = np.eye(4)
    slide[:3, 3] = sum(value * axis.direction for value, axis in zip(joints[:3], machine.linear, strict=True))
    tool = np.append(np.asarray(machine.gauge) - tool_length * np.asarray(machine.spindle), 1.0)
    part = np.linalg.inv(table @ offset) @ slide @ head
    return (part @ tool)[:3], part[:3, :3] @ np.asarray(machine.spindle)


def _offset(rng: np.random.Generator) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(rng.normal(size=3), rng.uniform(-pi, pi))
    matrix[:3, 3] = rng.uniform(-200, 200, 3)
    return matrix


def _poses(machine: Machine, rng: np.random.Generator, count: int) -> np.ndarray:
    angles = [rng.uniform(max(axis.low, -pi), min(axis.high, pi), count) for axis in machine.rotary]
    return np.stack([*rng.uniform(-300, 300, (3, count)), *angles], axis=1)


def test_all_are_there() -> None:
    assert set(NAMES) <= set(library())


@pytest.mark.parametrize("name", NAMES)
def test_forward_is_the_chain_of_bodies(name: str) -> None:
    machine, rng = load_machine(name), np.random.default_rng(1)
    offset = _offset(rng)
    joints = _poses(machine, rng, 20)
    points, axes = forward(machine, joints, 123.0, offset)
    for row, point, axis in zip(joints, points, axes, strict=True):
        tip, way = _oracle(machine, row, 123.0, offset)
        assert np.abs(tip - point).max() < 1e-10 and np.abs(way - axis).max() < 1e-13


@pytest.mark.parametrize("name", NAMES)
def test_forward_after_inverse_returns_the_input(name: str) -> None:
    machine, rng = load_machine(name), np.random.default_rng(2)
    offset = _offset(rng)
    points, axes = forward(machine, _poses(machine, rng, 10_000), 80.0, offset)
    found = inverse(machine, points, axes, 80.0, offset)
    assert found.reached.all()
    for branch in range(found.joints.shape[1]):
        again, ways = forward(machine, found.joints[:, branch], 80.0, offset)
        assert np.abs(again - points).max() < 1e-12 * np.abs(points).max() / 20
        assert np.abs(ways - axes).max() < 1e-13


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("away", [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4])
def test_at_and_near_singular_directions(name: str, away: float) -> None:
    machine = load_machine(name)
    a, b = (axis.direction for axis in machine.rotary)
    towards = np.cross(a, b) / np.linalg.norm(np.cross(a, b))
    spindle = np.asarray(machine.spindle)
    size = np.arccos(np.clip(a @ b, -1, 1)) + np.arccos(np.clip(b @ spindle, -1, 1))
    least = abs(np.arccos(np.clip(a @ b, -1, 1)) - np.arccos(np.clip(b @ spindle, -1, 1)))
    for angle in (least + away, min(size, pi) - away):
        axis = np.cos(angle) * a + np.sin(angle) * towards
        found = rotary_angles(machine, axis)
        assert found.reached.all()
        for branch in range(2):
            assert np.abs(tool_axes(machine, found.joints[:, branch]) - axis).max() < 2e-12
        assert found.determinant[0] < 4 * np.sqrt(away) + 1e-7
        assert found.free[0] == (np.linalg.norm(np.cross(a, axis)) < 1e-13)


def test_a_free_axis_stays_where_it_is() -> None:
    machine = load_machine("mikron-ucp-710")
    found = rotary_angles(machine, (0, 0, 1), near=(2.5, 0.0))
    assert found.free.all() and np.allclose(found.joints[0, :, 0], 2.5) and np.allclose(found.joints[0, :, 1], 0)


def test_there_are_no_other_solutions() -> None:
    """A fine scan of both angles of a nutating head meets the axis near the two solutions only."""
    machine = load_machine("nutating-head")
    axis = np.array([0.3, -0.4, 0.7]) / np.linalg.norm([0.3, -0.4, 0.7])
    grid = np.radians(np.arange(-180, 180, 1.0))
    pairs = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
    near = pairs[tool_axes(machine, pairs) @ axis > np.cos(np.radians(1.0))]
    solutions = rotary_angles(machine, axis).joints[0]
    gap = np.abs(np.angle(np.exp(1j * (near[:, None] - solutions[None])))).max(axis=2)
    assert len(near) > 4 and gap.min(axis=1).max() < np.radians(4) and (gap.min(axis=0) < np.radians(2)).all()


def test_out_of_reach_is_told() -> None:
    machine = load_machine("nutating-head")  # 45 degrees about 45 degrees: down to the horizon and no further
    assert rotary_angles(machine, [(0, 0, 1), (1, 0, 0), (0, 0.6, -0.8)]).reached.tolist() == [True, True, False]
    found = rotary_angles(load_machine("ab-trunnion"), [(0, 0, 1), (0, 1, 1), (0, -1, 1)])
    assert found.within.any(axis=1).tolist() == [True, False, True]


def test_the_papers_matrix() -> None:
    """[grandguillaume2021] Eq. 16 for the table that tilts A and turns C."""
    machine = load_machine("mikron-ucp-710")
    a, c = 0.7, -0.4
    expected = [[np.cos(c), -np.cos(a) * np.sin(c), np.sin(a) * np.sin(c)],
                [np.sin(c), np.cos(a) * np.cos(c), -np.sin(a) * np.cos(c)], [0, np.sin(a), np.cos(a)]]
    assert np.abs(part_from_machine(machine, [(c, a)])[0] - expected).max() < 1e-15


def test_table_1() -> None:
    machine = load_machine("mikron-ucp-710")
    assert [axis.drive.levels(axis.name) for axis in machine.linear] == [(500, 2500, 5000), (500, 3000, 5000),
                                                                         (500, 2100, 5000)]
    turning = {axis.name: np.array(axis.drive.levels(axis.name)) / (2 * pi) for axis in machine.rotary}  # type: ignore[union-attr]
    assert np.allclose(turning["A"], (0.25, 0.83, 5)) and np.allclose(turning["C"], (0.33, 0.83, 50))


def test_kinds_and_chains() -> None:
    kinds = {name: load_machine(name).kind for name in NAMES}
    assert kinds == {"mikron-ucp-710": "table-table", "dmg-dmu-60t": "head-table", "bc-table-table": "table-table",
                     "nutating-head": "head-table", "head-head-portal": "head-head", "ab-trunnion": "table-table",
                     "three-axes-fixture": "table-table"}
    assert load_machine("mikron-ucp-710").chain == "w C' A' b X Y Z t"
    assert load_machine("head-head-portal").chain == "w b X Y Z C A t"
    assert [name for name in NAMES if load_machine(name).nutating] == ["nutating-head"]


def test_a_pivoting_head_takes_its_length_along() -> None:
    """B at 90 degrees puts the tip of a head 150 mm from its pivot, with a tool of 50 mm, 200 mm to the side."""
    machine = load_machine("dmg-dmu-60t")
    still = linear_coordinates(machine, (0, 0, 0), (0.0, 0.0), 50.0)
    turned_over = linear_coordinates(machine, (0, 0, 0), (0.0, -pi / 2), 50.0)
    assert np.allclose(still, (0, 0, 200)) and np.allclose(turned_over, (-200, 0, 0))


def test_fewer_axes() -> None:
    drive = Drive(1.0, 1.0, 1.0)
    linear = tuple(LinearAxis(name, way, drive) for name, way in zip("XYZ", np.eye(3), strict=True))
    plain = Machine("plain", linear)
    assert plain.kind == "three axes"
    assert rotary_angles(plain, [(0, 0, 1), (0, 0.1, 1)]).within[:, 0].tolist() == [True, False]
    four = Machine("four", linear, (RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), drive, -1.0, 1.0),))
    found = rotary_angles(four, [(0, -np.sin(0.5), np.cos(0.5)), (0.1, 0, 1), (0, 1, 0)])
    assert found.reached.tolist() == [True, False, True] and found.within[:, 0].tolist() == [True, False, False]
    assert found.joints[0, 0, 0] == pytest.approx(0.5, abs=1e-14)
    assert reach_excess(four, [(0, 1, 0)])[0] == pytest.approx(pi / 2 - 1)
    assert reach_excess(plain, [(0, 1, 0)])[0] == pytest.approx(pi / 2)


def test_whole_turns_inside_the_range() -> None:
    axis = RotaryAxis("C", np.array([0, 0, 1.0]), np.zeros(3), None, radians(-360), radians(360))
    assert np.allclose(np.degrees(axis.turns(radians(10))), [-350, 10])
    assert np.allclose(np.degrees(axis.turns(0.0)), [-360, 0, 360])
    values, inside = axis.within(np.radians([10, -10, 170]), radians(350))
    assert np.allclose(np.degrees(values), [-350 + 720 - 360, 350, 170]) and inside.all()
    narrow = RotaryAxis("A", np.array([1.0, 0, 0]), np.zeros(3), None, radians(170), radians(200), radians(1))
    values, inside = narrow.within(np.radians([-175, 20]))
    assert np.degrees(values[0]) == pytest.approx(185) and inside.tolist() == [True, False]
    assert np.degrees(narrow.rounded(radians(180.4))) == pytest.approx(180)


def _askew() -> Machine:
    """The two solutions meet inside the range of B, away from its ends and from the axis of C."""
    plain, drive = load_machine("dmg-dmu-60t"), Drive(1.0, 1.0, 1.0)
    head = RotaryAxis("B", np.array([0.0, 1.0, 2.0]), np.zeros(3), drive, -1.0, 4.0)
    return Machine("askew", plain.linear, plain.table, (head,), (0.3, 0.0, 1.0))


@pytest.mark.parametrize("name", [*NAMES, "askew"])
def test_excess_is_the_angle_to_the_nearest_reached_axis(name: str) -> None:
    machine, rng = _askew() if name == "askew" else load_machine(name), np.random.default_rng(5)
    where = _offset(rng)
    axes = rng.normal(size=(200, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    ranges = [(axis.low, axis.high) if axis.high - axis.low < 2 * pi else (-pi, pi) for axis in machine.rotary]
    grid = [np.linspace(*span, 361) for span in ranges]
    pairs = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    reached = tool_axes(machine, pairs) @ np.asarray(where)[:3, :3]
    scanned = np.arccos(np.clip((axes @ reached.T).max(axis=1), -1, 1))
    excess = reach_excess(machine, axes, where)
    allowed = rotary_angles(machine, axes, table_from_part=where).within.any(axis=1)
    assert (excess[allowed] == 0).all() and (excess <= scanned + 1e-9).all()
    assert (scanned - excess).max() < np.radians(1.0)
    assert ((excess > 0) == ~allowed).all()


def test_travel() -> None:
    machine = load_machine("mikron-ucp-710")
    points = [(0, 0, 100), (400, 0, 100)]
    out = travel_excess(machine, points, (0, 0, 1))
    assert np.allclose(out, [(45, 0, 0), (45, 0, 0)])
    moved = np.array([-100.0, 0, 0])
    assert np.allclose(travel_excess(machine, points, (0, 0, 1), table_from_part=moved), 0)
    out = travel_excess(machine, [(0, 0, 0)], (0, -0.6, 0.8))  # A 36.87 degrees one way, beyond -30 the other
    assert np.isfinite(out).all(axis=1).sum() == 1


def test_turns_of_the_plain_kind() -> None:
    found = two_turns((0, 0, 1), (1, 0, 0), (0, 0, 1), (0, -1, 0))
    pairs = sorted((abs(round(first)), round(second)) for first, second in np.degrees(found.angles[0]))
    assert pairs == [(0, 90), (180, -90)]
    angles, reached, free = one_turn((0, 0, 1), (0, 0, 1), (0, 0, 1))
    assert angles[0] == 0 and reached[0] and free[0]


def test_what_a_machine_says_of_its_numbers_cites_no_key_of_a_paper() -> None:
    """It is read in windows and in plans, where a key of resources/references.bib says nothing."""
    text = (Path(__file__).parents[2] / "resources" / "references.bib").read_text(encoding="utf-8")
    keys = re.findall(r"^@\w+\{(\w+),", text, re.MULTILINE)
    assert len(keys) > 5
    for name in library():
        machine = load_machine(name)
        said = " ".join((machine.name, machine.source, *machine.assumed))
        assert machine.source and not [key for key in keys if key in said], said
