"""One operation with another axis: judged as the search judges, and taken over by the plan."""

from math import radians

import numpy as np
import pytest

from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.job.output.verify import verify
from toolaxis.job.planning.edit_axis import rule_of_thumb, try_axis, with_operations
from toolaxis.job.planning.pipeline import plan
from toolaxis.plan.plan import Plan
from toolaxis.plan.sub_surface import SubSurface
from toolaxis.progress import Progress
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool


def test_the_plans_own_axis_comes_to_what_the_plan_says(small_plan: Plan) -> None:
    op = small_plan.operations[0]
    again = try_axis(small_plan, op, op.orientation.axis)
    assert again.orientation.passes == op.orientation.passes
    assert again.orientation.length == pytest.approx(op.orientation.length, rel=1e-9)
    assert np.allclose(again.path.cl, op.path.cl, atol=1e-9)
    assert np.allclose(again.frame.part_from_work, op.frame.part_from_work)
    assert again.orientation.map is op.orientation.map


def test_another_axis_costs_more_and_may_be_taken_over(small_plan: Plan) -> None:
    op = small_plan.operations[0]
    seen = op.orientation.map
    middling = seen.axis[np.argsort(seen.length)[(seen.reason == 0).sum() // 2]]
    tried = try_axis(small_plan, op, middling)
    assert tried.done and tried.orientation.length >= 1.02 * op.orientation.length
    assert np.allclose(tried.frame.z, tried.orientation.axis)
    plan = with_operations(small_plan, {1: tried})
    assert plan.operations[0].path is tried.path and plan.outcome == "complete"
    assert verify(plan).passed


def test_a_forbidden_axis_says_why_and_leaves_the_plan_incomplete(small_plan: Plan) -> None:
    op = small_plan.operations[0]
    tried = try_axis(small_plan, op, [0.0, 0.0, -1.0])
    assert not tried.done and tried.frame is None
    assert tried.orientation.outcome == "infeasible" and "face 1" in tried.orientation.reasons[0]
    assert with_operations(small_plan, {1: tried}).outcome == "incomplete"
    with pytest.raises(InvalidInput, match="operation 2"):
        with_operations(small_plan, {2: tried})


def test_an_axis_without_a_feed_takes_the_better_one() -> None:
    """Found: on part of a sphere the worse feed looked better by the screening, and made passes 25 % longer."""
    surface = SphericalSurface(40.0, (radians(-50), radians(50)), (radians(-75), radians(-30))).nurbs()
    part = Part.from_faces([Face(surface, flip=True)])
    axis = (-0.332682, -0.556849, 0.761079)
    length = {}
    for feed in ("", "u", "v"):
        given = SubSurface(1, axis=axis, feed=feed, locked=True)
        made = plan(part, Tool.torus(12, 2), 0.1, division=[given], workers=1)
        (op,) = made.operations
        length[feed] = op.orientation.length
    assert length["u"] < 0.9 * length["v"]
    assert length[""] == length["u"]


def test_stops_when_asked(small_plan: Plan) -> None:
    with pytest.raises(Cancelled):
        try_axis(small_plan, small_plan.operations[0], [0.1, 0.2, 1.0], progress=Progress(None, lambda: True))


def test_the_rule_of_thumb_is_an_axis(small_plan: Plan) -> None:
    assert np.linalg.norm(rule_of_thumb(small_plan, small_plan.operations[0])) == pytest.approx(1.0)
