"""The task panel of Machine: pick one, see its angles for every operation, and watch it go from one to the next."""

from dataclasses import replace

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.machine import machine_of, place_machine
from freecad.toolaxis.document.machine_angles import texts_of
from freecad.toolaxis.document.machine_limits import available, text_of
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.gui.machine.check import lengths_at, looked_at, met_by, middle_of, names_of, things_of, tip_of
from freecad.toolaxis.gui.machine.motion import MachineTour, meeting
from freecad.toolaxis.gui.machine.scene import MachineScene
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.gui.widgets.table_entries import data_of, put
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.messages import list_of, shown
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Interval of the animation, ms, and the time from one operation to the next, s.
_FRAME, _SECONDS = 40, 2.5
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
        self.scene = MachineScene(document)
        self.found = self.journey = None
        self.stations = []
        self.met, self.held = [], {}
        self.timer = QtCore.QTimer(self.form)
        self.timer.setInterval(_FRAME)
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
        mounted, rows, _ = self.found
        texts = [(operation, texts_of(mounted.machine, ways, taken))
                 for operation, (ways, taken) in zip(self.operations, rows, strict=True)]
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
        form.slide.valueChanged.connect(self._slide)
        form.still.toggled.connect(lambda _: self._slide(form.slide.value()))
        form.play.clicked.connect(self._play)
        self.timer.timeout.connect(self._tick)

    def _browse(self):
        name, _ = QtWidgets.QFileDialog.getOpenFileName(self.form, translate("ToolAxis", "Machine file"), "",
                                                        "TOML, FreeCAD (*.toml *.fcm)")
        if name:
            self._pick(name)

    # computing

    def _changed(self, *_):
        """Another machine or place: look at all operations anew."""
        self._leave()
        self.timer.stop()
        self.found = self.journey = None
        self.met, self.held = [], {}
        self.scene.clear()
        if not self.operations:
            self._not_found(translate("ToolAxis", "The operations were deleted: there is no axis to hold"))
            return
        try:
            stands = [OperationRecord.of(operation) for operation in self.operations]
            tools = [inputs_of(operation).assembled() for operation in self.operations]
            self.copies = collisions.copies(self.operations)
        except Exception as reason:
            self._not_found(sentence(reason))
            return
        text = text_of(self.machine, self.offset)
        self.work = BackgroundWork(lambda progress: looked_at(text, stands, tools))
        self.work.done.connect(lambda found: self._looked(found, stands))
        self.work.failed.connect(self._not_found)
        tell(self.form.message, translate("ToolAxis", "Looking at all operations"))
        self._show()
        self.work.start()

    def _not_found(self, message):
        self.work = None
        self.form.angles.setRowCount(0)
        self.form.about.setText("")
        tell(self.form.message, message, bad=True)
        self._show()

    def _looked(self, found, stands):
        self.work, self.found = None, found
        mounted, rows, tools = found
        machine = mounted.machine
        assumed = ", ".join(machine.assumed)
        self.form.about.setText(translate("ToolAxis", "{}. Assumed: {}.").format(machine.name, assumed or "-"))
        self.form.about.setToolTip(machine.source)
        self._fill_table(machine, rows)
        lost = [self.operations[k].Label for k, (_, taken) in enumerate(rows) if taken < 0]
        self.stations = [(k, max(taken, 0)) for k, (ways, taken) in enumerate(rows) if ways]
        if self.stations:
            self.scene.show(mounted, tools)
            self._travel(stands)
        if lost:
            self.told = translate("ToolAxis", "Not held by this machine: {}").format(", ".join(lost)), True
        elif any(tool.gauge_length is None for tool in tools):
            self.told = translate("ToolAxis", "Every axis can be held. Travels are not looked at: the tool has no "
                                              "holder."), False
        else:
            self.told = translate("ToolAxis", "Every axis can be held. OK puts the machine into the document."), False
        tell(self.form.message, *self.told)
        if self.stations:
            self._look_out()
        self._show()

    def _look_out(self):
        """Look for what the tool and the machine meet of parts and clamps, off the GUI thread."""
        mounted, rows, tools = self.found
        paths, copies, stations = [stand.path for stand in self.stands], self.copies, list(self.stations)
        self.work = BackgroundWork(lambda progress: met_by(mounted, (rows, tools, paths), copies, stations, progress))
        self.work.done.connect(self._looked_out)
        self.work.failed.connect(lambda text: self._not_looked_out(text))
        self.work.start()

    def _looked_out(self, found):
        """Stop where something meets, and say so."""
        self.work = None
        self.held, journey, self.met = found
        at = self.form.slide.value()
        self.journey = journey
        for (row, column), one in self.held.items():
            if one is not None and not self.found[1][row][0][column].reason:
                text = data_of(self.form.angles, row, column)
                put(self.form.angles, row, column, f"{text}\n{shown(one.text)}", shown(one.text))
        self.form.angles.resizeRowsToContents()
        tell(self.form.message, *self._verdict())
        self._slide(at)

    def _not_looked_out(self, text):
        self.work = None
        tell(self.form.message, translate("ToolAxis", "{} Collisions with the part could not be looked for: {}").format(
            self.told[0], text), True)

    def _verdict(self):
        """What is told above the table: where an operation, or a way between two, meets something."""
        for row, column in self.stations:
            if self.held.get((row, column)) is not None:
                return f"{self.operations[row].Label}: {shown(self.held[row, column].text)}", True
        k = next((k for k, one in enumerate(self.met) if one is not None), None)
        if k is None:
            return self.told
        row, other = (self.stations[min(k // collisions.STEPS + j, len(self.stations) - 1)][0] for j in (0, 1))
        return translate("ToolAxis", "On the way from {} to {}: {}").format(
            self.operations[row].Label, self.operations[other].Label, shown(self.met[k].text)), True

    def _travel(self, stands):
        """Show the machine on its way through the operations."""
        mounted, rows, tools = self.found
        self.journey = MachineTour.through(mounted, [(middle_of(stands[k].path), rows[k][0][way].rotary)
                                                     for k, way in self.stations], lengths_at(self.stations, tools))
        self.stands = stands
        self.form.slide.setMaximum(max(1000 * (len(self.stations) - 1), 1))
        blocked = self.form.slide.blockSignals(True)
        self.form.slide.setValue(0)
        self.form.slide.blockSignals(blocked)
        self._slide(0)
        self.scene.look()

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
        form, moving = self.form, self.journey is not None and len(self.journey.joints) > 1
        form.play.setEnabled(moving)
        form.slide.setEnabled(moving)
        form.still.setEnabled(self.journey is not None)
        form.angles.setEnabled(self.found is not None)
        form.play.setText(translate("ToolAxis", "Pause") if self.timer.isActive() else translate("ToolAxis", "Play"))

    # moving

    def _slide(self, value):
        if self.journey is None:
            return
        near, row = self._near(value / 1000), self.stations[self.journey.station(value / 1000)][0]
        mounted, joints = self._holding(row), self.journey.at(value / 1000)
        red, depth = meeting(mounted, joints)
        self.scene.stand(joints, red | names_of(near), self.form.still.isChecked(), row)
        self.scene.redden(things_of(near, self.document))
        at = mounted.at(joints[3:]).removeprefix(" at ")
        linear = "  ".join(f"{axis.name} {x:.1f}" for axis, x in zip(mounted.machine.linear, joints[:3], strict=True))
        text = f"{linear}  {at}"
        if red:
            from toolaxis.machine.setup import in_tenths

            names = ", ".join(map(shown, sorted(red)))
            text += "\n" + translate("ToolAxis", "{} meet by {} mm").format(names, in_tenths(depth))
        if near is not None:
            text += f"\n{shown(near.text)}"
        tell(self.form.pointer, text, bool(red) or near is not None)

    def _holding(self, row):
        """The machine with the tool of an operation in its spindle."""
        mounted, _, tools = self.found
        return replace(mounted, tool_length=tools[row].gauge_length)

    def _near(self, way):
        """What meets there, or at the next place beside it that was looked at; None where nothing does."""
        low = int(way * collisions.STEPS)
        some = self.met[low:low + (1 if way * collisions.STEPS == low else 2)]
        return next((one for one in some if one is not None), None)

    def _clicked(self, row, column):
        """Show one solution of one operation, also one that cannot be held."""
        if self.found is None or column >= len(self.found[1][row][0]):
            return
        self.timer.stop()
        if (row, column) in self.stations:
            self.form.slide.setValue(1000 * self.stations.index((row, column)))
            return
        mounted, rows = self._holding(row), self.found[1]
        way, path, one = rows[row][0][column], self.stands[row].path, self.held.get((row, column))
        joints = MachineTour.through(mounted, [(tip_of(path, one), way.rotary)]).joints[0]
        red, _ = meeting(mounted, joints)
        self.scene.stand(joints, red | names_of(one), self.form.still.isChecked(), row)
        self.scene.redden(things_of(one, self.document))
        reasons = [text for text in (way.reason, one.text if one is not None else "") if text]
        tell(self.form.pointer, f"{way.text(mounted.machine)}: {list_of(reasons)}", bool(reasons))

    def _play(self):
        if self.timer.isActive():
            self.timer.stop()
        else:
            if self.form.slide.value() >= self.form.slide.maximum():
                self.form.slide.setValue(0)
            self.timer.start()
        self._show()

    def _tick(self):
        slide = self.form.slide
        slide.setValue(slide.value() + round(1000 * _FRAME / 1000 / _SECONDS))
        if slide.value() >= slide.maximum():
            self.timer.stop()
            self._show()

    # what happens to the document meanwhile

    def object_deleted(self, name):
        """An operation is about to be deleted: go on without it."""
        if any(operation.Name == name for operation in self.operations):
            self.operations = [operation for operation in self.operations if operation.Name != name]
            QtCore.QTimer.singleShot(0, lambda: None if self.over else self._changed())

    def _forget_view(self):
        self.scene.forget()

    def _let_go(self):
        self.timer.stop()
        self.scene.leave()
