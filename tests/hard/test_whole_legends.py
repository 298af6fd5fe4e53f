"""Found: the legend below a wide part was cut off by the picture's edge: "shank (not given)" could not be read."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.report.figures.plots import operation_picture, widths_picture
from toolaxis.shape.part import Part

BARE = ta.Tool.torus(diameter=12, corner_radius=1)
HELD = ta.Tool.ball(diameter=8, stickout=40, holder=[(10, 0), (10, 40)])


@pytest.mark.parametrize("size, tool", [
    ((90, 30), BARE), ((30, 90), HELD), *(pytest.param(*case, marks=pytest.mark.long) for case in (
        ((30, 90), BARE), ((40, 40), BARE), ((90, 30), HELD), ((40, 40), HELD)))])
def test_no_legend_leaves_the_picture(size, tool):
    axis, along = np.array([0.0, 0.0, 1.0]), np.linspace(0, 1, 20)
    face = ta.Face.from_bspline([[[x, y, 0] for y in (0, size[1])] for x in (0, size[0])], degree=(1, 1))
    points = face.evaluate(np.column_stack([along, np.full(20, 0.5)])).point
    rows = np.tile(axis, (20, 1))
    path = ToolPath(points, points, rows, rows, np.full(20, Motion.CUT, dtype=np.int8), np.array([0, 20]))
    frame = work_coordinates(axis, np.array([[1.0, 0, 0]]), np.zeros(3), points[0])
    op = Operation(1, face, tool, Orientation(axis, "u", 1, 1.0, 40.0, 2.5, outcome="feasible"), path, frame)
    plan = Plan(Part.from_faces([face]), (tool,), PlanInputs(0.02), (op,), (), np.zeros(3), "complete")
    made = operation_picture(plan, op)
    made.canvas.draw()
    for ax in made.axes:
        box = ax.get_legend().get_window_extent()
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= made.bbox.width and box.y1 <= made.bbox.height


def test_no_picture_makes_matplotlib_grumble(caplog):
    face = ta.Face.from_bspline([[[x, y, 0] for y in (0, 30)] for x in (0, 90)], degree=(1, 1))
    lines = [(face.evaluate([[0.1, v], [0.5, v], [0.9, v]]).point, np.array([1.0, 2.0, 1.5])) for v in (0.2, 0.7)]
    widths_picture(lines, (face, ta.Tool.ball(diameter=8)), "op01").canvas.draw()
    assert not caplog.records
