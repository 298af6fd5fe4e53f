"""The legend of a painted map: colour scale from zero to a limit, and what lies beyond."""

import FreeCAD
from freecad.toolaxis.document.colour_scale import ABOVE, ASIDE, MISSED, scale_colours
from freecad.toolaxis.gui.widgets import palette
from freecad.toolaxis.gui.widgets.quantity import fine_text
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Height of a row of swatches, and where their texts begin, pixels.
_ROW, _SWATCH = 19, 28


class Scale(QtWidgets.QWidget):
    """A bar of colours with its ends, and swatches for above the limit, not reached, and left to clean-up."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.limit, self.most, self.name, self.heights = 1.0, 1.0, "", True
        self._fit()

    def show_scale(self, name, limits, heights):
        """Explain another map.

        Parameters
        ----------
        name : str
        limits : (float, float)
            The end of the scale, and what the judge accepts, mm.
        heights : bool
            Whether heights are shown: places not reached and clean-up zones have colours of their own.
        """
        (self.limit, self.most), self.name, self.heights = limits, name, heights
        self._fit()
        self.update()

    def resizeEvent(self, event):
        """What no longer fits beside each other goes below each other."""
        self._fit()

    def _fit(self):
        self.setFixedHeight(39 + _ROW * len(self._rows()))

    def _entries(self):
        """Colours beyond the scale, with what they mean."""
        entries = [(ABOVE, translate("ToolAxis", "above {}").format(fine_text(self.most)))]
        if self.heights:
            entries += [(MISSED, translate("ToolAxis", "not reached")),
                        (ASIDE, translate("ToolAxis", "rest material"))]
        return entries

    def _rows(self):
        """The same in rows: two in one where each fits into its half."""
        entries, metrics = self._entries(), self.fontMetrics()
        fits = all(metrics.horizontalAdvance(name) + _SWATCH < self.width() / 2 for _, name in entries)
        beside = 2 if fits else 1
        return [entries[k:k + beside] for k in range(0, len(entries), beside)]

    def _caption(self):
        """The name of the scale between its ends, or less of it where they need the room."""
        metrics = self.fontMetrics()
        room = self.width() - 2 * (metrics.horizontalAdvance(fine_text(self.limit)) + 8)
        return metrics.elidedText(self.name, QtCore.Qt.ElideRight, max(room, 0))

    def paintEvent(self, event):
        """Draw bar, ends and swatches."""
        painter = QtGui.QPainter(self)
        text = self.palette().color(QtGui.QPalette.WindowText)
        painter.setPen(text)
        bar = QtCore.QRectF(0, 2, self.width() - 1, 12)
        painter.drawImage(bar, palette.image_of(scale_colours()[None]))
        painter.drawRect(bar)
        line = QtCore.QRectF(0, 16, self.width(), 18)
        painter.drawText(line, QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, "0")
        painter.drawText(line, QtCore.Qt.AlignCenter, self._caption())
        painter.drawText(line, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, fine_text(self.limit))
        for row, entries in enumerate(self._rows()):
            for column, (colour, name) in enumerate(entries):
                x, y = column * self.width() / 2, 36 + row * _ROW
                box = QtCore.QRectF(x, y + 3, _SWATCH - 6, 13)
                painter.fillRect(box, QtGui.QColor(*colour))
                painter.setPen(text)
                painter.drawRect(box)
                painter.drawText(QtCore.QRectF(x + _SWATCH, y, self.width() - x - _SWATCH, _ROW),
                                 QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, name)
        painter.end()
