"""Documents that the add-on saved in earlier versions: they open, and go on as if made today.

before-divisions was saved by commit 1816a7b in FreeCAD 1.1 and 1.0: a block with one operation on its wavy face.
before-moving-axes (5d17646) and before-raised-surfaces (78fcea3) were saved from the window of FreeCAD 1.1: a roof in
two sub-surfaces, one locked, beside a clamp, on a machine, with a job of the second; the later one also has a block
whose axis moves.  before-layers was saved by commit 3c371f0, from the window of FreeCAD 1.1 and in 1.0 without one: a
block with one operation, and two more in a plan, the first of them locked, on a machine.
"""

import re
import shutil
import sys
import zipfile
from importlib import import_module
from pathlib import Path

import FreeCAD
import freecad.toolaxis
import pytest
from freecad.toolaxis.cam.jobs import make_jobs
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kinds import is_operation, is_plan, operations_in
from freecad.toolaxis.document.machine import machine_of
from freecad.toolaxis.document.operation import OperationProxy
from freecad.toolaxis.document.passes import moves
from freecad.toolaxis.document.plan_group import WholePlan
from freecad.toolaxis.document.strategies import STRATEGIES
from freecad.toolaxis.saved_names import TODAY
from freecad.toolaxis.services import api
from freecad.toolaxis.services.export import Wish, export, plan_task
from freecad.toolaxis.services.write_results import child

from toolaxis.progress import NO_PROGRESS

SAVED = Path(__file__).with_name("saved")
NEWER = FreeCAD.Version()[:2] >= ["1", "1"]
#: Passes are the same, and their points other ones on them: chords that are shorter or longer differ in length by this.
CHORDS = 2e-6
#: A newer FreeCAD opens both, an older one its own.
FILES = ["before-divisions-1.0.FCStd", *(["before-divisions.FCStd"] if NEWER else [])]


@pytest.fixture(params=FILES)
def opened(request, tmp_path):
    shutil.copy(SAVED / request.param, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / request.param))
    yield document
    FreeCAD.closeDocument(document.Name)


@pytest.fixture
def operation(opened):
    return next(thing for thing in opened.Objects if is_operation(thing))


def test_it_opens_as_it_was_saved(opened, operation, parts):
    """Results are those of that time and nothing is stale; what came later is there with its plain value."""
    assert operation.Outcome == "feasible" and not operation.Stale and not api.is_stale(operation)
    assert operation.Axis.getAngle(parts.LEANING) < 1e-9
    assert operation.Passes == 5 and len(moves(child(operation, "Path::Feature"))[0]) > 100
    fresh = parts.planned(opened, (opened.getObject("Block"), parts.sculptured_name(opened.getObject("Block"))))[0]
    assert set(fresh.PropertiesList) == set(operation.PropertiesList)
    opened.recompute(None, True)
    assert not operation.Stale, operation.StaleReasons


def test_it_is_verified_and_planned_again(opened, operation, parts):
    assert api.verify(operation).passed
    inputs = inputs_of(operation)
    assert (inputs.tool, inputs.scallop, inputs.holder) == (parts.TOOL, parts.SCALLOP, parts.HOLDER)
    again = parts.planned(opened, *inputs.faces, tolerance=inputs.tolerance)[0]
    assert again.Passes == operation.Passes
    assert again.CuttingLength.Value == pytest.approx(operation.CuttingLength.Value, rel=CHORDS)


def test_it_keeps_the_machining_tolerance_that_held_then(opened, operation, parts):
    """0.002 mm, in the tree as in what it is verified and planned again with; a new operation takes 0.01 mm."""
    thing = opened.getObject("Block")
    assert operation.Tolerance.Value == 0.002 and inputs_of(operation).job().tolerance.gouge == 0.002
    api.verify(operation)
    assert operation.GougeAllowed.Value == 0.002
    fresh = parts.planned(opened, (thing, parts.sculptured_name(thing)))[0]
    assert fresh.Tolerance.Value == 0.01
    operation.Tolerance = 0.01
    opened.recompute()
    assert operation.Stale and operation.StaleReasons == ["tolerance was changed"] and not fresh.Stale
    operation.Tolerance = 0.002
    opened.recompute()
    assert not operation.Stale


def test_it_offers_the_strategies_that_came_later(opened, operation, tmp_path):
    """An operation saved by a version that knew two of them keeps its own, and takes all others."""
    operation.Strategy = ["sturz", "indexed"]
    operation.Strategy = "indexed"
    name = operation.Name
    opened.saveAs(str(tmp_path / "fewer.FCStd"))
    again = FreeCAD.openDocument(str(shutil.copy(tmp_path / "fewer.FCStd", tmp_path / "again.FCStd")))
    found = again.getObject(name)
    assert found.getEnumerationsOfProperty("Strategy") == list(STRATEGIES) and found.Strategy == "indexed"
    assert not found.Stale and not api.is_stale(found)
    found.Strategy = "multiscale"
    assert inputs_of(found).strategy == "multiscale"
    FreeCAD.closeDocument(again.Name)


@pytest.fixture(params=["before-moving-axes.FCStd", "before-raised-surfaces.FCStd"])
def whole(request, tmp_path):
    """A document with a whole plan, and whether it knew axes that move."""
    if not NEWER:
        pytest.skip("an older FreeCAD opens its own documents")
    shutil.copy(SAVED / request.param, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / request.param))
    yield document, "raised" in request.param
    FreeCAD.closeDocument(document.Name)


def test_a_whole_plan_opens_and_goes_on(whole):
    """What it lacks gets its plain value, nothing is stale, all can be written, and planned again it is the same."""
    document, moving = whole
    plan = next(filter(is_plan, document.Objects))
    operations = list(filter(is_operation, document.Objects))
    assert len(operations) == 2 + moving and operations_in(plan) == operations[:2]
    for _ in range(2):
        assert not any(one.Stale for one in (plan, *operations)), [one.StaleReasons for one in (plan, *operations)]
        document.recompute(None, True)
    assert {one.name for one in OperationProxy.properties} <= set(operations[0].PropertiesList)
    assert {one.name for one in WholePlan.properties} <= set(plan.PropertiesList)
    assert [one.Strategy for one in operations] == ["indexed", "indexed", "sturz"][:2 + moving]
    assert [one.AxisLocked for one in operations[:2]] == [True, False] and machine_of(document).Offset.z == 20
    assert all(plan_task([one])(NO_PROGRESS).operations[0].path.passes == one.Passes for one in operations)
    before = [(one.Name, one.Passes, one.CuttingLength.Value) for one in operations[:2]]
    assert plan.Tolerance.Value == 0.002 and {one.Tolerance.Value for one in operations} == {0.002}
    assert [(one.Name, one.Passes, pytest.approx(one.CuttingLength.Value, rel=CHORDS))
            for one in api.recompute(plan)] == before and {one.Tolerance.Value for one in operations} == {0.002}
    assert not plan.Stale and not any(one.Stale for one in operations)
    jobs = [thing.Name for thing in document.Objects if hasattr(thing, "PostProcessor")]
    assert len(jobs) == 1 and len(make_jobs(document, operations[:2])) == 2
    document.removeObject(operations[1].Name)
    document.recompute()
    assert plan.Stale and "deleted" in plan.StaleReasons[0]


#: Where FreeCAD keeps the module and the class of an object's Python, in Document.xml and GuiDocument.xml.
PYTHON = re.compile(r'module="(freecad\.toolaxis[\w.]*)" class="(\w+)"')


def python_in(path):
    """The pairs of module and class that a saved document names of ours."""
    with zipfile.ZipFile(path) as saved:
        texts = [saved.read(name).decode() for name in saved.namelist() if name.endswith("Document.xml")]
    return {pair for text in texts for pair in PYTHON.findall(text)}


def test_every_name_that_was_ever_saved_is_known():
    """All are in the documents here, and stand for classes of today; those of views are imported with a window."""
    saved = set().union(*map(python_in, SAVED.glob("*.FCStd")))
    former = {f"freecad.toolaxis.{name}" for name in TODAY if "." in name}
    assert {module for module, _ in saved} == former
    for module, kind in saved:
        if FreeCAD.GuiUp or ".views." not in module:
            today = f"freecad.toolaxis.{TODAY[module.removeprefix('freecad.toolaxis.')]}"
            assert getattr(import_module(module), kind).__module__ == today


def test_files_left_over_from_a_former_package_hide_nothing(tmp_path, monkeypatch):
    (tmp_path / "objects").mkdir()
    for name in ("__init__.py", "operation.py"):
        (tmp_path / "objects" / name).write_text("from ..inputs import nothing_any_more\n")
    monkeypatch.setattr(freecad.toolaxis, "__path__", [str(tmp_path), *freecad.toolaxis.__path__])
    for name in [name for name in sys.modules if name.startswith("freecad.toolaxis.objects")]:
        monkeypatch.delitem(sys.modules, name)
    assert import_module("freecad.toolaxis.objects.operation").Operation is OperationProxy
    with pytest.raises(ModuleNotFoundError):
        import_module("freecad.toolaxis.objects.nothing")


def test_macros_of_earlier_versions_find_what_they_call():
    macro = "import freecad.toolaxis.exporting\nmade = freecad.toolaxis.exporting.Wish(dialect='linuxcnc')"
    names = {}
    exec(macro, names)
    assert names["made"] == Wish(dialect="linuxcnc") and freecad.toolaxis.exporting.export is export


@pytest.fixture(params=["before-layers-1.0.FCStd", *(["before-layers.FCStd"] if NEWER else [])])
def layers(request, tmp_path):
    """A document with every kind of object of ours, saved when their classes stood elsewhere."""
    shutil.copy(SAVED / request.param, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / request.param))
    yield document
    FreeCAD.closeDocument(document.Name)


def test_all_kinds_of_objects_open_and_go_on(layers, parts, tmp_path):
    """Their proxies are of today's classes and work, and saved again they have today's names."""
    kinds = {thing: getattr(getattr(thing, "Proxy", None), "Type", "") for thing in layers.Objects}
    ours = [thing for thing, kind in kinds.items() if kind.startswith("ToolAxis")]
    assert sorted(type(thing.Proxy).__name__ for thing in ours) == [
        "MachineProxy", *["OperationProxy"] * 3, *["ToolOnPasses"] * 3, "WholePlan"]
    operations, plan = list(filter(is_operation, ours)), next(filter(is_plan, ours))
    assert operations_in(plan) == operations[1:] and machine_of(layers).Offset.z == 20
    layers.recompute(None, True)
    assert not any(one.Stale for one in (plan, *operations)), [one.StaleReasons for one in (plan, *operations)]
    assert [one.AxisLocked for one in operations] == [False, True, False]
    before = [(one.Passes, one.CuttingLength.Value) for one in operations]
    assert all(passes > 3 for passes, _ in before)
    assert api.verify(operations[0]).passed
    tool = child(operations[0], "Part::FeaturePython")
    place = tool.Placement.Base
    tool.Position = 0.4
    layers.recompute()
    assert tool.Placement.Base.distanceToPoint(place) > 1
    layers.saveAs(str(tmp_path / "again.FCStd"))
    today = {f"freecad.toolaxis.{name}" for name in TODAY.values()}
    assert {module for module, _ in python_in(tmp_path / "again.FCStd")} <= today
    operations[1].Scallop = 0.2
    layers.recompute()
    assert plan.Stale and operations[1].StaleReasons == ["scallop was changed"]
