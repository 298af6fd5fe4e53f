"""Found: where every axis missed some of a face, the plan named the best of them and held the passes of another one."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.orient.indexed import OVERLOOKED, Task, searched, task
from toolaxis.path.layout import Layout
from toolaxis.path.mending import Made
from toolaxis.plan.plan import Plan

TOOL = ta.Tool.ball(diameter=8, stickout=40)


class Unmended(Task):
    """Passes as they are laid, without further ones over what they leave."""

    def completed(self, placed: Layout) -> Made:
        """The passes as they come."""
        path = self.traced(placed)
        return Made(placed, path, self.left_by(path))


def test_the_passes_of_a_search_are_those_of_its_axis() -> None:
    x, y = np.meshgrid(np.linspace(0, 8, 4), np.linspace(0, 10, 4), indexing="ij")
    slanted = (np.array([[0.05, 0.05], [0.95, 0.3], [0.3, 0.95]]),)
    face = ta.Face.from_bspline(np.stack([x, y, 0.02 * x * y], axis=-1), trims=slanted)
    made = task(face, TOOL, 0.05, limits=None)
    bound = Unmended(replace(made.feasibility), made.worth, made.groups)
    inside = bound.feasibility.face.contains
    object.__setattr__(bound.feasibility, "reach", lambda uv, axis: inside(uv))  # no pass may run out beyond the border
    found, path = searched(bound)
    assert sum("misses" in why for why in found.reasons) > 1, "one axis was enough: find another case"
    assert found.unreached > OVERLOOKED
    np.testing.assert_allclose(path.axis, np.broadcast_to(found.axis, path.axis.shape), atol=1e-12)


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
