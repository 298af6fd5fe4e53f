"""The task panel of Verify: the judge's map on the faces, its verdict, and the worst points to zoom to."""

from contextlib import suppress

import FreeCAD
import FreeCADGui
import numpy as np
from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.verdict_maps import drawn, greatest_accepted, limit_of, places_above, shown_of
from freecad.toolaxis.gui.axis_map.result_rows import fill
from freecad.toolaxis.gui.play.nodes import view_of
from freecad.toolaxis.gui.verify.colour_bar import Scale
from freecad.toolaxis.gui.verify.paint import WHAT, Paint, skins_of
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.gui.widgets.quantity import fine_text, length_text
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import api
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.macros import record, thing_of
from freecad.toolaxis.services.messages import line_of, lines_of
from freecad.toolaxis.services.write_results import keep_verdict
from PySide import QtWidgets

translate = FreeCAD.Qt.translate

#: The judge looks no farther, mm.
_FAR = 100.0


class VerifyPanel(Panel):
    """FreeCAD calls getStandardButtons.

    Parameters
    ----------
    document : App.Document
    operations : sequence of objects
        Operations of Tool Axis; the verdict is on all of them.
    """

    def __init__(self, document, operations):
        super().__init__(document, load_form("verify"))
        self.operations = list(operations)
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "verify.svg")))
        self.scale = Scale(self.form)
        self.form.scaleLayout.addWidget(self.scale)
        self.paint = Paint(view_of(document.Name))
        self.found, self.meshes = None, []
        self.form.verify.clicked.connect(self.verify)
        self.form.stop.clicked.connect(self.stop)
        self.form.operation.currentIndexChanged.connect(self._show)
        self.form.what.currentIndexChanged.connect(self._show)
        self.form.worst.currentRowChanged.connect(self._zoom)
        self.form.worst.itemClicked.connect(lambda item: self._zoom(self.form.worst.row(item)))
        self._follow()
        self._show()
        self.verify()

    def getStandardButtons(self):
        """Close."""
        return QtWidgets.QDialogButtonBox.Close

    def verify(self):
        """Judge off the GUI thread."""
        if self.work is not None or not self.operations:
            return
        try:
            judges = [api.verification(operation) for operation in self.operations]
            frames = [child(operation, "Path::Feature").Placement for operation in self.operations]
        except Exception as reason:
            self._tell(sentence(reason), bad=True)
            return
        self.work = BackgroundWork(lambda progress: [_judge_operation(judge, frame, progress)
                                                     for judge, frame in zip(judges, frames, strict=True)])
        self.work.progressed.connect(self._progressed)
        self.work.done.connect(self._done)
        self.work.failed.connect(lambda text: self._ended(text))
        self.work.cancelled.connect(lambda: self._ended(translate("ToolAxis", "Stopped")))
        self._tell(translate("ToolAxis", "Removing material"))
        self._show()
        self.work.start()

    def stop(self):
        """Ask the judge to stop."""
        if self.work is not None:
            self.work.cancel()

    def _progressed(self, stage, share):
        self.form.progress.setMaximum(1000 if share >= 0 else 0)
        self.form.progress.setValue(int(1000 * max(share, 0.0)))
        self._tell(line_of(stage))

    def _done(self, found):
        self.work = None
        self.found = [one for verdicts, _ in found for one in verdicts]
        combo = self.form.operation
        blocked = combo.blockSignals(True)
        combo.clear()
        combo.addItems([f"{verdict.name}" for verdict, _ in self.found])
        combo.blockSignals(blocked)
        failed = [verdict.name for verdict, _ in self.found if not verdict.passed]
        if failed:
            self._tell(translate("ToolAxis", "Not inside tolerance: {}").format(", ".join(failed)), bad=True)
        else:
            self._tell(translate("ToolAxis", "Inside tolerance"))
        self._show()
        self._keep(found)

    def _keep(self, found):
        """Put verdicts and maps into the document; the meshes come to sight when the panel closes."""
        try:
            for operation, (verdicts, maps) in zip(self.operations, found, strict=True):
                scallops, *_ = keep_verdict(operation, [verdict for verdict, _ in verdicts], maps)
                scallops.Visibility = False
                self.meshes.append(scallops)
                record(f"freecad.toolaxis.verify({thing_of(operation)})")
        except Exception as reason:
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            self._tell(translate("ToolAxis", "The result of Verify could not be saved: {}").format(
                sentence(reason)), bad=True)

    def _ended(self, text):
        self.work = None
        self._tell(text, bad=True)
        self._show()

    def _tell(self, text, bad=False):
        tell(self.form.message, text, bad)

    @property
    def chosen(self):
        """The verdict that is shown, with its skins for each of `WHAT`; None before there is one."""
        index = self.form.operation.currentIndex()
        return self.found[index] if self.found and 0 <= index < len(self.found) else None

    def _show(self, *_):
        form, judging = self.form, self.work is not None
        form.progress.setVisible(judging)
        form.stop.setEnabled(judging)
        form.verify.setEnabled(not judging and bool(self.operations))
        chosen = self.chosen
        several = self.found is not None and len(self.found) > 1
        for widget in (form.operation, form.operationLabel):
            widget.setVisible(several)
        for widget in (form.what, form.whatLabel, self.scale, form.results, form.reasons, form.worst, form.worstLabel):
            widget.setVisible(chosen is not None)
        if chosen is None:
            self.paint.clear()
            return
        verdict, skins = chosen
        what = WHAT[form.what.currentIndex()]
        limits = limit_of(verdict, what), greatest_accepted(verdict, what)
        self.scale.show_scale(form.what.currentText(), limits, what == "remaining")
        self.paint.show(skins[what], what, limits)
        fill(form.results, [("", _measures(verdict))])
        form.reasons.setText(lines_of(verdict.reasons))
        self.places = verdict.worst_scallop if what == "remaining" else verdict.worst_gouge
        self._list_worst()

    def _list_worst(self):
        worst = self.form.worst
        blocked = worst.blockSignals(True)
        worst.clear()
        for place in self.places:
            value = fine_text(place.value) if np.isfinite(place.value) else translate("ToolAxis", "not reached")
            x, y, z = (f"{v:.2f}" for v in place.point)
            worst.addItem(translate("ToolAxis", "{} at ({}, {}, {}) on face {}").format(value, x, y, z, place.face))
        if not self.places:
            worst.addItem(translate("ToolAxis", "no points"))
        worst.blockSignals(blocked)

    def _zoom(self, row):
        if self.chosen is not None and 0 <= row < len(self.places):
            size = max(0.12 * float(np.sqrt(self.chosen[0].area)), 2.0)
            self.paint.point_at(self.places[row].point, size)

    def object_deleted(self, name):
        """An operation is about to be deleted: stop and say so."""
        if all(operation.Name != name for operation in self.operations):
            return
        self.operations = [operation for operation in self.operations if operation.Name != name]
        self._leave()
        self.found = None
        self._ended(translate("ToolAxis", "The operation was deleted"))

    def _forget_view(self):
        self.paint.root, self.meshes = None, []

    def _let_go(self):
        """Take the colours off, and show the meshes that stay in the document."""
        self.paint.clear()
        for mesh in self.meshes:
            with suppress(ReferenceError, RuntimeError):  # deleted meanwhile
                mesh.Visibility = True


def _judge_operation(judge, frame, progress):
    """Verdicts of one operation with the skins to paint, and the maps to keep; runs off the GUI thread."""
    verdicts = judge(progress).operations
    skins = [{name: [skin for one in shown_of(verdict, name) for skin in skins_of(one)] for name in WHAT}
             for verdict in verdicts]
    return list(zip(verdicts, skins, strict=True)), drawn(verdicts[0], frame)


def share_text(verdict):
    """The share of the area that is low enough: no round 100 % where the map shows places that are not.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict
    """
    share = f"{100 * verdict.share_within:.2f} %"
    area, border = places_above(verdict)
    if share != "100.00 %" or not (area or border):
        return share
    return "> 99.99 %" if area else translate("ToolAxis", "{}, border aside").format(share)


def _measures(verdict):
    def _room(name):
        room = verdict.clearance.get(name)
        distance = getattr(room, "distance", None)
        if distance is None:
            return translate("ToolAxis", "not checked")
        return length_text(distance) if distance < _FAR else translate("ToolAxis", "over {}").format(length_text(_FAR))

    height = verdict.scallop_max
    return [(translate("ToolAxis", "Max. scallop height"), fine_text(height) if np.isfinite(height) else "-"),
            (translate("ToolAxis", "Scallop limit"), fine_text(verdict.scallop_limit)),
            (translate("ToolAxis", "Rest material"), f"{100 * verdict.declared / verdict.area:.1f} %"),
            (translate("ToolAxis", "Machined within {}").format(
                fine_text(greatest_accepted(verdict, "remaining"))),
             share_text(verdict)),
            (translate("ToolAxis", "Max. gouge"), fine_text(verdict.gouge_max)),
            (translate("ToolAxis", "Gouge allowed"), fine_text(verdict.gouge_allowed)),
            (translate("ToolAxis", "Cutter clearance"), _room("cutter")),
            (translate("ToolAxis", "Shank clearance"), _room("shank")),
            (translate("ToolAxis", "Holder clearance"), _room("holder"))]
