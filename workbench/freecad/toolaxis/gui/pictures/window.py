"""The window with the pictures of a plan: a list of them, the one that is chosen, and a button that saves them all."""

from pathlib import Path

import FreeCAD
import FreeCADGui
from freecad.toolaxis.services.background import note_window
from freecad.toolaxis.services.pictures import title_of
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

_SIZE, _LIST = (1000, 640), 220


class PictureWindow(QtWidgets.QDialog):
    """Shows pictures; it stays open beside the panel, and is gone when it is closed.

    Parameters
    ----------
    parent : QWidget
    pictures : list of (str, bytes)
        Of `freecad.toolaxis.services.pictures.drawn`.
    """

    def __init__(self, parent, pictures):
        super().__init__(parent)
        note_window(self)
        self.pictures = list(pictures)
        self.setObjectName("ToolAxisPictures")
        self.setWindowTitle(translate("ToolAxis", "Pictures of the plan"))
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.list, self.image = QtWidgets.QListWidget(self), QtWidgets.QLabel(self)
        self.list.setObjectName("pictureList")
        self.list.setFixedWidth(_LIST)
        self.list.setWordWrap(True)
        self.image.setObjectName("picture")
        self.image.setAlignment(QtCore.Qt.AlignCenter)
        self.image.setSizePolicy(QtWidgets.QSizePolicy.Ignored, QtWidgets.QSizePolicy.Ignored)
        for name, _ in self.pictures:
            self.list.addItem(title_of(name))
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.Close, self)
        save = buttons.addButton(translate("ToolAxis", "Save all..."), QtWidgets.QDialogButtonBox.ActionRole)
        save.setObjectName("savePictures")
        inner, outer = QtWidgets.QHBoxLayout(), QtWidgets.QVBoxLayout(self)
        inner.addWidget(self.list)
        inner.addWidget(self.image, 1)
        outer.addLayout(inner, 1)
        outer.addWidget(buttons)
        self.list.currentRowChanged.connect(self._draw)
        buttons.rejected.connect(self.close)
        save.clicked.connect(self._save)
        self.resize(*_SIZE)
        self.list.setCurrentRow(0)

    def resizeEvent(self, event):
        """Draw the picture as large as there is room."""
        super().resizeEvent(event)
        self._draw()

    def _draw(self, *_):
        row = self.list.currentRow()
        if row < 0:
            return
        whole = QtGui.QPixmap()
        whole.loadFromData(self.pictures[row][1])
        room = self.image.size()
        smaller = whole.width() > room.width() or whole.height() > room.height()
        self.image.setPixmap(whole.scaled(room, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation)
                             if smaller else whole)

    def _save(self):
        folder = QtWidgets.QFileDialog.getExistingDirectory(self, translate("ToolAxis", "Folder for the pictures"))
        if not folder:
            return
        try:
            self.save(folder)
        except OSError as reason:
            QtWidgets.QMessageBox.warning(self, self.windowTitle(), translate(
                "ToolAxis", "The pictures cannot be written: {}").format(reason))

    def save(self, folder):
        """Write all pictures into a folder, by the names that the command gives them.

        Parameters
        ----------
        folder : str or Path
        """
        for name, data in self.pictures:
            (Path(folder) / f"{name}.png").write_bytes(data)


def show_pictures(pictures):
    """Open a window with pictures; the window.

    Parameters
    ----------
    pictures : list of (str, bytes)
    """
    window = PictureWindow(FreeCADGui.getMainWindow(), pictures)
    window.show()
    return window
