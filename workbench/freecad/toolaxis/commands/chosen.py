"""What commands act on, and how they say that there is nothing."""

import FreeCADGui


def operations(document):
    """The operations of Tool Axis that are selected, in groups too; all of the document where none is.

    Parameters
    ----------
    document : App.Document
    """
    from ..objects import is_operation

    chosen = []
    for thing in FreeCADGui.Selection.getSelection(document.Name):
        chosen += [one for one in (thing, *thing.OutListRecursive, *thing.InListRecursive) if is_operation(one)]
    every = [thing for thing in document.Objects if is_operation(thing)]
    return list(dict.fromkeys(chosen)) or every


def warn(text):
    """Say something in a dialog that waits for OK.

    Parameters
    ----------
    text : str
    """
    from PySide import QtWidgets

    QtWidgets.QMessageBox.information(FreeCADGui.getMainWindow(), "Tool Axis", text)
