"""Examples: opens one of the parts that come with the project, in a document of its own."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.gui.commands.freecad import add_commands
from freecad.toolaxis.gui.widgets.message_box import warn
from freecad.toolaxis.paths import RESOURCES, ROOT
from freecad.toolaxis.services.background import sentence

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

#: Files in the folder of examples, and what they are called in the menu.
PARTS = {"freeform": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Freeform face"),
         "dish": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Dish"),
         "saddle": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Saddle"),
         "trimmed": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Trimmed face with a hole"),
         "outline": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Face with an irregular outline"),
         "boss": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Face with a boss"),
         "bosses": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Face with three bosses"),
         "skin": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Skin of six faces"),
         "waves": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Strong waves"),
         "manta": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Manta surface"),
         "biquintic": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Biquintic patch"),
         "hyperbolic_paraboloid": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Hyperbolic paraboloid"),
         "hyperbolic_paraboloid_rules": QT_TRANSLATE_NOOP("ToolAxis_Examples",
                                                          "Hyperbolic paraboloid along its rulings"),
         "blade": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Turbine blade"),
         "blisk": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Blisk with 16 blades"),
         "impeller": QT_TRANSLATE_NOOP("ToolAxis_Examples", "Impeller with nine blades")}


class Example:
    """Open one part.

    Parameters
    ----------
    name : str
        Of the file, without its ending.
    """

    def __init__(self, name):
        self.name = name

    @property
    def file(self):
        """The STEP file."""
        return ROOT / "examples" / f"{self.name}.step"

    def GetResources(self):
        """Icon and texts."""
        return {"Pixmap": str(RESOURCES / "icons" / "toolaxis.svg"),
                "MenuText": FreeCAD.Qt.translate("ToolAxis_Examples", PARTS[self.name]),
                "ToolTip": FreeCAD.Qt.translate("ToolAxis_Examples", QT_TRANSLATE_NOOP(
                    "ToolAxis_Examples", "Opens this example part in a document of its own"))}

    def IsActive(self):
        """Whether the file is there."""
        return self.file.is_file()

    def Activated(self):
        """Open the part and look at it as a whole."""
        import Import

        document = FreeCAD.newDocument(self.name)
        try:
            Import.insert(str(self.file), document.Name)
        except Exception as reason:
            FreeCAD.closeDocument(document.Name)
            warn(sentence(reason))
            return
        for thing in document.Objects:
            if hasattr(thing, "Shape") and thing.Shape.Faces:
                thing.Label = FreeCAD.Qt.translate("ToolAxis_Examples", PARTS[self.name])
                break
        document.recompute()
        document.clearUndos()
        view = FreeCADGui.getDocument(document.Name).ActiveView
        view.viewIsometric()
        view.fitAll()


def register():
    """Make the commands known to FreeCAD; their names in the order of the menu."""
    return add_commands({f"ToolAxis_Example_{part}": Example(part) for part in PARTS})
