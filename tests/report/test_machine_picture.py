"""The picture of the machine: surfaces of its bodies, one panel for each orientation, things where they are."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.setup import Mounting
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.report.figures import machine
from toolaxis.report.figures.machine import body_splats, has_machine_picture, machine_picture, orientations_of
from toolaxis.shape.part import Part

TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
X, Y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 30, 4), indexing="ij")
FACE = ta.Face.from_bspline(np.stack([X, Y, 0 * X], axis=-1))


def plan(*tilts: float) -> Plan:
    operations = []
    mounting = Mounting(ta.load_machine("bc-table-table"), (-20.0, -15.0, 40.0))
    for number, tilt in enumerate(tilts, 1):
        axis = mounting.axis_at([0.0, tilt])
        tips = np.array([[5.0, 5, 1], [35, 25, 1]]) + np.zeros((2, 3))
        path = ToolPath(tips, tips, np.tile(axis, (2, 1)), np.tile(axis, (2, 1)),
                        np.full(2, Motion.CUT, dtype=np.int8), np.array([0, 2]))
        operations.append(Operation(number, FACE, TOOL, Orientation(axis, "u", 1, outcome="feasible"), path,
                                    work_coordinates(axis, np.array([1.0, 0, 0]), np.zeros(3), np.zeros(3)),
                                    rotary=(0.0, tilt)))
    return Plan(Part((FACE,)), (TOOL,), PlanInputs(0.1), tuple(operations), (), np.zeros(3), "complete",
                machine=mounting)


@pytest.mark.parametrize("body", [
    MachineBody("a", "bed", "box", np.array([[-3.0, -2, -1], [4, 5, 6]])),
    MachineBody("b", "bed", "cylinder", np.array([[1.0, 2, 3], [4, -2, 9]]), 2.5),
    MachineBody("c", "bed", "points", np.random.default_rng(3).normal(size=(12, 3)) * 4)])
def test_splats_lie_on_the_surface_and_leave_no_gap(body: MachineBody) -> None:
    pieces = list(body_splats(body, 0.2))
    points, normals = (np.concatenate(some) for some in zip(*pieces, strict=True))
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    far = np.einsum("nc,nc->n", body.convex.support(normals), normals) - np.einsum("nc,nc->n", points, normals)
    assert np.abs(far).max() < 1e-6, "each point is the farthest of the body along its own normal"
    ways = np.random.default_rng(5).normal(size=(80, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    gap = (body.convex.support(ways) * ways).sum(axis=1) - (points @ ways.T).max(axis=0)
    assert gap.min() > -1e-9 and gap.max() < 0.3


def test_one_panel_for_each_orientation_and_its_angles() -> None:
    made = plan(0.2, -0.4, 0.2)
    assert [[op.number for op in group] for group in orientations_of(made)] == [[1, 3], [2]]
    figure = machine_picture(made)
    titles = [ax.get_title() for ax in figure.axes if ax.get_title()]
    assert titles == ["op01-face1, op03-face1\nC 0.00°  B 11.46°", "op02-face1\nC 0.00°  B -22.92°"]
    assert figure.get_suptitle() == "BC table-table (bodies assumed)"
    for ax in figure.axes[:2]:
        picture = ax.images[0].get_array()
        green = (picture[..., 1] > picture[..., 0] + 0.03) & (picture[..., 1] > picture[..., 2] + 0.03)
        yellow = (picture[..., 0] > picture[..., 2] + 0.25) & (picture[..., 1] > picture[..., 2] + 0.2)
        assert green.mean() > 0.05 and yellow.sum() > 20, "table and cutter are there"
        rows = np.arange(len(picture))[:, None]
        assert (rows * yellow).sum() / yellow.sum() > (rows * green).sum() / green.sum(), "the cutter stands above"


def test_where_there_is_nothing_to_draw() -> None:
    made = plan(0.2)
    assert has_machine_picture(made)
    bare, tool = replace(made.machine.machine, bodies=()), ta.Tool.torus(diameter=12, corner_radius=2)
    for other in (replace(made, machine=None), replace(made, machine=replace(made.machine, machine=bare)),
                  replace(made, machine=Mounting(made.machine.machine)),
                  replace(made, tools=(tool,), operations=tuple(replace(op, tool=tool) for op in made.operations)),
                  replace(made, operations=())):
        assert not has_machine_picture(other)


def test_only_the_first_ones_are_drawn_and_the_title_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "_MOST", 2)
    figure = machine_picture(plan(0.1, 0.2, 0.3))
    assert len([ax for ax in figure.axes if ax.images]) == 2
    assert "the first 2 of 3 orientations" in figure.get_suptitle()
