"""Shapes of the Open CASCADE kernel as plain records: every face once, as an exact rational B-spline with its trims."""

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_Shape
from OCP.ShapeFix import ShapeFix_Edge
from OCP.Standard import Standard_Failure
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_Orientation,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_State,
    TopAbs_WIRE,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS_Iterator

from toolaxis.cad.faces import record_of_face, record_of_shape
from toolaxis.cad.kernel_protocol import KernelBody
from toolaxis.cad.ocp.geometry import OcpSurface
from toolaxis.cad.ocp.kernel_names import ShapeMap, as_edge, as_face, as_solid, as_wire
from toolaxis.cad.shape_data import FaceRecord, ShapeRecord
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]


def face_map(shape: Any) -> ShapeMap:
    """The faces of a shape in the kernel's own order, each once; indices begin at 1."""
    faces = ShapeMap()
    TopExp.MapShapes_s(shape, TopAbs_FACE, faces)
    return faces


def shape_record(shape: Any, selected: Sequence[Any] = (), tolerance: Tolerance | None = None,
                 numbers: Sequence[int] = ()) -> ShapeRecord:
    """Everything toolaxis needs of a kernel shape.

    Parameters
    ----------
    shape : TopoDS_Shape
    selected : sequence of TopoDS_Face
        Faces of the shape that the caller picked.
    tolerance : Tolerance, optional
        Its `trim` is the chord tolerance of loops and edges, as a share of the face's diagonal.
    numbers : sequence of int
        Of the faces in the kernel's order; from 1 unless given.

    Raises
    ------
    InvalidInput
        When the shape is null or has no faces.
    UnsupportedGeometry
        When not one face can be converted.
    """
    if shape is None or shape.IsNull():
        raise InvalidInput("the CAD shape is empty: nothing was selected or transferred")
    faces, edges = face_map(shape), ShapeMap()
    readers = [OcpFace(as_face(faces.FindKey(index + 1)), edges) for index in range(faces.Extent())]
    record = record_of_shape(readers, list(_bodies(shape, faces)), tolerance, numbers, (Standard_Failure,))
    picked = {faces.FindIndex(face) for face in selected} - {0}
    record.selected = tuple(sorted(numbers[index - 1] if numbers else index for index in picked))
    return record


def face_record(face: Any, number: int = 1, share: float = 1e-5) -> tuple[FaceRecord, list[str]]:
    """One kernel face as plain arrays, and warnings.

    Parameters
    ----------
    face : TopoDS_Face
    number : int
    share : float
        Chord tolerance of the loops as a share of the face's diagonal.

    Raises
    ------
    UnsupportedGeometry
        When the face has no surface (it is only tessellated), is endless, or cannot be approximated.
    """
    return record_of_face(OcpFace(face, ShapeMap()), number, share)


class OcpFace:
    """A TopoDS_Face, as `KernelFace` asks; edges get their keys from a map of the whole shape."""

    def __init__(self, face: Any, edges: ShapeMap) -> None:
        self.flip = bool(face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED)
        self.face = as_face(face.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
        self.edges = edges

    @cached_property
    def surface(self) -> OcpSurface | None:
        """None where it has only a mesh."""
        surface = BRep_Tool.Surface_s(self.face)
        return None if surface is None else OcpSurface(surface)

    @cached_property
    def wires(self) -> list[list["OcpEdge"]]:
        """Edges of every wire in the order of travel."""
        walks = (edges_of(as_wire(wire), self.face) for wire in children(self.face, TopAbs_WIRE))
        return [[OcpEdge(edge, self.face, self.edges.Add(edge)) for edge in walk] for walk in walks if walk]


class OcpEdge:
    """A TopoDS_Edge of a face, as `toolaxis.cad.kernel_protocol.KernelEdge` asks."""

    def __init__(self, edge: Any, face: Any, key: int) -> None:
        self.key = key
        self.forward = bool(edge.Orientation() != TopAbs_Orientation.TopAbs_REVERSED)
        self.degenerate = bool(BRep_Tool.Degenerated_s(edge))
        if BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 1.0) is None:
            ShapeFix_Edge().FixAddPCurve(edge, face, bool(BRep_Tool.IsClosed_s(edge, face)), 1e-6)
        if BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 1.0) is None:
            raise UnsupportedGeometry("an edge has no curve in the parameters of its face: repair the part in the "
                                      "CAD system")
        self.edge = edge
        self.curve = BRepAdaptor_Curve2d(edge, face)
        ends = self.curve.FirstParameter(), self.curve.LastParameter()
        self.first, self.last = ends if self.forward else ends[::-1]

    @property
    def straight(self) -> bool:
        """Whether it is a line in the kernel's parameters."""
        return bool(self.curve.GetType() == GeomAbs_CurveType.GeomAbs_Line)

    @property
    def spans(self) -> int:
        """Smooth pieces in the parameters."""
        return int(self.curve.NbIntervals(GeomAbs_Shape.GeomAbs_C2))

    @cached_property
    def space(self) -> BRepAdaptor_Curve:
        """The curve in space."""
        return BRepAdaptor_Curve(as_edge(self.edge.Oriented(TopAbs_Orientation.TopAbs_FORWARD)))

    @property
    def space_spans(self) -> int:
        """Smooth pieces in space."""
        return int(self.space.NbIntervals(GeomAbs_Shape.GeomAbs_C2))

    def parameters(self, share: Array) -> Array:
        """(u, v) at shares of the way from its start (0) to its end (1), (n, 2)."""
        values = (self.curve.Value(t) for t in self.first + (self.last - self.first) * share)
        return np.array([[p.X(), p.Y()] for p in values]).reshape(-1, 2)

    def points(self, share: Array) -> Array:
        """Points at shares of the edge's own range, (n, 3)."""
        start, length = self.space.FirstParameter(), self.space.LastParameter() - self.space.FirstParameter()
        values = (self.space.Value(start + length * s) for s in share)
        return np.array([[p.X(), p.Y(), p.Z()] for p in values]).reshape(-1, 3)


def edges_of(wire: Any, face: Any) -> list[Any]:
    """Edges of a wire in the order in which they are run through; internal ones left out."""
    explorer = BRepTools_WireExplorer(wire, face)
    walked = []
    while explorer.More():
        walked.append(explorer.Current())
        explorer.Next()
    outside = (TopAbs_Orientation.TopAbs_FORWARD, TopAbs_Orientation.TopAbs_REVERSED)
    listed = [as_edge(e) for e in children(wire, TopAbs_EDGE) if e.Orientation() in outside]
    return walked if len(walked) == len(listed) else listed


def children(shape: Any, kind: Any) -> Iterator[Any]:
    """Direct sub-shapes of one kind, with their orientation in the shape."""
    iterator = TopoDS_Iterator(shape)
    while iterator.More():
        if iterator.Value().ShapeType() == kind:
            yield iterator.Value()
        iterator.Next()


def _explore_shape(shape: Any, kind: Any, avoid: Any = None) -> list[Any]:
    explorer = TopExp_Explorer(shape, kind) if avoid is None else TopExp_Explorer(shape, kind, avoid)
    found = []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def _bodies(shape: Any, faces: ShapeMap) -> Iterator[KernelBody]:
    """Solids, then shells outside solids, then loose faces."""
    def numbers(item: Any, *avoid: Any) -> tuple[int, ...]:
        return tuple(dict.fromkeys(faces.FindIndex(face) for face in _explore_shape(item, TopAbs_FACE, *avoid)))

    for solid in _explore_shape(shape, TopAbs_SOLID):
        yield KernelBody("solid", numbers(solid), True, _inside_out(solid))
    for shell in _explore_shape(shape, TopAbs_SHELL, TopAbs_SOLID):
        yield KernelBody("shell", numbers(shell), bool(BRep_Tool.IsClosed_s(shell)))
    yield KernelBody("faces", numbers(shape, TopAbs_SHELL), False)


def _inside_out(solid: Any) -> bool:
    classifier = BRepClass3d_SolidClassifier(as_solid(solid))
    classifier.PerformInfinitePoint(1e-6)
    return bool(classifier.State() == TopAbs_State.TopAbs_IN)
