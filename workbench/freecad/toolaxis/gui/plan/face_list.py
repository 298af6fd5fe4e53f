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
#: Share of the area below which a skin is not listed unless it is looked for.
_TINY = 1e-3
#: Which faces are listed: all, those in sight, those that are hidden; the places of the field in the form.
ALL, IN_SIGHT, HIDDEN = range(3)


class FaceList:
    """The list of faces to machine, as (object, "Face7"); a row has one of them, or those that are machined as one.

    Parameters
    ----------
    widget : QListWidget

    Attributes
    ----------
    is_fixed : bool
        Whether they are those of an earlier setup.
    """

    def __init__(self, widget):
        self.widget = widget
        self._slots, self._sought = [], ""
        self._faces, self._skins, self._areas = [], (), {}
        self._kind, self._hidden = ALL, frozenset()
        self.is_fixed = False

    def on_change(self, slot):
        """Call a slot without arguments whenever faces come or go.

        Parameters
        ----------
        slot : callable
        """
        self._slots.append(slot)

    def _changed(self):
        self._skins = ()
        self._list_rows()
        for slot in self._slots:
            slot()

    @property
    def faces(self):
        """What the list holds."""
        return tuple(self._faces)

    @faces.setter
    def faces(self, faces):
        self._faces = []
        if not self.add(faces):
            self._changed()

    def add(self, faces):
        """Add what is not there yet; how many were added.

        Parameters
        ----------
        faces : sequence of (object, str)
        """
        known, count = set(map(face_key, self._faces)), len(self._faces)
        for face in faces:
            if face_key(face) not in known:
                known.add(face_key(face))
                self._faces.append(face)
                self._areas[face_key(face)] = _area_of(*face)
        if len(self._faces) > count:
            self._changed()
        return len(self._faces) - count

    def show_skins(self, skins):
        """Give faces that are machined as one a row together, the largest first, and list no tiny ones.

        Parameters
        ----------
        skins : sequence of tuple of (object, str)
            Narrow planes and cylinders among them that are not in the list; nothing for a row for each face.
        """
        known = set(map(face_key, self._faces))
        skins = tuple(skin for skin in skins if known.intersection(map(face_key, skin)))
        if skins != self._skins:
            self._skins = skins
            self._areas = {face_key(face): _area_of(*face) for skin in skins for face in skin} | self._areas
            self._list_rows()

    def _list_rows(self):
        """Write all rows anew."""
        within = {face_key(face) for skin in self._skins for face in skin}
        rows = [*self._skins, *((face,) for face in self._faces if face_key(face) not in within)]
        if self._skins:
            rows.sort(key=lambda row: -(self._area(row) or 0.0))
        self.widget.clear()
        for row in rows:
            (thing, name), area = row[0], self._area(row)
            title = name if len(row) == 1 else translate("ToolAxis", "{} and {} more").format(name, len(row) - 1)
            append(self.widget, ", ".join([title, *([] if area is None else [area_text(area)]), thing.Label]),
                   UserRole=row, ToolTipRole=", ".join(name for _, name in row))
        self._filter()

    def _area(self, row):
        """Area of the faces of a row, mm^2; None where one cannot be read."""
        areas = [self._areas[face_key(face)] for face in row]
        return None if None in areas else sum(areas)

    def _row(self, k):
        return data_of(self.widget, k, role=_DATA)

    def summary(self):
        """How many faces or skins there are, and of which part; empty without any."""
        things = list(dict.fromkeys(thing for thing, _ in self._faces))
        if not things:
            return translate("ToolAxis", "no faces")
        whole = things[0].Label if len(things) == 1 else translate("ToolAxis", "{} parts").format(len(things))
        if self.is_fixed:
            return translate("ToolAxis", "{} of {}, as in the earlier setup").format(len(self._faces), whole)
        if not self._skins:
            return translate("ToolAxis", "{} of {}").format(len(self._faces), whole)
        told = translate("ToolAxis", "skins: {} of {} faces, {}").format(self.widget.count(), len(self._faces), whole)
        tiny = sum(self._is_tiny(k) for k in range(self.widget.count()))
        return told if not tiny else translate("ToolAxis", "{}, tiny and not listed: {}").format(told, tiny)

    def show_matching(self, text):
        """Show only some rows; the others stay in the list.

        Parameters
        ----------
        text : str
            What stands in their names, or "< 5" for those with an area of less than 5 in the square of what lengths are
            shown in; empty for all that are not tiny.
        """
        self._sought = text.strip()
        self._filter()

    def show_kind(self, kind, hidden=()):
        """Show only rows that are in sight, or only those that are hidden; the others stay in the list.

        Parameters
        ----------
        kind : int
            ALL, IN_SIGHT or HIDDEN.
        hidden : iterable of tuple
            Faces that cannot be seen, by `face_key`.
        """
        self._kind, self._hidden = kind, frozenset(hidden)
        self._filter()

    @property
    def listed(self):
        """The faces of all rows, those of skins that were not chosen among them."""
        return tuple(face for k in range(self.widget.count()) for face in self._row(k))

    def _filter(self):
        """Hide what is not looked for, and take its mark away: nothing is removed unseen."""
        for row in range(self.widget.count()):
            hidden = not self._matches(row)
            self.widget.setRowHidden(row, hidden)
            if hidden:
                self.widget.selectionModel().select(self.widget.model().index(row, 0),
                                                    QtCore.QItemSelectionModel.Deselect)

    def _is_tiny(self, row):
        """Whether a row is one of many with next to no area: it is machined all the same."""
        area = self._area(self._row(row))
        whole = sum(self._area(self._row(k)) or 0.0 for k in range(self.widget.count()))
        return bool(self._skins) and area is not None and area < _TINY * whole

    def _is_of_kind(self, row):
        """Whether a row is asked for; it is hidden where all its faces are."""
        return self._kind == ALL or self._hidden.issuperset(map(face_key, self._row(row))) == (self._kind == HIDDEN)

    def _matches(self, row):
        if not self._is_of_kind(row):
            return False
        if not self._sought:
            return self._kind == HIDDEN or not self._is_tiny(row)
        if self._sought.startswith("<"):
            limit = value_from_text(self._sought[1:], "mm")
            if limit is None:
                return True
            area, scale = self._area(self._row(row)), shown_unit("mm")[1]
            return area is not None and area < limit * scale
        texts = [data_of(self.widget, row), *(name for _, name in self._row(row))]
        return any(self._sought.lower() in text.lower() for text in texts)

    @property
    def marked(self):
        """The faces of the marked rows."""
        return tuple(face for index in self.widget.selectedIndexes() for face in index.data(_DATA))

    def mark(self, face):
        """Mark the row of a face alone, where it is not hidden; the faces of that row, none without one.

        Parameters
        ----------
        face : (object, str)
        """
        for k in range(self.widget.count()):
            if face_key(face) in map(face_key, self._row(k)):
                self.widget.setCurrentRow(k)
                return self._row(k)
        return ()

    def remove_marked(self):
        """Remove the faces of the marked rows."""
        marked = set(map(face_key, self.marked))
        if marked:
            self._faces = [face for face in self._faces if face_key(face) not in marked]
            self._changed()

    def remove_object(self, name):
        """Remove the faces of an object that is about to be deleted; how many there were.

        Parameters
        ----------
        name : str
        """
        kept = [(thing, sub) for thing, sub in self._faces if thing.Name != name]
        gone = len(self._faces) - len(kept)
        if gone:
            self.faces = kept
        return gone


def face_key(face):
    """What a face is known by, also when its object is gone: names of document, object and face.

    Parameters
    ----------
    face : (object, str)
    """
    thing, name = face
    return thing.Document.Name, thing.Name, name


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
