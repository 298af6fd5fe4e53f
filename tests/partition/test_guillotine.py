"""The cheapest division of a lattice, against plain enumeration."""

import itertools

import numpy as np
import pytest

from toolaxis.partition.guillotine import CheapestDivisions, Corners, each_axis, offers, proper
from toolaxis.partition.guillotine_kernel import least_costs, least_costs_numpy


def shapes(nu: int, nv: int) -> tuple[int, int, int, int]:
    return nu + 1, nu + 1, nv + 1, nv + 1


def enumerated(box: Corners, cost: np.ndarray, empty: np.ndarray,
               known: dict[Corners, dict[int, float]]) -> dict[int, float]:
    """Least cost by number of pieces, by trying all cuts."""
    if box in known:
        return known[box]
    best = {0: 0.0} if empty[box] else {1: float(cost[box])}
    u0, u1, v0, v1 = box
    cuts = [((u0, c, v0, v1), (c, u1, v0, v1)) for c in range(u0 + 1, u1)]
    cuts += [((u0, u1, v0, c), (u0, u1, c, v1)) for c in range(v0 + 1, v1)]
    for one, other in cuts:
        left, right = enumerated(one, cost, empty, known), enumerated(other, cost, empty, known)
        for (k, a), (m, b) in itertools.product(left.items(), right.items()):
            best[k + m] = min(best.get(k + m, np.inf), a + b)
    known[box] = best
    return best


@pytest.mark.parametrize("seed", range(6))
def test_division_is_the_cheapest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nu, nv, most = 4, 3, 6
    cost = rng.uniform(1, 9, shapes(nu, nv)) ** 2
    cost[rng.random(cost.shape) < 0.3] = np.inf
    cells = rng.random((nu, nv)) < 0.2
    empty = np.zeros(cost.shape, dtype=bool)
    for box in np.argwhere(proper(nu, nv)):
        u0, u1, v0, v1 = box
        empty[u0, u1, v0, v1] = cells[u0:u1, v0:v1].all()
    found = CheapestDivisions(cost, empty, most)
    wanted = enumerated((0, nu, 0, nv), cost, empty, {})
    for count in range(most + 1):
        assert found.curve[count] == pytest.approx(wanted.get(count, np.inf), rel=1e-12)
        if np.isfinite(found.curve[count]):
            pieces = found.pieces(count)
            assert len(pieces) == count
            covered = np.zeros((nu, nv), dtype=int)
            for u0, u1, v0, v1 in pieces:
                covered[u0:u1, v0:v1] += 1
            assert covered.max(initial=0) <= 1 and cells[covered == 0].all()
            assert sum(cost[box] for box in pieces) == pytest.approx(found.curve[count], rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_compiled_and_plain_costs_agree_to_the_last_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nu, nv, most = (7, 5, 6) if seed % 2 else (3, 8, 4)
    least = np.full((*shapes(nu, nv), most + 1), np.inf)
    kinds = np.where(rng.random(shapes(nu, nv)) < 0.1, 0, 1)
    cost = np.where(rng.random(shapes(nu, nv)) < 0.3, np.inf, rng.uniform(1, 9, shapes(nu, nv)) ** 2)
    for box in np.argwhere(proper(nu, nv)):
        least[(*box, kinds[tuple(box)])] = 0.0 if kinds[tuple(box)] == 0 else cost[tuple(box)]
    plain = least.copy()
    least_costs(least)
    least_costs_numpy(plain)
    assert np.array_equal(least, plain) and np.isfinite(least[0, -1, 0, -1]).sum() > 2


@pytest.mark.parametrize("own", [False, True], ids=["lengths", "times of each axis"])
def test_offers_are_integrals_over_the_narrowest_places(own: bool) -> None:
    rng = np.random.default_rng(3)
    nu, nv, k = 4, 5, 40
    rates = rng.uniform(0.5, 2.0, (k, 2, nu + 1, nv + 1))
    rates[rng.random(rates.shape) < 0.02] = 1e12
    rows = k if own else 1
    gaps = rng.uniform(1, 3, (rows, nu, nv + 1)), rng.uniform(1, 3, (rows, nu + 1, nv))
    pitch = rng.uniform(0.1, 0.2, nu), rng.uniform(0.1, 0.2, nv)
    found = offers(rates, gaps, pitch, ends=0.7)
    for u0, u1, v0, v1 in np.argwhere(proper(nu, nv)):
        best = np.inf
        for axis, feed in itertools.product(range(k), (0, 1)):
            rate = rates[axis, feed, u0:u1 + 1, v0:v1 + 1].max(axis=feed)
            of = axis if own else 0
            row = 0.7 + (gaps[0][of, u0:u1, v0:v1 + 1].sum(axis=0) if feed == 0
                         else gaps[1][of, u0:u1 + 1, v0:v1].sum(axis=1))
            step = pitch[1][v0:v1] if feed == 0 else pitch[0][u0:u1]
            if rate.max() < 1e9:
                best = min(best, np.trapezoid(rate * row, np.concatenate([[0], np.cumsum(step)])) + row.mean() / 2)
        assert found.cost[u0, u1, v0, v1] == pytest.approx(best, rel=1e-6)
        one = each_axis(rates[:, :, u0:u1 + 1, v0:v1 + 1],
                        (gaps[0][:, u0:u1, v0:v1 + 1], gaps[1][:, u0:u1 + 1, v0:v1]),
                        (pitch[0][u0:u1], pitch[1][v0:v1]), 0.7)
        assert one.min() == pytest.approx(best, rel=1e-9) and one.shape == (k, 2)


def test_what_cells_cost_besides_is_added_up_over_every_rectangle() -> None:
    rng = np.random.default_rng(3)
    rates = rng.uniform(0.5, 2, (3, 2, 5, 4))
    gaps, pitch = (np.ones((1, 4, 4)), np.ones((1, 5, 3))), (np.ones(4), np.ones(3))
    extra = rng.uniform(0, 5, (3, 4, 3))
    found = offers(rates, gaps, pitch, 0.7, extra)
    for u0, u1, v0, v1 in np.argwhere(proper(4, 3)):
        box = slice(u0, u1 + 1), slice(v0, v1 + 1)
        one = each_axis(rates[:, :, *box], (gaps[0][:, u0:u1, box[1]], gaps[1][:, box[0], v0:v1]),
                        (pitch[0][u0:u1], pitch[1][v0:v1]), 0.7, extra[:, u0:u1, v0:v1])
        assert found.cost[u0, u1, v0, v1] == pytest.approx(one.min())
        assert found.axis[u0, u1, v0, v1] == one.min(axis=1).argmin()
    whole = offers(rates, gaps, pitch, 0.7).cost[0, 4, 0, 3]
    flat = offers(rates, gaps, pitch, 0.7, np.full((3, 4, 3), 2.5)).cost[0, 4, 0, 3]
    assert flat - whole == pytest.approx(12 * 2.5)
