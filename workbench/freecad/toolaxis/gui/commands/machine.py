"""Machine: picks one, shows its angles for every operation, and moves it from one to the next."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.commands.selection import operations
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class ChooseMachine:
    """Open the machine's panel for the selected operations, or all of the document where none is selected."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "machine.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Machine", "Machine"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Machine",
                    "Selects a machine and shows the positions of its rotary axes for each operation, and its index "
                    "moves"),
                "Accel": "T, M"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel, or say what is missing."""
        planned = [one for one in operations(FreeCAD.ActiveDocument) if one.Motions]
        found = [one for one in planned if not one.AxisMoves]
        if planned and not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "All operations use a moving tool axis. Choose their machine in the "
                                                  "planning panel, tab Job."))
            return
        if not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "There is no planned operation for a machine: "
                                                  "select faces and run Plan Orientations first."))
            return
        from freecad.toolaxis.gui.machine.panel import MachinePanel

        FreeCADGui.Control.showDialog(MachinePanel(FreeCAD.ActiveDocument, found))
