"""The add-on in German: the panel, its messages and the menu."""

import pytest


@pytest.fixture
def german(desk):
    """FreeCAD in German, and in English again afterwards."""
    desk.gui.setLocale("de")
    desk.pump(0.3)
    yield desk
    desk.tidy()
    desk.gui.setLocale("en")
    desk.pump(0.3)


def test_the_panel_speaks_german(german, wavy):
    part, face = wavy
    form = german.start(part, face)
    assert form.compute.text() == "Berechnen" and form.scallopLabel.text() == "Rillenhöhe"
    assert form.message.text().startswith("Berechnen findet die Achsen")
    menus = [action.text().replace("&", "") for menu in german.window.menuBar().findChildren(german.widgets.QMenu)
             for action in menu.actions()]
    assert "CAM-Aufträge anlegen" in menus and "Beispiele" in menus
    german.shot("95-german")
