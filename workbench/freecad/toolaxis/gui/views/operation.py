"""An operation in the tree: its icon tells whether its results still hold."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.kinds import plan_of
from freecad.toolaxis.document.stale_label import plain_label
from freecad.toolaxis.gui.views.view import ResultView
from freecad.toolaxis.services.messages import list_of

translate = FreeCAD.Qt.translate

#: What makes FreeCAD open all that is above an object in the tree.
_EXPAND_PATH = 3
#: How long the status bar says that something is stale, ms.
_TIME = 10000


class OperationView(ResultView):
    """View provider of an operation."""

    icon = "operation.svg"

    def updateData(self, thing, name):
        """Show a changed mark, and say so in the status bar."""
        super().updateData(thing, name)
        if name == "Stale" and thing.Stale and not getattr(thing.Document, "Restoring", False):
            if plan_of(thing) is None:  # a plan tells by its own label what is in it
                FreeCADGui.getDocument(thing.Document.Name).toggleTreeItem(thing, _EXPAND_PATH)
            text = translate("ToolAxis", "{} is out of date: {}. Recompute it.").format(
                plain_label(thing), list_of(thing.StaleReasons))
            FreeCADGui.getMainWindow().statusBar().showMessage(text, _TIME)

    def panel(self, thing):
        """Results, map, the tool on its passes, and the way to plan it again."""
        from freecad.toolaxis.gui.operation.panel import OperationPanel

        return OperationPanel(thing.Document, thing)
