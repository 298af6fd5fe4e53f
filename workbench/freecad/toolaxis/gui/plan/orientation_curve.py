"""Length, or time, against the number of orientations: a curve whose points can be clicked."""

import FreeCAD
from freecad.toolaxis.gui.axis_map.widget import place_of
from freecad.toolaxis.gui.widgets import palette
from freecad.toolaxis.gui.widgets.quantity import length_text
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

_HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 150, 76, 14, 12, 34
_REACH = 14.0
_POINT = 4.5


class OrientationCurve(QtWidgets.QWidget):
    """Draws the options of a plan; a click on one asks for it.

    Parameters
    ----------
    parent : QWidget
    """

    picked = QtCore.Signal(int)
    """The number of orientations that was clicked."""
    hovered = QtCore.Signal(str)
    """What stands under the pointer; empty when it leaves."""

    def __init__(self, parent):
        super().__init__(parent)
        self.options = ()
        self.setObjectName("orientationCurve")
        self.setMouseTracking(True)
        self.setFixedHeight(_HEIGHT)
        self.setAccessibleName(translate("ToolAxis", "Length against the number of orientations"))
        self.setToolTip(translate("ToolAxis", "Click a point: the plan is computed again with that many orientations."))
        self.setVisible(False)

    def show_options(self, options):
        """Show other options; nothing is shown of fewer than two.

        Parameters
        ----------
        options : sequence of toolaxis.plan.plan.Option
        """
        self.options = tuple(options) if len(options) > 1 else ()
        self.setVisible(bool(self.options))
        self.update()

    @property
    def timed(self):
        """Whether times are shown, not lengths."""
        return bool(self.options) and all(one.seconds is not None for one in self.options)

    def cost(self, option):
        """What an option comes to, mm or s.

        Parameters
        ----------
        option : toolaxis.plan.plan.Option
        """
        return option.seconds if self.timed else option.length

    def position_of(self, option):
        """Where an option is drawn.

        Parameters
        ----------
        option : toolaxis.plan.plan.Option
        """
        counts = [one.orientations for one in self.options]
        costs = [self.cost(one) for one in self.options]
        wide = max(max(counts) - min(counts), 1)
        tall = max(max(costs) - min(costs), 1e-9)
        x = _LEFT + (option.orientations - min(counts)) / wide * (self.width() - _LEFT - _RIGHT)
        y = _TOP + (max(costs) - self.cost(option)) / tall * (_HEIGHT - _TOP - _BOTTOM)
        return QtCore.QPointF(x, y)

    def option_at(self, position):
        """The option near a place; None where there is none.

        Parameters
        ----------
        position : QPointF
        """
        def away(one):
            way = self.position_of(one) - position
            return (way.x() ** 2 + way.y() ** 2) ** 0.5

        near = min(self.options, key=away, default=None)
        return near if near is not None and away(near) <= _REACH else None

    def words(self, option):
        """An option in a sentence.

        Parameters
        ----------
        option : toolaxis.plan.plan.Option
        """
        first = self.cost(self.options[0])
        cost = self.cost(option)
        text = translate("ToolAxis", "{:.0f} s").format(cost) if self.timed else length_text(cost, 0, 0)
        told = translate("ToolAxis", "Orientations: {}; sub-surfaces: {}; {}").format(
            option.orientations, option.sub_surfaces, text)
        if option is self.options[0] or not first > 0:
            return told
        return translate("ToolAxis", "{}, {:.1f} % less than the first").format(told, 100 * (1 - cost / first))

    def mouseMoveEvent(self, event):
        """Tell what stands under the pointer."""
        option = self.option_at(place_of(event))
        self.setCursor(QtCore.Qt.PointingHandCursor if option else QtCore.Qt.ArrowCursor)
        self.hovered.emit(self.words(option) if option else "")

    def leaveEvent(self, event):
        """Nothing is under the pointer any more."""
        self.hovered.emit("")

    def mousePressEvent(self, event):
        """Ask for the option that was clicked."""
        option = self.option_at(place_of(event))
        if option is not None and self.isEnabled():
            self.picked.emit(option.orientations)

    def paintEvent(self, event):
        """Draw axes, curve and points; the chosen one is filled."""
        if not self.options:
            return
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        line = self.palette().color(QtGui.QPalette.WindowText)
        font = painter.font()
        font.setPointSizeF(max(6.5, 0.8 * font.pointSizeF()))
        painter.setFont(font)
        self._draw_frame(painter, line)
        places = [self.position_of(one) for one in self.options]
        painter.setPen(QtGui.QPen(line, 1.4))
        painter.drawPolyline(QtGui.QPolygonF(places))
        for one, place in zip(self.options, places, strict=True):
            painter.setBrush(QtGui.QColor(palette.CHOSEN) if one.chosen else self.palette().color(
                QtGui.QPalette.Window))
            size = _POINT + 1.5 if one.chosen else _POINT
            painter.drawEllipse(place, size, size)
        painter.end()

    def _draw_frame(self, painter, line):
        bottom = _HEIGHT - _BOTTOM + 8
        painter.setPen(QtGui.QPen(line, 0.6))
        painter.drawLine(QtCore.QPointF(_LEFT - 8, _TOP - 6), QtCore.QPointF(_LEFT - 8, bottom))
        painter.drawLine(QtCore.QPointF(_LEFT - 8, bottom), QtCore.QPointF(self.width() - _RIGHT + 6, bottom))
        for one in self.options:
            box = QtCore.QRectF(self.position_of(one).x() - 14, bottom + 1, 28, 12)
            painter.drawText(box, QtCore.Qt.AlignCenter, str(one.orientations))
        costs = [self.cost(one) for one in self.options]
        for one in {max(costs), min(costs)}:
            option = next(option for option in self.options if self.cost(option) == one)
            box = QtCore.QRectF(0, self.position_of(option).y() - 7, _LEFT - 12, 14)
            text = f"{one:.0f} s" if self.timed else length_text(one, 0, 0)
            painter.drawText(box, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, text)
        box = QtCore.QRectF(_LEFT, _HEIGHT - 14, self.width() - _LEFT - _RIGHT, 14)
        painter.drawText(box, QtCore.Qt.AlignCenter, translate("ToolAxis", "orientations"))
