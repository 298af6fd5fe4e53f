"""Kernel surfaces as exact rational B-splines over the range that a face uses."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from OCP.Geom import Geom_RectangularTrimmedSurface
from OCP.GeomAbs import GeomAbs_CurveType as CurveKind
from OCP.GeomAbs import GeomAbs_Shape
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind
from OCP.GeomAdaptor import GeomAdaptor_Surface
from OCP.GeomConvert import GeomConvert_ApproxSurface

from toolaxis.cad.arcs import ParameterMap, angle_breaks, arc_knots
from toolaxis.cad.curves import EXACT, Spline, arc, extruded, frame, from_adaptor, line, point_row, revolved
from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.bspline import surface_derivatives_many_numpy
from toolaxis.numeric.knots import restricted, unrolled

Array = NDArray[np.float64]
Box: TypeAlias = tuple[float, float, float, float]

KINDS = {
    Kind.GeomAbs_Plane: "plane", Kind.GeomAbs_Cylinder: "cylinder", Kind.GeomAbs_Cone: "cone",
    Kind.GeomAbs_Sphere: "sphere", Kind.GeomAbs_Torus: "torus", Kind.GeomAbs_BSplineSurface: "bspline",
    Kind.GeomAbs_BezierSurface: "bspline", Kind.GeomAbs_SurfaceOfRevolution: "revolution",
    Kind.GeomAbs_SurfaceOfExtrusion: "extrusion", Kind.GeomAbs_OffsetSurface: "offset",
}
APPROXIMATION = 1e-6


@dataclass(frozen=True, eq=False)
class PlainSurface:
    """A converted surface as plain arrays.

    Attributes
    ----------
    knots_u, knots_v : (m,) array
    control : (nu, nv, 4) array
        Homogeneous control points, mm.
    degree : (int, int)
    kind : str
        The kernel's kind of surface.
    map : ParameterMap
        From the kernel's parameters to ours.
    tolerance : float
        Bound of the distance to the kernel's surface at the same parameters, mm; 0 where it is exact.
    """

    knots_u: Array
    knots_v: Array
    control: Array
    degree: tuple[int, int]
    kind: str
    map: ParameterMap = field(default_factory=ParameterMap)
    tolerance: float = 0.0


def kind_of(surface: Any) -> str:
    """The kernel's kind of surface, in our words."""
    return KINDS.get(GeomAdaptor_Surface(surface).GetType(), "other")


def convert(surface: Any, box: Box) -> PlainSurface:
    """A kernel surface as a rational B-spline that covers a parameter box.

    Parameters
    ----------
    surface : Geom_Surface
    box : (u0, u1, v0, v1)
        In the kernel's parameters.  Elementary and swept surfaces come cut to it, B-splines whole; periodic
        B-splines are unrolled over it.

    Raises
    ------
    UnsupportedGeometry
        When the kernel cannot approximate a surface that has no exact form here.
    """
    adaptor = GeomAdaptor_Surface(surface)
    kind = adaptor.GetType()
    if kind == Kind.GeomAbs_Plane:
        return _plane(adaptor.Plane().Position(), box)
    if kind in _MERIDIANS:
        return _elementary(adaptor, kind, box)
    if kind == Kind.GeomAbs_BSplineSurface:
        return _bspline(adaptor.BSpline(), box)
    if kind == Kind.GeomAbs_BezierSurface:
        return _bezier(adaptor.Bezier())
    if kind == Kind.GeomAbs_SurfaceOfRevolution:
        profile = from_adaptor(adaptor.BasisCurve(), box[2], box[3])
        return _revolution(adaptor.AxeOfRevolution(), profile, box) if profile else _approximation(surface, box)
    if kind == Kind.GeomAbs_SurfaceOfExtrusion:
        profile = from_adaptor(adaptor.BasisCurve(), box[0], box[1])
        return _extrusion(profile, point_row(adaptor.Direction()), box) if profile else _approximation(surface, box)
    return _approximation(surface, box)


def map_of(surface: Any, box: Box) -> ParameterMap:
    """The parameter map that `convert` will find, without converting.

    Parameters
    ----------
    surface : Geom_Surface
    box : (u0, u1, v0, v1)
        In the kernel's parameters.
    """
    adaptor = GeomAdaptor_Surface(surface)
    kind = adaptor.GetType()
    arcs = (CurveKind.GeomAbs_Circle, CurveKind.GeomAbs_Ellipse)
    swept = kind in (Kind.GeomAbs_SurfaceOfRevolution, Kind.GeomAbs_SurfaceOfExtrusion)
    profile = adaptor.BasisCurve().GetType() if swept else None
    if profile is not None and profile not in EXACT:
        return ParameterMap()
    turned = kind in _MERIDIANS or kind == Kind.GeomAbs_SurfaceOfRevolution
    round_u = turned or (profile in arcs and not turned)
    round_v = kind in (Kind.GeomAbs_Sphere, Kind.GeomAbs_Torus) or (profile in arcs and turned)
    return ParameterMap(angle_breaks(box[0], box[1]) if round_u else None,
                        angle_breaks(box[2], box[3]) if round_v else None)


def _plane(position: Any, box: Box) -> PlainSurface:
    placed, (u0, u1, v0, v1) = frame(position), box
    corners = np.array([[[u, v, 0.0, 1.0] for v in (v0, v1)] for u in (u0, u1)])
    return PlainSurface(np.array([u0, u0, u1, u1]), np.array([v0, v0, v1, v1]), corners @ placed.T, (1, 1), "plane")


def _cylinder(adaptor: Any) -> tuple[Any, Array, Array]:
    shape = adaptor.Cylinder()
    return shape.Position(), np.array([shape.Radius(), 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def _cone(adaptor: Any) -> tuple[Any, Array, Array]:
    shape = adaptor.Cone()
    angle = shape.SemiAngle()
    return shape.Position(), np.array([shape.RefRadius(), 0.0, 0.0]), np.array([np.sin(angle), 0.0, np.cos(angle)])


def _sphere(adaptor: Any) -> tuple[Any, Array, float]:
    shape = adaptor.Sphere()
    return shape.Position(), np.zeros(3), shape.Radius()


def _torus(adaptor: Any) -> tuple[Any, Array, float]:
    shape = adaptor.Torus()
    return shape.Position(), np.array([shape.MajorRadius(), 0.0, 0.0]), shape.MinorRadius()


_MERIDIANS: dict[Any, Callable[[Any], tuple[Any, Array, Any]]] = {
    Kind.GeomAbs_Cylinder: _cylinder, Kind.GeomAbs_Cone: _cone,
    Kind.GeomAbs_Sphere: _sphere, Kind.GeomAbs_Torus: _torus,
}


def _elementary(adaptor: Any, kind: Any, box: Box) -> PlainSurface:
    """Cylinder, cone, sphere and torus: a meridian in the local x-z plane, turned about z."""
    position, start, course = _MERIDIANS[kind](adaptor)
    if not isinstance(course, float):
        profile = line(start, course, box[2], box[3])
    else:
        upright = np.eye(4)[:, [0, 2, 1, 3]]
        upright[:3, 3] = start
        profile = arc(upright, (course, course), box[2], box[3])
    return _turned(profile, frame(position), box, KINDS[kind])


def _turned(profile: Spline, placed: Array, box: Box, kind: str) -> PlainSurface:
    breaks = angle_breaks(box[0], box[1])
    net = revolved(profile.control, breaks) @ placed.T
    return PlainSurface(arc_knots(breaks), profile.knots, net, (2, profile.degree), kind,
                        ParameterMap(breaks, profile.breaks))


def _revolution(axis: Any, profile: Spline, box: Box) -> PlainSurface:
    z = point_row(axis.Direction())
    x = np.zeros(3)
    x[int(np.argmin(np.abs(z)))] = 1.0
    x -= (x @ z) * z
    x /= np.linalg.norm(x)
    placed = np.eye(4)
    placed[:3] = np.column_stack([x, np.cross(z, x), z, point_row(axis.Location())])
    local = profile.control @ np.linalg.inv(placed).T
    return _turned(profile._replace(control=local), placed, box, "revolution")


def _extrusion(profile: Spline, direction: Array, box: Box) -> PlainSurface:
    net = extruded(profile.control, direction, box[2], box[3])
    knots_v = np.array([box[2], box[2], box[3], box[3]])
    return PlainSurface(profile.knots, knots_v, net, (profile.degree, 1), "extrusion",
                        ParameterMap(profile.breaks, None))


def _net(surface: Any) -> Array:
    nu, nv = surface.NbUPoles(), surface.NbVPoles()
    rational = surface.IsURational() or surface.IsVRational()
    net = np.ones((nu, nv, 4))
    for i in range(nu):
        for j in range(nv):
            net[i, j, :3] = point_row(surface.Pole(i + 1, j + 1))
            if rational:
                net[i, j, 3] = surface.Weight(i + 1, j + 1)
    net[..., :3] *= net[..., 3:]
    return net


def _bspline(surface: Any, box: Box) -> PlainSurface:
    net = _net(surface)
    degree = (int(surface.UDegree()), int(surface.VDegree()))
    knots_u, net = _clamped(list(surface.UKnotSequence()), net, degree[0], surface.IsUPeriodic(), box[:2])
    knots_v, turned = _clamped(list(surface.VKnotSequence()), net.swapaxes(0, 1), degree[1],
                               surface.IsVPeriodic(), box[2:])
    return PlainSurface(knots_u, knots_v, np.ascontiguousarray(turned.swapaxes(0, 1)), degree, "bspline")


def _clamped(sequence: list[float], net: Array, degree: int, periodic: bool,
             need: tuple[float, ...]) -> tuple[Array, Array]:
    """One direction of a net with clamped ends; a periodic one over its own period or what is needed beyond."""
    knots = np.array(sequence)
    low, high = float(knots[degree]), float(knots[-degree - 1])
    if not periodic:
        return restricted(knots, net, degree, low, high)
    if need[0] < low or need[1] > high:
        low, high = need[0], need[1]
    return unrolled(knots, net, degree, low, high)


def _bezier(surface: Any) -> PlainSurface:
    degree = (int(surface.UDegree()), int(surface.VDegree()))
    return PlainSurface(np.repeat([0.0, 1.0], degree[0] + 1), np.repeat([0.0, 1.0], degree[1] + 1), _net(surface),
                        degree, "bspline")


def _approximation(surface: Any, box: Box) -> PlainSurface:
    """What has no exact form: the kernel's approximation, which keeps the parameters, and its measured error."""
    piece = Geom_RectangularTrimmedSurface(surface, *box)
    grid = ((u, v) for u in np.linspace(*box[:2], 5) for v in np.linspace(*box[2:], 5))
    corners = np.array([point_row(piece.Value(u, v)) for u, v in grid])
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    smooth = GeomAbs_Shape.GeomAbs_C2
    fit = GeomConvert_ApproxSurface(piece, max(APPROXIMATION * size, 1e-7), smooth, smooth, 9, 9, 200, 1)
    kind = kind_of(surface)
    if not fit.HasResult():
        raise UnsupportedGeometry(f"a surface of kind {kind} could not be approximated by a B-spline: "
                                  "convert it to B-splines in the CAD system")
    plain = _bspline(fit.Surface(), box)
    return PlainSurface(plain.knots_u, plain.knots_v, plain.control, plain.degree, kind, ParameterMap(),
                        _measured(piece, plain, box, float(fit.MaxError())))


def _measured(surface: Any, plain: PlainSurface, box: Box, claimed: float) -> float:
    """A bound of the approximation's error: twice the largest of what the kernel claims and 41 x 41 checks show."""
    u, v = np.linspace(*box[:2], 41), np.linspace(*box[2:], 41)
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    data = plain.knots_u, plain.knots_v, plain.control, plain.degree[0], plain.degree[1], True
    ours = surface_derivatives_many_numpy(data, uv)[:, 0]
    theirs = np.array([point_row(surface.Value(a, b)) for a, b in uv])
    return 2 * max(claimed, float(np.linalg.norm(ours - theirs, axis=1).max()))
