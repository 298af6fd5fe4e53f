"""What the tool of an operation meets: looked for off the GUI thread, told below the slider, red in the 3D view."""

from contextlib import suppress

import FreeCAD
from freecad.toolaxis.document.passes import PassStations
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.gui.play.nodes import view_of
from freecad.toolaxis.gui.play.scene import red_over
from freecad.toolaxis.gui.widgets.fields import tell
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.background import BackgroundWork
from freecad.toolaxis.services.messages import line_of, shown
from freecad.toolaxis.services.path_collisions import bumps

translate = FreeCAD.Qt.translate


class Collisions:
    """Looks for collisions of an operation, and shows the one at the place where its tool stands.

    Parameters
    ----------
    operation : App.DocumentObject
    tool : App.DocumentObject
        With shank and holder, on the operation's passes.
    label : QLabel
    """

    def __init__(self, operation, tool, label):
        self.operation, self.tool, self.label = operation, tool, label
        self.found = self.stations = self.work = self.view = self.red = None
        self.share = tool.Position

    def look(self):
        """Begin to look for them."""
        self.leave()
        try:
            path, copies = OperationRecord.of(self.operation).path, collisions.copies([self.operation])
            whole = collisions.tool_of(self.operation)
            self.stations = PassStations(self.tool.Passes)
        except Exception as reason:  # the part is gone: nothing to look at
            FreeCAD.Console.PrintLog(f"{reason!r}\n")
            return
        self.work = BackgroundWork(lambda progress: bumps(whole, path, copies, progress))
        self.work.done.connect(self._looked)
        self.work.failed.connect(self._not_looked)
        tell(self.label, translate("ToolAxis", "Checking for collisions"))
        self.work.start()

    def stand(self, share):
        """Tell of the place where the tool stands.

        Parameters
        ----------
        share : float
            Of the way along the passes.
        """
        self.share = share
        if self.found is None:
            return
        here = self.found.at(self.stations.motion(share))
        self._redden(here is not None)
        tell(self.label, *self._words(here))

    def somewhere(self):
        """The share of the way in the middle of the first collision on the passes; None without one there."""
        for one in () if self.found is None else self.found.found:
            ends = self.stations.share(one.first - 1), self.stations.share(one.last)
            if ends[1] > ends[0]:
                return sum(ends) / 2
        return None

    def leave(self):
        """Stop looking, and take the red out of the view."""
        if self.work is not None:
            self.work.leave()
        self.found = self.work = None
        self._redden(False)

    def forget(self):
        """Let go without touching the view, which is gone."""
        self.red = self.view = None
        self.leave()

    def _words(self, here):
        if here is not None:
            return line_of(here.text), True
        if not self.found.found:
            return translate("ToolAxis", "No collisions along the passes (checked: {})").format(
                ", ".join(map(shown, self.found.checked))), False
        if self.somewhere() is None:
            return translate("ToolAxis", "Between the passes {}").format(shown(self.found.found[0].text)), True
        first = next(one for one in self.found.found
                     if self.stations.share(one.last) > self.stations.share(one.first - 1))
        there = translate("ToolAxis", "show it")
        return translate("ToolAxis", "Elsewhere on the passes {}: {}").format(
            shown(first.text), f'<a href="there">{there}</a>'), True

    def _looked(self, found):
        self.work, self.found = None, found
        self.stand(self.share)

    def _not_looked(self, text):
        self.work = None
        tell(self.label, translate("ToolAxis", "Collisions could not be checked: {}").format(text), True)

    def _redden(self, wanted):
        if wanted == (self.red is not None):
            return
        if not wanted:
            with suppress(Exception):  # the view may be gone already
                self.view.getSceneGraph().removeChild(self.red)
            self.red = self.view = None
            return
        self.view = view_of(self.operation.Document.Name)
        if self.view is not None:
            self.red = red_over(self.tool)
            self.view.getSceneGraph().addChild(self.red)
