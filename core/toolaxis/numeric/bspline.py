"""Tensor-product rational B-splines: position and the five derivatives up to the second order.

A surface is a tuple ``(knots_u, knots_v, control, degree_u, degree_v, rational)`` with homogeneous control points
``control`` (nu, nv, 4) = (w x, w y, w z, w).  Outside its domain it goes on straight ahead: linearly in the parameter
that was crossed.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_fma, jit_fma_inline

Array = NDArray[np.float64]
SurfaceData: TypeAlias = tuple[Array, Array, Array, int, int, bool]
Four: TypeAlias = tuple[float, float, float, float]
Six: TypeAlias = tuple[float, float, float, float, float, float]

MAX_DEGREE = 25
WORK_SHAPE = (6, MAX_DEGREE + 1)


@jit_fma_inline
def find_span(knots: Array, degree: int, t: float) -> int:
    """Index i with knots[i] <= t < knots[i + 1], the last non-empty span at the upper end.

    Halves the range without branching on the outcome, which random parameters would make unpredictable.
    """
    low = degree
    size: int = knots.shape[0] - 2 * degree - 1
    while size > 1:
        half = size >> 1
        low = low + half if knots[low + half] <= t else low
        size -= half
    while low > degree and knots[low] >= knots[low + 1]:
        low -= 1
    return low


@jit_fma
def basis_derivatives(knots: Array, degree: int, span: int, t: float, rows: Array) -> None:
    """Basis functions and their first two derivatives at t into rows[0:3, 0:degree+1].

    **Source**: Cox and de Boor's recursion; derivatives from the bases of degree - 1 and degree - 2.
    """
    _basis(knots, (degree, span), t, rows, 0)


@jit_fma_inline
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


@jit_fma_inline
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


@jit
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
    knots_u, knots_v, control, pu, pv, rational = data
    uc = _clamp_parameter(knots_u, pu, u)
    vc = _clamp_parameter(knots_v, pv, v)
    span_u = find_span(knots_u, pu, uc)
    span_v = find_span(knots_v, pv, vc)
    _basis(knots_u, (pu, span_u), uc, work, 0)
    _basis(knots_v, (pv, span_v), vc, work, 3)
    _patch(control, (span_u - pu, span_v - pv), (pu, pv), work, out)
    weights = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if rational:
        weights = _weights(control, (span_u - pu, span_v - pv), (pu, pv), work)
        _divide(weights, out)
    if u != uc or v != vc:
        thirds = _thirds(control, (span_u - pu, span_v - pv), (pu, pv), work)
        _extend((u - uc, v - vc), weights, thirds, out)


@jit_fma_inline
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
    uc, vc = _clamp_parameter(knots_u, pu, u), _clamp_parameter(knots_v, pv, v)
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


@jit_fma_inline
def _clamp_parameter(knots: Array, degree: int, t: float) -> float:
    """The nearest parameter in the domain; NaN stays NaN."""
    if t < knots[degree]:
        return float(knots[degree])
    if t > knots[knots.shape[0] - degree - 1]:
        return float(knots[knots.shape[0] - degree - 1])
    return t


@jit_fma_inline
def _patch(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array, out: Array) -> None:
    """Contract the first three homogeneous coordinates; every sum is kept in a register."""
    (i0, j0), (pu, pv) = first, degree
    s0 = s1 = s2 = su0 = su1 = su2 = sv0 = sv1 = sv2 = 0.0
    suu0 = suu1 = suu2 = suv0 = suv1 = suv2 = svv0 = svv1 = svv2 = 0.0
    for i in range(pu + 1):
        a0 = a1 = a2 = b0 = b1 = b2 = c0 = c1 = c2 = 0.0
        for j in range(pv + 1):
            x, y, z = control[i0 + i, j0 + j, 0], control[i0 + i, j0 + j, 1], control[i0 + i, j0 + j, 2]
            p, q, r = work[3, j], work[4, j], work[5, j]
            a0, a1, a2 = a0 + p * x, a1 + p * y, a2 + p * z
            b0, b1, b2 = b0 + q * x, b1 + q * y, b2 + q * z
            c0, c1, c2 = c0 + r * x, c1 + r * y, c2 + r * z
        p, q, r = work[0, i], work[1, i], work[2, i]
        s0, s1, s2 = s0 + p * a0, s1 + p * a1, s2 + p * a2
        su0, su1, su2 = su0 + q * a0, su1 + q * a1, su2 + q * a2
        sv0, sv1, sv2 = sv0 + p * b0, sv1 + p * b1, sv2 + p * b2
        suu0, suu1, suu2 = suu0 + r * a0, suu1 + r * a1, suu2 + r * a2
        suv0, suv1, suv2 = suv0 + q * b0, suv1 + q * b1, suv2 + q * b2
        svv0, svv1, svv2 = svv0 + p * c0, svv1 + p * c1, svv2 + p * c2
    out[0, 0], out[0, 1], out[0, 2] = s0, s1, s2
    out[1, 0], out[1, 1], out[1, 2] = su0, su1, su2
    out[2, 0], out[2, 1], out[2, 2] = sv0, sv1, sv2
    out[3, 0], out[3, 1], out[3, 2] = suu0, suu1, suu2
    out[4, 0], out[4, 1], out[4, 2] = suv0, suv1, suv2
    out[5, 0], out[5, 1], out[5, 2] = svv0, svv1, svv2


@jit_fma_inline
def _weights(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array) -> Six:
    """The weight and its five derivatives."""
    (i0, j0), (pu, pv) = first, degree
    w = wu = wv = wuu = wuv = wvv = 0.0
    for i in range(pu + 1):
        a = b = c = 0.0
        for j in range(pv + 1):
            x = control[i0 + i, j0 + j, 3]
            a, b, c = a + work[3, j] * x, b + work[4, j] * x, c + work[5, j] * x
        p, q, r = work[0, i], work[1, i], work[2, i]
        w, wu, wv = w + p * a, wu + q * a, wv + p * b
        wuu, wuv, wvv = wuu + r * a, wuv + q * b, wvv + p * c
    return w, wu, wv, wuu, wuv, wvv


@jit_fma_inline
def _divide(weights: Six, out: Array) -> None:
    w, wu, wv, wuu, wuv, wvv = weights
    share = 1.0 / w
    for c in range(3):
        s = out[0, c] * share
        su = (out[1, c] - wu * s) * share
        sv = (out[2, c] - wv * s) * share
        out[3, c] = (out[3, c] - 2.0 * wu * su - wuu * s) * share
        out[4, c] = (out[4, c] - wu * sv - wv * su - wuv * s) * share
        out[5, c] = (out[5, c] - 2.0 * wv * sv - wvv * s) * share
        out[0, c] = s
        out[1, c] = su
        out[2, c] = sv


@jit_fma_inline
def _thirds(control: Array, first: tuple[int, int], degree: tuple[int, int], work: Array) -> tuple[Four, Four]:
    """The mixed third derivatives uuv and uvv of the four homogeneous coordinates."""
    (i0, j0), (pu, pv) = first, degree
    x = y = z = w = x2 = y2 = z2 = w2 = 0.0
    for i in range(pu + 1):
        for j in range(pv + 1):
            p, q = work[2, i] * work[4, j], work[1, i] * work[5, j]
            a, b = control[i0 + i, j0 + j, 0], control[i0 + i, j0 + j, 1]
            c, d = control[i0 + i, j0 + j, 2], control[i0 + i, j0 + j, 3]
            x, y, z, w = x + p * a, y + p * b, z + p * c, w + p * d
            x2, y2, z2, w2 = x2 + q * a, y2 + q * b, z2 + q * c, w2 + q * d
    return (x, y, z, w), (x2, y2, z2, w2)


@jit_fma_inline
def _extend(beyond: tuple[float, float], weights: Six, thirds: tuple[Four, Four], out: Array) -> None:
    """Carry the six vectors of the border on: S + du Su + dv Sv + du dv Suv, and its derivatives."""
    (du, dv), (w, wu, wv, wuu, wuv, wvv), (uuv, uvv) = beyond, weights, thirds
    for c in range(3):
        s, su, sv, suu, suv, svv = out[0, c], out[1, c], out[2, c], out[3, c], out[4, c], out[5, c]
        suuv = (uuv[c] - wv * suu - 2.0 * (wu * suv + wuv * su) - wuu * sv - uuv[3] * s) / w
        suvv = (uvv[c] - wu * svv - 2.0 * (wv * suv + wuv * sv) - wvv * su - uvv[3] * s) / w
        out[0, c] = s + du * su + dv * sv + du * dv * suv
        out[1, c] = su + dv * suv
        out[2, c] = sv + du * suv
        out[3, c] = suu + dv * suuv if du == 0.0 else 0.0 * du
        out[5, c] = svv + du * suvv if dv == 0.0 else 0.0 * dv


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
        u, v = _clamp_parameter(knots_u, 3, uv[k, 0]), _clamp_parameter(knots_v, 3, uv[k, 1])
        inside = inside and u == uv[k, 0] and v == uv[k, 1]
        span_u, span_v = find_span(knots_u, 3, u), find_span(knots_v, 3, v)
        _cubic(knots_u, span_u, u, work, 0)
        _cubic(knots_v, span_v, v, work, 3)
        _patch(control, (span_u - 3, span_v - 3), (3, 3), work, out[k])
        if rational:
            _divide(_weights(control, (span_u - 3, span_v - 3), (3, 3), work), out[k])
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
