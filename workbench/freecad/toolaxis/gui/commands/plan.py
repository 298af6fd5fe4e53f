"""Plan orientations: opens the task panel for the selected faces."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class PlanOrientations:
    """Find for each face the fixed tool axis that machines it in the fewest, widest strips."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "plan.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_PlanOrientations", "Plan Orientations"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_PlanOrientations",
                    "Finds the best fixed tool axis for each selected face, its work coordinate system and its passes"),
                "Accel": "T, P"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel."""
        from freecad.toolaxis.gui.plan.panel import PlanPanel

        FreeCADGui.Control.showDialog(PlanPanel(FreeCAD.ActiveDocument))
