"""A turbine blade that stands along x on a platform: a closed face around the blade, as four-axis machines cut it.

Nothing of the blade of [stheta2023] is published; this one is 40 mm high, 60 mm wide and twisted by 20 degrees, its
camber falls from 60 to 40 degrees, and its pressure side is hollow.
"""

import numpy as np
from block import write_facts
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.GeomAPI import GeomAPI_Interpolate
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

from toolaxis.cad.ocp.kernel_names import SharedPointArray

SPAN, CHORD, SECTIONS, POINTS = 40.0, 60.0, 6, 72
CAMBER, TWIST = np.radians((60.0, 40.0)), np.radians(20.0)
THICK, END = (11.0, 7.0), (1.8, 1.3)
PLATFORM = ((-12.0, -36.0, -20.0), (0.0, 36.0, 30.0))

#: Cutter, scallop height in mm, and machine.
FACTS = {"tool": "ball:8", "scallop": 0.05, "machine": "four-axis-a"}


def section(share):
    """Points of the closed section at a share of the span, close together where it bends, (POINTS, 3)."""
    camber, thick, end = (a + (b - a) * share for a, b in (CAMBER, THICK, END))
    t = (1 - np.cos(np.linspace(0, np.pi, 4001))) / 2
    cap = np.clip(1 - CHORD * np.minimum(t, 1 - t) / (1.6 * end), 0, 1)
    half = end * np.sqrt(1 - cap**2.5) + (thick / 2 - end) * (4 * t * (1 - t))**1.3
    radius, angle = CHORD / (2 * np.sin(camber / 2)), camber * (t - 0.5)
    middle = radius * np.column_stack([np.sin(angle), np.cos(angle) - np.cos(camber / 2)])
    normal = np.column_stack([np.sin(angle), np.cos(angle)])
    rows = np.concatenate([(middle + half[:, None] * normal)[::-1], (middle - half[:, None] * normal)[1:]])
    way = np.hypot(*np.diff(rows, axis=0).T)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(*np.diff(rows, axis=0).T[::-1])), append=0.0))
    turn[-1] = turn[0]
    measure = np.concatenate([[0.0], np.cumsum(way / way.sum() + 0.12 * np.minimum(turn, 0.1))])
    at = np.linspace(0, measure[-1], POINTS, endpoint=False)
    y, z = (np.interp(at, measure, column) for column in rows.T)
    c, s = np.cos(TWIST * share), np.sin(TWIST * share)
    return np.column_stack([np.full(POINTS, SPAN * share), c * y - s * z, s * y + c * z])


def wire(points):
    """A closed smooth curve through points."""
    rows = SharedPointArray(1, len(points))
    for k, point in enumerate(points):
        rows.SetValue(k + 1, gp_Pnt(*map(float, point)))
    curve = GeomAPI_Interpolate(rows, True, 1e-9)
    curve.Perform()
    return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve.Curve()).Edge()).Wire()


def blade():
    """The blade with its platform."""
    loft = BRepOffsetAPI_ThruSections(True, False, 1e-7)
    loft.CheckCompatibility(False)
    for share in np.linspace(0, 1, SECTIONS):
        loft.AddWire(wire(section(share)))
    loft.Build()
    box = BRepPrimAPI_MakeBox(gp_Pnt(*PLATFORM[0]), gp_Pnt(*PLATFORM[1])).Solid()
    return TopExp_Explorer(BRepAlgoAPI_Fuse(loft.Shape(), box).Shape(), TopAbs_SOLID).Current()


if __name__ == "__main__":
    write_facts("blade", blade(), "made for this project", **FACTS)
