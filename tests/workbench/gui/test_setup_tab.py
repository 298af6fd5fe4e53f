"""The tab Setup: origin and stock by mouse and keys, before and after Compute, and in the 3D view."""

import numpy as np
import pytest


@pytest.fixture(autouse=True)
def _remembered(remembered):
    """The plans are those of other tests: origin and stock change no passes."""


def choose(desk, combo, index):
    """Choose an entry of a combo box by keys, as a user does who has tabbed to it."""
    combo.setFocus()
    steps = index - combo.currentIndex()
    for _ in range(abs(steps)):
        desk._key(combo, desk.qt.Qt.Key_Down if steps > 0 else desk.qt.Qt.Key_Up, "")
    desk.pump(0.05)
    assert combo.currentIndex() == index


def setup_page(desk, form):
    """Turn to the tab."""
    bar = form.tabs.tabBar()
    desk.click(bar, bar.tabRect(form.tabs.indexOf(form.setupTab)).center())
    assert form.tabs.currentWidget() is form.setupTab


def origin_of(desk, part):
    """Where the work coordinate system of the only operation stands."""
    from freecad.toolaxis.document.children import frame_of

    return np.array(tuple(frame_of(desk.operation_in(part.Document)).Placement.Base))


def ok(desk):
    return desk.standard_button("Ok")


def closed(desk):
    desk.press(ok(desk))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")


def reds(desk, document, folder):
    """Whether the red arrow of a triad is in the 3D view."""
    return desk.red_points(document, folder) > 20


def test_a_corner_of_the_stock_from_the_panel_into_the_document(desk, wavy, form, tmp_path):
    part, _ = wavy
    assert not reds(desk, part.Document, tmp_path)
    setup_page(desk, form)
    assert reds(desk, part.Document, tmp_path), "the part's own origin is shown while the tab is open"
    assert not form.originPlace.isVisible() and not form.marginsGroup.isVisible()
    choose(desk, form.origin, 1)
    assert form.stockKind.currentIndex() == 1, "a point of the stock asks for its margins"
    assert form.originPlace.isVisible() and form.marginsGroup.isVisible() and not form.takeVertex.isVisible()
    choose(desk, form.originPlace, 1)
    desk.type(form.marginZHigh, "3 mm")
    desk.type(form.marginXLow, "2")
    desk.shot("setup-stock")
    assert form.stockSize.text() == "Stock: 23.00 mm x 18.00 mm x 15.50 mm"
    box = part.Shape.optimalBoundingBox(False, False)
    desk.computed(form)
    assert ok(desk).isEnabled(), form.message.text()
    desk.shot("setup-computed")
    closed(desk)
    assert np.allclose(origin_of(desk, part), [box.XMin - 2, box.YMin - 1, box.ZMax + 3], atol=1e-3)
    assert desk.operation_in(part.Document).StockBox == "2,1,1,1,1,3"


def test_the_triad_of_the_preview_stands_where_that_of_the_document_will(desk, wavy, form):
    """The first point of the arrow along X, and its end in that direction."""
    from FreeCAD import Vector
    from freecad.toolaxis.document.children import frame_of
    from pivy import coin

    part, _ = wavy
    setup_page(desk, form)
    choose(desk, form.origin, 2)
    desk.computed(form)
    preview = desk.opened[-1]().preview
    desk.wait(lambda: not preview._left, "all of the preview is drawn")
    action = coin.SoSearchAction()
    action.setType(coin.SoAnnotation.getClassTypeId())
    action.apply(preview.root)
    triad = action.getPath().getTail()
    action.setType(coin.SoCoordinate3.getClassTypeId())
    action.apply(triad)
    begin, end = (np.array(point.getValue()) for point in action.getPath().getTail().point.getValues())
    closed(desk)
    placement = frame_of(desk.operation_in(part.Document)).Placement
    assert np.allclose(begin, tuple(placement.Base), atol=1e-3)
    along = placement.Rotation.multVec(Vector(1, 0, 0))
    assert np.allclose((end - begin) / np.linalg.norm(end - begin), tuple(along), atol=1e-3)


def test_another_origin_needs_no_other_computation(desk, wavy, form):
    part, _ = wavy
    desk.computed(form)
    plan = desk.opened[-1]().view.plan
    setup_page(desk, form)
    choose(desk, form.origin, 2)
    assert ok(desk).isEnabled() and desk.opened[-1]().view.plan.operations[0].path is plan.operations[0].path
    choose(desk, form.origin, 1)
    assert ok(desk).isEnabled() and form.stockKind.currentIndex() == 1
    choose(desk, form.origin, 3)
    assert form.stockKind.currentIndex() == 0, "the stock was there for the point of it only"
    assert not ok(desk).isEnabled() and "Select a vertex of the part" in form.message.text()
    desk.press(form.takeVertex)
    assert not ok(desk).isEnabled() and "No vertex is selected" in form.message.text()
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(part.Document.Name, part.Name, "Vertex2")
    desk.press(form.takeVertex)
    desk.shot("setup-vertex")
    assert ok(desk).isEnabled(), form.message.text()
    closed(desk)
    assert np.allclose(origin_of(desk, part), tuple(part.Shape.Vertexes[1].Point), atol=1e-6)
    operation = desk.operation_in(part.Document)
    assert operation.Origin.startswith("point:") and not operation.Stale


def test_the_panel_shows_what_an_operation_was_planned_with(desk, wavy, form):
    part, _ = wavy
    setup_page(desk, form)
    choose(desk, form.origin, 1)
    choose(desk, form.originPlace, 6)
    desk.type(form.marginYHigh, "7 mm")
    desk.computed(form)
    closed(desk)
    operation = desk.operation_in(part.Document)
    assert operation.Origin == "stock:bottom" and operation.StockBox == "1,1,1,7,1,1"
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(part.Document.Name, operation.Name)
    desk.gui.runCommand("ToolAxis_Recompute")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    again = desk.form("ToolAxisPlan")
    assert (again.origin.currentIndex(), again.originPlace.currentIndex(), again.stockKind.currentIndex()) == (1, 6, 1)
    assert desk.shown(again.marginYHigh) == "7.00 mm"


def test_margins_that_are_none_are_refused_with_the_reason(desk, form):
    setup_page(desk, form)
    choose(desk, form.stockKind, 1)
    desk.type(form.marginXLow, "-1 mm")
    assert not form.compute.isEnabled() and "margin of the stock is -1.0 mm" in form.message.text()
    desk.type(form.marginXLow, "0 mm")
    assert form.compute.isEnabled(), form.message.text()
    choose(desk, form.origin, 1)
    choose(desk, form.stockKind, 0)
    assert not form.compute.isEnabled() and "is a point of the stock and there is none" in form.message.text()


def test_in_german_and_a_small_window(german, wavy):
    desk, (part, face) = german, wavy
    form = desk.start(part, face)
    setup_page(desk, form)
    choose(desk, form.origin, 1)
    usual = desk.window.size()
    desk.window.resize(1100, 700)
    desk.shot("setup-german")
    assert form.tabs.tabText(1) == "Aufspannung" and form.stockSize.text().startswith("Rohteil: ")
    choose(desk, form.origin, 3)
    assert "Eckpunkt des Teils auswählen" in form.message.text()
    desk.window.resize(usual)
