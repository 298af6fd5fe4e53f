"""The swept cutter: signed distance to a cutter, its tip along a pass, and the least distance over the pass.

A cutter is an array ``(a, r, cos beta, sin beta, top, offset)``: flat radius, corner radius, inclination of the side,
height of the cutting edge, and offset = corner radius + allowance, which is how far the corner's centre circle stays
away from the surface.  Distances are negative inside.
"""

from math import inf, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curves import Curve, Scratch, curve_point
from toolaxis.numeric.bspline import SurfaceData
from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
Setting: TypeAlias = tuple[SurfaceData, float, Array, Array]
"""Surface, sign of its normal, cutter, unit axis."""
Vector: TypeAlias = Array | tuple[float, float, float]
Pair: TypeAlias = tuple[float, float, float, float, float, float]
"""A point and its derivative."""
Gap: TypeAlias = tuple[float, float, float, float, float, float, float, float]

SIDE_NODES = 96
UPRIGHT = 1e-12


@jit_fma_inline
def meridian_distance(cutter: Array, rho: float, z: float) -> tuple[float, float, float, float]:
    """Signed distance from a point of the meridian half plane to the cutter, its gradient, and its bend.

    The distance to a convex body is the greatest of its distances to supporting planes.  Above the cutting edge's end
    it is that to the end's plane, a lower bound.

    Parameters
    ----------
    cutter : (6,) array
    rho, z : float
        Distance from the axis and height above the tip, mm.

    Returns
    -------
    distance, d/drho, d/dz, curvature of the level line : float
    """
    a, r, cos_side, sin_side, top = cutter[0], cutter[1], cutter[2], cutter[3], cutter[4]
    x, y = rho - a, z - r
    if x >= 0.0 and y * cos_side + x * sin_side <= 0.0:
        size = sqrt(x * x + y * y)
        if size > 1e-300:
            return size - r, x / size, y / size, 1.0 / size
        return -r, cos_side, -sin_side, 0.0
    side = x * cos_side - y * sin_side - r
    if side >= -z and side >= z - top:
        return side, cos_side, -sin_side, 0.0
    if -z >= z - top:
        return -z, 0.0, -1.0, 0.0
    return z - top, 0.0, 1.0, 0.0


@jit_fma_inline
def signed_distance(cutter: Array, axis: Array | tuple[float, float, float], x: float, y: float, z: float) -> float:
    """Signed distance from a point, relative to the tip, to the cutter, mm."""
    height = x * axis[0] + y * axis[1] + z * axis[2]
    x -= height * axis[0]
    y -= height * axis[1]
    z -= height * axis[2]
    return meridian_distance(cutter, sqrt(x * x + y * y + z * z), height)[0]


@jit_fma_inline
def tip_from(cutter: Array, axis: Vector, centre: Pair, normal: Pair) -> Pair:
    """Tip and its rate from c = S + offset n and n with their rates.

    Upright (T = n) the tip stands under c, as in `toolaxis.contact.placement.tips`, whose formula this is.
    """
    t0, t1, t2 = axis[0], axis[1], axis[2]
    height = normal[0] * t0 + normal[1] * t1 + normal[2] * t2
    rate = normal[3] * t0 + normal[4] * t1 + normal[5] * t2
    x0, x1, x2 = normal[0] - height * t0, normal[1] - height * t1, normal[2] - height * t2
    y0, y1, y2 = normal[3] - rate * t0, normal[4] - rate * t1, normal[5] - rate * t2
    size = x0 * x0 + x1 * x1 + x2 * x2
    reach = turn = 0.0
    if size > UPRIGHT**2:
        reach, turn = cutter[0] / sqrt(size), (x0 * y0 + x1 * y1 + x2 * y2) / size
    r = cutter[1]
    return (centre[0] + reach * x0 - r * t0, centre[1] + reach * x1 - r * t1, centre[2] + reach * x2 - r * t2,
            centre[3] + reach * (y0 - turn * x0), centre[4] + reach * (y1 - turn * x1),
            centre[5] + reach * (y2 - turn * x2))


@jit_fma_inline
def pair_of(rows: Array) -> Pair:
    """The six numbers of a (2, 3) array."""
    return rows[0, 0], rows[0, 1], rows[0, 2], rows[1, 0], rows[1, 1], rows[1, 2]


@jit_fma_inline
def gap_rates(cutter: Array, axis: Vector, point: Pair, tip: Pair) -> Gap:
    """Distance F(s, w) of a moving point q(s) to the cutter at tip(w), and derivatives.

    Parameters
    ----------
    cutter : (6,) array
    axis : three numbers
    point, tip : six numbers
        q and dq/ds; tip and dtip/dw.

    Returns
    -------
    F, F_s, F_w, F_ww without the tip's second derivative, F_ws, and the gradient's three components
    """
    t0, t1, t2 = axis[0], axis[1], axis[2]
    _, _, _, m0, m1, m2 = tip
    _, _, _, p0, p1, p2 = point
    x0, x1, x2 = point[0] - tip[0], point[1] - tip[1], point[2] - tip[2]
    z = x0 * t0 + x1 * t1 + x2 * t2
    x0, x1, x2 = x0 - z * t0, x1 - z * t1, x2 - z * t2
    rho = sqrt(x0 * x0 + x1 * x1 + x2 * x2)
    value, g_rho, g_z, bend = meridian_distance(cutter, rho, z)
    inverse = 1.0 / rho if rho > 1e-300 else 0.0
    x0, x1, x2 = x0 * inverse, x1 * inverse, x2 * inverse
    ring = g_rho * inverse if rho > 1e-300 else bend
    tr, tz = x0 * m0 + x1 * m1 + x2 * m2, t0 * m0 + t1 * m1 + t2 * m2
    pr, pz = x0 * p0 + x1 * p1 + x2 * p2, t0 * p0 + t1 * p1 + t2 * p2
    beside = m0 * m0 + m1 * m1 + m2 * m2 - tr * tr - tz * tz
    across = m0 * p0 + m1 * p1 + m2 * p2 - tr * pr - tz * pz
    t_bent, p_bent = g_rho * tz - g_z * tr, g_rho * pz - g_z * pr
    return (value, g_rho * pr + g_z * pz, -(g_rho * tr + g_z * tz), bend * t_bent * t_bent + ring * beside,
            -bend * t_bent * p_bent - ring * across,
            g_rho * x0 + g_z * t0, g_rho * x1 + g_z * t1, g_rho * x2 + g_z * t2)


@jit_fma_inline
def pass_tip(setting: Setting, curve: Curve, w: float, memory: tuple[Array, Array, Array, Scratch]) -> None:
    """Tip and its rate at w of a pass into memory[1]; memory = state (4, 3), tip (2, 3), point (2, 3), scratch."""
    surface, sign, cutter, axis = setting
    state, tip = memory[0], memory[1]
    curve_point((surface, sign), curve, w, state, memory[3])
    offset = cutter[5]
    centre = (state[0, 0] + offset * state[2, 0], state[0, 1] + offset * state[2, 1],
              state[0, 2] + offset * state[2, 2], state[1, 0] + offset * state[3, 0],
              state[1, 1] + offset * state[3, 1], state[1, 2] + offset * state[3, 2])
    normal = (state[2, 0], state[2, 1], state[2, 2], state[3, 0], state[3, 1], state[3, 2])
    (tip[0, 0], tip[0, 1], tip[0, 2], tip[1, 0], tip[1, 1], tip[1, 2]) = tip_from(cutter, axis, centre, normal)


@jit_fma_inline
def lift_point(setting: Setting, curve: Curve, s: float, lift: float,
               memory: tuple[Array, Array, Array, Scratch]) -> None:
    """The point lift above the surface at s of a curve, and its rate, into memory[2]."""
    curve_point((setting[0], setting[1]), curve, s, memory[0], memory[3])
    state, point = memory[0], memory[2]
    for c in range(3):
        point[0, c] = state[0, c] + lift * state[2, c]
        point[1, c] = state[1, c] + lift * state[3, c]


@jit
def new_memory(scratch: Scratch) -> tuple[Array, Array, Array, Scratch]:
    """Working memory of one contact."""
    return np.empty((4, 3)), np.empty((2, 3)), np.empty((2, 3)), scratch


@jit
def lay_pass(setting: Setting, curve: Curve, reach: tuple[float, float, float],
             memory: tuple[Array, Array, Array, Scratch], table: Array) -> tuple[int, int]:
    """Tips along a pass around a contact.

    Parameters
    ----------
    setting, curve, memory
    reach : (start, window, spacing)
        Parameter of the contact; distance to which the pass is followed, and length between nodes both on the surface
        and of the tip's path, mm.
    table : (2 SIDE_NODES + 1, 7) array
        Receives rows of w, tip, dtip/dw in increasing w from row `first` to row `last`.

    Returns
    -------
    first, last : int
        The contact is row SIDE_NODES.
    """
    start, window, spacing = reach
    first = last = SIDE_NODES
    tip = memory[1]
    for side in (-1, 1):
        w, row, step, last_w = start, SIDE_NODES, 0.0, start
        while True:
            pass_tip(setting, curve, w, memory)
            far = moved = speed = travel = 0.0
            for c in range(3):
                far += (tip[0, c] - table[SIDE_NODES, 1 + c]) ** 2 if row != SIDE_NODES else 0.0
                moved += (tip[0, c] - table[row - side, 1 + c]) ** 2 if row != SIDE_NODES else 0.0
                speed += memory[0][1, c] ** 2
                travel += tip[1, c] ** 2
            if moved > (1.5 * spacing) ** 2 and abs(step) > 1e-6 * spacing / sqrt(speed):
                step *= 0.5
                w = last_w + step
                continue
            table[row, 0] = w
            for c in range(3):
                table[row, 1 + c] = tip[0, c]
                table[row, 4 + c] = tip[1, c]
            pace = sqrt(max(speed, travel))
            if far > window ** 2 or row in (0, 2 * SIDE_NODES) or pace <= 1e-300:
                break
            row += side
            step = side * spacing / pace
            last_w = w
            w += step
        if side < 0:
            first = row
        else:
            last = row
    return first, last


@jit
def scan_pass(setting: Setting, table: Array, rows: tuple[int, int], point: Array, gaps: Array) -> float:
    """Distances of a point to the cutter at all nodes of a pass, and their slopes, into gaps (n, 2); the least one."""
    cutter, axis = setting[2], setting[3]
    best = inf
    lifted = pair_of(point)
    for k in range(rows[0], rows[1] + 1):
        tip = (table[k, 1], table[k, 2], table[k, 3], table[k, 4], table[k, 5], table[k, 6])
        gaps[k, 0], _, gaps[k, 1], _, _, _, _, _ = gap_rates(cutter, axis, lifted, tip)
        best = min(best, gaps[k, 0])
    return best
