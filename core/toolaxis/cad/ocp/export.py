"""Kernel shapes out: polylines as edges, sub-surfaces as trimmed faces, the frame of a work coordinate system."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepLib import BRepLib
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.Geom2dAPI import Geom2dAPI_Interpolate
from OCP.GeomAbs import GeomAbs_Shape
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Pnt2d, gp_Trsf
from OCP.ShapeFix import ShapeFix_Shape
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Edge, TopoDS_Face, TopoDS_Vertex, TopoDS_Wire

from toolaxis.cad.ocp.kernel_names import (
    IntegerArray,
    Point2dArray,
    PointArray,
    PointGrid,
    RealArray,
    RealGrid,
    SharedPoint2dArray,
    SharedRealArray,
    as_face,
)
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.machine.work_coordinates import WorkCoordinates
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: How far borders of sub-surfaces may be from the exact ones, and their chords from the surface, mm.
BORDER = 1e-3
#: Distance at which points are one, mm.
_ONE = 1e-7
#: rad: a border is broken into edges where it turns by more.
_CORNER = 0.2
#: Chords of one stretch of a border at most.
_MOST_CHORDS = 64


def polyline_edge(points: ArrayLike) -> Any:
    """A polyline as one edge: a B-spline curve of degree one, which is the polyline itself.

    Parameters
    ----------
    points : (n, 3) array_like
        mm; points that repeat the one before are left out.

    Returns
    -------
    TopoDS_Edge

    Raises
    ------
    InvalidInput
        When it has no length.
    """
    rows = np.asarray(points, dtype=float).reshape(-1, 3)
    apart = np.linalg.norm(np.diff(rows, axis=0), axis=1) > _ONE
    rows = rows[np.concatenate([[True], apart])]
    if len(rows) < 2:
        raise InvalidInput(f"a polyline of {len(np.asarray(points))} points has no length: two different points are "
                           "needed")
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))])
    return BRepBuilderAPI_MakeEdge(_curve(rows, way)).Edge()


def path_edges(path: ToolPath, *kinds: Motion, frame: WorkCoordinates | None = None) -> list[Any]:
    """Uninterrupted motions of a tool path as edges, in the order in which they are made.

    Cuts are drawn where the tool touches, all else at its tip.

    Parameters
    ----------
    path : ToolPath
    *kinds : Motion
        Which motions; cuts unless given.
    frame : WorkCoordinates, optional
        The coordinates; the part's unless given.

    Returns
    -------
    list of TopoDS_Edge
    """
    rows = path.cc if frame is None else frame.from_part(path.cc)
    wanted = np.isin(path.kind, kinds or (Motion.CUT,))
    one_before = np.concatenate([[False], wanted[:-1]])
    one_after = np.concatenate([wanted[1:], [False]])
    starts = np.flatnonzero(wanted & ~one_before)
    ends = np.flatnonzero(wanted & ~one_after)
    edges = []
    for start, end in zip(starts, ends, strict=True):
        line = rows[max(start - 1, 0):end + 1]  # a motion begins at the point before
        if np.ptp(line, axis=0).max() > 2 * _ONE:
            edges.append(polyline_edge(line))
    return edges


def compound_of(shapes: Sequence[Any]) -> Any:
    """Several kernel shapes as one, a TopoDS_Compound.

    Parameters
    ----------
    shapes : sequence of TopoDS_Shape
    """
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def frame_axes(frame: WorkCoordinates) -> Any:
    """The axes of a work coordinate system, gp_Ax3.

    Parameters
    ----------
    frame : WorkCoordinates
    """
    return gp_Ax3(gp_Pnt(*map(float, frame.origin)), gp_Dir(*map(float, frame.z)), gp_Dir(*map(float, frame.x)))


def frame_location(frame: WorkCoordinates) -> Any:
    """Where a work coordinate system stands on the part, TopLoc_Location.

    Parameters
    ----------
    frame : WorkCoordinates
    """
    turn = gp_Trsf()
    turn.SetTransformation(frame_axes(frame), gp_Ax3())
    return TopLoc_Location(turn)


def face_shape(face: Face) -> Any:
    """A face or sub-surface as a kernel face: the exact surface, cut out along its loops.

    Parameters
    ----------
    face : Face

    Returns
    -------
    TopoDS_Face
        Its normal points out of the material.  Stretches of its border along iso-parametric lines are exact, others are
        within `BORDER` of the loops' chords.
    """
    surface = bspline_surface(face)
    if not face.trims:
        made = BRepBuilderAPI_MakeFace(surface, 1e-6).Face()
        return as_face(made.Reversed()) if face.flip else made
    builder, made = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(made, surface, TopLoc_Location(), 1e-6)
    for loop in face.trims:
        builder.Add(made, _wire(face, surface, loop))
    fixed = ShapeFix_Shape(made)
    fixed.Perform()
    whole = fixed.Shape()
    return whole.Reversed() if face.flip else whole


def bspline_surface(face: Face) -> Any:
    """The surface of a face, Geom_BSplineSurface.

    Parameters
    ----------
    face : Face
    """
    surface = face.surface
    nu, nv = surface.control.shape[:2]
    poles, weights = PointGrid(1, nu, 1, nv), RealGrid(1, nu, 1, nv)
    for i, j in np.ndindex(nu, nv):
        x, y, z, w = (float(value) for value in surface.control[i, j])
        poles.SetValue(i + 1, j + 1, gp_Pnt(x / w, y / w, z / w))
        weights.SetValue(i + 1, j + 1, w)
    (ku, mu), (kv, mv) = (_knots(*np.unique(k, return_counts=True)) for k in (surface.knots_u, surface.knots_v))
    return Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, *surface.degree, False, False)


def _knots(values: Array, counts: NDArray[np.int64]) -> tuple[Any, Any]:
    knots, multiplicities = RealArray(1, len(values)), IntegerArray(1, len(values))
    for k, (value, count) in enumerate(zip(values, counts, strict=True), 1):
        knots.SetValue(k, float(value))
        multiplicities.SetValue(k, int(count))
    return knots, multiplicities


def _polyline_knots(way: Array) -> tuple[Any, Any]:
    counts = np.ones(len(way), dtype=np.int64)
    counts[[0, -1]] = 2
    return _knots(way, counts)


def _curve(rows: Array, way: Array) -> Any:
    poles = PointArray(1, len(rows))
    for k, row in enumerate(rows, 1):
        poles.SetValue(k, gp_Pnt(*map(float, row)))
    return Geom_BSplineCurve(poles, *_polyline_knots(way), 1)


def _flat_curve(rows: Array, way: Array) -> Any:
    poles = Point2dArray(1, len(rows))
    for k, row in enumerate(rows, 1):
        poles.SetValue(k, gp_Pnt2d(*map(float, row)))
    return Geom2d_BSplineCurve(poles, *_polyline_knots(way), 1)


def _wire(face: Face, surface: Any, loop: Array) -> Any:
    """A closed loop in the parameters as a wire with curves in space and in the parameters."""
    builder, wire = BRep_Builder(), TopoDS_Wire()
    builder.MakeWire(wire)
    runs = _runs(face, loop)
    points = face.evaluate(np.array([run[0] for run in runs])).point
    corners = [_vertex(builder, point) for point in points]
    for k, run in enumerate(runs):
        edge = _edge(face, surface, run, (corners[k], corners[(k + 1) % len(runs)]))
        builder.Add(wire, edge)
    wire.Closed(True)
    return wire


def _vertex(builder: Any, point: Array) -> Any:
    vertex = TopoDS_Vertex()
    builder.MakeVertex(vertex, gp_Pnt(*map(float, point)), BORDER)
    return vertex


def _runs(face: Face, loop: Array) -> list[Array]:
    """A loop as smooth stretches between its corners, (m, 2) each, ends included; iso-parametric lines stand alone."""
    d = face.evaluate(loop)
    scale = np.maximum([np.linalg.norm(rows, axis=1).mean() for rows in (d.su, d.sv)], 1e-12)
    rows = loop[simplify_loop(np.hstack([d.point, loop * scale]), 0.25 * BORDER)]
    ahead = np.roll(rows, -1, axis=0) - rows
    iso = (np.abs(ahead) <= 1e-12 * np.maximum(np.abs(rows), 1.0)).any(axis=1)
    scaled_u, scaled_v = (ahead * scale).T
    size = np.hypot(scaled_u, scaled_v)
    heading = np.arctan2(scaled_u, scaled_v)
    turn = np.abs((heading - np.roll(heading, 1) + np.pi) % (2 * np.pi) - np.pi)
    bulge = turn * np.maximum(size, np.roll(size, 1)) / 8  # height over the chord of an arc that turns so much
    corner = (turn > _CORNER) | (bulge > BORDER) | iso | np.roll(iso, 1)
    if corner.sum() < 2:
        corner[[0, len(rows) // 2]] = True
    starts = np.flatnonzero(corner)
    ends = np.append(starts[1:], starts[0] + len(rows))
    return [rows[np.arange(a, b + 1) % len(rows)] for a, b in zip(starts, ends, strict=True)]


def _edge(face: Face, surface: Any, run: Array, ends: tuple[Any, Any]) -> Any:
    """One stretch of a border as an edge between two vertices, in its direction."""
    same = np.abs(np.diff(run, axis=0)).max(axis=0) <= 1e-12 * np.maximum(np.abs(run).max(axis=0), 1.0)
    if len(run) == 2 and same.any():
        return _iso_edge(face, surface, run, int(np.flatnonzero(same)[0]), ends)
    flat, end = _smooth(face, run)
    edge = _between(None, flat, surface, (0.0, end), ends)
    BRepLib.BuildCurve3d_s(edge, 0.5 * BORDER, GeomAbs_Shape.GeomAbs_C1, 8, 200)
    return edge


def _chord_lengths(rows: Array, scale: Array) -> Array:
    """Lengths of the chords between parameters (n, 2), (n - 1,) mm."""
    return np.asarray(np.linalg.norm(np.diff(rows, axis=0) * scale, axis=1))


def _divide_chords(run: Array, size: Array) -> Array:
    """The points of a stretch, with more on chords that are much longer than a neighbour."""
    counts = np.ones(1, dtype=int)
    if len(run) > 2:
        before = np.insert(size[:-1], 0, np.inf)
        after = np.append(size[1:], np.inf)
        shorter = np.minimum(after, before)
        counts = np.clip(np.ceil(size / (2 * shorter)).astype(int), 1, _MOST_CHORDS)
    pieces = []
    for start, end, count in zip(run[:-1], run[1:], counts, strict=True):
        share = np.arange(count)[:, None] / count
        pieces.append(start + share * (end - start))
    return np.vstack([*pieces, run[-1:]])


def _smooth(face: Face, run: Array) -> tuple[Any, float]:
    """A curve in the parameters through the points of a stretch, from 0 to its length in mm, and that length."""
    d = face.evaluate(run)
    scale = np.maximum([np.linalg.norm(rows, axis=1).mean() for rows in (d.su, d.sv)], 1e-12)
    rows = _divide_chords(run, _chord_lengths(run, scale))
    way = np.concatenate([[0.0], np.cumsum(_chord_lengths(rows, scale))])
    if len(rows) == 2:
        return _flat_curve(rows, way), float(way[-1])
    points, places = SharedPoint2dArray(1, len(rows)), SharedRealArray(1, len(rows))
    for k, (row, at) in enumerate(zip(rows, way, strict=True), 1):
        points.SetValue(k, gp_Pnt2d(*map(float, row)))
        places.SetValue(k, float(at))
    made = Geom2dAPI_Interpolate(points, places, False, 1e-12)
    made.Perform()
    return made.Curve(), float(way[-1])


def _iso_edge(face: Face, surface: Any, run: Array, fixed: int, ends: tuple[Any, Any]) -> Any:
    """An edge along an exact iso-parametric line; a degenerate one at a pole."""
    start, end = float(run[0, 1 - fixed]), float(run[1, 1 - fixed])
    line = face.evaluate(run[0] + np.linspace(0.0, 1.0, 9)[:, None] * (run[1] - run[0])).point
    ahead = end > start
    flat = _flat_curve(run if ahead else run[::-1], np.array([min(start, end), max(start, end)]))
    curve = surface.UIso(float(run[0, 0])) if fixed == 0 else surface.VIso(float(run[0, 1]))
    pole = bool(np.ptp(line, axis=0).max() < _ONE)
    edge = _between(None if pole else curve, flat, surface, (min(start, end), max(start, end)),
                    ends if ahead else ends[::-1])
    if pole:
        BRep_Builder().Degenerated(edge, True)
    return edge if ahead else edge.Reversed()


def _between(curve: Any, flat: Any, surface: Any, span: tuple[float, float], ends: tuple[Any, Any]) -> Any:
    """An edge between two vertices, with a curve in the parameters and, if there is one, in space."""
    builder, edge = BRep_Builder(), TopoDS_Edge()
    if curve is None:
        builder.MakeEdge(edge)
    else:
        builder.MakeEdge(edge, curve, _ONE)
    builder.UpdateEdge(edge, flat, surface, TopLoc_Location(), BORDER)
    builder.Add(edge, ends[0].Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    builder.Add(edge, ends[1].Oriented(TopAbs_Orientation.TopAbs_REVERSED))
    builder.Range(edge, *span)
    return edge
