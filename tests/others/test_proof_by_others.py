"""Other programs agree with plans, verdicts and programs within their own tolerances, and find planted faults."""

from collections.abc import Callable

import pytest
from benchmarks._others import Check, Unavailable
from benchmarks._others_angles import compare_angles
from benchmarks._others_control import TRUNNIONS, compare_control
from benchmarks._others_distances import compare_distances
from benchmarks._others_removal import TOOL, compare_removal


def _sound(check: Callable[[], Check], faults: int) -> Check:
    """A check that agrees and finds all of so many planted faults; skipped where its program is not there."""
    try:
        row = check()
    except Unavailable as reason:
        pytest.skip(str(reason))
    assert row.agrees, f"{row.difference}, allowed {row.allowed}: {row.notes}"
    assert len(row.found) == faults and all(row.found.values()), row.found
    return row


def test_mesh_libraries_measure_the_gouges_and_gaps_that_the_judge_states() -> None:
    row = _sound(lambda: compare_distances("dish", TOOL, count=40), 4)
    assert float(row.allowed.split()[0]) < 0.01


def test_linuxcnc_takes_the_program_back_to_the_poses_of_the_plan() -> None:
    _sound(lambda: compare_control(TRUNNIONS[:1], "dish", fetch=False), 3)


def test_planes_by_scipy_are_those_of_the_programs() -> None:
    _sound(lambda: compare_angles(40), 3)


@pytest.mark.long
def test_linuxcnc_takes_programs_for_both_kinds_of_table_back_to_the_poses_of_the_plan() -> None:
    _sound(compare_control, 3)


@pytest.mark.long
def test_what_cutrail_leaves_is_the_part_and_the_rest_that_the_judge_states() -> None:
    row = _sound(compare_removal, 4)
    assert float(row.allowed.split()[0]) < 0.01
