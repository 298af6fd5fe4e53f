"""A document saved when the classes of views stood elsewhere: in the window it looks and answers as one of today."""

import shutil
from pathlib import Path

import FreeCAD
import pytest

SAVED = Path(__file__).resolve().parents[1] / "saved" / "before-layers.FCStd"
VIEWS = {"ToolAxisMachine": "machine", "ToolAxisOperation": "operation", "ToolAxisTool": "tool_on_path",
         "ToolAxisPlan": "plan_group"}


@pytest.fixture
def opened(desk, tmp_path):
    shutil.copy(SAVED, tmp_path)
    document = FreeCAD.openDocument(str(tmp_path / SAVED.name))
    desk.pump(0.5)
    return document


def test_views_are_todays_and_open_their_panels(desk, opened):
    kinds = {thing: getattr(getattr(thing, "Proxy", None), "Type", "") for thing in opened.Objects}
    ours = {thing: kind for thing, kind in kinds.items() if kind.startswith("ToolAxis")}
    assert set(ours.values()) == set(VIEWS)
    for thing, kind in ours.items():
        assert type(thing.ViewObject.Proxy).__module__ == f"freecad.toolaxis.gui.views.{VIEWS[kind]}"
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
    operation.Scallop = 0.2
    opened.recompute()
    assert operation.Stale and operation.ViewObject.Proxy.getIcon() != fresh
