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


def orange(verdict, name):
    """How many points of a map are painted as above what is accepted."""
    import numpy as np
    from freecad.toolaxis.document.colour_scale import ABOVE, judged
    from freecad.toolaxis.document.verdict_maps import greatest_accepted, limit_of

    one, = verdict.maps[:1]
    rgb = judged(getattr(one, name), limit_of(verdict, name), greatest_accepted(verdict, name), one.declared)
    return int((rgb == np.array(ABOVE)).all(axis=1).sum())


def changed(verdict, name, ray, height):
    """A verdict with another height, or depth, at one ray of its first map, and the share that follows."""
    from dataclasses import replace

    values = getattr(verdict.maps[0], name).copy()
    values[ray] = height
    one = replace(verdict.maps[0], **{name: values})
    found = replace(verdict, maps=(one, *verdict.maps[1:]))
    return replace(found, share_within=one.share_within(1.02 * verdict.scallop_limit), area=one.area)


def test_picture_and_share_say_the_same(desk, planned):
    """Found: orange places beside 100.00 %, where they lay on the border or were lost in rounding."""
    import numpy as np
    from freecad.toolaxis.gui.verify.panel import share_text

    form = judged(desk)
    panel = desk.opened[-1]()
    verdict = panel.found[0][0]
    one, limit = verdict.maps[0], verdict.scallop_limit
    names = [form.results.verticalHeaderItem(k).text() for k in range(form.results.rowCount())]
    assert "Machined within 0.05100 mm" in names and panel.scale.most == pytest.approx(0.051)
    assert orange(verdict, "remaining") == 0 and share_text(verdict) == "100.00 %"
    border, inner = np.flatnonzero(one.border)[0], int(np.argmin(np.where(one.weight > 0, one.weight, np.inf)))
    seen = changed(verdict, "remaining", border, 2 * limit)
    assert orange(seen, "remaining") == 1 and share_text(seen) == "100.00 %, border aside"
    seen = changed(verdict, "remaining", inner, 2 * limit)
    assert orange(seen, "remaining") == 1 and share_text(seen) in ("> 99.99 %", f"{100 * seen.share_within:.2f} %")
    assert share_text(seen) != "100.00 %"
    seen = changed(verdict, "remaining", inner, 1.01 * limit)
    assert orange(seen, "remaining") == 0 and share_text(seen) == "100.00 %"
    seen = changed(verdict, "gouge", inner, 1.01 * verdict.gouge_allowed)
    assert orange(seen, "gouge") == 1, "the judge accepts no gouge above the tolerance"


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
