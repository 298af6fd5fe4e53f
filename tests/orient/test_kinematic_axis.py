"""The axis of most jerk along the passes: the paper's cases, brute force, what binds it, and what it needs."""

import json
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feasibility.violations import CUTTER, FREE, Violation
from toolaxis.machine.feed_polytopes import Level
from toolaxis.machine.library import load_machine
from toolaxis.machine.limits import AllOf, Cone
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import best_axis, find_axis
from toolaxis.search.kinematic_axis import by_jerk, next_by_jerk
from toolaxis.search.kinematic_setup import common_feed, pass_segments, reach_along_feed, rotary_grid
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

MIKRON = Mounting(load_machine("mikron-ucp-710"))
#: What three linear axes with 5 m/s3 each do together, mm/s3.
CORNER = 5000 * np.sqrt(3)
BALL, TORUS, H = Tool.ball(10), Tool.torus(diameter=12, corner_radius=2), 0.1
EXAMPLES = Path(__file__).parents[2] / "examples"


def _example(name: str, degree: tuple[int, int]) -> Face:
    return Face.from_bspline(np.array(json.loads((EXAMPLES / f"{name}.json").read_text())["points"]), degree=degree)


def _wave(turn: np.ndarray | None = None) -> Face:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 45, 5), indexing="ij")
    points = np.stack([x, y, 4 * np.sin(x / 20) + 3 * np.cos(y / 15)], axis=-1)
    return Face.from_bspline(points if turn is None else points @ turn)


def _jerk(axis: np.ndarray, path) -> float:
    """Along the very passes, mm/s3."""
    feed = common_feed(pass_segments(path))
    return float(reach_along_feed(MIKRON, Level.JERK, feed, MIKRON.solutions(axis)[:1])[0])


@pytest.mark.parametrize(("name", "feed", "tilt", "turn", "within"), [
    ("hyperbolic_paraboloid_rules", "u", 45.0, 9.7356, 0.05), ("manta", "v", 45.0, 35.2644, 1.0)])
def test_the_papers_parts(name: str, feed: str, tilt: float, turn: float, within: float) -> None:
    """Whole parts: A = 45 and C = 9.74 for the rules, A = -45, here 45 as -45 is out of range, and C = 35.26 along y.

    The middle of a small ball moves nearly as its contact does; the Manta's passes end 10 degrees off y.
    """
    face = _example(name, (1, 1) if feed == "u" else (3, 3))
    job = task(face, Tool.ball(0.2), 0.05, MIKRON)
    found = by_jerk(AxisTable(job.feasibility, replace(job.worth, feed=feed)))
    assert len(found) == 1
    c, a = np.degrees(MIKRON.solutions(found[0].axis)[0])
    assert (abs(a), abs(c)) == pytest.approx((tilt, turn), abs=within)


@pytest.mark.parametrize("tool", [BALL, TORUS])
def test_passes_are_aligned_with_a_corner(tool: Tool) -> None:
    found, path = find_axis(task(_wave(), tool, H, MIKRON), "jerk")
    assert found.outcome == "feasible" and path is not None
    assert _jerk(found.axis, path) == pytest.approx(CORNER, rel=0.005)  # a few lines stand for all passes
    assert found.reasons[0].startswith("jerk along the passes: 8.6") and "of the 8.66 m/s3" in found.reasons[0]
    assert found.axis == pytest.approx(best_axis(_wave(), tool, H, MIKRON, method="jerk").axis, abs=1e-12)


@pytest.mark.parametrize("tool", [BALL, TORUS])
def test_of_equal_axes_the_cheapest_is_taken_and_then_the_least_turned(tool: Tool) -> None:
    """All axes of a ball cost the same; of a torus they differ."""
    job = task(_wave(), tool, H, MIKRON)
    ledger = AxisTable(job.feasibility, replace(job.worth, feed="u"))
    chosen, = by_jerk(ledger)
    path = job.made(chosen.axis, "u")
    most = _jerk(chosen.axis, path)
    equal = [axis for axis in ledger.axes[ledger.reason == FREE] if _jerk(axis, path) > 0.998 * most]
    counts = [job.worth.counted(axis, "u")[1] for axis in equal]
    turns = [np.abs(MIKRON.solutions(axis)[0]).sum() for axis in equal]
    own = np.abs(MIKRON.solutions(chosen.axis)[0]).sum()
    assert len(equal) > 1 and chosen.length <= 1.002 * min(counts)
    if tool is BALL:
        assert own <= min(turns) + radians(0.2)
    else:
        assert max(counts) > 1.05 * min(counts)


@pytest.mark.parametrize("cone", [
    pytest.param(Cone((0.0, 0.0, 1.0), radians(20)), marks=pytest.mark.long), Cone((0.5, 0.2, 1.0), radians(1.2))])
def test_no_free_axis_does_more_where_limits_keep_corners_away(cone: Cone) -> None:
    """A cone of 1.2 degrees lies between the nodes of the first grid of rotary angles."""
    job = task(_wave(), BALL, H, AllOf((MIKRON, cone)))
    ledger = AxisTable(job.feasibility, replace(job.worth, feed="v"))
    found = find_axis(replace(job, worth=ledger.worth), "jerk")[0]
    assert found.axis is not None and cone.allowed(found.axis[None])[0]
    chosen, = by_jerk(ledger)
    near = MIKRON.solutions(chosen.axis)[0]
    rows = np.concatenate([rotary_grid(MIKRON, radians(1.0)), rotary_grid(MIKRON, radians(0.1), near)])
    axes = np.array([MIKRON.axis_at(row) for row in rows])
    allowed = rows[cone.allowed(axes)]
    path = job.made(chosen.axis, "v")
    feed = common_feed(pass_segments(path))
    most = reach_along_feed(MIKRON, Level.JERK, feed, allowed).max()
    assert _jerk(chosen.axis, path) == pytest.approx(most, rel=2e-3) and most < 0.99 * CORNER


def test_another_set_up_takes_the_place_of_a_refused_one() -> None:
    job = task(_wave(), BALL, H, MIKRON)
    ledger = AxisTable(job.feasibility, job.worth)
    first = by_jerk(ledger)[0]
    second = next_by_jerk(ledger, first, Violation(CUTTER, 1.0))
    assert second is not None and second.feed == first.feed
    assert float(angle_between(first.axis, second.axis)) > radians(0.15)
    assert _jerk(second.axis, job.made(second.axis, "uv"[second.feed])) == pytest.approx(CORNER, rel=0.005)


def test_limits_that_leave_no_axis_are_told_as_infeasible() -> None:
    found = best_axis(_wave(), BALL, H, AllOf((MIKRON, Cone((0.0, 0.0, -1.0), radians(10)))), method="jerk")
    assert found.axis is None and found.outcome == "infeasible"
    assert found.reasons[0].startswith("infeasible: limits and normals leave no axis")


def test_a_machine_of_another_kind_is_searched() -> None:
    """With two rotary axes in the head the part stands still: all axes have the same jerk, the least turn decides."""
    head = Mounting(load_machine("head-head-portal"))
    found = best_axis(_wave(), BALL, H, head, method="jerk")
    assert found.outcome == "feasible" and "do together at" in found.reasons[0]


def test_a_ring_has_no_mean_feed_along_one_parameter() -> None:
    """Passes around a dome end where they began: those towards its top are aligned."""
    angle = np.linspace(0, 2 * np.pi, 25)
    radius, height = np.linspace(20, 8, 5), np.linspace(0, 3, 5)
    points = np.stack([np.outer(np.cos(angle), radius), np.outer(np.sin(angle), radius),
                       np.tile(height, (len(angle), 1))], axis=-1)
    ring = Face.from_bspline(points, degree=(3, 3))
    job = task(ring, BALL, H, MIKRON)
    assert {one.feed for one in by_jerk(AxisTable(job.feasibility, job.worth))} == {1}
    locked = AxisTable(job.feasibility, replace(job.worth, feed="u"))
    with pytest.raises(InvalidInput, match="end where they began and have no mean feed direction: choose another"):
        by_jerk(locked)


def test_what_is_missing_is_told_with_the_remedy() -> None:
    with pytest.raises(InvalidInput, match=r"method 'jerk' needs a machine.*: name a machine"):
        best_axis(_wave(), BALL, H, method="jerk")
    linear = MIKRON.machine.linear
    slow = replace(linear[1], drive=replace(linear[1].drive, jerk=None))
    unstated = replace(MIKRON.machine, linear=(linear[0], slow, linear[2]))
    with pytest.raises(InvalidInput, match="does not state those of axis Y: complete its file"):
        best_axis(_wave(), BALL, H, unstated, method="jerk")
    fixed = replace(MIKRON.machine, table=(), bodies=())
    with pytest.raises(InvalidInput, match="needs a rotary axis and Mikron UCP 710 has none"):
        best_axis(_wave(), BALL, H, fixed, method="jerk")


def test_moving_part_and_machine_together_changes_nothing() -> None:
    turn = np.eye(4)
    turn[:2, :2] = [[0.8, -0.6], [0.6, 0.8]]
    here = best_axis(_wave(), BALL, H, MIKRON, method="jerk")
    there = best_axis(_wave(turn[:3, :3]), BALL, H, Mounting(MIKRON.machine, turn), method="jerk")
    assert unit(turn[:3, :3] @ there.axis) == pytest.approx(here.axis, abs=1e-6) and there.passes == here.passes
