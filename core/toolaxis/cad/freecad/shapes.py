"""Shapes of FreeCAD's Part module as plain records."""

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np
import Part
from numpy.typing import NDArray

from toolaxis.cad.faces import record_of_shape
from toolaxis.cad.freecad.geometry import FreecadSurface, rows
from toolaxis.cad.kernel_protocol import KernelBody
from toolaxis.cad.shape_data import ShapeRecord, Transfer
from toolaxis.cad.step.faces import number_faces, warn_of_lost_faces
from toolaxis.cad.step.precheck import StepText
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]

CLOSE = 1e-6
FAR = 10.0
PROJECTED = 65


class Numbering:
    """Numbers from 1 for sub-shapes, the same for the same one in either sense."""

    def __init__(self, shapes: Sequence[Any] = ()) -> None:
        self.count = 0
        self.buckets: dict[int, list[tuple[Any, int]]] = {}
        for shape in shapes:
            self.add(shape)

    def add(self, shape: Any) -> int:
        """The number of a shape, a new one where it is new."""
        known = self.find(shape)
        if known:
            return known
        self.count += 1
        self.buckets.setdefault(shape.hashCode(), []).append((shape, self.count))
        return self.count

    def find(self, shape: Any) -> int:
        """The number of a shape; 0 where it has none."""
        return next((n for other, n in self.buckets.get(shape.hashCode(), ()) if other.isSame(shape)), 0)


def shape_record(shape: Any, selected: Sequence[Any] = (), tolerance: Tolerance | None = None,
                 numbers: Sequence[int] = ()) -> ShapeRecord:
    """Everything toolaxis needs of a shape of the Part module.

    Parameters
    ----------
    shape : Part.Shape
    selected : sequence of Part.Face
        Faces of the shape that the caller picked.
    tolerance : Tolerance, optional
        Its `trim` is the chord tolerance of loops and edges, as a share of the face's diagonal.
    numbers : sequence of int
        Of the faces in FreeCAD's order; from 1 unless given.

    Raises
    ------
    InvalidInput
        When the shape is null or has no faces.
    UnsupportedGeometry
        When not one face can be converted.
    """
    if shape is None or shape.isNull():
        raise InvalidInput("the CAD shape is empty: nothing was selected or computed")
    faces, edges = Numbering(shape.Faces), Numbering()
    readers = [FreecadFace(face, edges) for face in shape.Faces]
    record = record_of_shape(readers, list(_bodies(shape, faces)), tolerance, numbers, (Part.OCCError,))
    picked = {faces.find(face) for face in selected} - {0}
    record.selected = tuple(sorted(numbers[index - 1] if numbers else index for index in picked))
    return record


def step_record(path: Path, text: StepText) -> Transfer:
    """What FreeCAD makes of a STEP file, in mm.

    Parameters
    ----------
    path : Path
        With the text as it was mended.
    text : StepText

    Raises
    ------
    InvalidInput
        When FreeCAD refuses the file or makes nothing of it.
    UnsupportedGeometry
        When not one face can be converted.
    """
    try:
        shape = Part.read(str(path))
    except (Part.OCCError, OSError, RuntimeError) as reason:
        raise InvalidInput("the CAD kernel cannot parse its text: export the part again") from reason
    faces = shape.Faces
    for face in faces:
        face.Placement = FreeCAD.Placement()
    origins = text.order.guessed(len(faces))
    numbers = number_faces(text.order, origins)
    record = shape_record(shape, numbers=numbers.made)
    record.unit = text.unit
    distinct = Numbering()
    return warn_of_lost_faces(record, [distinct.add(face) for face in faces], text.order, numbers, origins)


class FreecadFace:
    """A Part.Face, as `toolaxis.cad.kernel_protocol.KernelFace` asks; edges get their keys from the whole shape."""

    def __init__(self, face: Any, edges: Numbering) -> None:
        self.flip = face.Orientation == "Reversed"
        self.face = face.reversed() if self.flip else face
        self.edges = edges

    @cached_property
    def surface(self) -> FreecadSurface | None:
        """None where it has only a mesh."""
        try:
            return FreecadSurface(self.face.Surface)
        except (TypeError, ReferenceError, RuntimeError):
            return None

    @cached_property
    def wires(self) -> list[list["FreecadEdge"]]:
        """Edges of every wire in the order of travel."""
        walks = (self._walk_wire(wire) for wire in self.face.childShapes() if wire.ShapeType == "Wire")
        return [walk for walk in walks if walk]

    def _walk_wire(self, wire: Any) -> list["FreecadEdge"]:
        listed = [edge for edge in wire.childShapes() if edge.Orientation in ("Forward", "Reversed")]
        twice = [edge.reversed() for edge in listed if edge.isSeam(self.face)]
        ordered = wire.OrderedEdges
        whole = len(ordered) == len(listed) + len(twice)
        edges = [FreecadEdge(edge, self.face, self.edges.add(edge)) for edge in (ordered if whole else listed + twice)]
        periods = self.surface.periods if self.surface else (0.0, 0.0)
        return edges if whole and _closes(edges, periods) else _chain_edges(edges, periods)


class FreecadEdge:
    """A Part.Edge of a face, as `toolaxis.cad.kernel_protocol.KernelEdge` asks."""

    def __init__(self, edge: Any, face: Any, key: int) -> None:
        self.key = key
        self.edge, self.face = edge, face
        self.forward = edge.Orientation != "Reversed"
        self.degenerate = bool(edge.Degenerated)
        found: tuple[Any, float, float] = face.curveOnSurface(edge) or _project_edge(edge, face)
        self.curve, first, last = found
        self.range = first, last
        self.first, self.last = (first, last) if self.forward else (last, first)
        self.straight = type(self.curve).__name__ in ("Line2d", "Line2dSegment")

    @property
    def spans(self) -> int:
        """Smooth pieces in the parameters."""
        return smooth_pieces(self.curve, *self.range)

    @cached_property
    def space(self) -> Any:
        """The curve in space; None where the edge is only a curve on its faces."""
        try:
            return self.edge.Curve
        except (AttributeError, TypeError, RuntimeError):
            return None

    @property
    def space_spans(self) -> int:
        """Smooth pieces in space."""
        return smooth_pieces(self.space, *self.edge.ParameterRange) if self.space else self.spans

    def parameters(self, share: Array) -> Array:
        """(u, v) at shares of the way from its start (0) to its end (1), (n, 2)."""
        values = (self.curve.value(t) for t in (self.first + (self.last - self.first) * share).tolist())
        return np.array([(p.x, p.y) for p in values]).reshape(-1, 2)

    def points(self, share: Array) -> Array:
        """Points at shares of the edge's own range, (n, 3)."""
        if self.space is None:
            places = self.parameters(share if self.forward else 1 - share)
            return rows(self.face.valueAt(u, v) for u, v in places.tolist())
        start, end = self.edge.ParameterRange
        return rows(self.edge.valueAt(t) for t in (start + (end - start) * share).tolist())

    @cached_property
    def ends(self) -> Array:
        """Parameters of its start and its end, (2, 2)."""
        return self.parameters(np.array([0.0, 1.0]))


class ProjectedCurve:
    """The curve of an edge in the parameters of its face, by projection, where the shape has none."""

    def __init__(self, edge: Any, surface: Any, periods: tuple[float, float]) -> None:
        self.edge, self.surface, self.periods = edge, surface, np.array(periods)
        first, last = edge.ParameterRange
        self.times = np.linspace(first, last, PROJECTED)
        self.places = np.array([surface.parameter(edge.valueAt(t)) for t in self.times.tolist()])
        for column, period in enumerate(periods):
            if period > 0:
                self.places[:, column] = np.unwrap(self.places[:, column], period=period)

    def value(self, t: float) -> Any:
        """(u, v) at a parameter of the edge, without jumps over the seam of the surface."""
        place = np.array(self.surface.parameter(self.edge.valueAt(t)))
        near = np.array([np.interp(t, self.times, column) for column in self.places.T])
        turns = np.round((near - place) / np.where(self.periods > 0, self.periods, np.inf))
        return FreeCAD.Base.Vector2d(*(place + turns * self.periods))


def _project_edge(edge: Any, face: Any) -> tuple[ProjectedCurve, float, float]:
    surface = FreecadSurface(face.Surface)
    if edge.Degenerated or edge.isSeam(face):
        raise UnsupportedGeometry("an edge has no curve in the parameters of its face: repair the part in the "
                                  "CAD system")
    return ProjectedCurve(edge, surface.basis, surface.periods), *edge.ParameterRange


def smooth_pieces(curve: Any, low: float, high: float) -> int:
    """How many pieces of a curve are smooth (C2) between two of its parameters.

    Parameters
    ----------
    curve : curve of Part or Part.Geom2d
    low, high : float
    """
    if not type(curve).__name__.startswith("BSplineCurve"):
        return 1
    knots, counts = np.array(curve.getKnots()), np.array(curve.getMultiplicities())
    slack = 1e-9 * (high - low)
    weak = (knots > low + slack) & (knots < high - slack) & (counts > curve.Degree - 2)
    return 1 + int(np.count_nonzero(weak))


def _gap(one: FreecadEdge, other: FreecadEdge, periods: tuple[float, float]) -> float:
    """Distance in the parameters from the end of an edge to the start of another, whole periods aside."""
    away = other.ends[0] - one.ends[1]
    turns = [p * round(a / p) if p > 0 else 0.0 for a, p in zip(away.tolist(), periods, strict=True)]
    return float(np.abs(away - turns).max())


def _closes(edges: list[FreecadEdge], periods: tuple[float, float]) -> bool:
    """Whether each edge begins where the one before ends, for the most part of the wire's own size."""
    places = np.concatenate([edge.ends for edge in edges])
    limit = 1e-3 * max(float(np.ptp(places, axis=0).max()), 1e-12)
    return all(_gap(edges[k - 1], edge, periods) <= limit for k, edge in enumerate(edges))


def _chain_edges(edges: list[FreecadEdge], periods: tuple[float, float]) -> list[FreecadEdge]:
    """The edges in the order in which each begins nearest to where the one before ends."""
    walk, rest = edges[:1], edges[1:]
    while rest:
        nearest = min(range(len(rest)), key=lambda k: _gap(walk[-1], rest[k], periods))
        walk.append(rest.pop(nearest))
    return walk


def _bodies(shape: Any, faces: Numbering) -> Iterator[KernelBody]:
    """Solids, then shells outside solids, then loose faces."""
    shells: list[Any] = []
    loose: list[Any] = []
    _collect(shape, shells, loose)
    for solid in shape.Solids:
        yield KernelBody("solid", _numbers(solid.Faces, faces), True, _inside_out(solid))
    for shell in shells:
        yield KernelBody("shell", _numbers(shell.Faces, faces), bool(shell.isClosed()))
    yield KernelBody("faces", _numbers(loose, faces), False)


def _collect(shape: Any, shells: list[Any], loose: list[Any]) -> None:
    """Shells outside solids, and faces outside shells."""
    if shape.ShapeType == "Shell":
        shells.append(shape)
    elif shape.ShapeType == "Face":
        loose.append(shape)
    elif shape.ShapeType in ("Compound", "CompSolid"):
        for child in shape.childShapes():
            _collect(child, shells, loose)


def _numbers(items: Sequence[Any], faces: Numbering) -> tuple[int, ...]:
    return tuple(dict.fromkeys(faces.find(face) for face in items))


def _inside_out(solid: Any) -> bool:
    """Whether a point far outside its box counts as inside."""
    box = solid.BoundBox
    away = FreeCAD.Vector(1.0, 0.9, 0.8) * (FAR * box.DiagonalLength)
    return bool(solid.isInside(box.Center + away, CLOSE, False))
