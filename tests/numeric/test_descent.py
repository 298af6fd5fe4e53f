"""Downhill on functions whose lowest place is known."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from toolaxis.numeric.descent import descend

Array = NDArray[np.float64]


@pytest.mark.parametrize("seed", range(6))
def test_the_lowest_place_of_a_paraboloid_is_the_solution_of_its_equations(seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(40, 40))
    matrix, aim = half @ half.T + np.eye(40), rng.normal(size=40)

    def paraboloid(x: Array) -> tuple[float, Array]:
        return float(0.5 * x @ matrix @ x - aim @ x), matrix @ x - aim

    value, place = descend(paraboloid, np.zeros(40), 400)
    exact = np.linalg.solve(matrix, aim)
    assert value == pytest.approx(-0.5 * aim @ exact, rel=1e-6)
    assert place == pytest.approx(exact, abs=1e-2)


def test_a_bent_valley_is_followed_and_the_value_never_rises() -> None:
    """Rosenbrock's function in ten pairs: least at 1."""
    seen: list[float] = []

    def valley(x: Array) -> tuple[float, Array]:
        a, b = x[::2], x[1::2]
        slope = np.empty_like(x)
        slope[::2], slope[1::2] = -400 * a * (b - a**2) - 2 * (1 - a), 200 * (b - a**2)
        return float((100 * (b - a**2) ** 2 + (1 - a) ** 2).sum()), slope

    start = np.tile([-1.2, 1.0], 10)
    for rounds in (1, 5, 20, 80, 300):
        seen.append(descend(valley, start, rounds)[0])
    assert all(later <= earlier for earlier, later in pairwise(seen))
    assert seen[-1] < 1e-6


def test_a_function_that_breaks_off_is_drawn_back_from_and_a_flat_one_is_left_alone() -> None:
    def broken(x: Array) -> tuple[float, Array]:
        return (float(x[0] - np.log(x[0])), 1 - 1 / x) if x[0] > 0 else (np.inf, x)

    assert descend(broken, np.array([1e-3]), 200)[1] == pytest.approx([1.0], abs=1e-3)
    assert descend(lambda x: (3.0, np.zeros_like(x)), np.ones(3), 10) == (3.0, pytest.approx(np.ones(3)))
