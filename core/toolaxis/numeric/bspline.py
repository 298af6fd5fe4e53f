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
            upper, lower = knots[span + 1 + r], knots[span + 1 + r - d]
            inverse = 1.0 / (upper - lower)
            share = rows[at, r] * inverse
            if d == degree:
                slope = rows[at + 2, r] * inverse
                rows[at + 1, r], previous = d * (previous - share), share
                rows[at + 2, r], previous_slope = d * (previous_slope - slope), slope
            elif d == degree - 1:
                rows[at + 2, r], previous = d * (previous - share), share
            rows[at, r] = saved + (upper - t) * share
            saved = (t - lower) * share
        rows[at, d] = saved
        if d == degree:
            rows[at + 1, d], rows[at + 2, d] = d * previous, d * previous_slope
        elif d == degree - 1:
            rows[at + 2, d] = d * previous


@jit_uncounted_inline
def _cubic(knots: Array, span: int, t: float, rows: Array, at: int) -> None:
    """The recursion of `basis_derivatives` written out for degree 3, with six divisions."""
    a, b, c = knots[span - 2], knots[span - 1], knots[span]
    d, e, f = knots[span + 1], knots[span + 2], knots[span + 3]
    over_c, over_b, over_a = t - c, t - b, t - a
    under_d, under_e, under_f = d - t, e - t, f - t
    line = 1.0 / (d - c)
    low, high = line / (d - b), line / (e - c)
    left, middle, right = 1.0 / (d - a), 1.0 / (e - b), 1.0 / (f - c)
    p, q = under_d * low, over_c * high
    x, y, z = under_d * p * left, (over_b * p + under_e * q) * middle, over_c * q * right
    rows[at, 0], rows[at, 3] = under_d * x, over_c * z
    rows[at, 1], rows[at, 2] = over_a * x + under_e * y, over_b * y + under_f * z
    rows[at + 1, 0], rows[at + 1, 1], rows[at + 1, 2], rows[at + 1, 3] = -3.0 * x, 3.0 * (x - y), 3.0 * (y - z), 3.0 * z
    x, y, z = -6.0 * p * left, 6.0 * (p - q) * middle, 6.0 * q * right
    rows[at + 2, 0], rows[at + 2, 1], rows[at + 2, 2], rows[at + 2, 3] = -x, x - y, y - z, z


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
    uc, vc = clamp_parameter(knots_u, pu, u), clamp_parameter(knots_v, pv, v)
    span_u, span_v = find_span(knots_u, pu, uc), find_span(knots_v, pv, vc)
    _basis(knots_u, (pu, span_u), uc, work, 0)
    _basis(knots_v, (pv, span_v), vc, work, 3)
    i0, j0 = span_u - pu, span_v - pv
    x = y = z = w = 0.0
    for i in range(pu + 1):
        a = b = c = d = 0.0
        for j in range(pv + 1):
            p = work[3, j]
            a, b = a + p * control[i0 + i, j0 + j, 0], b + p * control[i0 + i, j0 + j, 1]
            c, d = c + p * control[i0 + i, j0 + j, 2], d + p * control[i0 + i, j0 + j, 3]
        q = work[0, i]
        x, y, z, w = x + q * a, y + q * b, z + q * c, w + q * d
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
    (i0, j0), (pu, pv) = first, degree
    s = su = sv = suu = suv = svv = no_lanes()
    for i in range(pu + 1):
        a = b = c = no_lanes()
        for j in range(pv + 1):
            point = load_lanes(control, i0 + i, j0 + j)
            a, b, c = (add_scaled(a, work[3, j], point), add_scaled(b, work[4, j], point),
                       add_scaled(c, work[5, j], point))
        p, q, r = work[0, i], work[1, i], work[2, i]
        s, su, sv = add_scaled(s, p, a), add_scaled(su, q, a), add_scaled(sv, p, b)
        suu, suv, svv = add_scaled(suu, r, a), add_scaled(suv, q, b), add_scaled(svv, p, c)
    return s, su, sv, suu, suv, svv


@jit_uncounted_inline
def weights_of(six: SixLanes) -> Six:
    """The weight and its five derivatives."""
    return lane(six[0], 3), lane(six[1], 3), lane(six[2], 3), lane(six[3], 3), lane(six[4], 3), lane(six[5], 3)


@jit_uncounted_inline
def divide_six(six: SixLanes) -> SixLanes:
    """The six vectors of a quotient, from those of its parts."""
    w, wu, wv, wuu, wuv, wvv = weights_of(six)
    share = 1.0 / w
    s = scale(share, six[0])
    su = scale(share, add_scaled(six[1], -wu, s))
    sv = scale(share, add_scaled(six[2], -wv, s))
    suu = scale(share, add_scaled(add_scaled(six[3], -2.0 * wu, su), -wuu, s))
    suv = scale(share, add_scaled(add_scaled(add_scaled(six[4], -wu, sv), -wv, su), -wuv, s))
    svv = scale(share, add_scaled(add_scaled(six[5], -2.0 * wv, sv), -wvv, s))
    return s, su, sv, suu, suv, svv


@jit_uncounted_inline
def store_slopes(s: Lanes, su: Lanes, sv: Lanes, out: Array) -> None:
    """S, Su and Sv into the first three rows of a (6, 3) array."""
    out[0, 0], out[0, 1], out[0, 2] = lane(s, 0), lane(s, 1), lane(s, 2)
    out[1, 0], out[1, 1], out[1, 2] = lane(su, 0), lane(su, 1), lane(su, 2)
    out[2, 0], out[2, 1], out[2, 2] = lane(sv, 0), lane(sv, 1), lane(sv, 2)


@jit_uncounted_inline
def store_six(six: SixLanes, out: Array) -> None:
    """The six vectors into a (6, 3) array."""
    s, su, sv, suu, suv, svv = six
    store_slopes(s, su, sv, out)
    out[3, 0], out[3, 1], out[3, 2] = lane(suu, 0), lane(suu, 1), lane(suu, 2)
    out[4, 0], out[4, 1], out[4, 2] = lane(suv, 0), lane(suv, 1), lane(suv, 2)
    out[5, 0], out[5, 1], out[5, 2] = lane(svv, 0), lane(svv, 1), lane(svv, 2)


@jit_uncounted_inline
def _thirds(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array) -> tuple[Lanes, Lanes]:
    """The mixed third derivatives uuv and uvv of the homogeneous coordinates."""
    (i0, j0), (pu, pv) = first, degree
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
    part = add_scaled(add_scaled(third, -wv, second), -2.0, both)
    whole = add_scaled(add_scaled(part, -wuu, sv), -lane(third, 3), s)
    return add_scaled(second, step, shrink(w, whole))


@jit_uncounted_inline
def extend_six(beyond: tuple[float, float], weights: Six, thirds: tuple[Lanes, Lanes], six: SixLanes) -> SixLanes:
    """The six vectors of the border carried on: S + du Su + dv Sv + du dv Suv, and its derivatives."""
    (du, dv), (w, wu, wv, wuu, wuv, wvv), (s, su, sv, suu, suv, svv) = beyond, weights, six
    uuv, uvv = thirds
    whole = add_scaled(add_scaled(add_scaled(s, du, su), dv, sv), du * dv, suv)
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
        u, v = clamp_parameter(knots_u, 3, uv[k, 0]), clamp_parameter(knots_v, 3, uv[k, 1])
        inside = inside and u == uv[k, 0] and v == uv[k, 1]
        span_u, span_v = find_span(knots_u, 3, u), find_span(knots_v, 3, v)
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
    levels: list[Array] = [np.ones((len(t), 1))]
    for d in range(1, degree + 1):
        previous, row = levels[-1], np.zeros((len(t), d + 1))
        for r in range(d):
            lower, upper = knots[span + 1 + r - d], knots[span + 1 + r]
            share = previous[:, r] / (upper - lower)
            row[:, r] += (upper - t) * share
            row[:, r + 1] += (t - lower) * share
        levels.append(row)
    rows = np.zeros((len(t), 3, degree + 1))
    rows[:, 0] = levels[degree]
    rows[:, 1] = _slopes(knots, degree, span, levels[degree - 1])
    if degree > 1:
        rows[:, 2] = _slopes(knots, degree, span, _slopes(knots, degree - 1, span, levels[degree - 2]))
    return rows, span - degree


def _slopes(knots: Array, d: int, span: NDArray[np.intp], lower: Array) -> Array:
    rows = np.zeros((len(span), d + 1))
    for k in range(d):
        value = d * lower[:, k] / (knots[span + 1 + k] - knots[span + 1 + k - d])
        rows[:, k] -= value
        rows[:, k + 1] += value
    return rows


def surface_derivatives_many_numpy(data: SurfaceData, uv: Array) -> Array:
    """The plain twin of `surface_derivatives_many`, written on whole arrays.

    Parameters and result as there.
    """
    knots_u, knots_v, control, pu, pv, _ = data
    uv = np.asarray(uv, dtype=float)
    inside = np.column_stack([np.clip(uv[:, 0], knots_u[pu], knots_u[-pu - 1]),
                              np.clip(uv[:, 1], knots_v[pv], knots_v[-pv - 1])])
    bu, iu = basis_derivatives_numpy(knots_u, pu, inside[:, 0])
    bv, iv = basis_derivatives_numpy(knots_v, pv, inside[:, 1])
    net = control[(iu[:, None] + np.arange(pu + 1))[:, :, None], (iv[:, None] + np.arange(pv + 1))[:, None, :]]
    h = np.einsum("nai,nbj,nijc->nabc", bu, bv, net)
    return _extend_numpy(*_quotient(h), uv - inside)


def _quotient(h: NDArray[Any]) -> tuple[Array, Array, Array]:
    """The six vectors, Suuv and Suvv of a quotient, from the table h[n, a, b, xyzw] of its parts' derivatives."""
    w = h[..., 3:] / h[:, :1, :1, 3:]
    part = h[..., :3] / h[:, :1, :1, 3:]
    wu, wv, wuu, wuv, wvv = w[:, 1, 0], w[:, 0, 1], w[:, 2, 0], w[:, 1, 1], w[:, 0, 2]
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
    du, dv = beyond[:, :1], beyond[:, 1:]
    s, su, sv, suu, suv, svv = (out[:, k] for k in range(6))
    suu_on, svv_on = np.where(du != 0, 0.0 * du, suu + dv * suuv), np.where(dv != 0, 0.0 * dv, svv + du * suvv)
    return np.stack([s + du * su + dv * sv + du * dv * suv, su + dv * suv, sv + du * suv, suu_on, suv, svv_on], axis=1)
