"""The window with the manual: a page with its figures, and the pages that it leads to."""

import re
from pathlib import Path

import FreeCAD
import FreeCADGui
from freecad.toolaxis.paths import RESOURCES
from freecad.toolaxis.services.background import note_window
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

#: Where the pages lie.
MANUAL = RESOURCES / "manual"
_SIZE, _FIGURE = (860, 720), 780


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
        self.names = []
        self.setObjectName("ToolAxisManual")
        self.setWindowTitle(translate("ToolAxis", "Tool Axis: tour and manual"))
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.page = QtWidgets.QTextBrowser(self)
        self.page.setObjectName("manualPage")
        self.page.setOpenLinks(False)
        self.page.setSearchPaths([str(MANUAL)])
        self.page.anchorClicked.connect(self._follow)
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.Close, self)
        self.back = buttons.addButton(translate("ToolAxis", "Back"), QtWidgets.QDialogButtonBox.ActionRole)
        self.back.clicked.connect(self._go_back)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.page, 1)
        layout.addWidget(buttons)
        buttons.rejected.connect(self.close)
        self.resize(*_SIZE)
        self.open_page(name)

    def open_page(self, name):
        """Show a page, with figures that are not wider than the window is at first.

        Parameters
        ----------
        name : str
        """
        document = QtGui.QTextDocument()
        document.setMarkdown((MANUAL / name).read_text(encoding="utf-8"))
        self.page.setHtml(re.sub(r"<img ", f'<img width="{_FIGURE}" ', document.toHtml()))
        self.names.append(name)
        self.back.setEnabled(len(self.names) > 1)

    def _follow(self, link):
        """Open what a link leads to: a page here, all else outside."""
        if not link.scheme() and (MANUAL / link.path()).is_file() and Path(link.path()).suffix == ".md":
            self.open_page(link.path())
        else:
            QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(MANUAL)).resolved(link))

    def _go_back(self):
        self.names.pop()
        self.open_page(self.names.pop())


def show_manual(name):
    """Open a window with a page of the manual; the window.

    Parameters
    ----------
    name : str
    """
    window = ManualWindow(FreeCADGui.getMainWindow(), name)
    window.show()
    return window
