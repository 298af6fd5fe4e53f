"""The free angle over a face: as wide as brute force finds, as smooth as a general solver, and never through walls."""

from itertools import pairwise, product

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from toolaxis.strategies.four_plus_one import free_angle
from toolaxis.strategies.four_plus_one.free_angle import SingularSides, bands, narrowest, smoothest, widest

ANGLES = np.radians(np.linspace(-10, 10, 5))


def _price(widths, chosen, gates=None):
    """What dynamic programming makes least on one pass, written again."""
    width = widths[list(chosen), np.arange(len(chosen))]
    if (width <= 0).any():
        return np.inf
    turn = np.diff(ANGLES[list(chosen)]) / free_angle._TENTH
    least = widths.max(axis=0).min()
    for i, (a, b) in enumerate(pairwise(chosen)):
        low, high = min(a, b), max(a, b)
        if ((widths[low:high + 1, i] <= 0) & (widths[low:high + 1, i + 1] <= 0)).any():
            return np.inf
        below = [gates.at[n, 0] <= ANGLES[j] for n, j in ((i, a), (i + 1, b))] if gates is not None else [True, True]
        if below[0] != below[1] and gates.shut[i:i + 2].any():
            return np.inf
    return float(((least / width) ** free_angle._POWER).sum() + free_angle._ALONG * (turn**2).sum())


@pytest.mark.parametrize("seed", range(12))
def test_one_pass_is_that_of_brute_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    widths = rng.uniform(0.2, 1.0, (5, 4)) * (rng.random((5, 4)) > 0.25)
    rows = sorted((_price(widths, chosen), chosen) for chosen in product(range(5), repeat=4))
    found = widest(widths[:, :, None], ANGLES)
    if not np.isfinite(rows[0][0]):
        assert found is None
    else:
        assert found is not None and _price(widths, found[:, 0]) == pytest.approx(rows[0][0], rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_one_pass_between_gates_is_that_of_brute_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    widths = rng.uniform(0.2, 1.0, (5, 4)) * (rng.random((5, 4)) > 0.1)
    gates = SingularSides(rng.uniform(-0.15, 0.15, (4, 1)), rng.random((4, 1)) > 0.4)
    least = min(_price(widths, chosen, gates) for chosen in product(range(5), repeat=4))
    found = widest(widths[:, :, None], ANGLES, gates)
    if not np.isfinite(least):
        assert found is None
    else:
        assert found is not None and _price(widths, found[:, 0], gates) == pytest.approx(least, rel=1e-12)


@pytest.mark.parametrize("shape", [(2, 1), (1, 2)])
def test_a_gate_that_moves_is_passed_neither_along_a_pass_nor_from_one_to_the_next(shape: tuple[int, int]) -> None:
    """No angle is forbidden at either node: only the side tells that the normal would be passed."""
    at, shut = np.radians([-2.5, 2.5]).reshape(shape), np.ones(shape, dtype=bool)
    widths = np.full((5, *shape), 0.5)
    widths[2] = 1.0  # no lean is the widest: above the gate at one node, below it at the other
    free, kept = (widest(widths, ANGLES, SingularSides(at, each)) for each in (~shut, shut))
    assert free is not None and (free == 2).all()
    assert kept is not None and np.unique(ANGLES[kept] > at).size == 1 and np.ptp(kept) == 1
    for gates, everywhere in ((SingularSides(at, ~shut), True), (SingularSides(at, shut), False)):
        low, high = bands(widths, ANGLES, kept, 0.5, gates)
        assert ((low == ANGLES[0]).all() and (high == ANGLES[-1]).all()) == everywhere
        assert everywhere or ((low > at) == (high > at)).all()


def test_an_angle_that_two_places_forbid_is_not_turned_across() -> None:
    widths = np.ones((5, 2, 1))
    widths[2] = 0.0
    widths[:2, 0], widths[3:, 1] = 0.0, 0.0  # above the wall at first, below it then
    assert widest(widths, ANGLES) is None
    widths[2, 1] = 0.5
    assert widest(widths, ANGLES) is not None


def test_bands_hold_wide_strips_alone() -> None:
    rng = np.random.default_rng(3)
    widths = rng.uniform(0.5, 1.0, (9, 6, 4))
    angles = np.radians(np.linspace(-20, 20, 9))
    chosen = widest(widths, angles)
    assert chosen is not None
    low, high = bands(widths, angles, chosen, 0.9)
    inside = (angles[:, None, None] >= low - 1e-12) & (angles[:, None, None] <= high + 1e-12)
    assert (widths >= 0.9 * narrowest(widths, chosen) - 1e-12)[inside].all()
    assert (low <= angles[chosen]).all() and (high >= angles[chosen]).all()


def _rows(n: int, m: int) -> np.ndarray:
    """The sums of squares that are to be least, written again for even spacing of one mm."""
    names = np.arange(n * m).reshape(n, m)
    out = []

    def add(places, weights):
        row = np.zeros(n * m)
        row[list(places)] += weights
        out.append(row)

    for i, k in product(range(n), range(m)):
        if i + 2 < n:
            add(names[i:i + 3, k], [1, -2, 1])
        if k + 2 < m:
            add(names[i, k:k + 3], [1, -2, 1])
        if i + 1 < n and k + 1 < m:
            add(names[i:i + 2, k:k + 2].ravel(), np.sqrt(2.0) * np.array([1, -1, -1, 1]))
        if i + 1 < n:
            add(names[i:i + 2, k], 0.02 * np.array([-1, 1]))
        if k + 1 < m:
            add(names[i, k:k + 2], 0.02 * np.array([-1, 1]))
    return np.array(out)


@pytest.mark.parametrize("seed", range(4))
def test_the_smoothest_angles_are_those_of_a_general_solver(seed: int) -> None:
    rng, n, m = np.random.default_rng(seed), 7, 6
    x, y = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    middle = np.sin(x + 0.4 * y) + 0.4 * rng.normal(size=(n, m))
    low, high = middle - 0.3 * rng.random((n, m)), middle + 0.3 * rng.random((n, m))
    found = smoothest(low, high, np.arange(n, dtype=float), np.arange(m, dtype=float))
    rows = _rows(n, m)
    best = lsq_linear(rows, np.zeros(len(rows)), (low.ravel(), high.ravel()), method="bvls", tol=1e-12)
    assert (found >= low).all() and (found <= high).all()
    assert ((rows @ found.ravel()) ** 2).sum() == pytest.approx(2 * best.cost, rel=1e-8)
    again = free_angle._by_descent(rows.T @ rows, low.ravel(), high.ravel())
    assert ((rows @ again) ** 2).sum() == pytest.approx(2 * best.cost, rel=1e-4)


def test_a_constant_that_fits_is_taken() -> None:
    low, high = np.full((5, 5), -0.1), np.full((5, 5), 0.3)
    low[2, 2], high[4, 1] = 0.1, 0.2
    found = smoothest(low, high, np.arange(5.0), np.arange(5.0))
    assert np.ptp(found) == 0.0 and 0.1 <= found[0, 0] <= 0.2
