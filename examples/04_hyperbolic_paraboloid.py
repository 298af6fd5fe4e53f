"""The hyperbolic paraboloid z = (y^2 - x^2)/500 over 100 x 100 mm, twice: as published, and along its rules.

[grandguillaume2021], Appendix B: a Bezier patch of degree (2, 2).  There it is the locus of the ball's centre.
The second face is the same surface as a bilinear patch, u along the rules y = x + c and v across them, trimmed back to
the square.
"""

import numpy as np
from block import face, surface, write
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.Geom2d import Geom2d_Line, Geom2d_TrimmedCurve
from OCP.gp import gp_Dir2d, gp_Pnt2d
from OCP.ShapeFix import ShapeFix_Face

POINTS = np.array([[[-50, -50, 0], [-50, 0, -10], [-50, 50, 0]],
                   [[0, -50, 10], [0, 0, 0], [0, 50, 10]],
                   [[50, -50, 0], [50, 0, -10], [50, 50, 0]]], dtype=float)
RULES = np.array([[[0, -100, 20], [-100, 0, -20]], [[100, 0, -20], [0, 100, 20]]], dtype=float)
SQUARE = np.array([[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]])


def trimmed_to_square():
    """The bilinear patch with the square's border as straight lines in its parameters."""
    patch = surface(RULES, (1, 1))
    wire = BRepBuilderAPI_MakeWire()
    for a, b in zip(SQUARE, np.roll(SQUARE, -1, axis=0), strict=True):
        line = Geom2d_Line(gp_Pnt2d(*map(float, a)), gp_Dir2d(*map(float, b - a)))
        segment = Geom2d_TrimmedCurve(line, 0.0, float(np.linalg.norm(b - a)))
        wire.Add(BRepBuilderAPI_MakeEdge(segment, patch).Edge())
    result = BRepBuilderAPI_MakeFace(patch, wire.Wire(), True).Face()
    BRepLib.BuildCurves3d_s(result)
    fixed = ShapeFix_Face(result)
    fixed.Perform()
    return fixed.Face()


if __name__ == "__main__":
    source = "grandguillaume2021, Appendix B"
    write("hyperbolic_paraboloid", face(POINTS, (2, 2)), POINTS, (2, 2), source)
    write("hyperbolic_paraboloid_rules", trimmed_to_square(), RULES, (1, 1), f"{source}, along its rules")
