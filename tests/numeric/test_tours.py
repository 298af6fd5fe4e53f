"""Orders of things with states, against all orders and all states."""

from itertools import pairwise, permutations, product

import numpy as np
import pytest

from toolaxis.numeric import sequencing as tours
from toolaxis.numeric.sequencing import TransitionCosts, in_order, shortest


def random_steps(seed: int, things: int = 5, groups: int = 5, holes: float = 0.0) -> TransitionCosts:
    rng = np.random.default_rng(seed)
    counts = rng.integers(1, 4, things)
    owner = np.repeat(np.arange(things), counts)
    cost = rng.uniform(0.1, 9, (len(owner), len(owner)))
    cost[rng.uniform(size=cost.shape) < holes] = np.inf
    return TransitionCosts(cost, owner, rng.integers(0, groups, things), rng.uniform(0, 2, len(owner)))


def cohesive(steps: TransitionCosts, order: tuple[int, ...]) -> bool:
    names = steps.group[list(order)].tolist()
    return len([k for k in range(len(names)) if k == 0 or names[k] != names[k - 1]]) == len(set(names))


def cheapest(steps: TransitionCosts) -> float:
    """All orders, all states."""
    best = np.inf
    states = [np.flatnonzero(steps.owner == thing) for thing in range(steps.things)]
    for order in permutations(range(steps.things)):
        if cohesive(steps, order):
            for chosen in product(*(states[thing] for thing in order)):
                total = steps.start[chosen[0]] + sum(steps.cost[a, b] for a, b in pairwise(chosen))
                best = min(best, float(total))
    return best


def told(steps: TransitionCosts, states: tuple[int, ...]) -> float:
    return float(steps.start[states[0]] + sum(steps.cost[a, b] for a, b in pairwise(states)))


@pytest.mark.parametrize("seed", range(12))
def test_the_cheapest_of_all_orders_and_states(seed: int) -> None:
    steps = random_steps(seed, groups=5 if seed % 2 else 2, holes=0.25 if seed % 3 == 0 else 0.0)
    found, expected = shortest(steps), cheapest(steps)
    assert found.cost == pytest.approx(expected) or (np.isinf(found.cost) and np.isinf(expected))
    if np.isfinite(expected):
        order = tuple(int(steps.owner[state]) for state in found.states)
        assert sorted(order) == list(range(5)) and cohesive(steps, order) and found.exact
        assert told(steps, found.states) == pytest.approx(found.cost)


def test_a_given_order_gets_its_cheapest_states() -> None:
    steps = random_steps(40)
    states = [np.flatnonzero(steps.owner == thing) for thing in (3, 0, 4, 1, 2)]
    expected = min(told(steps, chosen) for chosen in product(*states))
    assert in_order(steps, np.array([3, 0, 4, 1, 2])).cost == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_not_exact_keeps_groups_together_and_is_within_its_bound(seed: int, monkeypatch) -> None:
    steps = random_steps(seed + 60, things=7, groups=4)
    exact = shortest(steps)
    monkeypatch.setattr(tours, "EXACT", 3)
    found = shortest(steps)
    assert cohesive(steps, tuple(int(steps.owner[state]) for state in found.states))
    assert told(steps, found.states) == pytest.approx(found.cost)
    assert found.bound <= exact.cost + 1e-9 <= found.cost + 2e-9
    assert found.cost <= 1.35 * exact.cost


def test_many_things_on_a_line_are_found_in_their_order() -> None:
    places = np.random.default_rng(2).permutation(30).astype(float)
    cost = np.abs(places[:, None] - places)
    steps = TransitionCosts(cost, np.arange(30), np.arange(30), places)
    found = shortest(steps)
    assert found.cost == pytest.approx(29.0) and found.bound <= 29.0


def test_one_thing() -> None:
    found = shortest(TransitionCosts(np.zeros((2, 2)), np.zeros(2, dtype=int), np.zeros(1, dtype=int),
                                     np.array([3.0, 2.0])))
    assert (found.states, found.cost) == ((1,), 2.0)
