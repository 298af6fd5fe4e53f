"""What belongs to an operation: told when it is deleted or cannot be opened, made again, and deleted with it."""

import zipfile

import FreeCAD
import pytest
from FreeCAD import Vector
from freecad.toolaxis.document import work_coordinates
from freecad.toolaxis.document.children import FRAMES, belongings, child, frame_of
from freecad.toolaxis.document.kinds import is_operation
from freecad.toolaxis.document.work_coordinates import kind_of_frame
from freecad.toolaxis.services import api

LIMITS = "cone:0.2,0.1,1,2"
FRAME, PASSES, TOOL = "its work coordinate system is missing", "its passes are missing", "Part::FeaturePython"


@pytest.fixture
def part(document, parts):
    return parts.block(document)


@pytest.fixture
def operation(document, parts, part):
    return parts.planned(document, (part, parts.sculptured_name(part)), limits=LIMITS)[0]


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def whole(operation):
    """Whether an operation has all that stands after planning, in its place and valid."""
    document = operation.Document
    frame, passes, tool = frame_of(operation), child(operation, "Path::Feature"), child(operation, TOOL)
    assert tool.Passes == passes and passes.Path.Size > 10 and not operation.Stale and not api.is_stale(operation)
    assert not [thing.Name for thing in document.Objects if "Invalid" in thing.State]
    part = operation.Faces[0][0]
    part.Placement.Base = part.Placement.Base + Vector(3, 4, 5)
    before = [thing.Placement.Base for thing in (frame, passes, tool)]
    document.recompute()
    after = [thing.Placement.Base for thing in (frame, passes, tool)]
    return all((b - a).isEqual(Vector(3, 4, 5), 1e-9) for a, b in zip(before, after, strict=True))


@pytest.mark.parametrize(("kind", "words"), [("frame", FRAME), ("passes", PASSES)])
def test_what_is_deleted_is_told_at_once_and_made_again(document, operation, kind, words):
    thing = frame_of(operation) if kind == "frame" else child(operation, "Path::Feature")
    document.removeObject(thing.Name)
    assert operation.Stale and any(words in reason for reason in operation.StaleReasons)
    assert api.is_stale(operation)
    document.recompute()
    assert not [other.Name for other in document.Objects if "Invalid" in other.State]
    assert operation.Stale and [words in reason for reason in operation.StaleReasons] == [True]
    assert api.recompute(operation) == [operation]
    assert whole(operation)


def test_both_deleted_and_what_is_dragged_out_of_the_operation(document, operation):
    passes = child(operation, "Path::Feature")
    document.removeObject(frame_of(operation).Name)
    operation.removeObject(passes)
    document.recompute()
    assert len(operation.StaleReasons) == 2 and PASSES in operation.StaleReasons
    document.removeObject(passes.Name)
    api.recompute(operation)
    assert whole(operation)


def test_the_tool_or_a_map_may_be_deleted(document, operation):
    api.verify(operation)
    for kind in (TOOL, "Mesh::Feature"):
        document.removeObject(child(operation, kind).Name)
    document.recompute()
    assert not operation.Stale and not api.is_stale(operation)


@pytest.mark.parametrize("undo", [0, 1])
def test_undo_brings_what_was_deleted_back_with_the_mark(document, operation, undo):
    document.UndoMode = undo
    before = names(document)
    document.openTransaction("Delete")
    document.removeObject(frame_of(operation).Name)
    document.commitTransaction()
    document.recompute()
    assert operation.Stale
    if undo:
        document.undo()
        document.recompute()
        assert names(document) == before and not operation.Stale and not api.is_stale(operation)
        document.redo()
        assert operation.Stale and frame_of(operation) is None
        document.undo()
        document.recompute()
        assert whole(operation)


def test_an_operation_takes_with_it_what_belongs_to_it(document, parts, part, operation):
    api.verify(operation)
    other = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    note = document.addObject("App::FeaturePython", "Note")
    operation.addObject(note)
    gone = {thing.Name for thing in (*belongings(operation), *operation.InList)}
    assert len(gone) == 5 + 1, "the group of this planning, with nothing else in it, too"
    left = [name for name in names(document) if "Axis" not in name and "Plane" not in name
            and not name.startswith("Origin") and name not in {operation.Name, *gone}]
    document.removeObject(operation.Name)
    there = [name for name in names(document) if "Axis" not in name and "Plane" not in name
             and not name.startswith("Origin")]
    assert there == left and note.Document is document, "what the user has put there stays"
    assert len(belongings(other)) == 3 and not other.Stale


@pytest.mark.parametrize("transaction", [False, True])
def test_undo_and_redo_of_a_deleted_operation(document, parts, part, transaction):
    document.UndoMode = 1
    made = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    api.verify(made)
    before, name = names(document), made.Name
    if transaction:
        document.openTransaction("Delete")
    document.removeObject(name)
    if transaction:
        document.commitTransaction()
    after = names(document)
    assert after == [part.Name]
    for _ in range(2):
        document.undo()
        assert names(document) == before
        again = document.getObject(name)
        assert is_operation(again) and len(belongings(again)) == 5 and not again.Stale
        document.redo()
        assert names(document) == after
    document.undo()
    document.recompute()
    again = document.getObject(name)
    assert api.verify(again).passed and whole(again)


def test_undo_of_planning_and_redo_again(document, parts, part):
    document.UndoMode = 1
    before = names(document)
    parts.planned(document, (part, parts.sculptured_name(part)))
    after = names(document)
    for _ in range(2):
        document.undo()
        assert names(document) == before
        document.redo()
        assert names(document) == after


def kinds(document):
    return [thing.TypeId for thing in document.Objects]


def test_a_group_stays_until_nothing_is_in_it(document, parts, part):
    first = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    group, = first.InList
    name = group.Name
    second = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    group.addObject(second)
    document.removeObject(first.Name)
    assert document.getObject(name) is not None and second in group.Group
    note = document.addObject("App::FeaturePython", "Note")
    group.addObject(note)
    document.removeObject(second.Name)
    assert group.Group == [note], "what the user has put there stays"


def reopened(document, path, change):
    """A saved document with a change of its text, open."""
    document.recompute()
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    with zipfile.ZipFile(path) as packed:
        members = {name: packed.read(name) for name in packed.namelist()}
    members["Document.xml"] = change(members["Document.xml"].decode()).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, content in members.items():
            packed.writestr(name, content)
    return FreeCAD.openDocument(str(path))


def test_a_frame_that_cannot_be_opened_is_told_and_made_again(document, operation, tmp_path):
    kind, before = frame_of(operation).TypeId, sorted(kinds(document))
    opened = reopened(document, tmp_path / "Newer.FCStd", lambda text: text.replace(kind, "Part::FrameOfTomorrow"))
    try:
        again = next(thing for thing in opened.Objects if is_operation(thing))
        assert frame_of(again) is None
        assert again.Stale and FRAME in again.StaleReasons[0] and api.is_stale(again)
        api.recompute(again)
        assert frame_of(again).TypeId == kind_of_frame(opened) and whole(again)
        assert sorted(kinds(opened)) == before, "nothing of the lost frame stays"
    finally:
        FreeCAD.closeDocument(opened.Name)


def test_what_a_lost_frame_left_behind_goes_with_its_operation_alone(document, parts, part, operation, tmp_path):
    other = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    kind, name, mine = frame_of(operation).TypeId, operation.Name, document.addObject("App::Line", "Mine").Name
    kept, gone = {mine, *other.FrameFeatures}, set(operation.FrameFeatures)
    opened = reopened(document, tmp_path / "Newer.FCStd", lambda text: text.replace(kind, "Part::FrameOfTomorrow"))
    try:
        assert not kept & gone and all(opened.getObject(name) for name in kept | gone)
        opened.removeObject(name)
        assert all(map(opened.getObject, kept)) and not any(map(opened.getObject, gone))
    finally:
        FreeCAD.closeDocument(opened.Name)


def test_a_frame_of_the_other_kind_is_kept(document, parts, part, monkeypatch):
    import _PartDesign  # noqa: F401

    monkeypatch.setattr(work_coordinates, "kind_of_frame", lambda _: FRAMES[-1])
    made = parts.planned(document, (part, parts.sculptured_name(part)), limits=LIMITS)[0]
    monkeypatch.undo()
    frame = frame_of(made)
    assert frame.TypeId == FRAMES[-1] and not api.is_stale(made)
    made.Scallop = 0.4
    api.recompute(made)
    assert frame_of(made) == frame and whole(made)


def test_closing_a_document_deletes_nothing_by_itself(parts, tmp_path):
    closed = FreeCAD.newDocument("Closed")
    thing = parts.block(closed)
    parts.planned(closed, (thing, parts.sculptured_name(thing)))
    path, before = tmp_path / "Closed.FCStd", names(closed)
    closed.saveAs(str(path))
    FreeCAD.closeDocument(closed.Name)
    opened = FreeCAD.openDocument(str(path))
    try:
        assert names(opened) == before
    finally:
        FreeCAD.closeDocument(opened.Name)
