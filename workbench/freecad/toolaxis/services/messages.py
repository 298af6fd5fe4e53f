"""Sentences of the program in the language of the window; what is kept in documents and plans stays English."""

import FreeCAD
from PySide import QtCore


def language():
    """The language of FreeCAD's window by its English name in small letters; "english" without a window."""
    if not FreeCAD.GuiUp:
        return "english"
    import FreeCADGui

    return FreeCADGui.getLocale().lower()


def shown(text):
    """A sentence as the user reads it, with the decimal point of the window's other numbers.

    Parameters
    ----------
    text : str
        English.
    """
    from toolaxis.messages.translate import translate

    return translate(text, language(), QtCore.QLocale().decimalPoint())


def line_of(text):
    """A sentence, as the user reads it, as the beginning of a line.

    Parameters
    ----------
    text : str
        English.
    """
    text = shown(text)
    return text[:1].upper() + text[1:]


def lines_of(reasons):
    """Sentences, as the user reads them, one in a line and each with a stop.

    Parameters
    ----------
    reasons : iterable of str
        English.
    """
    return "\n".join(f"{line_of(text)}." for text in reasons)


def stale_text(thing):
    """What to say above the results of a stale operation or plan: what has changed, and what mends it.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return FreeCAD.Qt.translate("ToolAxis", "Out of date: {}. Recompute").format(list_of(thing.StaleReasons))


def list_of(reasons):
    """Sentences, as the user reads them, in one line.

    Parameters
    ----------
    reasons : iterable of str
        English.
    """
    return "; ".join(map(shown, reasons))
