"""Tensor-product rational B-splines: position and the five derivatives up to the second order.

A surface is a tuple ``(knots_u, knots_v, control, degree_u, degree_v, rational)`` with homogeneous control points
``control`` (nu, nv, 4) = (w x, w y, w z, w).  Outside its domain it goes on straight ahead: linearly in the parameter
that was crossed.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_fma, jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.lanes import Lanes, add_scaled, lane, load_lanes, no_lanes, scale, shrink

Array = NDArray[np.float64]
SurfaceData: TypeAlias = tuple[Array, Array, Array, int, int, bool]
Four: TypeAlias = tuple[float, float, float, float]
Five: TypeAlias = tuple[float, float, float, float, float]
Six: TypeAlias = tuple[float, float, float, float, float, float]
FourLanes: TypeAlias = tuple[Lanes, Lanes, Lanes, Lanes]
SixLanes: TypeAlias = tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]

MAX_DEGREE = 25
WORK_SHAPE = (6, MAX_DEGREE + 1)
#: Knots up to which counting those below a parameter is faster than halving their range.
_COUNTED = 16


@jit_uncounted_inline
def find_span(knots: Array, degree: int, t: float) -> int:
    """Index i with knots[i] <= t < knots[i + 1], the last non-empty span at the upper end.

    Halves the range without branching on the outcome, which random parameters would make unpredictable.
    """
    low = degree
    size: int = knots.shape[0] - 2 * degree - 1
    while size > _COUNTED:
        half = size >> 1
        low = low + half if knots[low + half] <= t else low
        size -= half
    below = 0
    for k in range(low + 1, low + size):
        below += knots[k] <= t
    low += below
    while low > degree and knots[low] >= knots[low + 1]:
        low -= 1
    return low


@jit_fma
def basis_derivatives(knots: Array, degree: int, span: int, t: float, rows: Array) -> None:
    """Basis functions and their first two derivatives at t into rows[0:3, 0:degree+1].

    **Source**: Cox and de Boor's recursion; derivatives from the bases of degree - 1 and degree - 2.
    """
    _basis(knots, (degree, span), t, rows, 0)


@jit_uncounted_inline
def _basis(knots: Array, place: tuple[int, int], t: float, rows: Array, at: int) -> None:
    """The same into rows[at:at+3]; a slice there would count references in the hot loop.

    Slopes are differences of the recursion's own shares; those of the degree below wait in the last row.
    """
    degree, span = place
    if degree == 3:
        _cubic(knots, span, t, rows, at)
        return
    rows[at, 0] = 1.0
    rows[at + 2, 0] = 0.0
    for d in range(1, degree + 1):
        saved = previous = previous_slope = 0.0
        for r in range(d):
            upper = knots[span + 1 + r]
            lower = knots[span + 1 + r - d]
            inverse = 1.0 / (upper - lower)
            share = rows[at, r] * inverse
            if d == degree:
                slope = rows[at + 2, r] * inverse
                rows[at + 1, r] = d * (previous - share)
                rows[at + 2, r] = d * (previous_slope - slope)
                previous = share
                previous_slope = slope
            elif d == degree - 1:
                rows[at + 2, r] = d * (previous - share)
                previous = share
            rows[at, r] = saved + (upper - t) * share
            saved = (t - lower) * share
        rows[at, d] = saved
        if d == degree:
            rows[at + 1, d] = d * previous
            rows[at + 2, d] = d * previous_slope
        elif d == degree - 1:
            rows[at + 2, d] = d * previous


@jit_uncounted_inline
def _store_four(rows: Array, row: int, four: Four) -> None:
    rows[row, 0] = four[0]
    rows[row, 1] = four[1]
    rows[row, 2] = four[2]
    rows[row, 3] = four[3]


@jit_uncounted_inline
def _cubic(knots: Array, span: int, t: float, rows: Array, at: int) -> None:
    """The recursion of `basis_derivatives` written out for degree 3, with six divisions.

    The knots a to f stand around t, which lies between c and d: `over_c` is how far it is above c, and so on.
    """
    a, b, c = knots[span - 2], knots[span - 1], knots[span]
    d, e, f = knots[span + 1], knots[span + 2], knots[span + 3]
    over_c = t - c
    over_b = t - b
    over_a = t - a
    under_d = d - t
    under_e = e - t
    under_f = f - t
    line = 1.0 / (d - c)
    low = line / (d - b)
    high = line / (e - c)
    left = 1.0 / (d - a)
    middle = 1.0 / (e - b)
    right = 1.0 / (f - c)
    # p and q are functions of degree 1, x, y and z of degree 2, all over the widths of their knots; degree 3 and its
    # slopes come from the latter
    p = under_d * low
    q = over_c * high
    x = under_d * p * left
    y = (over_b * p + under_e * q) * middle
    z = over_c * q * right
    # Values are computed before they are stored, the ends of the first row before its middle: by this order the
    # compiler chooses which products are rounded, and so the last digits of all plans.
    first = under_d * x
    last = over_c * z
    rows[at, 0] = first
    rows[at, 3] = last
    second = over_a * x + under_e * y
    third = over_b * y + under_f * z
    rows[at, 1] = second
    rows[at, 2] = third
    _store_four(rows, at + 1, (-3.0 * x, 3.0 * (x - y), 3.0 * (y - z), 3.0 * z))
    slope_x = -6.0 * p * left
    slope_y = 6.0 * (p - q) * middle
    slope_z = 6.0 * q * right
    _store_four(rows, at + 2, (-slope_x, slope_x - slope_y, slope_y - slope_z, slope_z))


@jit_uncounted
def surface_derivatives(data: SurfaceData, u: float, v: float, out: Array, work: Array) -> None:
    """S, Su, Sv, Suu, Suv, Svv at one (u, v).

    Parameters
    ----------
    data : tuple
        The surface.
    u, v : float
        Parameters; outside the domain the surface goes on linearly in the parameter that was crossed, and the six
        vectors are the exact derivatives of that continuation: C1 across the border, with no second derivative in
        the crossed parameter.
    out : (6, 3) array
        Receives the six vectors.
    work : (6, 26) array
        Scratch.
    """
    if data[3] == 3 and data[4] == 3:  # with degrees known to the compiler there are no loops left
        _fill_derivatives(data, (3, 3), u, v, out, work)
    else:
        _fill_derivatives(data, (data[3], data[4]), u, v, out, work)


@jit_uncounted
def any_derivatives(data: SurfaceData, u: float, v: float, out: Array, work: Array) -> None:
    """The same, by loops over the degrees."""
    _fill_derivatives(data, (data[3], data[4]), u, v, out, work)


@jit_uncounted_inline
def _fill_derivatives(data: SurfaceData, degree: tuple[int, int], u: float, v: float, out: Array, work: Array) -> None:
    knots_u, knots_v, control, _, _, rational = data
    pu, pv = degree
    uc = clamp_parameter(knots_u, pu, u)
    vc = clamp_parameter(knots_v, pv, v)
    span_u = find_span(knots_u, pu, uc)
    span_v = find_span(knots_v, pv, vc)
    _basis(knots_u, (pu, span_u), uc, work, 0)
    _basis(knots_v, (pv, span_v), vc, work, 3)
    six = _patch(control, (span_u - pu, span_v - pv), (pu, pv), work)
    weights = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if rational:
        weights = weights_of(six)
        six = divide_six(six)
    if u != uc or v != vc:
        thirds = _thirds(control, (span_u - pu, span_v - pv), (pu, pv), work)
        six = extend_six((u - uc, v - vc), weights, thirds, six)
    store_six(six, out)


@jit_uncounted_inline
def surface_point(data: SurfaceData, u: float, v: float, work: Array) -> tuple[float, float, float]:
    """S at one (u, v), at the nearest parameters of the domain; for searches that ask for nothing else.

    Parameters
    ----------
    data : tuple
        The surface.
    u, v : float
    work : (6, 26) array
        Scratch.
    """
    knots_u, knots_v, control, pu, pv, rational = data
    uc = clamp_parameter(knots_u, pu, u)
    vc = clamp_parameter(knots_v, pv, v)
    span_u = find_span(knots_u, pu, uc)
    span_v = find_span(knots_v, pv, vc)
    _basis(knots_u, (pu, span_u), uc, work, 0)
    _basis(knots_v, (pv, span_v), vc, work, 3)
    x = y = z = w = 0.0
    for i in range(pu + 1):
        row = span_u - pu + i
        row_x = row_y = row_z = row_w = 0.0
        for j in range(pv + 1):
            column = span_v - pv + j
            p = work[3, j]
            row_x += p * control[row, column, 0]
            row_y += p * control[row, column, 1]
            row_z += p * control[row, column, 2]
            row_w += p * control[row, column, 3]
        q = work[0, i]
        x += q * row_x
        y += q * row_y
        z += q * row_z
        w += q * row_w
    share = 1.0 / w if rational else 1.0
    return x * share, y * share, z * share


@jit_uncounted_inline
def clamp_parameter(knots: Array, degree: int, t: float) -> float:
    """The nearest parameter in the domain; NaN stays NaN."""
    if t < knots[degree]:
        return float(knots[degree])
    if t > knots[knots.shape[0] - degree - 1]:
        return float(knots[knots.shape[0] - degree - 1])
    return t


@jit_uncounted_inline
def _patch(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array) -> SixLanes:
    """The six vectors of the homogeneous coordinates."""
    i0, j0 = first
    pu, pv = degree
    s = su = sv = suu = suv = svv = no_lanes()
    for i in range(pu + 1):
        along_v = slope_v = bend_v = no_lanes()
        for j in range(pv + 1):
            point = load_lanes(control, i0 + i, j0 + j)
            along_v = add_scaled(along_v, work[3, j], point)
            slope_v = add_scaled(slope_v, work[4, j], point)
            bend_v = add_scaled(bend_v, work[5, j], point)
        p = work[0, i]
        q = work[1, i]
        r = work[2, i]
        s = add_scaled(s, p, along_v)
        su = add_scaled(su, q, along_v)
        sv = add_scaled(sv, p, slope_v)
        suu = add_scaled(suu, r, along_v)
        suv = add_scaled(suv, q, slope_v)
        svv = add_scaled(svv, p, bend_v)
    return s, su, sv, suu, suv, svv


@jit_uncounted_inline
def weights_of(six: SixLanes) -> Six:
    """The weight and its five derivatives."""
    s, su, sv, suu, suv, svv = six
    return lane(s, 3), lane(su, 3), lane(sv, 3), lane(suu, 3), lane(suv, 3), lane(svv, 3)


@jit_uncounted_inline
def divide_six(six: SixLanes) -> SixLanes:
    """The six vectors of a quotient, from those of its parts."""
    w, wu, wv, wuu, wuv, wvv = weights_of(six)
    share = 1.0 / w
    s = scale(share, six[0])
    su = scale(share, add_scaled(six[1], -wu, s))
    sv = scale(share, add_scaled(six[2], -wv, s))
    part = add_scaled(six[3], -2.0 * wu, su)
    suu = scale(share, add_scaled(part, -wuu, s))
    part = add_scaled(six[4], -wu, sv)
    part = add_scaled(part, -wv, su)
    suv = scale(share, add_scaled(part, -wuv, s))
    part = add_scaled(six[5], -2.0 * wv, sv)
    svv = scale(share, add_scaled(part, -wvv, s))
    return s, su, sv, suu, suv, svv


@jit_uncounted_inline
def _store_vector(vector: Lanes, out: Array, row: int) -> None:
    out[row, 0] = lane(vector, 0)
    out[row, 1] = lane(vector, 1)
    out[row, 2] = lane(vector, 2)


@jit_uncounted_inline
def store_slopes(s: Lanes, su: Lanes, sv: Lanes, out: Array) -> None:
    """S, Su and Sv into the first three rows of a (6, 3) array."""
    _store_vector(s, out, 0)
    _store_vector(su, out, 1)
    _store_vector(sv, out, 2)


@jit_uncounted_inline
def store_six(six: SixLanes, out: Array) -> None:
    """The six vectors into a (6, 3) array."""
    s, su, sv, suu, suv, svv = six
    store_slopes(s, su, sv, out)
    _store_vector(suu, out, 3)
    _store_vector(suv, out, 4)
    _store_vector(svv, out, 5)


@jit_uncounted_inline
def _thirds(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array) -> tuple[Lanes, Lanes]:
    """The mixed third derivatives uuv and uvv of the homogeneous coordinates."""
    i0, j0 = first
    pu, pv = degree
    uuv = uvv = no_lanes()
    for i in range(pu + 1):
        for j in range(pv + 1):
            point = load_lanes(control, i0 + i, j0 + j)
            uuv = add_scaled(uuv, work[2, i] * work[4, j], point)
            uvv = add_scaled(uvv, work[1, i] * work[5, j], point)
    return uuv, uvv


@jit_uncounted_inline
def _carry_second(second: Lanes, third: Lanes, weights: Five, vectors: FourLanes, step: float) -> Lanes:
    """A second derivative carried on across the border: Suu + dv Suuv.

    Parameters
    ----------
    second, third : lanes
        Suu, and uuv of the homogeneous coordinates.
    weights : five floats
        w, wu, wv, wuu, wuv.
    vectors : four lanes
        S, Su, Sv, Suv.
    step : float
        dv
    """
    w, wu, wv, wuu, wuv = weights
    s, su, sv, suv = vectors
    both = add_scaled(scale(wuv, su), wu, suv)
    part = add_scaled(third, -wv, second)
    part = add_scaled(part, -2.0, both)
    part = add_scaled(part, -wuu, sv)
    part = add_scaled(part, -lane(third, 3), s)
    return add_scaled(second, step, shrink(w, part))


@jit_uncounted_inline
def extend_six(beyond: tuple[float, float], weights: Six, thirds: tuple[Lanes, Lanes], six: SixLanes) -> SixLanes:
    """The six vectors of the border carried on: S + du Su + dv Sv + du dv Suv, and its derivatives."""
    du, dv = beyond
    w, wu, wv, wuu, wuv, wvv = weights
    s, su, sv, suu, suv, svv = six
    uuv, uvv = thirds
    whole = add_scaled(s, du, su)
    whole = add_scaled(whole, dv, sv)
    whole = add_scaled(whole, du * dv, suv)
    if du == 0.0:
        suu = _carry_second(suu, uuv, (w, wu, wv, wuu, wuv), (s, su, sv, suv), dv)
    else:
        suu = scale(0.0 * du, no_lanes())
    if dv == 0.0:
        svv = _carry_second(svv, uvv, (w, wv, wu, wvv, wuv), (s, sv, su, suv), du)
    else:
        svv = scale(0.0 * dv, no_lanes())
    return whole, add_scaled(su, dv, suv), add_scaled(sv, du, suv), suu, suv, svv


@jit
def _many(data: SurfaceData, uv: Array, out: Array) -> None:
    work = np.empty((6, 26))
    for k in range(uv.shape[0]):
        surface_derivatives(data, uv[k, 0], uv[k, 1], out[k], work)


@jit
def _many_cubic(data: SurfaceData, uv: Array, out: Array) -> bool:
    """The six vectors at the nearest parameters of the domain of a bicubic surface; whether all were inside.

    With degrees known to the compiler and no continuation beyond the border the loop runs a third faster.
    """
    knots_u, knots_v, control, _, _, rational = data
    work = np.empty((6, 26))
    inside = True
    for k in range(uv.shape[0]):
        u = clamp_parameter(knots_u, 3, uv[k, 0])
        v = clamp_parameter(knots_v, 3, uv[k, 1])
        inside = inside and u == uv[k, 0] and v == uv[k, 1]
        span_u = find_span(knots_u, 3, u)
        span_v = find_span(knots_v, 3, v)
        _cubic(knots_u, span_u, u, work, 0)
        _cubic(knots_v, span_v, v, work, 3)
        six = _patch(control, (span_u - 3, span_v - 3), (3, 3), work)
        if rational:
            six = divide_six(six)
        store_six(six, out[k])
    return inside


def surface_derivatives_many(data: SurfaceData, uv: Array) -> Array:
    """S, Su, Sv, Suu, Suv, Svv at many parameters.

    Parameters
    ----------
    data : tuple
        The surface.
    uv : (n, 2) array
        Parameters.

    Returns
    -------
    (n, 6, 3) array
    """
    if not _compiled.available:
        return surface_derivatives_many_numpy(data, uv)
    uv = np.ascontiguousarray(uv, dtype=float)
    out = np.empty((len(uv), 6, 3))
    if data[3] == data[4] == 3 and _many_cubic(data, uv, out):
        return out
    _many(data, uv, out)
    return out


def basis_derivatives_numpy(knots: Array, degree: int, t: Array) -> tuple[Array, NDArray[np.intp]]:
    """Basis functions and two derivatives at many parameters.

    Parameters
    ----------
    knots : (m,) array
    degree : int
    t : (n,) array
        Parameters inside the domain.

    Returns
    -------
    rows : (n, 3, degree + 1) array
    first : (n,) array of int
        Index of the first control point each row belongs to.
    """
    last = np.flatnonzero(knots < knots[len(knots) - degree - 1])[-1]
    span = np.clip(np.searchsorted(knots, t, side="right") - 1, degree, last)
    levels: list[Array] = [np.ones((len(t), 1))]  # the functions of each degree from 0
    for d in range(1, degree + 1):
        previous = levels[-1]
        row = np.zeros((len(t), d + 1))
        for r in range(d):
            lower = knots[span + 1 + r - d]
            upper = knots[span + 1 + r]
            share = previous[:, r] / (upper - lower)
            row[:, r] += (upper - t) * share
            row[:, r + 1] += (t - lower) * share
        levels.append(row)
    rows = np.zeros((len(t), 3, degree + 1))
    rows[:, 0] = levels[degree]
    rows[:, 1] = _slopes(knots, degree, span, levels[degree - 1])
    if degree > 1:
        lower_slopes = _slopes(knots, degree - 1, span, levels[degree - 2])
        rows[:, 2] = _slopes(knots, degree, span, lower_slopes)
    return rows, span - degree


def _slopes(knots: Array, d: int, span: NDArray[np.intp], lower: Array) -> Array:
    """Slopes of the functions of degree d, (n, d + 1), from those of the degree below, (n, d)."""
    rows = np.zeros((len(span), d + 1))
    for k in range(d):
        width = knots[span + 1 + k] - knots[span + 1 + k - d]
        value = d * lower[:, k] / width
        rows[:, k] -= value
        rows[:, k + 1] += value
    return rows


def surface_derivatives_many_numpy(data: SurfaceData, uv: Array) -> Array:
    """The plain twin of `surface_derivatives_many`, written on whole arrays.

    Parameters and result as there.
    """
    knots_u, knots_v, control, pu, pv, _ = data
    uv = np.asarray(uv, dtype=float)
    u = np.clip(uv[:, 0], knots_u[pu], knots_u[-pu - 1])
    v = np.clip(uv[:, 1], knots_v[pv], knots_v[-pv - 1])
    basis_u, first_u = basis_derivatives_numpy(knots_u, pu, u)
    basis_v, first_v = basis_derivatives_numpy(knots_v, pv, v)
    rows = first_u[:, None] + np.arange(pu + 1)
    columns = first_v[:, None] + np.arange(pv + 1)
    net = control[rows[:, :, None], columns[:, None, :]]
    h = np.einsum("nai,nbj,nijc->nabc", basis_u, basis_v, net)
    return _extend_numpy(*_quotient(h), uv - np.column_stack([u, v]))


def _quotient(h: NDArray[Any]) -> tuple[Array, Array, Array]:
    """The six vectors, Suuv and Suvv of a quotient, from the table h[n, a, b, xyzw] of its parts' derivatives."""
    weight = h[:, :1, :1, 3:]
    w = h[..., 3:] / weight
    part = h[..., :3] / weight
    wu = w[:, 1, 0]
    wv = w[:, 0, 1]
    wuu = w[:, 2, 0]
    wuv = w[:, 1, 1]
    wvv = w[:, 0, 2]
    s = part[:, 0, 0]
    su = part[:, 1, 0] - wu * s
    sv = part[:, 0, 1] - wv * s
    suu = part[:, 2, 0] - 2 * wu * su - wuu * s
    suv = part[:, 1, 1] - wu * sv - wv * su - wuv * s
    svv = part[:, 0, 2] - 2 * wv * sv - wvv * s
    suuv = part[:, 2, 1] - wv * suu - 2 * (wu * suv + wuv * su) - wuu * sv - w[:, 2, 1] * s
    suvv = part[:, 1, 2] - wu * svv - 2 * (wv * suv + wuv * sv) - wvv * su - w[:, 1, 2] * s
    return np.stack([s, su, sv, suu, suv, svv], axis=1), suuv, suvv


def _extend_numpy(out: Array, suuv: Array, suvv: Array, beyond: Array) -> Array:
    """The six vectors of the border carried on, as `extend_six` does it."""
    du = beyond[:, :1]
    dv = beyond[:, 1:]
    s, su, sv, suu, suv, svv = (out[:, k] for k in range(6))
    point = s + du * su + dv * sv + du * dv * suv
    along_u = su + dv * suv
    along_v = sv + du * suv
    bend_u = np.where(du != 0, 0.0 * du, suu + dv * suuv)
    bend_v = np.where(dv != 0, 0.0 * dv, svv + du * suvv)
    return np.stack([point, along_u, along_v, bend_u, suv, bend_v], axis=1)
