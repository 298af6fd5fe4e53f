"""Tells when a 3D view that was turned has come to rest."""

import numpy as np
from freecad.toolaxis.gui.plan.camera import camera_of
from PySide import QtCore

#: How often the view is looked at, ms: it rests when it stands the same twice.
_EVERY = 200


class ViewWatch(QtCore.QObject):
    """Looks at a document's view from time to time, once it is begun.

    Parameters
    ----------
    document : App.Document
    parent : QObject
    """

    rested = QtCore.Signal()
    """The view shows another side than when this was told last, and moves no more."""

    def __init__(self, document, parent):
        super().__init__(parent)
        self.document = document
        self._told = self._before = None
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(_EVERY)
        self._timer.timeout.connect(self._look)

    def begin(self):
        """Watch from how the view stands now."""
        self._told = self._before = self._side()
        self._timer.start()

    def look_again(self):
        """Tell once more that the view has come to rest."""
        self._told = None

    def leave(self):
        """Watch no more."""
        self._timer.stop()

    def _look(self):
        side, before = self._side(), self._before
        self._before = side
        if side == before and side != self._told:
            self._told = side
            self.rested.emit()

    def _side(self):
        """From where one looks; panning and zooming change nothing of that where lines of sight are parallel."""
        camera = camera_of(self.document)
        return tuple(np.round(camera.rotation, 6).flat), None if camera.eye is None else tuple(camera.eye)
