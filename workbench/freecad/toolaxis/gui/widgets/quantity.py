"""Fields for lengths, feed rates and angles that show mm, or inches, and never the unit that FreeCAD finds shortest.

FreeCAD's own fields show 0.02 mm as 20 µm, and take a bare number for as many of what they show: 0.1 becomes 100 nm.
"""

import re

import FreeCAD
from FreeCAD import Units
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

MM_PER_INCH = 25.4
#: Significant digits of what a text shows, and digits behind the point at most.
_SIGNIFICANT, _MOST_DIGITS = 4, 7
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)")


def shows_inches():
    """Whether FreeCAD's unit system is an imperial one."""
    unit = Units.Quantity(10.0, Units.Length).getUserPreferred()[2]
    return not unit.endswith("m")


def shown_unit(unit):
    """The unit in which a quantity is shown, and how much of `unit` one of it is.

    Parameters
    ----------
    unit : str
        "mm", "mm/min" or "deg".

    Returns
    -------
    str, float
    """
    if unit == "deg":
        return "°", 1.0
    if shows_inches():
        return unit.replace("mm", "in", 1), MM_PER_INCH
    return unit, 1.0


def number_text(value, least, most):
    """A number with as many digits behind the point as it needs, within bounds, and the point of the user's language.

    Parameters
    ----------
    value : float
    least, most : int
        Digits behind the point.
    """
    digits = next((k for k in range(least, most) if abs(round(value, k) - value) < 0.5 * 10.0**-most), most)
    text = f"{value:.{digits}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace(".", QtCore.QLocale().decimalPoint())


def length_text(value, least=2, most=3):
    """A length with its unit, mm or inches.

    Parameters
    ----------
    value : float
        mm
    least, most : int
        Digits behind the point, for mm; one more for inches.
    """
    unit, factor = shown_unit("mm")
    more = 1 if factor != 1.0 else 0
    return f"{number_text(float(value) / factor, least, most + more)} {unit}"


def area_text(value):
    """An area with its unit, of square mm or inches, with two digits that count at least.

    Parameters
    ----------
    value : float
        mm^2
    """
    unit, factor = shown_unit("mm")
    number, digits = float(value) / factor**2, 0 if factor == 1.0 else 2
    while digits < _MOST_DIGITS and 0 < abs(number) < 10.0 ** (1 - digits):
        digits += 1
    return f"{number_text(number, digits, digits)} {unit}²"


def fine_text(value):
    """A length that may be thousandths of a millimetre, with four digits that count.

    Parameters
    ----------
    value : float
        mm
    """
    unit, factor = shown_unit("mm")
    number = float(value) / factor
    digits = 2
    while digits < _MOST_DIGITS and 0 < abs(number) < 10.0 ** (_SIGNIFICANT - 1 - digits):
        digits += 1
    return f"{number_text(number, digits, digits)} {unit}"


def value_from_text(text, unit):
    """What a text stands for, in `unit`; a bare number counts in the unit that is shown. None where it is no quantity.

    Parameters
    ----------
    text : str
        "0.02", "0,02", "20 um", "1/8 in", "50 in/min".
    unit : str
        "mm", "mm/min" or "deg".
    """
    text = text.strip()
    if _NUMBER.fullmatch(text):
        return float(text.replace(",", ".")) * shown_unit(unit)[1]
    if text.count(",") == 1 and "." not in text:
        text = text.replace(",", ".")
    one = Units.Quantity(f"1 {unit}")
    try:
        quantity = Units.Quantity(text)
    except (ValueError, ArithmeticError, RuntimeError, FreeCAD.Base.FreeCADError):
        return None
    if quantity.Unit != one.Unit:
        return None
    value = quantity.Value / one.Value
    return value if abs(value) < float("inf") else None


class QuantityBox(QtWidgets.QAbstractSpinBox):
    """A spin box for a quantity in one unit.

    The wheel scrolls the panel, and never changes it.

    Parameters
    ----------
    unit : str
        "mm", "mm/min" or "deg".
    decimals : (int, int)
        Digits behind the point that are shown at least and at most.
    step : float
        What an arrow adds, in `unit`.
    parent : QWidget
    """

    changed = QtCore.Signal()

    def __init__(self, unit, decimals, step, parent):
        super().__init__(parent)
        self.unit, self.decimals, self.step = unit, decimals, step
        self._value = self._before = 0.0
        self.setFocusPolicy(QtCore.Qt.StrongFocus)
        # its own line: Qt's would be asked for again and again, and Python may answer with the object of a dead widget
        # that lay at the same address
        self._line = QtWidgets.QLineEdit(self)
        self.setLineEdit(self._line)
        self._line.textEdited.connect(self._take)
        self.editingFinished.connect(self._finish)
        self._show()

    @property
    def value(self):
        """The number in `unit`, as it was set or typed."""
        return self._value

    def set_value(self, value):
        """Show a number.

        Parameters
        ----------
        value : float
            In `unit`.
        """
        different = value != self._value
        self._value = float(value)
        self._show()
        if different:
            self.changed.emit()

    def text_of(self, value):
        """How a number is shown, its unit included.

        Parameters
        ----------
        value : float
            In `unit`.
        """
        unit, factor = shown_unit(self.unit)
        least, most = self.decimals
        if factor != 1.0:
            most += 1
        return f"{number_text(value / factor, least, most)} {unit}"

    def _show(self):
        self._before = self._value
        text = self.text_of(self._value)
        if self._line.text() != text:
            self._line.setText(text)

    def _take(self, text):
        """Take what has been typed so far, where it is a quantity."""
        value = value_from_text(text, self.unit)
        if value is not None and value != self._value:
            self._value = value
            self.changed.emit()

    def _finish(self):
        """Show what was typed in full; where it is no quantity, the one from before."""
        if value_from_text(self._line.text(), self.unit) is None:
            self.set_value(self._before)
        else:
            self._show()

    def validate(self, text, position):
        """Qt asks whether a text may stand: any may while it is typed."""
        complete = value_from_text(text, self.unit) is not None
        return QtGui.QValidator.Acceptable if complete else QtGui.QValidator.Intermediate, text, position

    def stepEnabled(self):
        """Qt asks which arrows work: both."""
        return QtWidgets.QAbstractSpinBox.StepUpEnabled | QtWidgets.QAbstractSpinBox.StepDownEnabled

    def stepBy(self, steps):
        """Add steps, for an arrow or a key."""
        self.set_value(round(self._value + steps * self.step, 9))
        self.selectAll()

    def wheelEvent(self, event):
        """Leave the wheel to what is scrolled."""
        event.ignore()

    def sizeHint(self):
        """As wide as a long number with its unit."""
        hint = super().sizeHint()
        hint.setWidth(max(hint.width(), self.fontMetrics().horizontalAdvance("-0000.000 mm/min")))
        return hint


class QuantityField:
    """A quantity in a place that a layout keeps for it.

    Parameters
    ----------
    place : QWidget
        An empty widget of the layout, which the box fills: tooltip, label and focus go on to it.
    unit : str
        "mm", "mm/min" or "deg".
    decimals : (int, int)
        Digits behind the point that are shown at least and at most, in mm, mm/min or deg.
    step : float
        What an arrow adds, in `unit`.
    """

    def __init__(self, place, unit="mm", decimals=(2, 3), step=1.0):
        self.unit = unit
        self.box = QuantityBox(unit, decimals, step, place)
        layout = QtWidgets.QHBoxLayout(place)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.box)
        place.setFocusProxy(self.box)

    @property
    def value(self):
        """The number in the field's unit."""
        return self.box.value

    @value.setter
    def value(self, number):
        self.box.set_value(number)

    def on_change(self, slot):
        """Call a slot without arguments whenever the value changes.

        Parameters
        ----------
        slot : callable
        """
        self.box.changed.connect(slot)
