"""The task panel of Export: a folder, and what is written into it besides the plan."""

from dataclasses import replace
from pathlib import Path

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kept_export import keep_export, kept_export
from freecad.toolaxis.document.machine import machine_of, place_machine
from freecad.toolaxis.document.machine_limits import available, read_text, text_of
from freecad.toolaxis.gui.plan.panel import PlanPanel
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.gui.widgets.quantity import length_text
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import api
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.export import Wish, missing_for_report, task, with_remedy
from freecad.toolaxis.services.macros import list_of, record
from freecad.toolaxis.services.messages import line_of, shown
from PySide import QtWidgets

translate = FreeCAD.Qt.translate


class ExportPanel(Panel):
    """FreeCAD calls getStandardButtons.

    Parameters
    ----------
    document : App.Document
    operations : sequence of App.DocumentObject
    """

    def __init__(self, document, operations):
        super().__init__(document, load_form("export"))
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "export.svg")))
        self.operations = list(operations)
        self.lacking, self.limits_again = 0.0, ""
        self._fill()
        form = self.form
        form.browse.clicked.connect(self._browse)
        form.write.clicked.connect(self.write)
        form.stop.clicked.connect(self.stop)
        form.raisePart.clicked.connect(self.raise_part)
        form.planAgain.clicked.connect(self.plan_again)
        form.dialect.currentIndexChanged.connect(self._place_changed)
        form.machine.currentIndexChanged.connect(self._place_changed)
        for spin in self._spins:
            spin.valueChanged.connect(self._place_changed)
        self._follow()
        tell(form.message, translate("ToolAxis", "Operations: {}. plan.json and their CL files are written.").format(
            len(self.operations)))
        self._show()

    def getStandardButtons(self):
        """Close."""
        return QtWidgets.QDialogButtonBox.Close

    @property
    def _spins(self):
        return self.form.offsetX, self.form.offsetY, self.form.offsetZ

    def _fill(self):
        from toolaxis.post.dialects.registry import dialects

        form = self.form
        file = Path(self.document.FileName) if self.document.FileName else Path.home() / self.document.Label
        form.folder.setText(str(file.with_name(f"{file.stem}-plan")))
        form.dialect.addItem(translate("ToolAxis", "no program"), "")
        for name, dialect in dialects().items():
            form.dialect.addItem(dialect.title, name)
        for combo in (form.machine, form.dialect):
            combo.setMinimumContentsLength(12)
            combo.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        for spin in self._spins:
            spin.setMinimumWidth(50)
            spin.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Fixed)
        missing = missing_for_report()
        if missing:  # all the rest can be written
            form.report.setText(translate("ToolAxis", "HTML report: needs {}").format(", ".join(missing)))
            form.report.setToolTip(translate("ToolAxis", "Install {} by the Addon Manager for reports.").format(
                ", ".join(missing)))
            form.report.setChecked(False)
            form.report.setEnabled(False)
        for title, name in available().items():
            form.machine.addItem(title, name)
        standing = machine_of(self.document)
        if standing is not None:
            self._pick(standing.Machine, standing.Offset)
        self._fill_kept(kept_export(self.operations))

    def _fill_kept(self, kept):
        """What was written last is offered again."""
        form = self.form
        form.folder.setText(kept.get("folder", form.folder.text()))
        form.dialect.setCurrentIndex(max(form.dialect.findData(kept.get("dialect", "")), 0))
        if "machine" in kept:
            self._pick(kept["machine"], kept["offset"])
        form.report.setChecked(form.report.isEnabled() and kept.get("report", form.report.isChecked()))

    def _pick(self, machine, offset):
        """Choose a machine by name or file, and a place on its table; a file that is not in the list is added."""
        combo = self.form.machine
        if combo.findData(machine) < 0:
            combo.addItem(machine, machine)
        combo.setCurrentIndex(combo.findData(machine))
        for spin, value in zip(self._spins, offset, strict=True):
            spin.setValue(value)

    def _browse(self):
        name = QtWidgets.QFileDialog.getExistingDirectory(self.form, translate("ToolAxis", "Folder"),
                                                          str(Path(self.form.folder.text()).parent))
        if name:
            self.form.folder.setText(name)

    def write(self):
        """Write off the GUI thread; what stands in the document is read here and now."""
        form = self.form
        if self.work is not None:
            return
        form.files.clear()
        self._offer_nothing()
        if not form.folder.text().strip():
            tell(form.message, translate("ToolAxis", "Choose a folder."), bad=True)
            return
        dialect = form.dialect.currentData()
        machine = form.machine.currentData() if dialect else ""
        wish = Wish(dialect, machine, tuple(spin.value() for spin in self._spins), form.report.isChecked())
        try:
            folder = Path(form.folder.text().strip()).expanduser()
            compute = task(self.operations, folder, wish)
        except Exception as reason:
            tell(form.message, sentence(reason), bad=True)
            return
        self.work = BackgroundWork(with_remedy(compute))
        self.work.progressed.connect(lambda stage, share: self._progressed(stage, share))
        self.work.done.connect(lambda found: self._done(folder, wish, found))
        self.work.failed.connect(lambda text: self._ended(text, True))
        self.work.cancelled.connect(lambda: self._ended(translate("ToolAxis", "Stopped; the folder is as it was."),
                                                        True))
        form.progress.setMaximum(0)
        self._show()
        self.work.start()

    def stop(self):
        """Ask to stop."""
        if self.work is not None:
            self.work.cancel()

    def raise_part(self):
        """Set the part higher on the table by what is missing, in the document's own machine too, and write."""
        before = tuple(spin.value() for spin in self._spins)
        after = (*before[:2], before[2] + self.lacking)
        standing = machine_of(self.document)
        if standing is not None and (standing.Machine, *standing.Offset) == (self.form.machine.currentData(), *before):
            place_machine(self.document, standing.Machine, after, ())
        self.form.offsetZ.setValue(after[2])
        self.write()

    def plan_again(self):
        """Plan what was to be written for the machine in the fields, in the planning panel, which computes at once."""
        chosen = api.planned_with(self.operations[0])
        inputs = replace(inputs_of(chosen), limits=self.limits_again)
        name, offset = read_text(self.limits_again)
        place_machine(self.document, name, tuple(offset), ())
        self._open_instead(lambda: PlanPanel(self.document, inputs, chosen), PlanPanel.compute)

    def _limits_to_plan_for(self, wish):
        """Machine and place for which to plan again; empty where the plan was made for them, or plans are several."""
        limits = text_of(wish.machine, wish.offset)
        chosen = {api.planned_with(operation).Name for operation in self.operations}
        known = all(inputs_of(operation).limits == limits for operation in self.operations)
        return limits if wish.machine and len(chosen) == 1 and not known else ""

    def _place_changed(self, *_):
        """Another program, machine or place: what was offered for the one before is gone."""
        self._offer_nothing()
        self._show()

    def _offer_nothing(self):
        self.lacking, self.limits_again = 0.0, ""

    def _progressed(self, stage, share):
        self.form.progress.setMaximum(1000 if share >= 0 else 0)
        self.form.progress.setValue(int(1000 * max(share, 0.0)))
        tell(self.form.message, line_of(stage))

    def _done(self, folder, wish, found):
        if found.refusal:
            self.lacking = found.height
            self.limits_again = "" if found.height > 0 else self._limits_to_plan_for(wish)
            self._ended(shown(found.refusal), True)
            return
        names = found.names
        keep_export(self.operations, folder, wish)
        record(f"freecad.toolaxis.export({list_of(self.operations)}, {str(folder)!r}, freecad.toolaxis.{wish!r})")
        self.form.files.addItems(names)
        self._ended(translate("ToolAxis", "{} files in {}").format(len(names), folder), False)

    def _ended(self, text, bad):
        self.work = None
        tell(self.form.message, text, bad)
        self._show()

    def _show(self, *_):
        form, writing = self.form, self.work is not None
        form.progress.setVisible(writing)
        form.stop.setEnabled(writing)
        form.write.setEnabled(not writing and bool(self.operations))
        form.raisePart.setText(translate("ToolAxis", "Raise the part by {}").format(length_text(self.lacking, 0)))
        form.raisePart.setVisible(not writing and self.lacking > 0 and bool(self.operations))
        form.planAgain.setText(translate("ToolAxis", "Plan again for {}").format(form.machine.currentText()))
        form.planAgain.setVisible(not writing and bool(self.limits_again) and bool(self.operations))
        form.files.setVisible(bool(form.files.count()))
        for widget in (form.machine, form.machineLabel, form.offsetLabel, *self._spins):
            widget.setVisible(bool(form.dialect.currentData()))

    def object_deleted(self, name):
        """An operation is about to be deleted: it is not written."""
        left = [operation for operation in self.operations if operation.Name != name]
        if self.operations and not left:
            tell(self.form.message, translate("ToolAxis", "The operations were deleted: there is nothing to export"),
                 bad=True)
        self.operations = left
        self._show()
