"""Axes that move, from the panel: chosen, refused where they do not apply, computed, drawn, and put into the tree."""

from freecad.toolaxis.document.strategies import STRATEGIES


def choose(form, name):
    form.strategy.setCurrentIndex(STRATEGIES.index(name))


def names(document):
    return [thing.Name for thing in document.Objects]


def pictures(desk, button):
    """The window that a button opens."""
    desk.press(button)
    desk.wait(lambda: desk.form("ToolAxisPictures") is not None, "the pictures are drawn")
    return desk.form("ToolAxisPictures")


def test_a_moving_axis_is_chosen_refused_computed_and_drawn(desk, wavy, tmp_path):
    part, face = wavy
    form, document = desk.start(part, face), part.Document
    before = names(document)
    form.tabs.setCurrentWidget(form.toolTab)
    desk.type(form.diameter, "6 mm")
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.3 mm")
    form.tabs.setCurrentWidget(form.advancedTab)
    assert not form.roughness.isVisible() and form.method.isEnabled() and form.passes.isEnabled()
    form.method.setCurrentIndex(form.method.findText("highest axis jerk along passes"))
    form.passes.setCurrentIndex(form.passes.findText("in parallel planes"))
    assert not form.compute.isEnabled() and "choose a machine among the limits" in form.message.text()
    desk.shot("68-method-refused")
    form.limits.setCurrentIndex(form.limits.findData("machine:bc-table-table"))
    assert form.compute.isEnabled()
    form.limits.setCurrentIndex(0)
    choose(form, "four-plus-one")
    assert not form.compute.isEnabled() and "choose a machine among the limits" in form.message.text()
    assert not form.method.isEnabled() and not form.passes.isEnabled() and "Needs a machine" in form.strategyNote.text()
    desk.shot("68-strategy-refused")
    choose(form, "multiscale")
    assert form.roughness.isVisible() and not form.compute.isEnabled()
    form.limits.setCurrentIndex(form.limits.findData("machine:bc-table-table"))
    assert form.compute.isEnabled()
    desk.computed(form)
    assert "'multiscale' does not serve face" in form.message.text() and names(document) == before
    assert not desk.standard_button("Ok").isEnabled()
    desk.shot("69-strategy-in-vain")
    form.tabs.setCurrentWidget(form.advancedTab)
    choose(form, "sturz")
    desk.computed(form)
    assert "Every face has an axis" in form.message.text() and names(document) == before
    assert not form.mapPlace.isVisible() and not form.lockAxis.isVisible() and form.slide.isVisible()
    rows = [form.results.model().headerData(k, desk.qt.Qt.Vertical) for k in range(form.results.rowCount())]
    assert "Mean lean" in rows
    desk.shot("70-moving-axis")
    window = pictures(desk, form.pictures)
    assert [desk.text(window.list, k) for k in range(window.list.count())] == ["Passes and tool, op01-face" + face[4:]]
    assert window.image.pixmap().width() > 300
    window.save(tmp_path)
    assert (tmp_path / f"op01-face{face[4:]}-passes.png").stat().st_size > 10000
    desk.shot("71-pictures")
    window.close()
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    made = desk.operation_in(document)
    assert made.AxisMoves and made.Strategy == "sturz" and not made.Stale
    kinds = [thing.TypeId for thing in made.Group]
    assert "Path::Feature" in kinds and "Part::Feature" in kinds
    desk.shot("72-moving-in-the-tree")
    made.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisOperation") is not None, "the panel opens")
    form = desk.form("ToolAxisOperation")
    assert not form.mapPlace.isVisible()
    form.slide.setValue(500)
    window = pictures(desk, form.pictures)
    assert window.list.count() == 1
    desk.shot("73-moving-operation")
    window.close()
    desk.press(desk.standard_button("Close"))
    document.undo()
    desk.pump(0.2)
    assert names(document) == before, "one undo step takes all back"
