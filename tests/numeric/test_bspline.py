"""B-spline kernels against scipy, their numpy twins, difference quotients and the way they must follow a change."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import NdBSpline

from toolaxis.numeric import bspline
from toolaxis.numeric.bspline import (
    basis_derivatives,
    basis_derivatives_numpy,
    find_span,
    surface_derivatives,
    surface_derivatives_many,
    surface_derivatives_many_numpy,
)

ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


def knots_for(rng: np.random.Generator, count: int, degree: int, clamped: bool = True) -> np.ndarray:
    """Uneven knots, some of them repeated, on about [-1, 4]."""
    inner = np.sort(rng.uniform(-1, 4, count - degree - 1))
    if len(inner) > 2 and degree > 1:
        inner[1] = inner[0]
    ends = (np.full(degree + 1, -1.3), np.full(degree + 1, 4.2))
    if not clamped:
        ends = (-1.3 - 0.4 * np.arange(degree + 1)[::-1], 4.2 + 0.3 * np.arange(degree + 1))
    return np.concatenate([ends[0], inner, ends[1]])


def surface(degree: tuple[int, int], rational: bool, clamped: bool = True, seed: int = 0) -> Any:
    rng = np.random.default_rng(seed)
    counts = degree[0] + 5, degree[1] + 4
    weights = rng.uniform(0.5, 2, counts) if rational else np.ones(counts)
    control = np.concatenate([rng.normal(0, 30, (*counts, 3)) * weights[..., None], weights[..., None]], axis=2)
    knots = [knots_for(rng, n, p, clamped) for n, p in zip(counts, degree, strict=True)]
    return knots[0], knots[1], control, degree[0], degree[1], rational


def inside(data: Any, count: int = 200, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    uv = np.column_stack([rng.uniform(k[p], k[-p - 1], count) for k, p in ((data[0], data[3]), (data[1], data[4]))])
    uv[:4] = [(data[0][i], data[1][j]) for i in (data[3], -data[3] - 1) for j in (data[4], -data[4] - 1)]
    return uv


def by_scipy(data: Any, uv: np.ndarray) -> np.ndarray:
    """Quotient rule on scipy's tensor-product splines."""
    knots_u, knots_v, control, pu, pv, _ = data
    spline = NdBSpline((knots_u, knots_v), control, (pu, pv))
    h = {order: spline(uv, nu=list(order)) if order[0] <= pu and order[1] <= pv else np.zeros((len(uv), 4))
         for order in ORDERS}
    w = {order: value[:, 3:] for order, value in h.items()}
    a = {order: value[:, :3] for order, value in h.items()}
    s = a[0, 0] / w[0, 0]
    su, sv = ((a[o] - w[o] * s) / w[0, 0] for o in ((1, 0), (0, 1)))
    suu = (a[2, 0] - 2 * w[1, 0] * su - w[2, 0] * s) / w[0, 0]
    svv = (a[0, 2] - 2 * w[0, 1] * sv - w[0, 2] * s) / w[0, 0]
    suv = (a[1, 1] - w[1, 0] * sv - w[0, 1] * su - w[1, 1] * s) / w[0, 0]
    return np.stack([s, su, sv, suu, suv, svv], axis=1)


def assert_close(found: np.ndarray, wanted: np.ndarray, tolerance: float) -> None:
    """Row k of all six within a share of the greatest entry of that row over all points."""
    scale = np.maximum(np.abs(wanted).max(axis=(0, 2)), 1.0)
    assert (np.abs(found - wanted).max(axis=(0, 2)) / scale).max() <= tolerance


DEGREES = ((3, 3), (2, 2), (1, 1), (1, 2), (3, 1), (2, 3), (5, 5), (3, 7), (9, 2), (25, 1))


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degree", DEGREES)
def test_agrees_with_scipy_and_with_its_twin(degree: tuple[int, int], rational: bool) -> None:
    data = surface(degree, rational)
    uv = inside(data)
    wanted = by_scipy(data, uv)
    assert_close(surface_derivatives_many(data, uv), wanted, 1e-10)
    assert_close(surface_derivatives_many_numpy(data, uv), wanted, 1e-10)


@pytest.mark.parametrize("degree", [(3, 3), (4, 2)])
def test_unclamped_knots(degree: tuple[int, int]) -> None:
    data = surface(degree, True, clamped=False)
    uv = inside(data)
    assert_close(surface_derivatives_many(data, uv), by_scipy(data, uv), 1e-10)


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degree", [(3, 3), (2, 5), (1, 3), (1, 1)])
def test_the_scalar_kernel_is_the_array_one(degree: tuple[int, int], rational: bool) -> None:
    data = surface(degree, rational)
    uv = np.vstack([inside(data, 40), np.random.default_rng(3).uniform(-3, 6, (40, 2))])
    out, work = np.empty((6, 3)), np.empty(bspline.WORK_SHAPE)
    rows = []
    for u, v in uv:
        surface_derivatives(data, u, v, out, work)
        rows.append(out.copy())
    assert_close(np.array(rows), surface_derivatives_many(data, uv), 1e-13)
    assert_close(surface_derivatives_many(data, uv[:40]), np.array(rows[:40]), 1e-13)


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degree", [(3, 3), (2, 4), (1, 2)])
def test_beyond_the_border_derivatives_belong_to_one_continuation(degree: tuple[int, int], rational: bool) -> None:
    data = surface(degree, rational)
    rng = np.random.default_rng(5)
    uv, h = rng.uniform(-2.3, 5.2, (400, 2)), 1e-5
    near = [np.abs(uv[:, i, None] - data[i]).min(axis=1) < 10 * h for i in (0, 1)]
    uv = uv[~near[0] & ~near[1]]
    for evaluate in (surface_derivatives_many, surface_derivatives_many_numpy):
        at, (du, dv) = evaluate(data, uv), ((evaluate(data, uv + s) - evaluate(data, uv - s)) / (2 * h)
                                            for s in ([h, 0.0], [0.0, h]))
        slopes = np.stack([du[:, 0], dv[:, 0], du[:, 1], du[:, 2], dv[:, 2]], axis=1)
        assert_close(slopes, at[:, 1:], 1e-6)
        assert_close(dv[:, 1:2], at[:, 4:5], 1e-6)


def test_the_continuation_is_straight_and_smooth_at_the_border() -> None:
    data = surface((3, 3), True)
    u1 = data[0][-1]
    at, beyond = surface_derivatives_many(data, np.array([[u1, 0.7], [u1 + 2.5, 0.7]]))
    assert beyond[0] == pytest.approx(at[0] + 2.5 * at[1], abs=1e-9)
    assert beyond[1] == pytest.approx(at[1], abs=1e-12)
    assert np.all(beyond[3] == 0.0)
    corner = surface_derivatives_many(data, np.array([[u1, data[1][0]], [u1 + 1.0, data[1][0] - 2.0]]))
    s, su, sv, _, suv, _ = corner[0]
    assert corner[1, 0] == pytest.approx(s + su - 2 * sv - 2 * suv, abs=1e-9)
    assert np.all(corner[1, [3, 5]] == 0.0)


@pytest.mark.parametrize("beyond", [[9.0, 0.0], [0.0, 9.0], [-9.0, 0.0], [0.0, -9.0]])
def test_one_point_outside_changes_no_other(beyond: list[float]) -> None:
    data = surface((3, 3), False)
    uv = inside(data)
    alone = surface_derivatives_many(data, uv)
    together = surface_derivatives_many(data, np.vstack([uv, [beyond]]))
    assert_close(together[:-1], alone, 1e-13)
    assert_close(together[-1:], surface_derivatives_many_numpy(data, np.array([beyond])), 1e-12)


def test_nan_stays_nan_and_nothing_comes_of_nothing() -> None:
    data = surface((3, 3), True)
    for evaluate in (surface_derivatives_many, surface_derivatives_many_numpy):
        table = evaluate(data, np.array([[np.nan, 0.5], [0.5, 0.5], [0.5, np.nan]]))
        assert np.isnan(table[[0, 2]]).all() and np.isfinite(table[1]).all()
        assert evaluate(data, np.empty((0, 2))).shape == (0, 6, 3)


@given(st.integers(1, 9), st.integers(0, 6), st.integers(0, 10**6), st.floats(-1.3, 4.2))
@settings(max_examples=60, deadline=None)
def test_bases_sum_to_one_and_their_derivatives_to_zero(degree: int, more: int, seed: int, t: float) -> None:
    knots = knots_for(np.random.default_rng(seed), degree + 1 + more, degree)
    span, rows = find_span(knots, degree, t), np.empty((3, degree + 1))
    assert knots[span] <= t <= knots[span + 1] and knots[span] < knots[span + 1]
    basis_derivatives(knots, degree, span, t, rows)
    twin, first = basis_derivatives_numpy(knots, degree, np.array([t]))
    scale = np.abs(twin[0]).max(axis=1, keepdims=True) + 1e-300
    assert first[0] == span - degree
    assert (np.abs(rows - twin[0]) / scale).max() < 1e-11
    assert rows[0].sum() == pytest.approx(1.0, abs=1e-12)
    assert np.abs(rows[1:].sum(axis=1) / scale[1:, 0]).max() < 1e-11
    assert (rows[0] >= -1e-15).all()


def test_spans_at_ends_and_at_repeated_knots() -> None:
    knots = np.array([0.0, 0, 0, 1, 1, 2, 3, 3, 3])
    at = (-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 2.9, 3.0, 4.0)
    assert [find_span(knots, 2, t) for t in at] == [2, 2, 2, 4, 4, 5, 5, 5, 5]
    assert [find_span(np.array([0.0, 0, 0, 1, 2, 2, 2, 2]), 2, t) for t in (1.5, 2.0, 3.0)] == [3, 3, 3]


def test_reparametrised_knots_scale_derivatives() -> None:
    data = surface((3, 3), True)
    other = (2.0 * data[0] + 5.0, *data[1:])
    uv = inside(data)
    first, second = surface_derivatives_many(data, uv), surface_derivatives_many(other, uv * [2, 1] + [5, 0])
    assert_close(second * np.array([1, 2, 1, 4, 2, 1])[:, None], first, 1e-11)
