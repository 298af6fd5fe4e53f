"""Icons of our objects in the tree."""

import FreeCADGui
from freecad.toolaxis.paths import RESOURCES


def icon(name):
    """An icon of ours as FreeCAD itself draws it: Qt alone cannot read SVG everywhere.

    Parameters
    ----------
    name : str
        Of the file in resources/icons.
    """
    path = str(RESOURCES / "icons" / name)
    return FreeCADGui.getIcon(path) or path
