"""The tool on its passes in the 3D view: cutter bright, holder see-through."""

from freecad.toolaxis.gui.views.view import View

_CLEAR = 30


class ToolView(View):
    """View provider of the tool."""

    icon = "tool.svg"

    def __init__(self, view):
        super().__init__(view)
        view.Transparency = _CLEAR
        view.ShapeColor = (0.55, 0.60, 0.68)
        view.Selectable = True

    def getDisplayModes(self, view):
        """No modes besides FreeCAD's own."""
        return []

    def getDefaultDisplayMode(self):
        """FreeCAD's own."""
        return "Shaded"
