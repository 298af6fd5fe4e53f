"""The cheapest order of things, each in one of several states, some of which must stay together.

Exact for few things by dynamic programming over sets (Held and Karp 1962), each state a node of its own; beyond that by
insertion, with a bound of what could at best be saved.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Most things that are ordered exactly.
EXACT = 12
#: Orders that the heuristic looks at, at most.
_TRIALS = 4000


@dataclass(frozen=True, eq=False)
class TransitionCosts:
    """What goes between states.

    Attributes
    ----------
    cost : (n, n) array
        From each state to each other one; infinite where there is no way.
    owner : (n,) array of int
        Which thing each state belongs to, ascending from 0.
    group : (k,) array of int
        Things of one group follow each other.
    start : (n,) array
        What beginning with each state costs.
    """

    cost: Array
    owner: Indices
    group: Indices
    start: Array

    @property
    def things(self) -> int:
        """How many there are."""
        return len(self.group)


@dataclass(frozen=True)
class VisitingOrder:
    """States in their order, what they cost together, a bound below which no order is, and whether that is the cost."""

    states: tuple[int, ...]
    cost: float
    bound: float

    @property
    def exact(self) -> bool:
        """Whether nothing is cheaper."""
        return self.cost <= self.bound + 1e-9 * max(abs(self.bound), 1.0)


def in_order(steps: TransitionCosts, order: Indices) -> VisitingOrder:
    """The cheapest states of things in a given order.

    Parameters
    ----------
    steps : TransitionCosts
    order : (k,) array of int
        Things.
    """
    rows = [np.flatnonzero(steps.owner == thing) for thing in order]
    best, before = steps.start[rows[0]], []
    for a, b in pairwise(rows):
        table = best[:, None] + steps.cost[np.ix_(a, b)]
        before.append(table.argmin(axis=0))
        best = table.min(axis=0)
    last = int(np.argmin(best))
    states = [last]
    for choice in reversed(before):
        states.append(int(choice[states[-1]]))
    cost = float(best[last])
    return VisitingOrder(tuple(int(rows[k][s]) for k, s in enumerate(reversed(states))), cost, cost)


def shortest(steps: TransitionCosts) -> VisitingOrder:
    """The cheapest order, and what no order can be cheaper than.

    Parameters
    ----------
    steps : TransitionCosts

    Returns
    -------
    VisitingOrder
        Its cost is infinite where there is no way through all.
    """
    return _exact(steps) if steps.things <= EXACT else _insert_groups(steps)


def _exact(steps: TransitionCosts) -> VisitingOrder:
    count, n = steps.things, len(steps.owner)
    bit = np.left_shift(1, steps.owner)
    whole = np.array([sum(1 << int(k) for k in np.flatnonzero(steps.group == g)) for g in steps.group])[steps.owner]
    same = steps.group[steps.owner][:, None] == steps.group[steps.owner]
    best = np.full((1 << count, n), np.inf)
    before = np.full((1 << count, n), -1, dtype=np.int64)
    best[bit, np.arange(n)] = steps.start
    for mask in range(1, 1 << count):
        rows = np.flatnonzero(np.isfinite(best[mask]))
        if not len(rows):
            continue
        done = (whole[rows] & mask) == whole[rows]
        new = np.flatnonzero((bit & mask) == 0)
        table = best[mask, rows][:, None] + steps.cost[np.ix_(rows, new)]
        table[~(done[:, None] | same[np.ix_(rows, new)])] = np.inf
        if not table.size:
            continue
        pick = table.argmin(axis=0)
        value, target = table[pick, np.arange(len(new))], mask | bit[new]
        better = value < best[target, new]
        best[target[better], new[better]] = value[better]
        before[target[better], new[better]] = rows[pick[better]]
    mask = (1 << count) - 1
    state = int(np.argmin(best[mask]))
    cost, states = float(best[mask, state]), [state]
    while before[mask, states[-1]] >= 0:
        previous = int(before[mask, states[-1]])
        mask &= ~int(bit[states[-1]])
        states.append(previous)
    return VisitingOrder(tuple(reversed(states)), cost, cost)


def _insert_groups(steps: TransitionCosts) -> VisitingOrder:
    """Groups one after the other by the nearest next thing, then things and groups moved while that helps."""
    groups = [np.flatnonzero(steps.group == g) for g in dict.fromkeys(steps.group.tolist())]
    orders = [np.concatenate(groups), _nearest_next(steps, groups)]
    best = min((in_order(steps, order) for order in orders), key=lambda tour: tour.cost)
    order = [int(steps.owner[state]) for state in best.states]
    trials, improved = 0, True
    while improved and trials < _TRIALS:
        improved = False
        for block in _blocks(steps, order):
            rest = [thing for thing in order if thing not in block]
            places = [k for k in range(len(rest) + 1) if _fits(steps, rest, k, block)]
            tours = [in_order(steps, np.array([*rest[:k], *block, *rest[k:]])) for k in places]
            trials += len(tours)
            found = min(tours, key=lambda tour: tour.cost)
            if found.cost < best.cost - 1e-9:
                best, improved = found, True
                order = [int(steps.owner[state]) for state in best.states]
    return VisitingOrder(best.states, best.cost, min(_bound(steps), best.cost))


def _blocks(steps: TransitionCosts, order: list[int]) -> list[list[int]]:
    """Whole groups as they lie in an order, and single things of larger groups."""
    groups = [[thing for thing in order if steps.group[thing] == g]
              for g in dict.fromkeys(steps.group[order].tolist())]
    return [*groups, *([thing] for group in groups if len(group) > 1 for thing in group)]


def _fits(steps: TransitionCosts, rest: list[int], place: int, block: list[int]) -> bool:
    """Whether a block in a place leaves all groups together."""
    own = steps.group[block[0]]
    beside = [steps.group[rest[k]] for k in (place - 1, place) if 0 <= k < len(rest)]
    if any(steps.group[thing] == own for thing in rest):
        return own in beside
    return len(beside) < 2 or beside[0] != beside[1]


def _nearest_next(steps: TransitionCosts, groups: list[Indices]) -> Indices:
    state = int(np.argmin(steps.start))
    left = set(range(steps.things)) - {int(steps.owner[state])}
    order = [int(steps.owner[state])]
    while left:
        own = [thing for thing in left if steps.group[thing] == steps.group[order[-1]]]
        open_ = np.flatnonzero(np.isin(steps.owner, own or list(left)))
        state = int(open_[np.argmin(steps.cost[state, open_])])
        order.append(int(steps.owner[state]))
        left.discard(order[-1])
    return np.array(order)


def _bound(steps: TransitionCosts) -> float:
    """Each thing but the first is come to from somewhere: the least of these costs, the greatest of them left out."""
    other = steps.owner[:, None] != steps.owner
    arrive = np.where(other, steps.cost, np.inf).min(axis=0)
    each = np.array([arrive[steps.owner == thing].min() for thing in range(steps.things)])
    return float(steps.start.min() + each.sum() - each.max())
