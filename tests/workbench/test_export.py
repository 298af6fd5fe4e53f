"""Operations of a document as the files that the command writes: the same bytes, whole or not at all."""

import json

import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.services.export import Wish, export
from freecad.toolaxis.services.write_results import apply

import toolaxis as ta
from toolaxis.cad.machines import load_machine
from toolaxis.errors import InvalidInput, MissingBackend
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.machine.setup import Mounting

OFFSET = (0.0, 0.0, 60.0)
MACHINE = "bc-table-table"


@pytest.fixture
def made(document, parts):
    """Two blocks, an operation on each, and the plan that they came from."""
    first, second = parts.block(document, "First"), parts.block(document, "Second")
    second.Placement = Placement(Vector(0, 60, 0), Rotation(Vector(0, 0, 1), 20))
    document.recompute()
    name = parts.sculptured_name(first)
    inputs = parts.inputs_for((first, name), (second, name))
    plan = parts.quick_plan(inputs)
    return apply(document, inputs, plan), plan


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_folder_is_the_commands(made, tmp_path):
    operations, plan = made
    names = export(operations, tmp_path / "plan")
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    write_plan(plan, theirs)
    ours, theirs = files(tmp_path / "plan"), files(theirs)
    assert sorted(ours) == names == sorted(theirs)
    for name in theirs:
        if name != "plan.json":
            assert ours[name] == theirs[name], name
    one, other = (json.loads(found["plan.json"]) for found in (ours, theirs))
    for mine, their in zip(one.pop("operations"), other.pop("operations"), strict=True):
        for key in ("name", "face", "label", "kind", "cl_file", "points", "region"):
            assert mine[key] == their[key], key
        for key in ("area", "travel", "seconds"):
            assert mine[key] == pytest.approx(their[key], rel=1e-9), key
        assert mine["orientation"]["length"] == their["orientation"]["length"]
    for key in ("area", "machined", "open", "length", "bound", "gap"):
        assert one["part"].pop(key) == pytest.approx(other["part"].pop(key), rel=1e-9, abs=1e-9), key
    assert {key: one[key] for key in ("units", "tools", "inputs", "outcome", "not_checked", "part")} == {
        key: other[key] for key in ("units", "tools", "inputs", "outcome", "not_checked", "part")}
    back = read_plan(tmp_path / "plan")
    assert ta.verify(back).passed


@pytest.mark.parametrize("dialect", ["linuxcnc", "heidenhain"])
def test_a_program_has_the_commands_bytes(made, tmp_path, dialect):
    operations, plan = made
    export(operations, tmp_path / "plan", Wish(dialect, MACHINE, OFFSET))
    mounting = Mounting(load_machine(MACHINE), OFFSET, plan.tools[0].gauge_length)
    theirs = post_plan(plan, dialect, mounting, name="plan", verdict="not verified yet: run toolaxis verify")
    ours = files(tmp_path / "plan")
    for name, text in theirs.items():
        assert ours[name].decode() == text, name


def test_the_page_is_written_or_it_is_said_what_is_missing(made, tmp_path):
    operations, _ = made
    folder = tmp_path / "plan"
    try:
        names = export(operations[0], folder, Wish(report=True))
    except MissingBackend as reason:
        assert "pip install" in str(reason) and not folder.exists()
    else:
        assert "report.html" in names and b"op01" in (folder / "report.html").read_bytes()


def test_what_cannot_be_written_leaves_the_folder_as_it_was(made, tmp_path):
    operations, _ = made
    folder = tmp_path / "plan"
    export(operations, folder)
    (folder / "mine.txt").write_text("stays")
    before = files(folder)
    with pytest.raises(InvalidInput, match="names no machine"):
        export(operations, folder, Wish("linuxcnc"))
    with pytest.raises(InvalidInput, match="dialect 'basic' is unknown"):
        export(operations, folder, Wish("basic", MACHINE))
    operations[1].FeedRate = 5
    with pytest.raises(InvalidInput, match="is out of date"):
        export(operations, folder)
    assert files(folder) == before
    export(operations[0], folder)
    assert (folder / "mine.txt").read_text() == "stays" and not (folder / "op02-face12.apt").exists()


def test_operations_that_do_not_go_together_are_refused(document, parts, tmp_path):
    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    made = [parts.planned(document, (thing, name), allowance=value)[0] for value in (0.0, 0.1)]
    with pytest.raises(InvalidInput, match="different allowances: select those that go together"):
        export(made, tmp_path / "plan")
    assert not list(tmp_path.iterdir())
