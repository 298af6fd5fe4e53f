"""Computations that are stopped, and what is closed or deleted under them; the window stays alive."""

import pytest


@pytest.mark.parametrize("delay", [0.0, 0.1, 0.5])
def test_stop_leaves_the_document_as_it_was(desk, wavy, form, delay):
    before = [thing.Name for thing in wavy[0].Document.Objects]
    desk.type(form.scallop, "0.01 mm")
    desk.press(form.compute)
    desk.pump(delay)
    if form.stop.isEnabled():
        desk.press(form.stop)
    desk.wait(lambda: form.compute.isEnabled(), "the computation stops")
    assert "Stopped" in form.message.text() or "Every face" in form.message.text()
    assert [thing.Name for thing in wavy[0].Document.Objects] == before


def test_cancel_while_computing(desk, wavy, form):
    before = [thing.Name for thing in wavy[0].Document.Objects]
    desk.press(form.compute)
    desk.pump(0.1)
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert [thing.Name for thing in wavy[0].Document.Objects] == before


def test_the_panel_is_taken_away_while_computing(desk, form):
    desk.press(form.compute)
    desk.pump(0.2)
    desk.gui.Control.closeDialog()
    desk.pump(1.0)
    assert desk.form("ToolAxisPlan") is None


def test_document_closed_while_computing(desk, wavy, form):
    import FreeCAD

    desk.press(form.compute)
    desk.pump(0.2)
    FreeCAD.closeDocument(wavy[0].Document.Name)
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")


def test_part_deleted_while_computing(desk, wavy, form):
    part = wavy[0]
    desk.press(form.compute)
    desk.pump(0.2)
    part.Document.removeObject(part.Name)
    desk.pump(0.5)
    assert "deleted" in form.message.text() and not form.compute.isEnabled()
    assert form.faces.count() == 0


def test_the_window_stays_alive_while_computing(desk, form):
    import time

    gaps, last = [], [time.perf_counter()]

    def tick():
        now = time.perf_counter()
        gaps.append(now - last[0])
        last[0] = now

    timer = desk.qt.QTimer()
    timer.setInterval(5)
    timer.timeout.connect(tick)
    form.compute.click()
    last[0] = time.perf_counter()
    timer.start()
    desk.wait(lambda: form.compute.isEnabled() or form.stop.isEnabled() is False, "the computation ends")
    timer.stop()
    assert len(gaps) > 5 and sorted(gaps)[len(gaps) // 2] < 0.2
