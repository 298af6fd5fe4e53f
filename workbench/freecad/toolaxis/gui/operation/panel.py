"""The task panel of one operation in the document: what it comes to, its map, and the tool moved along its passes."""

import json

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.children import child
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.document.stale_label import plain_label
from freecad.toolaxis.gui.axis_map.legend import Legend
from freecad.toolaxis.gui.axis_map.raster import marked, picture_of
from freecad.toolaxis.gui.axis_map.result_rows import fill, measures
from freecad.toolaxis.gui.axis_map.widget import HemisphereMap, no_map
from freecad.toolaxis.gui.operation.collisions import Collisions
from freecad.toolaxis.gui.pictures.window import show_pictures
from freecad.toolaxis.gui.plan.panel import PlanPanel
from freecad.toolaxis.gui.verify.panel import VerifyPanel
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import api
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.export import plan_task
from freecad.toolaxis.services.messages import lines_of, shown, stale_text
from freecad.toolaxis.services.pictures import drawn
from PySide import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

#: How long nothing has changed before collisions are looked for again, ms.
_AGAIN = 300


class OperationPanel(Panel):
    """FreeCAD calls getStandardButtons.

    Parameters
    ----------
    document : App.Document
    operation : App.DocumentObject
    """

    def __init__(self, document, operation):
        from toolaxis.plan.document import orientation_from

        super().__init__(document, load_form("operation"))
        self.operation, self.drawing, self.collisions = operation, None, None
        self.again = QtCore.QTimer(self.form)
        self.again.setSingleShot(True)
        self.again.setInterval(_AGAIN)
        self.again.timeout.connect(self._look_again)
        self.form.setWindowTitle(plain_label(operation))
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "operation.svg")))
        self.map, self.legend = HemisphereMap(self.form, translate("ToolAxis", "There is no map.")), Legend(self.form)
        self.found = orientation_from(json.loads(operation.AxisMap)) if operation.AxisMap else None
        if self.found is not None and self.found.map is None:
            self.map.show_picture(None, no_map(self.found))
        self.map.setObjectName("axisMap")
        self.form.mapLayout.addWidget(self.map)
        self.form.legendLayout.addWidget(self.legend)
        self.tool = next((one for one in operation.Group
                          if getattr(getattr(one, "Proxy", None), "Type", "") == "ToolAxisTool"), None)
        moves = self.found is not None and self.found.lead is not None
        for widget in (self.form.mapPlace, self.form.legendPlace, self.form.pointer):
            widget.setVisible(not moves)
        self._fill()
        self._connect()
        self._draw_map()
        self._look_out()

    def getStandardButtons(self):
        """Close."""
        return QtWidgets.QDialogButtonBox.Close

    def _fill(self):
        form, operation = self.form, self.operation
        form.again.setText(translate("ToolAxis", "Recompute") if operation.Stale
                           else translate("ToolAxisOperation", "Plan again..."))
        if operation.Stale:
            tell(form.message, stale_text(operation), bad=True)
        else:
            told = translate("ToolAxis", "Results are up to date; Verify: {}")
            tell(form.message, told.format(shown(operation.Verdict)))
        seconds = operation.MachiningTime.Value
        fill(form.results, [] if self.found is None else [("", measures(self.found, seconds))])
        form.reasons.setText(lines_of(operation.Reasons))
        passes = child(operation, "Path::Feature") is not None
        form.slide.setEnabled(self.tool is not None and passes)
        if self.tool is not None:
            form.slide.setValue(round(self.tool.Position * form.slide.maximum()))
        form.verify.setEnabled(passes)
        form.pictures.setEnabled(passes and self.drawing is None)

    def _connect(self):
        form = self.form
        form.slide.valueChanged.connect(self._move)
        form.again.clicked.connect(self._plan_again)
        form.verify.clicked.connect(self._verify)
        form.pictures.clicked.connect(self.draw)
        form.met.linkActivated.connect(self._show_collision)
        self.map.hovered.connect(form.pointer.setText)
        self._follow()

    def _move(self, value):
        if self.tool is not None:
            if not self.tool.ViewObject.Visibility:
                self.tool.ViewObject.Visibility = True
            self.tool.Position = value / self.form.slide.maximum()
        if self.collisions is not None:
            self.collisions.stand(self.tool.Position)

    def _look_out(self):
        """Look for what the tool meets, where there is one on passes."""
        if self.form.slide.isEnabled():
            self.collisions = Collisions(self.operation, self.tool, self.form.met)
            self.collisions.look()

    def _show_collision(self, _):
        """Move the tool to a collision."""
        share = self.collisions.somewhere()
        if share is not None:
            self.form.slide.setValue(round(share * self.form.slide.maximum()))
            self.tool.Position = share  # a slider knows places between its steps as little as short collisions
            self.collisions.stand(share)

    def _draw_map(self):
        """The map, off the GUI thread: its centre is the mean normal of the face, which has to be read."""
        found, number = self.found, json.loads(self.operation.Details or "{}").get("face", 0)
        if found is None or found.map is None:
            return
        try:
            source = ShapesRead.of(inputs_of(self.operation))
        except Exception as reason:  # the part is gone: no map
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            return
        self.map.empty = translate("ToolAxis", "The map is being drawn.")
        self.work = BackgroundWork(lambda progress: _picture(source, number, found, progress))
        self.work.done.connect(self._drawn)
        self.work.failed.connect(self._not_drawn)
        self.work.start()

    def _drawn(self, picture):
        self.work = None
        self.map.show_picture(picture)
        self.map.setCursor(QtCore.Qt.ArrowCursor)
        self.legend.show_picture(picture)

    def _not_drawn(self, message):
        self.work = None
        self.map.empty = translate("ToolAxis", "The map could not be drawn.")
        self.map.update()
        tell(self.form.message, message, bad=True)

    def draw(self):
        """Draw the operation as it stands, off the GUI thread, and open the window with its pictures."""
        try:
            plan = plan_task([self.operation])
        except Exception as reason:
            tell(self.form.message, sentence(reason), bad=True)
            return
        self.drawing = BackgroundWork(lambda progress: drawn(plan(progress), progress))
        self.drawing.done.connect(self._show_pictures)
        self.drawing.failed.connect(self._no_pictures)
        tell(self.form.message, translate("ToolAxis", "Drawing"))
        self.form.pictures.setEnabled(False)
        self.drawing.start()

    def _show_pictures(self, pictures):
        self.drawing = None
        self._fill()
        show_pictures(pictures)

    def _no_pictures(self, message):
        self.drawing = None
        self._fill()
        tell(self.form.message, message, bad=True)

    def _forget_view(self):
        if self.collisions is not None:
            self.collisions.forget()

    def _let_go(self):
        if self.collisions is not None:
            self.collisions.leave()
        if self.drawing is not None:
            self.drawing.leave()
            self.drawing = None

    def _plan_again(self):
        """Open the planning panel; it computes at once where what stands is stale."""
        chosen, stale = api.planned_with(self.operation), self.operation.Stale
        then = PlanPanel.compute if stale else None
        self._open_instead(lambda: PlanPanel(self.document, inputs_of(chosen), chosen), then)

    def _verify(self):
        self._open_instead(lambda: VerifyPanel(self.document, [self.operation]))

    def object_deleted(self, name):
        """The operation or its tool is about to be deleted: close the panel."""
        if self.collisions is not None and name in (self.operation.Name, self.tool.Name):
            self.collisions.leave()
            self.collisions = None
        if name == self.operation.Name:
            self.document_closed()
        elif self.tool is not None and name == self.tool.Name:
            self.tool = None
            self.form.slide.setEnabled(False)
        QtCore.QTimer.singleShot(0, self._refresh)  # it may be one of what belongs to the operation

    def object_changed(self, name):
        """The part has changed: the marks may have."""
        if not self.over:
            QtCore.QTimer.singleShot(0, self._refresh)
            if self.collisions is not None and name != self.tool.Name:
                self.again.start()

    def _look_again(self):
        if not self.over and self.collisions is not None:
            self.collisions.look()

    def _refresh(self):
        if not self.over:
            self._fill()


def _picture(source, number, found, progress):
    """The picture of a kept map; runs off the GUI thread."""
    part, _ = source.read(progress)
    picture = picture_of(part.face(number), found.map)
    return None if picture is None else marked(picture, found)
