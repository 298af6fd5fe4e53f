"""What stands in the document after planning: frames, passes and tool, wherever the part stands."""

import json

import FreeCAD
import numpy as np
import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.kinds import is_operation
from freecad.toolaxis.document.passes import moves, read_back
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.tool_on_path import tool_shape
from freecad.toolaxis.document.work_coordinates import kind_of_frame
from freecad.toolaxis.services import api
from freecad.toolaxis.services.write_results import apply, child

from toolaxis.cldata.toolpath import Motion
from toolaxis.tools.tool import Tool

TURNED = Placement(Vector(100, -20, 5), Rotation(Vector(1, 2, 3), 50))
RAISED = Placement(Vector(0, 0, 50), Rotation(Vector(0, 0, 1), 30))


def frame_of(operation):
    return child(operation, kind_of_frame(operation.Document))


def alone(document, parts):
    thing = parts.block(document)
    return thing, thing, "Face"


def moved(document, parts):
    thing = parts.block(document)
    thing.Placement = TURNED
    return thing, thing, "Face"


def in_containers(document, parts):
    thing = parts.block(document, "A")  # a name that FreeCAD's expressions take for ampere
    inner, outer = (document.addObject("App::Part", name) for name in ("Inner", "Outer"))
    inner.addObject(thing)
    outer.addObject(inner)
    thing.Placement, inner.Placement = Placement(Vector(1, 2, 3), Rotation()), TURNED
    return thing, outer, "Face"


def linked(document, parts):
    thing = parts.block(document)
    thing.Placement = RAISED
    link = document.addObject("App::Link", "Link")
    link.LinkedObject, link.Placement = thing, TURNED
    return link, link, "Face"


def linked_with_its_place(document, parts):
    link, _, name = linked(document, parts)
    link.LinkTransform = True
    return link, link, name


def array_of_links(document, parts):
    thing = parts.block(document)
    array = document.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount, array.ShowElement = thing, 2, True
    array.Placement = TURNED
    document.recompute()
    array.ElementList[1].Placement = Placement(Vector(0, 60, 0), Rotation(Vector(0, 0, 1), 90))
    return array.ElementList[1], array, "Face"


def array_as_a_whole(document, parts):
    thing = parts.block(document)
    array = document.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount, array.ShowElement = thing, 2, False
    array.PlacementList = [Placement(), Placement(Vector(0, 60, 0), Rotation(Vector(0, 0, 1), 90))]
    array.Placement = TURNED
    return array, array, "1.Face"


def linked_in_an_assembly(document, parts):
    import AssemblyApp  # noqa: F401  makes its types known

    link, _, name = linked(document, parts)
    assembly = document.addObject("Assembly::AssemblyObject", "Assembly")
    assembly.addObject(link)
    assembly.Placement = Placement(Vector(5, 6, 7), Rotation(Vector(1, 0, 0), 40))
    return link, assembly, name


STANDS = (alone, moved, in_containers, linked, linked_with_its_place, array_of_links, array_as_a_whole,
          linked_in_an_assembly)


@pytest.fixture(params=STANDS, ids=lambda make: make.__name__)
def stand(request, document, parts):
    """A part somewhere, what moves it, its operation and the plan behind it."""
    thing, mover, prefix = request.param(document, parts)
    document.recompute()
    number = parts.sculptured_name(thing if not hasattr(thing, "LinkedObject") else thing.getLinkedObject(True))[4:]
    inputs = parts.inputs_for((thing, prefix + number))
    part, _ = bridge_source(inputs)
    normal = part.face(selected(inputs)).normal(np.array([[0.5, 0.5]]))[0]
    plan = parts.quick_plan(inputs, Vector(*(normal + np.array([0.15, 0.1, 0.05]))))
    assert plan.operations[0].done, plan.operations[0].orientation.reasons
    return mover, apply(document, inputs, plan)[0], plan


def bridge_source(inputs):
    from freecad.toolaxis.document.read_shapes import ShapesRead

    from toolaxis.progress import NO_PROGRESS

    return ShapesRead.of(inputs).read(NO_PROGRESS)


def selected(inputs):
    from freecad.toolaxis.document.read_shapes import ShapesRead

    return ShapesRead.of(inputs).numbers[0]


def check_on_cl(operation, tips, axis):
    """Passes turned back by the frame lie on the CL data; the triad is right-handed with +Z the axis."""
    matrix = matrix_of(frame_of(operation).Placement)
    points, _ = moves(child(operation, "Path::Feature"))
    back = points @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.abs(back - tips).max() < 1e-6
    assert np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1.0, abs=1e-12)
    assert np.allclose(matrix[:3, 2], axis, atol=1e-12)
    assert child(operation, "Path::Feature").Placement.isSame(frame_of(operation).Placement, 1e-9)


def test_frames_and_passes_stand_on_the_part_and_follow_it(stand, document):
    mover, operation, plan = stand
    op = plan.operations[0]
    check_on_cl(operation, op.path.cl, op.orientation.axis)
    assert not api.is_stale(operation)
    before = mover.Placement
    mover.Placement = Placement(Vector(-7, 30, 11), Rotation(Vector(0, 1, 2), 75)).multiply(before)
    document.recompute()
    motion = matrix_of(mover.Placement.multiply(before.inverse()))
    check_on_cl(operation, op.path.cl @ motion[:3, :3].T + motion[:3, 3], motion[:3, :3] @ op.orientation.axis)
    assert not api.is_stale(operation) and not operation.Stale, operation.StaleReasons
    standing = child(operation, "Part::FeaturePython")
    assert standing.Placement.Rotation.isSame(frame_of(operation).Placement.Rotation, 1e-9)
    assert not [thing.Name for thing in document.Objects if "Invalid" in thing.State]


@pytest.fixture
def operation(document, parts):
    thing = parts.block(document)
    return parts.planned(document, (thing, parts.sculptured_name(thing)))[0]


def test_the_frame_stands_by_the_mean_feed(document, parts):
    thing = parts.block(document)
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)))
    plan = parts.quick_plan(inputs)
    made = apply(document, inputs, plan)[0]
    matrix, op = matrix_of(frame_of(made).Placement), plan.operations[0]
    assert np.allclose(matrix[:3, 0], op.frame.x, atol=1e-12)
    steps = np.diff(op.path.cl, axis=0)[op.path.kind[1:] == Motion.CUT]
    along = np.abs(steps @ matrix[:3, 0]).sum() / np.linalg.norm(steps, axis=1).sum()
    assert along > 0.95, "the passes run along +X"
    assert np.allclose(matrix[:3, 3], 0), "the datum is the origin of the part"


def test_an_operation_tells_what_was_found(operation):
    assert is_operation(operation) and operation.Outcome == "feasible"
    assert operation.Passes > 1 and operation.CuttingLength.Value > 50 and operation.AverageStripWidth.Value > 0.5
    assert 0 <= operation.Gouge.Value <= operation.Tolerance.Value == 0.01
    assert operation.CutterClearance.Value >= 0.1 and operation.HolderClearance.Value >= 1
    assert "obstacles other than the part" in operation.NotChecked
    assert json.loads(operation.AxisMap)["axis"] == pytest.approx(list(operation.Axis))


def test_what_is_not_checked_has_no_clearance(document, parts):
    thing = parts.block(document)
    inputs = JobInputs(((thing, parts.sculptured_name(thing)),), parts.TOOL, scallop=parts.SCALLOP, stickout=25)
    made = apply(document, inputs, parts.quick_plan(inputs))[0]
    assert "holder" in made.NotChecked and not hasattr(made, "HolderClearance")


def test_inputs_come_back_from_the_operation(document, parts):
    thing, other = parts.block(document), document.addObject("Part::Box", "Clamp")
    other.Placement.Base = Vector(60, 0, 0)
    document.recompute()
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), obstacles=(other,), limits="cone:0,0,1,60",
                              tolerance=0.004, allowance=0.1, direction="climb", objective="passes", feedrate=777.0,
                              spindle=5400.0)
    made = apply(document, inputs, parts.quick_plan(inputs))[0]
    back = inputs_of(made)
    assert back == inputs, (back, inputs)


def test_passes_come_back_as_they_were_planned(document, parts):
    thing = parts.block(document)
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), feedrate=600.0)
    plan = parts.quick_plan(inputs)
    made = apply(document, inputs, plan)[0]
    passes, path = child(made, "Path::Feature"), plan.operations[0].path
    back = read_back(passes, made.Motions, made.Starts)
    assert np.abs(back.cl - path.cl).max() < 1e-6 and np.array_equal(back.kind, path.kind)
    assert np.array_equal(back.breaks, path.breaks)
    feeds = {command.Parameters.get("F") for command in passes.Path.Commands if command.Name == "G1"}
    assert feeds == {10.0}, "mm/s"
    names = [command.Name for command in passes.Path.Commands]
    assert [name == "G0" for name in names[1:]] == (path.kind[1:] == Motion.LINK).tolist()
    words = {word for command in passes.Path.Commands for word in command.Parameters}
    assert words <= {"X", "Y", "Z", "F"}, "no rotary words in a preview"


def test_the_tool_stands_on_its_passes_and_moves(operation, document):
    standing = child(operation, "Part::FeaturePython")
    passes = child(operation, "Path::Feature")
    points, rapid = moves(passes)
    cut = np.flatnonzero(~rapid)
    ends = points[cut[0] - 1], points[cut[-1]]
    for position, end in ((0.0, ends[0]), (1.0, ends[1])):
        standing.Position = position
        tip = passes.Placement.inverse().multVec(standing.Placement.Base)
        assert np.allclose(tip, end, atol=1e-9)
    standing.Position = 0.37
    before = standing.Placement.Base
    segments = np.stack([points[cut - 1], points[cut]], axis=1)
    tip = np.array(passes.Placement.inverse().multVec(before))
    way = segments[:, 1] - segments[:, 0]
    share = np.clip(((tip - segments[:, 0]) * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), 1e-18), 0, 1)
    assert np.linalg.norm(segments[:, 0] + share[:, None] * way - tip, axis=1).min() < 1e-9
    document.recompute()
    assert standing.Placement.Base.distanceToPoint(before) < 1e-9
    standing.Position = 7
    assert standing.Position == 1.0


@pytest.mark.parametrize("text", ["torus:12x1", "ball:8", "flat:20", "tapered:6x3x4", "tapered:6x1x10", "torus:6x3"])
def test_the_tool_is_a_solid_of_revolution_of_its_profile(text):
    tool = Tool.parse(text, stickout=50.0, holder=[[10, 0], [10, 30], [20, 30], [20, 60]])
    solids = tool_shape(tool).Solids
    assert len(solids) == 3 and all(solid.isValid() and solid.Volume > 0 for solid in solids)
    z = np.linspace(0, tool.flute_length, 20001)
    radius = tool.profile.radius_at(z)
    assert solids[0].Volume == pytest.approx(np.pi * np.trapezoid(radius**2, z), rel=1e-3)
    assert solids[2].Volume == pytest.approx(np.pi * (100 * 30 + 400 * 30), rel=1e-6)
    assert solids[0].BoundBox.ZMin == pytest.approx(0, abs=1e-6)


def test_a_face_without_an_axis_has_its_reasons_and_no_objects(document, parts):
    thing = parts.block(document)
    made = parts.planned(document, (thing, parts.sculptured_name(thing)), axis=Vector(0, 0, -1))[0]
    assert made.Outcome == "infeasible" and made.Reasons and not made.Group
    assert not api.is_stale(made)


def test_faces_of_two_parts_are_planned_at_once(document, parts):
    first, second = parts.block(document, "First"), parts.block(document, "Second")
    second.Placement = RAISED.multiply(Placement(Vector(0, 80, 0), Rotation()))
    document.recompute()
    name = parts.sculptured_name(first)
    made = parts.planned(document, (first, name), (second, name))
    assert [one.Faces for one in made] == [[(first, (name,))], [(second, (name,))]]
    assert list(made[0].Obstacles) == [second] and list(made[1].Obstacles) == [first]
    assert frame_of(made[1]).Placement.isSame(made[1].Group[1].Placement, 1e-9)
    assert frame_of(made[1]).AttachmentSupport[0][0] == second
    assert made[0].Label != made[1].Label
    assert api.verify(made[1]).passed


def test_a_whole_plan_from_one_call(document, parts):
    import freecad.toolaxis as add_on

    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    made = add_on.plan(document, (thing, name), parts.TOOL, parts.SCALLOP, limits="cone:0.2,0.1,1,3",
                       holder=parts.HOLDER, stickout=25.0)
    assert len(made) == 1 and made[0].Faces == [(thing, (name,))]
    assert made[0].Outcome == "feasible" and not add_on.is_stale(made[0])
    angle = made[0].Axis.getAngle(Vector(0.2, 0.1, 1.0))
    assert np.degrees(angle) <= 3.0001
    assert FreeCAD.ActiveDocument.Name == document.Name
