"""Make CAM jobs: FreeCAD's own jobs from operations, ready for its post-processors."""

from time import monotonic

import FreeCAD
import FreeCADGui
from freecad.toolaxis.cam.jobs import count_jobs, make_jobs
from freecad.toolaxis.cam.work_offsets import OFFSETS, shared_of
from freecad.toolaxis.gui.commands.selection import operations
from freecad.toolaxis.gui.widgets.message_box import confirmed, warn
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services.background import sentence
from freecad.toolaxis.services.macros import list_of, record
from freecad.toolaxis.services.messages import shown
from PySide import QtCore, QtWidgets

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
        """Make the jobs and select them, or say what is missing; asks first where they become many."""
        document = FreeCAD.ActiveDocument
        found = operations(document)
        if not found:
            warn(translate("ToolAxis", "There is no planned operation to make a job of: "
                                       "select faces and run Plan Orientations first."))
            return
        try:
            count = count_jobs(found)
            if count > len(OFFSETS) and not confirmed(translate(
                    "ToolAxis", "These operations have {0} orientations, and each becomes a job. There are only {1} "
                                "work offsets (G54 to G59.3), so some jobs will share one. Make {0} jobs?").format(
                                    count, len(OFFSETS))):
                return
            made = _make_jobs(document, found)
        except Exception as reason:
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            warn(sentence(reason))
            return
        if made is None:
            return
        record(f"freecad.toolaxis.make_jobs(FreeCAD.ActiveDocument, {list_of(found)})")
        FreeCADGui.Selection.clearSelection(document.Name)
        for job in made:
            FreeCADGui.Selection.addSelection(document.Name, job.Name)
        without, shared = [one.Label for one in found if not one.Motions], shared_of(made)
        told = [translate("ToolAxis", "Not in the jobs (no tool axis): {}").format(", ".join(without))] * bool(
            without)
        if shared:
            told.append(translate("ToolAxis", "{} of {} jobs share their work offset with another job. Set the offset "
                                              "for the orientation before you run such a program. Jobs and programs "
                                              "carry a note.").format(len(shared), len(made)))
        if told:
            warn("\n\n".join(told))


def _make_jobs(document, found):
    """The jobs; none where the user stopped."""
    from toolaxis.errors import Cancelled
    from toolaxis.progress import Progress

    box = QtWidgets.QProgressDialog("", translate("ToolAxis", "Cancel"), 0, 1, FreeCADGui.getMainWindow())
    box.setWindowTitle("Tool Axis")
    box.setWindowModality(QtCore.Qt.WindowModal)
    box.setMinimumDuration(1000)
    begin = monotonic()

    def show(stage, done, total):
        left = (monotonic() - begin) * (total - done) / done if done else 0.0
        rest = translate("ToolAxis", ", about {} s left").format(round(left)) if done else ""
        box.setMaximum(int(total))
        box.setLabelText(f"{shown(stage)}: {int(done)} / {int(total)}{rest}")
        box.setValue(int(done))

    try:
        return make_jobs(document, found, Progress(show, box.wasCanceled))
    except Cancelled:
        return None
    finally:
        box.close()
        box.deleteLater()
