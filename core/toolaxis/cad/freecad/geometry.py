"""Curves and surfaces of FreeCAD's Part module, as the forms that toolaxis reads."""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import FreeCAD  # noqa: F401  first, because Part alone crashes
import numpy as np
import Part
from numpy.typing import NDArray

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
    "Plane": "plane", "Cylinder": "cylinder", "Cone": "cone", "Sphere": "sphere", "Toroid": "torus",
    "BSplineSurface": "bspline", "BezierSurface": "bspline", "SurfaceOfRevolution": "revolution",
    "SurfaceOfExtrusion": "extrusion", "OffsetSurface": "offset",
}


def rows(vectors: Any) -> Array:
    """x, y, z of several FreeCAD vectors, (n, 3)."""
    return np.array([(p.x, p.y, p.z) for p in vectors]).reshape(-1, 3)


def remove_trim(geometry: Any, basis: str) -> Any:
    """What a trimmed curve or surface was cut from."""
    while hasattr(geometry, basis) and type(geometry).__name__.startswith(("RectangularTrimmed", "TrimmedCurve")):
        geometry = getattr(geometry, basis)
    return geometry


class FreecadSurface:
    """A surface of the Part module, as `toolaxis.cad.kernel_protocol.KernelSurface` asks."""

    def __init__(self, surface: Any) -> None:
        self.surface = surface
        self.basis = remove_trim(surface, "BasisSurface")
        self.name = type(self.basis).__name__
        self.kind = KINDS.get(self.name, "other")

    @property
    def domain(self) -> Box:
        """Natural borders."""
        u0, u1, v0, v1 = self.surface.bounds()
        return u0, u1, v0, v1

    @property
    def periods(self) -> tuple[float, float]:
        """In u and v, 0 where there is none."""
        s = self.basis
        return s.UPeriod() if s.isUPeriodic() else 0.0, s.VPeriod() if s.isVPeriodic() else 0.0

    @cached_property
    def form(self) -> Form | None:
        """The exact form; None where there is none of ours."""
        reader = _READERS.get(self.name)
        return reader(self.basis) if reader else None

    def points(self, uv: Array) -> Array:
        """Points, (n, 3)."""
        return rows(self.basis.value(u, v) for u, v in uv.tolist())

    def tangents(self, uv: Array) -> Array:
        """Su and Sv, (n, 2, 3)."""
        places = uv.tolist()
        return np.stack([rows(self.basis.getDN(u, v, 1, 0) for u, v in places),
                         rows(self.basis.getDN(u, v, 0, 1) for u, v in places)], axis=1)

    def approximation(self, box: Box, tolerance: float) -> tuple[SplineForm, float] | None:
        """The kernel's B-spline over a box; it claims no error, so that only the measured one counts."""
        try:
            fit = Part.RectangularTrimmedSurface(self.basis, *box).toBSpline(tolerance, "C2", "C2", 9, 9, 200, 1)
        except Part.OCCError:
            return None
        return _spline(fit), 0.0


def _frame(surface: Any, x: Array, y: Array, origin: Array) -> Array:
    """World from local, (4, 4), with the third axis that `Axis` gives: left-handed ones stay so."""
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([x, y, rows([surface.Axis])[0], origin])
    return matrix


def _round_frame(surface: Any) -> Array:
    """The frame of a surface turned about its axis: Y and -X are its first two derivatives in u at (0, 0)."""
    first, second = rows([surface.getDN(0.0, 0.0, 1, 0), surface.getDN(0.0, 0.0, 2, 0)])
    return _frame(surface, -second / np.linalg.norm(second), first / np.linalg.norm(first), rows([surface.Center])[0])


def _plane(surface: Any) -> Form:
    origin, x, y = rows([surface.value(0.0, 0.0), surface.getDN(0.0, 0.0, 1, 0), surface.getDN(0.0, 0.0, 0, 1)])
    return PlaneForm(_frame(surface, x, y, origin))


def _cylinder(surface: Any) -> Form:
    return MeridianForm(_round_frame(surface), np.array([surface.Radius, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))


def _cone(surface: Any) -> Form:
    angle = surface.SemiAngle
    return MeridianForm(_round_frame(surface), np.array([surface.Radius, 0.0, 0.0]),
                        np.array([np.sin(angle), 0.0, np.cos(angle)]))


def _sphere(surface: Any) -> Form:
    return MeridianForm(_round_frame(surface), np.zeros(3), float(surface.Radius))


def _torus(surface: Any) -> Form:
    return MeridianForm(_round_frame(surface), np.array([surface.MajorRadius, 0.0, 0.0]), float(surface.MinorRadius))


def _revolution(surface: Any) -> Form | None:
    curve = curve_form(surface.BasisCurve)
    origin, direction = rows([surface.Location, surface.Direction])
    return RevolutionForm(origin, direction, curve) if curve else None


def _extrusion(surface: Any) -> Form | None:
    curve = curve_form(surface.BasisCurve)
    return ExtrusionForm(rows([surface.Direction])[0], curve) if curve else None


def _net(surface: Any) -> Array:
    points = np.array([[(p.x, p.y, p.z) for p in row] for row in surface.getPoles()])
    return homogeneous(points, np.array(surface.getWeights(), dtype=float))


def _spline(surface: Any) -> SplineForm:
    return SplineForm(np.array(surface.UKnotSequence), np.array(surface.VKnotSequence), _net(surface),
                      (int(surface.UDegree), int(surface.VDegree)),
                      (bool(surface.isUPeriodic()), bool(surface.isVPeriodic())))


def _bezier(surface: Any) -> SplineForm:
    degree = (int(surface.UDegree), int(surface.VDegree))
    return SplineForm(np.repeat([0.0, 1.0], degree[0] + 1), np.repeat([0.0, 1.0], degree[1] + 1), _net(surface), degree)


_READERS: dict[str, Callable[[Any], Form | None]] = {
    "Plane": _plane, "Cylinder": _cylinder, "Cone": _cone, "Sphere": _sphere, "Toroid": _torus,
    "SurfaceOfRevolution": _revolution, "SurfaceOfExtrusion": _extrusion, "BSplineSurface": _spline,
    "BezierSurface": _bezier,
}


def curve_form(curve: Any) -> CurveForm | None:
    """The exact form of a curve of the Part module; None where there is none of our kinds."""
    curve = remove_trim(curve, "BasisCurve")
    reader = _CURVES.get(type(curve).__name__)
    return reader(curve) if reader else None


def _line_form(curve: Any) -> CurveForm:
    origin, direction = rows([curve.value(0.0), curve.getDN(0.0, 1)])
    return CurveForm(False, lambda low, high: line(origin, direction, low, high))


def _conic_frame(curve: Any) -> Array:
    """The frame of a circle or an ellipse: Y and -X are its first two derivatives at 0."""
    first, second = rows([curve.getDN(0.0, 1), curve.getDN(0.0, 2)])
    return _frame(curve, -second / np.linalg.norm(second), first / np.linalg.norm(first), rows([curve.Center])[0])


def _circle_form(curve: Any) -> CurveForm:
    placed, radii = _conic_frame(curve), (curve.Radius, curve.Radius)
    return CurveForm(True, lambda low, high: arc(placed, radii, low, high))


def _ellipse_form(curve: Any) -> CurveForm:
    placed, radii = _conic_frame(curve), (curve.MajorRadius, curve.MinorRadius)
    return CurveForm(True, lambda low, high: arc(placed, radii, low, high))


def _parabola_form(curve: Any) -> CurveForm:
    origin, y, x = rows([curve.value(0.0), curve.getDN(0.0, 1), curve.getDN(0.0, 2)])
    placed = _frame(curve, x / np.linalg.norm(x), y, origin)
    return CurveForm(False, lambda low, high: parabola(placed, curve.Focal, low, high))


def _control(curve: Any) -> Array:
    return homogeneous(rows(curve.getPoles()), np.array(curve.getWeights(), dtype=float))


def _bspline_form(curve: Any) -> CurveForm:
    knots, degree, periodic = np.array(curve.KnotSequence), int(curve.Degree), bool(curve.isPeriodic())

    def over(low: float, high: float) -> Spline:
        return bspline(knots, _control(curve), degree, periodic, (low, high))

    return CurveForm(False, over)


_CURVES: dict[str, Callable[[Any], CurveForm]] = {
    "Line": _line_form, "LineSegment": _line_form, "Circle": _circle_form, "ArcOfCircle": _circle_form,
    "Ellipse": _ellipse_form, "ArcOfEllipse": _ellipse_form, "Parabola": _parabola_form,
    "ArcOfParabola": _parabola_form, "BSplineCurve": _bspline_form,
    "BezierCurve": lambda curve: CurveForm(False, lambda low, high: bezier(_control(curve))),
}
