"""The panel of Verify: the map on the face, its legend, the worst points, and a click that zooms to one."""

import pytest


@pytest.fixture
def planned(operation):
    """A document with an operation."""
    return operation.Document


def opened(desk):
    """The form of Verify, open and still judging."""
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Verify")
    desk.wait(lambda: desk.form("ToolAxisVerify") is not None, "the panel opens")
    return desk.form("ToolAxisVerify")


def judged(desk):
    """The form of Verify, done."""
    form = opened(desk)
    desk.wait(lambda: form.verify.isEnabled(), "the judge is done")
    desk.pump(0.5)
    return form


def test_the_map_is_painted_and_a_click_zooms(desk, planned):
    form = judged(desk)
    assert "nside tolerance" in form.message.text()
    desk.shot("30-verified")
    camera = desk.gui.getDocument(planned.Name).ActiveView.getCameraNode()
    before = camera.height.getValue()
    assert form.worst.count() > 0
    rect = form.worst.visualRect(form.worst.model().index(0, 0))
    desk.click(form.worst.viewport(), rect.center())
    assert camera.height.getValue() < before
    desk.shot("31-zoomed")
    form.what.setCurrentIndex(1)
    desk.pump(0.5)
    desk.shot("32-gouge")
    desk.press(desk.standard_button("Close"))
    assert desk.form("ToolAxisVerify") is None


def test_what_is_left_to_clean_up_is_passed_over(desk, planned):
    """Another operation of the document, which has no axis and no passes, does not keep this one from being judged."""
    from freecad.toolaxis.document.operation import OperationProxy

    other = planned.addObject("App::DocumentObjectGroupPython", "Operation")
    OperationProxy(other)
    form = judged(desk)
    assert "nside tolerance" in form.message.text() and form.worst.count() > 0


def test_stop_and_verify_again(desk, planned):
    form = opened(desk)
    if form.stop.isEnabled():
        desk.press(form.stop)
    desk.wait(lambda: form.verify.isEnabled(), "the judge stops")
    desk.press(form.verify)
    desk.wait(lambda: form.verify.isEnabled(), "the judge is done")
    assert "nside tolerance" in form.message.text()


def test_document_closed_while_judging(desk, planned):
    import FreeCAD

    opened(desk)
    FreeCAD.closeDocument(planned.Name)
    desk.wait(lambda: desk.form("ToolAxisVerify") is None, "the panel closes")
