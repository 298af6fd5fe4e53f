"""The task panel of Play: tool, holder and machine run along all operations in their order."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.machine_limits import mounting_in
from freecad.toolaxis.gui.play.bar import PlayBar, PlayWidgets
from freecad.toolaxis.gui.widgets.fields import load_form, tell
from freecad.toolaxis.gui.widgets.panel import Panel
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.background import BackgroundWork, sentence
from freecad.toolaxis.services.messages import shown
from freecad.toolaxis.services.playing import lay_out, look_out, played_from
from PySide import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

#: How long nothing has changed before operations are looked at again, ms.
_AGAIN = 300


class PlayPanel(Panel):
    """FreeCAD calls getStandardButtons.

    Parameters
    ----------
    document : App.Document
    operations : sequence of App.DocumentObject
        Operations with passes, in the order in which they are played.
    labels : sequence of str, optional
        What is played of these and of their turned copies, in this order; all of it unless given.
    """

    def __init__(self, document, operations, labels=None):
        super().__init__(document, load_form("play"))
        self.form.setWindowIcon(FreeCADGui.getIcon(str(RESOURCES / "icons" / "play.svg")))
        self.operations, self.labels = list(operations), labels
        self.bar = PlayBar(document, PlayWidgets.of(self.form, self.form.still))
        self.again = QtCore.QTimer(self.form)
        self.again.setSingleShot(True)
        self.again.setInterval(_AGAIN)
        self.again.timeout.connect(self._begin)
        self._follow()
        self._begin()

    def getStandardButtons(self):
        """Close."""
        return QtWidgets.QDialogButtonBox.Close

    def _begin(self):
        """Read the operations, and lay them out off the GUI thread."""
        if self.over:
            return
        self._leave()
        self.bar.clear()
        self.form.still.setVisible(False)
        try:
            played = played_from(self.operations, self.labels)
            mounted = mounting_in(self.document, played[0].tool)
            copies = collisions.copies(self.operations)
        except Exception as reason:
            self._fail(sentence(reason))
            return
        self.bar.hide([thing for operation in self.operations for thing in operation.Group
                       if getattr(getattr(thing, "Proxy", None), "Type", "") == "ToolAxisTool"])
        self.work = BackgroundWork(lambda progress: lay_out(played, mounted))
        self.work.done.connect(lambda laid: self._show_tour(laid, copies))
        self.work.failed.connect(self._fail)
        tell(self.form.message, translate("ToolAxis", "Reading the passes"))
        self.work.start()

    def _fail(self, text):
        self.work = None
        tell(self.form.message, text, bad=True)

    def _show_tour(self, laid, copies):
        self.work = None
        self.form.still.setVisible(laid.mounted is not None)
        self.bar.show(laid, looks=True)
        self.work = BackgroundWork(lambda progress: look_out(laid, copies, progress))
        self.work.done.connect(self._show_collisions)
        self.work.failed.connect(self._not_looked)
        self._tell_machine(laid)
        self.work.start()

    def _not_looked(self, text):
        self.bar.give_up()
        self._fail(translate("ToolAxis", "Collisions could not be checked: {}").format(text))

    def _show_collisions(self, found):
        self.work = None
        self.bar.show_collisions(found)

    def _tell_machine(self, laid):
        """Say what is played on."""
        if laid.why:
            told = translate("ToolAxis", "The machine is not shown: {}").format(shown(laid.why)), True
        elif laid.mounted is None:
            told = translate("ToolAxis", "The tool alone: choose a machine with Tool Axis > Machine to see it and its "
                                         "index moves"), False
        else:
            told = translate("ToolAxis", "On {}").format(laid.mounted.machine.name), False
        tell(self.form.message, *told)

    # what happens to the document meanwhile

    def object_deleted(self, name):
        """An operation, or what stands in its way, is about to be deleted: go on without it."""
        self.operations = [operation for operation in self.operations if operation.Name != name]
        self.again.start()

    def object_changed(self, name):
        """A part or what stands beside it has changed: what meets may have."""
        self.again.start()

    def _forget_view(self):
        self.again.stop()
        self.bar.forget()

    def _let_go(self):
        self.again.stop()
        self.bar.leave()
