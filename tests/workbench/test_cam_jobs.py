"""FreeCAD's own CAM jobs from operations: what its post-processor writes lies on the CL data, and nothing half-made."""

import re
import sys
import types

import FreeCAD
import numpy as np
import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.cam import job_setup
from freecad.toolaxis.cam import jobs as cam_jobs
from freecad.toolaxis.cam.jobs import count_jobs, jobs_of, make_jobs
from freecad.toolaxis.cam.tools import add_bit
from freecad.toolaxis.cam.work_offsets import OFFSETS, shared_of
from freecad.toolaxis.document.cam_probe import tool_from
from freecad.toolaxis.document.children import frame_of
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.work_coordinates import kind_of_frame
from freecad.toolaxis.services.write_results import apply

from toolaxis.cad.freecad.documents import shape_of
from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.progress import Progress
from toolaxis.tools.tool import Tool

TURNED = Placement(Vector(100, -20, 5), Rotation(Vector(1, 2, 3), 50))


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def planned(document, parts, thing, name, lean=(0.15, 0.1, 0.05), **given):
    """An operation with the plan behind it, its axis near the middle normal."""
    shape = shape_of(thing)
    face = shape.Faces[int(name.rsplit("Face", 1)[1]) - 1]
    inputs = parts.inputs_for((thing, name), **given)
    plan = parts.known_plan(inputs, Vector(*(np.array(face.normalAt(0.5, 0.5)) + lean)))
    assert plan.operations[0].done, plan.operations[0].orientation.reasons
    return apply(document, inputs, plan)[0], plan.operations[0]


def turned(document, parts):
    thing = parts.block(document)
    thing.Placement = TURNED
    return thing, thing, "Face"


def contained(document, parts):
    thing = parts.block(document)
    outer = document.addObject("App::Part", "Outer")
    outer.addObject(thing)
    thing.Placement, outer.Placement = Placement(Vector(1, 2, 3), Rotation()), TURNED
    return thing, outer, "Face"


def linked(document, parts):
    thing = parts.block(document)
    link = document.addObject("App::Link", "Link")
    link.LinkedObject, link.Placement = thing, TURNED
    return link, link, "Face"


@pytest.mark.parametrize("stand", [turned, contained, linked], ids=lambda make: make.__name__)
def test_the_posted_program_lies_on_the_cl_data(stand, document, parts, posting):
    thing, mover, prefix = stand(document, parts)
    document.recompute()
    name = prefix + parts.sculptured_name(thing.getLinkedObject(True))[4:]
    operation, op = planned(document, parts, thing, name)
    before = mover.Placement
    mover.Placement = Placement(Vector(-7, 30, 11), Rotation(Vector(0, 1, 2), 75)).multiply(before)
    document.recompute()
    motion = matrix_of(mover.Placement.multiply(before.inverse()))
    job, = make_jobs(document, operation)
    frame = frame_of(operation).Placement
    posting.check_on_cl(posting.posted(job), job.Operations.Group[0], op.path, frame, motion)
    model, shape = job.Model.Group[0], shape_of(thing)
    for own, face in zip(model.Shape.Faces, shape.Faces, strict=True):
        assert frame.multVec(own.CenterOfMass).distanceToPoint(face.CenterOfMass) < 1e-6
    box, stock = model.Shape.BoundBox, job.Stock.Shape.BoundBox
    assert stock.XMin <= box.XMin and stock.ZMax >= box.ZMax and stock.DiagonalLength < 1.5 * box.DiagonalLength
    assert job.Operations.Group[0].OrientedFrom == operation and jobs_of(operation) == [job]
    assert not [one.Name for one in document.Objects if "Invalid" in one.State]


def test_a_program_of_a_tilted_plane_says_so_before_it_moves(document, parts, posting):
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing), (0.1, 0.2, 0.0))
    job, = make_jobs(document, operation)
    frame = frame_of(operation).Placement
    axis = frame.Rotation.multVec(Vector(0, 0, 1))
    before, _, _ = posting.posted(job).partition("\nG0 ")
    assert "(TILTED PLANE - this program does not tilt it" in before
    told = re.search(r"\(its Z, the tool axis, in the part: (\S+) (\S+) (\S+)\)", before)
    assert Vector(*map(float, told.groups())).distanceToPoint(axis) < 2e-6


def test_a_program_in_the_parts_own_plane_says_nothing_of_tilting():
    assert job_setup.plane_comments(Placement()) == []


def test_each_orientation_is_a_job_and_shares_it(document, parts, posting):
    first, second = parts.block(document, "First"), parts.block(document, "Second")
    second.Placement.Base = Vector(0, 60, 0)
    document.recompute()
    name = parts.sculptured_name(first)
    made = [planned(document, parts, first, name, (0.1, 0.0, 0.0)),
            planned(document, parts, second, name, (0.0, 0.2, 0.0), feedrate=800.0),
            planned(document, parts, second, name, (0.1, 0.0, 0.0), feedrate=600.0)]
    jobs = make_jobs(document, [operation for operation, _ in made])
    assert [job.Fixtures for job in jobs] == [["G54"], ["G55"]]
    held = [[one.OrientedFrom for one in job.Operations.Group] for job in jobs]
    assert held == [[made[0][0], made[2][0]], [made[1][0]]]
    shared = jobs[0]
    assert [tc.ToolNumber for tc in shared.Tools.Group] == [1, 2] and len(shared.Model.Group) == 2
    assert [tc.HorizFeed.Value * 60 for tc in shared.Tools.Group] == pytest.approx([1000, 600])
    text, frame = posting.posted(shared), frame_of(made[0][0]).Placement
    assert "M6 T1" in text and "M6 T2" in text and "M3 S10000" in text
    for job_op, (_, op) in zip(shared.Operations.Group, (made[0], made[2]), strict=True):
        matrix = matrix_of(frame)
        points, _, rates = posting.motions(text, job_op.Label)
        assert np.abs(points[2:-1] - (op.path.cl - matrix[:3, 3]) @ matrix[:3, :3]).max() <= posting.DIGIT / 2 + 1e-9
        assert (1000.0 if op is made[0][1] else 600.0) in rates
    assert "\nG55" in posting.posted(jobs[1])


def test_a_clone_that_shows_something_else_is_refused(document, parts):
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing))
    job, = make_jobs(document, operation)
    model, frame = job.Model.Group[0], frame_of(operation).Placement
    job_setup._turn_model(model, thing, frame)
    model.Scale = Vector(1.0, 1.0, 1.001)
    with pytest.raises(InvalidInput, match="makes no true copy of Block"):
        job_setup._turn_model(model, thing, frame)


def test_the_safe_height_is_above_what_is_avoided(document, parts, posting):
    thing, clamp = parts.block(document), document.addObject("Part::Box", "Clamp")
    clamp.Placement.Base, clamp.Height = Vector(60, 0, 0), 90
    document.recompute()
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing), obstacles=(clamp,))
    job, = make_jobs(document, [operation])
    points, *_ = posting.motions(posting.posted(job), job.Operations.Group[0].Label)
    corners = [frame_of(operation).Placement.inverse().multVec(vertex.Point).z for vertex in clamp.Shape.Vertexes]
    assert points[0, 2] >= max(corners) + job.SetupSheet.ClearanceHeightOffset.Value - posting.DIGIT


def test_one_undo_step_and_back(document, parts):
    document.UndoMode = 1
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing))
    before, steps = names(document), document.UndoCount
    make_jobs(document, [operation])
    after = names(document)
    assert document.UndoCount == steps + 1
    document.undo()
    assert names(document) == before
    document.redo()
    assert names(document) == after


def test_made_again_it_takes_the_place_of_the_old_one(document, parts):
    thing = parts.block(document)
    operation, op = planned(document, parts, thing, parts.sculptured_name(thing))
    job, = make_jobs(document, [operation])
    job.PostProcessor, job.PostProcessorArgs, job.Fixtures = "grbl", "--no-header", ["G58"]
    count, lines = len(document.Objects), len(job.Operations.Group[0].Gcode)
    labels = sorted(thing.Label for thing in document.Objects)
    operation.Scallop = 0.5
    document.recompute()
    assert operation.Stale
    inputs = inputs_of(operation)
    apply(document, inputs, parts.known_plan(inputs, Vector(*op.orientation.axis)), operation)
    again, = make_jobs(document, [operation])
    assert len(document.Objects) == count and len(again.Operations.Group[0].Gcode) < lines
    assert sorted(thing.Label for thing in document.Objects) == labels, "nothing has another name"
    assert (again.PostProcessor, again.PostProcessorArgs, again.Fixtures) == ("grbl", "--no-header", ["G58"])


def test_what_a_user_put_into_a_job_stays(document, parts):
    import Path.Op.Custom as Custom

    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing))
    job, = make_jobs(document, [operation])
    mine = Custom.Create("Mine", parentJob=job)
    passes = job.Operations.Group[0].Label
    again, = make_jobs(document, [operation])
    assert again.Name != job.Name and job.Operations.Group == [mine]
    assert again.Operations.Group[0].Label == passes
    assert jobs_of(operation) == [again]


def test_bad_operations_are_refused_in_a_sentence(document, parts):
    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    nowhere = parts.planned(document, (thing, name), axis=Vector(0, 0, -1))[0]
    operation, _ = planned(document, parts, thing, name)
    with pytest.raises(InvalidInput, match="no operation with passes"):
        make_jobs(document, nowhere)
    assert len(make_jobs(document, [nowhere, operation])) == 1, "those without an axis are left out"
    before = names(document)
    operation.Scallop = 0.2
    with pytest.raises(InvalidInput, match=r"is out of date \(scallop was changed\): recompute it"):
        make_jobs(document, operation)
    with pytest.raises(InvalidInput, match="none of Tool Axis"):
        make_jobs(document, thing)
    assert names(document) == before


def test_nothing_half_made_stays(document, parts, monkeypatch):
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, parts.sculptured_name(thing))
    before = names(document)

    def fails(*_):
        raise InvalidInput("the disk is full")

    monkeypatch.setattr(job_setup, "blocks", fails)
    with pytest.raises(InvalidInput, match="the disk is full"):
        make_jobs(document, operation)
    assert names(document) == before
    document.recompute()
    assert not operation.Stale


@pytest.mark.parametrize("text", ["torus:12x1", "ball:8", "flat:20", "torus:6x3", "tapered:6x3x4"])
def test_a_cutter_comes_back_from_its_bit(text, document):
    FreeCAD.setActiveDocument(document.Name)
    tool = Tool.parse(text, stickout=70.0)
    back = tool_from(add_bit(document, tool, text))
    if tool.kind != "tapered" or back.kind == "tapered":
        assert (back.radius, back.corner_radius, back.half_angle) == pytest.approx(
            (tool.radius, tool.corner_radius, tool.half_angle))
        assert back.flute_length == pytest.approx(tool.flute_length)
    else:
        assert (back.kind, back.radius) == ("ball", 3.0), "FreeCAD 1.0 has no tapered cutters"


def test_work_planes_are_used_where_jobs_have_them(document, parts, monkeypatch, posting):
    """By the interface of FreeCAD's coming Path.Main.Workplane, which no FreeCAD that can be had yet has."""
    import Path.Op.Custom as Custom

    def create(job, label=None, placement=None, **_):
        plane = document.addObject(kind_of_frame(document), "Workplane")
        plane.Label = label
        plane.addProperty("App::PropertyPlacement", "Stands")
        plane.Stands = placement
        return plane

    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    made = [planned(document, parts, thing, name, (lean, 0.0, 0.0)) for lean in (0.1, 0.2)]
    monkeypatch.setitem(sys.modules, "Path.Main.Workplane", types.SimpleNamespace(createWorkplane=create))
    monkeypatch.setattr(cam_jobs, "_has_planes", lambda: True)
    jobs = make_jobs(document, [operation for operation, _ in made])
    assert len(jobs) == 2, "operations with given passes that take no plane: a job for each orientation"
    assert not [one.Name for one in document.Objects if one.Name.startswith("Workplane")]
    plain = Custom.Create

    def with_plane(*args, **given):
        operation = plain(*args, **given)
        operation.addProperty("App::PropertyLink", "Workplane")
        return operation

    monkeypatch.setattr(Custom, "Create", with_plane)
    job, = make_jobs(document, [operation for operation, _ in made])
    assert len(job.Operations.Group) == 2
    text = posting.posted(job)
    for one, (operation, op) in zip(job.Operations.Group, made, strict=True):
        assert one.Workplane.Stands.isSame(frame_of(operation).Placement, 1e-9)
        posting.check_on_cl(text, one, op.path, one.Workplane.Stands, np.eye(4))


def turned_copy(document, operation, face):
    """A link like those that show an operation on another blade."""
    link = document.addObject("App::Link", "Turned")
    link.LinkedObject = operation
    link.addProperty("App::PropertyPlacement", "Turn")
    link.addProperty("App::PropertyString", "Face")
    link.Placement = link.Turn = Placement(Vector(), Rotation(Vector(0, 0, 1), 90))
    link.Face, link.Label = face, "Another blade (turned copy)"
    return link


def test_turned_copies_of_blades_are_machined_too(document, parts, tmp_path, posting):
    from freecad.toolaxis.services.export import export

    from toolaxis.job.files.plan_folder import read_plan

    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    operation, op = planned(document, parts, thing, name)
    link = turned_copy(document, operation, name)
    document.recompute()
    jobs = make_jobs(document, operation)
    assert [job.Operations.Group[0].MadeFor for job in jobs] == [operation.Label, "Another blade (turned copy)"]
    assert [job.Fixtures for job in jobs] == [["G54"], ["G55"]] and jobs_of(operation) == jobs
    assert jobs[1].Operations.Group[0].Label == "Finishing Another blade, turned copy"
    assert not re.search(r"\([^)]*\(", posting.posted(jobs[1])), "comments inside one another"
    frame = link.Placement.multiply(frame_of(operation).Placement)
    posting.check_on_cl(posting.posted(jobs[1]), jobs[1].Operations.Group[0], op.path, frame, matrix_of(link.Placement))
    export(operation, tmp_path / "plan")
    first, second = read_plan(tmp_path / "plan").operations
    turn = matrix_of(link.Placement)[:3, :3]
    assert np.abs(second.path.cl - first.path.cl @ turn.T).max() < 2e-6
    assert np.abs(second.orientation.axis - turn @ first.orientation.axis).max() < 1e-9
    assert np.abs(second.frame.x - turn @ first.frame.x).max() < 1e-9


@pytest.fixture
def crowded(document, parts):
    """An operation with ten turned copies: eleven orientations."""
    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    operation, _ = planned(document, parts, thing, name)
    for k in range(1, 11):
        link = turned_copy(document, operation, name)
        link.Placement = link.Turn = Placement(Vector(), Rotation(Vector(0, 0, 1), 33 * k))
        link.Label = f"Blade {k + 1}"
    document.recompute()
    return operation


def test_where_work_offsets_run_out_jobs_and_programs_say_so(crowded, parts, posting):
    """Nine offsets for eleven orientations: the first two and the last two jobs have common ones, and tell."""
    document = crowded.Document
    assert count_jobs([crowded]) == 11
    jobs = make_jobs(document, crowded)
    offsets = [name for job in jobs for name in job.Fixtures]
    assert tuple(offsets) == (*OFFSETS, *OFFSETS[:2]) and OFFSETS[-1] == "G59.3"
    assert shared_of(jobs) == [*jobs[:2], *jobs[-2:]]
    assert jobs[0].SharedOffset.startswith(f"G54 is also the work offset of {jobs[9].Label}: set it for")
    text = posting.posted(jobs[9])
    assert text.index("(work offset G54 serves several orientations") < text.index("\nG0 Z")
    assert "serves several" not in posting.posted(jobs[5])
    again = make_jobs(document, crowded)
    assert [name for job in again for name in job.Fixtures] == offsets
    thing = parts.block(document, "Another")
    other, = make_jobs(document, planned(document, parts, thing, parts.sculptured_name(thing), (0.3, 0, 0))[0])
    assert other.Fixtures == [OFFSETS[2]] and other in shared_of([other])
    assert again[2].SharedOffset.startswith(f"{OFFSETS[2]} is also the work offset of {other.Label}"), "told at both"


def test_a_later_call_takes_offsets_that_are_free(document, parts):
    """Also where one job was made of two operations that have different axes now."""
    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    first, second, third = (planned(document, parts, thing, name, (lean, 0.0, 0.0)) for lean in (0.1, 0.1, 0.3))
    job, = make_jobs(document, [first[0], second[0]])
    assert job.Fixtures == ["G54"] and make_jobs(document, third[0])[0].Fixtures == ["G55"]
    inputs = inputs_of(second[0])
    apply(document, inputs, parts.known_plan(inputs, Vector(0, 0.2, 1)), second[0])
    jobs = make_jobs(document, [first[0], second[0]])
    assert [job.Fixtures for job in jobs] == [["G54"], ["G56"]] and not shared_of(jobs)


def test_making_many_jobs_can_be_stopped(crowded):
    document, told = crowded.Document, []
    before = names(document)
    with pytest.raises(Cancelled):
        make_jobs(document, crowded, Progress(lambda *row: told.append(row), lambda: len(told) > 3))
    assert names(document) == before and [row[1:] for row in told] == [(k, 11) for k in range(4)]
