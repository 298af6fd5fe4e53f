"""The window with the manual: a page with its figures, and the pages that it leads to."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services.background import note_window
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Where the pages lie.
MANUAL = RESOURCES / "manual"
_SIZE, _MARGIN = (860, 720), 30


class ManualPage(QtWidgets.QTextBrowser):
    """Shows pages in Markdown; figures are not wider than the window is at first."""

    def loadResource(self, kind, name):
        """Qt asks for a page or a figure."""
        found = super().loadResource(kind, name)
        if kind != QtGui.QTextDocument.ImageResource:
            return found
        image = QtGui.QImage(self.source().resolved(name).toLocalFile())
        room = _SIZE[0] - 2 * _MARGIN
        return image.scaledToWidth(room, QtCore.Qt.SmoothTransformation) if image.width() > room else image


class ManualWindow(QtWidgets.QDialog):
    """Shows the manual beside FreeCAD, and is gone when it is closed.

    Parameters
    ----------
    parent : QWidget
    name : str
        Of the page, "freecad.md".
    """

    def __init__(self, parent, name):
        super().__init__(parent)
        note_window(self)
        self.setObjectName("ToolAxisManual")
        self.setWindowTitle(translate("ToolAxis", "Tool Axis: tour and manual"))
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.page = ManualPage(self)
        self.page.setObjectName("manualPage")
        self.page.setOpenExternalLinks(True)
        self.page.setSource(QtCore.QUrl.fromLocalFile(str(MANUAL / name)))
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.Close, self)
        back = buttons.addButton(translate("ToolAxis", "Back"), QtWidgets.QDialogButtonBox.ActionRole)
        back.setEnabled(False)
        back.clicked.connect(self.page.backward)
        self.page.backwardAvailable.connect(back.setEnabled)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.page, 1)
        layout.addWidget(buttons)
        buttons.rejected.connect(self.close)
        self.resize(*_SIZE)


def show_manual(name):
    """Open a window with a page of the manual; the window.

    Parameters
    ----------
    name : str
    """
    window = ManualWindow(FreeCADGui.getMainWindow(), name)
    window.show()
    return window
