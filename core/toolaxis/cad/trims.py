"""Trim loops: the kernel's parameter curves of a face as closed polygons in our parameters."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_Shape
from OCP.GeomAdaptor import GeomAdaptor_Surface
from OCP.gp import gp_Pnt, gp_Vec
from OCP.ShapeFix import ShapeFix_Edge
from OCP.TopAbs import TopAbs_EDGE, TopAbs_Orientation, TopAbs_WIRE
from OCP.TopoDS import TopoDS, TopoDS_Iterator

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.polygons import signed_area

Array = NDArray[np.float64]

MOST_ROUNDS = 14
STRAIGHT = 1e-10


@dataclass
class Loops:
    """Loops of one face in the kernel's parameters, and what was wrong with them.

    Attributes
    ----------
    polygons : list of (m, 2) arrays
        Outer loop first and anticlockwise, holes clockwise; no repeated end point.
    reversed : bool
        The wires ran the other way round in the file.
    warnings : list of str
    """

    polygons: list[Array]
    reversed: bool = False
    warnings: list[str] = field(default_factory=list)


class ParameterCurve:
    """The parameter curve of an edge on a face, traversed as its wire does."""

    def __init__(self, edge: Any, face: Any) -> None:
        if BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 1.0) is None:
            ShapeFix_Edge().FixAddPCurve(edge, face, bool(BRep_Tool.IsClosed_s(edge, face)), 1e-6)
        if BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 1.0) is None:
            raise UnsupportedGeometry("an edge has no curve in the parameters of its face: repair the part in the "
                                      "CAD system")
        self.curve = BRepAdaptor_Curve2d(edge, face)
        ends = self.curve.FirstParameter(), self.curve.LastParameter()
        self.first, self.last = ends[::-1] if edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else ends

    @property
    def straight(self) -> bool:
        """Whether it is a line in the kernel's parameters."""
        return bool(self.curve.GetType() == GeomAbs_CurveType.GeomAbs_Line)

    def points(self, share: Array) -> Array:
        """(u, v) at shares of the way from its start (0) to its end (1), (n, 2)."""
        values = (self.curve.Value(t) for t in self.first + (self.last - self.first) * share)
        return np.array([[p.X(), p.Y()] for p in values]).reshape(-1, 2)

    def coarse(self) -> Array:
        """Shares that show every span of the curve."""
        spans = 1 if self.straight else max(1, self.curve.NbIntervals(GeomAbs_Shape.GeomAbs_C2))
        return np.linspace(0.0, 1.0, 5 if self.straight else 1 + 4 * min(spans, 250))


def edges_of(wire: Any, face: Any) -> list[Any]:
    """Edges of a wire in the order in which they are run through; internal ones left out."""
    explorer = BRepTools_WireExplorer(wire, face)
    walked = []
    while explorer.More():
        walked.append(explorer.Current())
        explorer.Next()
    outside = (TopAbs_Orientation.TopAbs_FORWARD, TopAbs_Orientation.TopAbs_REVERSED)
    listed = [TopoDS.Edge_s(e) for e in children(wire, TopAbs_EDGE) if e.Orientation() in outside]
    return walked if len(walked) == len(listed) else listed


def children(shape: Any, kind: Any) -> Iterator[Any]:
    """Direct sub-shapes of one kind, with their orientation in the shape."""
    iterator = TopoDS_Iterator(shape)
    while iterator.More():
        if iterator.Value().ShapeType() == kind:
            yield iterator.Value()
        iterator.Next()


def wires_of(face: Any) -> list[list[ParameterCurve]]:
    """Parameter curves of every wire of a face that is oriented forward."""
    wires = (edges_of(TopoDS.Wire_s(w), face) for w in children(face, TopAbs_WIRE))
    return [[ParameterCurve(edge, face) for edge in wire] for wire in wires if wire]


def coarse_box(wires: list[list[ParameterCurve]]) -> tuple[float, float, float, float]:
    """Parameter box of all curves, from a coarse look."""
    points = np.concatenate([curve.points(curve.coarse()) for wire in wires for curve in wire])
    (u0, v0), (u1, v1) = points.min(axis=0), points.max(axis=0)
    return float(u0), float(u1), float(v0), float(v1)


def metric(surface: Any) -> Callable[[Array], Array]:
    """Su and Sv of a kernel surface at rows of its parameters, (n, 2, 3)."""
    adaptor = GeomAdaptor_Surface(surface)

    def derivatives(uv: Array) -> Array:
        table = np.empty((len(uv), 2, 3))
        p, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        for k, (u, v) in enumerate(uv):
            adaptor.D1(u, v, p, du, dv)
            table[k] = (du.X(), du.Y(), du.Z()), (dv.X(), dv.Y(), dv.Z())
        return table

    return derivatives


def discretised(curve: ParameterCurve, to_ours: Callable[[Array], Array], derivatives: Callable[[Array], Array],
                tolerance: float) -> Array:
    """The kernel's parameters along a curve, dense enough for chords in our parameters.

    Parameters
    ----------
    curve : ParameterCurve
    to_ours : callable
        Maps (n, 2) parameters of the kernel to ours.
    derivatives : callable
        From `metric`.
    tolerance : float
        Greatest distance of the curve from its chords, measured on the surface, mm.
    """
    share = curve.coarse()
    points = curve.points(share)
    if _is_straight(to_ours(points)):
        return points[[0, -1]]
    for _ in range(MOST_ROUNDS):
        middle = 0.5 * (share[1:] + share[:-1])
        between = curve.points(middle)
        ours = to_ours(points)
        off = to_ours(between) - 0.5 * (ours[1:] + ours[:-1])
        coarse = np.linalg.norm(np.einsum("nk,nkc->nc", off, derivatives(between)), axis=1) > 0.9 * tolerance
        if not coarse.any():
            break
        at = np.flatnonzero(coarse) + 1
        share, points = np.insert(share, at, middle[coarse]), np.insert(points, at, between[coarse], axis=0)
    return points


def _is_straight(points: Array) -> bool:
    chord = points[-1] - points[0]
    length = float(np.hypot(*chord))
    if length == 0.0:
        return bool(np.ptp(points, axis=0).max() == 0.0)
    off = points - points[0]
    across = np.abs(off[:, 0] * chord[1] - off[:, 1] * chord[0]) / length
    along = off @ chord / length
    return bool(across.max() <= STRAIGHT * length and along.min() >= -STRAIGHT * length
                and along.max() <= length * (1 + STRAIGHT))


def chained(pieces: list[Array], periods: tuple[float, float], warnings: list[str]) -> Array:
    """Join pieces into one closed polygon, moving pieces by whole periods where that closes a gap.

    Parameters
    ----------
    pieces : list of (m, 2) arrays
        In order of travel, ends included.
    periods : (float, float)
        Periods in u and v, 0 where there is none.
    warnings : list of str
        Receives what does not close.

    Returns
    -------
    (n, 2) array
        Without repeated points.
    """
    loop = [pieces[0]]
    for piece in pieces[1:]:
        loop.append(piece + _turns(loop[-1][-1] - piece[0], periods))
    whole = np.concatenate(loop)
    if np.abs(_turns(whole[-1] - whole[0], periods)).max() > 0:
        raise UnsupportedGeometry("a trim loop runs round the whole surface without a seam: "
                                  "export the part with seam edges")
    keep = np.abs(whole - np.roll(whole, 1, axis=0)).max(axis=1) > STRAIGHT * max(np.ptp(whole, axis=0).max(), 1e-300)
    return whole[keep]


def _turns(gap: Array, periods: tuple[float, float]) -> Array:
    return np.array([p * np.round(g / p) if p > 0 else 0.0 for g, p in zip(gap, periods, strict=True)])


def arranged(polygons: list[Array], periods: tuple[float, float], warnings: list[str]) -> Loops:
    """Sort loops: the outer one first and anticlockwise, holes clockwise and inside its range.

    Parameters
    ----------
    polygons : list of (m, 2) arrays
    periods : (float, float)
    warnings : list of str
    """
    areas = [signed_area(p) if len(p) > 2 else 0.0 for p in polygons]
    order = sorted(range(len(polygons)), key=lambda k: -abs(areas[k]))
    if not order or areas[order[0]] == 0.0:
        raise UnsupportedGeometry("its trim loops enclose no area: repair the face in the CAD system")
    outer = polygons[order[0]]
    box = np.ptp(outer, axis=0)
    result = [outer if areas[order[0]] > 0 else outer[::-1]]
    for k in order[1:]:
        if abs(areas[k]) <= 1e-14 * box[0] * box[1]:
            warnings.append("a trim loop without area was left out")
            continue
        hole = polygons[k] if areas[k] < 0 else polygons[k][::-1]
        middle = 0.5 * (hole.min(axis=0) + hole.max(axis=0))
        low, high = outer.min(axis=0), outer.max(axis=0)
        away = np.where((middle < low) | (middle > high), 0.5 * (low + high) - middle, 0.0)
        result.append(hole + _turns(away, periods))
    return Loops(result, areas[order[0]] < 0, warnings)
