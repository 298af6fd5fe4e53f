"""Tour: opens the page of the manual that goes from a part to a posted program in FreeCAD."""

import FreeCAD
from freecad.toolaxis.gui.commands.freecad import add_commands
from freecad.toolaxis.gui.manual.window import show_manual
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


class Tour:
    """Show the tour through FreeCAD."""

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "toolaxis.svg"),
                "MenuText": QT_TRANSLATE_NOOP("ToolAxis_Tour", "Tool Axis Tour"),
                "ToolTip": QT_TRANSLATE_NOOP(
                    "ToolAxis_Tour", "Opens the tour from a part to a posted program, and from there the manual")}

    def IsActive(self):
        """Always."""
        return True

    def Activated(self):
        """Open the window."""
        show_manual("freecad.md")


def register():
    """Make the command known to FreeCAD; its name in a list, as a menu takes it."""
    return add_commands({"ToolAxis_Tour": Tour()})
