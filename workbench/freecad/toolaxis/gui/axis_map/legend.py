"""The legend of the hemisphere map: colour scale, hatches by reason, marks."""

import FreeCAD
import numpy as np
from freecad.toolaxis.document.colour_scale import scale_colours
from freecad.toolaxis.gui.axis_map.raster import reason_name
from freecad.toolaxis.gui.widgets import palette
from freecad.toolaxis.gui.widgets.quantity import length_text
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

_ROW, _SWATCH, _GAP = 18, 26, 6


def mark_names():
    """Names of the marks as the user reads them, in the legend's order."""
    return {"chosen": translate("ToolAxis", "chosen axis"), "tried": translate("ToolAxis", "axis tried"),
            "mean normal": translate("ToolAxis", "mean normal"), "Roman's rule": translate("ToolAxis", "Roman's rule"),
            "other lobes": translate("ToolAxis", "other good axes")}


def draw_mark(painter, name, at):
    """Draw the mark of an axis, with a dark rim around light strokes so that it stands out on every colour.

    Parameters
    ----------
    painter : QPainter
    name : str
        A key of `mark_names`.
    at : QPointF
    """
    shape = _SHAPES.get(name, _diamond)
    painter.save()
    painter.translate(at)
    painter.setBrush(QtCore.Qt.NoBrush)
    shape(painter)
    painter.restore()


def _strokes(painter, lines, colour, width=2.0):
    for pen in (QtGui.QPen(QtGui.QColor("black"), width + 2.4), QtGui.QPen(QtGui.QColor(colour), width)):
        pen.setCapStyle(QtCore.Qt.RoundCap)
        painter.setPen(pen)
        painter.drawLines([QtCore.QLineF(*line) for line in lines])


def _star(painter):
    points = []
    for k in range(10):
        angle, radius = np.pi * (k / 5 - 0.5), 9.0 if k % 2 == 0 else 3.8
        points.append(QtCore.QPointF(radius * np.cos(angle), radius * np.sin(angle)))
    painter.setPen(QtGui.QPen(QtGui.QColor("black"), 1.2))
    painter.setBrush(QtGui.QColor(palette.CHOSEN))
    painter.drawPolygon(QtGui.QPolygonF(points))


def _plus(painter):
    _strokes(painter, [(-6, 0, 6, 0), (0, -6, 0, 6)], "white")


def _cross(painter):
    _strokes(painter, [(-5, -5, 5, 5), (-5, 5, 5, -5)], palette.ROMAN)


def _diamond(painter):
    painter.setPen(QtGui.QPen(QtGui.QColor("black"), 1.2))
    painter.setBrush(QtGui.QColor(palette.LOBE))
    painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(*p) for p in ((0, -5), (5, 0), (0, 5), (-5, 0))]))


def _ring(painter):
    for pen in (QtGui.QPen(QtGui.QColor("black"), 4.4), QtGui.QPen(QtGui.QColor(palette.TRIED), 2.0)):
        painter.setPen(pen)
        painter.drawEllipse(QtCore.QPointF(0, 0), 7.5, 7.5)


_SHAPES = {"chosen": _star, "mean normal": _plus, "Roman's rule": _cross, "other lobes": _diamond, "tried": _ring}


class Legend(QtWidgets.QWidget):
    """Says what colours, hatches and marks of a map mean."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.picture = None
        self.tried = False
        self.setSizePolicy(QtWidgets.QSizePolicy.Expanding, QtWidgets.QSizePolicy.Fixed)

    def show_picture(self, picture, tried=False):
        """Explain another map.

        Parameters
        ----------
        picture : AxisPicture or None
        tried : bool
            Whether an axis is being tried.
        """
        self.picture, self.tried = picture, tried
        self.setFixedHeight(max(self.sizeHint().height(), 1))
        self.update()

    def rows(self):
        """Entries as (kind, key, text): marks, then reasons."""
        if self.picture is None:
            return []
        names = mark_names()
        shown = [("mark", key, names[key]) for key in names
                 if key in self.picture.marks or (key == "tried" and self.tried)]
        return shown + [("reason", code, reason_name(code)) for code in self.picture.reasons]

    def sizeHint(self):
        """Room for the scale and all entries in two columns."""
        if self.picture is None:
            return QtCore.QSize(240, 0)
        return QtCore.QSize(240, 40 + _ROW * len(self._place_entries(max(self.width(), 240))[0]) + 4)

    def resizeEvent(self, event):
        """Entries that no longer fit beside each other go below each other."""
        if self.picture is not None:
            self.setFixedHeight(self.sizeHint().height())

    def _place_entries(self, width):
        """Lines of entries, two beside each other where both fit, and the width of a column."""
        metrics = self.fontMetrics()
        half = width / 2
        lines = []
        for entry in self.rows():
            wide = metrics.horizontalAdvance(entry[2]) + _SWATCH + 2 * _GAP > half
            if lines and len(lines[-1]) == 1 and not wide and not lines[-1][0][1]:
                lines[-1].append((entry, wide))
            else:
                lines.append([(entry, wide)])
        return [[entry for entry, _ in line] for line in lines], half

    def paintEvent(self, event):
        """Draw the scale, then the entries."""
        if self.picture is None:
            return
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        self._draw_scale(painter)
        lines, half = self._place_entries(self.width())
        for number, line in enumerate(lines):
            for column, entry in enumerate(line):
                self._draw_entry(painter, entry, (column * half, 40 + number * _ROW))
        painter.end()

    def _draw_scale(self, painter):
        free = bool(np.isfinite(self.picture.width).any())
        painter.setPen(self.palette().color(QtGui.QPalette.WindowText))
        if not free:
            painter.drawText(QtCore.QRectF(0, 0, self.width(), 34), QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter,
                             translate("ToolAxis", "No possible axis."))
            return
        low, high = (length_text(width) for width in self.picture.span)
        bar = QtCore.QRectF(0, 2, self.width(), 12)
        painter.drawImage(bar, palette.image_of(scale_colours()[None]))
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawRect(bar)
        text = QtCore.QRectF(0, 16, self.width(), 18)
        painter.drawText(text, QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, low)
        painter.drawText(text, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, high)
        painter.drawText(text, QtCore.Qt.AlignCenter, translate("ToolAxis", "strip width, estimated"))

    def _draw_entry(self, painter, entry, at):
        kind, key, text = entry
        x, y = at
        box = QtCore.QRectF(x, y + 2, _SWATCH, _ROW - 4)
        if kind == "mark":
            draw_mark(painter, key, box.center())
        else:
            painter.drawImage(box, _swatch(key, palette.is_dark(self.palette())))
            painter.setPen(QtGui.QPen(self.palette().color(QtGui.QPalette.WindowText), 0.6))
            painter.setBrush(QtCore.Qt.NoBrush)
            painter.drawRect(box)
        painter.setPen(self.palette().color(QtGui.QPalette.WindowText))
        painter.drawText(QtCore.QRectF(x + _SWATCH + _GAP, y, self.width() - x - _SWATCH, _ROW),
                         QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, text)


def _swatch(code, dark):
    y, x = np.mgrid[:_ROW - 4, :_SWATCH]
    ground, line = palette.greys(dark)
    rgb = np.where(palette.hatch(np.full(x.shape, code), x, y)[..., None], line, ground).astype(np.uint8)
    return palette.image_of(rgb)
