"""Layouts of panels, their messages, and the outlines of shank and holder."""

from xml.etree import ElementTree

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

try:
    import shiboken6 as shiboken
except ImportError:  # FreeCAD 1.0
    import shiboken2 as shiboken

from freecad.toolaxis.gui.widgets import palette
from freecad.toolaxis.gui.widgets.quantity import length_text, value_from_text
from freecad.toolaxis.gui.widgets.table_entries import data_of, put
from freecad.toolaxis.paths import RESOURCES

translate = FreeCAD.Qt.translate

_DATA = QtCore.Qt.UserRole
#: How often a layout is loaded until all its widgets are of their own class.
_LOADINGS = 5


def load_form(name):
    """The widget of a layout file.

    Where a dead widget lay at the address of a new one, the bindings may hand out the dead one's Python object, which
    is of another class, raises when touched or ends FreeCAD (seen: a QWidget instead of a slider or a layout, a dead
    box of buttons instead of the form, a former form with all its dead widgets).  So these are collected before a panel
    is made; where that does not do, the file is loaded again, elsewhere in memory.  Panels take widgets and layouts by
    their names here, as they were looked at.

    Parameters
    ----------
    name : str
        Without its ending.

    Raises
    ------
    RuntimeError
        Where every loading met dead widgets.
    """
    file = RESOURCES / "ui" / f"{name}.ui"
    root = next(ElementTree.parse(file).iter("widget"))
    widgets = {one.get("name"): getattr(QtWidgets, one.get("class"), QtWidgets.QWidget)
               for one in root.iter("widget") if one is not root}
    layouts = {one.get("name"): getattr(QtWidgets, one.get("class")) for one in root.iter("layout")}
    spoilt = []
    for _ in range(_LOADINGS):
        known = shiboken.getAllValidWrappers()  # held meanwhile: what is new cannot be mistaken for one of these
        form = FreeCADGui.PySideUic.loadUi(str(file))
        if _sound(form, root.get("name"), {**widgets, **layouts}, {id(one) for one in known}):
            break
        spoilt.append(form)  # kept until another is loaded, so that it lies elsewhere
    else:
        raise RuntimeError(translate("ToolAxis", "FreeCAD has mixed up this panel with one that was closed: open it "
                                                 "once more, or restart FreeCAD"))
    form.wheel = WheelScrolls(form)
    for child, kind in widgets.items():
        if issubclass(kind, QtWidgets.QComboBox | QtWidgets.QAbstractSpinBox):
            getattr(form, child).installEventFilter(form.wheel)
    for child in widgets:  # what a tooltip says is what "What's this?" says, where the layout has no more to say
        widget = getattr(form, child)
        if not widget.whatsThis():
            widget.setWhatsThis(widget.toolTip())
    return form


class WheelScrolls(QtCore.QObject):
    """Leaves the wheel over a combo box or a spin box to what is scrolled: scrolling a panel changes no field."""

    def eventFilter(self, watched, event):
        """Qt asks what becomes of an event."""
        if event.type() != QtCore.QEvent.Wheel:
            return False
        event.ignore()  # it goes on to what the field stands in
        return True


def fit_pages(form, names):
    """Make scroll areas wide enough for what is in them, so that they scroll up and down only.

    Parameters
    ----------
    form : QWidget
    names : sequence of str
        Of QScrollArea widgets of its layout.
    """
    for name in names:
        area = getattr(form, name)
        width = area.widget().minimumSizeHint().width() + area.verticalScrollBar().sizeHint().width()
        if area.minimumWidth() != width:
            area.setMinimumWidth(width)


def _sound(form, name, expected, known):
    """Whether a form, its widgets and its layouts are what the file says, and none has a dead one's Python object.

    Objects that were there before, by their identities in `known`, are of dead widgets; these are not touched.
    """
    held = vars(form)
    found = {child: held.get(child) for child in expected}
    if any(id(one) in known for one in (form, *found.values())):
        return False
    try:
        return form.objectName() == name and all(
            isinstance(one, expected[child]) and one.objectName() == child and _parts_sound(one)
            for child, one in found.items())
    except RuntimeError:  # "Internal C++ object already deleted"
        return False


def _parts_sound(widget):
    """Whether the model and the heads of a table or a list are such."""
    if isinstance(widget, QtWidgets.QTableWidget) and not all(
            isinstance(head, QtWidgets.QHeaderView) for head in (widget.horizontalHeader(), widget.verticalHeader())):
        return False
    return not isinstance(widget, QtWidgets.QAbstractItemView) or isinstance(widget.model(), QtCore.QAbstractItemModel)


def tell(label, text, bad=False):
    """Show a sentence on a label, in a warning colour where it is bad; nothing is drawn anew without need.

    Parameters
    ----------
    label : QLabel
    text : str
    bad : bool
    """
    colour = ("#ff9e80" if palette.is_dark(label.parentWidget().palette()) else "#a33c00") if bad else ""
    style = f"color: {colour};" if colour else ""
    if label.styleSheet() != style:
        label.setStyleSheet(style)
    sentence = text if not text or text.endswith((".", "...")) else f"{text}."
    if label.text() != sentence:
        label.setText(sentence)


class OutlineTable:
    """Rows of diameter and height that make the outline of a shank or holder.

    Parameters
    ----------
    form : QWidget
    name : str
        "shank" or "holder": the table's name, and the stem of its buttons' names.
    """

    def __init__(self, form, name):
        self.name = name
        self.table = form.findChild(QtWidgets.QTableWidget, name)
        self.table.setColumnCount(2)
        self.table.setHorizontalHeaderLabels([translate("ToolAxis", "Diameter"), translate("ToolAxis", "Height")])
        self.table.verticalHeader().setDefaultSectionSize(22)
        self.table.horizontalHeader().setSectionResizeMode(QtWidgets.QHeaderView.Stretch)
        form.findChild(QtWidgets.QPushButton, f"{name}Add").clicked.connect(self._add)
        form.findChild(QtWidgets.QPushButton, f"{name}Remove").clicked.connect(self._remove)
        self._slot = None

    def on_change(self, slot):
        """Call a slot without arguments whenever a row changes.

        Parameters
        ----------
        slot : callable
        """
        self._slot = slot
        self.table.itemChanged.connect(lambda _: slot())

    @property
    def rows(self):
        """(radius, height) rows, mm.

        Raises
        ------
        ValueError
            With a sentence, where a cell is no length.
        """
        return tuple((self._length(i, 0) / 2, self._length(i, 1)) for i in range(self.table.rowCount()))

    @rows.setter
    def rows(self, rows):
        blocked = self.table.blockSignals(True)
        self.table.setRowCount(0)
        for radius, height in rows:
            self._append(2 * radius, height)
        self.table.blockSignals(blocked)

    def _append(self, diameter, height):
        row = self.table.rowCount()
        self.table.insertRow(row)
        for column, value in enumerate((diameter, height)):
            put(self.table, row, column, length_text(value), UserRole=float(value))  # the text may be rounded

    def _length(self, row, column):
        text = (data_of(self.table, row, column) or "").strip()
        known = data_of(self.table, row, column, _DATA)
        if known is not None and text == length_text(known):
            return float(known)
        value = value_from_text(text, "mm")
        if value is None:
            column_name = self.table.model().headerData(column, QtCore.Qt.Horizontal).lower()
            raise ValueError(translate("ToolAxis", "{} row {}: {} '{}' is not a length").format(
                self.name, row + 1, column_name, text))
        return value

    def _add(self):
        count = self.table.rowCount()
        if count == 0:
            rows = [(40.0, 0.0), (40.0, 40.0)] if self.name == "holder" else [(12.0, 0.0), (12.0, 60.0)]
        else:
            try:
                radius, height = self.rows[-1]
                rows = [(2 * radius, height + 20.0)]
            except ValueError:
                rows = [(40.0, 40.0)]
        for diameter, height in rows:
            self._append(diameter, height)
        if self._slot:
            self._slot()

    def _remove(self):
        chosen = sorted({index.row() for index in self.table.selectedIndexes()}, reverse=True)
        for row in chosen or ([self.table.rowCount() - 1] if self.table.rowCount() else []):
            self.table.removeRow(row)
        if self._slot:
            self._slot()
