"""Axes that move while they cut: the command's plan through the document, what stands in the tree, what is refused."""

import json
from pathlib import Path
from types import SimpleNamespace

import FreeCAD
import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.cam.jobs import make_jobs
from freecad.toolaxis.document.axis_lines import MOST, is_lines
from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.gui.plan.outcome import touched_once
from freecad.toolaxis.services import api
from freecad.toolaxis.services.export import plan_task

from toolaxis.errors import InvalidInput, ToolAxisError
from toolaxis.post.read_apt import read_apt
from toolaxis.progress import NO_PROGRESS

ROOT = Path(__file__).resolve().parents[2]
TURNED = Placement(Vector(30, -10, 5), Rotation(Vector(1, 2, 3), 40))


@pytest.fixture(scope="module")
def theirs(prepared):
    """The command's plan of one operation, and the path that it wrote."""
    document = json.loads((prepared / "out" / "plan.json").read_text())
    op, = document["operations"]
    path = read_apt((prepared / "out" / op["cl_file"]).read_text()).path
    return SimpleNamespace(inputs=document["inputs"], tool=document["tools"][0]["name"], face=op["face"],
                           found=op["orientation"], path=path)


@pytest.fixture(scope="module")
def planned(prepared, theirs):
    """The same through a document, with the part as an object of it."""
    document = FreeCAD.newDocument("Moving")
    thing = document.addObject("Part::Feature", "Imported")
    thing.Shape = Part.read(str(prepared / "part.step"))
    document.recompute()
    made, = api.plan(document, (thing, theirs.face), theirs.tool, theirs.inputs["scallop"],
                        strategy=theirs.inputs["method"], shank=None, holder=None, limits="machine:bc-table-table",
                        feedrate=theirs.inputs["feedrate"])
    yield made
    FreeCAD.closeDocument(document.Name)


def lines_of(operation):
    return next(filter(is_lines, operation.Group))


def test_the_command_comes_to_the_same(theirs, planned):
    """Passes, lengths, and tip and axis of every point, read back from the tree as they are exported."""
    plan = plan_task([planned])(NO_PROGRESS)
    path = plan.operations[0].path
    assert planned.Strategy == plan.inputs.method == "sturz" and planned.AxisMoves
    assert planned.Passes == theirs.found["passes"] and list(planned.Reasons) == theirs.found["reasons"]
    assert planned.CuttingLength.Value == pytest.approx(theirs.found["length"], rel=1e-6)
    assert np.radians(planned.MeanLean.Value) == pytest.approx(theirs.found["lead"], abs=1e-9)
    assert (path.kind == theirs.path.kind).all() and (path.breaks == theirs.path.breaks).all()
    on = path.kind != 3  # the height of links hangs on the box around the part, which each kernel gives loosely
    assert np.abs(path.cl - theirs.path.cl)[on].max() < 1e-5 and np.abs(path.axis - theirs.path.axis).max() < 1e-6
    assert np.ptp(path.axis, axis=0).max() > 0.01
    assert [text[:2] for text in planned.RotaryAngles] == ["C:", "B:"]


def test_lines_and_tool_stand_along_the_axis_of_each_point(planned):
    path, lines = OperationRecord.of(planned).path, lines_of(planned)
    cut, edges = path.kind == 0, lines.Shape.Edges
    assert 0 < len(edges) <= MOST and len(edges) == len(path.cl[cut][::lines.Every])
    ends = np.array([[vertex.Point for vertex in edge.Vertexes] for edge in edges])
    assert np.abs(ends[:, 0] - path.cl[cut][::lines.Every]).max() < 1e-6
    assert np.abs((ends[:, 1] - ends[:, 0]) / lines.LineLength.Value - path.axis[cut][::lines.Every]).max() < 1e-6
    tool = child(planned, "Part::FeaturePython")
    tool.Position = 1.0
    spindle = tool.Placement.Rotation.multVec(Vector(0, 0, 1))
    assert np.abs(np.array(spindle) - path.axis[np.flatnonzero(path.kind != 3)[-1]]).max() < 1e-6
    tool.Position = 0.0


def test_the_axes_are_saved_and_turn_with_the_part(planned, tmp_path):
    before = OperationRecord.of(planned).path
    planned.Document.saveCopy(str(tmp_path / "Moving.FCStd"))
    document = FreeCAD.openDocument(str(tmp_path / "Moving.FCStd"))
    again = document.getObject(planned.Name)
    document.recompute()
    path = OperationRecord.of(again).path
    assert not again.Stale and again.Strategy == "sturz"
    assert np.abs(path.axis - before.axis).max() < 1e-12 and np.abs(path.cc - before.cc).max() < 1e-12
    first = Vector(*lines_of(again).Shape.Edges[0].Vertexes[0].Point)
    again.Faces[0][0].Placement = TURNED
    document.recompute()
    turned = np.array([TURNED.Rotation.multVec(Vector(*axis)) for axis in path.axis.tolist()])
    assert np.abs(OperationRecord.of(again).path.axis - turned).max() < 1e-9
    assert lines_of(again).Shape.Edges[0].Vertexes[0].Point.distanceToPoint(TURNED.multVec(first)) < 1e-6
    passes = child(again, "Path::Feature")
    passes.Path = type(passes.Path)(passes.Path.Commands[:-1])
    with pytest.raises(InvalidInput, match="its commands were changed since"):
        OperationRecord.of(again)
    names = {one.Name for one in again.Group}
    document.removeObject(again.Name)
    assert not any(document.getObject(name) for name in names), "the lines go with their operation"
    FreeCAD.closeDocument(document.Name)


def test_jobs_with_fixed_planes_are_refused(planned):
    names = {one.Name for one in planned.Document.Objects}
    with pytest.raises(InvalidInput, match="moves while it cuts"):
        make_jobs(planned.Document, [planned])
    assert {one.Name for one in planned.Document.Objects} == names


@pytest.mark.parametrize(("given", "words"), [
    ({"strategy": "four-plus-one"}, "choose a machine among the limits"),
    ({"strategy": "four-plus-one", "limits": "machine:four-axis-a"}, "needs two driven rotary axes"),
    ({"strategy": "two-point", "tool": "ball:6"}, "no flat bottom"),
    ({"strategy": "blade"}, "no ball end"),
    ({"strategy": "multiscale", "tool": "ball:6"}, "smaller corner radius"),
    ({"strategy": "multiscale", "roughness": 0.0}, "above zero"),
    ({"strategy": "sturz", "roughness": 1.0}, "applies to strategy 'multiscale' only"),
    ({"strategy": "sturz", "orientations": 2}, "leave out the number of orientations"),
    ({"strategy": "sturz", "method": "roman"}, "leave out one of the two"),
    ({"strategy": "sturz", "passes": "planes"}, "leave out one of the two"),
    ({"passes": "spiral"}, "passes 'spiral' is unknown: use iso, planes, scallop or auto"),
    ({"method": "jerk"}, "choose a machine among the limits"),
    ({"strategy": "best"}, "use indexed, sturz")])
def test_what_does_not_go_with_a_strategy_is_told_and_nothing_is_made(document, parts, given, words):
    block = parts.block(document)
    given = {"tool": parts.TOOL, **given}
    names = [one.Name for one in document.Objects]
    with pytest.raises(ToolAxisError, match=words):
        api.plan(document, (block, parts.sculptured_name(block)), scallop=parts.SCALLOP, shank=None, holder=None,
                    **given)
    assert [one.Name for one in document.Objects] == names


def split_blade(document):
    """The blade of the examples with its closed face in two halves, and the name of one of these."""
    shape = Part.read(str(ROOT / "examples" / "blade.step"))
    closed = next(face for face in shape.Faces if type(face.Surface).__name__ == "BSplineSurface")
    others, halves = [face for face in shape.Faces if not face.isSame(closed)], []
    for low, high in ((0.0, 0.5), (0.5, 1.0)):
        half = closed.Surface.copy()
        half.segment(low, high, 0.0, 1.0)
        halves.append(half.toShape())
    shell = Part.makeShell([*others, *halves])
    shell.sewShape()
    thing = document.addObject("Part::Feature", "Blade")
    thing.Shape = shell
    document.recompute()
    return thing, f"Face{len(shell.Faces)}"


@pytest.mark.parametrize("strategy", [pytest.param("blade", marks=pytest.mark.long), "blade-keys"])
def test_faces_around_a_blade_are_one_in_the_tree_too(document, strategy):
    thing, name = split_blade(document)
    made, = api.plan(document, (thing, name), "ball:8", 1.0, strategy=strategy, limits="machine:four-axis-a",
                        stickout=100.0, holder=((12.5, 0.0), (12.5, 60.0)), shank=None, direction="climb")
    label = json.loads(made.Details)["label"]
    assert made.AxisMoves and made.Strategy == strategy
    assert label.startswith(f"{name[4:]}+") and made.Label.endswith(label)
    op, = plan_task([made])(NO_PROGRESS).operations
    assert op.face.label == label and op.path.passes == made.Passes
    assert op.face.area == pytest.approx(sum(thing.Shape.Faces[k - 1].Area for k in op.face.numbers), rel=1e-3)
    assert not made.Stale


@pytest.mark.long
def test_two_point_contact_on_a_convex_face_is_planned_with_one_as_by_the_command(document, parts):
    import toolaxis as ta

    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(x, y, 10 - 0.02 * (x - 10) ** 2 - 0.02 * (y - 8) ** 2) for y in range(0, 17, 4)]
                         for x in range(0, 21, 5)])
    thing = document.addObject("Part::Feature", "Convex")
    thing.Shape = surface.toShape()
    document.recompute()
    made, = api.plan(document, (thing, "Face1"), parts.TOOL, 0.3, shank=None, holder=parts.HOLDER, stickout=25.0,
                        strategy="two-point")
    theirs = ta.plan(thing, ta.Tool.parse(parts.TOOL, stickout=25.0, holder=parts.HOLDER), 0.3, strategy="two-point")
    assert made.AxisMoves and made.Passes == theirs.operations[0].orientation.passes
    assert list(made.Reasons) == list(theirs.operations[0].orientation.reasons)
    assert any(why.startswith("one contact") for why in made.Reasons) and touched_once(theirs)


def test_a_strategy_that_comes_to_nothing_leaves_the_tree_as_it_is(document, parts):
    block = parts.block(document)
    names = [one.Name for one in document.Objects]
    with pytest.raises(ToolAxisError, match=r"'multiscale' does not serve face .: refused feed"):
        api.plan(document, (block, parts.sculptured_name(block)), parts.TOOL, parts.SCALLOP, shank=None,
                    holder=parts.HOLDER, stickout=25.0, strategy="multiscale", limits="machine:bc-table-table")
    assert [one.Name for one in document.Objects] == names


def test_passes_that_keep_a_roughness_stand_in_the_tree_with_what_they_leave(document):
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(x, y, 2 - 0.02 * (x - 1) ** 2 - 0.01 * y**2) for y in (0, 1.5, 3, 4.5)]
                         for x in (0, 0.8, 1.6, 2.4)])
    thing = document.addObject("Part::Feature", "Hill")
    thing.Shape = surface.toShape()
    document.recompute()
    made, = api.plan(document, (thing, "Face1"), "torus:10x3", 0.1, shank=None, holder=None, feedrate=800.0,
                        strategy="multiscale", roughness=1.6, limits="machine:bc-table-table")
    assert made.AxisMoves and made.Strategy == "multiscale" and made.Roughness == 1.6 and made.Passes >= 5
    ra, wide = (why.split() for why in made.Reasons[:2])
    assert ra[0] == "Ra" and float(ra[1]) < float(ra[7]) <= 1.6
    assert 2.15 < float(wide[3]) < float(wide[5]) < 3.154, "section strips as wide as expected"
    op, = plan_task([made])(NO_PROGRESS).operations
    assert op.path.passes == made.Passes and np.ptp(op.path.axis, axis=0).max() > 1e-4 and not made.Stale
    assert any(map(is_lines, made.Group)) and [text[:2] for text in made.RotaryAngles] == ["C:", "B:"]
