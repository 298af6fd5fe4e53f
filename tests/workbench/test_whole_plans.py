"""Whole parts by scripts: sub-surfaces, shared axes and blades in the tree, locks, and the library's own figures."""

import json

import FreeCAD
import pytest
from freecad.toolaxis.document.children import frame_of
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.kinds import is_operation, operations_in, plan_of
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.document.sub_surface_shape import CLEAN_UP, SURFACE, is_shown
from freecad.toolaxis.services import api

import toolaxis as ta
from toolaxis.progress import NO_PROGRESS

TOOL = "ball:6"
LENGTHS = "CuttingLength", "Travel", "MachiningTime"


@pytest.fixture(scope="module")
def divided(whole_parts):
    """The roof in two sub-surfaces, and its plan as the library makes it of the same shape."""
    document = FreeCAD.newDocument("Divided")
    document.UndoMode = 1
    thing, name = whole_parts.roof(document)
    made = api.plan(document, (thing, name), TOOL, 0.4, regions=2, method="normal")
    theirs = ta.plan(thing, inputs_of(made[0]).assembled(), 0.4, faces=[int(name[4:])], regions=2,
                     method="normal", feedrate=made[0].FeedRate.Value * 60)
    yield made, theirs
    FreeCAD.closeDocument(document.Name)


@pytest.fixture(scope="module")
def bladed(whole_parts):
    """The wheel, with one blade planned and turned to the others."""
    document = FreeCAD.newDocument("Bladed")
    document.UndoMode = 1
    thing = whole_parts.wheel(document)
    made = api.plan(document, thing, regions=1, **whole_parts.BLADE_TOOL)
    yield thing, made
    FreeCAD.closeDocument(document.Name)


def shown(operation, what):
    return [thing for thing in operation.Group if is_shown(thing) and thing.Shows == what]


def links(plan):
    return [thing for group in plan.Group for thing in getattr(group, "Group", ()) if thing.TypeId == "App::Link"]


def test_the_figures_are_the_librarys(divided):
    made, theirs = divided
    assert [one.Outcome for one in made] == [op.orientation.outcome for op in theirs.operations]
    plan = plan_of(made[0])
    assert plan.CuttingLength.Value == pytest.approx(theirs.length, rel=1e-9)
    assert plan.Travel.Value == pytest.approx(theirs.travel, rel=1e-9)
    for ours, op in zip(made, theirs.operations, strict=True):
        assert tuple(ours.Axis) == pytest.approx(tuple(op.orientation.axis), abs=1e-9)
        assert ours.CuttingLength.Value == pytest.approx(op.orientation.length, rel=1e-9)
        area = sum(mesh.Mesh.Area for mesh in shown(ours, SURFACE))
        assert area == pytest.approx(op.face.area, rel=0.02), "the colour lies on the whole sub-surface"


def test_the_judge_takes_a_sub_surface_from_the_document(divided):
    made, theirs = divided
    verdict = api.verify(made[0])
    expected = ta.verify(theirs).operations[0]
    assert verdict.passed == expected.passed
    assert verdict.share_within == pytest.approx(expected.share_within, abs=0.02)


def test_one_sub_surface_is_planned_again_with_its_own_border(divided):
    made, _ = divided
    first, region = made[0], json.loads(made[0].Details)["region"]
    others, plan = [one.Name for one in made], plan_of(made[0])
    asked, figures = inputs_of(plan), [getattr(plan, name).Value for name in LENGTHS]
    again = api.recompute(first)
    assert again == [first] and json.loads(first.Details)["region"] == region
    assert [one.Name for one in operations_in(plan)] == others
    assert inputs_of(plan) == asked and plan.SubSurfaces == 2 and plan.Outcome == "complete"
    assert [getattr(plan, name).Value for name in LENGTHS] == pytest.approx(figures, rel=1e-9), "those of both"


def test_locks_are_kept_and_the_plan_is_planned_again_in_the_same_objects(divided):
    made, _ = divided
    plan = plan_of(made[0])
    made[1].AxisLocked, made[1].FeedLocked = True, True
    axis, feed = made[1].Axis, made[1].FeedParameter
    inputs = inputs_of(plan)
    assert [piece.locked for piece in inputs.pieces] == [False, True] and inputs.pieces[1].feed == feed
    again = api.recompute(plan)
    assert again == made and made[1].AxisLocked and not made[0].AxisLocked and not plan.Stale
    assert made[1].Axis.isEqual(axis, 1e-9) and made[1].FeedParameter == feed
    made[1].AxisLocked = made[1].FeedLocked = False
    assert not inputs_of(plan).pieces


def test_an_input_of_the_plan_that_is_changed_marks_it(divided):
    plan = plan_of(divided[0][0])
    plan.Scallop = 0.5
    plan.Document.recompute()
    assert plan.Stale and plan.StaleReasons == ["scallop was changed"]
    plan.Scallop = 0.4
    plan.Document.recompute()
    assert not plan.Stale


def taller(part):
    shape = part.Shape.copy()
    part.Shape = shape.transformGeometry(FreeCAD.Matrix(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.1, 0))


@pytest.mark.parametrize(("change", "reason"), [
    (lambda part, made: part.Document.removeObject(part.Name), "the part was deleted"),
    (lambda part, made: taller(part), "{0}, {1}: the part has changed"),
    (lambda part, made: part.Document.removeObject(made[1].Name), "{1}: deleted"),
    (lambda part, made: plan_of(made[0]).removeObject(made[1]), "{1}: taken out of the plan"),
    (lambda part, made: setattr(made[0], "Scallop", 0.3), "{0}: scallop was changed")])
def test_a_plan_says_what_became_of_its_part_and_its_operations(divided, change, reason):
    made, _ = divided
    part, plan, document = made[0].Faces[0][0], plan_of(made[0]), made[0].Document
    names, words = [one.Name for one in made], reason.format(*(one.Label for one in made))
    document.openTransaction("change")
    change(part, made)
    if "deleted" in reason and part.Name in [one.Name for one in document.Objects]:
        assert plan.Stale and list(plan.StaleReasons) == [words], "told at once"
    document.recompute()
    document.commitTransaction()
    assert plan.Stale and list(plan.StaleReasons) == [words]
    assert not [one.Name for one in document.Objects if "Invalid" in one.State]
    if reason == "the part was deleted":
        for act in (lambda: api.recompute(plan), lambda: api.split(made[0]), lambda: api.merge(made)):
            with pytest.raises(ta.InvalidInput, match="deleted"):
                act()
    document.undo()
    document.recompute()
    assert not plan.Stale and [one.Name for one in operations_in(plan)] == names
    assert all(mesh.ExpressionEngine for one in operations_in(plan) for mesh in shown(one, SURFACE)), "it follows again"
    divided[0][:] = operations_in(plan)


def test_faces_left_to_clean_up_are_told_apart_from_those_without_an_axis(divided):
    from dataclasses import replace

    from freecad.toolaxis.gui.plan.outcome import figures, left_to_clean_up, outcome_sentence

    from toolaxis.plan.zone import Zone

    _, plan = divided
    first, second = plan.operations
    without = replace(second, path=None)
    left = replace(without, zones=(Zone(second.face.outline, second.face.area),))
    third = replace(without, number=3)
    for operations, words, bad in (
            ((first, second), f"Every face has an axis. {figures(plan)} OK", False),
            ((first, left), "1 of 2 faces have an axis, 1 are left as rest material. ", False),
            ((first, without), "1 of 2 faces have an axis; the reasons", True),
            ((first, left, third), "1 of 3 faces have an axis, 1 are left as rest material, 1 have none;", True)):
        found = replace(plan, operations=operations)
        text, warns = outcome_sentence(found)
        assert text.startswith(words) and warns == bad
        assert left_to_clean_up(found) == {op.number for op in operations if op is left}


def test_the_headline_has_time_passes_step_over_and_axes_over_all(divided):
    from dataclasses import replace

    from freecad.toolaxis.gui.plan.outcome import figures, outcome_sentence
    from freecad.toolaxis.gui.widgets.quantity import length_text
    from freecad.toolaxis.services.time_left import clock

    _, plan = divided
    first, second = plan.operations
    count = first.orientation.passes + second.orientation.passes
    lengths = [op.orientation.length for op in plan.operations]
    widths = [op.orientation.average_strip_width for op in plan.operations]
    mean = sum(a * b for a, b in zip(lengths, widths, strict=True)) / sum(lengths)
    assert figures(plan) == (f"{clock(plan.seconds)}, passes: {count}, mean step-over {length_text(mean)}, "
                             f"orientations: {plan.orientations}.")
    half = replace(plan, operations=(first, replace(second, path=None)), outcome="cancelled")
    text, bad = outcome_sentence(half)
    assert text == f"Stopped with 1 finished. {figures(half)} OK puts what is finished into the document." and bad
    assert f"passes: {first.orientation.passes}," in text
    nothing = replace(half, operations=(replace(first, path=None), replace(second, path=None)))
    assert "OK" not in outcome_sentence(nothing)[0], "OK is locked then"


def test_other_blades_are_links_that_follow(bladed, tmp_path):
    thing, made = bladed
    plan = plan_of(made[0])
    assert plan.Outcome in ("complete", "incomplete") and len(plan.Group) == 3
    found = links(plan)
    done = [one for one in made if one.Outcome == "feasible"]
    assert done and len(found) == 2 * len(done)
    for link in found:
        source = link.LinkedObject
        assert is_operation(source) and plan_of(source) == plan
        turned = link.Placement.multiply(frame_of(source).Placement)
        assert turned.Rotation.multVec(FreeCAD.Vector(0, 0, 1)).isEqual(link.Axis, 1e-6)
        number = int(link.Face[4:])
        passes = next(one for one in source.Group if one.TypeId == "Path::Feature")
        end = passes.Path.Commands[len(passes.Path.Commands) // 2].Placement.Base
        place = link.Placement.multVec(passes.Placement.multVec(end))
        face = thing.Shape.Faces[number - 1]
        assert face.distToShape(FreecadVertex(place))[0] < 4.0, "the passes lie at the face that the link names"
    before = [link.Placement for link in found]
    motion = FreeCAD.Placement(FreeCAD.Vector(5, -3, 2), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    thing.Placement = motion
    thing.Document.recompute()
    for link, was in zip(found, before, strict=True):
        assert link.Placement.isSame(motion.multiply(was).multiply(motion.inverse()), 1e-7)
    thing.Placement = FreeCAD.Placement()
    thing.Document.recompute()
    names = sorted(one.Name for one in thing.Document.Objects)
    thing.Document.saveCopy(str(tmp_path / "Bladed.FCStd"))
    again = FreeCAD.openDocument(str(tmp_path / "Bladed.FCStd"))
    try:
        assert sorted(one.Name for one in again.Objects) == names
        assert not any(one.Stale for one in again.Objects if is_operation(one))
    finally:
        FreeCAD.closeDocument(again.Name)


def FreecadVertex(place):
    import Part as FreecadPart

    return FreecadPart.Vertex(place)


def test_one_undo_takes_blades_and_links(bladed):
    thing, made = bladed
    document = thing.Document
    names = sorted(one.Name for one in document.Objects)
    document.openTransaction("delete")
    document.removeObject(plan_of(made[0]).Name)
    document.commitTransaction()
    left = [one for one in document.Objects if one.TypeId == "App::Link" or is_operation(one) or is_shown(one)]
    assert not left, "what belongs to a plan goes with it"
    document.undo()
    assert sorted(one.Name for one in document.Objects) == names
    source = links(plan_of(document.getObject(made[0].Name)))[0].LinkedObject
    plan = plan_of(source)
    for gone in (source, links(plan)[0]):
        words = f"{gone.Label}: deleted"
        document.openTransaction("delete")
        document.removeObject(gone.Name)
        document.commitTransaction()
        assert all(one.LinkedObject is not None for one in document.Objects if one.TypeId == "App::Link")
        assert plan.Stale and list(plan.StaleReasons) == [words]
        document.undo()
        assert sorted(one.Name for one in document.Objects) == names and not plan.Stale
    document.recompute()
    document.openTransaction("delete")
    document.removeObject(thing.Name)
    document.recompute()
    document.commitTransaction()
    assert plan.Stale and list(plan.StaleReasons) == ["the part was deleted"]
    assert not [one.Name for one in document.Objects if "Invalid" in one.State]
    document.undo()
    document.recompute()
    assert all(one.ExpressionEngine for one in links(plan)), "they follow again"
    assert not plan.Stale and not [one for one in document.Objects if "Invalid" in one.State]


def test_clean_up_zones_are_hatched(document, whole_parts):
    """A zone drawn as lines: as long as its area over their pitch, and on the face."""
    from freecad.toolaxis.document.placement import chain_of
    from freecad.toolaxis.document.sub_surface_shape import show_surface

    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.zone import Zone

    thing, name = whole_parts.roof(document)
    inputs = JobInputs(((thing, name),))
    part, _ = ShapesRead.of(inputs).read(NO_PROGRESS)
    face = part.face(int(name[4:]))
    group = document.addObject("App::DocumentObjectGroupPython", "Group")
    op = Operation(1, face, None, Orientation(None), zones=(Zone(face.outline, face.area),))
    show_surface(group, op, chain_of(thing), (0.5, 0.5, 1.0))
    lines, = shown(group, CLEAN_UP)
    mesh, = shown(group, SURFACE)
    wires = lines.Shape.Wires
    assert len(wires) > 30
    length = sum(wire.Length for wire in wires[1:])
    assert length * face.diagonal / 60 == pytest.approx(face.area, rel=0.25)
    top = thing.Shape.Faces[int(name[4:]) - 1]
    assert top.distToShape(wires[len(wires) // 2])[0] < 0.01 * face.diagonal
    thing.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 7), FreeCAD.Rotation())
    document.recompute()
    assert lines.Placement.Base.z == mesh.Placement.Base.z == pytest.approx(7)
    show_surface(group, Operation(1, face, None, Orientation(None)), chain_of(thing), None)
    assert not group.Group


@pytest.mark.parametrize(("given", "words"), [
    ({"regions": 0}, "number of sub-surfaces is 0"), ({"orientations": 40}, "number of orientations is 40"),
    ({"method": "best"}, "method 'best' is unknown"), ({"regions": "some"}, "number of sub-surfaces is 'some'"),
    ({"orientations": 2, "method": "roman"}, "one axis for each sub-surface")])
def test_what_cannot_be_is_a_sentence_and_leaves_nothing(document, whole_parts, given, words):
    thing, name = whole_parts.roof(document)
    before = [one.Name for one in document.Objects]
    with pytest.raises(ta.InvalidInput, match=words):
        api.plan(document, (thing, name), TOOL, 0.4, **given)
    assert [one.Name for one in document.Objects] == before


def sub_surfaces(plan):
    return [one.Label.rsplit("Face", 1)[1] for one in operations_in(plan)]


def test_sub_surfaces_are_merged_split_and_drawn_by_hand(document, whole_parts):
    """Areas stay the face's, what was drawn is kept when the plan is made again, and each change is one undo step."""
    document.UndoMode = 1
    thing, name = whole_parts.roof(document)
    number, area = name[4:], thing.Shape.Faces[int(name[4:]) - 1].Area
    made = api.plan(document, (thing, name), TOOL, 0.4, method="normal")
    plan = plan_of(made[0])
    line = document.addObject("Part::Feature", "Line")
    line.Shape = polygon([(9, -2, 40), (12, 8, 40), (9, 18, 40)])
    names = {one.Name for one in document.Objects}

    def meshes():
        return sum(mesh.Mesh.Area for one in operations_in(plan) for mesh in shown(one, SURFACE))

    api.split(operations_in(plan)[0], line)
    assert sub_surfaces(plan) == [f"{number}a", f"{number}b"] and meshes() == pytest.approx(area, rel=0.02)
    assert all(one.DrawnByHand for one in operations_in(plan))
    left, right = operations_in(plan)
    borders = [json.loads(one.Details)["region"] for one in (left, right)]
    api.recompute(plan)
    assert [json.loads(one.Details)["region"] for one in operations_in(plan)] == borders
    document.undo()
    document.undo()
    assert {one.Name for one in document.Objects} == names
    document.redo()
    document.redo()
    line.Shape = polygon([(6, 4, 40), (20, 4, 40), (20, 12, 40), (6, 12, 40), (6, 4, 40)])
    api.split(operations_in(plan)[0], line)
    assert len(sub_surfaces(plan)) == 3 and meshes() == pytest.approx(area, rel=0.02)
    api.merge(operations_in(plan))
    assert sub_surfaces(plan) == [number] and operations_in(plan)[0].DrawnByHand
    api.split(operations_in(plan)[0])
    assert len(sub_surfaces(plan)) == 2
    for wrong, words in ((lambda: api.merge(operations_in(plan)[:1]), "two or more of one face"),
                         (lambda: api.split(operations_in(plan)[0], thing), "separate lines")):
        before = {one.Name for one in document.Objects}
        with pytest.raises(ta.InvalidInput, match=words):
            wrong()
        assert {one.Name for one in document.Objects} == before


def polygon(points):
    import Part as FreecadPart

    return FreecadPart.makePolygon([FreeCAD.Vector(*point) for point in points])
