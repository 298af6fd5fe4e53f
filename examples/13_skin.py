"""A smooth skin of six patches on a block, 120 x 80 mm, each with parameters of its own, and a hole where four meet.

The patches are cut from one bicubic surface, so what they come to when joined is known exactly.
"""

from itertools import pairwise

import numpy as np
from block import surface, write
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeSolid,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
)
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

from toolaxis.cad.ocp.kernel_names import RealArray, as_shell, as_solid

X, Y = np.meshgrid(np.linspace(-60, 60, 7), np.linspace(-40, 40, 6), indexing="ij")
POINTS = np.stack([X, Y, np.round(30 + 5 * np.sin(X / 26 + 0.3) + 4 * np.cos(Y / 22 - X / 80), 1)], -1)

#: Lines along which the surface is cut; the hole: x, y, radius.
LINES = (0.0, 0.25, 0.6, 1.0), (0.0, 0.5, 1.0)
HOLE = (12.0, 0.0, 7.0)


def patch(i, j):
    """A patch with parameters of its own: stretched, some with u and v exchanged, reversed, or of a higher degree."""
    piece = surface(POINTS, (3, 3))
    piece.Segment(*LINES[0][i:i + 2], *LINES[1][j:j + 2])
    knots = RealArray(1, piece.NbUKnots())
    for k in range(1, piece.NbUKnots() + 1):
        knots.SetValue(k, (1 + i) * (piece.UKnot(k) - LINES[0][i]))
    piece.SetUKnots(knots)
    if i == 1:
        piece.UReverse()
        piece.VReverse()
    if (i, j) == (2, 1):
        piece.IncreaseDegree(4, 3)
    if j == 1 and i < 2:
        piece.ExchangeUV()
        piece.VReverse()
    return piece


def wall(curve):
    """An upright plane face from z = 0 to a border of the skin, and its two lower corners."""
    a, b = curve.StartPoint(), curve.EndPoint()
    low_a, low_b = (gp_Pnt(p.X(), p.Y(), 0.0) for p in (a, b))
    edges = [BRepBuilderAPI_MakeEdge(curve).Edge(), *(BRepBuilderAPI_MakeEdge(p, q).Edge()
                                                      for p, q in ((b, low_b), (low_b, low_a), (low_a, a)))]
    return BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(*edges).Wire(), True).Face(), (low_a, low_b)


def skin():
    """The solid: six patches, walls, a foot, less the hole."""
    whole, sewing = surface(POINTS, (3, 3)), BRepBuilderAPI_Sewing(1e-6)
    for i in range(3):
        for j in range(2):
            sewing.Add(BRepBuilderAPI_MakeFace(patch(i, j), 1e-7).Face())
    curves = []
    for iso, lines, ends in ((whole.VIso, LINES[0], LINES[1]), (whole.UIso, LINES[1], LINES[0])):
        for end in (ends[0], ends[-1]):
            for low, high in pairwise(lines):
                curve = iso(end)
                curve.Segment(low, high)
                curves.append(curve)
    corners = set()
    for curve in curves:
        face, ends = wall(curve)
        sewing.Add(face)
        corners |= {(round(p.X(), 9), round(p.Y(), 9)) for p in ends}
    foot = BRepBuilderAPI_MakePolygon()
    for x, y in sorted(corners, key=lambda c: np.arctan2(c[1] / 40, c[0] / 60)):
        foot.Add(gp_Pnt(x, y, 0.0))
    foot.Close()
    sewing.Add(BRepBuilderAPI_MakeFace(foot.Wire(), True).Face())
    sewing.Perform()
    solid = BRepBuilderAPI_MakeSolid(as_shell(sewing.SewedShape())).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    x, y, radius = HOLE
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, -5), gp_Dir(0, 0, 1)), radius, 60).Shape()
    return as_solid(TopExp_Explorer(BRepAlgoAPI_Cut(solid, drill).Shape(), TopAbs_SOLID).Current())


if __name__ == "__main__":
    write("skin", skin(), POINTS, (3, 3), "made for this project", lines=LINES, hole=HOLE, tool="torus:12x1",
          scallop=0.02)
