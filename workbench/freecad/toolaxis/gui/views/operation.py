"""An operation in the tree: its icon tells whether its results still hold."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.views.view import ResultView
from freecad.toolaxis.services.messages import list_of

translate = FreeCAD.Qt.translate

#: How long the status bar says that something is stale, ms.
_TIME = 10000


class OperationView(ResultView):
    """View provider of an operation."""

    icon = "operation.svg"

    def updateData(self, thing, name):
        """Show a changed mark, and say so in the status bar."""
        super().updateData(thing, name)
        if name == "Stale" and thing.Stale and not getattr(thing.Document, "Restoring", False):
            text = translate("ToolAxis", "{} is stale: {}. Recompute it.").format(
                thing.Label, list_of(thing.StaleReasons))
            FreeCADGui.getMainWindow().statusBar().showMessage(text, _TIME)

    def panel(self, thing):
        """Results, map, the tool on its passes, and the way to plan it again."""
        from freecad.toolaxis.gui.operation.panel import OperationPanel

        return OperationPanel(thing.Document, thing)
