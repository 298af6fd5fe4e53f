"""How our objects look in the tree and in the 3D view; imported only where FreeCAD has its window."""

import FreeCADGui
from freecad.toolaxis import RESOURCES


def icon(name):
    """An icon of ours as FreeCAD itself draws it: Qt alone cannot read SVG everywhere.

    Parameters
    ----------
    name : str
        Of the file in resources/icons.
    """
    path = str(RESOURCES / "icons" / name)
    return FreeCADGui.getIcon(path) or path
