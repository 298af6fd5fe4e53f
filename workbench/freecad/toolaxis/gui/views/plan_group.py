"""A whole plan in the tree: its icon tells whether its results still hold."""

import FreeCAD
from freecad.toolaxis.document.blade_links import quiet
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.gui.views.view import ResultView
from PySide import QtCore

#: Time between looks whether a document is open as a whole, ms: before, links still forget what they are told to hide.
_PAUSE = 100


def _quiet(name):
    document = FreeCAD.listDocuments().get(name)
    if document is not None and document.Restoring:
        QtCore.QTimer.singleShot(_PAUSE, lambda: _quiet(name))
    elif document is not None:
        quiet(document.Objects)


class WholePlanView(ResultView):
    """View provider of a whole plan."""

    icon = "plan.svg"

    def attach(self, view):
        """Called by FreeCAD when the view is there; when a document was opened, links show all again, later."""
        super().attach(view)
        document = self.thing.Document.Name
        QtCore.QTimer.singleShot(0, lambda: _quiet(document))

    def panel(self, thing):
        """The planning panel with what the plan was made with."""
        from freecad.toolaxis.gui.plan.panel import PlanPanel

        return PlanPanel(thing.Document, inputs_of(thing), thing)
