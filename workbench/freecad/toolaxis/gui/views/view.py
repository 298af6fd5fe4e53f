"""What all view providers have in common: their object, an icon, and nothing saved but the class."""

from abc import ABC, abstractmethod

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.stale_label import mark_label
from freecad.toolaxis.gui.views.icons import icon

translate = FreeCAD.Qt.translate

#: States of a document in which labels are not for us to change.
_BUSY = ("Restoring", "Transacting")


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
        """Show a changed mark: by the icon and at the end of the label.

        While a document is opened or a step is undone, labels come with all other properties.
        """
        self.thing = thing
        if name == "Stale":
            thing.ViewObject.signalChangeIcon()
        if name in ("Stale", "Label") and not any(getattr(thing.Document, state, False) for state in _BUSY):
            mark_label(thing, f" {translate('ToolAxis', '(out of date)')}" if thing.Stale else "")

    def setupContextMenu(self, view, menu):
        """Offer to compute again what is stale.

        Parameters
        ----------
        view : Gui.ViewProviderDocumentObject
        menu : QMenu
        """
        if view.Object.Stale and not FreeCADGui.Control.activeDialog():
            menu.addAction(translate("ToolAxis", "Recompute")).triggered.connect(
                lambda *_: compute_again(view.Object))

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


def compute_again(thing):
    """Open the planning panel for an operation or a plan, and compute at once.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(thing.Document.Name, thing.Name)
    FreeCADGui.runCommand("ToolAxis_Recompute")
