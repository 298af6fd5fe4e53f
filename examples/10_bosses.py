"""A freeform face with three bosses, 150 x 110 mm: round, oblong, and drafted with a fillet at its foot.

[zhu2016] Sec. 6.5 names several bosses without an example; cutter and scallop height are its single boss's.
"""

import numpy as np
from block import block, write
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.GC import GC_MakeArcOfCircle, GC_MakeSegment
from OCP.GeomAbs import GeomAbs_BSplineCurve
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopAbs import TopAbs_EDGE, TopAbs_SOLID
from OCP.TopExp import TopExp, TopExp_Explorer

from toolaxis.cad.ocp.kernel_names import ShapeMap, as_edge

X, Y = np.meshgrid(np.linspace(-75, 75, 7), np.linspace(-55, 55, 6), indexing="ij")
POINTS = np.stack([X, Y, np.round(40 + 6 * np.sin(X / 30 + Y / 90) + 5 * np.cos(Y / 24 - 0.4), 1)], -1)

#: Round post: centre, radius, top.  Oblong: centres of its ends, radius, top.  Drafted: centre, radius at
#: z = 10 and at the top, top.
ROUND = ((-44.0, -20.0), 10.0, 66.0)
OBLONG = ((-12.0, 24.0), (10.0, 30.0), 7.0, 64.0)
DRAFTED = ((38.0, -12.0), 16.0, 10.0, 68.0)
FILLET = 4.0

#: Cutter and scallop height in mm.
FACTS = {"look_alike": "zhu2016 Sec. 6.5, three bosses instead of one", "tool": "torus:10x1", "scallop": 0.02,
         "weights": [0.6, 0.2, 0.2]}


def upright(x, y):
    """An upright axis at (x, y) that begins inside the block, seams towards +y."""
    return gp_Ax2(gp_Pnt(x, y, 10), gp_Dir(0, 0, 1), gp_Dir(0, 1, 0))


def oblong():
    """A post between two half-cylinders."""
    (ax, ay), (bx, by), radius, top = OBLONG
    along = np.array([bx - ax, by - ay]) / np.hypot(bx - ax, by - ay)
    side, end = radius * np.array([-along[1], along[0]]), radius * along
    a, b = np.array([ax, ay]), np.array([bx, by])
    corner = [gp_Pnt(*map(float, p), 10) for p in (a - side, b - side, b + end, b + side, a + side, a - end)]
    curves = (GC_MakeSegment(corner[0], corner[1]), GC_MakeArcOfCircle(corner[1], corner[2], corner[3]),
              GC_MakeSegment(corner[3], corner[4]), GC_MakeArcOfCircle(corner[4], corner[5], corner[0]))
    wire = BRepBuilderAPI_MakeWire(*(BRepBuilderAPI_MakeEdge(curve.Value()).Edge() for curve in curves)).Wire()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire, True).Face(), gp_Vec(0, 0, top - 10)).Shape()


def foot(shape, x, y, radius):
    """An edge round a post where it leaves the freeform face."""
    edges = ShapeMap()
    TopExp.MapShapes_s(shape, TopAbs_EDGE, edges)
    for k in range(1, edges.Extent() + 1):
        edge = as_edge(edges.FindKey(k))
        curve = BRepAdaptor_Curve(edge)
        start = curve.Value(curve.FirstParameter())
        if curve.GetType() == GeomAbs_BSplineCurve and np.hypot(start.X() - x, start.Y() - y) < radius:
            return edge
    raise ValueError(f"no post leaves the face around ({x}, {y})")


def bossed():
    """The block and the posts as one solid."""
    (x, y), radius, top = ROUND
    post = BRepPrimAPI_MakeCylinder(upright(x, y), radius, top - 10).Shape()
    shape = BRepAlgoAPI_Fuse(BRepAlgoAPI_Fuse(block(POINTS, (3, 3), 0.0), post).Shape(), oblong()).Shape()
    (x, y), radius, radius_at_top, top = DRAFTED
    post = BRepPrimAPI_MakeCone(upright(x, y), radius, radius_at_top, top - 10).Shape()
    whole = ShapeUpgrade_UnifySameDomain(BRepAlgoAPI_Fuse(shape, post).Shape(), True, False)
    whole.Build()
    fillet = BRepFilletAPI_MakeFillet(whole.Shape())
    fillet.Add(FILLET, foot(whole.Shape(), x, y, radius))
    return TopExp_Explorer(fillet.Shape(), TopAbs_SOLID).Current()


if __name__ == "__main__":
    write("bosses", bossed(), POINTS, (3, 3), "made for this project", **FACTS)
