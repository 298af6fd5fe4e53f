"""The best division of a lattice into rectangles by cuts from side to side."""

from collections.abc import Iterator
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from toolaxis.partition.guillotine_kernel import least_costs

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Values = TypeVar("Values", Array, Index)

Corners = tuple[int, int, int, int]
#: Sums of rates above this hold a forbidden node.
_TOO_MUCH = 1e9
#: Cost, mm or s, below which a rectangle is left as rest material as a whole: it is no sub-surface.
_NONE = 1e-6
_CHUNK = 32


class BestCosts(NamedTuple):
    """The cheapest axis and feed of every rectangle, each array indexed by first and last line along u, then along v.

    cost : of what the gaps are in, mm or s; inf where no axis serves;  axis, feed : indices of the cheapest.
    """

    cost: Array
    axis: Index
    feed: Index


def offers(rates: Array, gaps: tuple[Array, Array], pitch: tuple[Array, Array], ends: float = 0.0,
           extra: Array | None = None) -> BestCosts:
    """The cheapest axis and feed of every rectangle of a lattice.

    A rectangle's passes run from side to side, each as far from the next as the narrowest place on it allows: with
    feed u their number is the integral over v of the greatest rate in the row, and half a pass more, as a whole number
    is made.

    Parameters
    ----------
    rates : (k, 2, nu + 1, nv + 1) array
        Passes for a unit of the step, with feed u and v.
    gaps : pair of (1 or k, nu, nv + 1) and (1 or k, nu + 1, nv) arrays
        What a pass costs between neighbouring nodes along u and along v, mm or s; 0 off the face. One row where it is
        the same with all axes.
    pitch : pair of (nu,) and (nv,) arrays
        Distances of neighbouring lines in u and in v.
    ends : float
        By how much a pass is dearer than its line on the face.
    extra : (k, nu, nv) array, optional
        What each cell costs besides: what is left as rest material.
    """
    nu = rates.shape[2] - 1
    nv = rates.shape[3] - 1
    first_u, last_u = np.triu_indices(nu + 1, 1)
    first_v, last_v = np.triu_indices(nv + 1, 1)
    shape = (len(first_u), len(first_v))
    cost = np.full(shape, _TOO_MUCH)
    axis = np.zeros(shape, dtype=np.intp)
    feed = np.zeros(shape, dtype=np.intp)
    best = BestCosts(cost, axis, feed)
    across = gaps[0], gaps[1].swapaxes(1, 2)
    for first in range(0, len(rates), _CHUNK):
        part = slice(first, first + _CHUNK)
        rows = [_rows(_of_axes(one, part), ends) for one in across]
        for number in (0, 1):
            table = _feed_prices(rates[part, number], rows, pitch, number)
            if extra is not None and extra[part].any():
                table = table + _boxes(extra[part])
            _keep_cheaper(best, table, first, number)
    corners = first_u[:, None], last_u[:, None], first_v, last_v
    lines = (nu + 1, nu + 1, nv + 1, nv + 1)
    price = np.where(cost < _TOO_MUCH, cost, np.inf)
    whole_cost = _spread_out(price, corners, np.full(lines, np.inf))
    whole_axis: Index = _spread_out(axis, corners, np.zeros(lines, dtype=np.intp))
    whole_feed: Index = _spread_out(feed, corners, np.zeros(lines, dtype=np.intp))
    return BestCosts(whole_cost, whole_axis, whole_feed)


def _of_axes(gaps: Array, part: slice) -> Array:
    """What some axes' passes cost between nodes: one row where it is the same with all."""
    return gaps if len(gaps) == 1 else gaps[part]


def _feed_prices(rates: Array, rows: list[Array], pitch: tuple[Array, Array], feed: int) -> Array:
    """What all rectangles cost with one feed, (k, pairs along u, pairs along v)."""
    if feed == 0:
        return _lengths(rates, rows[0], pitch[1])
    turned = _lengths(rates.swapaxes(1, 2), rows[1], pitch[0])
    return np.asarray(turned.swapaxes(1, 2))


def _keep_cheaper(best: BestCosts, prices: Array, first: int, feed: int) -> None:
    """Put axes from a first one on, with one feed, where they are cheaper than what is there."""
    # numpy's argmin over the first axis takes several times as long.
    for k, price in enumerate(prices):
        better = price < best.cost
        best.cost[better] = price[better]
        best.axis[better] = first + k
        best.feed[better] = feed


def _spread_out(values: Values, corners: tuple[Index, ...], table: Values) -> Values:
    """A table by first and last line along u and along v, with the values of all rectangles put into it."""
    table[corners] = values
    return table


def _boxes(cells: Array) -> Array:
    """Sums over all rectangles of cells (k, nu, nv), (k, pairs along u, pairs along v)."""
    sums = np.cumsum(np.cumsum(cells, axis=1), axis=2)
    total = np.pad(sums, ((0, 0), (1, 0), (1, 0)))
    first, last = np.triu_indices(total.shape[1], 1)
    between_lines = total[:, last] - total[:, first]
    return _between(between_lines)


def each_axis(rates: Array, gaps: tuple[Array, Array], pitch: tuple[Array, Array], ends: float = 0.0,
              extra: Array | None = None) -> Array:
    """What a whole lattice costs as one piece with each axis and both feeds, (k, 2); inf where one is forbidden.

    Parameters
    ----------
    rates, gaps, pitch, ends, extra
        As for `offers`.
    """
    both = []
    for along, step in ((0, 1), (1, 0)):
        most = rates[:, along].max(axis=1 + along)
        whole = gaps[along].sum(axis=1 + along)
        row = _rectangle_ends(whole, ends)
        prices = most * row
        middle = (prices[:, 1:] + prices[:, :-1]) / 2
        passes = (middle * pitch[step]).sum(axis=1)
        cost = passes + row.mean(axis=1) / 2
        if extra is not None:
            cost += extra.sum(axis=(1, 2))
        is_allowed = most.max(axis=1) < _TOO_MUCH
        usable = is_allowed & (passes > _NONE)
        both.append(np.where(usable, cost, np.inf))
    return np.stack(both, axis=1)


def proper(nu: int, nv: int) -> NDArray[np.bool_]:
    """Which pairs of lines make a rectangle, by first and last along u and along v.

    Parameters
    ----------
    nu, nv : int
        Cells of the lattice.
    """
    u = np.arange(nu + 1)
    v = np.arange(nv + 1)
    rising_u = u[:, None] < u
    rising_v = v[:, None] < v
    return np.asarray(rising_u[:, :, None, None] & rising_v)


def _rows(gaps: Array, ends: float) -> Array:
    """What passes over all ranges along cost, (1 or k, first, last, step); 0 off the face."""
    begin = np.zeros((len(gaps), 1, gaps.shape[2]))
    total = np.concatenate([begin, np.cumsum(gaps, axis=1)], axis=1)
    ranges = total[:, None] - total[:, :, None]
    return _rectangle_ends(ranges, ends)


def _rectangle_ends(rows: Array, ends: float) -> Array:
    return np.asarray(np.where(rows > 1e-9, rows + ends, 0.0))


def _lengths(rates: Array, rows: Array, pitch: Array) -> Array:
    """What all ranges along and across cost, (k, pairs along, pairs across); pairs of first and last, in rows.

    rates (k, along, step);  rows (1 or k, first, last, step);  pitch (step - 1).
    """
    ns = rates.shape[2]
    first, last = np.triu_indices(rates.shape[1], 1)
    rows = rows[:, first, last]
    rate = _greatest_in_ranges(rates)
    table = np.where(rate < _TOO_MUCH, rate * rows, _TOO_MUCH)
    before = table[..., :-1]
    behind = table[..., 1:]
    bad = np.maximum(behind, before) >= _TOO_MUCH
    middle = np.where(bad, _TOO_MUCH, (behind + before) / 2 * pitch)
    begin = np.zeros((*middle.shape[:2], 1))
    passes = _between(np.concatenate([begin, np.cumsum(middle, axis=-1)], axis=-1))
    low, high = np.triu_indices(ns, 1)
    sums = np.cumsum(np.insert(rows, 0, 0.0, axis=-1), axis=-1)
    mean = (sums[..., high + 1] - sums[..., low]) / (high - low + 1)
    half_a_pass = mean / 2
    return np.asarray(np.where(passes > _NONE, passes + half_a_pass, _TOO_MUCH))


def _greatest_in_ranges(rates: Array) -> Array:
    """The greatest rate of all ranges along, (k, pairs along, step)."""
    k, na, ns = rates.shape
    first, _ = np.triu_indices(na, 1)
    table = np.empty((k, len(first), ns))
    for a in range(na - 1):
        greatest = np.maximum.accumulate(rates[:, a:], axis=1)
        table[:, first == a] = greatest[:, 1:]
    return table


def _between(total: Array) -> Array:
    """Differences of running sums, (…, pairs of first and last)."""
    first, last = np.triu_indices(total.shape[-1], 1)
    return np.asarray(total[..., last] - total[..., first])


class CheapestDivisions:
    """The cheapest divisions of every rectangle into 1, 2, … rectangles.

    Parameters
    ----------
    cost : (nu + 1, nu + 1, nv + 1, nv + 1) array
        Price of each rectangle as one piece, by first and last line along u and v; inf where that cannot be.
    empty : array of bool of the same shape
        Rectangles with nothing in them: they cost nothing and are no piece.
    most : int
        Greatest number of pieces.

    Notes
    -----
    Least cost of a rectangle with k pieces: as one piece, or over all cuts from side to side and all shares of k.
    Exact among divisions by such cuts.
    """

    def __init__(self, cost: Array, empty: NDArray[np.bool_], most: int) -> None:
        self._most = most
        self.least = np.full((*cost.shape, most + 1), np.inf)
        self.least[..., 1] = np.where(empty, np.inf, cost)
        self.least[empty, 0] = 0.0
        least_costs(self.least)

    @property
    def curve(self) -> Array:
        """Least cost of the whole lattice in 0, 1, … pieces, (most + 1,)."""
        return np.asarray(self.least[0, -1, 0, -1])

    def pieces(self, count: int) -> list[Corners]:
        """The rectangles of the cheapest division into a number of pieces, from low to high parameters.

        Parameters
        ----------
        count : int
            With a finite cost on the `curve`.
        """
        nu, nv = self.least.shape[0] - 1, self.least.shape[2] - 1
        return sorted(self._followed((0, nu, 0, nv), count))

    def _followed(self, box: Corners, count: int) -> Iterator[Corners]:
        if count == 0:
            return
        goal = self.least[box][count]
        for one, other in _cuts(box):
            for k in range(count + 1):
                if self.least[one][k] + self.least[other][count - k] == goal:
                    yield from self._followed(one, k)
                    yield from self._followed(other, count - k)
                    return
        yield box


def _cuts(box: Corners) -> Iterator[tuple[Corners, Corners]]:
    u0, u1, v0, v1 = box
    for c in range(u0 + 1, u1):
        yield (u0, c, v0, v1), (c, u1, v0, v1)
    for c in range(v0 + 1, v1):
        yield (u0, u1, v0, c), (u0, u1, c, v1)
