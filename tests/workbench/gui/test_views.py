"""View providers: of objects that are made, and of those saved when the classes of views stood elsewhere."""

import shutil
from pathlib import Path

import FreeCAD
import pytest
from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.machine import place_machine

SAVED = Path(__file__).resolve().parents[1] / "saved" / "before-layers.FCStd"
VIEWS = {"ToolAxisMachine": "machine", "ToolAxisOperation": "operation", "ToolAxisTool": "tool_on_path",
         "ToolAxisPlan": "plan_group"}


@pytest.fixture
def opened(desk, tmp_path):
    shutil.copy(SAVED, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / SAVED.name))
    desk.pump(0.5)
    return document


def view_of(thing):
    return type(thing.ViewObject.Proxy).__module__


def test_what_is_made_gets_its_view(desk, operation):
    machine = place_machine(operation.Document, "bc-table-table", (0, 0, 0), [])
    for thing in (operation, child(operation, "Part::FeaturePython"), machine):
        assert view_of(thing) == f"freecad.toolaxis.gui.views.{VIEWS[thing.Proxy.Type]}"


def test_saved_views_are_todays_and_open_their_panels(desk, opened):
    kinds = {thing: getattr(getattr(thing, "Proxy", None), "Type", "") for thing in opened.Objects}
    ours = {thing: kind for thing, kind in kinds.items() if kind.startswith("ToolAxis")}
    assert set(ours.values()) == set(VIEWS)
    for thing, kind in ours.items():
        assert view_of(thing) == f"freecad.toolaxis.gui.views.{VIEWS[kind]}"
    for kind, form in (("ToolAxisOperation", "ToolAxisOperation"), ("ToolAxisPlan", "ToolAxisPlan"),
                       ("ToolAxisMachine", "ToolAxisMachine")):
        thing = next(thing for thing in ours if ours[thing] == kind)
        assert thing.ViewObject.Proxy.doubleClicked(thing.ViewObject)
        desk.wait(lambda form=form: desk.form(form), f"{form} opens")
        desk.shot(f"80-saved-{form}")
        desk.gui.Control.closeDialog()
        desk.pump(0.2)


def test_an_operation_looks_stale_when_it_is(desk, opened):
    operation = next(thing for thing in opened.Objects if getattr(thing, "Stale", None) is False)
    fresh = operation.ViewObject.Proxy.getIcon()
    label, scallop = operation.Label, operation.Scallop
    operation.Scallop = 0.2
    opened.recompute()
    assert operation.Stale and operation.ViewObject.Proxy.getIcon() != fresh
    assert operation.Label == f"{label} (out of date)"
    desk.shot("81-stale-in-the-tree")
    operation.Label = "Roof"
    assert operation.Label == "Roof (out of date)", "what the user calls it is kept, and that it is stale is still told"
    operation.Scallop = scallop
    opened.recompute()
    assert not operation.Stale and operation.Label == "Roof"


def test_the_label_of_what_is_stale_survives_saving_undo_and_another_language(desk, operation, tmp_path):
    from freecad.toolaxis.document.stale_label import plain_label

    document, label = operation.Document, operation.Label
    document.openTransaction("Scallop")
    operation.Scallop = 0.2
    document.recompute()
    document.commitTransaction()
    assert operation.Label == f"{label} (out of date)" and plain_label(operation) == label
    document.undo()
    document.recompute()
    assert not operation.Stale and operation.Label == label
    document.redo()
    document.recompute()
    assert operation.Stale and operation.Label == f"{label} (out of date)"
    document.saveAs(str(tmp_path / "Stale.FCStd"))
    name = operation.Name
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "Stale.FCStd")).getObject(name)
    desk.pump(0.3)
    assert again.Label == f"{label} (out of date)"
    desk.gui.setLocale("de")
    again.Tool = "ball:3"
    again.Document.recompute()
    again.Label = label
    assert again.Label == f"{label} (veraltet)"
    desk.gui.setLocale("en")


def test_the_menu_of_what_is_stale_computes_it_again(desk, operation, remembered):
    menu = desk.widgets.QMenu()
    view = operation.ViewObject
    view.Proxy.setupContextMenu(view, menu)
    assert not menu.actions(), "it is not stale"
    operation.Scallop = 0.1
    operation.Document.recompute()
    view.Proxy.setupContextMenu(view, menu)
    action, = menu.actions()
    assert action.text() == "Recompute"
    action.trigger()
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert not operation.Stale and "(out of date)" not in operation.Label
