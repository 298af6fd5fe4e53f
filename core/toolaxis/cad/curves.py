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


def bspline(knots: Array, control: Array, degree: int, periodic: bool, need: tuple[float, float]) -> Spline:
    """A B-spline with clamped ends; a periodic one is unrolled over the range that is needed."""
    if periodic:
        return Spline(*unroll_periodic(knots, control, degree, *need), degree)
    first, last = float(knots[degree]), float(knots[-degree - 1])
    return Spline(*restrict_spline(knots, control, degree, first, last), degree)


def bezier(control: Array) -> Spline:
    """A Bezier curve over [0, 1]."""
    degree = len(control) - 1
    return Spline(np.repeat([0.0, 1.0], degree + 1), control, degree)


def homogeneous(points: Array, weights: Array) -> Array:
    """Control points (..., 3) and weights (...) as (w x, w y, w z, w)."""
    return np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)


def extrude_profile(profile: Array, direction: Array, low: float, high: float) -> Array:
    """Control net of profile + t direction, t in [low, high]: (n, 4) to (n, 2, 4)."""
    net = np.repeat(profile[:, None, :], 2, axis=1)
    net[:, 0, :3] += low * direction * net[:, 0, 3:]
    net[:, 1, :3] += high * direction * net[:, 1, 3:]
    return net


def revolve_profile(profile: Array, breaks: Array) -> Array:
    """Control net of a profile turned about the local z axis: (n, 4) to (2 k - 1, n, 4), the angle first."""
    c, s, w = (column[:, None] for column in arc_rows(breaks).T)
    x, y, z, weight = profile.T
    return np.stack([c * x - s * y, s * x + c * y, w * z, w * weight], axis=-1)
