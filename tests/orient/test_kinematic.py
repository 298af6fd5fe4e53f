"""Set-ups by kinematics: the paper's numbers, domains and ranges, and brute force."""

from math import radians

import numpy as np
import pytest

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.machine.feed_polytopes import Level, along
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.search.kinematic_setup import (
    Domain,
    PassSegment,
    common_feed,
    find_setup,
    find_setups_by_pass,
    mean_feed,
    pass_segments,
    rotary_grid,
)

MIKRON = Mounting(load_machine("mikron-ucp-710"))


def _rules(offsets: np.ndarray) -> tuple[PassSegment, ...]:
    """Rules y = x + c of the paraboloid z = (y^2 - x^2)/500, there and back."""
    found = []
    for k, c in enumerate(offsets):
        x = np.array([max(-50, -50 - c), min(50, 50 - c)])[:: 1 if k % 2 == 0 else -1]
        y = x + c
        normals = np.stack([2 * x / 500, -2 * y / 500, np.ones(2)], axis=1)
        found.append(PassSegment(np.stack([x, y, (y * y - x * x) / 500], axis=1),
                                 normals / np.linalg.norm(normals, axis=1, keepdims=True)))
    return tuple(found)


def _straight(direction: tuple[float, float, float], normal: tuple[float, float, float]) -> tuple[PassSegment, ...]:
    tips = np.linspace(0, 80, 5)[:, None] * np.array(direction) / np.linalg.norm(direction)
    return (PassSegment(tips, np.tile(np.array(normal) / np.linalg.norm(normal), (5, 1))),)


def test_the_papers_paraboloid() -> None:
    """Per pass A from 64.5 to 25.5 for the jerk cube, 54.2 to 15.8 for the acceleration polytope that Fig. 15 shows."""
    passes = _rules(np.linspace(-99.5, 99.5, 41))
    for level, tilt, turn in ((Level.JERK, (25.5, 64.5), (8.1, 9.7)), (Level.ACCELERATION, (15.8, 54.2), (9.1, 10.7))):
        found = find_setups_by_pass(MIKRON, passes, level=level)
        assert all(one.outcome == "aligned" for one in found)
        angles = np.abs(np.degrees([one.rotary for one in found]))
        assert angles[:, 1].min() == pytest.approx(tilt[0], abs=0.15)
        assert angles[:, 1].max() == pytest.approx(tilt[1], abs=0.15)
        assert angles[:, 0].min() == pytest.approx(turn[0], abs=0.15)
        assert angles[:, 0].max() == pytest.approx(turn[1], abs=0.15)
        assert np.abs(np.diff(angles, axis=0)).max() < 2.0  # one family from pass to pass
    whole = find_setup(MIKRON, passes)
    assert whole.reach == pytest.approx(5000 * np.sqrt(3))
    assert abs(np.degrees(whole.rotary[1])) == pytest.approx(45, abs=0.3)


def test_the_papers_manta() -> None:
    """Feed along y: A = -45 is out of range, so its mirror image is taken."""
    found = find_setup(MIKRON, _straight((0, 1, 0), (0, 0, 1)))
    c, a = np.degrees(found.rotary)
    assert (abs(a), abs(c)) == pytest.approx((45, 35.2644), abs=1e-3) and a > -30


def test_there_and_back_count_as_one() -> None:
    passes = _rules(np.linspace(-60, 60, 7))
    feed = common_feed(passes)
    assert feed @ (1, 1, 0) / np.sqrt(2) > 0.999 and mean_feed(passes[1].tips) @ feed < 0
    ways = np.array([(one.tips[-1] - one.tips[0]) * (-1) ** k for k, one in enumerate(passes)])
    assert np.allclose(feed, ways.sum(axis=0) / np.linalg.norm(ways.sum(axis=0)), atol=1e-12)


@pytest.mark.parametrize("level", list(Level))
def test_a_domain_is_kept_and_nothing_inside_it_is_better(level: Level) -> None:
    passes = _straight((1, 0.3, 0.1), (0.1, 0, 1))
    domain = Domain((radians(2), radians(12)), (radians(-8), radians(8)))
    found = find_setup(MIKRON, passes, domain, level)
    assert found.outcome == "allowed"
    axis = MIKRON.axis_at(found.rotary)
    assert domain.holds(axis[None], passes)[0]
    grid = rotary_grid(MIKRON, np.radians(1.0))
    axes = np.array([MIKRON.axis_at(row) for row in grid[::7]])
    inside = domain.holds(axes, passes)
    values = along(MIKRON.machine, level, np.tile(found.feed, (len(axes), 1)), grid[::7])
    assert inside.any() and values[inside].max() <= found.reach * (1 + 2e-3)


def test_ranges_are_kept() -> None:
    narrow = Mounting(load_machine("ab-trunnion"))
    found = find_setup(narrow, _straight((0, 1, 0.2), (0, 0, 1)))
    assert found.outcome in ("aligned", "allowed")
    for value, axis in zip(found.rotary, narrow.machine.rotary, strict=True):
        assert axis.low - 1e-9 <= value <= axis.high + 1e-9


def test_no_axis_sees_both_sides() -> None:
    up, down = _straight((1, 0, 0), (0, 0, 1)), _straight((1, 0, 0), (0, 0, -1))
    found = find_setup(MIKRON, (*up, *down))
    assert found.outcome == "infeasible" and found.rotary.size == 0 and found.reach == 0


def test_a_pole_leaves_the_first_axis_free() -> None:
    found = find_setup(MIKRON, _straight((0, 0, 1), (1, 0, 0)))
    assert found.outcome == "aligned" and found.reach == pytest.approx(5000 * np.sqrt(2))
    assert MIKRON.axis_at(found.rotary) @ (1, 0, 0) > 0


def test_moving_the_part_with_its_table_changes_nothing() -> None:
    turn = np.eye(4)
    turn[:2, :2] = [[0.8, -0.6], [0.6, 0.8]]
    passes = _rules(np.linspace(-40, 40, 5))
    moved = tuple(PassSegment(one.tips @ turn[:3, :3], one.normals @ turn[:3, :3]) for one in passes)
    here, there = find_setup(MIKRON, passes), find_setup(Mounting(MIKRON.machine, turn), moved)
    assert np.allclose(here.rotary, there.rotary, atol=1e-9) and here.reach == pytest.approx(there.reach)


def test_a_machine_without_a_closed_form_is_searched() -> None:
    head = Mounting(load_machine("dmg-dmu-60t"))
    found = find_setup(head, _straight((1, 0.2, 0.3), (0, 0, 1)))
    assert found.outcome == "allowed"
    rows = np.random.default_rng(1).uniform(-1, 1, (4000, 2)) * (np.pi, 1.0)
    others = along(head.machine, Level.JERK, np.tile(found.feed, (len(rows), 1)), rows)
    assert others.max() <= found.reach * (1 + 1e-3)


def test_passes_of_a_tool_path() -> None:
    tips = np.array([[0.0, 0, 9], [0, 0, 0], [30, 0, 0], [60, 0, 1], [60, 0, 9], [60, 5, 0], [0, 5, 0]])
    up = np.tile((0.0, 0, 1), (7, 1))
    path = ToolPath(tips, tips, up, up, np.array([3, 1, 0, 0, 2, 3, 0], dtype=np.int8), np.array([0, 5, 7]))
    found = pass_segments(path)
    assert [len(one.tips) for one in found] == [3, 2] and found[1].length == 60
    nothing = ToolPath(tips, tips, up, up, np.full(7, 3, dtype=np.int8), np.array([0, 7]))
    with pytest.raises(InvalidInput, match="cuts nothing"):
        pass_segments(nothing)


@pytest.mark.parametrize("ranges", [{"lead": (0.3, 0.1)}, {"tilt": (-2.0, 0.1)}])
def test_bad_domains(ranges: dict[str, tuple[float, float]]) -> None:
    with pytest.raises(InvalidInput, match="inside -pi/2 to pi/2"):
        Domain(**ranges)
