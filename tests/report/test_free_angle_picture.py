"""The picture of the axis that turns while the other one is clamped."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.strategies.four_plus_one.passes import Clamp
from toolaxis.strategies.four_plus_one.pictures import free_angle_picture, turning_of
from toolaxis.tools.tool import Tool

MIKRON = load_machine("mikron-ucp-710")


def _plan(clamp: Clamp) -> Plan:
    """Two passes there and back over a plane, the free axis turning by 20 deg; the other solution is out of range."""
    x, y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 20, 4), indexing="ij")
    face = Face.from_bspline(np.stack([x, y, 0 * x], axis=2))
    way = np.linspace(0, 40, 41)
    tips = np.concatenate([np.column_stack([w, np.full(41, 10.0 * k), np.zeros(41)]) for k, w in
                           enumerate((way, way[::-1]))])
    axes = clamp.axes(np.radians(20.0 + tips[:, 0] / 2))
    kind = np.full(82, Motion.CUT, dtype=np.int8)
    kind[[0, 41]] = Motion.LINK
    path = ToolPath(tips, tips, axes, axes, kind, np.array([0, 41, 82]))
    tool = Tool.torus(12, 1)
    op = Operation(1, face, tool, Orientation(np.array([0.0, 0.0, 1.0]), outcome="feasible", lead=0.3), path, None)
    inputs = PlanInputs(0.02, method="four-plus-one")
    return Plan(Part((face,)), (tool,), inputs, (op,), (), np.zeros(3), "complete", machine=Mounting(MIKRON))


@pytest.mark.parametrize(("which", "angle"), [(0, 30.0), (1, 25.0)])
def test_the_clamped_axis_is_told_from_the_free_one(which: int, angle: float) -> None:
    plan = _plan(Clamp(MIKRON, which, np.radians(angle)))
    found = turning_of(plan, plan.operations[0])
    names = [axis.name for axis in MIKRON.rotary]
    assert found is not None and (found.clamped, found.free) == (names[which], names[1 - which])
    assert found.angle == pytest.approx(angle, abs=1e-6) and len(found.passes) == 2
    contact, turned = found.passes[0]
    assert np.allclose(turned, 20.0 + contact[:, 0] / 2, atol=1e-6)


def test_the_picture_shows_each_pass_and_its_rate() -> None:
    plan = _plan(Clamp(MIKRON, 0, 0.5))
    found = turning_of(plan, plan.operations[0])
    assert found is not None
    made = free_angle_picture(found, plan.operations[0])
    angle, rate = made.axes[1], made.axes[2]
    assert len(angle.lines) == len(rate.lines) == 2
    for line in rate.lines:
        assert np.allclose(line.get_ydata(), 0.5, atol=1e-6)
    for line in angle.lines:  # the pass back is turned round
        assert line.get_ydata()[0] < line.get_ydata()[-1]


def test_where_both_axes_move_or_there_is_no_machine_there_is_no_picture() -> None:
    plan = _plan(Clamp(MIKRON, 1, 0.4))
    assert turning_of(replace(plan, machine=None), plan.operations[0]) is None
    op = plan.operations[0]
    assert op.path is not None
    rows = op.path.axis + np.column_stack([0.005 * op.path.cl[:, 0], 0 * op.path.cl[:, 1:]])
    bent = replace(op.path, axis=rows / np.linalg.norm(rows, axis=1, keepdims=True))
    assert turning_of(plan, replace(op, path=bent)) is None
