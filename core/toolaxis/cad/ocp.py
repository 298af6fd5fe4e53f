"""Shapes of the Open CASCADE kernel as plain records: every face once, as an exact rational B-spline with its trims."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.GeomAdaptor import GeomAdaptor_Surface
from OCP.TopAbs import (
    TopAbs_FACE,
    TopAbs_Orientation,
    TopAbs_SHELL,
    TopAbs_SOLID,
    TopAbs_State,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

from toolaxis.cad.borders import borders_of
from toolaxis.cad.records import FaceRecord, ShapeRecord
from toolaxis.cad.surfaces import Box, PlainSurface, convert, map_of
from toolaxis.cad.trims import Loops, arranged, chained, coarse_box, discretised, metric, wires_of
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.shape.part import Body
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]

ENDLESS = 1e50
NATURAL = 1e-7


class EndlessFace(UnsupportedGeometry):
    """A face of endless extent without trim loops: in a file, one that lost them."""


def face_map(shape: Any) -> TopTools_IndexedMapOfShape:
    """The faces of a shape in the kernel's own order, each once; indices begin at 1."""
    faces = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, faces)
    return faces


def shape_record(shape: Any, selected: Sequence[Any] = (), tolerance: Tolerance | None = None) -> ShapeRecord:
    """Everything toolaxis needs of a kernel shape.

    Parameters
    ----------
    shape : TopoDS_Shape
    selected : sequence of TopoDS_Face
        Faces of the shape that the caller picked.
    tolerance : Tolerance, optional
        Its `trim` is the chord tolerance of loops and edges, as a share of the face's diagonal.

    Raises
    ------
    InvalidInput
        When the shape is null or has no faces.
    UnsupportedGeometry
        When not one face can be converted.
    """
    if shape is None or shape.IsNull():
        raise InvalidInput("the CAD shape is empty: nothing was selected or transferred")
    faces = face_map(shape)
    if faces.Extent() == 0:
        raise InvalidInput("the CAD shape has no faces: give a solid, a shell or a face")
    record = ShapeRecord()
    share = (tolerance or Tolerance()).trim
    for number in range(1, faces.Extent() + 1):
        try:
            converted, warnings = face_record(TopoDS.Face_s(faces.FindKey(number)), number, share)
        except EndlessFace as reason:
            record.endless += 1
            record.warnings.append(f"face {number} was left out: {reason}")
        except UnsupportedGeometry as reason:
            record.warnings.append(f"face {number} was left out: {reason}")
        else:
            record.faces.append(converted)
            record.warnings += [f"face {number}: {text}" for text in warnings]
    if not record.faces:
        raise UnsupportedGeometry(f"none of the part's {faces.Extent()} faces can be used; {record.warnings[0]}")
    _add_bodies(record, shape, faces)
    record.borders, record.free = borders_of(faces, record.faces)
    record.selected = tuple(sorted({faces.FindIndex(face) for face in selected} - {0}))
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
    flip = face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    face = TopoDS.Face_s(face.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    surface = BRep_Tool.Surface_s(face)
    if surface is None:
        raise UnsupportedGeometry("it has a mesh but no surface: export the part with exact geometry")
    loops, box = _kernel_loops(face, surface, share)
    plain = convert(surface, box)
    low, high = _domain(plain)
    polygons = tuple(_kept_inside(plain.map.to_ours(polygon), low, high) for polygon in loops.polygons)
    if _covers_domain(polygons, low, high):
        polygons = ()
    record = FaceRecord(number, plain.knots_u, plain.knots_v, plain.control, plain.degree, polygons, flip,
                        loops.reversed, plain.kind, plain.tolerance, plain.map)
    return record, loops.warnings


def _kernel_loops(face: Any, surface: Any, share: float) -> tuple[Loops, Box]:
    """Loops in the kernel's parameters and the box they need."""
    wires = wires_of(face)
    adaptor = GeomAdaptor_Surface(surface)
    if not wires:
        box = (adaptor.FirstUParameter(), adaptor.LastUParameter(), adaptor.FirstVParameter(), adaptor.LastVParameter())
        if max(abs(value) for value in box) > ENDLESS:
            raise EndlessFace("it has no borders and no end: trim the face in the CAD system")
        u0, u1, v0, v1 = box
        return Loops([np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])]), box
    box = coarse_box(wires)
    if not (box[0] < box[1] and box[2] < box[3]):
        raise UnsupportedGeometry("its trim loops enclose no area: repair the face in the CAD system")
    to_ours = map_of(surface, box).to_ours
    size = _size(adaptor, box)
    derivatives = metric(surface)
    periods = (adaptor.UPeriod() if adaptor.IsUPeriodic() else 0.0, adaptor.VPeriod() if adaptor.IsVPeriodic() else 0.0)
    warnings: list[str] = []
    polygons = [chained([discretised(curve, to_ours, derivatives, share * size) for curve in wire], periods, warnings)
                for wire in wires]
    loops = arranged(polygons, periods, warnings)
    low, high = loops.polygons[0].min(axis=0), loops.polygons[0].max(axis=0)
    return loops, (float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def _size(adaptor: Any, box: Box) -> float:
    """Diagonal of the box around 7 x 7 points of the surface, mm."""
    points = [adaptor.Value(u, v) for u in np.linspace(*box[:2], 7) for v in np.linspace(*box[2:], 7)]
    return float(np.linalg.norm(np.ptp([[p.X(), p.Y(), p.Z()] for p in points], axis=0)))


def _domain(plain: PlainSurface) -> tuple[Array, Array]:
    pu, pv = plain.degree
    low = np.array([plain.knots_u[pu], plain.knots_v[pv]])
    return low, np.array([plain.knots_u[-pu - 1], plain.knots_v[-pv - 1]])


def _kept_inside(loop: Array, low: Array, high: Array) -> Array:
    """A loop that strays over the end of its surface, as inaccurate files have it, brought back to the end."""
    if (loop >= low).all() and (loop <= high).all():
        return loop
    inside = np.clip(loop, low, high)
    return np.asarray(inside[(inside != np.roll(inside, 1, axis=0)).any(axis=1)])


def _covers_domain(polygons: tuple[Array, ...], low: Array, high: Array) -> bool:
    """Whether a single loop is just the rectangle of the surface's domain."""
    if len(polygons) != 1 or len(polygons[0]) < 4:
        return False
    place = (polygons[0] - low) / (high - low)
    on_border = (np.minimum(np.abs(place), np.abs(place - 1)) <= NATURAL).any(axis=1)
    corners = (np.minimum(np.abs(place), np.abs(place - 1)) <= NATURAL).all(axis=1)
    return bool(on_border.all() and len(np.unique(np.round(place[corners]), axis=0)) == 4
                and np.ptp(place, axis=0).max() <= 1 + 2 * NATURAL)


def _explored(shape: Any, kind: Any, avoid: Any = None) -> list[Any]:
    explorer = TopExp_Explorer(shape, kind) if avoid is None else TopExp_Explorer(shape, kind, avoid)
    found = []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def _add_bodies(record: ShapeRecord, shape: Any, faces: TopTools_IndexedMapOfShape) -> None:
    """Solids, then shells outside solids, then loose faces; solids that are inside out are turned over."""
    usable = {face.number for face in record.faces}

    def numbers(items: list[Any]) -> tuple[int, ...]:
        return tuple(n for n in dict.fromkeys(faces.FindIndex(face) for face in items) if n in usable)

    for solid in _explored(shape, TopAbs_SOLID):
        own = numbers(_explored(solid, TopAbs_FACE))
        record.bodies.append(Body("solid", own, True))
        if _inside_out(solid):
            record.warnings.append(f"the solid with face {own[0]} is inside out: its faces were turned over")
            record.faces = [replace(face, flip=not face.flip) if face.number in own else face for face in record.faces]
    for shell in _explored(shape, TopAbs_SHELL, TopAbs_SOLID):
        own = numbers(_explored(shell, TopAbs_FACE))
        closed = bool(BRep_Tool.IsClosed_s(shell))
        record.bodies.append(Body("shell", own, closed))
        if not closed and own:
            which = f"faces {own[0]} to {own[-1]} form" if len(own) > 1 else f"face {own[0]} forms"
            record.warnings.append(f"{which} an open shell: which side the material is on was taken from the file")
    loose = numbers(_explored(shape, TopAbs_FACE, TopAbs_SHELL))
    if loose:
        record.bodies.append(Body("faces", loose, False))


def _inside_out(solid: Any) -> bool:
    classifier = BRepClass3d_SolidClassifier(TopoDS.Solid_s(solid))
    classifier.PerformInfinitePoint(1e-6)
    return bool(classifier.State() == TopAbs_State.TopAbs_IN)
