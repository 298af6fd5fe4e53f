"""What all view providers have in common: their object, an icon, and nothing saved but the class."""

from abc import ABC, abstractmethod

import FreeCADGui
from freecad.toolaxis.gui.views.icons import icon


class View:
    """View provider of an object of ours.

    Parameters
    ----------
    view : Gui.ViewProvider
    """

    #: Name of the icon's file in resources/icons.
    icon = ""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        """Called by FreeCAD when the view is there."""
        self.thing = view.Object

    def getIcon(self):
        """The icon in the tree."""
        return icon(self.icon)

    def dumps(self):
        """Nothing to save."""

    def loads(self, state):
        """Nothing was saved."""


class ResultView(View, ABC):
    """View provider of an object with results, which may be stale."""

    def getIcon(self):
        """Another icon while the results are stale."""
        stale = getattr(getattr(self, "thing", None), "Stale", False)
        return icon("operation-stale.svg" if stale else self.icon)

    def updateData(self, thing, name):
        """Show a changed mark."""
        self.thing = thing
        if name == "Stale":
            thing.ViewObject.signalChangeIcon()

    def onDelete(self, view, names):
        """Delete it without the question that FreeCAD asks for groups: what belongs to it goes with it."""
        return True

    def doubleClicked(self, view):
        """Open its panel where no panel is open."""
        if FreeCADGui.Control.activeDialog():
            return False
        FreeCADGui.Control.showDialog(self.panel(view.Object))
        return True

    @abstractmethod
    def panel(self, thing):
        """The panel of an object.

        Parameters
        ----------
        thing : App.DocumentObject
        """
