"""Sub-surfaces that share axes: where the proof refuses one, another shared one is taken before one is searched."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.job.planning.planner import REFUSED, PlanningJob
from toolaxis.job.planning.sub_surfaces import Target
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS

DOWN, LEANING = np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.6, 0.8])


@pytest.fixture(scope="module")
def job(small_plan: Plan) -> PlanningJob:
    return PlanningJob(small_plan.part, small_plan.tools[0], small_plan.inputs, None, (), np.zeros(3))


def test_the_cheapest_of_the_other_shared_axes_serves(job: PlanningJob, small_plan: Plan) -> None:
    (op,) = small_plan.operations
    good = op.orientation.axis
    made = job._operation(Target(op.face, DOWN, True, (LEANING, good)), (0, 1), NO_PROGRESS)
    assert made.done and np.allclose(made.orientation.axis, good)
    assert made.orientation.passes == op.orientation.passes and made.orientation.evaluations <= 4
    assert any(why.startswith(REFUSED) and "another shared axis" in why for why in made.orientation.reasons)


def test_its_own_shared_axis_comes_first_and_a_search_last(job: PlanningJob, small_plan: Plan) -> None:
    (op,) = small_plan.operations
    own = job._operation(Target(op.face, LEANING, True, (op.orientation.axis,)), (0, 1), NO_PROGRESS)
    assert np.allclose(own.orientation.axis, LEANING) and own.orientation.length > op.orientation.length
    other = replace(job, inputs=replace(job.inputs, method="normal"))
    searched = other._operation(Target(op.face, DOWN, True, (-LEANING,)), (0, 1), NO_PROGRESS)
    assert not any("another shared axis" in why for why in searched.orientation.reasons)
    assert any(why.startswith(REFUSED) for why in searched.orientation.reasons)
