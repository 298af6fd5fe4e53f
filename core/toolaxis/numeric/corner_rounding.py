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
    if not ((p2[:, 0] > p1[:, 0]) & (p3[:, 0] > p2[:, 0])).all():
        raise InvalidInput("x does not ascend from point to point of a corner: sort the points and drop repeated ones")
    alpha, gamma = (np.arctan2(step[:, 1], step[:, 0]) for step in (p2 - p1, p3 - p2))
    if not (eps * (gamma - alpha) > 0).all():
        raise InvalidInput("the height of a corner is zero or on its outer side, or the slope does not change: give a "
                           "positive height where the slope grows, a negative one where it falls")
    beta = (alpha + gamma) / 2
    d1 = eps * (np.cos(alpha) + np.cos(beta)) / np.sin(beta - alpha)
    d2 = eps * (np.cos(gamma) + np.cos(beta)) / np.sin(gamma - beta)
    top = p2 + np.column_stack([np.zeros(len(p2)), eps])
    inner = [p2 + (eps / (np.tan(slope) - np.tan(beta)))[:, None] * np.column_stack([np.ones(len(p2)), np.tan(slope)])
             for slope in (alpha, gamma)]
    first = p2 - d1[:, None] * np.column_stack([np.cos(alpha), np.sin(alpha)])
    last = p2 + d2[:, None] * np.column_stack([np.cos(gamma), np.sin(gamma)])
    return np.stack([np.stack([first, inner[0], inner[0], top], axis=1),
                     np.stack([top, inner[1], inner[1], last], axis=1)], axis=1)


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
    length, angle = np.hypot(*step.T), np.arctan2(step[:, 1], step[:, 0])
    beta = (angle[1:] + angle[:-1]) / 2
    share = np.full((len(step), 2), 0.5)
    share[0, 1], share[-1, 0] = shares
    before = length[:-1] * share[:-1, 1] * np.sin(beta - angle[:-1]) / (np.cos(angle[:-1]) + np.cos(beta))
    after = length[1:] * share[1:, 0] * np.sin(angle[1:] - beta) / (np.cos(angle[1:]) + np.cos(beta))
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
        slopes = np.diff(self.points[:, 1]) / np.diff(self.points[:, 0])
        gap = np.clip(np.searchsorted(self.points[:, 0], rows, side="right") - 1, 0, len(slopes) - 1)
        out = np.stack([self.points[gap, 1] + slopes[gap] * (rows - self.points[gap, 0]), slopes[gap],
                        np.zeros(len(rows))])
        for both in self.corners:
            for one in both:
                on = np.flatnonzero((rows >= one[0, 0]) & (rows <= one[3, 0]))
                if len(on):
                    out[:, on] = _on_bezier(one, rows[on])
        return out


def _on_bezier(control: Array, x: Array) -> Array:
    """y, slope and second derivative of a cubic Bezier curve whose inner points coincide, at places on it, (3, n).

    Newton's method begins where x bends the other way: from there it overshoots once and then comes down to the place.
    """
    (x0, y0), (x1, y1), _, (x3, y3) = control
    t = np.full(len(x), (x1 - x0) / (x3 - x0))
    for _ in range(_STEPS):
        s = 1 - t
        off = s**3 * x0 + 3 * s * t * x1 + t**3 * x3 - x
        t = np.clip(t - off / (3 * (s * s * (x1 - x0) + t * t * (x3 - x1))), 0.0, 1.0)
    s = 1 - t
    dx, dy = (3 * (s * s * (b - a) + t * t * (c - b)) for a, b, c in ((x0, x1, x3), (y0, y1, y3)))
    ddx, ddy = (6 * (t * (c - b) - s * (b - a)) for a, b, c in ((x0, x1, x3), (y0, y1, y3)))
    return np.stack([s**3 * y0 + 3 * s * t * y1 + t**3 * y3, dy / dx, (ddy * dx - ddx * dy) / dx**3])
