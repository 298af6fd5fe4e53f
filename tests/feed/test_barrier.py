"""The compiled barrier of path speeds against its numpy twin and scipy's solver of banded systems."""

import numpy as np
import pytest
from scipy.linalg import solveh_banded

from toolaxis.feed import interior_point as barrier
from toolaxis.feed.interior_point import SpeedProblem, greatest_speeds, system_numpy, value_numpy
from toolaxis.feed.interior_point_compiled import barrier_system, barrier_value, solve_pentadiagonal
from toolaxis.numeric import jit as compiled


def _problem(seed: int, n: int = 60, axes: int = 5) -> tuple[SpeedProblem, np.ndarray]:
    """Random forms, and squared speeds that keep all limits."""
    rng = np.random.default_rng(seed)
    problem = SpeedProblem(np.cumsum(rng.uniform(0.2, 2.0, n)), rng.uniform(1.0, 9.0, n),
                           rng.normal(size=(n - 1, axes, 2)), rng.normal(size=(n, axes, 3)))
    problem.jerk[0, :, 0] = problem.jerk[-1, :, 2] = 0.0
    b = rng.uniform(0.1, 0.9, n)
    while not problem.feasible(b):
        b = b / 2
    return problem, b


def _arrays(problem: SpeedProblem) -> tuple[np.ndarray, ...]:
    return problem.stations, problem.most, problem.acceleration, problem.jerk


@pytest.mark.parametrize("n", [2, 3, 60])
def test_compiled_as_numpy(n: int) -> None:
    for seed in range(5):
        problem, b = _problem(seed, n)
        assert barrier_value(*_arrays(problem), b, 3.0) == pytest.approx(value_numpy(problem, b, 3.0), rel=1e-12)
        gradient, bands = np.zeros(n), np.zeros((3, n))
        barrier_system(*_arrays(problem), b, 3.0, gradient, bands)
        other, diagonals = system_numpy(problem, b, 3.0)
        assert np.allclose(gradient, other, rtol=1e-11, atol=1e-11 * np.abs(other).max())
        assert np.allclose(bands, diagonals, rtol=1e-11, atol=1e-11 * np.abs(diagonals).max())


def test_the_gradient_is_that_of_the_value() -> None:
    problem, b = _problem(7, 12)
    gradient, bands = np.zeros(12), np.zeros((3, 12))
    barrier_system(*_arrays(problem), b, 2.0, gradient, bands)
    for i in range(12):
        step = np.zeros(12)
        step[i] = 1e-6 * b[i]
        rise = barrier_value(*_arrays(problem), b + step, 2.0) - barrier_value(*_arrays(problem), b - step, 2.0)
        assert rise / (2 * step[i]) == pytest.approx(gradient[i], rel=1e-4, abs=1e-4 * np.abs(gradient).max())


@pytest.mark.parametrize("change", ["velocity", "acceleration", "jerk", "sign", "nan"])
def test_a_limit_not_kept_is_infinite(change: str) -> None:
    problem, b = _problem(3)
    if change in ("sign", "nan"):
        b[7] = -1e-9 if change == "sign" else np.nan
    else:
        table = {"velocity": problem.most, "acceleration": problem.acceleration, "jerk": problem.jerk}[change]
        table[11] *= 1e-6 if change == "velocity" else 1e6
    assert barrier_value(*_arrays(problem), b, 1.0) == value_numpy(problem, b, 1.0) == np.inf


@pytest.mark.parametrize("n", [1, 2, 3, 40])
def test_five_diagonals_as_scipy(n: int) -> None:
    rng = np.random.default_rng(n)
    bands, right = rng.normal(size=(3, n)), rng.normal(size=n)
    bands[2] = np.abs(bands[2]) + 6
    bands[1, 0] = bands[0, :2] = 0.0
    expected = solveh_banded(bands[-min(n, 3):], right)
    spent, step = bands.copy(), right.copy()
    assert solve_pentadiagonal(spent, step)
    assert np.allclose(step, expected, rtol=1e-12, atol=1e-14)
    bands[2, n // 2] = -1.0
    assert not solve_pentadiagonal(bands.copy(), right.copy())


def test_the_same_speeds_without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, b = _problem(5)
    found = greatest_speeds(problem, b)
    monkeypatch.setattr(compiled, "available", False)
    assert barrier.compiled.available is False
    assert np.allclose(greatest_speeds(problem, b), found, rtol=1e-6)
