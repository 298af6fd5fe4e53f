"""From where one looks in the 3D view."""

import re

import FreeCADGui
import numpy as np
from freecad.toolaxis.services.sight import Viewpoint

_POSITION = re.compile(r"\bposition ([^\n]+)")


def camera_of(document):
    """The camera of a document's view; from above where it has none.

    Parameters
    ----------
    document : App.Document

    Returns
    -------
    freecad.toolaxis.services.sight.Viewpoint
    """
    view = FreeCADGui.getDocument(document.Name).ActiveView
    if not hasattr(view, "getCameraOrientation"):  # a spreadsheet or a drawing
        return Viewpoint(np.eye(3))
    turn = np.array(view.getCameraOrientation().toMatrix().A, dtype=float).reshape(4, 4)[:3, :3]
    place = _POSITION.search(view.getCamera())
    if view.getCameraType() != "Perspective" or place is None:
        return Viewpoint(turn.T)
    return Viewpoint(turn.T, np.array(place.group(1).split()[:3], dtype=float))
