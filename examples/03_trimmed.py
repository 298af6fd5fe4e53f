"""A trimmed patch with a hole on a round post: no border runs along an iso-parametric line.

The outline is a circle of radius 36 mm cut off by an oblique plane; a hole of radius 8 mm goes through.
"""

import numpy as np
from block import block, write
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

X, Y = np.meshgrid(np.linspace(-50, 50, 5), np.linspace(-45, 45, 5), indexing="ij")
POINTS = np.stack([X, Y, np.round(40 + 7 * np.sin(X / 30) - 6 * np.cos(Y / 24 + X / 90), 1)], -1)


def outlined():
    """The block, its outline and hole cut by upright walls."""
    up = gp_Dir(0, 0, 1)
    post = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -10), up), 36.0, 100.0).Shape()
    beyond = BRepPrimAPI_MakeBox(gp_Ax2(gp_Pnt(54, -82, -10), up, gp_Dir(0.9, 0.3, 0)), 100.0, 200.0, 100.0).Shape()
    hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-9, 7, -10), up), 8.0, 100.0).Shape()
    shape = BRepAlgoAPI_Common(block(POINTS, (3, 3), 0.0), post).Shape()
    for tool in (beyond, hole):
        shape = BRepAlgoAPI_Cut(shape, tool).Shape()
    return TopExp_Explorer(shape, TopAbs_SOLID).Current()


if __name__ == "__main__":
    write("trimmed", outlined(), POINTS, (3, 3), "made for this project")
