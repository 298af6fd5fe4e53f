"""Verify: judges an operation by material removal and paints what is left on its face."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.commands.selection import operations
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Verify:
    """Judge the selected operations, or all of the document where none is selected."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "verify.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Verify", "Verify"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Verify",
                    "Removes material along the passes and shows scallops and gouges on the faces"),
                "Accel": "T, V"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel, or say what is missing."""
        every = operations(FreeCAD.ActiveDocument)
        found = [one for one in every if one.Motions] or every  # what is left to clean-up has nothing to be judged
        if not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "There is no planned operation to verify: "
                                                  "select faces and run Plan Orientations first."))
            return
        from freecad.toolaxis.gui.verify.panel import VerifyPanel

        FreeCADGui.Control.showDialog(VerifyPanel(FreeCAD.ActiveDocument, found))
