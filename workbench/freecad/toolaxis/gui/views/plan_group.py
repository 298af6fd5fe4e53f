"""A whole plan in the tree: its icon tells whether its results still hold."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.blade_links import quiet
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.gui.views.icons import icon
from PySide import QtCore

#: Time between looks whether a document is open as a whole, ms: before, links still forget what they are told to hide.
_PAUSE = 100


def _quiet(name):
    document = FreeCAD.listDocuments().get(name)
    if document is not None and document.Restoring:
        QtCore.QTimer.singleShot(_PAUSE, lambda: _quiet(name))
    elif document is not None:
        quiet(document.Objects)


class WholePlanView:
    """View provider of a whole plan.

    Parameters
    ----------
    view : Gui.ViewProvider
    """

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        """Called by FreeCAD when the view is there; when a document was opened, links show all again, later."""
        self.thing = view.Object
        document = self.thing.Document.Name
        QtCore.QTimer.singleShot(0, lambda: _quiet(document))

    def getIcon(self):
        """Another icon while the results are stale."""
        stale = getattr(getattr(self, "thing", None), "Stale", False)
        return icon("operation-stale.svg" if stale else "plan.svg")

    def updateData(self, thing, name):
        """Show a changed mark."""
        self.thing = thing
        if name == "Stale":
            thing.ViewObject.signalChangeIcon()

    def onDelete(self, view, names):
        """Delete it without the question that FreeCAD asks for groups: what belongs to it goes with it."""
        return True

    def doubleClicked(self, view):
        """Open the planning panel with what the plan was made with."""
        if FreeCADGui.Control.activeDialog():
            return False
        from freecad.toolaxis.gui.plan.panel import PlanPanel

        plan = view.Object
        FreeCADGui.Control.showDialog(PlanPanel(plan.Document, inputs_of(plan), plan))
        return True

    def dumps(self):
        """Nothing to save."""

    def loads(self, state):
        """Nothing was saved."""
