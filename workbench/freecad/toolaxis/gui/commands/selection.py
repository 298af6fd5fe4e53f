"""What commands act on."""

import FreeCADGui
from freecad.toolaxis.document.kinds import is_operation, is_plan


def operations(document):
    """The operations of Tool Axis that are selected, in groups too; all of the document where none is.

    Parameters
    ----------
    document : App.Document
    """
    chosen = []
    for thing in FreeCADGui.Selection.getSelection(document.Name):
        chosen += [one for one in (thing, *thing.OutListRecursive, *thing.InListRecursive) if is_operation(one)]
    every = [thing for thing in document.Objects if is_operation(thing)]
    return list(dict.fromkeys(chosen)) or every


def plans(document):
    """Whole plans that are selected, or the only one of a document where nothing of Tool Axis is selected.

    Parameters
    ----------
    document : App.Document
    """
    chosen = FreeCADGui.Selection.getSelection(document.Name)
    if any(is_operation(one) for thing in chosen for one in (thing, *thing.InListRecursive)):
        return []
    found = [thing for thing in chosen if is_plan(thing)]
    return found or [thing for thing in document.Objects if is_plan(thing)][:1]
