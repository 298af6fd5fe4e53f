"""Circular and elliptic arcs as rational quadratic splines, with knots at the angles themselves.

Inside a span of 2 d the spline's parameter is not the angle; the closed form between the two is here, so that trim
curves given in angles land exactly.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WIDEST = np.pi / 2
SLACK = 0.1


def angle_breaks(low: float, high: float) -> Array:
    """Angles that divide [low, high] into equal spans of at most a right angle.

    Parameters
    ----------
    low, high : float
        rad, low < high.
    """
    count = max(1, int(np.ceil((high - low) / WIDEST - 1e-9)))
    return np.linspace(low, high, count + 1)


def arc_knots(breaks: Array) -> Array:
    """Knots of the quadratic spline: each break twice, the ends three times.

    Parameters
    ----------
    breaks : (k,) array
        From `angle_breaks`.
    """
    return np.concatenate([breaks[:1], np.repeat(breaks, 2), breaks[-1:]])


def arc_rows(breaks: Array) -> Array:
    """Homogeneous control points (w cos, w sin, w) of the unit arc, (2 k - 1, 3).

    Parameters
    ----------
    breaks : (k,) array
    """
    half = 0.5 * (breaks[1] - breaks[0])
    middle = 0.5 * (breaks[1:] + breaks[:-1])
    rows = np.empty((2 * len(breaks) - 1, 3))
    rows[0::2] = np.stack([np.cos(breaks), np.sin(breaks), np.ones_like(breaks)], axis=1)
    rows[1::2] = np.stack([np.cos(middle), np.sin(middle), np.full_like(middle, np.cos(half))], axis=1)
    return rows


def parameter_from_angle(breaks: Array, angle: Array) -> Array:
    """The spline parameter at which the arc reaches an angle.

    Parameters
    ----------
    breaks : (k,) array
    angle : (n,) array
        rad; whole turns are added where that brings an angle in from outside.

    **Properties**: 1. breaks map to themselves; 2. `angle_from_parameter` is the inverse.
    """
    half = 0.5 * (breaks[1] - breaks[0])
    turned = breaks[0] + np.mod(angle - breaks[0], 2 * np.pi)
    outside = (angle < breaks[0] - SLACK) | (angle > breaks[-1] + SLACK)
    angle = np.where(outside & (turned <= breaks[-1]), turned, angle)
    start = breaks[_span(breaks, angle)]
    quarter = np.tan(0.5 * (angle - start))
    return np.asarray(start + 2 * half * quarter / (np.sin(half) + quarter * (1 - np.cos(half))))


def angle_from_parameter(breaks: Array, parameter: Array) -> Array:
    """The angle that the arc has reached at a spline parameter.

    Parameters
    ----------
    breaks : (k,) array
    parameter : (n,) array
    """
    half = 0.5 * (breaks[1] - breaks[0])
    start = breaks[_span(breaks, parameter)]
    t = (parameter - start) / (2 * half)
    return np.asarray(start + 2 * np.arctan2(t * np.sin(half), 1 - t + t * np.cos(half)))


def _span(breaks: Array, value: Array) -> NDArray[np.intp]:
    return np.clip(np.searchsorted(breaks, value, side="right") - 1, 0, len(breaks) - 2)


@dataclass(frozen=True, eq=False)
class ParameterMap:
    """Between the parameters of a CAD kernel's surface and those of our spline.

    Attributes
    ----------
    breaks_u, breaks_v : (k,) array or None
        Breaks of the angle where the kernel's parameter is one; None where both parameters are the same.
    """

    breaks_u: Array | None = None
    breaks_v: Array | None = None

    def to_ours(self, uv: Array) -> Array:
        """Our parameters for the kernel's, (n, 2)."""
        return self._apply(parameter_from_angle, uv)

    def to_kernel(self, uv: Array) -> Array:
        """The kernel's parameters for ours, (n, 2)."""
        return self._apply(angle_from_parameter, uv)

    def _apply(self, convert: Callable[[Array, Array], Array], uv: Array) -> Array:
        result = np.array(uv, dtype=float).reshape(-1, 2)
        for column, breaks in enumerate((self.breaks_u, self.breaks_v)):
            if breaks is not None:
                result[:, column] = convert(breaks, result[:, column])
        return result
