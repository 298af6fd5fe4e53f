"""Fewest orientations: axes that serve several sub-surfaces, and what that costs in cutting length."""

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array

from toolaxis.advice import DIVIDE, SMALLER_TOOL
from toolaxis.errors import InvalidInput
from toolaxis.partition.cost_grid import CostGrid
from toolaxis.partition.face_division import MOST, Divider, Regions, Solution
from toolaxis.partition.guillotine import Corners
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Boxes: TypeAlias = list[list[Corners]]

_ROUNDS = 6
#: Time for one choice of axes, s, and what the solver says where it proved that there is none.
_SECONDS, _IMPOSSIBLE = 30.0, 2


class AxisAssignment(NamedTuple):
    """Which axis serves which sub-surface.

    axis : (s,) index of the axis of each sub-surface;  cost : of all, index costs included;  bound : no choice costs
    less; equal to the cost where it is proven to be the best.
    """

    axis: Index
    cost: float
    bound: float


def cover(costs: ArrayLike, most: int | None = None, index_cost: float = 0.0) -> AxisAssignment:
    """The cheapest choice of axes for sub-surfaces, with few different ones.

    Parameters
    ----------
    costs : (s, k) array_like
        What sub-surface s costs with axis k; inf where the axis may not be used.
    most : int, optional
        Greatest number of different axes.
    index_cost : float
        What each different axis costs.

    Returns
    -------
    AxisAssignment
        Exact unless 30 s were not enough; then the bound tells how far it may be off.

    Raises
    ------
    InvalidInput
        When no choice of so few axes serves every sub-surface.

    Notes
    -----
    An integer programme (plant location), solved by HiGHS: one axis for each sub-surface, used axes opened, at most so
    many open.
    """
    table = np.atleast_2d(np.asarray(costs, dtype=float))
    sub, axis = np.nonzero(np.isfinite(table))
    s, k = table.shape
    if len(np.unique(sub)) < s:
        raise InvalidInput(f"a sub-surface has no axis that may be used: {DIVIDE} further, or take another tool")
    n = len(sub)
    pick = np.arange(n)
    one = coo_array((np.ones(n), (sub, pick)), shape=(s, n + k))
    pairs = np.tile(pick, 2), np.concatenate([pick, n + axis])
    opened = coo_array((np.repeat([1.0, -1.0], n), pairs), shape=(n, n + k))
    rules = [LinearConstraint(one, 1, 1), LinearConstraint(opened, -np.inf, 0)]
    if most is not None:
        rules.append(LinearConstraint(np.concatenate([np.zeros(n), np.ones(k)])[None], 0, most))
    found = milp(np.concatenate([table[sub, axis], np.full(k, float(index_cost))]), constraints=rules,
                 integrality=np.concatenate([np.zeros(n), np.ones(k)]), bounds=Bounds(0, 1),
                 options={"time_limit": _SECONDS, "mip_rel_gap": 0.0})
    if found.x is None:
        chosen = None if found.status == _IMPOSSIBLE else _greedy(table, most)
        if chosen is None:
            why = "serve" if found.status == _IMPOSSIBLE else f"were found in {_SECONDS:g} s to serve"
            raise InvalidInput(f"no {most} axes {why} all {s} sub-surfaces: allow more orientations")
    else:
        chosen = np.empty(s, dtype=np.intp)
        best = np.argsort(found.x[:n], kind="stable")
        chosen[sub[best]] = axis[best]
    cost = float(table[np.arange(s), chosen].sum() + index_cost * len(np.unique(chosen)))
    known = float(table.min(axis=1).sum() + index_cost)  # each with its cheapest axis, and one axis at least
    if found.mip_dual_bound is not None and np.isfinite(found.mip_dual_bound):
        known = max(known, float(found.mip_dual_bound))
    return AxisAssignment(chosen, cost, min(cost, known))


def _greedy(table: Array, most: int | None) -> Index | None:
    """Axes opened one after the other, each the one that leaves least unserved, then cheapest; None if none do."""
    served = np.full(len(table), np.inf)
    chosen = np.zeros(len(table), dtype=np.intp)
    for _ in range(table.shape[1] if most is None else most):
        left = np.minimum(served[:, None], table)
        missing = np.isinf(left).sum(axis=0)
        k = int(np.lexsort((np.where(np.isinf(left), 0.0, left).sum(axis=0), missing))[0])
        better = table[:, k] < served
        if not better.any():
            break
        chosen[better], served = k, np.minimum(served, table[:, k])
    return chosen if np.isfinite(served).all() else None


class SharedDivision(NamedTuple):
    """Sub-surfaces of several faces that share a few axes.

    regions : one Regions a face;  length : reckoned length of all, mm;  orientations : different axes;  seconds :
    reckoned time of all where the division goes by time.
    """

    regions: tuple[Regions, ...]
    length: float
    orientations: int
    seconds: float | None = None

    @property
    def cost(self) -> float:
        """What the division went by: mm or s."""
        return self.length if self.seconds is None else self.seconds

    @property
    def pieces(self) -> int:
        """Number of sub-surfaces."""
        return sum(len(one) for one in self.regions)


class TradeOff(NamedTuple):
    """Reckoned length, or time, against the number of different axes.

    options : one Shared for each number of axes for which more of them cost less;  knee : index of the one from which
    on further axes gain little.
    """

    options: tuple[SharedDivision, ...]
    knee: int


def divide_with_shared_axes(dividers: Sequence[Divider], most: int, index_cost: float | None = None,
                            progress: Progress = NO_PROGRESS) -> SharedDivision:
    """Divide faces so that at most so many axes serve all sub-surfaces in the least cutting length or time.

    Parameters
    ----------
    dividers : sequence of Divider
        One a face.
    most : int
        Greatest number of different axes.
    index_cost : float, optional
        What one more axis costs, mm of cutting length, or s; `Divider.index_cost` unless given.
    progress : Progress

    Raises
    ------
    InvalidInput
        When no division was found that so few axes serve.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    From the best divisions into 1, 2, … sub-surfaces in turn: the best choice of axes for these sub-surfaces (exact),
    the best division for these axes (exact), and so on until nothing changes; the cheapest of all.

    Cuts are iso-parametric.  Rings around bosses, which `regions` tries too, are left out: on the example with one boss
    they would take 3 % less with one axis and 1 to 2 % less with two to four, for more pieces (`benchmarks/bosses.py`).
    """
    prices = _costs_on_all_faces(dividers)
    each = dividers[0].index_cost if index_cost is None else index_cost
    best: _Try | None = None
    seen: list[Boxes] = []
    for count in range(1, MOST + 1):
        progress.report("fewest orientations", count - 1, MOST)
        boxes = [_division(divider, count) for divider in dividers]
        if boxes not in seen:
            seen.append(boxes)
            best = _cheaper(best, _alternate_axes_and_pieces(list(zip(dividers, prices, boxes, strict=True)), most,
                                                             each))
    if best is None:
        raise InvalidInput(f"no division was found that {most} {'axis' if most == 1 else 'axes'} can machine: allow "
                           f"more orientations, or take {SMALLER_TOOL}")
    return _describe_division(dividers, best)


def trade(dividers: Sequence[Divider], most: int = MOST, progress: Progress = NO_PROGRESS) -> TradeOff:
    """Cutting length, or time, against the number of axes, each as `divide_with_shared_axes` with no cost of an axis.

    Parameters
    ----------
    dividers : sequence of Divider
        One a face.
    most : int
        Greatest number of different axes that is looked at.
    progress : Progress

    Raises
    ------
    InvalidInput
        When no division was found that so many axes serve.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    For each number from three starts: the divisions into as many and into twice as many sub-surfaces, and what was best
    with one axis less.  The knee is the option that lies farthest below the line from the first to the last one.
    """
    prices = _costs_on_all_faces(dividers)
    options: list[SharedDivision] = []
    best: _Try | None = None
    for count in range(1, most + 1):
        progress.report("orientations against length", count - 1, most)
        before = best
        starts = [[_division(divider, pieces) for divider in dividers] for pieces in (count, 2 * count)]
        for boxes in starts if best is None else [*starts, best.boxes]:
            best = _cheaper(best, _alternate_axes_and_pieces(list(zip(dividers, prices, boxes, strict=True)), count,
                                                             0.0))
        if best is None:
            continue
        if before is best:
            break
        options.append(_describe_division(dividers, best))
    if not options:
        raise InvalidInput(f"no division was found that {most} axes can machine: take {SMALLER_TOOL}")
    return TradeOff(tuple(options), knee([one.orientations for one in options], [one.cost for one in options]))


def knee(count: ArrayLike, length: ArrayLike) -> int:
    """Index of the point of a falling curve that lies farthest below the line from its first to its last point.

    Parameters
    ----------
    count, length : (n,) array_like
        Rising numbers, and what falls with them.
    """
    x, y = np.asarray(count, dtype=float), np.asarray(length, dtype=float)
    if len(x) < 3 or y[0] == y[-1]:
        return len(x) - 1
    return int(np.argmax((y[0] - y) / (y[0] - y[-1]) - (x - x[0]) / (x[-1] - x[0])))


def _costs_on_all_faces(dividers: Sequence[Divider]) -> list[CostGrid]:
    """Prices of all faces' candidates on every face."""
    pool = np.unique(np.concatenate([divider.candidates() for divider in dividers]), axis=0)
    return [divider.priced(pool) for divider in dividers]


def _describe_division(dividers: Sequence[Divider], best: "_Try") -> SharedDivision:
    regions = tuple(divider.named(found, boxes)
                    for divider, found, boxes in zip(dividers, best.solutions, best.boxes, strict=True))
    used = np.unique(np.concatenate([one.axes for one in regions]), axis=0)
    times = [sum(one.seconds) for one in regions if one.seconds]
    return SharedDivision(regions, sum(sum(one.lengths) for one in regions), len(used), sum(times) if times else None)


class _Try(NamedTuple):
    """Divisions of all faces with one set of axes, and what they cost."""

    cost: float
    solutions: list[Solution]
    boxes: Boxes


def _cheaper(one: _Try | None, other: _Try | None) -> _Try | None:
    """The cheaper one; the first where they cost the same."""
    return other if one is None or (other is not None and other.cost < one.cost - 1e-6) else one


def _division(divider: Divider, count: int) -> list[Corners]:
    """The best division into about so many pieces."""
    known = divider.best.known
    return divider.best.pieces(int(known[np.argmin(np.abs(known - count))])) if len(known) else []


def _alternate_axes_and_pieces(faces: list[tuple[Divider, CostGrid, list[Corners]]], most: int,
                               index_cost: float) -> _Try | None:
    """Axes for pieces and pieces for axes in turn, until the cost falls no more; None where a face is not divided."""
    best: _Try | None = None
    if not all(boxes for _, _, boxes in faces):
        return None
    for _ in range(_ROUNDS):
        costs = np.array([divider.costs(prices, box) for divider, prices, boxes in faces for box in boxes])
        try:
            axes = np.unique(cover(costs, most, index_cost).axis)
        except InvalidInput:
            return best
        solutions = [divider.solved(prices.of(axes), divider.piece_cost) for divider, prices, _ in faces]
        curves = [found.division.curve for found in solutions]
        cost = float(sum(curve.min() for curve in curves)) + index_cost * len(axes)
        if not np.isfinite(cost) or (best is not None and cost >= best.cost - 1e-6):
            return best
        boxes = [found.pieces(int(np.argmin(curve))) for found, curve in zip(solutions, curves, strict=True)]
        best = _Try(cost, solutions, boxes)
        faces = [(divider, prices, own) for (divider, prices, _), own in zip(faces, boxes, strict=True)]
    return best
