"""Curves and surfaces of the Open CASCADE kernel, as the forms that toolaxis reads."""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.Geom import Geom_RectangularTrimmedSurface
from OCP.GeomAbs import GeomAbs_CurveType as CurveKind
from OCP.GeomAbs import GeomAbs_Shape
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind
from OCP.GeomAdaptor import GeomAdaptor_Surface
from OCP.GeomConvert import GeomConvert_ApproxSurface
from OCP.gp import gp_Pnt, gp_Vec

from toolaxis.cad.curves import Spline, arc, bezier, bspline, homogeneous, line, parabola
from toolaxis.cad.kernel_protocol import (
    Box,
    CurveForm,
    ExtrusionForm,
    Form,
    MeridianForm,
    PlaneForm,
    RevolutionForm,
    SplineForm,
)

Array = NDArray[np.float64]

KINDS = {
    Kind.GeomAbs_Plane: "plane", Kind.GeomAbs_Cylinder: "cylinder", Kind.GeomAbs_Cone: "cone",
    Kind.GeomAbs_Sphere: "sphere", Kind.GeomAbs_Torus: "torus", Kind.GeomAbs_BSplineSurface: "bspline",
    Kind.GeomAbs_BezierSurface: "bspline", Kind.GeomAbs_SurfaceOfRevolution: "revolution",
    Kind.GeomAbs_SurfaceOfExtrusion: "extrusion", Kind.GeomAbs_OffsetSurface: "offset",
}


def point_row(p: Any) -> Array:
    """x, y, z of a kernel point, vector or direction, (3,)."""
    return np.array([p.X(), p.Y(), p.Z()])


def frame(position: Any) -> Array:
    """World from local, (4, 4), of a kernel placement; left-handed placements stay so."""
    matrix = np.eye(4)
    matrix[:3, 0] = point_row(position.XDirection())
    matrix[:3, 1] = point_row(position.YDirection())
    matrix[:3, 2] = point_row(position.Direction())
    matrix[:3, 3] = point_row(position.Location())
    return matrix


class OcpSurface:
    """A Geom_Surface of the kernel, as `toolaxis.cad.kernel_protocol.KernelSurface` asks."""

    def __init__(self, surface: Any) -> None:
        self.surface = surface
        self.adaptor = GeomAdaptor_Surface(surface)
        self.kind = KINDS.get(self.adaptor.GetType(), "other")

    @property
    def domain(self) -> Box:
        """Natural borders."""
        a = self.adaptor
        return a.FirstUParameter(), a.LastUParameter(), a.FirstVParameter(), a.LastVParameter()

    @property
    def periods(self) -> tuple[float, float]:
        """In u and v, 0 where there is none."""
        a = self.adaptor
        return a.UPeriod() if a.IsUPeriodic() else 0.0, a.VPeriod() if a.IsVPeriodic() else 0.0

    @cached_property
    def form(self) -> Form | None:
        """The exact form; None where there is none of ours."""
        reader = _READERS.get(self.adaptor.GetType())
        return reader(self.adaptor) if reader else None

    def points(self, uv: Array) -> Array:
        """Points, (n, 3)."""
        return np.array([point_row(self.adaptor.Value(u, v)) for u, v in uv]).reshape(-1, 3)

    def tangents(self, uv: Array) -> Array:
        """Su and Sv, (n, 2, 3)."""
        table = np.empty((len(uv), 2, 3))
        p, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        for k, (u, v) in enumerate(uv):
            self.adaptor.D1(u, v, p, du, dv)
            table[k] = (du.X(), du.Y(), du.Z()), (dv.X(), dv.Y(), dv.Z())
        return table

    def approximation(self, box: Box, tolerance: float) -> tuple[SplineForm, float] | None:
        """The kernel's B-spline over a box and the error it claims."""
        smooth = GeomAbs_Shape.GeomAbs_C2
        piece = Geom_RectangularTrimmedSurface(self.surface, *box)
        fit = GeomConvert_ApproxSurface(piece, tolerance, smooth, smooth, 9, 9, 200, 1)
        return (_spline(fit.Surface()), float(fit.MaxError())) if fit.HasResult() else None


def _cylinder(adaptor: Any) -> Form:
    shape = adaptor.Cylinder()
    return MeridianForm(frame(shape.Position()), np.array([shape.Radius(), 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))


def _cone(adaptor: Any) -> Form:
    shape = adaptor.Cone()
    angle = shape.SemiAngle()
    return MeridianForm(frame(shape.Position()), np.array([shape.RefRadius(), 0.0, 0.0]),
                        np.array([np.sin(angle), 0.0, np.cos(angle)]))


def _sphere(adaptor: Any) -> Form:
    shape = adaptor.Sphere()
    return MeridianForm(frame(shape.Position()), np.zeros(3), float(shape.Radius()))


def _torus(adaptor: Any) -> Form:
    shape = adaptor.Torus()
    return MeridianForm(frame(shape.Position()), np.array([shape.MajorRadius(), 0.0, 0.0]), float(shape.MinorRadius()))


def _revolution(adaptor: Any) -> Form | None:
    curve, axis = curve_form(adaptor.BasisCurve()), adaptor.AxeOfRevolution()
    return RevolutionForm(point_row(axis.Location()), point_row(axis.Direction()), curve) if curve else None


def _extrusion(adaptor: Any) -> Form | None:
    curve = curve_form(adaptor.BasisCurve())
    return ExtrusionForm(point_row(adaptor.Direction()), curve) if curve else None


def _net(surface: Any) -> Array:
    nu, nv = surface.NbUPoles(), surface.NbVPoles()
    places = [(i + 1, j + 1) for i in range(nu) for j in range(nv)]
    points = np.array([point_row(surface.Pole(i, j)) for i, j in places])
    rational = surface.IsURational() or surface.IsVRational()
    weights = np.array([surface.Weight(i, j) for i, j in places]) if rational else np.ones(len(places))
    return homogeneous(points, weights).reshape(nu, nv, 4)


def _spline(surface: Any) -> SplineForm:
    return SplineForm(np.array(list(surface.UKnotSequence())), np.array(list(surface.VKnotSequence())), _net(surface),
                      (int(surface.UDegree()), int(surface.VDegree())),
                      (bool(surface.IsUPeriodic()), bool(surface.IsVPeriodic())))


def _bezier(surface: Any) -> SplineForm:
    degree = (int(surface.UDegree()), int(surface.VDegree()))
    return SplineForm(np.repeat([0.0, 1.0], degree[0] + 1), np.repeat([0.0, 1.0], degree[1] + 1), _net(surface), degree)


_READERS: dict[Any, Callable[[Any], Form | None]] = {
    Kind.GeomAbs_Plane: lambda adaptor: PlaneForm(frame(adaptor.Plane().Position())),
    Kind.GeomAbs_Cylinder: _cylinder, Kind.GeomAbs_Cone: _cone, Kind.GeomAbs_Sphere: _sphere,
    Kind.GeomAbs_Torus: _torus, Kind.GeomAbs_SurfaceOfRevolution: _revolution,
    Kind.GeomAbs_SurfaceOfExtrusion: _extrusion,
    Kind.GeomAbs_BSplineSurface: lambda adaptor: _spline(adaptor.BSpline()),
    Kind.GeomAbs_BezierSurface: lambda adaptor: _bezier(adaptor.Bezier()),
}


def curve_form(curve: Any) -> CurveForm | None:
    """The exact form of a kernel curve (an Adaptor3d_Curve); None where there is none of our kinds."""
    reader = _CURVES.get(curve.GetType())
    return reader(curve) if reader else None


def _line_form(curve: Any) -> CurveForm:
    axis = curve.Line().Position()
    return CurveForm(False, lambda low, high: line(point_row(axis.Location()), point_row(axis.Direction()), low, high))


def _circle_form(curve: Any) -> CurveForm:
    circle = curve.Circle()
    return CurveForm(True, lambda low, high: arc(frame(circle.Position()), (circle.Radius(),) * 2, low, high))


def _ellipse_form(curve: Any) -> CurveForm:
    shape = curve.Ellipse()
    radii = shape.MajorRadius(), shape.MinorRadius()
    return CurveForm(True, lambda low, high: arc(frame(shape.Position()), radii, low, high))


def _parabola_form(curve: Any) -> CurveForm:
    shape = curve.Parabola()
    return CurveForm(False, lambda low, high: parabola(frame(shape.Position()), shape.Focal(), low, high))


def _control(curve: Any) -> Array:
    indices = range(1, curve.NbPoles() + 1)
    return homogeneous(np.array([point_row(curve.Pole(i)) for i in indices]),
                       np.array([curve.Weight(i) for i in indices]))


def _bspline_form(curve: Any) -> CurveForm:
    spline = curve.BSpline()
    knots, degree, periodic = np.array(list(spline.KnotSequence())), int(spline.Degree()), bool(spline.IsPeriodic())

    def over(low: float, high: float) -> Spline:
        return bspline(knots, _control(spline), degree, periodic, (low, high))

    return CurveForm(False, over)


_CURVES: dict[Any, Callable[[Any], CurveForm]] = {
    CurveKind.GeomAbs_Line: _line_form, CurveKind.GeomAbs_Circle: _circle_form,
    CurveKind.GeomAbs_Ellipse: _ellipse_form, CurveKind.GeomAbs_Parabola: _parabola_form,
    CurveKind.GeomAbs_BSplineCurve: _bspline_form,
    CurveKind.GeomAbs_BezierCurve: lambda curve: CurveForm(False, lambda low, high: bezier(_control(curve.Bezier()))),
}
