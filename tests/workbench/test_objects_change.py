"""What becomes of results when the document changes: stale marks, recompute, undo, failures, save and reload."""

import subprocess
import sys
from pathlib import Path

import FreeCAD
import numpy as np
import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.document import shape_cache, staleness
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kinds import is_operation
from freecad.toolaxis.document.passes import moves
from freecad.toolaxis.document.staleness import same, signature
from freecad.toolaxis.document.work_coordinates import kind_of_frame
from freecad.toolaxis.services import api, write_results
from freecad.toolaxis.services.write_results import apply, child, keep_verdict

from toolaxis.errors import Cancelled, ToolAxisError
from toolaxis.progress import NO_PROGRESS, Progress

ROOT = Path(__file__).resolve().parents[2]
LIMITS = "cone:0.2,0.1,1,2"


@pytest.fixture
def part(document, parts):
    return parts.block(document)


@pytest.fixture
def clamp(document):
    made = document.addObject("Part::Box", "Clamp")
    made.Placement.Base = Vector(80, 0, 0)
    document.recompute()
    return made


@pytest.fixture
def operation(document, parts, part, clamp):
    return parts.planned(document, (part, parts.sculptured_name(part)), obstacles=(clamp,))[0]


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def stale(operation, words):
    """Whether an operation is marked stale for one reason, by its properties and by a look at the document."""
    reasons = "; ".join(operation.StaleReasons)
    assert words in reasons, reasons
    return operation.Stale and api.is_stale(operation)


def test_nothing_is_stale_after_planning_or_after_a_recompute_of_all(operation, document, part):
    document.recompute(None, True)
    assert not operation.Stale and not api.is_stale(operation)
    part.touch()
    document.recompute()
    assert not operation.Stale and not operation.StaleReasons


def test_a_changed_part_makes_results_stale(operation, document, parts, part):
    part.Shape = parts.wavy(10.01)
    document.recompute()
    assert stale(operation, "the part has changed")
    part.Shape = parts.wavy()
    document.recompute()
    assert not operation.Stale, "and back again"


def test_a_verdict_holds_for_what_was_judged(operation, document, parts, part):
    api.verify(operation)
    assert operation.Verdict == "passed"
    document.recompute(None, True)
    assert operation.Verdict == "passed"
    part.Shape = parts.wavy(10.3)
    document.recompute()
    assert operation.Verdict == "out of date" and "verify again" in operation.VerdictReasons[0]
    api.verify(operation)
    assert operation.Verdict == "failed" and operation.Stale
    part.Shape = parts.wavy()
    document.recompute()
    assert not operation.Stale and operation.Verdict == "out of date"
    operation.Scallop = 2.0
    document.recompute()
    assert api.verify(operation).passed
    operation.Scallop = 0.3
    document.recompute()
    assert operation.Verdict == "out of date"


def test_a_part_changed_while_it_was_judged(operation, document, parts, part):
    found = api.verification(operation)(NO_PROGRESS).operations
    part.Shape = parts.wavy(10.3)
    keep_verdict(operation, found)
    document.recompute()
    assert operation.Verdict == "out of date"


def test_a_part_that_cannot_be_made_any_more_makes_results_stale(document, parts):
    base, hole = parts.block(document, "Base"), document.addObject("Part::Cylinder", "Hole")
    hole.Height, hole.Placement = 60, Placement(Vector(10, 8, -500), Rotation())
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = base, hole
    document.recompute()
    made = parts.planned(document, (cut, parts.sculptured_name(cut)))[0]
    assert not made.Stale
    document.removeObject(hole.Name)
    document.recompute()
    assert "Invalid" in cut.State and made.Stale and made.StaleReasons


def test_one_pole_a_hundredth_of_a_millimetre_off_is_a_change(document, parts):
    whole = parts.wavy()
    surface = next(face.Surface for face in whole.Faces if type(face.Surface).__name__ == "BSplineSurface")
    thing = document.addObject("Part::Feature", "Free")
    thing.Shape = surface.toShape()
    first = bridge_signature(thing)
    surface.setPole(3, 3, surface.getPole(3, 3) + Vector(0, 0, 0.01))
    thing.Shape = surface.toShape()
    assert not same(first, bridge_signature(thing)) and same(first, first)


def test_a_shape_is_looked_at_once_and_anew_where_it_stands_elsewhere(clamp, monkeypatch):
    looks, points = [], staleness._points
    monkeypatch.setattr(staleness, "_points", lambda shape: looks.append(shape) or points(shape))
    monkeypatch.setattr(shape_cache, "_SEEN", [])
    assert bridge_signature(clamp) == bridge_signature(clamp) and len(looks) == 1
    clamp.Placement.Base = Vector(10, 0, 0)
    bridge_signature(clamp)
    assert len(looks) == 2
    clamp.Height = 20
    clamp.Document.recompute()
    bridge_signature(clamp)
    assert len(looks) == 3


def bridge_signature(thing):
    return signature([thing])


def test_a_moved_obstacle_makes_results_stale_and_moving_both_does_not(operation, document, part, clamp):
    clamp.Placement.Base = Vector(40, 0, 0)
    document.recompute()
    assert stale(operation, "a body to avoid was moved or changed")
    clamp.Placement.Base = Vector(80, 0, 0)
    for thing in (part, clamp):
        thing.Placement = Placement(Vector(5, 6, 7), Rotation(Vector(1, 1, 0), 30)).multiply(thing.Placement)
    document.recompute()
    assert not operation.Stale, operation.StaleReasons


def test_a_deleted_obstacle_makes_results_stale(operation, document, clamp):
    document.removeObject(clamp.Name)
    document.recompute()
    assert stale(operation, "no longer avoided")


def test_a_changed_input_makes_results_stale(operation, document):
    operation.Scallop = 0.1
    document.recompute()
    assert stale(operation, "scallop was changed")
    operation.Scallop = 0.3
    document.recompute()
    assert not operation.Stale


def test_limits_stand_in_the_document_so_a_turned_part_is_stale(document, parts, part):
    made = parts.planned(document, (part, parts.sculptured_name(part)), limits="cone:0,0,1,60")[0]
    part.Placement.Base = Vector(1, 2, 3)
    document.recompute()
    assert bool(made.Stale) == bool(api.is_stale(made))
    part.Placement = Placement(Vector(), Rotation(Vector(1, 0, 0), 20))
    document.recompute()
    assert stale(made, "turned")


def test_recompute_mends_the_same_objects(document, parts, part):
    made = parts.planned(document, (part, parts.sculptured_name(part)), limits=LIMITS)[0]
    api.verify(made)
    part.Shape = parts.wavy(12.0)
    document.recompute()
    assert made.Stale
    before, old = names(document), moves(child(made, "Path::Feature"))[0]
    again = api.recompute(made)
    assert again == [made] and not made.Stale and not api.is_stale(made)
    maps = [name for name in before if name.startswith(("Scallops", "Gouges"))]
    assert len(maps) == 2 and names(document) == sorted(set(before) - set(maps)), "an old verdict does not stay"
    assert made.Verdict == "not verified"
    new = moves(child(made, "Path::Feature"))[0]
    assert new[:, 2].min() > old[:, 2].min() + 1.5, "the part is 2 mm higher"


def test_a_deleted_part_is_said_and_refused(operation, document, part):
    document.removeObject(part.Name)
    document.recompute()
    assert stale(operation, "the part was deleted")
    for act in (api.recompute, api.verify, api.verification):
        with pytest.raises(ToolAxisError, match="was deleted"):
            act(operation)
    assert child(operation, "Path::Feature").Path.Size > 0, "what was there stays"


def test_one_undo_takes_all_back_and_redo_brings_it(document, parts, part):
    document.UndoMode = 1
    before = names(document)
    made = parts.planned(document, (part, parts.sculptured_name(part)))[0]
    after = names(document)
    assert len(after) > len(before) + 4 and len(document.UndoNames) == 1
    name = made.Name
    document.undo()
    assert names(document) == before
    document.redo()
    assert names(document) == after
    again = document.getObject(name)
    assert is_operation(again) and again.Passes > 1 and not api.is_stale(again)
    assert child(again, "Part::FeaturePython").Passes == child(again, "Path::Feature")


def test_undo_of_a_recompute_brings_the_old_results_back(document, parts, part):
    document.UndoMode = 1
    made = parts.planned(document, (part, parts.sculptured_name(part)), limits=LIMITS)[0]
    passes = child(made, "Path::Feature")
    old = moves(passes)[0]
    part.Shape = parts.wavy(12.0)
    document.recompute()
    api.recompute(made)
    document.undo()
    assert np.array_equal(moves(passes)[0], old)


@pytest.mark.parametrize("undo", [0, 1])
@pytest.mark.parametrize("step", ["place_frame", "fill_passes", "tool_shape", "signature"])
def test_a_failure_leaves_no_half_made_tree(document, parts, part, monkeypatch, undo, step):
    document.UndoMode = undo
    before = names(document)

    def broken(*_):
        raise RuntimeError("planted")

    monkeypatch.setattr(write_results, step, broken)
    with pytest.raises(RuntimeError, match="planted"):
        parts.planned(document, (part, parts.sculptured_name(part)))
    assert names(document) == before
    assert document.UndoNames == [] and not document.HasPendingTransaction


def test_a_cancelled_computation_leaves_the_document(document, parts, part):
    before = names(document)
    with pytest.raises(Cancelled):
        api.plan(document, (part, parts.sculptured_name(part)), parts.TOOL, parts.SCALLOP,
                    progress=Progress(None, lambda: True))
    assert names(document) == before


def test_a_task_does_not_need_the_document_any_more(document, parts):
    other = FreeCAD.newDocument("Closed")
    thing = parts.block(other)
    task = api.task(parts.inputs_for((thing, parts.sculptured_name(thing)), limits=LIMITS))
    FreeCAD.closeDocument(other.Name)
    plan = task(Progress())
    assert plan.operations[0].done


def test_the_part_changed_while_it_was_planned(document, parts, part):
    import Part as FreecadPart

    inputs = parts.inputs_for((part, parts.sculptured_name(part)))
    plan = parts.quick_plan(inputs)
    part.Shape = FreecadPart.makeSphere(5)
    before = names(document)
    with pytest.raises(ToolAxisError, match="changed"):
        apply(document, inputs, plan)
    assert names(document) == before


def test_two_documents_do_not_mix(document, parts, part):
    other = FreeCAD.newDocument("Other")
    try:
        second = parts.block(other)
        before = names(document)
        made = parts.planned(other, (second, parts.sculptured_name(second)))[0]
        assert made.Document is other and names(document) == before
        assert {thing.Document.Name for thing in made.OutListRecursive} == {other.Name}
    finally:
        FreeCAD.closeDocument(other.Name)


@pytest.fixture
def saved(document, parts, part, clamp, tmp_path):
    """A document that was saved after planning and judging, and the file."""
    made = parts.planned(document, (part, parts.sculptured_name(part)), obstacles=(clamp,))[0]
    api.verify(made)
    path = tmp_path / "Saved.FCStd"
    document.recompute()
    document.saveAs(str(path))
    return made, path


def test_everything_is_there_after_saving_and_opening(saved, document):
    made, path = saved
    names = ("Axis", "Passes", "Reasons", "AxisMap", "Verdict", "WorstScallops", "Motions")
    figures = {name: getattr(made, name) for name in names}
    gouge = made.Gouge.Value
    points = moves(child(made, "Path::Feature"))[0]
    kinds = [thing.TypeId for thing in made.Group]
    inputs = inputs_of(made)
    FreeCAD.closeDocument(document.Name)
    opened = FreeCAD.openDocument(str(path))
    try:
        again = next(thing for thing in opened.Objects if is_operation(thing))
        for name, value in figures.items():
            assert getattr(again, name) == value, name
        assert again.Gouge.Value == pytest.approx(gouge, rel=1e-12)
        assert [thing.TypeId for thing in again.Group] == kinds
        assert np.abs(moves(child(again, "Path::Feature"))[0] - points).max() < 1e-6
        back = inputs_of(again)
        assert (back.tool, back.scallop, back.holder, back.limits) == (inputs.tool, inputs.scallop, inputs.holder, "")
        assert not again.Stale and not api.is_stale(again)
        opened.recompute(None, True)
        assert not again.Stale, again.StaleReasons
        again.Faces[0][0].Placement.Base = Vector(3, 4, 5)
        opened.recompute()
        assert child(again, kind_of_frame(opened)).Placement.Base.distanceToPoint(Vector(3, 4, 5)) < 1e-9
        standing = child(again, "Part::FeaturePython")
        before = standing.Placement.Base
        standing.Position = 0.8
        assert standing.Placement.Base.distanceToPoint(before) > 1
        assert api.verify(again).scallop_limit == 0.3
    finally:
        FreeCAD.closeDocument(opened.Name)


def test_properties_that_an_older_document_lacks_are_added(operation):
    operation.removeProperty("VerdictReasons")
    operation.removeProperty("SpindleSpeed")
    operation.Proxy.onDocumentRestored(operation)
    assert operation.VerdictReasons == [] and operation.SpindleSpeed == 0


WITHOUT = """
import sys
import FreeCAD
import Part, Mesh, Path
for name in [name for name in sys.modules if name.startswith(("freecad", "toolaxis"))]:
    del sys.modules[name]
import freecad
freecad.__path__ = []
sys.path = [entry for entry in sys.path if not entry.startswith({root!r}) and "Mod/" not in entry]
try:
    import freecad.toolaxis
except ImportError:
    pass
else:
    raise SystemExit("the add-on is still there")
document = FreeCAD.openDocument({path!r})
document.recompute()
part = document.getObject("Block")
before = document.getObject("WorkCoordinates").Placement.Base
part.Placement.Base = FreeCAD.Vector(3, 4, 5)
document.recompute()
frame, passes = document.getObject("WorkCoordinates"), document.getObject("Passes")
moved = [thing.Placement.Base.distanceToPoint(FreeCAD.Vector(3, 4, 5)) < 1e-9 for thing in (frame, passes)]
tool, mesh = document.getObject("ToolOnPasses"), document.getObject("Scallops")
told = [frame.isValid(), moved, passes.Path.Size > 10, len(tool.Shape.Solids), mesh.Mesh.CountFacets > 100,
        document.getObject("Operation").Outcome]
sys.__stdout__.write("TOLD " + repr(told) + chr(10))
sys.__stdout__.flush()
import os
os._exit(0)
"""


def test_plain_objects_stay_without_the_add_on(saved):
    _, path = saved
    code = WITHOUT.format(root=str(ROOT), path=str(path))
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False,
                         stdin=subprocess.DEVNULL, cwd=path.parent)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "TOLD [True, [True, True], True, 3, True, 'feasible']" in run.stdout, run.stdout + run.stderr
    assert "Traceback" not in run.stdout + run.stderr, run.stdout + run.stderr
