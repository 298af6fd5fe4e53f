"""The planning panel, driven as a user does it, in the light theme."""

import pytest


def spot(chart, free):
    """Where the widest free axis lies on the map, or the forbidden one that is missed by most."""
    picture = chart.picture
    usable = (picture.reason == 0) == free
    usable &= picture.axes @ picture.pole > 0.1
    assert usable.any()
    rank = picture.passes if free else -picture.amount
    rows = sorted((rank[i], i) for i in range(len(usable)) if usable[i])
    return chart.position_of(picture.axes[rows[0][1]])


def test_the_workbench_is_there_with_its_commands(desk):
    assert desk.gui.activeWorkbench().name() == "ToolAxisWorkbench"
    names = [name for name in desk.gui.listCommands() if name.startswith("ToolAxis_")]
    assert set(names) >= {"ToolAxis_PlanOrientations", "ToolAxis_Verify", "ToolAxis_Recompute"}


def test_plan_from_selection_to_objects_and_back(desk, wavy, form, remembered):
    document = wavy[0].Document
    before = [thing.Name for thing in document.Objects]
    assert form.faces.count() == 1 and wavy[1] in desk.text(form.faces, 0)
    desk.shot("1-job")
    form.tabs.setCurrentWidget(form.toolTab)
    desk.shot("2-tool")
    form.tabs.setCurrentWidget(form.advancedTab)
    desk.shot("3-advanced")
    desk.computed(form)
    assert "Every face has an axis" in form.message.text()
    assert form.tabs.currentWidget() is form.resultTab
    assert [thing.Name for thing in document.Objects] == before, "nothing in the document before OK"
    desk.shot("4-axis")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    made = [thing for thing in document.Objects if thing.Name not in before]
    assert made
    desk.shot("5-objects")
    document.undo()
    desk.pump(0.2)
    assert [thing.Name for thing in document.Objects] == before, "one undo step takes all back"


def test_the_triad_of_the_preview_stands_where_the_one_of_the_document_will(desk, wavy, remembered):
    import FreeCAD
    import numpy as np
    from freecad.toolaxis.document.children import frame_of
    from pivy import coin

    part, face = wavy
    part.Placement = FreeCAD.Placement(FreeCAD.Vector(30, -20, 10), FreeCAD.Rotation(FreeCAD.Vector(1, 1, 0), 20))
    part.Document.recompute()
    form = desk.start(part, face)
    desk.type(form.scallop, "0.05 mm")
    desk.computed(form)
    panel = desk.opened[-1]()
    desk.wait(lambda: not panel.preview._left, "all is drawn")
    search = coin.SoSearchAction()
    search.setType(coin.SoAnnotation.getClassTypeId())
    search.apply(panel.preview.root)
    search.setType(coin.SoCoordinate3.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    triad = search.getPath().getTail()
    search.apply(triad)
    paths = search.getPaths()
    lines = np.array([[paths[k].getTail().point[i].getValue() for i in (0, 1)] for k in range(paths.getLength())])
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    matrix = np.array(frame_of(desk.operation_in(part.Document)).Placement.toMatrix().A).reshape(4, 4)
    assert len(lines) == 3 and np.allclose(lines[:, 0], matrix[:3, 3], atol=1e-4)
    ways = lines[:, 1] - lines[:, 0]
    assert np.allclose(ways / np.linalg.norm(ways, axis=1)[:, None], matrix[:3, :3].T, atol=1e-4)


def test_the_map_grows_while_computing(desk, form):
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    desk.type(form.scallop, "0.01 mm")
    desk.press(form.compute)
    desk.wait(lambda: chart.picture is not None, "the first map appears")
    looked = len(chart.picture.axes)
    assert form.tabs.currentWidget() is form.resultTab
    if form.stop.isEnabled():  # still computing
        assert not chart.isEnabled() and not desk.standard_button("Ok").isEnabled()
        desk.shot("12-growing")
    desk.wait(lambda: form.compute.isEnabled(), "the computation ends")
    assert len(chart.picture.axes) >= looked and "chosen" in chart.picture.marks


def test_the_maps_of_several_faces_grow_and_one_stays_chosen(desk):
    from types import SimpleNamespace

    import numpy as np
    from freecad.toolaxis.gui.axis_map.raster import SIDE, AxisPicture
    from freecad.toolaxis.gui.plan.result_tab import AxisView
    from freecad.toolaxis.gui.widgets.fields import load_form

    def picture():
        up = np.array([[0.0, 0.0, 1.0]])
        return AxisPicture(up, np.ones(1), np.ones(1), np.zeros(1, int), np.zeros(1), up[0], np.array([1.0, 0, 0]),
                           np.zeros((SIDE, SIDE), int))

    form, titles = load_form("plan"), {2: "Face 2", 5: "Face 5", 7: "Face 7"}
    view = AxisView(form, SimpleNamespace(clear=lambda: None))
    faces = {number: SimpleNamespace(number=number, label=str(number)) for number in titles}
    first, second, third = picture(), picture(), picture()

    def shown():
        return form.operation.currentText(), view.map.picture, form.cost.text()

    view.show_growing(first, faces[2], titles)
    assert shown() == ("Face 2", first, "Face 2: the axes tested so far")
    assert not form.operation.isHidden() and form.operation.itemText(2) == "Face 7: not begun"
    view.show_growing(second, faces[5], titles)
    assert shown() == ("Face 5", second, "Face 5: the axes tested so far"), "follows what is computed"
    form.operation.setCurrentIndex(2)
    assert shown() == ("Face 7: not begun", None, "Face 7: no axis tested yet")
    form.operation.setCurrentIndex(0)
    assert shown()[1] is first
    view.show_growing(third, faces[5], titles)
    assert shown()[1] is first, "stays where the user looks"
    form.operation.setCurrentIndex(1)
    assert shown()[1] is third
    view.show_growing(second, faces[7], titles)
    assert shown() == ("Face 7", second, "Face 7: the axes tested so far")
    view.clear()
    assert view.map.picture is None and form.operation.isHidden()


def test_pointer_and_click_on_the_map(desk, form, remembered):
    desk.computed(form)
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    centre, radius = chart.disc()
    desk.hover(chart, spot(chart, free=False))
    assert "not possible" in form.pointer.text()
    passes, chosen = desk.text(form.results, 1), chart.position_of(chart.picture.marks["chosen"])
    picture = chart.picture
    free = (picture.reason == 0) & (picture.axes @ picture.pole > 0.1)
    places = [chart.position_of(axis) for axis in picture.axes[free]]
    desk.hover(chart, max(places, key=lambda at: abs(at.x() - chosen.x()) + abs(at.y() - chosen.y())))
    assert form.pointer.text().startswith("estimate: strip width ")
    desk.hover(chart, chosen)
    assert form.pointer.text().startswith("chosen axis: ") and f", {passes} passes computed" in form.pointer.text()
    assert f"passes: {passes}," in form.message.text(), "one number for one thing"
    assert not form.lock.isEnabled()
    desk.click(chart, centre + desk.qt.QPointF(0.35 * radius, 0.2 * radius))
    desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
    assert form.results.columnCount() == 2
    assert "Against the best axis" in form.cost.text() and form.lock.isEnabled()
    passes = [desk.text(form.results, 1, column) for column in (0, 1)]
    assert int(passes[1]) >= int(passes[0])
    desk.shot("6-tried")
    desk.press(form.lock)
    assert desk.text(form.results, 1, 0) == passes[1] and form.results.columnCount() == 1
    desk.press(form.best)
    assert desk.text(form.results, 1, 0) == passes[0]


def test_a_forbidden_axis_says_why_and_cannot_be_locked(desk, form, remembered):
    desk.computed(form)
    chart = form.findChild(desk.widgets.QWidget, "axisMap")
    desk.click(chart, spot(chart, free=False))
    desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
    assert "cannot be used" in form.cost.text() and not form.lock.isEnabled()
    assert "Infeasible" in form.reasons.text()


def test_the_slider_moves_the_tool(desk, form, remembered):
    desk.computed(form)
    form.slide.setValue(0)
    desk.pump(0.1)
    desk.shot("7-slider-first")
    form.slide.setValue(500)
    desk.shot("8-slider-middle")


IMPOSSIBLE = (("corner", "30 mm", "corner radius"), ("diameter", "0 mm", "diameter"), ("scallop", "-1 mm", "scallop"),
              ("stickout", "0.5 mm", "stick-out"), ("allowance", "-1 mm", "allowance"),
              ("tolerance", "0 mm", "machining tolerance"), ("tolerance", "1 mm", "from 0.0005 to 0.1 mm"))


def test_impossible_values_lock_compute_with_the_reason(desk, form):
    for field, text, words in IMPOSSIBLE:
        widget = getattr(form, field)
        form.tabs.setCurrentWidget(next(tab for tab in (form.jobTab, form.toolTab, form.advancedTab)
                                        if tab.isAncestorOf(widget)))
        good = desk.shown(widget)
        desk.type(widget, text)
        assert not form.compute.isEnabled() and words in form.message.text(), (field, text)
        if field == "corner":
            desk.shot("9-refused")
        desk.type(widget, good)
        assert form.compute.isEnabled(), form.message.text()


def test_a_change_after_computing_locks_ok(desk, form, remembered):
    desk.computed(form)
    assert desk.standard_button("Ok").isEnabled()
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.3 mm")
    assert not desk.standard_button("Ok").isEnabled() and "compute again" in form.message.text()


def test_a_closed_panel_is_gone_with_its_plan(desk, form, remembered):
    desk.computed(form)
    known = desk.opened[-1]
    assert known().view.plan is not None
    desk.press(desk.standard_button("Cancel"))
    desk.tidy()
    assert known() is None


def test_limits_that_leave_no_axis(desk, form, remembered):
    form.limits.setCurrentIndex(1)
    form.limitZ.setValue(-1.0)
    desk.type(form.cone, "10 deg")
    desk.computed(form)
    assert "0 of 1 faces" in form.message.text() and not desk.standard_button("Ok").isEnabled()
    desk.shot("10-no-axis")
    assert form.remedy1.isVisible() and form.remedy1.text() == "Remove axis limits" and not form.remedy2.isVisible()
    desk.type(form.cone, "9 deg")
    assert not form.remedy1.isVisible(), "it was offered for other inputs"
    desk.type(form.cone, "10 deg")
    desk.computed(form)
    desk.press(form.remedy1)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "it is computed again")
    assert form.limits.currentIndex() == 0 and "Every face has an axis" in form.message.text(), form.message.text()
    assert not form.remedy1.isVisible() and desk.standard_button("Ok").isEnabled()


def test_a_refused_value_and_a_failed_computation_have_their_remedy_beside_them(desk, form, monkeypatch, remembered):
    from freecad.toolaxis.services import api

    desk.type(form.scallop, "30 mm")
    assert "give a smaller scallop height" in form.message.text() and not form.compute.isEnabled()
    assert [button.isVisible() for button in (form.remedy1, form.remedy2)] == [True, False]
    assert form.remedy1.text() == "Scallop height 0.20 mm"
    desk.shot("11-remedy-of-a-value")
    usual = api.task

    def lacking(inputs):
        def compute(progress):
            raise MemoryError
        return compute if inputs.scallop < 0.25 else usual(inputs)

    monkeypatch.setattr(api, "task", lacking)
    desk.press(form.remedy1)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "it is computed")
    assert "memory does not suffice" in form.message.text() and desk.shown(form.scallop) == "0.20 mm"
    assert form.remedy1.isVisible() and form.remedy1.text() == "Scallop height 0.50 mm"
    desk.shot("12-remedy-of-an-error")
    desk.press(form.remedy1)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "it is computed")
    assert "Every face has an axis" in form.message.text() and not form.remedy1.isVisible()


def test_passes_are_drawn_beside_an_operation_without_an_axis(desk, form, remembered):
    """Found: with one of two sub-surfaces machined the view stayed empty, since the other one is shown first."""
    form.limits.setCurrentIndex(1)
    form.limitZ.setValue(1.0)
    form.tabs.setCurrentWidget(form.toolTab)
    sizes = (form.diameter, "40 mm"), (form.corner, "6 mm"), (form.stickout, "60 mm"), (form.cone, "3 deg")
    for field, text in sizes:
        desk.type(field, text)
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.01 mm")
    desk.computed(form)
    preview = desk.opened[-1]().preview
    assert "1 of 2 faces" in form.message.text() and form.operation.currentText().endswith("no axis")
    desk.wait(lambda: not preview._left, "all is drawn")
    assert preview.root is None and preview._others.getNumChildren() == 2, "the passes of the other"
    assert "reasons are listed below" in form.findChild(desk.widgets.QWidget, "axisMap").reason
    desk.shot("13-one-of-two")


TYPED = (("0.1", "0.10 mm"), ("0,1", "0.10 mm"), (".02", "0.02 mm"), ("20 um", "0.02 mm"), ("1/8 in", "3.175 mm"),
         ("0.1 kg", "0.02 mm"), ("nonsense", "0.02 mm"), ("", "0.02 mm"))


def test_a_bare_number_is_millimetres(desk, form):
    form.tabs.setCurrentWidget(form.jobTab)
    for typed, shown in TYPED:
        desk.type(form.scallop, "0.02 mm")
        desk.type(form.scallop, typed)
        assert desk.shown(form.scallop) == shown, typed


def test_no_unit_system_shows_micrometres(desk, wavy, remembered):
    import FreeCAD

    before = FreeCAD.Units.getSchema()
    try:
        for number in range(len(FreeCAD.Units.listSchemas())):
            FreeCAD.Units.setSchema(number)
            form = desk.start(*wavy)
            for field in (form.scallop, form.allowance, form.diameter, form.stickout):
                assert desk.shown(field).split()[1] in ("mm", "in"), number
            assert desk.shown(form.feedrate).split()[1] in ("mm/min", "in/min"), number
            form.tabs.setCurrentWidget(form.jobTab)
            desk.type(form.scallop, "0.1")
            assert desk.shown(form.scallop).split() in (["0.10", "mm"], ["0.10", "in"]), number
            desk.press(desk.standard_button("Cancel"))
    finally:
        FreeCAD.Units.setSchema(before)


def test_the_wheel_changes_no_field_that_is_not_used(desk, form):
    from PySide import QtCore, QtGui

    form.tabs.setCurrentWidget(form.jobTab)
    form.compute.setFocus()
    before = desk.shown(form.scallop)
    here = QtCore.QPoint(5, 5)
    turn = QtGui.QWheelEvent(QtCore.QPointF(here), QtCore.QPointF(form.scallop.mapToGlobal(here)), QtCore.QPoint(),
                             QtCore.QPoint(0, 120), QtCore.Qt.NoButton, QtCore.Qt.NoModifier,
                             QtCore.Qt.NoScrollPhase, False)
    desk.app.sendEvent(form.scallop.focusProxy(), turn)
    assert desk.shown(form.scallop) == before


@pytest.mark.parametrize(("schema", "number"), [("ImperialDecimal", 3), ("MmMin", 6), ("Internal", 0)])
def test_units_follow_freecads_settings(desk, wavy, remembered, schema, number):
    import FreeCAD
    from freecad.toolaxis.gui.widgets.quantity import area_text

    names = FreeCAD.Units.listSchemas()
    before = FreeCAD.Units.getSchema()
    FreeCAD.Units.setSchema(names.index(schema) if schema in names else number)  # 1.0 lists their descriptions
    try:
        form = desk.start(*wavy)
        inches = schema == "ImperialDecimal"
        assert area_text(0.0434) == ("0.000067 in²" if inches else "0.043 mm²"), "a small part has no faces of 0 mm²"
        form.tabs.setCurrentWidget(form.toolTab)
        assert desk.shown(form.diameter).endswith(" in" if inches else " mm")
        desk.type(form.diameter, "0.25 in")
        assert desk.shown(form.diameter) == ("0.25 in" if inches else "6.35 mm")
        assert ("in" in desk.text(form.holder, 0, 0)) == inches
        form.tabs.setCurrentWidget(form.jobTab)
        desk.type(form.scallop, "0.0125 mm")
        assert desk.shown(form.scallop) == ("0.000492 in" if inches else "0.0125 mm")
        desk.shot(f"11-units-{schema}")
        desk.type(form.scallop, "0.05 mm")
        desk.computed(form)
        assert any("in" in desk.text(form.results, row, 0).split() for row in (2, 3)) == inches
        desk.press(desk.standard_button("Ok"))
        rate = 60 * desk.operation_in(wavy[0].Document).FeedRate.Value
        assert rate == pytest.approx(1000, abs=1e-6), "not 1000.2, from 16.67 mm/s"
    finally:
        FreeCAD.Units.setSchema(before)
