"""Corners of a polyline y(x) rounded by pairs of cubic Bezier curves that meet it, and each other, without curvature.

The curve stays a function of x, rises where both segments rise, and leaves the corner by a given height.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]

#: Change of slope below which a vertex is no corner.
_STRAIGHT = 1e-12
_STEPS = 14


def corner(before: ArrayLike, vertex: ArrayLike, after: ArrayLike, height: ArrayLike) -> Array:
    """Control points of the two cubic Bezier curves that round corners of polylines.

    Parameters
    ----------
    before, vertex, after : (n, 2) or (2,) array_like
        Points of the polylines, x ascending.
    height : (n,) array_like or float
        By how much the curve passes above the vertex, negative for below; of the sign of the change of slope.

    Returns
    -------
    (n, 2, 4, 2) array
        Two curves of four points each; the inner two of each coincide.

    Raises
    ------
    InvalidInput
        When x does not ascend, the slope does not change, or the height is on the wrong side.

    Notes
    -----
    **Source**: [stheta2023] Eqs. (9), (11); Bi0 and Bj3 are printed mirrored, the text swaps beta and gamma, and the
    lines of the second segment need sin(gamma - beta).

    **Properties**: 1. the curves meet above the vertex; 2. the inner points lie where the line through there, at right
    angles to the bisector, cuts the segments; 3. they are as far from the outer points as from the middle; 4. tangents
    are continuous and curvatures vanish at all joints.
    """
    p1, p2, p3 = (as_rows(rows, 2, "corner points") for rows in (before, vertex, after))
    eps = np.broadcast_to(np.asarray(height, dtype=float), len(p2))
    first_step = p2 - p1
    second_step = p3 - p2
    if not ((first_step[:, 0] > 0) & (second_step[:, 0] > 0)).all():
        raise InvalidInput("x does not ascend from point to point of a corner: sort the points and drop repeated ones")
    alpha = np.arctan2(first_step[:, 1], first_step[:, 0])
    gamma = np.arctan2(second_step[:, 1], second_step[:, 0])
    if not (eps * (gamma - alpha) > 0).all():
        raise InvalidInput("the height of a corner is zero or on its outer side, or the slope does not change: give a "
                           "positive height where the slope grows, a negative one where it falls")
    beta = (alpha + gamma) / 2
    d1 = eps * (np.cos(alpha) + np.cos(beta)) / np.sin(beta - alpha)
    d2 = eps * (np.cos(gamma) + np.cos(beta)) / np.sin(gamma - beta)
    top = p2 + np.column_stack([np.zeros(len(p2)), eps])

    def inner_point(angle: Array) -> Array:
        """Where the line through the top, at right angles to the bisector, cuts a segment."""
        slope = np.tan(angle)
        forward = eps / (slope - np.tan(beta))
        return np.asarray(p2 + forward[:, None] * np.column_stack([np.ones(len(p2)), slope]))

    rising = inner_point(alpha)
    falling = inner_point(gamma)
    first = p2 - d1[:, None] * np.column_stack([np.cos(alpha), np.sin(alpha)])
    last = p2 + d2[:, None] * np.column_stack([np.cos(gamma), np.sin(gamma)])
    first_curve = np.stack([first, rising, rising, top], axis=1)
    second_curve = np.stack([top, falling, falling, last], axis=1)
    return np.stack([first_curve, second_curve], axis=1)


def greatest_height(points: Array, shares: tuple[float, float] = (0.5, 0.5)) -> Array:
    """Heights of the inner vertices of a polyline at which corners just take their shares of both segments, (n - 2,).

    Parameters
    ----------
    points : (n, 2) array
    shares : (float, float)
        Of the first and of the last segment; the others are shared half and half.

    Notes
    -----
    **Source**: [stheta2023] Eqs. (10), (12).
    """
    step = np.diff(points, axis=0)
    length = np.hypot(*step.T)
    angle = np.arctan2(step[:, 1], step[:, 0])
    alpha = angle[:-1]
    gamma = angle[1:]
    beta = (gamma + alpha) / 2
    at_start = np.full(len(step), 0.5)  # share of a segment that the corner at its start may take, and at its end
    at_end = np.full(len(step), 0.5)
    at_end[0], at_start[-1] = shares
    before = length[:-1] * at_end[:-1] * np.sin(beta - alpha) / (np.cos(alpha) + np.cos(beta))
    after = length[1:] * at_start[1:] * np.sin(gamma - beta) / (np.cos(gamma) + np.cos(beta))
    return np.asarray(np.sign(before) * np.minimum(np.abs(before), np.abs(after)))


@dataclass(frozen=True, eq=False)
class RoundedLine:
    """A polyline y(x) with rounded corners.

    Attributes
    ----------
    points : (n, 2) array
        Its vertices, x ascending.
    heights : (n - 2,) array
        Of the corners at the inner ones; 0 where the slope does not change.
    """

    points: Array
    heights: Array

    @property
    def corners(self) -> list[Array]:
        """Control points (2, 4, 2) of each corner, in their order."""
        p = self.points
        some = np.flatnonzero(np.abs(self.heights) > _STRAIGHT)
        return [corner(p[i], p[i + 1], p[i + 2], self.heights[i])[0] for i in some]

    def at(self, x: ArrayLike) -> Array:
        """y, slope and second derivative at places, (3, n).

        Parameters
        ----------
        x : (n,) array_like
        """
        rows = np.asarray(x, dtype=float)
        corner_x, corner_y = self.points.T
        slopes = np.diff(corner_y) / np.diff(corner_x)
        segment = np.searchsorted(corner_x, rows, side="right") - 1
        segment = np.clip(segment, 0, len(slopes) - 1)
        slope = slopes[segment]
        y = corner_y[segment] + slope * (rows - corner_x[segment])
        out = np.stack([y, slope, np.zeros(len(rows))])
        for curves in self.corners:
            for control in curves:
                begin = control[0, 0]
                end = control[3, 0]
                on = np.flatnonzero((rows >= begin) & (rows <= end))
                if len(on):
                    out[:, on] = _on_bezier(control, rows[on])
        return out


def _on_bezier(control: Array, x: Array) -> Array:
    """y, slope and second derivative of a cubic Bezier curve whose inner points coincide, at places on it, (3, n).

    Newton's method begins where x bends the other way: from there it overshoots once and then comes down to the place.
    """
    (x0, y0), (x1, y1), _, (x3, y3) = control
    t = np.full(len(x), (x1 - x0) / (x3 - x0))
    for _ in range(_STEPS):
        value, slope, _ = _cubic(x0, x1, x3, t)
        t = np.clip(t - (value - x) / slope, 0.0, 1.0)
    _, dx, ddx = _cubic(x0, x1, x3, t)
    y, dy, ddy = _cubic(y0, y1, y3, t)
    return np.stack([y, dy / dx, (ddy * dx - ddx * dy) / dx**3])


def _cubic(start: float, inner: float, end: float, t: Array) -> tuple[Array, Array, Array]:
    """One coordinate of a cubic Bezier curve whose inner points coincide, and its two derivatives."""
    s = 1 - t
    value = s**3 * start + 3 * s * t * inner + t**3 * end
    slope = 3 * (s * s * (inner - start) + t * t * (end - inner))
    bend = 6 * (t * (end - inner) - s * (inner - start))
    return value, slope, bend
