"""What the task panels have in common: the document is watched, work is left, and everything is let go of once."""

import FreeCADGui
from freecad.toolaxis.gui.widgets.document_observer import DocumentObserver
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.services.background import clear_for_window, note_window, sentence
from PySide import QtCore, QtWidgets


class Panel:
    """A task panel on a document; FreeCAD calls reject, isAllowedAlterDocument and modifyStandardButtons.

    Parameters
    ----------
    document : App.Document
    form : QWidget
        What the panel shows.
    """

    def __new__(cls, *_, **__):
        """Collect before there is a panel: it must not be among what the collector leaves alone for good."""
        clear_for_window()
        return super().__new__(cls)

    def __init__(self, document, form):
        self.document, self.form = document, form
        self.work, self.over = None, False
        self.buttons = None
        note_window(self)

    def isAllowedAlterDocument(self):
        """Other commands may change the document meanwhile; the panel notices."""
        return True

    def modifyStandardButtons(self, box):
        """Called by FreeCAD with the box of the panel's buttons."""
        if isinstance(box, QtWidgets.QDialogButtonBox):  # else it is Python's object of a dead widget, see load_form
            self.buttons = box

    def reject(self):
        """Stop what runs, and close."""
        self._close()
        return True

    def document_closed(self):
        """The document is about to close: stop, and close the panel."""
        self._forget_view()
        self._close()
        QtCore.QTimer.singleShot(0, FreeCADGui.Control.closeDialog)

    def object_deleted(self, name):
        """An object is about to be deleted."""

    def object_changed(self, name):
        """The shape or the placement of an object has changed."""

    def _follow(self):
        """Watch the document, and the form: FreeCAD may take it away without asking."""
        self.watch = DocumentObserver(self.document, self)
        self.form.destroyed.connect(self._close)

    def _leave(self):
        """Leave the computation that runs, if one does."""
        if self.work is not None:
            self.work.leave()
            self.work = None

    def _close(self, *_):
        """Let go of everything, once."""
        if self.over:
            return
        self.over = True
        self.watch.end()
        self._leave()
        self.buttons = None
        self._let_go()

    def _open_instead(self, make, then=None):
        """Close this panel and open another one.

        Parameters
        ----------
        make : callable
            Makes it.
        then : callable, optional
            Takes it, once it is open.
        """
        self._close()
        FreeCADGui.Control.closeDialog()

        def show():
            try:
                panel = make()
                FreeCADGui.Control.showDialog(panel)
                if then is not None:
                    then(panel)
            except Exception as reason:
                warn(sentence(reason))

        QtCore.QTimer.singleShot(0, show)

    def _let_go(self):
        """Let go of what only this panel has."""

    def _forget_view(self):
        """Let go of what stands in the 3D view without touching it: it goes with the document."""
