"""Layouts of panels come with widgets of their own classes."""

import pytest


@pytest.mark.parametrize("spoilt", ["slide", "mapLayout"])
def test_a_widget_or_layout_of_a_wrong_class_is_loaded_again(desk, monkeypatch, spoilt):
    from freecad.toolaxis.gui.widgets import fields
    from PySide import QtWidgets

    loaded = []

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            form = load(file)
            if not loaded:
                setattr(form, spoilt, QtWidgets.QWidget())
            loaded.append(form)
            return form

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    for name in ("plan", "operation"):
        form = fields.load_form(name)
        assert form is loaded[-1] and isinstance(form.slide, QtWidgets.QSlider)
        assert form.mapLayout.parentWidget().objectName() == "mapPlace"
    assert len(loaded) == 3


def test_a_form_that_is_dead_is_loaded_again(desk, monkeypatch):
    from freecad.toolaxis.gui.widgets import fields

    loaded = []

    class Dead:
        def objectName(self):
            raise RuntimeError("Internal C++ object (PySide6.QtWidgets.QDialogButtonBox) already deleted.")

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            loaded.append(load(file) if loaded else Dead())
            return loaded[-1]

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    form = fields.load_form("verify")
    assert form is loaded[1] and len(loaded) == 2


@pytest.mark.parametrize("whole", [True, False], ids=["form", "widget"])
def test_a_form_with_objects_of_dead_widgets_is_loaded_again_without_touching_them(desk, monkeypatch, whole):
    from freecad.toolaxis.gui.widgets import fields

    first, loaded = fields.FreeCADGui.PySideUic.loadUi(str(fields.RESOURCES / "ui" / "verify.ui")), []

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            form = load(file)
            if not loaded:  # as the bindings hand out what was known at an address: of the right class and name
                form.verify = first.verify
            loaded.append(first if whole and not loaded else form)
            return loaded[-1]

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    form = fields.load_form("verify")
    assert form is loaded[1] and form is not first and form.verify is not first.verify and len(loaded) == 2


def test_a_form_that_is_spoilt_each_time_is_not_shown(desk, monkeypatch):
    from freecad.toolaxis.gui.widgets import fields

    form = fields.FreeCADGui.PySideUic.loadUi(str(fields.RESOURCES / "ui" / "verify.ui"))
    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", type("Loader", (), {"loadUi": staticmethod(lambda _: form)}))
    with pytest.raises(RuntimeError, match="open it once more"):
        fields.load_form("verify")


def test_a_sound_layout_is_loaded_once(desk, monkeypatch):
    from freecad.toolaxis.gui.widgets import fields
    from PySide import QtWidgets

    loaded = []

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            loaded.append(load(file))
            return loaded[-1]

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    for name in ("plan", "operation", "verify", "export", "machine"):
        form = fields.load_form(name)
        # else FreeCAD squeezes widgets over one another
        assert getattr(form, f"{name}Layout").sizeConstraint() == QtWidgets.QLayout.SetMinimumSize
    assert len(loaded) == 5


#: Classes of widgets that show or hold others, and what is done by mouse or keys goes to those.
PASSIVE = ("QWidget", "QLabel", "QGroupBox", "QProgressBar", "QTabWidget", "QFrame", "QScrollArea", "QSplitter")


def layouts():
    """Each layout with its own widgets but for passive ones, (name, class, element)."""
    from pathlib import Path
    from xml.etree import ElementTree

    for path in sorted((Path(__file__).resolve().parents[3] / "resources" / "ui").glob("*.ui")):
        yield path.stem, [(widget.get("name"), widget.get("class"), widget)
                          for widget in ElementTree.parse(path).iter("widget") if widget.get("class") not in PASSIVE]


def test_every_widget_tells_what_it_is_for(desk):
    """Tooltips, and the same or more for "What's this?"; the preferences' page is loaded by FreeCAD itself."""
    from freecad.toolaxis.gui.widgets.fields import load_form

    for layout, widgets in layouts():
        form = None if layout == "preferences" else load_form(layout)
        for name, _, element in widgets:
            if form is None:
                texts = [element.findtext(f"property[@name='{one}']/string", "") for one in ("toolTip", "whatsThis")]
            else:
                widget = getattr(form, name)
                texts = [widget.toolTip(), widget.whatsThis()]
            assert all(len(text) > 10 and text.endswith(".") for text in texts), (layout, name, texts)


def test_numbers_have_ends_that_they_may_have(desk):
    """Spin boxes of the layouts name both ends; fields of quantities take all, and what is wrong is told below."""
    for layout, widgets in layouts():
        for name, kind, element in widgets:
            if kind.endswith("SpinBox") and "Quantity" not in kind:
                low, high = (float(element.findtext(f"property[@name='{end}']/*")) for end in ("minimum", "maximum"))
                assert low < high and abs(low) <= 1e5 and high <= 2e5, (layout, name)
                assert low >= 0 or name.startswith(("offset", "limit")), (layout, name)
