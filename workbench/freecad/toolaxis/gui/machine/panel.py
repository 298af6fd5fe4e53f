"""The task panel of Machine: pick one, see its angles for every operation, and watch it go from one to the next."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.machine import machine_of, place_machine
from freecad.toolaxis.document.machine_angles import texts_of
from freecad.toolaxis.document.machine_limits import available, text_of
from freecad.toolaxis.gui.machine.check import looked_at, met_by, middle_of, tip_of
from freecad.toolaxis.gui.play.bar import PlayBar, PlayWidgets, bodies_text, names_of, things_of
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.gui.widgets.table_entries import data_of, put
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.messages import list_of, shown
from freecad.toolaxis.services.playing import played_from
from freecad.toolaxis.services.tour import MachineTour, meeting
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Width of the operations' names in the table, pixels.
_NAMES = 110


class MachinePanel(Panel):
    """FreeCAD calls accept and getStandardButtons.

    Parameters
    ----------
    document : App.Document
    operations : sequence of App.DocumentObject
        Operations with passes.
    """

    def __init__(self, document, operations):
        super().__init__(document, load_form("machine"))
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "machine.svg")))
        self.operations = list(operations)
        self.bar = PlayBar(document, PlayWidgets.of(self.form, self.form.still))
        self.found, self.held = None, {}
        self._fill()
        self._connect()
        self._follow()
        self._changed()

    def getStandardButtons(self):
        """OK and Cancel."""
        return QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel

    def accept(self):
        """Put the machine into the document, with the angles of the operations, as one undo step."""
        if self.found is None:
            return False
        texts = [(operation, texts_of(self.found.mounted.machine, ways, taken))
                 for operation, (ways, taken) in zip(self.operations, self.found.rows, strict=True)]
        try:
            place_machine(self.document, self.machine, self.offset, texts)
        except Exception as reason:
            tell(self.form.message, sentence(reason), bad=True)
            return False
        self._close()
        return True

    @property
    def machine(self):
        """Name or file of the machine that is picked."""
        return self.form.machine.currentData() or ""

    @property
    def offset(self):
        """Where the document's origin stands on the table, mm."""
        return tuple(spin.value() for spin in self._spins)

    @property
    def _spins(self):
        return self.form.offsetX, self.form.offsetY, self.form.offsetZ

    def _fill(self):
        self.form.machine.setMinimumContentsLength(12)
        self.form.machine.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        for spin in self._spins:
            spin.setMinimumWidth(50)
            spin.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Fixed)
        self.form.angles.setMinimumWidth(200)
        for title, name in available().items():
            self.form.machine.addItem(title, name)
        standing = machine_of(self.document)
        if standing is not None:
            self._pick(standing.Machine)
            for spin, value in zip(self._spins, standing.Offset, strict=True):
                spin.setValue(value)

    def _pick(self, name):
        """Choose a machine by name or file; a file that is not in the list is added."""
        index = self.form.machine.findData(name)
        if index < 0:
            self.form.machine.addItem(name, name)
            index = self.form.machine.count() - 1
        self.form.machine.setCurrentIndex(index)

    def _connect(self):
        form = self.form
        form.machine.currentIndexChanged.connect(self._changed)
        for spin in self._spins:
            spin.setKeyboardTracking(False)
            spin.valueChanged.connect(self._changed)
        form.browse.clicked.connect(self._browse)
        form.angles.cellClicked.connect(self._clicked)

    def _browse(self):
        name, _ = QtWidgets.QFileDialog.getOpenFileName(self.form, translate("ToolAxis", "Machine file"), "",
                                                        "TOML, FreeCAD (*.toml *.fcm)")
        if name:
            self._pick(name)

    # computing

    def _changed(self, *_):
        """Another machine or place: look at all operations anew."""
        self._leave()
        self.bar.clear()
        self.found, self.held = None, {}
        if not self.operations:
            self._not_found(translate("ToolAxis", "The operations were deleted: there is no tool axis to reach"))
            return
        try:
            played = [played_from([operation])[0] for operation in self.operations]
            self.copies = collisions.copies(self.operations)
        except Exception as reason:
            self._not_found(sentence(reason))
            return
        text = text_of(self.machine, self.offset)
        self.work = BackgroundWork(lambda progress: looked_at(text, played))
        self.work.done.connect(self._looked)
        self.work.failed.connect(self._not_found)
        tell(self.form.message, translate("ToolAxis", "Checking all operations"))
        self._show()
        self.work.start()

    def _not_found(self, message):
        self.work = None
        self.form.angles.setRowCount(0)
        self.form.about.setText("")
        tell(self.form.message, message, bad=True)
        self._show()

    def _looked(self, found):
        self.work, self.found = None, found
        machine = found.mounted.machine
        assumed = ", ".join(machine.assumed)
        self.form.about.setText(translate("ToolAxis", "{}. Assumed: {}.").format(machine.name, assumed or "-"))
        self.form.about.setToolTip(machine.source)
        self._fill_table(machine, found.rows)
        lost = [self.operations[k].Label for k, (_, taken) in enumerate(found.rows) if taken < 0]
        if found.laid is not None:
            self.bar.show(found.laid, looks=True)
        if lost:
            told = translate("ToolAxis", "No usable position on this machine: {}")
            self.told = told.format(", ".join(lost)), True
        elif any(one.tool.gauge_length is None for one in found.operations):
            self.told = translate("ToolAxis", "All tool axes can be reached. Axis travels not checked: the tool has "
                                              "no holder."), False
        else:
            told = translate("ToolAxis", "All tool axes can be reached. OK puts the machine into the document.")
            self.told = told, False
        tell(self.form.message, *self.told)
        if found.laid is not None:
            self._look_out()
        self._show()

    def _look_out(self):
        """Look for what the tool and the machine meet of parts and clamps, off the GUI thread."""
        found, copies = self.found, self.copies
        self.work = BackgroundWork(lambda progress: met_by(found, copies, progress))
        self.work.done.connect(self._looked_out)
        self.work.failed.connect(lambda text: self._not_looked_out(text))
        self.work.start()

    def _looked_out(self, found):
        """Stop where something meets, and say so."""
        self.work = None
        self.held, met = found
        for (row, column), one in self.held.items():
            if one is not None and not self.found.rows[row][0][column].reason:
                text = data_of(self.form.angles, row, column)
                put(self.form.angles, row, column, f"{text}\n{shown(one.text)}", shown(one.text))
        self.form.angles.resizeRowsToContents()
        self.bar.show_collisions(met)
        tell(self.form.message, *self._verdict())

    def _not_looked_out(self, text):
        self.work = None
        self.bar.give_up()
        tell(self.form.message, translate("ToolAxis", "{} Collisions with the part could not be checked: {}").format(
            self.told[0], text), True)

    def _verdict(self):
        """What is told above the table: where an operation, or a way between two, meets something."""
        labels = [self.operations[row].Label for row, _ in self.found.stations]
        for label, key in zip(labels, self.found.stations, strict=True):
            if self.held.get(key) is not None:
                return f"{label}: {shown(self.held[key].text)}", True
        for place, row, one in self.bar.places:
            if self.found.laid.playback.at(place).between:
                return translate("ToolAxis", "Index move from {} to {}: {}").format(
                    labels[row], labels[row + 1], shown(one.text)), True
            return f"{labels[row]}: {shown(one.text)}", True
        return self.told

    def _fill_table(self, machine, rows):
        table = self.form.angles
        count = max(1, *(len(ways) for ways, _ in rows))
        table.setColumnCount(count)
        table.setRowCount(len(rows))
        table.setHorizontalHeaderLabels([translate("ToolAxis", "Solution {}").format(k + 1) for k in range(count)])
        metrics = table.fontMetrics()  # the end tells faces of one part apart
        table.setVerticalHeaderLabels([metrics.elidedText(operation.Label, QtCore.Qt.ElideMiddle, _NAMES - 12)
                                       for operation in self.operations])
        for row, operation in enumerate(self.operations):
            table.model().setHeaderData(row, QtCore.Qt.Vertical, operation.Label, QtCore.Qt.ToolTipRole)
        for row, (ways, taken) in enumerate(rows):
            if not ways:
                put(table, row, 0, translate("ToolAxis", "no position reaches it"))
            for column, way in enumerate(ways):
                angles = way.text(machine).replace("  ", "\n")
                font = QtGui.QFont(table.font())
                font.setBold(column == taken)
                put(table, row, column, angles + (f"\n{shown(way.reason)}" if way.reason else ""),
                    shown(way.reason) or way.text(machine), FontRole=font)
        table.horizontalHeader().setSectionResizeMode(QtWidgets.QHeaderView.Stretch)
        table.verticalHeader().setMaximumWidth(_NAMES)
        table.resizeRowsToContents()

    def _show(self):
        self.form.angles.setEnabled(self.found is not None)
        self.bar.refresh()

    def _clicked(self, row, column):
        """Show one solution of one operation, also one that cannot be held."""
        if self.found is None or column >= len(self.found.rows[row][0]):
            return
        self.bar.pause()
        way, one = self.found.rows[row][0][column], self.held.get((row, column))
        path = self.found.operations[row].path
        if (row, column) in self.found.stations:
            motion = middle_of(path) if one is None else min(one.motion + 1, len(path.cl) - 1)
            self.bar.go(self.found.laid.playback.place_of(self.found.stations.index((row, column)), motion))
            return
        mounted = self.found.holding(row)
        joints = MachineTour.through(mounted, [(tip_of(path, one), way.rotary)]).joints[0]
        red, depth = meeting(mounted, joints)
        scene = self.bar.scene
        scene.stand(joints, red | names_of(one), self.form.still.isChecked(),
                    next((k for k, (other, _) in enumerate(self.found.stations) if other == row), 0))
        scene.redden(things_of(one, self.document))
        reasons = [text for text in (way.reason, one.text if one is not None else "") if text]
        told = [f"{way.text(mounted.machine)}: {list_of(reasons)}", *([bodies_text(red, depth)] if red else [])]
        tell(self.form.pointer, "\n".join(told), bool(reasons))

    # what happens to the document meanwhile

    def object_deleted(self, name):
        """An operation is about to be deleted: go on without it."""
        if any(operation.Name == name for operation in self.operations):
            self.operations = [operation for operation in self.operations if operation.Name != name]
            self._leave()  # what is found now counts the one that goes
            self.found, self.held = None, {}
            QtCore.QTimer.singleShot(0, lambda: None if self.over else self._changed())

    def _forget_view(self):
        self.bar.forget()

    def _let_go(self):
        self.bar.leave()
