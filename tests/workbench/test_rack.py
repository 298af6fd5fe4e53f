"""Parts planned with a rack by scripts: what stands in the document, and what is written out of it again."""

import json
from dataclasses import replace

import FreeCAD
import pytest
from freecad.toolaxis.cam.jobs import make_jobs
from freecad.toolaxis.document.cam_probe import tool_libraries
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.kinds import operations_in, plan_of
from freecad.toolaxis.document.plan_account import account_from, account_of
from freecad.toolaxis.services import api
from freecad.toolaxis.services.export import export

from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.progress import Progress

SCALLOP = 0.1
ASKED = {"stock": 0.3, "greatest_step_over": 5.0, "lead": 0.5, "least_lean": 2.0, "held": "z<-8", "most_tools": 2}


@pytest.fixture(scope="module")
def rack(whole_parts, tmp_path_factory):
    path = tmp_path_factory.mktemp("rack") / "my-rack.toml"
    path.write_text(whole_parts.RACK, encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def planned(whole_parts, rack):
    """The grooved block planned with the rack, and the plan as the library made it."""
    document = FreeCAD.newDocument("Rack")
    document.UndoMode = 1
    face, kept, task = whole_parts.grooved(document), [], api.task

    def keeping(inputs):
        compute = task(inputs)
        return lambda progress: kept.append(compute(progress)) or kept[-1]

    api.task = keeping
    try:
        made = api.plan(document, face, scallop=SCALLOP, rack=rack, **ASKED)
    finally:
        api.task = task
    yield made, kept[0]
    FreeCAD.closeDocument(document.Name)


def test_each_operation_has_its_own_tool(planned):
    made, theirs = planned
    assert len(theirs.used_tools) == 2 and len(made) == len(theirs.operations)
    for one, op in zip(made, theirs.operations, strict=True):
        found = inputs_of(one)
        again = found.assembled()
        assert not found.rack and (again.number, again.shop_name) == (op.tool.number, op.tool.shop_name)
        assert again.name == op.tool.name and again.outlines.keys() == op.tool.outlines.keys()
        assert found.feedrate == pytest.approx(op.tool.feedrate) and found.spindle == op.tool.spindle
        assert {name: getattr(found, name) for name in ASKED if name != "most_tools"} == {
            name: value for name, value in ASKED.items() if name != "most_tools"}


def test_the_plan_tells_what_is_machined_and_what_was_asked(planned, rack):
    made, theirs = planned
    plan, account = plan_of(made[0]), theirs.account
    found = account_from(plan.Account)
    assert (found.area, found.machined, found.unreachable, found.open) == (
        account.area, account.machined, account.unreachable, account.open)
    assert plan.Machined.Value == pytest.approx(account.machined) and plan.NotBegun.Value == 0
    assert found.seconds == pytest.approx(theirs.seconds) and found.between > 0
    assert found.between + sum(one.seconds for one in found.tools) == pytest.approx(found.seconds)
    asked = inputs_of(plan)
    assert asked.rack == (rack,) and {name: getattr(asked, name) for name in ASKED} == ASKED
    assert api.planned_with(made[0]) == plan and not plan.Stale


def test_tools_that_machine_nothing_take_no_colour(planned):
    """Found: the second and the ninth tool of a rack had one colour."""
    _, theirs = planned
    last = theirs.tools[-1]
    more = tuple(replace(last, number=20 + k, title=f"in the rack alone {k}") for k in range(8))
    account = account_of(replace(theirs, tools=(theirs.tools[0], *more, *theirs.tools[1:])))
    assert [one.place for one in account.tools] == [0, 1] and account.offered == len(theirs.tools) + 8


def test_the_library_reads_the_same_plan_from_the_folder(planned, tmp_path):
    made, theirs = planned
    export(made, tmp_path / "out")
    again = read_plan(tmp_path / "out")
    assert again.account.machined == pytest.approx(theirs.account.machined)
    assert again.account.open == pytest.approx(theirs.account.open, abs=1e-6)
    assert again.account.area == pytest.approx(theirs.account.area)
    assert [op.rest_of for op in again.operations] == [op.rest_of for op in theirs.operations]
    assert [op.tool.number for op in again.operations] == [op.tool.number for op in theirs.operations]
    assert again.outcome == theirs.outcome and again.part.stock == theirs.part.stock
    assert again.held == theirs.held and again.seconds == pytest.approx(theirs.seconds)
    assert again.inputs.tolerance == theirs.inputs.tolerance and again.inputs.lead == theirs.inputs.lead


def test_an_operation_alone_is_written_too_and_judged(planned, tmp_path):
    made, _ = planned
    last = next(one for one in reversed(made) if one.Motions)
    before = last.Details
    last.Details = json.dumps(json.loads(before) | {"rest_of": [1]})
    try:
        export(made, tmp_path / "all")
        assert read_plan(tmp_path / "all").operations[made.index(last)].rest_of == (1,)
        export(last, tmp_path / "out")
        again = read_plan(tmp_path / "out")
        assert [op.rest_of for op in again.operations] == [()], "what left it is not written"
    finally:
        last.Details = before
    api.verify(last)
    assert last.Verdict == "passed", list(last.VerdictReasons)


def test_jobs_have_the_numbers_of_the_magazine(planned):
    made, _ = planned
    document = made[0].Document
    jobs = make_jobs(document, [one for one in made if one.Motions])
    numbers = {(controller.ToolNumber, controller.Label.removeprefix("TC: ").rstrip("0123456789") or controller.Label)
               for job in jobs for controller in job.Tools.Group}
    assert {number for number, _ in numbers} == {1, 7}
    document.undo()


def test_what_is_finished_is_kept_when_it_is_stopped(whole_parts, rack, tmp_path):
    document = FreeCAD.newDocument("Stopped")
    face, seen = whole_parts.grooved(document), []
    progress = Progress(lambda stage, *_: seen.append(stage), lambda: any("D6" in stage for stage in seen), None)
    made = api.plan(document, face, scallop=SCALLOP, rack=rack, progress=progress)
    plan = plan_of(made[0])
    assert plan.Outcome == "cancelled" and plan.Machined.Value > 0 and plan.NotBegun.Value > 0
    assert {one.ToolNumber for one in operations_in(plan)} == {1}
    export(made, tmp_path / "out")
    again = read_plan(tmp_path / "out")
    assert again.outcome == "cancelled" and again.account.not_begun == pytest.approx(plan.NotBegun.Value)
    FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize(("given", "words"), [
    ({"rack": 7}, "rack is 7"), ({"rack": "nobody"}, "'nobody'"), ({"rack": []}, "is empty"),
    ({"most_tools": 0}, "most_tools is 0"), ({"regions": 2}, "name one tool"), ({"stock": 0.1, "allowance": 0.2},
                                                                             "stock is 0.1 mm")])
def test_what_cannot_be_planned_with_a_rack_is_refused(planned, rack, given, words):
    thing, (name,) = planned[0][0].Faces[0]
    with pytest.raises(InvalidInput, match=words.replace("(", r"\(")):
        api.plan(thing.Document, (thing, name), **{"rack": rack, "scallop": SCALLOP, **given})


def test_freecads_own_library_can_be_a_rack():
    found = dict(tool_libraries())
    if not found:
        pytest.skip("this FreeCAD has no tool libraries in files")
    tools = JobInputs(rack=(next(iter(found.values())),), feedrate=700.0).tools()
    assert tools and all(tool.number and tool.feedrate == 700.0 for tool in tools)
    alone = JobInputs().with_tool(tools[0])
    assert alone.stickout == 0.0 and alone.assembled().name == tools[0].name and alone.tool_number == tools[0].number
    assert alone.assembled().outlines.keys() == tools[0].outlines.keys()
