"""Looks for what a rack machines as one while the panel stands open, and has the list of faces show it."""

from freecad.toolaxis.services.background import BackgroundWork
from freecad.toolaxis.services.skins import skins_task
from PySide import QtCore

#: How long nothing has changed before it is looked for, ms.
_QUIET = 300
#: Inputs on which skins depend.
_ASKED = ("faces", "rack", "blades", "avoid_faces", "allowance", "allowance_on", "held", "scallop")


class SkinSearch(QtCore.QObject):
    """One search at a time, off the GUI thread.

    Parameters
    ----------
    form : QWidget
        Of plan.ui.
    faces : freecad.toolaxis.gui.plan.face_list.FaceList
    """

    found = QtCore.Signal()
    """The list shows other rows."""

    def __init__(self, form, faces):
        super().__init__(form)
        self.faces, self.work = faces, None
        self._inputs, self._known, self._skins = None, None, ()
        self._timer = QtCore.QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(_QUIET)
        self._timer.timeout.connect(self._start)

    def seek(self, inputs):
        """Look for the skins of some inputs soon, unless they were looked for already.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs or None
            None for no skins.
        """
        asked = _asked(inputs)
        if asked != self._known:
            self.leave()
            self._known, self._inputs = asked, inputs
            if asked is not None:
                self._timer.start()
        self.faces.show_skins(self._skins)

    def show(self, inputs, skins):
        """Show skins that are known from a plan; what is looked for is given up.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
            What the plan was made with.
        skins : sequence of tuple of (object, str)
        """
        self.leave()
        self._known = _asked(inputs)
        self._done(tuple(skins))

    def _start(self):
        from toolaxis.errors import ToolAxisError

        try:
            compute = skins_task(self._inputs)
        except ToolAxisError:  # the panel tells it
            return
        self.work = BackgroundWork(compute, self)
        self.work.done.connect(self._done)
        self.work.failed.connect(self._failed)
        self.work.start()

    def _done(self, skins):
        self.work, self._skins = None, skins
        self.faces.show_skins(skins)
        self.found.emit()

    def _failed(self, _):
        """Faces stay listed one by one; what is wrong is told when it is computed."""
        self.work = None

    def pause(self):
        """Give up what is looked for, as the part is planned now: the plan tells its skins."""
        if self.work is not None or self._timer.isActive():
            self.leave()

    def leave(self):
        """Give up what is looked for; it is looked for again when it is asked for."""
        self._timer.stop()
        if self.work is not None:
            self.work.leave()
        self.work, self._known, self._skins = None, None, ()


def _asked(inputs):
    """What of some inputs skins depend on; None where there are none."""
    return None if inputs is None or not inputs.rack else tuple(getattr(inputs, name) for name in _ASKED)
