"""Lists of panels: faces to machine, and bodies to avoid."""

from contextlib import suppress

import FreeCAD
from freecad.toolaxis.document.read_shapes import number_in
from freecad.toolaxis.gui.widgets.quantity import area_text, shown_unit, value_from_text
from freecad.toolaxis.gui.widgets.table_entries import append, data_of
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

_DATA = QtCore.Qt.UserRole
_TICKED = 2  # Qt.Checked, which is a number in data


class FaceList:
    """The list of faces to machine, as (object, "Face7").

    Parameters
    ----------
    widget : QListWidget
    """

    def __init__(self, widget):
        self.widget = widget
        self._slots = []
        self._areas, self._sought = [], ""

    def on_change(self, slot):
        """Call a slot without arguments whenever faces come or go.

        Parameters
        ----------
        slot : callable
        """
        self._slots.append(slot)

    def _changed(self):
        for slot in self._slots:
            slot()

    @property
    def faces(self):
        """What the list holds."""
        return tuple((thing, sub) for thing, sub in (data_of(self.widget, i, role=_DATA)
                                                     for i in range(self.widget.count())))

    @faces.setter
    def faces(self, faces):
        self.widget.clear()
        self._areas.clear()
        if not self.add(faces):
            self._changed()

    def add(self, faces):
        """Add what is not there yet; how many were added.

        Parameters
        ----------
        faces : sequence of (object, str)
        """
        known = {(thing.Document.Name, thing.Name, sub) for thing, sub in self.faces}
        count = self.widget.count()
        for thing, sub in faces:
            if (thing.Document.Name, thing.Name, sub) not in known:
                known.add((thing.Document.Name, thing.Name, sub))
                area = _area_of(thing, sub)
                append(self.widget, ", ".join([sub, *([] if area is None else [area_text(area)]), thing.Label]),
                       UserRole=(thing, sub))
                self._areas.append(area)
        if self.widget.count() > count:
            self._filter()
            self._changed()
        return self.widget.count() - count

    def summary(self):
        """How many faces there are, and of which part; empty without any."""
        things = list(dict.fromkeys(thing for thing, _ in self.faces))
        if not things:
            return translate("ToolAxis", "none")
        whole = things[0].Label if len(things) == 1 else translate("ToolAxis", "{} parts").format(len(things))
        return translate("ToolAxis", "{} of {}").format(self.widget.count(), whole)

    def show_matching(self, text):
        """Show only some faces; the others stay in the list.

        Parameters
        ----------
        text : str
            What stands in their names, or "< 5" for those with an area of less than 5 in the square of what lengths are
            shown in; empty for all.
        """
        self._sought = text.strip()
        self._filter()

    def _filter(self):
        """Hide what is not looked for, and take its mark away: nothing is removed unseen."""
        for row in range(self.widget.count()):
            hidden = not self._matches(row)
            self.widget.setRowHidden(row, hidden)
            if hidden:
                self.widget.selectionModel().select(self.widget.model().index(row, 0),
                                                    QtCore.QItemSelectionModel.Deselect)

    def _matches(self, row):
        if self._sought.startswith("<"):
            limit = value_from_text(self._sought[1:], "mm")
            if limit is None:
                return True
            area, scale = self._areas[row], shown_unit("mm")[1]
            return area is not None and area < limit * scale
        return self._sought.lower() in data_of(self.widget, row).lower()

    def remove_marked(self):
        """Remove the marked entries."""
        marked = sorted((index.row() for index in self.widget.selectedIndexes()), reverse=True)
        for row in marked:
            self.widget.model().removeRow(row)
            del self._areas[row]
        if marked:
            self._changed()

    def remove_object(self, name):
        """Remove the faces of an object that is about to be deleted; how many there were.

        Parameters
        ----------
        name : str
        """
        kept = [(thing, sub) for thing, sub in self.faces if thing.Name != name]
        gone = self.widget.count() - len(kept)
        if gone:
            self.faces = kept
        return gone


def _area_of(thing, name):
    """Area of a face, mm^2; None where it cannot be read."""
    from toolaxis.cad.freecad.documents import shape_of

    with suppress(Exception):  # it is refused with the reason when it is computed with
        shape = shape_of(thing)
        return float(shape.Faces[number_in(thing, shape, name) - 1].Area)
    return None


class BodyList:
    """The list of bodies that may be avoided, with ticks.

    Parameters
    ----------
    widget : QListWidget
    """

    def __init__(self, widget):
        self.widget = widget
        widget.setSelectionMode(QtWidgets.QAbstractItemView.NoSelection)

    def offer(self, bodies, ticked):
        """Fill the list.

        Parameters
        ----------
        bodies, ticked : sequence of objects
        """
        names = {body.Name for body in ticked}
        blocked = self.widget.blockSignals(True)
        self.widget.clear()
        for body in bodies:
            append(self.widget, body.Label, CheckStateRole=_TICKED if body.Name in names else 0, UserRole=body)
        if not bodies:
            grey = self.widget.palette().brush(QtGui.QPalette.Disabled, QtGui.QPalette.Text)
            append(self.widget, translate("ToolAxis", "no other body in the document"), ForegroundRole=grey)
        self.widget.blockSignals(blocked)

    def remove_object(self, name):
        """Remove a body that is about to be deleted; whether it was ticked.

        Parameters
        ----------
        name : str
        """
        bodies = [data_of(self.widget, i, role=_DATA) for i in range(self.widget.count())]
        left = [body for body in bodies if body is not None and body.Name != name]
        if len(left) == len([body for body in bodies if body is not None]):
            return False
        ticked = self.ticked
        self.offer(left, ticked)
        return len(self.ticked) < len(ticked)

    @property
    def ticked(self):
        """The bodies to avoid."""
        ticks = (data_of(self.widget, i, role=QtCore.Qt.CheckStateRole) for i in range(self.widget.count()))
        return tuple(data_of(self.widget, i, role=_DATA) for i, tick in enumerate(ticks)
                     if tick is not None and getattr(tick, "value", tick) == _TICKED)
