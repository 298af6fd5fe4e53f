"""The workbench "Tool Axis" and its commands; what is heavy is loaded beside the window."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.view_providers import bring_views
from freecad.toolaxis.paths import RESOURCES

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

FreeCADGui.addLanguagePath(str(RESOURCES / "translations"))
FreeCADGui.updateLocale()
FreeCADGui.addIconPath(str(RESOURCES / "icons"))
FreeCADGui.addPreferencePage(str(RESOURCES / "ui" / "preferences.ui"), QT_TRANSLATE_NOOP("QObject", "Tool Axis"))

#: How long the status bar tells what goes on, ms.
_TOLD = 8000


class ToolAxisWorkbench(FreeCADGui.Workbench):
    """Tool orientations for multi-axis machining of sculptured surfaces."""

    MenuText = QT_TRANSLATE_NOOP("Workbench", "Tool Axis")
    ToolTip = QT_TRANSLATE_NOOP("Workbench", "Tool axes, work coordinate systems and passes for sculptured faces")
    Icon = str(RESOURCES / "icons" / "toolaxis.svg")

    def Initialize(self):
        """Register the commands, once, when the workbench is first shown."""
        from freecad.toolaxis.gui.commands import examples, tour
        from freecad.toolaxis.gui.commands.toolbar import register
        from freecad.toolaxis.gui.widgets.error_report import offer_report
        from freecad.toolaxis.services.background import hear_errors

        hear_errors(offer_report)
        names = register()
        self.appendToolbar(QT_TRANSLATE_NOOP("Workbench", "Tool Axis"), names)
        menu = QT_TRANSLATE_NOOP("Workbench", "&Tool Axis")
        self.appendMenu(menu, names)
        self.appendMenu([menu, QT_TRANSLATE_NOOP("Workbench", "Examples")], examples.register())
        self.appendMenu(menu, tour.register())
        self.appendMenu("&Help", tour.register())
        self._names = names

    def Activated(self):
        """Load the libraries meanwhile: opening the first panel does not wait for them then."""
        from freecad.toolaxis.services.background import load_ahead

        if load_ahead():
            told = FreeCAD.Qt.translate("ToolAxis", "Tool Axis loads its libraries in the background")
            FreeCADGui.getMainWindow().statusBar().showMessage(told, _TOLD)

    def ContextMenu(self, recipient):
        """Offer the commands where something is selected.

        Parameters
        ----------
        recipient : str
            "View" or "Tree".
        """
        if FreeCADGui.Selection.hasSelection():
            self.appendContextMenu("Tool Axis", self._names)

    def GetClassName(self):
        """Name of the C++ class that a Python workbench has."""
        return "Gui::PythonWorkbench"


def _attach_view(thing):
    from freecad.toolaxis.gui.views.attach import attach

    attach(thing)


bring_views(_attach_view)
FreeCADGui.addWorkbench(ToolAxisWorkbench())
