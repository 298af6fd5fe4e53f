"""Whether a part looks as if its file were of another unit: a document does not keep that, and shows mm or inches."""

from contextlib import suppress

import FreeCAD
from freecad.toolaxis.gui.widgets.quantity import length_text

translate = FreeCAD.Qt.translate


def size_note(things):
    """A sentence on the first part that is too small or too large to be milled; empty without one.

    Parameters
    ----------
    things : sequence of App.DocumentObject
    """
    from toolaxis.cad.freecad.documents import shape_of
    from toolaxis.cad.unit_checks import LARGEST, SMALLEST

    for thing in things:
        size = 0.0
        with suppress(Exception):  # it is refused with the reason when it is computed with
            size = shape_of(thing).BoundBox.DiagonalLength
        if 0.0 < size < SMALLEST:
            told = translate("ToolAxis", "{} is only {} across: check the unit of its file.")
        elif size > LARGEST:
            told = translate("ToolAxis", "{} is {} across: check the unit of its file.")
        else:
            continue
        return told.format(thing.Label, length_text(size, 0, 1 if size < SMALLEST else 0))
    return ""
