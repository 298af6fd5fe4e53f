"""Layouts of panels come with widgets of their own classes."""


def test_a_widget_of_a_wrong_class_is_loaded_again(desk, monkeypatch):
    from freecad.toolaxis.panels import fields
    from PySide import QtWidgets

    loaded = []

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            form = load(file)
            if not loaded:
                form.slide = QtWidgets.QWidget()
            loaded.append(form)
            return form

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    for name in ("plan", "operation"):
        form = fields.load_form(name)
        assert form is loaded[-1] and isinstance(form.slide, QtWidgets.QSlider)
    assert len(loaded) == 3


def test_a_form_that_is_dead_is_loaded_again(desk, monkeypatch):
    from freecad.toolaxis.panels import fields

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


def test_a_sound_layout_is_loaded_once(desk, monkeypatch):
    from freecad.toolaxis.panels import fields

    loaded = []

    class Loader:
        @staticmethod
        def loadUi(file, load=fields.FreeCADGui.PySideUic.loadUi):
            loaded.append(load(file))
            return loaded[-1]

    monkeypatch.setattr(fields.FreeCADGui, "PySideUic", Loader)
    for name in ("plan", "operation", "verify"):
        fields.load_form(name)
    assert len(loaded) == 3
