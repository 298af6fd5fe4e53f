"""How near shanks come to walls: thin cutters a tenth of their diameter, and what a user asks for instead."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.output.verify import _task
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance

#: Half the width of a groove, mm.
HALF = 1.5
NECKED = replace(ta.Tool.ball(diameter=1.0, stickout=20.0, shank=[(0.47, 0.0), (0.47, 20.0)]), flute_length=1.5)


def flat(corner: list[float], one: list[float], other: list[float]) -> Face:
    """A plane face whose normal is one x other."""
    start, along, across = np.array(corner), np.array(one), np.array(other)
    return Face.from_bspline(np.array([[start, start + across], [start + along, start + along + across]]), (1, 1))


def groove() -> Part:
    """A floor between two upright walls."""
    floor = flat([0.0, -HALF, 0.0], [20.0, 0.0, 0.0], [0.0, 2 * HALF, 0.0])
    left = flat([0.0, -HALF, 0.0], [0.0, 0.0, 3.0], [20.0, 0.0, 0.0])
    right = flat([0.0, HALF, 0.0], [20.0, 0.0, 0.0], [0.0, 0.0, 3.0])
    return Part.from_faces([floor, left, right])


@pytest.mark.parametrize("tolerance, kept", [(Tolerance(), 0.1), (Tolerance().with_clearances("0.1,0.5,1"), 0.5)])
def test_a_neck_comes_near_a_wall_unless_it_is_told_not_to(tolerance: Tolerance, kept: float) -> None:
    part = groove()
    found = evaluate_axis(part.faces[0], NECKED, (0.0, 0.0, 1.0), 0.05, part=part, tolerance=tolerance)
    assert found.outcome == "feasible", found.reasons
    reached = HALF - max(0.5 + 0.1, 0.47 + kept)  # the cutter keeps 0.1 mm
    assert found.unreached == pytest.approx(1 - reached / HALF, abs=0.04)
    assert found.clearance["shank"] >= kept


def test_the_judge_asks_for_the_same() -> None:
    part = groove()
    for tolerance, kept in ((None, 0.1), (Tolerance().with_clearances((0.1, 0.4, 1.0)), 0.4)):
        plan = ta.plan(part, NECKED, 0.05, faces=[1], tolerance=tolerance, regions=1, workers=1)
        assert [_task(plan, op).tolerance.shank_clearance for op in plan.operations if op.done] == [kept]
        assert ta.verify(plan).passed
