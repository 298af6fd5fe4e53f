"""How a machine looks in the tree; its panel opens on a double click."""

import FreeCADGui
from freecad.toolaxis.paths import RESOURCES


class MachineView:
    """View provider of a machine.

    Parameters
    ----------
    view : Gui.ViewProviderDocumentObject
    """

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        """Keep the object, called by FreeCAD."""
        self.thing = view.Object

    def getIcon(self):
        """The machine's icon."""
        return str(RESOURCES / "icons" / "machine.svg")

    def doubleClicked(self, view):
        """Open the panel.

        Parameters
        ----------
        view : Gui.ViewProviderDocumentObject
        """
        FreeCADGui.runCommand("ToolAxis_Machine")
        return True

    def dumps(self):
        """Nothing is saved."""

    def loads(self, state):
        """Nothing was saved."""
