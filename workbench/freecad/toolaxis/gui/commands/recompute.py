"""Recompute: plans an operation again with its own inputs, after its part has changed."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.gui.commands.selection import operations, plans
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import api

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Recompute:
    """Plan the selected operation again; its panel opens and computes at once."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "recompute.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Recompute", "Recompute"),
                "ToolTip": QT_TRANSLATE_NOOP("ToolAxis_Recompute",
                                             "Plans the selected operation again, for the part as it is now"),
                "Accel": "T, R"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel with the operation's inputs and compute, or say what is missing."""
        found = plans(FreeCAD.ActiveDocument) or operations(FreeCAD.ActiveDocument)
        if not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "There is no planned operation to recompute: "
                                                  "select faces and run Plan Orientations first."))
            return
        from freecad.toolaxis.gui.plan.panel import PlanPanel

        chosen = api.planned_with(found[0])
        panel = PlanPanel(FreeCAD.ActiveDocument, inputs_of(chosen), chosen)
        FreeCADGui.Control.showDialog(panel)
        panel.compute()
