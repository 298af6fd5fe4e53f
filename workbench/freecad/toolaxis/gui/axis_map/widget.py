"""The hemisphere map as a widget: all axes at a glance, the reason under the pointer, a click tries an axis."""

import FreeCAD
import numpy as np
from freecad.toolaxis.document.colour_scale import coloured
from freecad.toolaxis.gui.axis_map.legend import draw_mark
from freecad.toolaxis.gui.axis_map.raster import SIDE, missed, reason_name
from freecad.toolaxis.gui.widgets import palette
from freecad.toolaxis.gui.widgets.quantity import length_text
from PySide import QtCore, QtGui, QtWidgets

from toolaxis.plan.tally import is_tally

translate = FreeCAD.Qt.translate

_MARGIN, _HEIGHT, _LOW = 12, 300, 84
#: How near to its mark the pointer is on the chosen axis, pixels.
_ON_MARK = 9.0


def no_map(found):
    """Why an orientation has no map, a sentence.

    Parameters
    ----------
    found : toolaxis.plan.orientation.Orientation
    """
    if found.lead is not None:
        return translate("ToolAxis", "No map: the axis moves along the passes.")
    if found.axis is None and any(map(is_tally, found.reasons)):
        return translate("ToolAxis", "No map was kept of the axes tested: the reasons are listed below.")
    if found.axis is None:
        return translate("ToolAxis", "No map: no axis was tested.")
    return translate("ToolAxis", "No map: this axis was not searched for by itself. It is shared by sub-surfaces, "
                                 "given, or set by the method.")


class HemisphereMap(QtWidgets.QWidget):
    """Draws an `AxisPicture`; without one, a circle with a few words.

    Parameters
    ----------
    parent : QWidget
    empty : str
        The words.
    """

    picked = QtCore.Signal(object)
    """The axis that was clicked, (3,) array."""
    hovered = QtCore.Signal(str)
    """What stands under the pointer; empty when it leaves."""

    def __init__(self, parent, empty):
        super().__init__(parent)
        self.empty, self.reason = empty, ""
        self.setMouseTracking(True)
        self.setMinimumWidth(200)
        self.setFixedHeight(_HEIGHT)
        self.setSizePolicy(QtWidgets.QSizePolicy.Expanding, QtWidgets.QSizePolicy.Fixed)
        self.setAccessibleName(translate("ToolAxis", "Map of the tool axes"))
        self.picture = None
        self.tried = None
        self._drawn = None

    def show_picture(self, picture, reason=""):
        """Show another map.

        Parameters
        ----------
        picture : AxisPicture or None
        reason : str
            Why there is none, if none will come.
        """
        self.reason = reason
        self.picture, self.tried, self._drawn = picture, None, None
        self.setFixedHeight(_LOW if picture is None and self.reason else _HEIGHT)
        self.setCursor(QtCore.Qt.CrossCursor if picture is not None else QtCore.Qt.ArrowCursor)
        self.update()

    def show_tried(self, axis):
        """Mark the axis that is being tried.

        Parameters
        ----------
        axis : (3,) array or None
        """
        self.tried = axis
        self.update()

    def disc(self):
        """Centre and radius of the disc, pixels."""
        radius = (min(self.width(), self.height()) - 2 * _MARGIN) / 2
        return QtCore.QPointF(self.width() / 2, self.height() / 2), max(radius, 10.0)

    def axis_at(self, position):
        """The axis at a position in the widget, (3,) array, or None off the disc.

        Parameters
        ----------
        position : QPointF
        """
        if self.picture is None:
            return None
        centre, radius = self.disc()
        return self.picture.direction((position.x() - centre.x()) / radius, (centre.y() - position.y()) / radius)

    def position_of(self, axis):
        """Where an axis lies in the widget, QPointF; None behind the border.

        Parameters
        ----------
        axis : (3,) array
        """
        places = self.picture.place(np.atleast_2d(axis))
        return self._point(places[0]) if len(places) else None

    def text_at(self, position):
        """What stands under a position, a sentence; empty off the disc.

        Parameters
        ----------
        position : QPointF
        """
        axis = self.axis_at(position)
        if axis is None:
            return ""
        picture = self.picture
        row = picture.row(axis)
        lean = np.degrees(np.arccos(np.clip(picture.axes[row] @ picture.pole, -1, 1)))
        where = translate("ToolAxis", "{:.0f}° from the mean normal").format(lean)
        if self._is_on_chosen(position):
            width, passes = picture.planned
            return translate("ToolAxis", "chosen axis: strip width {}, {} passes computed").format(length_text(width),
                                                                                              passes)
        if picture.reason[row] == 0:
            width = length_text(picture.width[row])
            return translate("ToolAxis", "estimate: strip width {}, {:.0f} passes, {}").format(
                width, picture.passes[row], where)
        amount = missed(picture.reason[row], picture.amount[row])
        by = translate("ToolAxis", ", short by {}").format(amount) if amount else ""
        return translate("ToolAxis", "not possible: {}{}, {}").format(reason_name(picture.reason[row]), by, where)

    def _is_on_chosen(self, position):
        """Whether a position lies on the mark of the chosen axis, whose passes were made."""
        chosen = self.picture.marks.get("chosen")
        if chosen is None or self.picture.planned is None:
            return False
        at = self.position_of(chosen)
        return at is not None and np.hypot(at.x() - position.x(), at.y() - position.y()) <= _ON_MARK

    def mouseMoveEvent(self, event):
        """Tell what stands under the pointer."""
        self.hovered.emit(self.text_at(place_of(event)))

    def leaveEvent(self, event):
        """Tell that the pointer left."""
        self.hovered.emit("")

    def mousePressEvent(self, event):
        """Pick the axis under the pointer."""
        axis = self.axis_at(place_of(event)) if event.button() == QtCore.Qt.LeftButton else None
        if axis is not None and self.isEnabled():
            self.picked.emit(axis)

    def changeEvent(self, event):
        """Draw anew in another theme."""
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange, QtCore.QEvent.EnabledChange):
            self._drawn = None
            self.update()
        super().changeEvent(event)

    def paintEvent(self, event):
        """Draw disc, circles and marks."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        if self.picture is None:
            self._draw_nothing(painter)
        else:
            self._draw_disc(painter)
            self._draw_circles(painter)
            self._draw_marks(painter)
        painter.end()

    def _draw_nothing(self, painter):
        centre, radius = self.disc()
        colour = self.palette().color(QtGui.QPalette.WindowText)
        if self.reason:
            painter.setPen(colour)
            painter.drawText(QtCore.QRectF(self.rect()), QtCore.Qt.AlignCenter | QtCore.Qt.TextWordWrap, self.reason)
            return
        painter.setPen(QtGui.QPen(colour, 1, QtCore.Qt.DashLine))
        painter.drawEllipse(centre, radius, radius)
        box = QtCore.QRectF(centre.x() - 0.7 * radius, centre.y() - radius / 2, 1.4 * radius, radius)
        painter.drawText(box, QtCore.Qt.AlignCenter | QtCore.Qt.TextWordWrap, self.empty)

    def _draw_disc(self, painter):
        centre, radius = self.disc()
        ratio = self.devicePixelRatioF()
        size = int(2 * radius * ratio)
        dark = palette.is_dark(self.palette())
        if self._drawn is None or self._drawn[0] != (size, dark):
            self._drawn = (size, dark), _disc_image(self.picture, size, dark)
        target = QtCore.QRectF(centre.x() - radius, centre.y() - radius, 2 * radius, 2 * radius)
        path = QtGui.QPainterPath()
        path.addEllipse(centre, radius, radius)
        painter.save()
        painter.setClipPath(path)
        painter.drawImage(target, self._drawn[1])
        painter.restore()

    def _draw_circles(self, painter):
        centre, radius = self.disc()
        line = self.palette().color(QtGui.QPalette.WindowText)
        font = painter.font()
        font.setPointSizeF(max(6.5, 0.75 * font.pointSizeF()))
        painter.setFont(font)
        for angle in (30, 60, 90):
            r = radius * np.sqrt(2) * np.sin(np.radians(angle) / 2)
            style = QtCore.Qt.SolidLine if angle == 90 else QtCore.Qt.DotLine
            painter.setPen(QtGui.QPen(line, 1.2 if angle == 90 else 0.9, style))
            painter.drawEllipse(centre, r, r)
            if angle < 90:
                self._draw_label(painter, centre + QtCore.QPointF(0.26 * r, 0.966 * r), f"{angle}°")

    def _draw_label(self, painter, at, text):
        box = QtCore.QRectF(painter.fontMetrics().boundingRect(text)).adjusted(-2, -1, 2, 1)
        box.moveCenter(at)
        ground = QtGui.QColor(0, 0, 0, 190) if palette.is_dark(self.palette()) else QtGui.QColor(255, 255, 255, 200)
        painter.fillRect(box, ground)
        painter.setPen(self.palette().color(QtGui.QPalette.WindowText))
        painter.drawText(box, QtCore.Qt.AlignCenter, text)

    def _draw_marks(self, painter):
        for name, axes in self.picture.marks.items():
            for place in self.picture.place(axes):
                draw_mark(painter, name, self._point(place))
        if self.tried is not None:
            for place in self.picture.place(np.atleast_2d(self.tried)):
                draw_mark(painter, "tried", self._point(place))

    def _point(self, place):
        centre, radius = self.disc()
        return QtCore.QPointF(centre.x() + radius * place[0], centre.y() - radius * place[1])


def place_of(event):
    """Where a mouse event is; FreeCAD 1.0 has a Qt that calls it otherwise.

    Parameters
    ----------
    event : QMouseEvent

    Returns
    -------
    QPointF
    """
    return event.position() if hasattr(event, "position") else event.localPos()


def _disc_image(picture, size, dark):
    """The coloured square around the disc at the size of the screen's pixels, so that hatches stay crisp."""
    index = np.minimum((np.arange(size) + 0.5) * SIDE / size, SIDE - 1).astype(int)
    rows = np.maximum(picture.nearest[np.ix_(index, index)], 0)
    ground, line = palette.greys(dark)
    colour = coloured(picture.width, *picture.span)
    colour[picture.reason > 0] = ground
    rgb = colour[rows]
    y, x = np.ogrid[:size, :size]
    rgb[palette.hatch(picture.reason[rows], x, y)] = line
    # the border of the disc lies within its pixels: those just off it take the colour of their neighbours
    return palette.image_of(rgb)
