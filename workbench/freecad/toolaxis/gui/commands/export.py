"""Export: writes operations as the commands do, from a panel."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.commands.selection import operations
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Export:
    """Open the panel for the selected operations, or all of the document where none is selected."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "export.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Export", "Export"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Export",
                    "Writes plan.json, CL files, an NC program with its setup sheet, and a report"),
                "Accel": "T, E"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel, or say what is missing."""
        found = operations(FreeCAD.ActiveDocument)
        if not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "There is no planned operation to export: select faces and run Plan "
                                                  "Orientations first."))
            return
        from freecad.toolaxis.gui.export.panel import ExportPanel

        FreeCADGui.Control.showDialog(ExportPanel(FreeCAD.ActiveDocument, found))
