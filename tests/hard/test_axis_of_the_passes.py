"""Found: where every axis missed some of a face, the plan named the best of them and held the passes of another one.

An axis whose passes leave something on which the cutter may stand is refused now, with the place.
"""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import ToolPath
from toolaxis.path.mending import FurtherPasses
from toolaxis.path.pass_layout import Layout
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.fixed_axis import find_axis

TOOL = ta.Tool.ball(diameter=8, stickout=40)


class Unmended(FaceProblem):
    """Passes as they are laid, without further ones over what they leave."""

    def completed(self, placed: Layout, path: ToolPath) -> FurtherPasses:
        """The passes as they come."""
        return FurtherPasses(placed, path, self.left_by(path))


def bound(kind: type[FaceProblem]) -> FaceProblem:
    """A task on a face beyond whose slanting border no pass may run out."""
    x, y = np.meshgrid(np.linspace(0, 8, 4), np.linspace(0, 10, 4), indexing="ij")
    slanted = (np.array([[0.05, 0.05], [0.95, 0.3], [0.3, 0.95]]),)
    face = ta.Face.from_bspline(np.stack([x, y, 0.02 * x * y], axis=-1), trims=slanted)
    made = task(face, TOOL, 0.05, limits=None)
    own = kind(replace(made.feasibility), made.worth, made.groups, made.chord)
    inside = own.feasibility.face.contains
    object.__setattr__(own.feasibility, "reach", lambda uv, axis: inside(uv))
    return own


def test_axes_are_refused_whose_passes_leave_what_the_cutter_may_stand_on() -> None:
    found, path = find_axis(bound(Unmended))
    assert found.outcome == "not_found" and found.axis is None and path is None
    assert sum("stay higher than the scallop limit" in why for why in found.reasons) > 1, "find another case"
    mended, passes = find_axis(bound(FaceProblem))
    assert mended.outcome == "feasible" and mended.unreached == 0
    np.testing.assert_allclose(passes.axis, np.broadcast_to(mended.axis, passes.axis.shape), atol=1e-12)


def test_the_judge_refuses_passes_at_another_axis_than_the_plan_names() -> None:
    plane = ta.Face.from_bspline([[[0, 0, 0], [0, 8, 0]], [[14, 0, 0], [14, 8, 0]]], degree=(1, 1))
    made: Plan = ta.plan([plane], TOOL, 0.2, faces=[1])
    assert ta.verify(made).passed
    (op,) = made.operations
    turned = replace(op.orientation, axis=np.array([np.sin(0.1), 0.0, np.cos(0.1)]))
    verdict = ta.verify(replace(made, operations=(replace(op, orientation=turned),)))
    assert not verdict.passed
    assert "the plan names the axis (0.0998" in verdict.operations[0].reasons[0]


@pytest.mark.parametrize("angle", [0.0, 1e-9])
def test_digits_of_a_file_are_no_other_axis(angle: float) -> None:
    plane = ta.Face.from_bspline([[[0, 0, 0], [0, 8, 0]], [[14, 0, 0], [14, 8, 0]]], degree=(1, 1))
    made = ta.plan([plane], TOOL, 0.2, faces=[1])
    (op,) = made.operations
    axis = np.asarray(op.orientation.axis) + angle
    verdict = ta.verify(replace(made, operations=(replace(op, orientation=replace(op.orientation, axis=axis)),)))
    assert verdict.passed
