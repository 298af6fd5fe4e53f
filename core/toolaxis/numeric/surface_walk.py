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

#: Columns of a span that is kept: its six knots, the first one of them two below its beginning, five shares, and where
#: parameters of the domain belong to another one.
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
    span, kept, end = find_span(knots, degree, t), walk.kept, knots.shape[0] - degree - 1
    for k in range(4):
        walk.points[side, k] = min(span - degree + k, end - 1)
    c, d = knots[span], knots[span + 1]
    line = 1.0 / (d - c)
    kept[side, 2], kept[side, 3], kept[side, 6] = c, d, line
    kept[side, 11] = np.inf if d == knots[end] else d
    if degree > 1:
        b, e = knots[span - 1], knots[span + 2]
        kept[side, 1], kept[side, 4] = b, e
        kept[side, 8], kept[side, 9] = 1.0 / (d - b), 1.0 / (e - c)
    if degree > 2:
        a, b, e, f = knots[span - 2], knots[span - 1], knots[span + 2], knots[span + 3]
        kept[side, 0], kept[side, 5] = a, f
        kept[side, 6], kept[side, 7] = line / (d - b), line / (e - c)
        kept[side, 8], kept[side, 9], kept[side, 10] = 1.0 / (d - a), 1.0 / (e - b), 1.0 / (f - c)


@jit_uncounted_inline
def _enter_span(knots: Array, degree: int, t: float, walk: SurfaceWalk, side: int) -> float:
    """The nearest parameter of the domain, with its span kept."""
    kept = walk.kept
    if not kept[side, 2] <= t < kept[side, 3]:
        t = clamp_parameter(knots, degree, t)
        if not kept[side, 2] <= t < kept[side, 11]:
            _keep_span(knots, degree, t, walk, side)
    return t


@jit_uncounted_inline
def _basis_rows(walk: SurfaceWalk, degree: int, side: int, t: float) -> Rows:
    """Basis functions and their first two derivatives, zeros behind those of a lower degree."""
    if degree == 3:
        return _cubic_rows(walk, side, t)
    kept = walk.kept
    over_c, under_d = t - kept[side, 2], kept[side, 3] - t
    line = kept[side, 6]
    if degree == 1:
        return (under_d * line, over_c * line, 0.0, 0.0), (-line, line, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    over_b, under_e = t - kept[side, 1], kept[side, 4] - t
    left, right = kept[side, 8], kept[side, 9]
    x, y = under_d * line * left, over_c * line * right
    value = under_d * x, over_b * x + under_e * y, over_c * y, 0.0
    p, q = line * left, line * right
    return value, (-2.0 * x, 2.0 * (x - y), 2.0 * y, 0.0), (2.0 * p, 2.0 * (-p - q), 2.0 * q, 0.0)


@jit_uncounted_inline
def _cubic_rows(walk: SurfaceWalk, side: int, t: float) -> Rows:
    kept = walk.kept
    over_c, over_b, over_a = t - kept[side, 2], t - kept[side, 1], t - kept[side, 0]
    under_d, under_e, under_f = kept[side, 3] - t, kept[side, 4] - t, kept[side, 5] - t
    left, middle, right = kept[side, 8], kept[side, 9], kept[side, 10]
    p, q = under_d * kept[side, 6], over_c * kept[side, 7]
    x, y, z = under_d * p * left, (over_b * p + under_e * q) * middle, over_c * q * right
    value = under_d * x, over_a * x + under_e * y, over_b * y + under_f * z, over_c * z
    slope = -3.0 * x, 3.0 * (x - y), 3.0 * (y - z), 3.0 * z
    x, y, z = -6.0 * p * left, 6.0 * (p - q) * middle, 6.0 * q * right
    return value, slope, (-x, x - y, y - z, z)


@jit_uncounted_inline
def _combine(shares: Four, lanes: FourLanes) -> Lanes:
    total = add_scaled(no_lanes(), shares[0], lanes[0])
    total = add_scaled(total, shares[1], lanes[1])
    total = add_scaled(total, shares[2], lanes[2])
    return add_scaled(total, shares[3], lanes[3])


@jit_uncounted_inline
def _load_row(control: Array, walk: SurfaceWalk, i: int) -> FourLanes:
    """Four control points along v."""
    at, points = walk.points[0, i], walk.points
    return (load_lanes(control, at, points[1, 0]), load_lanes(control, at, points[1, 1]),
            load_lanes(control, at, points[1, 2]), load_lanes(control, at, points[1, 3]))


@jit_uncounted_inline
def _combine_rows(control: Array, walk: SurfaceWalk, shares: Four) -> FourLanes:
    """The sums along v of four rows."""
    return (_combine(shares, _load_row(control, walk, 0)), _combine(shares, _load_row(control, walk, 1)),
            _combine(shares, _load_row(control, walk, 2)), _combine(shares, _load_row(control, walk, 3)))


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
    uc, vc = _enter_span(knots_u, pu, u, walk, 0), _enter_span(knots_v, pv, v, walk, 1)
    rows_u, rows_v = _basis_rows(walk, pu, 0, uc), _basis_rows(walk, pv, 1, vc)
    (p, q, r), (x, y, z) = rows_u, rows_v
    a, b, c = _combine_rows(control, walk, x), _combine_rows(control, walk, y), _combine_rows(control, walk, z)
    six = _combine(p, a), _combine(q, a), _combine(p, b), _combine(r, a), _combine(q, b), _combine(p, c)
    weights = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if rational:
        weights = weights_of(six)
        six = divide_six(six)
    if u != uc or v != vc:
        thirds = _combine_products(control, walk, r, y), _combine_products(control, walk, q, z)
        six = extend_six((u - uc, v - vc), weights, thirds, six)
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
    uc, vc = _enter_span(knots_u, pu, u, walk, 0), _enter_span(knots_v, pv, v, walk, 1)
    (p, q, _), (x, y, _) = _basis_rows(walk, pu, 0, uc), _basis_rows(walk, pv, 1, vc)
    a, b = _combine_rows(control, walk, x), _combine_rows(control, walk, y)
    s, su, sv = _combine(p, a), _combine(q, a), _combine(p, b)
    if rational:
        if u != uc or v != vc:
            any_derivatives(data, u, v, out, walk.basis)
            return
        share = 1.0 / lane(s, 3)
        wu, wv = lane(su, 3), lane(sv, 3)
        s = scale(share, s)
        su, sv = scale(share, add_scaled(su, -wu, s)), scale(share, add_scaled(sv, -wv, s))
    elif u != uc or v != vc:
        suv, du, dv = _combine(q, b), u - uc, v - vc
        s = add_scaled(add_scaled(add_scaled(s, du, su), dv, sv), du * dv, suv)
        su, sv = add_scaled(su, dv, suv), add_scaled(sv, du, suv)
    store_slopes(s, su, sv, out)
