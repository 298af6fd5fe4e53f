"""Tensor-product rational B-splines: position and the five derivatives up to the second order.

A surface is a tuple ``(knots_u, knots_v, control, degree_u, degree_v, rational)`` with homogeneous control points
``control`` (nu, nv, 4) = (w x, w y, w z, w).  Outside its domain it goes on straight ahead: linearly in the parameter
that was crossed.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import compiled as _compiled
from toolaxis.numeric.compiled import compiled

Array = NDArray[np.float64]
SurfaceData: TypeAlias = tuple[Array, Array, Array, int, int, bool]

MAX_DEGREE = 25
WORK_SHAPE = (6, MAX_DEGREE + 1)


@compiled
def find_span(knots: Array, degree: int, t: float) -> int:
    """Index i with knots[i] <= t < knots[i + 1], the last non-empty span at the upper end."""
    low = degree
    high = knots.shape[0] - degree - 1
    if t >= knots[high]:
        while knots[high - 1] >= knots[high]:
            high -= 1
        return high - 1
    if t <= knots[low]:
        while knots[low + 1] <= knots[low]:
            low += 1
        return low
    while high - low > 1:
        middle = (low + high) // 2
        if t < knots[middle]:
            high = middle
        else:
            low = middle
    return low


@compiled
def basis_derivatives(knots: Array, degree: int, span: int, t: float, rows: Array) -> None:
    """Basis functions and their first two derivatives at t into rows[0:3, 0:degree+1].

    **Source**: Cox and de Boor's recursion; derivatives from the bases of degree - 1 and degree - 2.
    """
    for k in range(degree + 1):
        rows[1, k] = 0.0
        rows[2, k] = 0.0
    rows[0, 0] = 1.0
    for d in range(1, degree + 1):
        if d == degree:
            _differentiate(knots, d, span, rows, 0, 1)
            if degree > 1:
                _differentiate(knots, d, span, rows, 2, 2)
        elif d == degree - 1:
            _differentiate(knots, d, span, rows, 0, 2)
        saved = 0.0
        for r in range(d):
            upper = knots[span + 1 + r]
            lower = knots[span + 1 + r - d]
            share = rows[0, r] / (upper - lower)
            rows[0, r] = saved + (upper - t) * share
            saved = (t - lower) * share
        rows[0, d] = saved


@compiled
def _differentiate(knots: Array, d: int, span: int, rows: Array, source: int, target: int) -> None:
    previous = 0.0
    for k in range(d + 1):
        value = 0.0
        if k < d:
            value = rows[source, k] / (knots[span + 1 + k] - knots[span + 1 + k - d])
        rows[target, k] = d * (previous - value)
        previous = value


@compiled
def surface_derivatives(data: SurfaceData, u: float, v: float, out: Array, work: Array) -> None:
    """S, Su, Sv, Suu, Suv, Svv at one (u, v).

    Parameters
    ----------
    data : tuple
        The surface.
    u, v : float
        Parameters; outside the domain the surface goes on linearly (second derivatives there are those of the
        border, zero in the crossed parameter).
    out : (6, 3) array
        Receives the six vectors.
    work : (6, 26) array
        Scratch.
    """
    knots_u, knots_v, control, pu, pv, rational = data
    uc = min(max(u, knots_u[pu]), knots_u[knots_u.shape[0] - pu - 1])
    vc = min(max(v, knots_v[pv]), knots_v[knots_v.shape[0] - pv - 1])
    span_u = find_span(knots_u, pu, uc)
    span_v = find_span(knots_v, pv, vc)
    bu = work[0:3]
    bv = work[3:6]
    basis_derivatives(knots_u, pu, span_u, uc, bu)
    basis_derivatives(knots_v, pv, span_v, vc, bv)
    for c in range(3):
        _contract(control, span_u - pu, span_v - pv, pu, pv, bu, bv, c, out)
    if rational:
        _divide(control, span_u - pu, span_v - pv, pu, pv, bu, bv, out)
    if u != uc or v != vc:
        _extend(u - uc, v - vc, out)


@compiled
def _contract(control: Array, i0: int, j0: int, pu: int, pv: int, bu: Array, bv: Array, c: int, out: Array) -> None:
    s = su = sv = suu = suv = svv = 0.0
    for j in range(pv + 1):
        a0 = a1 = a2 = 0.0
        for i in range(pu + 1):
            x = control[i0 + i, j0 + j, c]
            a0 += bu[0, i] * x
            a1 += bu[1, i] * x
            a2 += bu[2, i] * x
        s += bv[0, j] * a0
        su += bv[0, j] * a1
        sv += bv[1, j] * a0
        suu += bv[0, j] * a2
        suv += bv[1, j] * a1
        svv += bv[2, j] * a0
    out[0, c] = s
    out[1, c] = su
    out[2, c] = sv
    out[3, c] = suu
    out[4, c] = suv
    out[5, c] = svv


@compiled
def _divide(control: Array, i0: int, j0: int, pu: int, pv: int, bu: Array, bv: Array, out: Array) -> None:
    w = wu = wv = wuu = wuv = wvv = 0.0
    for j in range(pv + 1):
        a0 = a1 = a2 = 0.0
        for i in range(pu + 1):
            x = control[i0 + i, j0 + j, 3]
            a0 += bu[0, i] * x
            a1 += bu[1, i] * x
            a2 += bu[2, i] * x
        w += bv[0, j] * a0
        wu += bv[0, j] * a1
        wv += bv[1, j] * a0
        wuu += bv[0, j] * a2
        wuv += bv[1, j] * a1
        wvv += bv[2, j] * a0
    for c in range(3):
        s = out[0, c] / w
        su = (out[1, c] - wu * s) / w
        sv = (out[2, c] - wv * s) / w
        out[3, c] = (out[3, c] - 2.0 * wu * su - wuu * s) / w
        out[4, c] = (out[4, c] - wu * sv - wv * su - wuv * s) / w
        out[5, c] = (out[5, c] - 2.0 * wv * sv - wvv * s) / w
        out[0, c] = s
        out[1, c] = su
        out[2, c] = sv


@compiled
def _extend(du: float, dv: float, out: Array) -> None:
    for c in range(3):
        su, sv, suv = out[1, c], out[2, c], out[4, c]
        out[0, c] += du * su + dv * sv + du * dv * suv
        out[1, c] = su + dv * suv
        out[2, c] = sv + du * suv
        if du != 0.0:
            out[3, c] = 0.0
        if dv != 0.0:
            out[5, c] = 0.0


@compiled
def _many(data: SurfaceData, uv: Array, out: Array) -> None:
    work = np.empty((6, 26))
    for k in range(uv.shape[0]):
        surface_derivatives(data, uv[k, 0], uv[k, 1], out[k], work)


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
    out = np.empty((len(uv), 6, 3))
    _many(data, np.ascontiguousarray(uv, dtype=float), out)
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
    out = _quotient(h)
    return _extend_numpy(out, uv - inside)


def _quotient(h: NDArray[Any]) -> Array:
    w = h[..., 3:]
    s = h[:, 0, 0, :3] / w[:, 0, 0]
    su = (h[:, 1, 0, :3] - w[:, 1, 0] * s) / w[:, 0, 0]
    sv = (h[:, 0, 1, :3] - w[:, 0, 1] * s) / w[:, 0, 0]
    suu = (h[:, 2, 0, :3] - 2 * w[:, 1, 0] * su - w[:, 2, 0] * s) / w[:, 0, 0]
    suv = (h[:, 1, 1, :3] - w[:, 1, 0] * sv - w[:, 0, 1] * su - w[:, 1, 1] * s) / w[:, 0, 0]
    svv = (h[:, 0, 2, :3] - 2 * w[:, 0, 1] * sv - w[:, 0, 2] * s) / w[:, 0, 0]
    return np.stack([s, su, sv, suu, suv, svv], axis=1)


def _extend_numpy(out: Array, beyond: Array) -> Array:
    du, dv = beyond[:, :1], beyond[:, 1:]
    su, sv, suv = out[:, 1].copy(), out[:, 2].copy(), out[:, 4]
    out[:, 0] += du * su + dv * sv + du * dv * suv
    out[:, 1] = su + dv * suv
    out[:, 2] = sv + du * suv
    out[:, 3] = np.where(du != 0, 0.0, out[:, 3])
    out[:, 5] = np.where(dv != 0, 0.0, out[:, 5])
    return out
