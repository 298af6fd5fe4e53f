"""The order in which pieces of passes are cut: pass by pass, or side by side where passes are interrupted."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.path.links import BESIDE

Array = NDArray[np.float64]
Index = NDArray[np.intp]

ZIGZAG = "zigzag"
#: What lifting and coming down adds to a way that is longer than `BESIDE`, mm.
_LIFT = 20.0
#: Ways that differ by less are as long, mm.
_SAME = 1e-6


class OrderedStroke(NamedTuple):
    """A stroke in the order of cutting: its number, and its sense along the pass, 1 or -1."""

    number: int
    sense: int


class _Covered(NamedTuple):
    """A stretch of the along parameter, and the last stroke that covers it."""

    low: float
    high: float
    stroke: int


@dataclass(frozen=True, eq=False)
class _Strokes:
    """Strokes sorted by pass, then along.

    Attributes
    ----------
    first, last : (n, 3) array
        Tips at the ends of each in the sense of the along parameter, mm.
    low, high : (n,) array
        Along parameter at these ends.
    owner : (n,) array of int
        Pass of each.
    """

    first: Array
    last: Array
    low: Array
    high: Array
    owner: Index

    def begin(self, stroke: OrderedStroke) -> Array:
        """Tip at which a stroke begins, (3,) mm."""
        ends = self.first if stroke.sense > 0 else self.last
        return np.asarray(ends[stroke.number])

    def end(self, stroke: OrderedStroke) -> Array:
        """Tip at which a stroke ends, (3,) mm."""
        return self.begin(OrderedStroke(stroke.number, -stroke.sense))

    def way_of(self, order: Sequence[OrderedStroke]) -> float:
        """What the ways between strokes in some order come to, mm."""
        ends = np.array([self.end(one) for one in order[:-1]])
        begins = np.array([self.begin(one) for one in order[1:]])
        ways = np.linalg.norm(begins - ends, axis=1)
        return float(ways.sum() + _LIFT * (ways > BESIDE).sum())


def order_strokes(tips: Sequence[Array], pieces: Array, owner: Index, sense: int | None) -> list[list[OrderedStroke]]:
    """Passes, or the parts of passes that are cut one after the other, with their strokes in the order of cutting.

    Where passes are interrupted, the strokes on one side of a gap are cut first where that makes the ways between
    strokes shorter: pass by pass, the tool would cross the gap twice for each of them.

    Parameters
    ----------
    tips : sequence of n arrays (k, 3)
        Tips along each stroke in the sense of the along parameter, mm, sorted by pass, then along.
    pieces : (n, 3) array
        along0, along1, step of each.
    owner : (n,) array of int
        Pass of each.
    sense : int or None
        Sense of the along parameter in which all are cut, 1 or -1; None for to and fro.

    Notes
    -----
    **Properties**: 1. each stroke is there once; 2. a stroke is cut after all those of earlier passes beside which it
    lies, so that material stays on the same side of the tool; 3. passes of one stroke each are cut in their order.
    """
    passes = _order_by_pass(owner, sense)
    order = [one for some in passes for one in some]
    if len(passes) == len(order):
        return passes
    first = np.array([some[0] for some in tips])
    last = np.array([some[-1] for some in tips])
    strokes = _Strokes(first, last, pieces[:, 0], pieces[:, 1], owner)
    sideways = _order_by_side(strokes, order[0], sense)
    if strokes.way_of(sideways) >= strokes.way_of(order):
        return passes
    return [list(some) for _, some in groupby(sideways, lambda one: owner[one.number])]


def _order_by_pass(owner: Index, sense: int | None) -> list[list[OrderedStroke]]:
    """All strokes of a pass, then all of the next one."""
    passes: list[list[OrderedStroke]] = []
    for number in np.unique(owner):
        own = (-1) ** len(passes) if sense is None else sense
        members = np.flatnonzero(owner == number)[::own]
        passes.append([OrderedStroke(int(member), own) for member in members])
    return passes


def _order_by_side(strokes: _Strokes, first: OrderedStroke, sense: int | None) -> list[OrderedStroke]:
    """From each stroke to the nearest one that may be cut then."""
    before = _find_strokes_before(strokes)
    waits_for = np.array([len(some) for some in before])
    followers: list[list[int]] = [[] for _ in before]
    for number, some in enumerate(before):
        for earlier in some:
            followers[earlier].append(number)
    ready = waits_for == 0
    order = [first]
    while True:
        last = order[-1]
        ready[last.number] = False
        for follower in followers[last.number]:
            waits_for[follower] -= 1
            ready[follower] = waits_for[follower] == 0
        candidates = np.flatnonzero(ready)
        if not len(candidates):
            return order
        order.append(_nearest(strokes, candidates, last, sense))


def _find_strokes_before(strokes: _Strokes) -> list[set[int]]:
    """For each stroke those of earlier passes beside which it lies, with no other one between them."""
    before: list[set[int]] = [set() for _ in strokes.owner]
    covered: list[_Covered] = []
    for _, members in groupby(range(len(strokes.owner)), lambda number: strokes.owner[number]):
        own = [_Covered(float(strokes.low[number]), float(strokes.high[number]), number) for number in members]
        for one in own:
            before[one.stroke] = {known.stroke for known in covered if known.low < one.high and known.high > one.low}
        for one in own:
            covered = _cover(covered, one)
    return before


def _cover(covered: list[_Covered], by: _Covered) -> list[_Covered]:
    """Stretches with a further one over them."""
    kept = [by]
    for known in covered:
        if known.high <= by.low or known.low >= by.high:
            kept.append(known)
            continue
        if known.low < by.low:
            kept.append(known._replace(high=by.low))
        if known.high > by.high:
            kept.append(known._replace(low=by.high))
    return kept


def _nearest(strokes: _Strokes, candidates: Index, last: OrderedStroke, sense: int | None) -> OrderedStroke:
    """The stroke that begins nearest to the end of the last one; to and fro, either way."""
    here = strokes.end(last)
    ways = {1: np.linalg.norm(strokes.first[candidates] - here, axis=1),
            -1: np.linalg.norm(strokes.last[candidates] - here, axis=1)}
    if sense is not None:
        nearest = int(np.argmin(ways[sense]))
        return OrderedStroke(int(candidates[nearest]), sense)
    on, back = last.sense, -last.sense
    goes_on = ways[on] < ways[back] - _SAME
    nearest = int(np.argmin(np.where(goes_on, ways[on], ways[back])))
    return OrderedStroke(int(candidates[nearest]), on if goes_on[nearest] else back)
