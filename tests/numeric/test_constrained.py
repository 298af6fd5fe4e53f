"""Least squares under equations and inequalities: the conditions of the least one, and a general solver."""

import numpy as np
import pytest
from scipy.optimize import minimize

from toolaxis.errors import InvalidInput
from toolaxis.numeric.constrained_least_squares import constrained_least_squares


def _problem(seed: int, n: int = 7, e: int = 2, m: int = 12):
    rng = np.random.default_rng(seed)
    a, b, c = rng.normal(size=(n + 4, n)), rng.normal(size=n + 4), rng.normal(size=(e, n))
    inside = rng.normal(size=n)
    g = rng.normal(size=(m, n))
    return a, b, (c, c @ inside), (g, g @ inside - rng.uniform(0, 0.3, m))


@pytest.mark.parametrize("seed", range(40))
def test_the_conditions_of_the_least_one_hold(seed: int) -> None:
    a, b, (c, d), (g, h) = _problem(seed)
    x = constrained_least_squares(a, b, (c, d), (g, h))
    assert np.abs(c @ x - d).max() < 1e-11
    slack = g @ x - h
    assert slack.min() > -1e-9
    # The gradient is a combination of the equations and, with no negative weight, of the inequalities that are met.
    active = slack < 1e-8
    gradient = a.T @ (a @ x - b)
    weights = np.linalg.lstsq(np.vstack([c, g[active]]).T, gradient, rcond=None)[0]
    assert np.abs(np.vstack([c, g[active]]).T @ weights - gradient).max() < 1e-8
    assert weights[len(c):].min(initial=0.0) > -1e-8


@pytest.mark.parametrize("seed", range(6))
def test_a_general_solver_finds_nothing_less(seed: int) -> None:
    a, b, (c, d), (g, h) = _problem(100 + seed)
    x = constrained_least_squares(a, b, (c, d), (g, h))
    found = minimize(lambda y: ((a @ y - b) ** 2).sum(), np.zeros(a.shape[1]), jac=lambda y: 2 * a.T @ (a @ y - b),
                     constraints=[{"type": "eq", "fun": lambda y: c @ y - d, "jac": lambda y: c},
                                  {"type": "ineq", "fun": lambda y: g @ y - h, "jac": lambda y: g}],
                     method="SLSQP", options={"ftol": 1e-11, "maxiter": 500})
    assert found.success
    assert ((a @ x - b) ** 2).sum() == pytest.approx(found.fun, rel=1e-7)
    assert np.abs(x - found.x).max() < 1e-4


def test_inequalities_that_do_not_bind_change_nothing() -> None:
    a, b, equal, _ = _problem(3)
    plain = constrained_least_squares(a, b, equal)
    loose = constrained_least_squares(a, b, equal, (np.eye(7), np.full(7, -1e3)))
    assert np.abs(plain - loose).max() < 1e-10


def test_what_contradicts_itself_is_told() -> None:
    with pytest.raises(InvalidInput, match="contradict each other"):
        constrained_least_squares(np.eye(2), [0, 0], ([[1, 0], [1, 0]], [1, 2]))
    with pytest.raises(InvalidInput, match="contradict each other"):
        constrained_least_squares(np.eye(2), [0, 0], None, ([[1, 0], [-1, 0]], [1, 1]))
    with pytest.raises(InvalidInput, match="can be met by nothing"):
        constrained_least_squares(np.eye(2), [0, 0], None, ([[0, 0], [1, 0]], [1, 0]))
    with pytest.raises(InvalidInput, match="leave nothing free"):
        constrained_least_squares(np.eye(1), [0], ([[1]], [1]), ([[1]], [2]))
    with pytest.raises(InvalidInput, match="several solutions are least"):
        constrained_least_squares([[1, 0]], [0], None, ([[1, 1]], [1]))
