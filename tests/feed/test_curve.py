"""Curved paths: limits kept at every sampled time, and outside oracles for the time."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import linprog

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import AxisBounds
from toolaxis.feed.time_optimal import _problem, schedule_curve

MIKRON = AxisBounds(np.full(3, 500.0), np.array([2500.0, 3000.0, 2100.0]), np.full(3, 5000.0))
Curve = Callable[[np.ndarray], np.ndarray]


def _wave(seed: int) -> np.ndarray:
    """A smooth space curve of some 100 mm."""
    rng, t = np.random.default_rng(seed), np.linspace(0, 1, 200)
    rows = np.stack([100 * t * rng.uniform(0.5, 1), np.zeros_like(t), np.zeros_like(t)], axis=1)
    for k in range(1, 4):
        rows += rng.normal(size=3) * 8 / k**2 * np.sin(np.pi * k * t + rng.uniform(0, 6))[:, None]
    return rows


@pytest.mark.parametrize(("feed", "length"), [(50.0, 100.0), (200.0, 100.0), (np.inf, 100.0), (np.inf, 3.0),
                                              (20.0, 1000.0)])
def test_a_straight_line_takes_as_long_as_the_closed_form(feed: float, length: float) -> None:
    x = np.linspace(0, length, 50)
    points = np.stack([x, 0 * x, 0 * x], axis=1)
    for stations in (400, 1500):
        found = schedule_curve(points, points, feed, MIKRON, stations)
        exact = float(travel_time(length, min(feed, 500.0), 2500.0, 5000.0))
        assert exact * (1 - 1e-9) <= found.duration <= 1.005 * exact


@pytest.mark.parametrize("seed", [0, 1, 2, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(3, 20))])
def test_no_axis_exceeds_a_limit(seed: int) -> None:
    """Finite differences of positions alone, as a judge sees them."""
    points = _wave(seed)
    found = schedule_curve(points, points, 150.0, MIKRON)
    count = 8000
    step = found.duration / count
    q = found.at(np.arange(count + 1) * step)[0]
    for order, limit in enumerate((MIKRON.velocity, MIKRON.acceleration, MIKRON.jerk), start=1):
        assert (np.abs(np.diff(q, order, axis=0)).max(axis=0) / step**order <= limit * 1.002).all()
    assert np.linalg.norm(np.diff(q, axis=0), axis=1).max() / step <= 150.0 * 1.001
    assert np.abs(q[0] - points[0]).max() < 1e-9 and np.abs(q[-1] - points[-1]).max() < 1e-6
    _, v, a, _ = found.at([0.0, found.duration])
    assert np.abs(v).max() < 1e-5 and np.abs(a).max() < 1e-3 and found.stretch < 1.02


@pytest.mark.parametrize("seed", range(3))
def test_without_jerk_as_toppra(seed: int) -> None:
    """With jerk all but free the time is that of velocity and acceleration limits alone."""
    toppra = pytest.importorskip("toppra", reason="toppra is the oracle of velocity and acceleration limits")
    points = _wave(seed)
    loose = AxisBounds(MIKRON.velocity, MIKRON.acceleration, np.full(3, 1e7))
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    velocity, acceleration = (np.stack([-limit, limit], axis=1) for limit in (MIKRON.velocity, MIKRON.acceleration))
    limits = [toppra.constraint.JointVelocityConstraint(velocity),
              toppra.constraint.JointAccelerationConstraint(acceleration)]
    path = toppra.SplineInterpolator(along, points)
    planner = toppra.algorithm.TOPPRA(limits, path, gridpoints=np.linspace(0, along[-1], 500))
    bound = planner.compute_trajectory(0, 0).duration
    free = schedule_curve(points, points, np.inf, loose, 1500).duration
    assert bound * 0.998 < free < 1.03 * bound
    assert schedule_curve(points, points, np.inf, MIKRON).duration > free


def _by_linear_programming(points: np.ndarray, feed: float, count: int = 160, rounds: int = 12) -> float:
    """Least time by linear programs in the squared speed, jerk's root bounded by its tangent; its own stations.

    Next to the ends three stations have the speed of the greatest jerk from rest as their only limit.
    """
    from scipy.interpolate import make_interp_spline

    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    curve = make_interp_spline(along, points, 5)
    half = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    s = along[-1] * half
    q1, q2, q3 = (curve(s, k) for k in (1, 2, 3))
    rows, ends, jerk_rows, where = [], [], [], []
    for i in range(1, count - 1):
        d = s[i - 1:i + 2] - s[i]
        first = np.array([-d[2] / (d[0] * (d[0] - d[2])), 0.0, -d[0] / (d[2] * (d[2] - d[0]))])
        first[1] = -(first[0] + first[2])
        second = 2 / np.array([d[0] * (d[0] - d[2]), d[0] * d[2], d[2] * (d[2] - d[0])])
        here = np.array([0.0, 1.0, 0.0])
        for k in range(3):
            row = np.zeros(count)
            row[i - 1:i + 2] = (q1[i, k] * first / 2 + q2[i, k] * here) / MIKRON.acceleration[k]
            rows += [row, -row]
            ends += [1.0, 1.0]
            if 3 <= i < count - 3:
                row = np.zeros(count)
                row[i - 1:i + 2] = (q1[i, k] * second / 2 + 1.5 * q2[i, k] * first + q3[i, k] * here) / MIKRON.jerk[k]
                jerk_rows += [row, -row]
                where += [i, i]
    most = np.minimum((MIKRON.velocity / np.abs(q1)).min(axis=1), feed) ** 2
    most[[0, -1]] = 0.0
    for ends_at, way in ((slice(1, 4), s[1:4]), (slice(-4, -1), along[-1] - s[-4:-1])):
        fastest = (MIKRON.jerk / np.abs(q1[ends_at])).min()
        most[ends_at] = np.minimum(most[ends_at], fastest ** (2 / 3) * (6 * way) ** (4 / 3) / 4)
    b, best = np.minimum(most, 4.0), np.inf
    for _ in range(rounds):
        b = np.maximum(b, 1e-6)
        tangent = np.array(jerk_rows)
        tangent[np.arange(len(where)), where] += 0.5 * b[where] ** -1.5
        price = np.zeros(count)
        price[1:-1] = (s[2:] - s[:-2])[: count] / b[1:-1] ** 1.5
        found = linprog(-price / price.max(), A_ub=np.concatenate([np.array(rows), tangent]),
                        b_ub=np.concatenate([ends, 1.5 * b[where] ** -0.5]), bounds=np.stack([0 * most, most], axis=1))
        b = found.x
        v = np.sqrt(np.maximum(b, 0))
        best = min(best, float((2 * np.diff(s) / np.maximum(v[1:] + v[:-1], 1e-9)).sum()))
    return best


@pytest.mark.parametrize("seed", range(3))
def test_with_jerk_as_linear_programming(seed: int) -> None:
    points = _wave(seed)
    other = _by_linear_programming(points, 150.0)
    assert 0.95 * other < schedule_curve(points, points, 150.0, MIKRON).duration < 1.03 * other


def test_the_differences_are_the_derivatives() -> None:
    """Accelerations and jerks of a known speed, on stations that are not evenly apart, against the chain rule."""
    from scipy.interpolate import make_interp_spline

    points = _wave(2)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    curve = make_interp_spline(along, points, 5)
    s = along[-1] * np.linspace(0.05, 0.98, 3000) ** 1.5
    problem = _problem(s, curve, curve, 150.0, MIKRON)
    inner = problem.stations
    b, first, second = (400 * np.cos(inner / 30 + k * np.pi / 2) / 30**k + (600 if k == 0 else 0) for k in range(3))
    acceleration, jerk = problem.forms(b)
    q = [curve(inner, k) for k in (1, 2, 3)]
    exact = q[0] * first[:, None] / 2 + q[1] * b[:, None]
    middle = (exact[1:] + exact[:-1]) / 2
    assert np.abs(acceleration * 0.999 * MIKRON.acceleration - middle).max() < 1e-3 * np.abs(exact).max()
    exact = q[0] * second[:, None] / 2 + 1.5 * q[1] * first[:, None] + q[2] * b[:, None]
    assert np.abs(jerk * 0.999 * MIKRON.jerk - exact)[1:-1].max() < 2e-2 * np.abs(exact).max()


def test_two_rotary_axes_too() -> None:
    """Five axes along a curve: the planner does not ask what an axis is."""
    points = _wave(1)
    t = np.linspace(0, 1, len(points))
    joints = np.column_stack([points, 0.3 * np.sin(2 * t), 0.5 * t**2])
    bounds = AxisBounds(np.append(MIKRON.velocity, (1.5, 2.0)), np.append(MIKRON.acceleration, (5.0, 5.0)),
                        np.append(MIKRON.jerk, (30.0, 300.0)))
    found = schedule_curve(joints, points, 150.0, bounds)
    q = found.at(np.linspace(0, found.duration, 3000))
    for size, limit in zip(q[1:], (bounds.velocity, bounds.acceleration, bounds.jerk), strict=True):
        assert (np.abs(size).max(axis=0) <= limit * (1 + 1e-3)).all()
    assert found.duration > schedule_curve(points, points, 150.0, MIKRON).duration * (1 - 1e-3)


@pytest.mark.parametrize(("change", "said"), [
    ({"points": np.zeros((5, 3)), "tips": np.zeros((5, 3))}, "six or more"), ({"feed": 0.0}, "feed is 0"),
    ({"tips": np.zeros((9, 3))}, "coincide"), ({"points": np.zeros((8, 3))}, "8 joint positions for 9 tips"),
    ({"points": np.full((9, 3), np.inf)}, "finite"), ({"feed": np.nan}, "feed is nan"),
])
def test_bad_input(change: dict[str, object], said: str) -> None:
    points = _wave(0)[:9]
    with pytest.raises(InvalidInput, match=said):
        schedule_curve(**{"points": points, "tips": points, "feed": 10.0, "bounds": MIKRON, **change})  # type: ignore[arg-type]
