"""An operation in the tree: its icon tells whether its results still hold."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.views.icons import icon

translate = FreeCAD.Qt.translate

#: How long the status bar says that something is stale, ms.
_TIME = 10000


class OperationView:
    """View provider of an operation.

    Parameters
    ----------
    view : Gui.ViewProvider
    """

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        """Called by FreeCAD when the view is there."""
        self.thing = view.Object

    def getIcon(self):
        """Another icon while the results are stale."""
        stale = getattr(getattr(self, "thing", None), "Stale", False)
        return icon("operation-stale.svg" if stale else "operation.svg")

    def updateData(self, thing, name):
        """Show a changed mark, and say so in the status bar."""
        self.thing = thing
        if name != "Stale":
            return
        thing.ViewObject.signalChangeIcon()
        if thing.Stale and not getattr(thing.Document, "Restoring", False):
            text = translate("ToolAxis", "{} is stale: {}. Recompute it.").format(
                thing.Label, "; ".join(thing.StaleReasons))
            FreeCADGui.getMainWindow().statusBar().showMessage(text, _TIME)

    def onDelete(self, view, names):
        """Delete it without the question that FreeCAD asks for groups: what belongs to it goes with it."""
        return True

    def doubleClicked(self, view):
        """Open the operation's panel: results, map, the tool on its passes, and the way to plan it again."""
        if FreeCADGui.Control.activeDialog():
            return False
        from freecad.toolaxis.gui.operation.panel import OperationPanel

        FreeCADGui.Control.showDialog(OperationPanel(view.Object.Document, view.Object))
        return True

    def dumps(self):
        """Nothing to save."""

    def loads(self, state):
        """Nothing was saved."""
