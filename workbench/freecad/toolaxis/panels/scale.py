"""The legend of a painted map: colour scale from zero to a limit, and what lies beyond."""

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from ..colours import ABOVE, MISSED, scale_colours
from . import palette
from .fields import fine_text

translate = FreeCAD.Qt.translate


class Scale(QtWidgets.QWidget):
    """A bar of colours with its ends, and swatches for above the limit and not reached."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.limit, self.name, self.missed = 1.0, "", True
        self.setFixedHeight(58)

    def show_scale(self, name, limit, missed):
        """Explain another map.

        Parameters
        ----------
        name : str
        limit : float
            mm
        missed : bool
            Whether places that were not reached have a colour of their own.
        """
        self.limit, self.name, self.missed = limit, name, missed
        self.update()

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
        painter.drawText(line, QtCore.Qt.AlignCenter, self.name)
        painter.drawText(line, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, fine_text(self.limit))
        entries = [(ABOVE, translate("ToolAxis", "above the limit"))]
        if self.missed:
            entries.append((MISSED, translate("ToolAxis", "not reached")))
        for k, (colour, name) in enumerate(entries):
            x = k * self.width() / 2
            box = QtCore.QRectF(x, 39, 22, 13)
            painter.fillRect(box, QtGui.QColor(*colour))
            painter.setPen(text)
            painter.drawRect(box)
            painter.drawText(QtCore.QRectF(x + 28, 36, self.width() / 2 - 28, 19),
                             QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, name)
        painter.end()
