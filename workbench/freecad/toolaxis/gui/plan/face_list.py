"""Lists of panels: faces to machine, and bodies to avoid."""

import FreeCAD
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
                append(self.widget, f"{thing.Label}: {sub}", UserRole=(thing, sub))
        if self.widget.count() > count:
            self._changed()
        return self.widget.count() - count

    def remove_marked(self):
        """Remove the marked entries."""
        marked = sorted((index.row() for index in self.widget.selectedIndexes()), reverse=True)
        for row in marked:
            self.widget.model().removeRow(row)
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
