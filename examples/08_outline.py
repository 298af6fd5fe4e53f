"""A sloping freeform face with an irregular outline: the look-alike of the trimmed surface of [zhu2016] Fig. 21.

No border runs along an iso-parametric line: seven straight walls with rounded corners, one of them a hollow.
The face slopes by some 36 degrees, so that its axis leans about as much as the paper's (-0.535, 0.475, 0.699).
"""

import numpy as np
from block import block, write
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet2d
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

X, Y = np.meshgrid(np.linspace(-65, 65, 6), np.linspace(-55, 55, 6), indexing="ij")
POINTS = np.stack([X, Y, np.round(90 + 0.58 * X - 0.46 * Y + 9 * np.sin(X / 26 + 0.4) * np.cos(Y / 30)
                                  + 4 * np.cos(Y / 19 - X / 60), 1)], -1)

#: Corners of the outline, counter-clockwise, and the radius of each.
CORNERS = ((-52, -20), (-24, -45), (10, -32), (44, -40), (56, 6), (22, 44), (-34, 36))
RADII = (14, 10, 18, 12, 15, 16, 20)

#: Cutter, scallop height in mm, weights of the samples and what [zhu2016] Sec. 6.4 prints for the original.
FACTS = {"look_alike": "zhu2016 Fig. 21", "tool": "torus:16x2", "scallop": 0.02, "weights": [0.334, 0.283, 0.383],
         "published": {"passes": [41], "axes": [[-0.535191, 0.475039, 0.698505]]}}


def outlined():
    """The block within the outline's upright walls."""
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in CORNERS:
        polygon.Add(gp_Pnt(x, y, -10))
    polygon.Close()
    flat = BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face()
    rounding, corners = BRepFilletAPI_MakeFillet2d(flat), BRepTools_WireExplorer(polygon.Wire())
    for radius in RADII:
        rounding.AddFillet(corners.CurrentVertex(), radius)
        corners.Next()
    post = BRepPrimAPI_MakePrism(rounding.Shape(), gp_Vec(0, 0, 200)).Shape()
    shape = BRepAlgoAPI_Common(block(POINTS, (3, 3), 0.0), post).Shape()
    return TopExp_Explorer(shape, TopAbs_SOLID).Current()


if __name__ == "__main__":
    write("outline", outlined(), POINTS, (3, 3), "made for this project", **FACTS)
