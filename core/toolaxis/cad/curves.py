"""Curves as homogeneous splines, and the nets that a curve sweeps: extrusions and revolutions."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.rational_arcs import angle_breaks, arc_knots, arc_rows
from toolaxis.numeric.knots import restrict_spline, unroll_periodic

Array = NDArray[np.float64]


class Spline(NamedTuple):
    """A curve: knots (m,), homogeneous control points (n, 4), degree, breaks of the angle where it is an arc."""

    knots: Array
    control: Array
    degree: int
    breaks: Array | None = None


def line(origin: Array, direction: Array, low: float, high: float) -> Spline:
    """The line origin + t direction over [low, high]."""
    knots = np.array([low, low, high, high])
    ends = np.array([origin + low * direction, origin + high * direction])
    control = homogeneous(ends, np.ones(2))
    return Spline(knots, control, degree=1)


def arc(placed: Array, radii: tuple[float, float], low: float, high: float) -> Spline:
    """The arc placed @ (r0 cos t, r1 sin t, 0, 1) over the angles [low, high]."""
    breaks = angle_breaks(low, high)
    cosine, sine, weight = arc_rows(breaks).T
    x = radii[0] * cosine
    y = radii[1] * sine
    local = np.stack([x, y, np.zeros_like(weight), weight], axis=1)
    return Spline(arc_knots(breaks), local @ placed.T, 2, breaks)


def parabola(placed: Array, focal: float, low: float, high: float) -> Spline:
    """The parabola placed @ (t^2 / (4 focal), t, 0, 1) over [low, high]."""
    # The control points of a parabola are its polar values: of (low, low), (low, high) and (high, high).
    first = np.array([low, low, high])
    second = np.array([low, high, high])
    x = first * second / (4 * focal)
    y = (first + second) / 2
    local = np.stack([x, y, np.zeros(3), np.ones(3)], axis=1)
    knots = np.array([low, low, low, high, high, high])
    return Spline(knots, local @ placed.T, degree=2)


def bspline(knots: Array, control: Array, degree: int, periodic: bool, need: tuple[float, float]) -> Spline:
    """A B-spline with clamped ends; a periodic one is unrolled over the range that is needed."""
    if periodic:
        clamped, points = unroll_periodic(knots, control, degree, *need)
    else:
        first = float(knots[degree])
        last = float(knots[-degree - 1])
        clamped, points = restrict_spline(knots, control, degree, first, last)
    return Spline(clamped, points, degree)


def bezier(control: Array) -> Spline:
    """A Bezier curve over [0, 1]."""
    degree = len(control) - 1
    knots = np.repeat([0.0, 1.0], degree + 1)
    return Spline(knots, control, degree)


def homogeneous(points: Array, weights: Array) -> Array:
    """Control points (..., 3) and weights (...) as (w x, w y, w z, w)."""
    column = weights[..., None]
    return np.concatenate([points * column, column], axis=-1)


def extrude_profile(profile: Array, direction: Array, low: float, high: float) -> Array:
    """Control net of profile + t direction, t in [low, high]: (n, 4) to (n, 2, 4)."""
    weight = profile[:, 3:]
    net = np.repeat(profile[:, None, :], 2, axis=1)
    net[:, 0, :3] += low * direction * weight
    net[:, 1, :3] += high * direction * weight
    return net


def revolve_profile(profile: Array, breaks: Array) -> Array:
    """Control net of a profile turned about the local z axis: (n, 4) to (2 k - 1, n, 4), the angle first."""
    cosine, sine, arc_weight = (column[:, None] for column in arc_rows(breaks).T)
    x, y, z, weight = profile.T
    turned_x = cosine * x - sine * y
    turned_y = sine * x + cosine * y
    return np.stack([turned_x, turned_y, arc_weight * z, arc_weight * weight], axis=-1)
