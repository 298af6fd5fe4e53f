"""Preferences, the menu of examples, and the add-on in German."""

import FreeCAD
import pytest


@pytest.fixture
def kept():
    """Where preferences are kept, empty before and after."""
    from freecad.toolaxis.document.preferences import PLACE

    group = FreeCAD.ParamGet(PLACE)
    group.Clear()
    yield group
    group.Clear()


def on_page(desk, act):
    """Open FreeCAD's preferences at our page, do something with it, and answer OK."""
    from PySide import QtCore, QtWidgets

    seen = []

    def visit():
        dialog = desk.app.activeModalWidget()
        if dialog is None or seen:
            return
        page = dialog.findChild(QtWidgets.QWidget, "ToolAxisPreferences")
        seen.append(page is not None)
        try:
            if page is not None:
                act(page)
        finally:
            box = dialog.findChild(QtWidgets.QDialogButtonBox)
            box.button(QtWidgets.QDialogButtonBox.Ok).click()

    timer = QtCore.QTimer()
    timer.setInterval(500)
    timer.timeout.connect(visit)
    timer.start()
    desk.gui.showPreferences("Tool Axis", 0)
    timer.stop()
    assert seen == [True]


def test_the_page_keeps_what_is_set(desk, kept, tmp_path):
    from freecad.toolaxis.document.preferences import threads

    def fill(page):
        page.findChild(desk.widgets.QWidget, "tool").setText("ball:4")
        page.findChild(desk.widgets.QWidget, "scallop").setValue(0.03)
        page.findChild(desk.widgets.QWidget, "feed").setValue(640)
        page.findChild(desk.widgets.QWidget, "folder").setProperty("fileName", str(tmp_path))
        assert page.findChild(desk.widgets.QWidget, "threads").value() == threads() == 2
        page.findChild(desk.widgets.QWidget, "threads").setValue(3)
        desk.shot("90-preferences")

    on_page(desk, fill)
    assert kept.GetString("Tool") == "ball:4" and kept.GetFloat("Scallop") == pytest.approx(0.03)
    assert kept.GetFloat("FeedRate") == 640 and kept.GetString("MachinesFolder") == str(tmp_path)
    assert threads() == 3


def test_new_plans_begin_with_what_is_preferred(desk, kept, wavy):
    from freecad.toolaxis.services.defaults import defaults

    part, face = wavy
    usual = defaults(part.Document, ((part, face),))
    assert usual.tool.startswith("torus:") and not usual.rack
    assert defaults(part.Document, ((part, face),), whole=True).rack == ("general-rack",)
    kept.SetString("Tool", "ball:4")
    kept.SetFloat("Scallop", 0.03)
    kept.SetFloat("FeedRate", 640.0)
    found = defaults(part.Document, ((part, face),))
    assert (found.tool, found.scallop, found.feedrate, found.spindle) == ("ball:4", 0.03, 640.0, usual.spindle)
    assert not defaults(part.Document, ((part, face),), whole=True).rack, "the tool is preferred to any rack"
    assert found.stickout == 20.0 and found.assembled().kind == "ball"
    kept.SetString("Tool", "ball")
    assert defaults(part.Document, ((part, face),)).tool == usual.tool, "a tool that is none"


def test_colours_are_those_of_the_preferences(kept):
    from freecad.toolaxis.document.preferences import colours

    assert colours()[0] == pytest.approx((0.9, 0.38, 0.0), abs=0.005)
    kept.SetUnsigned("CutColour", 0x0000FFFF)
    assert colours()[0] == (0.0, 0.0, 1.0)


def test_every_example_of_the_menu_is_there_and_opens(desk):
    from freecad.toolaxis.gui.commands.examples import PARTS, Example

    assert all(Example(name).file.is_file() for name in PARTS)
    assert {file.stem for file in Example("dish").file.parent.glob("*.step")} == set(PARTS), "none is left out"
    menus = desk.children(desk.widgets.QMenu, desk.window.menuBar())
    texts = [action.text().replace("&", "") for menu in menus for action in menu.actions()]
    assert {"Examples", *PARTS.values()} <= set(texts)
    desk.gui.runCommand("ToolAxis_Example_saddle")
    desk.pump(0.3)
    document = FreeCAD.ActiveDocument
    assert document.Name == "saddle" and document.Objects[0].Label == "Saddle" and document.UndoCount == 0
    assert any(type(face.Surface).__name__ == "BSplineSurface" for face in document.Objects[0].Shape.Faces)
    desk.shot("91-example")


def test_the_tour_opens_from_both_menus(desk):
    bar = desk.window.menuBar()
    for title in ("Tool Axis", "Help"):
        actions = bar.actions()  # held: in FreeCAD 1.0 a menu's object ends with that of its action
        menu = next(action for action in actions if action.text().replace("&", "") == title).menu()
        entries = menu.actions()
        tour = [action for action in entries if action.text().replace("&", "") == "Tool Axis Tour"]
        assert len(tour) == 1, title
    tour[0].trigger()
    desk.wait(lambda: desk.form("ToolAxisManual") is not None, "the manual opens")
    window = desk.form("ToolAxisManual")
    text = window.page.toPlainText()
    assert text.startswith("A tour through FreeCAD") and "Compute" in text and len(text) > 5000
    assert window.page.toHtml().count("<img ") > 8 and not window.page.horizontalScrollBar().maximum()
    desk.shot("92-tour")
    window.page.anchorClicked.emit(desk.qt.QUrl("tools.md"))
    assert "library" in window.page.toPlainText() and window.page.toPlainText() != text
    desk.press(window.back)
    assert window.page.toPlainText() == text and not window.back.isEnabled()
    window.close()
    # what FreeCAD's own loop does: Qt 5 keeps what is to be deleted while no loop runs
    desk.app.sendPostedEvents(window, int(desk.qt.QEvent.DeferredDelete))
    desk.wait(lambda: desk.form("ToolAxisManual") is None, "the manual is closed")


def test_the_panel_speaks_german(german, wavy):
    part, face = wavy
    form = german.start(part, face)
    assert form.compute.text() == "Berechnen" and form.scallopLabel.text() == "Rillenhöhe"
    assert form.message.text().startswith("Auf Berechnen drücken, um die Achsen zu suchen")
    menus = [action.text().replace("&", "") for menu in german.children(german.widgets.QMenu, german.window.menuBar())
             for action in menu.actions()]
    assert "CAM-Aufträge anlegen" in menus and "Beispiele" in menus
    german.shot("95-german")


def test_reasons_progress_and_wrong_inputs_are_german(german, wavy):
    """What the library says, in English in plans and documents, is German in the window."""
    part, face = wavy
    form = german.start(part, face)
    form.tabs.setCurrentWidget(form.jobTab)
    german.type(form.scallop, "50 mm")
    assert form.message.text().startswith("Rillenhöhe ist 50"), form.message.text()
    assert "eine kleinere Rillenhöhe angeben" in form.message.text()
    assert form.remedy1.isVisible() and form.remedy1.text().startswith("Rillenhöhe 0"), form.remedy1.text()
    german.type(form.scallop, "0.005 mm")  # long enough that what it says along the way is seen
    said = set()
    german.press(form.compute)
    german.wait(lambda: said.add(form.message.text().split("\n")[0]) or form.compute.isEnabled(), "the end")
    assert any(text.startswith("Fläche ") for text in said), said
    german.type(form.scallop, "0.1 mm")
    form.limits.setCurrentIndex(1)
    form.limitZ.setValue(-1.0)
    german.type(form.cone, "10 deg")
    german.press(form.compute)
    german.wait(lambda: said.add(form.message.text().split("\n")[0]) or form.compute.isEnabled(), "the end")
    assert not any("Face " in text or "axes" in text for text in said), said
    reasons = form.reasons.text().split("\n")
    assert reasons[0].startswith("Unmöglich") and " Achsen " in reasons[0], reasons
    assert "Achsen geprüft: " in reasons[-1] and "außerhalb der Grenzen" in reasons[-1], reasons
    assert form.remedy1.isVisible() and form.remedy1.text() == "Grenzen der Achse aufheben", form.remedy1.text()
    german.down(form.reasons)
    german.shot("96-german-reasons")
