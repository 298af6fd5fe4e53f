"""Merge and split: sub-surfaces changed by hand; the planning panel opens with them and computes at once."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.kinds import is_operation
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services.background import sentence
from freecad.toolaxis.services.edit_sub_surfaces import merged, split

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
translate = FreeCAD.Qt.translate


def _selection():
    """Operations that are selected, or whose objects are, and what else is selected that has edges and no faces."""
    operations, lines = [], []
    for thing in FreeCADGui.Selection.getSelection(FreeCAD.ActiveDocument.Name):
        above = [one for one in (thing, *thing.InList) if is_operation(one) and (one is thing or thing in one.Group)]
        shape = getattr(thing, "Shape", None)
        if above:
            operations += above
        elif shape is not None and not shape.isNull() and shape.Edges and not shape.Faces:
            lines.append(thing)
    return list(dict.fromkeys(operations)), lines


def _open(make):
    """Open the panel for the plan that inputs are made for, or say why there are none."""
    from freecad.toolaxis.gui.plan.panel import PlanPanel

    try:
        owner, inputs = make()
    except Exception as reason:
        FreeCAD.Console.PrintLog(f"{reason!r}\n")
        warn(f"{sentence(reason)}.")
        return
    panel = PlanPanel(owner.Document, inputs, owner)
    FreeCADGui.Control.showDialog(panel)
    panel.compute()


class _Command:
    """What both have in common."""

    def IsActive(self):
        """Whether a document is open and no other task panel."""
        return FreeCAD.ActiveDocument is not None and not FreeCADGui.Control.activeDialog()


class MergeSubSurfaces(_Command):
    """Put the selected sub-surfaces of a face together."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "merge.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Merge", "Merge Sub-Surfaces"),
                "ToolTip": QT_TRANSLATE_NOOP("ToolAxis_Merge", "Merges the selected sub-surfaces of a face and plans "
                                                               "them again")}

    def Activated(self):
        """Open the panel with the sub-surfaces put together, or say why that cannot be."""
        operations, _ = _selection()
        if len(operations) < 2:
            warn(translate("ToolAxis", "Select two or more sub-surfaces of one face in the tree first."))
            return
        _open(lambda: merged(operations))


class SplitSubSurface(_Command):
    """Cut the selected sub-surface apart, along a line that was drawn, or in its middle."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "split.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Split", "Split Sub-Surface"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Split",
                    "Splits the selected sub-surface along a wire or sketch that is also selected; a closed one cuts a "
                    "piece out; without one, in the middle")}

    def Activated(self):
        """Open the panel with the pieces, or say why that cannot be."""
        operations, lines = _selection()
        if len(operations) != 1 or len(lines) > 1:
            warn(translate("ToolAxis", "Select one sub-surface in the tree. To split it elsewhere than in the middle, "
                                       "also select a line across it."))
            return
        _open(lambda: split(operations[0], lines[0] if lines else None))
