"""What scripts hand to the public functions: wrong kinds end in one sentence, and the document stays as it was."""

from dataclasses import replace
from types import SimpleNamespace

import FreeCAD
import pytest
from freecad import toolaxis
from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.document.read_shapes import sculptured
from freecad.toolaxis.services import api, arguments
from freecad.toolaxis.services.tools import tool_fields

import toolaxis as ta
from toolaxis.errors import InvalidInput, ToolAxisError
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.progress import Progress

Quantity = FreeCAD.Units.Quantity
STOPPED = Progress(None, lambda: True)


@pytest.fixture
def part(document, parts):
    return parts.block(document)


@pytest.fixture
def face(part, parts):
    return part, parts.sculptured_name(part)


@pytest.fixture
def elsewhere(parts):
    other = FreeCAD.newDocument("Elsewhere")
    yield parts.block(other, "Stranger")
    FreeCAD.closeDocument(other.Name)


def refused(document, words, *rest, **given):
    """Planning ends in one sentence with some words, and makes nothing."""
    before = [thing.Name for thing in document.Objects]
    with pytest.raises(InvalidInput) as caught:
        toolaxis.plan(document, *rest, **given)
    told = str(caught.value)
    assert all(word in told for word in words), told
    assert "\n" not in told and "Traceback" not in told and len(told) < 300
    assert [thing.Name for thing in document.Objects] == before
    assert not document.HasPendingTransaction and not document.UndoNames


@pytest.mark.parametrize("wrong", [None, "x", 7])
def test_what_is_no_document(wrong, face):
    with pytest.raises(InvalidInput, match=r"document is .*: give an open document"):
        toolaxis.plan(wrong, face)


def test_a_closed_document(parts):
    closed = FreeCAD.newDocument("Shut")
    FreeCAD.closeDocument(closed.Name)
    with pytest.raises(InvalidInput, match="document was closed: open it again"):
        toolaxis.plan(closed, "Block.Face1")


@pytest.mark.parametrize(("make", "words"), [
    (lambda part: 7, ("faces is 7", "give an object")),
    (lambda part: None, ("faces is None", "give an object")),
    (lambda part: part.Shape.Faces[0], ("faces is ", "Face", "give an object")),
    (lambda part: [part.Shape.Faces[0]], ("faces[0] is ", "give an object")),
    (lambda part: [], ("nothing is selected",)),
    (lambda part: (part, "Face99"), ("Face99", "select one of Face1 to Face")),
    (lambda part: (part, 99), ("Face99", "select one of Face1 to Face")),
    (lambda part: (part, True), ("faces names the face True", '"Face7" or 7')),
    (lambda part: [(part, 2.5)], ("faces[0] names the face 2.5",)),
    (lambda part: (part, "Edge1"), ("Edge1", "is an edge")),
    (lambda part: (part, "nonsense"), ("nonsense", "is no face")),
    (lambda part: [part, [part, part]], ("faces[1] is ", "give an object")),
    (lambda part: "Nobody.Face1", ("'Nobody'", "no object of")),
    (lambda part: "Block.Face99", ("Face99", "select one of Face1 to Face")),
    (lambda part: "", ("faces names ''",))])
def test_what_is_no_face(document, part, make, words):
    refused(document, words, make(part), progress=STOPPED)


def test_objects_that_cannot_be_planned(document, part, elsewhere):
    group = document.addObject("App::DocumentObjectGroup", "Empty")
    refused(document, ("Empty", "has no shape"), group)
    refused(document, ("faces is Stranger", "of the document Elsewhere"), elsewhere)
    refused(document, ("faces[1] is Stranger", "of the document Elsewhere"), [part, (elsewhere, "Face1")])
    refused(document, ("obstacles[0] is Stranger",), part, obstacles=[elsewhere])
    document.removeObject(group.Name)
    refused(document, ("faces was deleted", "give another object"), group)


@pytest.mark.parametrize(("given", "words"), [
    ({"tool": 6}, ("tool is 6", "torus:12x1")),
    ({"tool": "nonsense"}, ("tool 'nonsense'",)),
    ({"scallop": "much"}, ("scallop is 'much'", "mm")),
    ({"scallop": float("nan")}, ("scallop is nan", "finite")),
    ({"scallop": True}, ("scallop is True", "finite")),
    ({"scallop": 0}, ("scallop is 0.0 mm", "above zero")),
    ({"scallop": [1]}, ("scallop is [1]",)),
    ({"scallop": Quantity("0.02 s")}, ("scallop is ", "mm")),
    ({"tolerance": "fine"}, ("tolerance is 'fine'", "mm")),
    ({"tolerance": 0}, ("machining tolerance is 0.0 mm", "from 0.0005 to 0.1 mm")),
    ({"tolerance": "1 m"}, ("machining tolerance is 1000.0 mm", "from 0.0005 to 0.1 mm")),
    ({"allowance": "5 kg"}, ("allowance is '5 kg'", "mm")),
    ({"feedrate": Quantity("2 mm")}, ("feedrate is ", "mm/min")),
    ({"spindle": None, "stickout": "long"}, ("stickout is 'long'",)),
    ({"holder": "10,0"}, ("holder is '10,0'", "rows of (radius, height)")),
    ({"holder": 7}, ("holder is 7", "rows")),
    ({"holder": [(1, 2, 3)]}, ("holder is [(1, 2, 3)]", "rows")),
    ({"shank": [(3, 0), (3, float("inf"))]}, ("shank[1] is", "finite")),
    ({"obstacles": [3]}, ("obstacles[0] is 3", "objects of the document")),
    ({"obstacles": "Nobody"}, ("obstacles[0] names 'Nobody'",)),
    ({"limits": 5}, ("limits is 5", "cone:0,0,1,60")),
    ({"limits": "nonsense"}, ("nonsense",)),
    ({"objective": "fun"}, ("objective 'fun' is unknown", "length")),
    ({"direction": 1}, ("direction is 1", "zigzag")),
    ({"progress": 7}, ("progress is 7", "Progress")),
    ({"scalop": 0.1}, ("'scalop' is no argument of plan", "scallop"))])
def test_wrong_values(document, face, given, words):
    refused(document, words, face, **given)


@pytest.mark.parametrize("act", [toolaxis.verify, toolaxis.recompute, toolaxis.is_stale])
def test_what_is_no_operation(document, part, act):
    gone = document.addObject("App::DocumentObjectGroup", "Gone")
    for wrong in (None, "Operation", 3, [part]):
        with pytest.raises(InvalidInput, match="give one of the operations that plan returns"):
            act(wrong)
    with pytest.raises(InvalidInput, match="operation is Block, which is none of Tool Axis"):
        act(part)
    document.removeObject(gone.Name)
    with pytest.raises(InvalidInput, match="operation was deleted"):
        act(gone)


def test_a_wrong_progress_is_refused_by_all(document, parts, face):
    made = parts.planned(document, face)[0]
    for act in (toolaxis.verify, toolaxis.recompute):
        with pytest.raises(InvalidInput, match="progress is 'loud'"):
            act(made, "loud")
    assert made.Verdict == "not verified"


def test_faces_are_written_in_many_ways(document, part, face):
    name, number = face[1], int(face[1].removeprefix("Face"))
    picked = SimpleNamespace(Object=part, SubElementNames=(name,))
    for given in (face, list(face), [face], [list(face)], (part, number), [(part, [number])], (part, (name, name)),
                  f"Block.{name}", [f"Block.{name}", face], picked, [picked]):
        assert arguments.faces_of(document, given) == (face,), given
    whole = tuple((part, one) for one in sculptured(part))
    for given in (part, [part], "Block", [part, face], (part, part), SimpleNamespace(Object=part, SubElementNames=())):
        assert arguments.faces_of(document, given) == whole and face in whole, given


def test_bodies_of_the_same_assembly_are_avoided(document, part):
    from freecad.toolaxis.services.defaults import defaults
    from freecad.toolaxis.services.obstacles import bodies_in

    outer, inner = (document.addObject("App::Part", name) for name in ("Outer", "Inner"))
    disc, hidden, apart = (document.addObject("Part::Box", name) for name in ("Disc", "Hidden", "Apart"))
    for holder, thing in ((outer, part), (outer, inner), (inner, disc), (outer, hidden)):
        holder.addObject(thing)
    hidden.Visibility = False
    document.recompute()
    assert set(bodies_in(document, [part])) == {disc, hidden, apart}
    assert defaults(document, ((part, "Face1"),)).obstacles == (disc,)
    assert defaults(document, ((apart, "Face1"),)).obstacles == ()
    assert bodies_in(document, [outer]) == [apart] and set(bodies_in(document, [inner])) == {part, hidden, apart}
    assert defaults(document, ((outer, "Face1"),)).obstacles == ()


def test_numbers_may_have_units(document, part):
    given = {"scallop": Quantity("20 um"), "allowance": "0.1 mm", "stickout": "2 in", "feedrate": Quantity("10 mm/s"),
             "spindle": 8000, "tolerance": "5 um"}
    assert arguments.fields_of(document, given) == pytest.approx(
        {"scallop": 0.02, "allowance": 0.1, "stickout": 50.8, "feedrate": 600, "spindle": 8000, "tolerance": 0.005})
    part.addProperty("App::PropertyLength", "Height")
    part.Height = 7
    assert arguments.fields_of(document, {"scallop": part.Height}) == {"scallop": 7.0}
    found = arguments.fields_of(document, {"obstacles": "Block", "holder": [[10, 0], [10, 30]], "limits": None})
    assert found == {"obstacles": (part,), "holder": ((10.0, 0.0), (10.0, 30.0))}


def test_planned_with_units_and_names(document, parts, face):
    made = toolaxis.plan(document, f"Block.{face[1]}", parts.TOOL, Quantity("0.3 mm"), limits="cone:0.2,0.1,1,2",
                         stickout=Quantity("25 mm"))
    assert made[0].Scallop.Value == 0.3 and made[0].StickOut.Value == 25 and made[0].Faces[0][1] == (face[1],)


def test_a_tool_that_is_none(document, part, face):
    with pytest.raises(ToolAxisError, match="is no tool"):
        api.plan(document, face, tool=part)


@pytest.mark.parametrize("tool", ["tapered-2x1x3", "torus-10x1", ta.Tool.torus(8, 1, flute_length=5.0, stickout=40.0),
                                  ta.Tool.ball(6, shank=[(4, 30), (4, 60)])])
def test_a_tool_is_taken_whole(tool):
    """Cutting edge and shank are those of the tool that is given, not of another one."""
    given = load_tool(tool) if isinstance(tool, str) else tool
    taken = replace(JobInputs(shank=((9, 0), (9, 50)), flute_length=3.0, stickout=50.0),
                    **tool_fields(tool)).assembled()
    assert (taken.name, taken.flute_length) == (given.name, given.flute_length)
    for member in ("shank", "holder"):
        theirs = getattr(given, member)
        assert theirs is None or (getattr(taken, member) == theirs).all()
    assert given.shank is not None or taken.shank is None
    again = replace(JobInputs(), **tool_fields(taken)).assembled()
    assert again.flute_length == given.flute_length


def test_the_machining_tolerance_is_that_of_the_library_and_stands_in_macros(document, parts, face):
    from freecad.toolaxis.document.inputs import TOLERANCE
    from freecad.toolaxis.services.macros import again_lines, plan_line

    from toolaxis.tolerances import MACHINING

    usual = parts.inputs_for(face)
    finer = replace(usual, tolerance=0.005)
    assert usual.tolerance == TOLERANCE == MACHINING
    assert "tolerance" not in plan_line(usual) and "tolerance=0.005" in plan_line(finer)
    made = parts.planned(document, face)[0]
    assert any(line.endswith(".Tolerance = 0.005") for line in again_lines(made, usual, finer))
