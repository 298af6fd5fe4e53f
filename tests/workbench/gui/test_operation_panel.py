"""The panel of an operation in the document: a double click opens it; it moves the tool and leads to planning again."""

import FreeCAD
import pytest


def opened(desk, operation):
    operation.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisOperation") is not None, "the panel opens")
    form = desk.form("ToolAxisOperation")
    desk.pump(0.2)
    # what is told of collisions takes a second line, the map grows when it is drawn, and all below moves
    desk.wait(lambda: not form.results.geometry().intersects(form.mapPlace.geometry()), "the map is off the table")
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
    assert form.faces.count() == 1 and desk.shown(form.scallop) == f"{operation.Scallop.Value:.2f} mm"
    desk.type(form.scallop, "0.4 mm")
    passes = operation.Passes
    desk.computed(form)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert operation.Passes < passes and len(document.Objects) == count
    document.undo()
    assert operation.Passes == passes


def test_the_panel_tells_the_machining_time(desk, operation):
    form = opened(desk, operation)
    rows = {form.results.verticalHeaderItem(k).text(): desk.text(form.results, k) for k in range(5)}
    assert operation.MachiningTime.Value > 1 and rows["Machining time"] == f"{operation.MachiningTime.Value:.0f} s"


def test_a_changed_part_makes_it_stale_and_recompute_mends_it(desk, operation):
    document, part = operation.Document, operation.Faces[0][0]
    shape = part.Shape.copy()
    shape.scale(1.2)
    part.Shape = shape
    document.recompute()
    assert operation.Stale
    form = opened(desk, operation)
    assert form.message.text() == "Out of date: the part has changed. Recompute." and form.again.text() == "Recompute"
    desk.shot("41-stale")
    desk.press(form.again)
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert not operation.Stale


def test_a_clamp_that_the_tool_meets_is_told_and_red(desk, operation, tmp_path):
    """A post that nobody ticked stands at one side of the part, as high as the holder."""
    document = operation.Document
    form = opened(desk, operation)
    desk.wait(lambda: "No collisions" in form.met.text(), "collisions were looked for")
    assert "cutter, shank" in form.met.text()
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Length, clamp.Width, clamp.Height = 6, 6, 90
    clamp.Placement.Base = FreeCAD.Vector(26, 4, 0)
    document.recompute()
    desk.wait(lambda: "Clamp" in form.met.text(), "the clamp is noticed")
    for thing in document.Objects:  # axes and rapid moves are red too
        if thing.TypeId.endswith("CoordinateSystem") or thing.TypeId == "Path::Feature":
            thing.ViewObject.Visibility = False
    form.slide.setValue(0)
    free = [value for value in range(0, 1001, 50) if moved(desk, form, value).startswith("Elsewhere on the passes")]
    assert free, form.met.text()
    form.slide.setValue(free[0])
    assert "of Clamp by" in form.met.text() and "show it" in form.met.text()
    desk.gui.ActiveDocument.ActiveView.fitAll()
    desk.shot("42-met-elsewhere")
    before = desk.red_points(document, tmp_path)
    form.met.linkActivated.emit("there")
    desk.pump(0.2)
    assert "collides with face" in form.met.text() and "of Clamp by" in form.met.text()
    assert "Elsewhere" not in form.met.text()
    desk.shot("43-met-here")
    assert desk.red_points(document, tmp_path) > before + 500
    desk.press(desk.standard_button("Close"))
    desk.pump(0.2)
    assert desk.red_points(document, tmp_path) <= before, "the red goes with the panel"


def moved(desk, form, value):
    form.slide.setValue(value)
    desk.pump(0.02)
    return form.met.text()


def test_the_operation_deleted_under_its_panel(desk, operation):
    document = operation.Document
    opened(desk, operation)
    document.removeObject(operation.Name)
    desk.wait(lambda: desk.form("ToolAxisOperation") is None, "the panel closes")
