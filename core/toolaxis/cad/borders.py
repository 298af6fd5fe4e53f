"""Edges that faces share in the kernel's topology, as points and as parameters of both faces."""

from typing import Any, TypeAlias

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
from toolaxis.shape.matching import Side

Array = NDArray[np.float64]

_User: TypeAlias = tuple[FaceRecord, Any, Any]

FINENESS = 1e-4


def borders_of(faces: TopTools_IndexedMapOfShape, records: list[FaceRecord]) -> tuple[list[Border], list[Side]]:
    """Every edge that two faces share, or that one face has twice (a seam); and the sides that only one face has.

    Parameters
    ----------
    faces : indexed map of TopoDS_Face
    records : list of FaceRecord
        Faces to look at; their numbers are indices of the map.
    """
    edges = TopTools_IndexedMapOfShape()
    users: dict[int, list[_User]] = {}
    for record in records:
        face = TopoDS.Face_s(faces.FindKey(record.number).Oriented(TopAbs_Orientation.TopAbs_FORWARD))
        for wire in children(face, TopAbs_WIRE):
            for edge in edges_of(TopoDS.Wire_s(wire), face):
                if not BRep_Tool.Degenerated_s(edge):
                    users.setdefault(edges.Add(edge), []).append((record, face, edge))
    borders, free = [], []
    for sharing in users.values():
        if len(sharing) == 1:
            free.append(_side(sharing[0]))
        for k, one in enumerate(sharing):
            borders += [_border(one, other) for other in sharing[k + 1:]]
    return borders, free


def _side(user: _User) -> Side:
    record, _, edge = user
    share, points = _polyline(edge)
    return Side(record.number, points, _parameters(user, share), _forward(edge) ^ record.turned)


def _border(one: _User, other: _User) -> Border:
    record, _, edge = one
    share, points = _polyline(edge)
    first, second = (_parameters(user, share) for user in (one, other))
    lefts = [_forward(user[2]) ^ user[0].turned for user in (one, other)]
    return Border((record.number, other[0].number), points, first, second, lefts[0], lefts[1])


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


def _parameters(user: _User, share: Array) -> Array:
    record, face, edge = user
    return record.map.to_ours(ParameterCurve(edge, face).points(share if _forward(edge) else 1 - share))


def _forward(edge: Any) -> bool:
    return bool(edge.Orientation() != TopAbs_Orientation.TopAbs_REVERSED)
