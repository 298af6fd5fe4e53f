"""What a user sees of an error inside the add-on: that it was one, and all that a report needs, ready to copy."""

import platform
import re

import FreeCAD
import FreeCADGui
from freecad.toolaxis.services.messages import line_of
from PySide import QtCore, QtWidgets

translate = FreeCAD.Qt.translate


def report_text(message, trace):
    """What a report needs: versions, the sentence that was shown, and where the error came from.

    Parameters
    ----------
    message, trace : str
    """
    from toolaxis import __version__

    version = ".".join(FreeCAD.Version()[:3])
    home = re.escape(FreeCAD.getHomePath()) if FreeCAD.getHomePath() else "(?!)"
    return "\n".join((f"toolaxis {__version__}, FreeCAD {version}, Python {platform.python_version()}, "
                      f"{platform.platform()}", message, "", re.sub(home, "", trace)))


def offer_report(message, trace):
    """Show an error inside the add-on with its details and a button that copies them; waits for nobody.

    Parameters
    ----------
    message : str
        One sentence.
    trace : str
        Where it came from.

    Returns
    -------
    QMessageBox
    """
    text = report_text(message, trace)
    box = QtWidgets.QMessageBox(QtWidgets.QMessageBox.Warning, "Tool Axis", line_of(message),
                                parent=FreeCADGui.getMainWindow())
    box.setInformativeText(translate("ToolAxis", "The document was not changed. Please report the error with the "
                                                 "copied details and, if you can, the part."))
    box.setDetailedText(text)
    copy = box.addButton(translate("ToolAxis", "Copy details"), QtWidgets.QMessageBox.ActionRole)
    copy.clicked.disconnect()  # copying does not close the box
    copy.clicked.connect(lambda: QtWidgets.QApplication.clipboard().setText(text))
    box.addButton(QtWidgets.QMessageBox.Close)
    box.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    box.setModal(False)
    box.show()
    return box
