"""The planning panel in small windows: what is asked for, Compute, and the headline of the result are in sight."""

import pytest

#: The smallest window that FreeCAD's own panels are usable in, and those of usual notebooks.
WINDOWS = [(1000, 700), (1100, 700), (1400, 900)]
#: What is machined, with what, how fine, on what, and Compute.
ASKED = ("message", "compute", "stop", "facesTold", "addFaces", "rack", "scallop", "tolerance", "limits")


@pytest.fixture
def resize(desk):
    """Gives the window a size; afterwards it has the usual one."""
    usual = desk.window.size()

    def sized(width, height):
        desk.window.resize(width, height)
        desk.pump(0.5)

    yield sized
    desk.window.resize(usual)
    desk.pump(0.3)


def in_sight(widget):
    """Whether all of a widget can be seen."""
    return widget.isVisible() and widget.visibleRegion().boundingRect() == widget.rect()


def hidden(form, names):
    return [name for name in names if not in_sight(getattr(form, name))]


@pytest.mark.parametrize("size", WINDOWS)
def test_what_is_asked_for_and_compute_are_in_sight_together(desk, wavy, resize, size):
    resize(*size)
    form = desk.start(*wavy)
    form.rack.setCurrentIndex(form.rack.findText("general rack"))
    desk.pump(0.2)
    assert hidden(form, ASKED) == []
    desk.shot(f"95-{size[0]}-job")


def test_a_part_with_a_long_name_is_told_as_far_as_there_is_room(desk, wavy, resize):
    wavy[0].Label = "the name of a product that nobody shortened"
    form = desk.start(*wavy)
    told, whole = form.facesTold.text(), form.facesTold.toolTip()
    assert whole == f"1 of {wavy[0].Label}" and told.startswith("1 of the name") and told.endswith("\u2026")
    assert form.facesTold.fontMetrics().horizontalAdvance(told) <= form.facesTold.width()
    resize(1400, 900)
    assert len(form.facesTold.text()) >= len(told)


@pytest.mark.parametrize("size", WINDOWS)
def test_compute_and_the_headline_stay_whatever_is_scrolled(desk, form, resize, remembered, size):
    resize(*size)
    above = desk.around(form)
    assert not above.verticalScrollBar().maximum(), "FreeCAD has nothing to scroll: each tab scrolls for itself"
    for tab in (form.jobTab, form.toolTab, form.advancedTab):
        form.tabs.setCurrentWidget(tab)
        desk.pump(0.1)
        tab.verticalScrollBar().setValue(tab.verticalScrollBar().maximum())
        assert not tab.horizontalScrollBar().maximum(), tab.objectName()
        assert hidden(form, ("message", "compute", "stop")) == []
    desk.shot(f"96-{size[0]}-advanced")
    desk.computed(form)
    desk.pump(0.2)
    assert form.tabs.currentWidget() is form.resultTab
    assert hidden(form, ("message", "compute", "stop")) == []
    assert not above.verticalScrollBar().maximum() and not form.resultTab.horizontalScrollBar().maximum()
    desk.shot(f"97-{size[0]}-result")


def test_nothing_is_cut_off_in_german(german, wavy, resize, remembered):
    """FreeCAD's overlay is as wide as it is, and cuts off what is wider."""
    resize(1100, 700)
    form = german.start(*wavy)
    room = german.around(form).viewport().width()
    for rack in (1, 0):
        form.rack.setCurrentIndex(rack)
        form.kind.setCurrentIndex(form.kind.count() - 1)
        form.limits.setCurrentIndex(2)
        german.pump(0.2)
        assert form.minimumSizeHint().width() <= room, "job, tool and advanced"
        assert hidden(form, ASKED) == []
    form.limits.setCurrentIndex(0)
    form.kind.setCurrentIndex(0)
    german.type(form.scallop, "0.05 mm")
    german.computed(form)
    german.pump(0.2)
    assert form.minimumSizeHint().width() <= room, "result"
    assert form.operation.itemText(0).startswith("Fläche "), form.operation.itemText(0)
    assert hidden(form, ("message", "compute", "stop")) == []
    german.down(form.lockFeed)
    assert in_sight(form.lockAxis) and in_sight(form.lockFeed)
    german.shot("99-german-result")


def test_the_wheel_is_left_to_what_is_scrolled(desk, form):
    """Also over a field that has the focus.  Qt passes on what nobody takes, but only if it comes from outside."""
    from PySide import QtCore, QtGui

    here = QtCore.QPoint(5, 5)
    form.tabs.setCurrentWidget(form.advancedTab)
    for field, value in ((form.strategy, form.strategy.currentIndex), (form.direction, form.direction.currentIndex),
                         (form.roughness, form.roughness.value),
                         (form.allowance.focusProxy(), lambda: desk.shown(form.allowance))):
        before = value()
        field.setFocus()
        turn = QtGui.QWheelEvent(QtCore.QPointF(here), QtCore.QPointF(field.mapToGlobal(here)), QtCore.QPoint(),
                                 QtCore.QPoint(0, -120), QtCore.Qt.NoButton, QtCore.Qt.NoModifier,
                                 QtCore.Qt.NoScrollPhase, False)
        desk.app.sendEvent(field, turn)
        assert value() == before and not turn.isAccepted(), field.objectName()
