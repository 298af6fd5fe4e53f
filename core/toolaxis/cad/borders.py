"""Edges that faces share in the kernel's topology, as points and as parameters of both faces."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_Shape
from OCP.TopAbs import TopAbs_Orientation, TopAbs_WIRE
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

from toolaxis.cad.records import FaceRecord
from toolaxis.cad.trims import ParameterCurve, children, edges_of
from toolaxis.shape.adjacency import Border

Array = NDArray[np.float64]

FINENESS = 1e-4


def shared_borders(faces: TopTools_IndexedMapOfShape, records: list[FaceRecord]) -> list[Border]:
    """Every edge that two faces share, or that one face has twice (a seam).

    Parameters
    ----------
    faces : indexed map of TopoDS_Face
    records : list of FaceRecord
        Faces to look at; their numbers are indices of the map.
    """
    edges = TopTools_IndexedMapOfShape()
    users: dict[int, list[tuple[FaceRecord, Any, Any]]] = {}
    for record in records:
        face = TopoDS.Face_s(faces.FindKey(record.number).Oriented(TopAbs_Orientation.TopAbs_FORWARD))
        for wire in children(face, TopAbs_WIRE):
            for edge in edges_of(TopoDS.Wire_s(wire), face):
                if not BRep_Tool.Degenerated_s(edge):
                    users.setdefault(edges.Add(edge), []).append((record, face, edge))
    borders = []
    for sharing in users.values():
        for k, one in enumerate(sharing):
            borders += [_border(one, other) for other in sharing[k + 1:]]
    return borders


def _border(one: tuple[FaceRecord, Any, Any], other: tuple[FaceRecord, Any, Any]) -> Border:
    record, _, edge = one
    forward = edge.Orientation() != TopAbs_Orientation.TopAbs_REVERSED
    share, points = _polyline(edge)
    first, second = (_parameters(user, share) for user in (one, other))
    return Border((record.number, other[0].number), points, first, second, forward ^ record.turned)


def _polyline(edge: Any) -> tuple[Array, Array]:
    """Shares of the edge's own range, and points dense enough for its shape."""
    curve = BRepAdaptor_Curve(TopoDS.Edge_s(edge.Oriented(TopAbs_Orientation.TopAbs_FORWARD)))
    start, length = curve.FirstParameter(), curve.LastParameter() - curve.FirstParameter()

    def at(share: Array) -> Array:
        points = (curve.Value(start + length * s) for s in share)
        return np.array([[p.X(), p.Y(), p.Z()] for p in points]).reshape(-1, 3)

    spans = max(1, min(curve.NbIntervals(GeomAbs_Shape.GeomAbs_C2), 100))
    share = np.linspace(0.0, 1.0, 1 + 4 * spans)
    points = at(share)
    limit = FINENESS * np.linalg.norm(np.ptp(points, axis=0))
    for _ in range(8):
        middle = 0.5 * (share[1:] + share[:-1])
        between = at(middle)
        coarse = np.linalg.norm(between - 0.5 * (points[1:] + points[:-1]), axis=1) > limit
        if not coarse.any():
            break
        places = np.flatnonzero(coarse) + 1
        share, points = np.insert(share, places, middle[coarse]), np.insert(points, places, between[coarse], axis=0)
    return share, points


def _parameters(user: tuple[FaceRecord, Any, Any], share: Array) -> Array:
    record, face, edge = user
    reverse = edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    return record.map.to_ours(ParameterCurve(edge, face).points(1 - share if reverse else share))
