"""The 3D view of a document, and tools as nodes of its scene."""

import FreeCADGui
import numpy as np
from pivy import coin

COLOURS = {"cutter": (0.80, 0.80, 0.82), "shank": (0.62, 0.64, 0.68), "holder": (0.35, 0.45, 0.60)}
_CLEAR = {"cutter": 0.0, "shank": 0.15, "holder": 0.35}
_AROUND = 48


def view_of(name):
    """The 3D view of a document; None where it has none.

    Parameters
    ----------
    name : str
        Of the document.
    """
    try:
        document = FreeCADGui.getDocument(name)
    except NameError:  # it is just being closed
        document = None
    view = document.ActiveView if document is not None else None
    if hasattr(view, "getSceneGraph"):
        return view
    found = document.mdiViewsOfType("Gui::View3DInventor") if document is not None else []
    return found[0] if found else None


def solids(tool):
    """Closed outlines of cutter, shank and holder, (name, (k, 2) array of radius and z from the tip).

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    """
    from toolaxis.report.figures.splat_renderer import tool_outlines

    return [(name.split(" ")[0], line) for name, line in tool_outlines(tool, 6 * tool.radius).items()]


def colour_node(colour, clear=0.0, lit=True):
    """A separator with a material.

    Parameters
    ----------
    colour : (float, float, float)
    clear : float
        Transparency.
    lit : bool
        Whether light falls on it.
    """
    node = coin.SoSeparator()
    model = coin.SoLightModel()
    model.model = coin.SoLightModel.PHONG if lit else coin.SoLightModel.BASE_COLOR
    material = coin.SoMaterial()
    material.diffuseColor.setValue(*colour)
    material.specularColor.setValue(0.3, 0.3, 0.3)
    material.shininess.setValue(0.4)
    material.transparency.setValue(clear)
    node.addChild(model)
    node.addChild(material)
    return node


def unpickable_node():
    """A separator for what cannot be picked in the view."""
    node = coin.SoSeparator()
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    node.addChild(style)
    return node


def revolve(name, outline):
    """A part of a tool as a solid of revolution about z.

    Parameters
    ----------
    name : str
        "cutter", "shank" or "holder".
    outline : (k, 2) array
        Radius and z, mm.
    """
    node = colour_node(COLOURS.get(name, COLOURS["shank"]), _CLEAR.get(name, 0.3))
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = 0.5
    turn = np.linspace(0, 2 * np.pi, _AROUND + 1)
    radius, z = np.asarray(outline, dtype=float).T
    rows = np.stack([radius[:, None] * np.cos(turn), radius[:, None] * np.sin(turn),
                     np.broadcast_to(z[:, None], (len(z), len(turn)))], axis=-1)
    points = coin.SoCoordinate3()
    points.point.setValues(0, rows.size // 3, rows.reshape(-1, 3).tolist())
    mesh = coin.SoQuadMesh()
    mesh.verticesPerRow = len(turn)
    mesh.verticesPerColumn = len(outline)
    for child in (hints, points, mesh):
        node.addChild(child)
    return node
