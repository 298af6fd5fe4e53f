"""A part in two setups: the second plan of a document takes what the first one leaves, and knows when that changes."""

import json
from shutil import copyfile

import FreeCAD
import pytest
from freecad.toolaxis.document.earlier_setups import setups_to_follow, setups_up_to
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.kinds import is_plan, operations_in, plan_of
from freecad.toolaxis.document.plan_account import account_from
from freecad.toolaxis.services import api
from freecad.toolaxis.services.export import export
from freecad.toolaxis.services.macros import again_lines, plan_line

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan

ASKED = {"tool": "torus:6x1", "stickout": 30.0, "holder": ((8.0, 0.0), (8.0, 30.0)), "scallop": 0.3}
#: Sides that are clamped in the two setups: what is beside the first is free in the second.
FIRST, SECOND = "x<10", "x>27"


@pytest.fixture(scope="module")
def saved(whole_parts, tmp_path_factory):
    """A document with both setups, and the names of its part, the face, and the whole plans."""
    document = FreeCAD.newDocument("Both")
    thing, name = whole_parts.roof(document)
    first = plan_of(api.plan(document, (thing, name), held=FIRST, **ASKED)[0])
    second = plan_of(api.plan(document, thing, held=SECOND, after=first, **ASKED)[0])
    path = str(tmp_path_factory.mktemp("setups") / "Both.FCStd")
    names = thing.Name, name, first.Name, second.Name
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    return path, names


def opened(saved, path):
    """A copy of the document under a path, with its part, the face, and the whole plans."""
    source, (thing, name, *plans) = saved
    copyfile(source, path)
    document = FreeCAD.openDocument(str(path))
    document.UndoMode = 1
    first, second = map(document.getObject, plans)
    return (document.getObject(thing), name), first, second


@pytest.fixture
def setups(saved, tmp_path):
    """Both setups, to be changed."""
    found = opened(saved, tmp_path / "Changed.FCStd")
    name = found[1].Document.Name
    yield found
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


@pytest.fixture(scope="module")
def kept(saved, tmp_path_factory):
    """Both setups, for all that change nothing."""
    found = opened(saved, tmp_path_factory.mktemp("setups") / "Kept.FCStd")
    yield found
    FreeCAD.closeDocument(found[1].Document.Name)


def exported(plan, folder):
    """The plan that is written of a whole plan, and the words of its part."""
    export(operations_in(plan), folder)
    words = json.loads((folder / "plan.json").read_text())["part"]
    return read_plan(folder), words


def test_the_second_takes_what_the_first_leaves(kept, tmp_path):
    (thing, name), first, second = kept
    assert is_plan(first) and is_plan(second), "with one face and one tool too"
    assert second.After == first and first.After is None
    assert not any("After" in one.PropertiesList for one in operations_in(second))
    assert inputs_of(second).faces == ((thing, name),) and not first.Stale and not second.Stale
    one, told = exported(first, tmp_path / "one")
    two, words = exported(second, tmp_path / "two")
    whole = one.part.face(int(name[4:])).area
    assert told["machined_before"] == [] and told["held"][0]["area"] == pytest.approx(one.held[0].area)
    (row,) = words["machined_before"]
    assert row["area"] == pytest.approx(one.account.machined, rel=1e-3) and not row["whole"]
    for plan in (one, two):
        areas = sum(share.area for share in (*plan.held, *plan.machined_before))
        assert plan.account.area + areas == pytest.approx(whole, rel=1e-4), "areas add up"
        verdict = ta.verify(plan)
        assert verdict.passed, verdict.reasons
    assert one.account.machined + two.account.machined > 0.98 * whole
    api.verify(operations_in(second)[0])
    assert operations_in(second)[0].Verdict == "passed"


def test_it_is_saved_opened_and_planned_again(setups, tmp_path):
    document = setups[0][0].Document
    path = str(tmp_path / "Two.FCStd")
    names = [plan.Name for plan in setups[1:]]
    document.saveAs(path)
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(path)
    try:
        first, second = map(again.getObject, names)
        again.recompute()
        assert second.After == first and not first.Stale and not second.Stale, list(second.StaleReasons)
        area = sum(one.MachiningTime.Value for one in operations_in(second))
        assert api.planned_with(operations_in(second)[0]) == second
        made = api.recompute(operations_in(second)[0])
        assert plan_of(made[0]) == second and not second.Stale
        assert sum(one.MachiningTime.Value for one in made) == pytest.approx(area)
    finally:
        FreeCAD.closeDocument(again.Name)


def test_it_is_out_of_date_when_the_first_is_changed_and_holds_again_after_undo(setups):
    _, first, second = setups
    document = first.Document
    first.Held = "x<12"
    document.recompute()
    assert first.Stale and second.Stale
    assert list(second.StaleReasons) == [f"the earlier setup {first.Label} is out of date"]
    with pytest.raises(InvalidInput, match=r"the earlier setup 'Plan' is out of date \(held was changed\)"):
        api.recompute(second)
    api.recompute(first)
    assert not first.Stale and list(second.StaleReasons) == ["the earlier setup Plan was planned again"]
    assert "Touched" not in second.State
    with pytest.raises(InvalidInput, match=r"is out of date \(the earlier setup Plan was planned again\)"):
        export(operations_in(second), "never")
    document.undo()
    assert list(second.StaleReasons) == ["the earlier setup Plan is out of date"]
    first.Held = FIRST
    document.recompute()
    assert not first.Stale and not second.Stale


def test_planned_again_to_the_same_it_still_holds(setups):
    _, first, second = setups
    api.recompute(first)
    first.Document.recompute()
    assert not second.Stale, list(second.StaleReasons)


def test_the_first_is_deleted(setups):
    _, first, second = setups
    document = first.Document
    document.openTransaction("Delete")
    document.removeObject(first.Name)
    document.commitTransaction()
    assert second.Stale and list(second.StaleReasons) == ["the earlier setup was deleted"]
    document.recompute()
    assert second.Stale and second.After is None and list(second.StaleReasons) == ["the earlier setup was deleted"]
    document.undo()
    document.recompute()
    assert second.After is not None and not second.Stale, list(second.StaleReasons)


def test_another_choice_is_told(setups):
    _, first, second = setups
    second.After = None
    first.Document.recompute()
    assert list(second.StaleReasons) == ["another earlier setup was chosen"]


def test_a_third_setup_comes_after_both(kept, whole_parts):
    (thing, _), first, second = kept
    with pytest.raises(InvalidInput, match="nothing is left to plan"):
        api.plan(thing.Document, thing, after=operations_in(second)[0], **ASKED)
    assert setups_up_to(second) == [first, second]
    assert setups_to_follow(thing.Document, thing) == [first, second]
    assert setups_to_follow(thing.Document, thing, first) == [], "neither itself nor what follows it"
    other, _ = whole_parts.roof(thing.Document, "Other")
    assert setups_to_follow(thing.Document, other) == []


def test_the_macro_plans_the_same(kept):
    (thing, name), first, second = kept
    line = plan_line(inputs_of(second))
    assert f"after='{first.Name}'" in line and f"'{thing.Name}.{name}'" in line
    before = inputs_of(first)
    assert any(line.endswith(f".After = FreeCAD.ActiveDocument.getObject('{first.Name}')")
               for line in again_lines(second, before, inputs_of(second)))


def test_an_operation_that_stands_alone_can_be_followed(document, whole_parts):
    thing, name = whole_parts.roof(document)
    (made,) = api.plan(document, (thing, name), limits="cone:0,0,1,5", **ASKED)
    assert plan_of(made) is None
    with pytest.raises(InvalidInput, match="nothing is left to plan"):
        api.plan(document, thing, after=made, **ASKED)


def test_faces_that_lie_in_the_clamped_side_as_a_whole_are_left_for_the_next(document, whole_parts, tmp_path):
    """Found: with one tool nothing told of them in the document, and the second setup did not know of them."""
    thing, name = whole_parts.roof(document)
    side = max(range(len(thing.Shape.Faces)), key=lambda k: thing.Shape.Faces[k].CenterOfMass.x)
    faces = (thing, name), (thing, f"Face{side + 1}")
    first = plan_of(api.plan(document, list(faces), held="x>27", limits="cone:0,0,1,30", **ASKED)[0])
    assert first is not None
    one, _ = exported(first, tmp_path / "one")
    assert side + 1 in {share.face for share in one.held if share.whole}
    made = api.plan(document, list(faces), held="x<3", after=first, limits="cone:1,0,0,60", **ASKED)
    assert f"Face{side + 1}" in {one.Faces[0][1][0] for one in made}


@pytest.mark.parametrize(("given", "words"), [
    ({"after": 7}, "after is 7"), ({"after": "nobody"}, "'nobody', which is no object"),
    ({"after": "Roof"}, "which is none of Tool Axis")])
def test_what_does_not_go_together_is_refused(kept, given, words):
    (thing, _), first, _ = kept
    with pytest.raises(InvalidInput, match=words):
        api.plan(thing.Document, thing, **{"after": first, **ASKED, **given})


def test_other_faces_and_other_parts_are_refused(kept, whole_parts):
    (thing, name), first, second = kept
    other, _ = whole_parts.roof(thing.Document, "Other")
    with pytest.raises(InvalidInput, match="is one of another part"):
        api.plan(thing.Document, other, after=first, **ASKED)
    with pytest.raises(InvalidInput, match="give the part alone"):
        api.plan(thing.Document, (thing, "Face1" if name != "Face1" else "Face2"), after=first, **ASKED)
    with pytest.raises(InvalidInput, match="'blade' does not go with earlier setups"):
        JobInputs(tool="ball:6", strategy="blade", after=first).check_tools()
    operations_in(second)[0].AxisLocked = True
    with pytest.raises(InvalidInput, match="locked or drawn by hand do not go with an earlier setup"):
        api.recompute(second)
    operations_in(second)[0].AxisLocked = False


def test_what_is_given_is_one_value(kept):
    (thing, name), first, _ = kept
    assert JobInputs(((thing, "Face99"),), after=first).faces == ((thing, name),)


def test_a_skin_that_is_clamped_as_a_whole_is_one_skin_in_the_next_setup(document, whole_parts, tmp_path):
    """With a rack; found: nothing in the document told of skins that lie in no operation."""
    rack = tmp_path / "rack.toml"
    rack.write_text(whole_parts.RACK, encoding="utf-8")
    thing = whole_parts.three_patches(document)
    asked = {"rack": str(rack), "scallop": 0.3}
    first = plan_of(api.plan(document, thing, held="x<34", **asked)[0])
    one, told = exported(first, tmp_path / "one")
    assert (1, 2) in [face.numbers for face in one.part.faces]
    assert {share["face"] for share in told["held"] if share["whole"]} == {1}
    made = api.plan(document, thing, held="x>38", after=first, **asked)
    second = plan_of(made[0])
    assert {tuple(json.loads(one.Details)["members"]) for one in made if one.Motions} == {(1, 2)}
    two, words = exported(second, tmp_path / "two")
    assert account_from(second.Account).machined_before == pytest.approx(one.account.machined, rel=1e-3)
    assert sum(row["area"] for row in words["machined_before"]) == pytest.approx(one.account.machined, rel=1e-3)
    for plan in (one, two):
        verdict = ta.verify(plan)
        assert verdict.passed, verdict.reasons


def test_a_copy_leaves_the_earlier_setup_alone(setups):
    (thing, _), first, second = setups
    document = thing.Document
    before = [one.Name for one in operations_in(first)]
    document.copyObject(second, True)
    (copied,) = [one for one in document.Objects if is_plan(one) and one not in (first, second)]
    document.recompute()
    assert copied.After == first and copied.Stale, "what is in it belongs to other operations"
    assert not second.Stale and not first.Stale
    assert [one.Name for one in operations_in(first)] == before
