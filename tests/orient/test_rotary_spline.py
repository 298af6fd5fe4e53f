"""Splines of rotary axes: fixed angles are met, and none that meets them turns less."""

import numpy as np
import pytest
from scipy.interpolate import BSpline
from scipy.optimize import LinearConstraint, minimize

from toolaxis.errors import InvalidInput
from toolaxis.strategies.roughness.rotary_spline import RotarySpline, basis, even_knots, rates, smoothest


def _pass(seed: int, n: int = 60):
    rng = np.random.default_rng(seed)
    places = np.sort(np.concatenate([[0.0, 1.0], rng.uniform(0, 1, n - 2)]))
    durations = rng.uniform(0.02, 0.2, n - 1)
    fixed = places[[0, n // 4, n // 2, 3 * n // 4, n - 1]]
    return places, durations, fixed, rng.normal(size=(5, 2))


@pytest.mark.parametrize("seed", range(20))
def test_fixed_angles_are_met_and_nothing_that_meets_them_turns_less(seed: int) -> None:
    places, durations, at, angles = _pass(seed)
    knots = even_knots(0.0, 1.0, 16)
    found = smoothest(knots, places, durations, (at, angles))
    assert np.abs(found.angles(at) - angles).max() < 1e-9
    least = found.cost(places, durations)
    # Everything that is left free: the null space of the fixed places.
    free = np.linalg.svd(basis(knots, at))[2][len(at):].T
    rng = np.random.default_rng(seed)
    for size in (1e-3, 0.1, 1.0):
        other = RotarySpline(knots, found.control + size * free @ rng.normal(size=(free.shape[1], 2)))
        assert np.abs(other.angles(at) - angles).max() < 1e-9 and other.cost(places, durations) > least
    slope = free.T @ rates(knots, places, durations).T @ found.velocities(places, durations)
    assert np.abs(slope).max() < 1e-7 * np.sqrt(least) * np.abs(rates(knots, places, durations)).max()


@pytest.mark.filterwarnings("ignore:Singular Jacobian")
@pytest.mark.parametrize("seed", range(3))
def test_a_general_solver_finds_the_same(seed: int) -> None:
    places, durations, at, angles = _pass(50 + seed, 24)
    knots = even_knots(0.0, 1.0, 9)
    low = np.quantile(angles, 0.2)
    forms = np.zeros((24, 2, 9))
    forms[:, 1] = basis(knots, places)
    held = angles.copy()
    held[:, 1] = np.maximum(held[:, 1], low)
    found = smoothest(knots, places, durations, (at, held), (forms, np.full(24, low)))

    least = found.cost(places, durations)
    d = np.diff(BSpline(knots, np.eye(9), 3)(places), axis=0) / durations[:, None]
    rows, value, there = np.kron(np.eye(2), d), BSpline(knots, np.eye(9), 3)(places), BSpline(knots, np.eye(9), 3)(at)
    half, pinned = np.hstack([np.zeros((24, 9)), value]), np.kron(np.eye(2), there)
    general = minimize(lambda x: ((rows @ x) ** 2).sum() / least, np.zeros(18), method="trust-constr",
                       jac=lambda x: 2 * rows.T @ (rows @ x) / least, hess=lambda x: 2 * rows.T @ rows / least,
                       constraints=[LinearConstraint(pinned, held.T.ravel(), held.T.ravel()),
                                    LinearConstraint(half, low, np.inf)],
                       options={"gtol": 1e-10, "xtol": 1e-13, "maxiter": 3000})
    assert general.constr_violation < 1e-6
    assert np.abs(found.angles(at) - held).max() < 1e-9
    assert found.angles(places)[:, 1].min() > low - 1e-9
    assert general.fun == pytest.approx(1.0, rel=1e-5) and general.fun > 1 - 1e-6


def test_between_two_fixed_ends_the_axes_turn_evenly() -> None:
    places, durations = np.linspace(0, 1, 50), np.full(49, 0.1)
    found = smoothest(even_knots(0.0, 1.0, 12), places, durations, ([0.0, 1.0], [[0.2, 1.0], [0.7, -1.0]]))
    assert np.abs(found.angles(places) - np.column_stack([0.2 + 0.5 * places, 1 - 2 * places])).max() < 1e-12
    assert found.cost(places, durations) == pytest.approx(49 * ((0.5 / 4.9) ** 2 + (2 / 4.9) ** 2), rel=1e-12)


def test_the_stacked_least_squares_of_the_paper_misses_fixed_angles() -> None:
    # Its Eq. (26) solves the conditions of the least sum and the fixed angles together, in the mean.
    places, durations, at, angles = _pass(7)
    knots = even_knots(0.0, 1.0, 16)
    d, held = rates(knots, places, durations), basis(knots, at)
    stacked = np.linalg.lstsq(np.vstack([d.T @ d, held]), np.append(np.zeros(16), angles[:, 0]), rcond=None)[0]
    assert np.degrees(np.abs(held @ stacked - angles[:, 0]).max()) > 1.0
    assert np.abs(smoothest(knots, places, durations, (at, angles)).angles(at) - angles).max() < 1e-9


def test_bad_input() -> None:
    places, durations, at, angles = _pass(1)
    knots = even_knots(0.0, 1.0, 8)
    with pytest.raises(InvalidInput, match="contradict each other"):
        smoothest(even_knots(0.0, 1.0, 4), places, durations, (at, angles))
    with pytest.raises(InvalidInput, match="times above zero"):
        smoothest(knots, places, -durations, (at, angles))
    with pytest.raises(InvalidInput, match="one at least"):
        smoothest(knots, places, durations, ([], np.empty((0, 2))))
    with pytest.raises(InvalidInput, match="a cubic needs 4"):
        even_knots(0.0, 1.0, 3)
