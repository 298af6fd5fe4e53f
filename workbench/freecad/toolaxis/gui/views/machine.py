"""How a machine looks in the tree; its panel opens on a double click."""

import FreeCADGui
from freecad.toolaxis.gui.views.view import View


class MachineView(View):
    """View provider of a machine."""

    icon = "machine.svg"

    def doubleClicked(self, view):
        """Open the panel.

        Parameters
        ----------
        view : Gui.ViewProviderDocumentObject
        """
        FreeCADGui.runCommand("ToolAxis_Machine")
        return True
