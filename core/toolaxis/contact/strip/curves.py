"""Curves on a surface, with the normal and its rate along them: iso-curves and plane sections.

A curve is ``(kind, fixed, plane, nodes, built)``: on an iso-curve `fixed` is the parameter that does not vary; a plane
section runs through node 0 in the plane with unit normal `plane`, and is parametrised piece by piece by the progress
along the tangent of the nearest node on the side of the start, which is its arc length to the second order.
"""

from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Nodes: TypeAlias = tuple[Array, Ints]
Curve: TypeAlias = tuple[int, float, Array, Array, Ints]
Scratch: TypeAlias = tuple[Array, Array, Array, Array]

# place = (u, v, du/dw, dv/dw); scratch = derivatives (6, 3), basis (6, 26), normal and its rates (3, 3), place (4,)
ALONG_U, ALONG_V, SECTION = 0, 1, 2
NODES = 128


@jit_fma_inline
def normal_rates(d: Array, sign: float, rates: Array) -> None:
    """Unit normal and its derivatives in u and v into rates (3, 3), from the six derivatives d (6, 3)."""
    a0, a1, a2, b0, b1, b2 = d[1, 0], d[1, 1], d[1, 2], d[2, 0], d[2, 1], d[2, 2]
    m0, m1, m2 = d[4, 0], d[4, 1], d[4, 2]
    n0, n1, n2 = a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0
    size = sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    uu, vv = a0 * a0 + a1 * a1 + a2 * a2, b0 * b0 + b1 * b1 + b2 * b2
    if size <= 1e-10 * max(uu, vv):
        _limit_normal(d, uu < vv, sign, rates)
        return
    share = sign / size
    n0, n1, n2 = n0 * share, n1 * share, n2 * share
    rates[0, 0], rates[0, 1], rates[0, 2] = n0, n1, n2
    for row in range(1, 3):
        if row == 1:
            p0, p1, p2, q0, q1, q2 = d[3, 0], d[3, 1], d[3, 2], m0, m1, m2
        else:
            p0, p1, p2, q0, q1, q2 = m0, m1, m2, d[5, 0], d[5, 1], d[5, 2]
        r0 = share * (p1 * b2 - p2 * b1 + a1 * q2 - a2 * q1)
        r1 = share * (p2 * b0 - p0 * b2 + a2 * q0 - a0 * q2)
        r2 = share * (p0 * b1 - p1 * b0 + a0 * q1 - a1 * q0)
        along = n0 * r0 + n1 * r1 + n2 * r2
        rates[row, 0], rates[row, 1], rates[row, 2] = r0 - along * n0, r1 - along * n1, r2 - along * n2


@jit
def _limit_normal(d: Array, su_small: bool, sign: float, rates: Array) -> None:
    """The normal next to a point where Su x Sv vanishes; its rates are taken as zero."""
    p, q = (d[4], d[2]) if su_small else (d[1], d[4])
    size = 0.0
    for c in range(3):
        a, b = (c + 1) % 3, (c + 2) % 3
        rates[0, c] = sign * (p[a] * q[b] - p[b] * q[a])
        size += rates[0, c] ** 2
    size = sqrt(size)
    for c in range(3):
        rates[0, c] = rates[0, c] / size if size > 0.0 else 0.0
        rates[1, c] = 0.0
        rates[2, c] = 0.0


@jit_fma_inline
def curve_point(side: tuple[SurfaceData, float], curve: Curve, w: float, state: Array, scratch: Scratch) -> None:
    """Point, tangent, normal and its rate at parameter w of a curve.

    Parameters
    ----------
    side : (surface, sign)
        The sign is 1, or -1 where the face is flipped.
    curve : tuple
    w : float
    state : (4, 3) array
        Receives S, dS/dw, n, dn/dw.
    scratch : tuple
        From `new_scratch`.
    """
    surface, sign = side
    d, basis, rates, place = scratch
    if curve[0] == ALONG_U:
        place[0], place[1], place[2], place[3] = w, curve[1], 1.0, 0.0
        surface_derivatives(surface, w, curve[1], d, basis)
    elif curve[0] == ALONG_V:
        place[0], place[1], place[2], place[3] = curve[1], w, 0.0, 1.0
        surface_derivatives(surface, curve[1], w, d, basis)
    else:
        _section_point(surface, curve, w, scratch)
    normal_rates(d, sign, rates)
    du, dv = place[2], place[3]
    for c in range(3):
        state[0, c] = d[0, c]
        state[1, c] = du * d[1, c] + dv * d[2, c]
        state[2, c] = rates[0, c]
        state[3, c] = du * rates[1, c] + dv * rates[2, c]


@jit
def new_scratch() -> Scratch:
    """Working memory of `curve_point`."""
    return np.empty((6, 3)), np.empty((6, 26)), np.empty((3, 3)), np.empty(4)


@jit
def new_nodes() -> Nodes:
    """Room for the nodes of a plane section, and their numbers ahead of and behind the start."""
    return np.empty((2 * NODES + 1, 10)), np.zeros(2, dtype=np.int64)


@jit_fma_inline
def iso_curve(along: int, fixed: float, frame: Array, nodes: Nodes) -> Curve:
    """The iso-curve along u (0) or v (1) on which the other parameter is fixed; frame and nodes are not used."""
    return along, fixed, frame[0], nodes[0], nodes[1]


@jit
def plane_section(surface: SurfaceData, start: tuple[float, float, float], ahead: tuple[Array, Array], nodes: Nodes,
                  scratch: Scratch) -> Curve:
    """The section of a surface by a plane through a point of it.

    Parameters
    ----------
    surface : tuple
    start : (u, v, spacing)
        The point, w = 0, and the length between nodes, mm.
    ahead : (tangent, plane)
        Unit tangent of increasing w, and unit normal of the plane.
    nodes, scratch : tuple
        Room; the section lives in `nodes`.
    """
    u, v, spacing = start
    tangent, plane = ahead
    curve = (SECTION, spacing, plane, nodes[0], nodes[1])
    nodes[1][0] = nodes[1][1] = 0
    surface_derivatives(surface, u, v, scratch[0], scratch[1])
    scratch[3][0] = u
    scratch[3][1] = v
    _point_forward(plane, tangent, scratch)
    _store_node(curve, 0, scratch)
    return curve


@jit_fma_inline
def _point_forward(plane: Array, tangent: Array, scratch: Scratch) -> None:
    """Rates of u and v that keep in the plane and make unit progress along the tangent."""
    d, _, _, place = scratch
    a = b = p = q = 0.0
    for c in range(3):
        a += d[1, c] * tangent[c]
        b += d[2, c] * tangent[c]
        p += d[1, c] * plane[c]
        q += d[2, c] * plane[c]
    det = a * q - b * p
    place[2] = q / det if det != 0.0 else 0.0
    place[3] = -p / det if det != 0.0 else 0.0


@jit_fma_inline
def _store_node(curve: Curve, index: int, scratch: Scratch) -> None:
    d, _, _, place = scratch
    row = curve[3][index]
    size = 0.0
    for c in range(3):
        row[4 + c] = d[0, c]
        row[7 + c] = place[2] * d[1, c] + place[3] * d[2, c]
        size += row[7 + c] ** 2
    size = sqrt(size)
    for c in range(3):
        row[7 + c] = row[7 + c] / size if size > 0.0 else 0.0
    row[0] = place[0]
    row[1] = place[1]
    row[2] = place[2] / size if size > 0.0 else 0.0
    row[3] = place[3] / size if size > 0.0 else 0.0


@jit
def _section_point(surface: SurfaceData, curve: Curve, w: float, scratch: Scratch) -> None:
    """Evaluate a plane section at w, laying nodes up to there first."""
    spacing, built = curve[1], curve[4]
    side = 1 if w >= 0.0 else -1
    last = min(int(abs(w) / spacing), NODES)
    slot = (1 - side) // 2
    while built[slot] < last:
        k = built[slot]
        _progress(surface, curve, side * k, side * spacing, scratch)
        _store_node(curve, side * (k + 1), scratch)
        built[slot] = k + 1
    _progress(surface, curve, side * last, w - side * last * spacing, scratch)


@jit
def _progress(surface: SurfaceData, curve: Curve, index: int, t: float, scratch: Scratch) -> None:
    """The point of the plane that lies t ahead of a node along its tangent, by Newton's method."""
    plane, row = curve[2], curve[3][index]
    d, basis, _, place = scratch
    u, v = row[0] + t * row[2], row[1] + t * row[3]
    for _ in range(12):
        surface_derivatives(surface, u, v, d, basis)
        a = b = p = q = beside = 0.0
        off = -t
        for c in range(3):
            a += d[1, c] * row[7 + c]
            b += d[2, c] * row[7 + c]
            p += d[1, c] * plane[c]
            q += d[2, c] * plane[c]
            off += (d[0, c] - row[4 + c]) * row[7 + c]
            beside += (d[0, c] - row[4 + c]) * plane[c]
        det = a * q - b * p
        if det == 0.0 or abs(off) + abs(beside) <= 1e-12 * curve[1]:
            break
        u -= (q * off - b * beside) / det
        v -= (a * beside - p * off) / det
    place[0], place[1] = u, v
    _point_forward(plane, row[7:10], scratch)


@jit
def curve_length(surface: SurfaceData, curve: Curve, w: float, scratch: Scratch) -> float:
    """Arc length of a plane section from its start to w, mm, by three-point Gauss quadrature between nodes."""
    spacing, d, place = curve[1], scratch[0], scratch[3]
    side = 1.0 if w >= 0.0 else -1.0
    whole = int(abs(w) / spacing)
    total = 0.0
    for k in range(whole + 1):
        start = side * k * spacing
        piece = side * spacing if k < whole else w - start
        for g in range(3):
            share, weight = 0.5, 4.0 / 9.0
            if g != 1:
                share, weight = 0.5 + (g - 1) * 0.3872983346207417, 5.0 / 18.0
            _section_point(surface, curve, start + share * piece, scratch)
            size = 0.0
            for c in range(3):
                size += (place[2] * d[1, c] + place[3] * d[2, c]) ** 2
            total += weight * sqrt(size) * abs(piece)
    return total
