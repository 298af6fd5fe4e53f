"""Dialogs that say or ask one thing, and wait."""

import FreeCADGui
from PySide import QtWidgets


def warn(text):
    """Say something in a dialog that waits for OK.

    Parameters
    ----------
    text : str
    """
    text = text if text.endswith(".") else f"{text}."
    QtWidgets.QMessageBox.information(FreeCADGui.getMainWindow(), "Tool Axis", text)


def confirmed(text):
    """Ask something in a dialog; whether the answer is yes.

    Parameters
    ----------
    text : str
    """
    box = QtWidgets.QMessageBox
    return box.question(FreeCADGui.getMainWindow(), "Tool Axis", text, box.Yes | box.No, box.No) == box.Yes
