"""Kernel curves as homogeneous splines, and the surfaces that a curve sweeps: extrusions and revolutions."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.GeomAbs import GeomAbs_CurveType as Kind

from toolaxis.cad.arcs import angle_breaks, arc_knots, arc_rows
from toolaxis.numeric.knots import restricted, unrolled

Array = NDArray[np.float64]


EXACT = (Kind.GeomAbs_Line, Kind.GeomAbs_Circle, Kind.GeomAbs_Ellipse, Kind.GeomAbs_Parabola,
         Kind.GeomAbs_BSplineCurve, Kind.GeomAbs_BezierCurve)


class Spline(NamedTuple):
    """A curve: knots (m,), homogeneous control points (n, 4), degree, breaks of the angle where it is an arc."""

    knots: Array
    control: Array
    degree: int
    breaks: Array | None = None


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


def line(origin: Array, direction: Array, low: float, high: float) -> Spline:
    """The line origin + t direction over [low, high]."""
    ends = np.array([origin + low * direction, origin + high * direction])
    return Spline(np.array([low, low, high, high]), np.column_stack([ends, np.ones(2)]), 1)


def arc(placed: Array, radii: tuple[float, float], low: float, high: float) -> Spline:
    """The arc placed @ (r0 cos t, r1 sin t, 0, 1) over the angles [low, high]."""
    breaks = angle_breaks(low, high)
    c, s, w = arc_rows(breaks).T
    local = np.stack([radii[0] * c, radii[1] * s, np.zeros_like(w), w], axis=1)
    return Spline(arc_knots(breaks), local @ placed.T, 2, breaks)


def parabola(placed: Array, focal: float, low: float, high: float) -> Spline:
    """The parabola placed @ (t^2 / (4 focal), t, 0, 1) over [low, high]."""
    first, second = np.array([low, low, high]), np.array([low, high, high])
    local = np.stack([first * second / (4 * focal), (first + second) / 2, np.zeros(3), np.ones(3)], axis=1)
    return Spline(np.array([low] * 3 + [high] * 3), local @ placed.T, 2)


def bspline(curve: Any, low: float, high: float) -> Spline:
    """A kernel B-spline curve; a periodic one is unrolled over [low, high]."""
    poles = np.array([point_row(curve.Pole(i)) for i in range(1, curve.NbPoles() + 1)])
    weights = np.array([curve.Weight(i) for i in range(1, curve.NbPoles() + 1)])
    control = np.column_stack([poles * weights[:, None], weights])
    knots = np.array(list(curve.KnotSequence()))
    degree = int(curve.Degree())
    if curve.IsPeriodic():
        return Spline(*unrolled(knots, control, degree, low, high), degree)
    first, last = float(knots[degree]), float(knots[-degree - 1])
    return Spline(*restricted(knots, control, degree, first, last), degree)


def bezier(curve: Any) -> Spline:
    """A kernel Bezier curve over [0, 1]."""
    poles = np.array([point_row(curve.Pole(i)) for i in range(1, curve.NbPoles() + 1)])
    weights = np.array([curve.Weight(i) for i in range(1, curve.NbPoles() + 1)])
    degree = int(curve.Degree())
    knots = np.repeat([0.0, 1.0], degree + 1)
    return Spline(knots, np.column_stack([poles * weights[:, None], weights]), degree)


def from_adaptor(curve: Any, low: float, high: float) -> Spline | None:
    """The exact spline of a kernel curve over [low, high]; None where there is none of our kinds.

    Parameters
    ----------
    curve : Adaptor3d_Curve
    low, high : float
        Range that is needed; B-splines without period come whole.
    """
    kind = curve.GetType()
    if kind == Kind.GeomAbs_Line:
        axis = curve.Line().Position()
        return line(point_row(axis.Location()), point_row(axis.Direction()), low, high)
    if kind == Kind.GeomAbs_Circle:
        circle = curve.Circle()
        return arc(frame(circle.Position()), (circle.Radius(), circle.Radius()), low, high)
    if kind == Kind.GeomAbs_Ellipse:
        ellipse = curve.Ellipse()
        return arc(frame(ellipse.Position()), (ellipse.MajorRadius(), ellipse.MinorRadius()), low, high)
    if kind == Kind.GeomAbs_Parabola:
        shape = curve.Parabola()
        return parabola(frame(shape.Position()), shape.Focal(), low, high)
    if kind == Kind.GeomAbs_BSplineCurve:
        return bspline(curve.BSpline(), low, high)
    if kind == Kind.GeomAbs_BezierCurve:
        return bezier(curve.Bezier())
    return None


def extruded(profile: Array, direction: Array, low: float, high: float) -> Array:
    """Control net of profile + t direction, t in [low, high]: (n, 4) to (n, 2, 4)."""
    net = np.repeat(profile[:, None, :], 2, axis=1)
    net[:, 0, :3] += low * direction * net[:, 0, 3:]
    net[:, 1, :3] += high * direction * net[:, 1, 3:]
    return net


def revolved(profile: Array, breaks: Array) -> Array:
    """Control net of a profile turned about the local z axis: (n, 4) to (2 k - 1, n, 4), the angle first."""
    c, s, w = (column[:, None] for column in arc_rows(breaks).T)
    x, y, z, weight = profile.T
    return np.stack([c * x - s * y, s * x + c * y, w * z, w * weight], axis=-1)
