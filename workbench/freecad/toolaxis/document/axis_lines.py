"""The axis that moves, shown along its passes: short lines from the tool's tip, a plain shape that needs no add-on."""

import FreeCAD
from freecad.toolaxis.document.passes import axes_of, moves
from freecad.toolaxis.document.properties import Property, assign, ensure

translate = FreeCAD.Qt.translate

_PROPERTIES = (Property("Integer", "Every", "Tool Axis", "One line for this many points of the cutting moves", True),
               Property("Length", "LineLength", "Tool Axis", "Length of a line", True))
#: Lines at most, and their length as a share of the face's size.
MOST, SHARE = 300, 0.1
COLOUR, _WIDTH = (0.90, 0.55, 0.10), 1.5


def is_lines(thing):
    """Whether an object shows the axis along passes.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return "LineLength" in thing.PropertiesList and "Every" in thing.PropertiesList


def ends_of(tips, axes, cutting, length):
    """Ends of the lines, evenly chosen among the points that cut.

    Parameters
    ----------
    tips, axes : (n, 3) array
    cutting : (n,) array of bool
    length : float
        mm

    Returns
    -------
    (m, 2, 3) array
        Tip and end, `MOST` lines at most.
    every : int
        Which of the points that cut have one.
    """
    import numpy as np

    cuts = np.flatnonzero(cutting)
    every = max(-(-len(cuts) // MOST), 1)
    some = cuts[::every]
    return np.stack([tips[some], tips[some] + length * axes[some]], axis=1), every


def show_axes(operation, passes, size, title):
    """Show the axis of an operation along its passes, or take the lines away where the axis stands still.

    Parameters
    ----------
    operation : App.DocumentObject
    passes : App.DocumentObject
        The Path object with its axes.
    size : float
        Of the face, mm.
    title : str
    """
    import Part

    standing, axes = next(filter(is_lines, operation.Group), None), axes_of(passes)
    if axes is None:
        if standing is not None:
            operation.Document.removeObject(standing.Name)
        return
    if standing is None:
        standing = operation.Document.addObject("Part::Feature", "ToolAxes")
        ensure(standing, _PROPERTIES)
        operation.addObject(standing)
        if FreeCAD.GuiUp:
            assign(standing.ViewObject, LineColor=COLOUR, LineWidth=_WIDTH, PointSize=1.0)
    points, _ = moves(passes)
    rows, every = ends_of(points, axes, [kind == 0 for kind in operation.Motions], SHARE * size)
    standing.Shape = Part.Compound([Part.makeLine(FreeCAD.Vector(*tip), FreeCAD.Vector(*end))
                                    for tip, end in rows.tolist()])
    standing.Label = translate("ToolAxis", "Tool axes {}").format(title)
    assign(standing, Every=every, LineLength=SHARE * size)
    standing.Placement = passes.Placement
    standing.setExpression("Placement", None)
    standing.setExpression("Placement", f"{passes.Name}.Placement")
