"""A part in two setups by the panel: a plan with a clamped side, then another that takes what the first one leaves."""

import pytest


@pytest.fixture
def roof(desk, whole_parts):
    """A block with a sculptured top, and the name of that face."""
    import FreeCAD

    document = FreeCAD.newDocument("Roof")
    document.UndoMode = 1
    thing, name = whole_parts.roof(document)
    view = desk.gui.getDocument(document.Name).ActiveView
    view.viewIsometric()
    view.fitAll()
    return thing, name


def plans_in(document):
    from freecad.toolaxis.document.kinds import is_plan

    return list(filter(is_plan, document.Objects))


def begin(desk, roof, side):
    """The panel for the face, with a side that is clamped."""
    form = desk.start(*roof)
    desk.type(form.scallop, "0.3 mm")
    form.tabs.setCurrentWidget(form.advancedTab)
    desk.down(form.held)
    desk.type(form.held, side)
    return form


def close_with(desk, button):
    desk.press(desk.standard_button(button))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")


def choose(desk, combo, steps):
    """Go down in a list by keys."""
    combo.setFocus()
    for _ in range(steps):
        desk._key(combo, desk.qt.Qt.Key_Down, "")
    desk.pump(0.1)


def test_the_next_setup_is_a_click_away(desk, roof):
    document = roof[0].Document
    form = begin(desk, roof, "x<10")
    assert not form.after.isVisible() and not form.afterLabel.isVisible(), "there is no setup to follow"
    assert not form.nextSetup.isVisible()
    desk.computed(form)
    assert "Clamped in this setup: " in form.message.text() and form.nextSetup.isVisible()
    desk.shot("97-clamped")
    desk.press(form.nextSetup)
    desk.wait(lambda: desk.form("ToolAxisPlan") not in (None, form), "the next panel opens")
    (first,) = plans_in(document)
    form = desk.form("ToolAxisPlan")
    assert form.after.currentText() == first.Label == "Plan" and not form.held.text()
    assert form.facesTold.toolTip() == "1 of Roof, as in the earlier setup"
    assert form.addFaces.isHidden() and form.removeFaces.isHidden(), "the faces are given"
    desk.shot("97-next-faces")
    form.tabs.setCurrentWidget(form.advancedTab)
    desk.down(form.after)
    desk.type(form.held, "x>27")
    assert form.after.isVisible()
    desk.shot("97-next-fields")
    desk.computed(form)
    assert "Machined in earlier setups: " in form.message.text(), form.message.text()
    desk.shot("97-next-result")
    close_with(desk, "Ok")
    second = plans_in(document)[1]
    assert second.After == first and not second.Stale and second.Held == "x>27"
    desk.shot("97-next-tree")
    first.Scallop = 0.2
    document.recompute()
    desk.pump(0.2)
    assert second.Label.endswith("(out of date)")
    second.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    assert form.after.currentText() == "Plan" and "the earlier setup Plan is out of date" in form.message.text()
    desk.press(form.compute)
    assert form.message.text().startswith("the earlier setup 'Plan' is out of date (scallop was changed)")
    desk.shot("97-next-refused")
    close_with(desk, "Cancel")


def test_an_earlier_setup_is_chosen_and_given_up_again(desk, roof, whole_parts, remembered):
    document = roof[0].Document
    whole_parts.roof(document, "Other")
    form = begin(desk, roof, "x<10")
    desk.computed(form)
    close_with(desk, "Ok")
    (first,) = plans_in(document)
    form = desk.start(document.getObject("Other"))
    assert not form.after.isVisible(), "the plan is one of another part"
    close_with(desk, "Cancel")
    form = desk.start()
    form.tabs.setCurrentWidget(form.advancedTab)
    assert form.after.isVisible() and form.after.currentText() == "none" and not form.faces.count()
    choose(desk, form.after, 1)
    assert form.after.currentText() == "Plan" and form.facesTold.toolTip() == "1 of Roof, as in the earlier setup"
    assert [desk.text(form.avoid, row) for row in range(form.avoid.count())] == ["Other"], "not what is machined"
    assert form.compute.isEnabled()
    desk._key(form.after, desk.qt.Qt.Key_Up, "")
    assert form.facesTold.toolTip() == "1 of Roof" and not form.addFaces.isHidden()
    choose(desk, form.after, 1)
    document.removeObject(first.Name)
    desk.pump(0.2)
    assert "The earlier setup was deleted" in form.message.text() and not form.after.isVisible()
    assert not form.addFaces.isHidden() and form.faces.count() == 1
    close_with(desk, "Cancel")
    assert not plans_in(document)


def test_a_plan_does_not_follow_itself(desk, roof, remembered):
    form = begin(desk, roof, "x<10")
    desk.computed(form)
    close_with(desk, "Ok")
    (first,) = plans_in(roof[0].Document)
    first.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    form.tabs.setCurrentWidget(form.advancedTab)
    assert not form.after.isVisible()
    close_with(desk, "Cancel")


def test_in_german(german, roof, remembered):
    desk = german
    form = begin(desk, roof, "x<10")
    desk.computed(form)
    assert "In dieser Aufspannung gespannt: " in form.message.text()
    assert form.nextSetup.text() == "OK und nächste Aufspannung planen"
    desk.shot("98-clamped-german")
    desk.press(form.nextSetup)
    desk.wait(lambda: desk.form("ToolAxisPlan") not in (None, form), "the next panel opens")
    form = desk.form("ToolAxisPlan")
    assert form.facesTold.toolTip() == "1 von Roof, wie in der früheren Aufspannung"
    desk.shot("98-faces-german")
    form.tabs.setCurrentWidget(form.advancedTab)
    desk.down(form.after)
    assert form.afterLabel.text() == "Frühere Aufspannung"
    desk.shot("98-fields-german")
    desk.type(form.held, "x>27")
    desk.computed(form)
    assert "In früheren Aufspannungen bearbeitet: " in form.message.text()
    desk.shot("98-result-german")
    close_with(desk, "Cancel")
