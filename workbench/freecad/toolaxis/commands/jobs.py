"""Make CAM jobs: FreeCAD's own jobs from operations, ready for its post-processors."""

import FreeCAD
import FreeCADGui

from .. import RESOURCES
from .chosen import operations, warn

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
translate = FreeCAD.Qt.translate


class MakeJobs:
    """Make jobs of the selected operations, or of all of the document where none is selected."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "jobs.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_MakeJobs", "Make CAM Jobs"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_MakeJobs",
                    "Makes jobs of FreeCAD's CAM workbench from operations: stock, tool and passes for each "
                    "orientation, ready for a post-processor"),
                "Accel": "T, J"}

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        """Make the jobs and select them, or say what is missing."""
        from ..cam_jobs import make_jobs
        from ..macros import list_of, record
        from ..tasks import sentence

        document = FreeCAD.ActiveDocument
        found = operations(document)
        if not found:
            warn(translate("ToolAxis", "There is no planned operation to make a job of: "
                                       "select faces and run Plan Orientations first."))
            return
        try:
            made = make_jobs(document, found)
        except Exception as reason:
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            warn(sentence(reason))
            return
        record(f"freecad.toolaxis.make_jobs(FreeCAD.ActiveDocument, {list_of(found)})")
        FreeCADGui.Selection.clearSelection(document.Name)
        for job in made:
            FreeCADGui.Selection.addSelection(document.Name, job.Name)
        without = [one.Label for one in found if not one.Motions]
        if without:
            warn(translate("ToolAxis", "Not in the jobs, for want of an axis: {}").format(", ".join(without)))
