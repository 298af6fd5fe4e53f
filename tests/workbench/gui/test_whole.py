"""Whole parts from the panel: divided, picked from the curve, locked, and put into the tree as one undo step."""

import pytest


@pytest.fixture
def roof(desk, whole_parts):
    return shown(desk, whole_parts.roof)


def shown(desk, make):
    """A part in a document of its own, in sight."""
    import FreeCAD

    document = FreeCAD.newDocument("Part")
    document.UndoMode = 1
    found = make(document)
    view = desk.gui.getDocument(document.Name).ActiveView
    view.viewIsometric()
    view.fitAll()
    return found


@pytest.fixture
def form(desk, roof):
    """The panel for the roof, with a ball end, a coarse scallop and few axes to look at: what is planned soonest."""
    form = desk.start(*roof)
    form.kind.setCurrentIndex(0)
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.4 mm")
    limit_axes(desk, form, "45 deg")
    return form


def limit_axes(desk, form, cone):
    """Have axes looked for around the vertical alone, which takes less time than all of them."""
    form.limits.setCurrentIndex(1)
    desk.type(form.cone, cone)


def put(desk):
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")


def plan_in(document):
    from freecad.toolaxis.document.kinds import is_plan

    return next(filter(is_plan, document.Objects), None)


def operations(document):
    from freecad.toolaxis.document.kinds import operations_in

    return operations_in(plan_in(document))


def colours_of(document):
    return [next(tuple(thing.ViewObject.ShapeColor) for thing in one.Group if thing.TypeId == "Mesh::Feature")
            for one in operations(document)]


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def test_two_sub_surfaces_stand_in_the_tree_and_go_with_one_undo(desk, roof, form, remembered, tmp_path):
    import FreeCAD

    document = roof[0].Document
    before = names(document)
    form.regions.setCurrentIndex(2)
    form.tabs.setCurrentWidget(form.advancedTab)
    assert form.blades.isChecked() and form.regionsNumber.isVisible() and form.regionsNumber.value() == 2
    desk.shot("60-division")
    desk.computed(form)
    assert "Every face has an axis" in form.message.text() and names(document) == before
    assert form.operation.count() == 2
    desk.shot("61-two-axes")
    put(desk)
    after = names(document)
    made = operations(document)
    assert [one.Label.rsplit(" ", 1)[1] for one in made] == [f"{roof[1]}a", f"{roof[1]}b"]
    for one in made:
        kinds = [thing.TypeId for thing in one.Group]
        assert "Path::Feature" in kinds and "Mesh::Feature" in kinds and not one.Stale
    colours = colours_of(document)
    assert colours[0] != colours[1]
    desk.shot("62-sub-surfaces")
    document.undo()
    desk.pump(0.2)
    assert names(document) == before, "one undo step takes all back"
    document.redo()
    desk.pump(0.2)
    assert names(document) == after and not plan_in(document).Stale
    document.saveAs(str(tmp_path / "Roof.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "Roof.FCStd"))
    desk.pump(0.3)
    assert names(again) == after and not any(one.Stale for one in operations(again))
    assert sum(colours_of(again), ()) == pytest.approx(sum(colours, ()), abs=0.01)
    desk.gui.getDocument(again.Name).ActiveView.fitAll()
    desk.shot("63-reopened")
    again.UndoMode = 1
    part = operations(again)[0].Faces[0][0]
    for gone, words in ((operations(again)[1], "deleted"), (part, "the part was deleted")):
        again.openTransaction("Delete")
        again.removeObject(gone.Name)
        again.recompute()
        again.commitTransaction()
        assert plan_in(again).Stale and words in plan_in(again).StaleReasons[0]
        if words != "deleted":
            desk.gui.runCommand("ToolAxis_Recompute")
            desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
            form = desk.form("ToolAxisPlan")
            assert "The part was deleted" in form.message.text() and not form.compute.isEnabled()
            desk.shot("68-part-deleted")
            desk.press(desk.standard_button("Cancel"))
            desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
        again.undo()
        again.recompute()
        assert not plan_in(again).Stale
    desk.gui.Selection.addSelection(again.Name, plan_in(again).Name)
    desk.gui.runCommand("Std_Delete")
    desk.pump(0.2)
    assert plan_in(again) is None and not [one for one in again.Objects if one.Name.startswith(("Operation", "Sub"))]


def test_the_curve_is_picked_from(desk, whole_parts):
    roof = shown(desk, whole_parts.wave)
    form = desk.start(*roof)
    form.tabs.setCurrentWidget(form.toolTab)
    desk.type(form.diameter, "6 mm")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.1 mm")
    desk.type(form.tolerance, "0.002 mm")  # with more, one axis for all is refused when its passes are proven
    limit_axes(desk, form, "30 deg")
    form.orientations.setCurrentIndex(1)
    desk.computed(form)
    curve = form.findChild(desk.widgets.QWidget, "orientationCurve")
    assert curve.isVisible() and len(curve.options) > 1
    chosen = next(one for one in curve.options if one.chosen)
    other = next(one for one in curve.options if not one.chosen)
    desk.hover(curve, curve.position_of(chosen))
    assert "sub-surfaces" in form.pointer.text()
    desk.shot("64-curve")
    desk.click(curve, curve.position_of(other))
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    assert form.orientationsNumber.value() == other.orientations and form.orientations.currentIndex() == 2
    put(desk)
    assert plan_in(roof[0].Document).DifferentAxes == other.orientations
    assert plan_in(roof[0].Document).Orientations == str(other.orientations)


def test_a_locked_axis_is_kept_when_the_plan_is_computed_again(desk, roof, form, remembered):
    document = roof[0].Document
    form.regions.setCurrentIndex(2)
    desk.computed(form)
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    centre, radius = chart.disc()
    desk.click(chart, centre + desk.qt.QPointF(0.2 * radius, -0.1 * radius))
    desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
    desk.press(form.lock)
    assert form.lockAxis.isChecked() and "(locked)" in form.operation.itemText(0)
    desk.shot("65-locked")
    put(desk)
    first, second = operations(document)
    axis, border = first.Axis, first.Details
    assert first.AxisLocked and not second.AxisLocked
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Recompute")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    assert form.lockAxis.isChecked() and "Every face has an axis" in form.message.text()
    put(desk)
    again = operations(document)
    assert [one.Name for one in again] == [first.Name, second.Name], "the same objects"
    assert again[0].Axis.isEqual(axis, 1e-9) and again[0].AxisLocked
    import json

    assert json.loads(again[0].Details)["region"] == json.loads(border)["region"]
    assert any("locked by hand" in text for text in again[0].Reasons)


@pytest.mark.parametrize(("field", "value", "words"), [
    pytest.param("regions", 16, "cannot be divided", marks=pytest.mark.long), ("orientations", 1, "")])
def test_impossible_divisions_are_told_and_nothing_is_made(desk, roof, form, remembered, field, value, words):
    document = roof[0].Document
    before = names(document)
    getattr(form, field).setCurrentIndex(2)
    getattr(form, f"{field}Number").setValue(value)
    if field == "orientations":
        form.method.setCurrentIndex(form.method.findText("mean normals"))
        assert not form.compute.isEnabled() and "one axis for each sub-surface" in form.message.text()
        desk.shot("66-refused-division")
        return
    desk.type(form.scallop, "0.4 mm")
    form.tabs.setCurrentWidget(form.toolTab)
    desk.type(form.diameter, "8 mm")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.computed(form)
    assert words in form.message.text() and not desk.standard_button("Ok").isEnabled()
    assert names(document) == before


@pytest.mark.long
def test_sub_surfaces_are_merged_by_the_command(desk, roof, form, remembered):
    document = roof[0].Document
    form.regions.setCurrentIndex(2)
    desk.computed(form)
    put(desk)
    first, second = operations(document)
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(document.Name, first.Name)
    told = desk.dialog_text(lambda: desk.gui.runCommand("ToolAxis_Merge"))
    assert "two or more sub-surfaces" in told
    desk.gui.Selection.addSelection(document.Name, second.Name)
    desk.gui.runCommand("ToolAxis_Merge")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    assert len(operations(document)) == 2, "nothing in the document before OK"
    put(desk)
    only, = operations(document)
    assert only.DrawnByHand and only.Label.endswith(roof[1])
    document.undo()
    desk.pump(0.2)
    assert len(operations(document)) == 2


def shown_by(link):
    """Kinds of what a link shows."""
    return sorted(thing.TypeId for thing in link.LinkedObject.Group if link.isElementVisible(thing.Name))


def test_other_blades_are_shown_as_turned_links(desk, whole_parts, tmp_path):
    import FreeCAD

    wheel = shown(desk, lambda document: (whole_parts.wheel(document),))[0]
    form = desk.start(wheel)
    form.rack.setCurrentIndex(0)
    form.tabs.setCurrentWidget(form.toolTab)
    form.kind.setCurrentIndex(0)
    desk.type(form.diameter, "6 mm")
    desk.type(form.stickout, "40 mm")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.4 mm")
    form.regions.setCurrentIndex(2)
    form.regionsNumber.setValue(1)
    assert form.faces.count() == 6
    desk.computed(form)
    assert "axis" in form.message.text() and form.operation.count() == 6
    assert "turned copy" in form.operation.itemText(5)
    put(desk)
    document = wheel.Document
    links = [thing for thing in document.Objects if thing.TypeId == "App::Link"]
    assert len(links) == 4 and len(operations(document)) == 2
    for link in links:
        assert shown_by(link) == ["Mesh::Feature", "Path::Feature"], "neither tools nor frames of all blades"
    assert [group.Label for group in plan_in(document).Group] == ["Blade 1", "Blade 2", "Blade 3"]
    desk.gui.getDocument(document.Name).ActiveView.fitAll()
    desk.shot("67-blades")
    document.saveCopy(str(tmp_path / "Wheel.FCStd"))
    again = FreeCAD.openDocument(str(tmp_path / "Wheel.FCStd"))
    link = again.getObject(links[0].Name)
    desk.wait(lambda: shown_by(link) == ["Mesh::Feature", "Path::Feature"], "links hide tools and frames again", 10.0)
    document.undo()
    desk.pump(0.2)
    assert names(document) == [wheel.Name]
