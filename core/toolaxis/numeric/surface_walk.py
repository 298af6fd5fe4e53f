"""Surfaces at one place after the other: up to degree 3 what the last place needed of the knots is kept.

The numbers are those of `toolaxis.numeric.bspline.surface_derivatives` to the last bit.  Places that follow each other
lie in one span more often than not; there neither the span is searched nor anything divided by its knots.
"""

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import (
    WORK_SHAPE,
    FourLanes,
    SurfaceData,
    any_derivatives,
    clamp_parameter,
    divide_six,
    extend_six,
    find_span,
    store_six,
    store_slopes,
    weights_of,
)
from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.lanes import Lanes, add_scaled, lane, load_lanes, no_lanes, scale

Array = NDArray[np.float64]
Four: TypeAlias = tuple[float, float, float, float]
Rows: TypeAlias = tuple[Four, Four, Four]

#: Columns of a span that is kept: the six knots around it, which is from c to d; one over distances of theirs, or for
#: degree 3 over the products of two (LOW and HIGH); and where parameters of the domain belong to another span.
_A, _B, _C, _D, _E, _F = range(6)
_LOW, _HIGH, _LEFT, _MIDDLE, _RIGHT, _END = range(6, 12)
_LINE = _LOW  # of degrees 1 and 2
_KEPT = 12


class SurfaceWalk(NamedTuple):
    """Memory for places one after the other on one and the same surface."""

    basis: Array
    """Scratch of `surface_derivatives`."""
    points: NDArray[np.int64]
    """Four control points of the spans in u and v, (2, 4): the last one again where the degree takes fewer."""
    kept: Array
    """What the basis needs of their knots, a row each."""


def new_walk() -> SurfaceWalk:
    """Memory for the places of one surface."""
    return SurfaceWalk(np.empty(WORK_SHAPE), np.zeros((2, 4), dtype=np.int64), np.full((2, _KEPT), np.inf))


@jit_uncounted
def _keep_span(knots: Array, degree: int, t: float, walk: SurfaceWalk, side: int) -> None:
    """Keep the span of a parameter of the domain."""
    span = find_span(knots, degree, t)
    kept = walk.kept
    end = knots.shape[0] - degree - 1
    for k in range(4):
        walk.points[side, k] = min(span - degree + k, end - 1)
    c = knots[span]
    d = knots[span + 1]
    line = 1.0 / (d - c)
    kept[side, _C] = c
    kept[side, _D] = d
    kept[side, _END] = np.inf if d == knots[end] else d
    if degree == 1:
        kept[side, _LINE] = line
        return
    b = knots[span - 1]
    e = knots[span + 2]
    kept[side, _B] = b
    kept[side, _E] = e
    if degree == 2:
        kept[side, _LINE] = line
        kept[side, _LEFT] = 1.0 / (d - b)
        kept[side, _MIDDLE] = 1.0 / (e - c)
        return
    a = knots[span - 2]
    f = knots[span + 3]
    kept[side, _A] = a
    kept[side, _F] = f
    kept[side, _LOW] = line / (d - b)
    kept[side, _HIGH] = line / (e - c)
    kept[side, _LEFT] = 1.0 / (d - a)
    kept[side, _MIDDLE] = 1.0 / (e - b)
    kept[side, _RIGHT] = 1.0 / (f - c)


@jit_uncounted_inline
def _enter_span(knots: Array, degree: int, t: float, walk: SurfaceWalk, side: int) -> float:
    """The nearest parameter of the domain, with its span kept."""
    kept = walk.kept
    if not kept[side, _C] <= t < kept[side, _D]:
        t = clamp_parameter(knots, degree, t)
        if not kept[side, _C] <= t < kept[side, _END]:
            _keep_span(knots, degree, t, walk, side)
    return t


@jit_uncounted_inline
def _basis_rows(walk: SurfaceWalk, degree: int, side: int, t: float) -> Rows:
    """Basis functions and their first two derivatives, zeros behind those of a lower degree."""
    if degree == 3:
        return _cubic_rows(walk, side, t)
    kept = walk.kept
    over_c = t - kept[side, _C]
    under_d = kept[side, _D] - t
    line = kept[side, _LINE]
    if degree == 1:
        value = under_d * line, over_c * line, 0.0, 0.0
        slope = -line, line, 0.0, 0.0
        return value, slope, (0.0, 0.0, 0.0, 0.0)
    over_b = t - kept[side, _B]
    under_e = kept[side, _E] - t
    left = kept[side, _LEFT]
    right = kept[side, _MIDDLE]
    x = under_d * line * left
    y = over_c * line * right
    p = line * left
    q = line * right
    value = under_d * x, over_b * x + under_e * y, over_c * y, 0.0
    slope = -2.0 * x, 2.0 * (x - y), 2.0 * y, 0.0
    return value, slope, (2.0 * p, 2.0 * (-p - q), 2.0 * q, 0.0)


@jit_uncounted_inline
def _cubic_rows(walk: SurfaceWalk, side: int, t: float) -> Rows:
    """The same for degree 3; the names are those of `toolaxis.numeric.bspline`'s recursion."""
    kept = walk.kept
    over_c = t - kept[side, _C]
    over_b = t - kept[side, _B]
    over_a = t - kept[side, _A]
    under_d = kept[side, _D] - t
    under_e = kept[side, _E] - t
    under_f = kept[side, _F] - t
    left = kept[side, _LEFT]
    middle = kept[side, _MIDDLE]
    right = kept[side, _RIGHT]
    p = under_d * kept[side, _LOW]
    q = over_c * kept[side, _HIGH]
    x = under_d * p * left
    y = (over_b * p + under_e * q) * middle
    z = over_c * q * right
    value = under_d * x, over_a * x + under_e * y, over_b * y + under_f * z, over_c * z
    slope = -3.0 * x, 3.0 * (x - y), 3.0 * (y - z), 3.0 * z
    slope_x = -6.0 * p * left
    slope_y = 6.0 * (p - q) * middle
    slope_z = 6.0 * q * right
    return value, slope, (-slope_x, slope_x - slope_y, slope_y - slope_z, slope_z)


@jit_uncounted_inline
def _combine(shares: Four, lanes: FourLanes) -> Lanes:
    total = add_scaled(no_lanes(), shares[0], lanes[0])
    total = add_scaled(total, shares[1], lanes[1])
    total = add_scaled(total, shares[2], lanes[2])
    return add_scaled(total, shares[3], lanes[3])


@jit_uncounted_inline
def _load_row(control: Array, walk: SurfaceWalk, i: int) -> FourLanes:
    """Four control points along v."""
    points = walk.points
    row = points[0, i]
    first = load_lanes(control, row, points[1, 0])
    second = load_lanes(control, row, points[1, 1])
    third = load_lanes(control, row, points[1, 2])
    fourth = load_lanes(control, row, points[1, 3])
    return first, second, third, fourth


@jit_uncounted_inline
def _combine_rows(control: Array, walk: SurfaceWalk, shares: Four) -> FourLanes:
    """The sums along v of four rows."""
    first = _combine(shares, _load_row(control, walk, 0))
    second = _combine(shares, _load_row(control, walk, 1))
    third = _combine(shares, _load_row(control, walk, 2))
    fourth = _combine(shares, _load_row(control, walk, 3))
    return first, second, third, fourth


@jit_uncounted_inline
def _combine_products(control: Array, walk: SurfaceWalk, x: Four, y: Four) -> Lanes:
    """The sum over all sixteen control points, each with the product of its two shares."""
    total = no_lanes()
    for i in range(4):
        row = _load_row(control, walk, i)
        total = add_scaled(total, x[i] * y[0], row[0])
        total = add_scaled(total, x[i] * y[1], row[1])
        total = add_scaled(total, x[i] * y[2], row[2])
        total = add_scaled(total, x[i] * y[3], row[3])
    return total


@jit_uncounted_inline
def walk_derivatives(data: SurfaceData, u: float, v: float, out: Array, walk: SurfaceWalk) -> None:
    """S, Su, Sv, Suu, Suv, Svv at one (u, v), as `surface_derivatives` gives them.

    Parameters
    ----------
    data : tuple
        The surface.
    u, v : float
    out : (6, 3) array
        Receives the six vectors.
    walk : SurfaceWalk
        Memory for this surface.
    """
    knots_u, knots_v, control, pu, pv, rational = data
    if not (1 <= pu <= 3 and 1 <= pv <= 3):
        any_derivatives(data, u, v, out, walk.basis)
        return
    uc = _enter_span(knots_u, pu, u, walk, 0)
    vc = _enter_span(knots_v, pv, v, walk, 1)
    p, q, r = _basis_rows(walk, pu, 0, uc)
    x, y, z = _basis_rows(walk, pv, 1, vc)
    along_v = _combine_rows(control, walk, x)
    slope_v = _combine_rows(control, walk, y)
    bend_v = _combine_rows(control, walk, z)
    s = _combine(p, along_v)
    su = _combine(q, along_v)
    sv = _combine(p, slope_v)
    suu = _combine(r, along_v)
    suv = _combine(q, slope_v)
    svv = _combine(p, bend_v)
    six = s, su, sv, suu, suv, svv
    weights = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if rational:
        weights = weights_of(six)
        six = divide_six(six)
    if u != uc or v != vc:
        uuv = _combine_products(control, walk, r, y)
        uvv = _combine_products(control, walk, q, z)
        six = extend_six((u - uc, v - vc), weights, (uuv, uvv), six)
    store_six(six, out)


@jit_uncounted_inline
def walk_slopes(data: SurfaceData, u: float, v: float, out: Array, walk: SurfaceWalk) -> None:
    """S, Su, Sv at one (u, v), as `surface_derivatives` gives them.

    Parameters
    ----------
    data : tuple
        The surface.
    u, v : float
    out : (6, 3) array
        Receives the vectors in its first three rows; what the others hold is not said.
    walk : SurfaceWalk
        Memory for this surface.
    """
    knots_u, knots_v, control, pu, pv, rational = data
    if not (1 <= pu <= 3 and 1 <= pv <= 3):
        any_derivatives(data, u, v, out, walk.basis)
        return
    uc = _enter_span(knots_u, pu, u, walk, 0)
    vc = _enter_span(knots_v, pv, v, walk, 1)
    p, q, _ = _basis_rows(walk, pu, 0, uc)
    x, y, _ = _basis_rows(walk, pv, 1, vc)
    along_v = _combine_rows(control, walk, x)
    slope_v = _combine_rows(control, walk, y)
    s = _combine(p, along_v)
    su = _combine(q, along_v)
    sv = _combine(p, slope_v)
    if rational:
        if u != uc or v != vc:
            any_derivatives(data, u, v, out, walk.basis)
            return
        share = 1.0 / lane(s, 3)
        wu = lane(su, 3)
        wv = lane(sv, 3)
        s = scale(share, s)
        su = scale(share, add_scaled(su, -wu, s))
        sv = scale(share, add_scaled(sv, -wv, s))
    elif u != uc or v != vc:
        suv = _combine(q, slope_v)
        du = u - uc
        dv = v - vc
        s = add_scaled(s, du, su)
        s = add_scaled(s, dv, sv)
        s = add_scaled(s, du * dv, suv)
        su = add_scaled(su, dv, suv)
        sv = add_scaled(sv, du, suv)
    store_slopes(s, su, sv, out)
