"""The field for the setup before the one that is planned: whose faces are planned then, as far as it leaves them."""

import FreeCAD
from freecad.toolaxis.document.earlier_setups import faces_of_setup, setups_to_follow
from freecad.toolaxis.document.kinds import is_plan
from freecad.toolaxis.document.stale_label import plain_label

translate = FreeCAD.Qt.translate


class EarlierChoice:
    """The list of setups that can be followed; out of sight where there is none.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    faces : freecad.toolaxis.gui.plan.face_list.FaceList
    """

    def __init__(self, form, faces):
        self.form, self.faces = form, faces
        self.chosen = None
        self._document = self._plan = None
        self._setups, self._gone, self._slots = [], set(), []
        faces.on_change(self._faces_changed)
        form.after.currentIndexChanged.connect(self._take)
        self._show()

    def on_change(self, slot):
        """Call a slot without arguments whenever another setup is chosen.

        Parameters
        ----------
        slot : callable
        """
        self._slots.append(slot)

    def offer(self, document, planned):
        """Offer the setups of a document.

        Parameters
        ----------
        document : App.Document
        planned : App.DocumentObject or None
            What is planned again: an operation follows no setup, its whole plan does.
        """
        if planned is None or is_plan(planned):
            self._document, self._plan = document, planned
        self._show()

    def choose(self, setup):
        """Show a setup as the one that is followed.

        Parameters
        ----------
        setup : App.DocumentObject or None
        """
        self.chosen = setup
        self._show()

    def remove_object(self, name):
        """Offer an object no more that is about to be deleted; whether it was chosen.

        Parameters
        ----------
        name : str
        """
        self._gone.add(name)
        was_chosen = self.chosen is not None and self.chosen.Name == name
        self.choose(None if was_chosen else self.chosen)
        return was_chosen

    def _take(self, index):
        """The user has chosen: the faces to machine are those of the earlier setup."""
        self.chosen = self._setups[index - 1] if index > 0 else None
        if self.chosen is not None:
            self.faces.faces = faces_of_setup(self.chosen)
        self._show()
        for slot in self._slots:
            slot()

    def _faces_changed(self):
        """Other faces than those of the earlier setup, as where their part is deleted, follow none."""
        if self.chosen is not None and set(self.faces.faces) != set(faces_of_setup(self.chosen)):
            self.chosen = None
        self._show()

    def _show(self):
        """List what can be followed, with what is chosen."""
        combo = self.form.after
        self._setups = [] if self._document is None else self._list_setups()
        blocked = combo.blockSignals(True)
        combo.clear()
        combo.addItem(translate("ToolAxis", "none"))
        for setup in self._setups:
            combo.addItem(plain_label(setup))
        combo.setCurrentIndex(0 if self.chosen is None else 1 + self._setups.index(self.chosen))
        combo.blockSignals(blocked)
        for widget in (combo, self.form.afterLabel):
            widget.setVisible(bool(self._setups))
        is_free = self.chosen is None
        for button in (self.form.addFaces, self.form.removeFaces):
            button.setVisible(is_free)
        self.faces.is_fixed = not is_free

    def _list_setups(self):
        """The setups of the part that is chosen, or of any part while none is."""
        parts = list(dict.fromkeys(thing for thing, _ in self.faces.faces))
        found = []
        if len(parts) < 2:
            found = setups_to_follow(self._document, parts[0] if parts else None, self._plan)
        there = [setup for setup in found if setup.Name not in self._gone]
        if self.chosen is not None and self.chosen not in there:
            there.append(self.chosen)
        return there
