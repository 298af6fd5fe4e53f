"""Iso-curves around a contact as tables: exact nodes, cubic interpolation between them.

A road is the pass: rows of w, c = S + offset n and n with their derivatives; a bank is the cross curve: rows of s and
q = S + lift n with its derivative.  Tables serve all axes; what they lead to is made exact by a last step on the
surface itself.
"""

from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.swept_cutter import Pair, tip_from
from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
Floats3: TypeAlias = tuple[float, float, float]
State: TypeAlias = tuple[float, float, float, float, float, float, float, float, float, float, float, float]

SIDE = 16
"""Most nodes on either side of the contact."""
ROWS = 2 * SIDE + 1
CLOSE = 1 / 6
"""Distance of the nodes next to the contact, in radii of the tool."""
GROWTH = 1.3
WIDEST = 0.45
FIRST_CLOSE = 3


@jit_fma_inline
def iso_state(surface: SurfaceData, place: tuple[float, int, float, float], d: Array, basis: Array) -> State:
    """Point, tangent, normal and its rate on an iso-curve; place = (sign, along, fixed, w)."""
    sign, along, fixed, w = place
    if along == 0:
        surface_derivatives(surface, w, fixed, d, basis)
    else:
        surface_derivatives(surface, fixed, w, d, basis)
    a0, a1, a2, b0, b1, b2 = d[1, 0], d[1, 1], d[1, 2], d[2, 0], d[2, 1], d[2, 2]
    n0, n1, n2 = a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0
    size = sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    share = sign / size
    n0, n1, n2 = n0 * share, n1 * share, n2 * share
    i, j, t = 3 + along, 4 + along, 1 + along
    p0, p1, p2, q0, q1, q2 = d[i, 0], d[i, 1], d[i, 2], d[j, 0], d[j, 1], d[j, 2]
    r0 = share * (p1 * b2 - p2 * b1 + a1 * q2 - a2 * q1)
    r1 = share * (p2 * b0 - p0 * b2 + a2 * q0 - a0 * q2)
    r2 = share * (p0 * b1 - p1 * b0 + a0 * q1 - a1 * q0)
    dot = n0 * r0 + n1 * r1 + n2 * r2
    return (d[0, 0], d[0, 1], d[0, 2], d[t, 0], d[t, 1], d[t, 2], n0, n1, n2,
            r0 - dot * n0, r1 - dot * n1, r2 - dot * n2)


@jit
def lay_road(surface: SurfaceData, place: tuple[float, int, float, float], sizes: tuple[float, float, float],
             table: Array) -> tuple[int, int]:
    """Nodes of the pass around a contact into table (ROWS, 13); the contact is row SIDE.

    Parameters
    ----------
    surface : tuple
    place : (sign, along, fixed, w)
        The contact.
    sizes : (radius, offset, window)
        Radius of the tool, offset of the corner's centre, length to either side, mm.

    Returns
    -------
    first, last row : int
    """
    radius, offset, window = sizes
    sign, along, fixed, start = place
    d, basis = np.empty((6, 3)), np.empty((6, 26))
    ends = (SIDE, SIDE)
    for side in (-1, 1):
        w, row, gone, step = start, SIDE, 0.0, CLOSE * radius
        while True:
            state = iso_state(surface, (sign, along, fixed, w), d, basis)
            table[row, 0] = w
            for c in range(3):
                table[row, 1 + c] = state[c] + offset * state[6 + c]
                table[row, 4 + c] = state[3 + c] + offset * state[9 + c]
                table[row, 7 + c] = state[6 + c]
                table[row, 10 + c] = state[9 + c]
            pace = sqrt(state[3] ** 2 + state[4] ** 2 + state[5] ** 2)
            if gone >= window or row == 0 or row == ROWS - 1 or not pace > 1e-300:
                break
            row += side
            w += side * step / pace
            gone += step
            if abs(row - SIDE) >= FIRST_CLOSE:
                step = min(step * GROWTH, WIDEST * radius)
        ends = (row, ends[1]) if side < 0 else (ends[0], row)
    return ends


@jit
def lay_bank(surface: SurfaceData, place: tuple[float, int, float, float], sizes: tuple[float, float, float],
             table: Array, rows: tuple[int, int]) -> int:
    """Nodes of the cross curve from row rows[0] on (laid already unless it is SIDE) up to a length on one side.

    Parameters
    ----------
    surface : tuple
    place : (sign, along, fixed, s)
        The contact.
    sizes : (radius, lift, length)
        Radius of the tool, height above the surface, length to reach, mm, negative on the lower side.
    table : (ROWS, 7) array
    rows : (last, side)
        The outermost row there is; 1 or -1.

    Returns
    -------
    int
        The outermost row now.
    """
    radius, lift, length = sizes
    sign, along, fixed, start = place
    row, side = rows
    d, basis = np.empty((6, 3)), np.empty((6, 26))
    s = start if row == SIDE else table[row, 0]
    while True:
        state = iso_state(surface, (sign, along, fixed, s), d, basis)
        table[row, 0] = s
        for c in range(3):
            table[row, 1 + c] = state[c] + lift * state[6 + c]
            table[row, 4 + c] = state[3 + c] + lift * state[9 + c]
        pace = sqrt(state[3] ** 2 + state[4] ** 2 + state[5] ** 2)
        if abs(row - SIDE) * CLOSE * radius >= length or row == 0 or row == ROWS - 1 or not pace > 1e-300:
            return row
        row += side
        s += side * CLOSE * radius / pace


@jit_fma_inline
def interval(table: Array, ends: tuple[int, int], near: int, x: float) -> int:
    """The row k with table[k, 0] <= x < table[k + 1, 0], by steps from a row near to it."""
    k = min(max(near, ends[0]), ends[1] - 1)
    while k > ends[0] and x < table[k, 0]:
        k -= 1
    while k < ends[1] - 1 and x >= table[k + 1, 0]:
        k += 1
    return k


@jit_fma_inline
def blend(table: Array, k: int, column: int, x: float) -> Pair:
    """Value and derivative at x of three columns, from the rows k and k + 1 with derivatives three columns on."""
    size = table[k + 1, 0] - table[k, 0]
    t = (x - table[k, 0]) / size
    u = 1.0 - t
    b = t * t * (3.0 - 2.0 * t)
    c, e = t * u * u * size, -t * t * u * size
    db, dc, de = 6.0 * t * u / size, u * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)
    p0, p1, p2 = table[k, column], table[k, column + 1], table[k, column + 2]
    q0, q1, q2 = table[k + 1, column] - p0, table[k + 1, column + 1] - p1, table[k + 1, column + 2] - p2
    f0, f1, f2 = table[k, column + 3], table[k, column + 4], table[k, column + 5]
    g0, g1, g2 = table[k + 1, column + 3], table[k + 1, column + 4], table[k + 1, column + 5]
    return (p0 + b * q0 + c * f0 + e * g0, p1 + b * q1 + c * f1 + e * g1, p2 + b * q2 + c * f2 + e * g2,
            db * q0 + dc * f0 + de * g0, db * q1 + dc * f1 + de * g1, db * q2 + dc * f2 + de * g2)


@jit_fma_inline
def road_tip(cutter: Array, axis: Floats3, table: Array, k: int, w: float) -> Pair:
    """Tip and its rate at w of a road, between rows k and k + 1."""
    return tip_from(cutter, axis, blend(table, k, 1, w), blend(table, k, 7, w))
