"""The tool on its passes in the 3D view: cutter bright, holder see-through."""

from freecad.toolaxis.gui.views.icons import icon

_CLEAR = 30


class ToolView:
    """View provider of the tool.

    Parameters
    ----------
    view : Gui.ViewProvider
    """

    def __init__(self, view):
        view.Proxy = self
        view.Transparency = _CLEAR
        view.ShapeColor = (0.55, 0.60, 0.68)
        view.Selectable = True

    def attach(self, view):
        """Called by FreeCAD when the view is there."""

    def getIcon(self):
        """The icon in the tree."""
        return icon("tool.svg")

    def getDisplayModes(self, view):
        """No modes besides FreeCAD's own."""
        return []

    def getDefaultDisplayMode(self):
        """FreeCAD's own."""
        return "Shaded"

    def dumps(self):
        """Nothing to save."""

    def loads(self, state):
        """Nothing was saved."""
