"""Play: tool, holder and machine run along the operations that are selected, or along those of a CAM job."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.cam.jobs import sources_of
from freecad.toolaxis.gui.commands.selection import operations
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Play:
    """Open the panel for the selected operations or jobs, or for all of the document where none is selected."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "play.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Play", "Play"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Play", "Plays all operations in sequence with tool, holder and machine; shows time, "
                                     "index moves and collisions"),
                "Accel": "T, Y"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Open the panel, or say what is missing."""
        document, labels = FreeCAD.ActiveDocument, None
        jobs = [thing for thing in FreeCADGui.Selection.getSelection(document.Name) if sources_of(thing)]
        if jobs:
            rows = [row for job in jobs for row in sources_of(job)]
            found = list({operation.Name: operation for operation, _ in rows}.values())
            labels = [label for _, label in rows]
        else:
            found = [one for one in operations(document) if one.Motions]
        if not found:
            warn(FreeCAD.Qt.translate("ToolAxis", "There is no planned operation to play: "
                                                  "select faces and run Plan Orientations first."))
            return
        from freecad.toolaxis.gui.play.panel import PlayPanel

        FreeCADGui.Control.showDialog(PlayPanel(document, found, labels))
