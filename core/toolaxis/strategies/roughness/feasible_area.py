"""Leans and directions of a torus that do not gouge by curvature: the feasible area at a contact.

In every normal plane the evaluation curvature is the cutter's normal curvature less the surface's; the least of them
over all planes, the critical one, must not be negative.  Leans are angles between axis and normal; directions are those
of the lean in the tangent plane, from the surface's first principal direction (the one with the greater curvature).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import SMALLER_CORNER
from toolaxis.errors import InvalidInput
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Directions at which the border is looked at for the nearest feasible orientation, and steps of the golden section.
_DIRECTIONS, _STEPS = 720, 60
_GOLDEN = 0.6180339887498949
#: How far outside the border the nearest feasible orientation is put, rad: what rounding needs.
_INSIDE = 1e-12


class NearestOrientations(NamedTuple):
    """Nearest feasible orientations: lean and direction, rad, their distance in both, and whether there is one."""

    lean: Array
    direction: Array
    distance: Array
    found: Bools


def check_bull_nose(tool: Tool, flat_too: bool = True) -> None:
    """Check that a cutter has the two radii of a torus.

    Parameters
    ----------
    tool : Tool
    flat_too : bool
        Whether a sharp corner will do.

    Raises
    ------
    InvalidInput
        When its corner radius is its radius, or, unless a sharp corner will do, zero.
    """
    if tool.flat_radius <= 0:
        raise InvalidInput(f"corner radius is {tool.corner_radius:g} mm, the radius of the cutter {tool.name}: the "
                           "curvature of a ball end does not depend on how it leans; take a cutter with "
                           f"{SMALLER_CORNER}")
    if not flat_too and tool.corner_radius <= 0:
        raise InvalidInput(f"corner radius of the cutter {tool.name} is 0 mm: a sharp corner leaves scallops with an "
                           "edge, for which the formulas of a torus do not stand; take one with a corner radius")


def torus_curvatures(tool: Tool, lean: ArrayLike) -> tuple[Array, Array]:
    """Principal curvatures of a torus at its contact: along the projection of the axis, and across it, 1/mm.

    Parameters
    ----------
    tool : Tool
    lean : float or (n,) array_like
        Angle between axis and normal, rad.

    Raises
    ------
    InvalidInput
        When the corner radius is the cutter's radius, or zero.

    Notes
    -----
    **Source**: [dong2023] Sec. 2.2: 1/r and sin lean / ((R - r) + r sin lean).
    """
    check_bull_nose(tool, flat_too=False)
    sine = np.sin(np.abs(np.asarray(lean, dtype=float)))
    reach = tool.flat_radius + tool.corner_radius * sine
    along = np.full_like(sine, 1 / tool.corner_radius)
    return along, np.asarray(sine / reach)


def evaluation_curvature(tool: Tool, curvatures: tuple[ArrayLike, ArrayLike], lean: ArrayLike, direction: ArrayLike,
                         plane: ArrayLike) -> Array:
    """Curvature of the cutter less that of the surface in a normal plane, 1/mm.

    Parameters
    ----------
    tool : Tool
    curvatures : two of float or (n,) array_like
        Principal curvatures of the surface, the greater one first, 1/mm, positive where hollow.
    lean, direction : float or (n,) array_like
        rad
    plane : float or (n,) array_like
        Angle of the plane from the first principal direction, rad.

    Notes
    -----
    **Source**: [dong2023] Eqs. (5) to (7).
    """
    along, across = torus_curvatures(tool, lean)
    angle = np.asarray(plane, dtype=float)
    turn = angle - np.asarray(direction)
    k1, k2 = (np.asarray(k, dtype=float) for k in curvatures)
    cutter = along * np.cos(turn) ** 2 + across * np.sin(turn) ** 2
    surface = k1 * np.cos(angle) ** 2 + k2 * np.sin(angle) ** 2
    return np.asarray(cutter - surface)


def critical_curvature(tool: Tool, curvatures: tuple[ArrayLike, ArrayLike], lean: ArrayLike,
                       direction: ArrayLike) -> tuple[Array, Array]:
    """The least evaluation curvature over all normal planes, 1/mm, and the plane where it is.

    Parameters
    ----------
    tool, curvatures, lean, direction
        As for `evaluation_curvature`.

    Returns
    -------
    least, plane : array
        1/mm; rad from the first principal direction, from 0 to pi.

    Notes
    -----
    **Source**: [dong2023] Eqs. (8) and (9), the angle by atan2(G, E - F), which the paper prints inverted.
    """
    along, across = torus_curvatures(tool, lean)
    gamma = np.asarray(direction, dtype=float)
    k1, k2 = (np.asarray(k, dtype=float) for k in curvatures)
    cosine = np.cos(gamma) ** 2
    sine = np.sin(gamma) ** 2
    e = along * cosine + across * sine - k1
    f = along * sine + across * cosine - k2
    g = np.sin(2 * gamma) * (along - across)
    least = (e + f - np.hypot(e - f, g)) / 2
    greatest = np.arctan2(g, e - f) / 2
    plane = np.mod(greatest + np.pi / 2, np.pi)
    return np.asarray(least), np.asarray(plane)


def least_lean(tool: Tool, curvatures: tuple[ArrayLike, ArrayLike], direction: ArrayLike) -> Array:
    """Border of the feasible area: the least lean that does not gouge by curvature, rad.

    Parameters
    ----------
    tool : Tool
        A flat end too.
    curvatures, direction
        As for `evaluation_curvature`.

    Returns
    -------
    array
        0 where every lean is feasible, inf where none is.

    Raises
    ------
    InvalidInput
        When the corner radius is the cutter's radius.

    Notes
    -----
    **Source**: [dong2023] Eq. (10), which stands for r k1 < 1; elsewhere no lean is feasible.  For r = 0 its limit,
    sin lean = R times the curvature at right angles to the lean.
    """
    check_bull_nose(tool)
    a = tool.flat_radius
    r = tool.corner_radius
    k1, k2 = (np.asarray(k, dtype=float) for k in curvatures)
    angle = np.asarray(direction, dtype=float)
    beside = (k1 - k2) * np.sin(angle) ** 2 + k2
    with np.errstate(divide="ignore", invalid="ignore"):
        room = (1 - r * k1) * (1 - r * k2)
        sine = np.asarray(a * (beside - r * k1 * k2) / room)
    none = (r * k1 >= 1) | (sine > 1)
    within = np.clip(np.nan_to_num(sine), 0.0, 1.0)
    return np.asarray(np.where(none, np.inf, np.arcsin(within)))


def nearest_feasible(tool: Tool, curvatures: tuple[ArrayLike, ArrayLike], lean: ArrayLike,
                     direction: ArrayLike) -> NearestOrientations:
    """The feasible orientations nearest to given ones, by the distance in lean and direction.

    Parameters
    ----------
    tool : Tool
    curvatures : two of (n,) array_like
    lean, direction : (n,) array_like
        rad

    Returns
    -------
    NearestOrientations
        Those given where they are feasible; where none is, not found, with the orientation given.

    Notes
    -----
    **Source**: [dong2023] Eq. (11); the paper takes the nearest of directions a step apart, here it is refined.
    """
    k1, k2, lean, direction = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (*curvatures, lean, direction))
    k1, k2, lean, direction = np.broadcast_arrays(k1, k2, lean, direction)

    def _off(turn: Array) -> Array:
        border = least_lean(tool, (k1[:, None], k2[:, None]), direction[:, None] + turn)
        missing = np.maximum(border - lean[:, None], 0.0)
        return np.asarray(np.hypot(turn, missing))

    gap = 2 * np.pi / _DIRECTIONS
    turns = gap * np.arange(-_DIRECTIONS // 2, _DIRECTIONS // 2)
    off = _off(np.broadcast_to(turns, (len(lean), _DIRECTIONS)))
    best = turns[np.argmin(off, axis=1)]
    low = best - gap
    high = best + gap
    for _ in range(_STEPS):
        inset = _GOLDEN * (high - low)
        left = high - inset
        right = low + inset
        off = _off(np.stack([left, right], axis=1))
        lower = off[:, 0] < off[:, 1]
        low = np.where(lower, low, left)
        high = np.where(lower, right, high)
    turn = (low + high) / 2
    is_feasible = least_lean(tool, (k1, k2), direction) <= lean
    turn = np.where(is_feasible, 0.0, turn)
    border = least_lean(tool, (k1, k2), direction + turn)
    found = np.isfinite(border)
    nearest = np.where(border > lean, border + _INSIDE, lean)
    size = np.where(found, nearest, lean)
    turn = np.where(found, turn, 0.0)
    return NearestOrientations(size, direction + turn, np.hypot(turn, size - lean), found)
