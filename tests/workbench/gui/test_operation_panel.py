"""The panel of an operation in the document: a double click opens it; it moves the tool and leads to planning again."""

import pytest


def opened(desk, operation):
    operation.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisOperation") is not None, "the panel opens")
    form = desk.form("ToolAxisOperation")
    assert not form.results.geometry().intersects(form.mapPlace.geometry()), "the map lies over the table"
    return form


def test_the_slider_moves_the_tool_and_it_stays(desk, operation):
    form = opened(desk, operation)
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    desk.wait(lambda: chart.picture is not None, "the map is drawn")
    assert "chosen" in chart.picture.marks and form.results.rowCount() > 5
    tool = next(thing for thing in operation.Group if "Position" in thing.PropertiesList)
    before = tool.Placement.Base
    form.slide.setValue(500)
    desk.pump(0.2)
    assert tool.Position == pytest.approx(0.5) and tool.Placement.Base.distanceToPoint(before) > 1.0
    desk.shot("40-operation")
    desk.press(desk.standard_button("Close"))
    assert tool.Position == pytest.approx(0.5)


def test_plan_again_takes_the_place_of_the_old_results(desk, operation):
    document = operation.Document
    count = len(document.Objects)
    form = opened(desk, operation)
    desk.press(form.again)
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the planning panel opens")
    form = desk.form("ToolAxisPlan")
    assert form.faces.count() == 1 and form.scallop.property("rawValue") == pytest.approx(0.2)
    desk.type(form.scallop, "0.4 mm")
    passes = operation.Passes
    desk.computed(form)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert operation.Passes < passes and len(document.Objects) == count
    document.undo()
    assert operation.Passes == passes


def test_a_changed_part_makes_it_stale_and_recompute_mends_it(desk, operation):
    document, part = operation.Document, operation.Faces[0][0]
    shape = part.Shape.copy()
    shape.scale(1.2)
    part.Shape = shape
    document.recompute()
    assert operation.Stale
    form = opened(desk, operation)
    assert "Stale" in form.message.text()
    desk.shot("41-stale")
    desk.press(desk.standard_button("Close"))
    desk.gui.runCommand("ToolAxis_Recompute")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert not operation.Stale


def test_the_operation_deleted_under_its_panel(desk, operation):
    document = operation.Document
    opened(desk, operation)
    document.removeObject(operation.Name)
    desk.wait(lambda: desk.form("ToolAxisOperation") is None, "the panel closes")
