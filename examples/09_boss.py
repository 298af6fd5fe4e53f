"""A gentle freeform face with one boss, 110 x 100 mm: look-alike of [zhu2016] Fig. 23.

The original takes four sub-surfaces.  The boss is a round post, 24 mm across and some 25 mm high,
without a fillet at its foot.
"""

import numpy as np
from block import block, write
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

X, Y = np.meshgrid(np.linspace(-55, 55, 6), np.linspace(-50, 50, 6), indexing="ij")
POINTS = np.stack([X, Y, np.round(40 + 7 * np.sin(X / 27 - 0.3) - 5 * np.cos(Y / 22 + X / 80) - 0.08 * Y, 1)], -1)

#: Centre, radius and top of the boss, mm.
BOSS = (3.0, -2.0, 12.0, 62.0)

#: Cutter, scallop height in mm, weights of the samples and what [zhu2016] Table 5 prints for the original.
FACTS = {"look_alike": "zhu2016 Fig. 23", "tool": "torus:10x1", "scallop": 0.02, "weights": [0.6, 0.2, 0.2],
         "published": {"passes": [19, 24, 22, 17],
                       "axes": [[0.144147, 0.405891, 0.902482], [-0.018188, 0.258719, 0.965782],
                                [-0.028162, -0.093619, 0.99521], [0.222612, 0.064526, 0.972769]]}}


def bossed():
    """The block and the post as one solid."""
    x, y, radius, top = BOSS
    post = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, 10), gp_Dir(0, 0, 1)), radius, top - 10).Shape()
    return TopExp_Explorer(BRepAlgoAPI_Fuse(block(POINTS, (3, 3), 0.0), post).Shape(), TopAbs_SOLID).Current()


if __name__ == "__main__":
    write("boss", bossed(), POINTS, (3, 3), "made for this project", **FACTS)
