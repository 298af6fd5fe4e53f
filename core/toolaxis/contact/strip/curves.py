"""Curves on a surface through a contact: iso-curves and plane sections, with the normal along them.

The parameter w of a curve is 0 at the contact.  On an iso-curve it is the change of u or v.  A plane section is
parametrised piece by piece by the progress along the tangent of the nearest node on the side of the contact, which is
its arc length to the second order; nodes are found one after the other as they are needed.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData
from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.surface_walk import SurfaceWalk, new_walk, walk_derivatives, walk_slopes
from toolaxis.numeric.triples import Triple, combine, cross, dot, plus

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

ALONG_U, ALONG_V, SECTION = 0, 1, 2
#: Most nodes of a plane section on either side of the contact.
_NODES = 128
#: Share of the square of the longer derivative below which the two are taken as parallel.
_PARALLEL = 1e-10


class Scratch(NamedTuple):
    """Working memory for places of one surface: the six vectors (6, 3), and that of `walk_derivatives`."""

    vectors: Array
    walk: SurfaceWalk


class SectionNodes(NamedTuple):
    """Nodes of a plane section, a row each, the contact in the middle."""

    parameters: Array
    """u, v and their rates along the tangent, 1/mm."""
    points: Array
    """Point and unit tangent."""
    found: Ints
    """Number of nodes found towards lower and towards higher w."""


class OrientedSurface(NamedTuple):
    """A surface, and the sign of its normal: 1, or -1 where the face is flipped."""

    data: SurfaceData
    sign: float


class SurfaceCurve(NamedTuple):
    """An iso-curve through (u, v), or the section there by a plane with unit normal `plane`."""

    kind: int
    u: float
    v: float
    plane: Triple
    spacing: float
    """Length between the nodes of a section, mm."""
    nodes: SectionNodes


class CurvePoint(NamedTuple):
    """A point of the surface, and the unit normal there, with their rates along a curve."""

    point: Triple
    tangent: Triple
    normal: Triple
    turn: Triple


class Moving(NamedTuple):
    """A point, and its rate in the parameter that moves it."""

    point: Triple
    rate: Triple


def new_scratch() -> Scratch:
    """Working memory for evaluating curves."""
    return Scratch(np.empty((6, 3)), new_walk())


def new_section_nodes() -> SectionNodes:
    """Memory for the nodes of a plane section."""
    return SectionNodes(np.empty((2 * _NODES + 1, 4)), np.empty((2 * _NODES + 1, 6)), np.zeros(2, dtype=np.int64))


@jit_uncounted
def curve_point(surface: OrientedSurface, curve: SurfaceCurve, w: float, scratch: Scratch) -> CurvePoint:
    """The point at parameter w of a curve.

    Where the derivatives of the surface are parallel, as at a pole, the normal is the limit, with no rate.
    """
    u, v, du, dv = curve.u, curve.v, 1.0, 0.0
    if curve.kind == SECTION:
        u, v, du, dv = _section_parameters(surface.data, curve, w, scratch)
    else:
        if curve.kind == ALONG_U:
            u += w
        else:
            v += w
            du, dv = 0.0, 1.0
    walk_derivatives(surface.data, u, v, scratch.vectors, scratch.walk)
    d = scratch.vectors
    su, sv = (d[1, 0], d[1, 1], d[1, 2]), (d[2, 0], d[2, 1], d[2, 2])
    suv = (d[4, 0], d[4, 1], d[4, 2])
    change_u = combine((d[3, 0], d[3, 1], d[3, 2]), du, suv, dv)
    change_v = combine(suv, du, (d[5, 0], d[5, 1], d[5, 2]), dv)
    n, uu, vv = cross(su, sv), dot(su, su), dot(sv, sv)
    change = plus(cross(change_u, sv), cross(su, change_v), 1.0)
    size = sqrt(dot(n, n))
    if size <= _PARALLEL * max(uu, vv):
        n = cross(suv, sv) if uu < vv else cross(su, suv)
        size = sqrt(dot(n, n))
        change = (0.0, 0.0, 0.0)
    share = surface.sign / size if size > 0.0 else 0.0
    normal = (share * n[0], share * n[1], share * n[2])
    turn = combine(change, share, normal, -share * dot(normal, change))
    return CurvePoint((d[0, 0], d[0, 1], d[0, 2]), combine(su, du, sv, dv), normal, turn)


@jit_uncounted_inline
def read_moving(rows: Array, k: int) -> Moving:
    """A row (x, y, z and their rates) of a table."""
    return Moving((rows[k, 0], rows[k, 1], rows[k, 2]), (rows[k, 3], rows[k, 4], rows[k, 5]))


@jit_uncounted_inline
def store_moving(rows: Array, k: int, moving: Moving) -> None:
    """Fill a row of a table."""
    rows[k, 0], rows[k, 1], rows[k, 2] = moving.point
    rows[k, 3], rows[k, 4], rows[k, 5] = moving.rate


@jit_uncounted_inline
def offset_point(at: CurvePoint, height: float) -> Moving:
    """The point at a height above the surface."""
    return Moving(plus(at.point, at.normal, height), plus(at.tangent, at.turn, height))


@jit_uncounted
def start_section(curve: SurfaceCurve, tangent: Triple, scratch: Scratch) -> None:
    """Begin a section at its (u, v), whose vectors `scratch` holds, with the unit tangent towards higher w."""
    curve.nodes.found[:] = 0
    _store_node(curve, _NODES, (curve.u, curve.v), tangent, scratch)


@jit_uncounted_inline
def _store_node(curve: SurfaceCurve, row: int, uv: tuple[float, float], along: Triple, scratch: Scratch) -> None:
    """Keep the point of the surface in `scratch` as a node, with the tangent in whose sense w grows."""
    d, parameters, points = scratch.vectors, curve.nodes.parameters, curve.nodes.points
    su, sv = (d[1, 0], d[1, 1], d[1, 2]), (d[2, 0], d[2, 1], d[2, 2])
    du, dv = _rates_along(su, sv, along, curve.plane)
    tangent = combine(su, du, sv, dv)
    size = sqrt(dot(tangent, tangent))
    share = 1.0 / size if size > 0.0 else 0.0
    parameters[row, 0], parameters[row, 1] = uv
    parameters[row, 2], parameters[row, 3] = share * du, share * dv
    points[row, 0], points[row, 1], points[row, 2] = d[0, 0], d[0, 1], d[0, 2]
    points[row, 3], points[row, 4], points[row, 5] = share * tangent[0], share * tangent[1], share * tangent[2]


@jit_uncounted_inline
def _rates_along(su: Triple, sv: Triple, tangent: Triple, plane: Triple) -> tuple[float, float]:
    """Rates of u and v that keep in a plane and make unit progress along a tangent; zero where there are none."""
    a, b, p, q = dot(su, tangent), dot(sv, tangent), dot(su, plane), dot(sv, plane)
    det = a * q - b * p
    return (q / det, -p / det) if det != 0.0 else (0.0, 0.0)


@jit_uncounted_inline
def _section_parameters(surface: SurfaceData, curve: SurfaceCurve, w: float,
                        scratch: Scratch) -> tuple[float, float, float, float]:
    """u, v and their rates at w of a plane section, by Newton's method from node to node; fills `scratch`."""
    d, plane, nodes = scratch.vectors, curve.plane, curve.nodes
    side, way = (1, 1) if w >= 0.0 else (-1, 0)
    last = min(int(abs(w) / curve.spacing), _NODES)
    k = min(last, nodes.found[way])
    while True:
        row = _NODES + side * k
        t = w - side * last * curve.spacing if k == last else side * curve.spacing
        origin = (nodes.points[row, 0], nodes.points[row, 1], nodes.points[row, 2])
        tangent = (nodes.points[row, 3], nodes.points[row, 4], nodes.points[row, 5])
        u = nodes.parameters[row, 0] + t * nodes.parameters[row, 2]
        v = nodes.parameters[row, 1] + t * nodes.parameters[row, 3]
        su, sv, u_at, v_at = tangent, tangent, u, v
        for _ in range(12):
            u_at, v_at = u, v
            walk_slopes(surface, u, v, d, scratch.walk)
            su, sv = (d[1, 0], d[1, 1], d[1, 2]), (d[2, 0], d[2, 1], d[2, 2])
            apart = plus((d[0, 0], d[0, 1], d[0, 2]), origin, -1.0)
            off, beside = dot(apart, tangent) - t, dot(apart, plane)
            a, b, p, q = dot(su, tangent), dot(sv, tangent), dot(su, plane), dot(sv, plane)
            det = a * q - b * p
            if det == 0.0 or abs(off) + abs(beside) <= 1e-12 * curve.spacing:
                break
            u -= (q * off - b * beside) / det
            v -= (a * beside - p * off) / det
        if k == last:
            du, dv = _rates_along(su, sv, tangent, plane)
            return u_at, v_at, du, dv
        k += 1
        _store_node(curve, _NODES + side * k, (u, v), tangent, scratch)
        nodes.found[way] = k


@jit_uncounted
def arc_length(surface: OrientedSurface, curve: SurfaceCurve, w: float, scratch: Scratch) -> float:
    """Arc length of a plane section from the contact to w, mm, by three-point Gauss quadrature between nodes."""
    side = 1.0 if w >= 0.0 else -1.0
    whole = int(abs(w) / curve.spacing)
    total = 0.0
    for k in range(whole + 1):
        start = side * k * curve.spacing
        piece = side * curve.spacing if k < whole else w - start
        for g in range(3):
            share, weight = 0.5, 4.0 / 9.0
            if g != 1:
                share, weight = 0.5 + (g - 1) * 0.3872983346207417, 5.0 / 18.0
            tangent = curve_point(surface, curve, start + share * piece, scratch).tangent
            total += weight * sqrt(dot(tangent, tangent)) * abs(piece)
    return total
