"""The free angle over a face: the widest strips that turning smoothly leaves, and the smoothest angle that keeps them.

Nodes stand along the passes (i) and across them (k), angles on a grid (j).  Passes go from the middle one outwards;
dynamic programming finds for each the angles with the widest strip against a charge on turning, along it and from the
pass beside it.  Around these angles lie bands in which the strip stays as wide, and the smoothest angle inside all
bands is a bounded linear least-squares problem.  Where the axis must not pass the normal, angles on its two sides are
kept apart: from one node to the next the side stays.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.work import spend

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Bools = NDArray[np.bool_]

#: How sharply a narrow place of a pass counts against its wider ones, and what a turn by a tenth of a rad between two
#: nodes costs, along the pass and from pass to pass, in shares of one node's strip.
_POWER, _ALONG, _ACROSS = 8, 0.02, 0.02
_TENTH = 0.1
#: Weights of slopes along and across against bends, which are what accelerates the axis.
_SLOPE = 0.02
_TIGHT = {"maxiter": 2_000, "maxfun": 4_000, "ftol": 1e-13, "gtol": 1e-8}
#: How often bounds that hold are exchanged, and by how much angles may pass them, rad.
_EXCHANGES, _TOUCH = 60, 1e-10
#: As many bounds of distances as take as long as solving for one angle, by the square of the number of diagonals.
_SOLVED = 0.004
#: Greatest turn between two nodes, along a pass and from pass to pass, rad: more would be a jump.
_MOST = 0.5


class SingularSides(NamedTuple):
    """Where a turning axis passes nearest to the normal.

    Attributes
    ----------
    at : (i, k) array
        That angle at each node, without whole turns between neighbours, rad.
    shut : (i, k) array of bool
        Whether the axis must not pass it there.
    """

    at: Array
    shut: Bools

    def sides(self, angles: Array) -> Index:
        """On which side angles lie, (j, i, k): numbers that grow by one at each time that the normal is passed.

        Parameters
        ----------
        angles : (j,) array
            rad
        """
        past_gate = angles[:, None, None] - self.at
        turns = np.floor(past_gate / (2 * np.pi))
        return np.asarray(turns.astype(np.intp))


def widest(widths: Array, angles: Array, gates: SingularSides | None = None) -> Index | None:
    """The angles with the widest strips that turn gently, (i, k) places on the grid of angles.

    Parameters
    ----------
    widths : (j, i, k) array
        Strip widths of each angle at each node in one unit; 0 where the angle must not be used.
    angles : (j,) array
        Even, rad.
    gates : SingularSides, optional
        That are not passed between two nodes of which one shuts.

    Returns
    -------
    (i, k) array of int, or None where there are none without a jump.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.4.2 takes the widest strip at every sample by itself; here the angles belong together.
    """
    best = widths.max(axis=0)
    if not (best > 0).all():
        return None
    graph = _AngleGraph.of(widths, angles, gates)
    chosen = np.empty(best.shape, dtype=np.intp)
    last_pass = best.shape[1] - 1
    middle = best.shape[1] // 2
    chosen[:, middle] = _cheapest(graph.price[:, :, middle], graph, middle)
    for k in (*range(middle + 1, last_pass + 1), *range(middle - 1, -1, -1)):
        beside = k - 1 if k > middle else k + 1
        charge = graph.charge_from(beside, chosen[:, beside], k)
        chosen[:, k] = _cheapest(graph.price[:, :, k] + charge, graph, k)
    turns_along = np.abs(np.diff(angles[chosen], axis=0))
    turns_across = np.abs(np.diff(angles[chosen], axis=1))
    greatest_turn = max(turns_along.max(initial=0.0), turns_across.max(initial=0.0))
    used = np.take_along_axis(widths, chosen[None], axis=0)[0]
    if not (used > 0).all() or greatest_turn > _MOST:
        return None
    return chosen


def _price_of_narrowness(widths: Array) -> Array:
    """Prices of angles (j, i, k): the narrower a strip is beside the narrowest of its pass, the dearer."""
    least = widths.max(axis=0).min(axis=0)
    finite = np.where(np.isfinite(least), least, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        price = (finite / widths) ** _POWER
    return np.where(widths > 0, price, np.inf)


def _walls(one: Bools, other: Bools) -> Index:
    """Numbers of angles (j, ...) up to each that two nodes both forbid: between angles with the same none does."""
    return np.asarray(np.cumsum(~(one | other), axis=0))


class _Turns(NamedTuple):
    """Turns between angles of a grid: from which ones each can be turned to, (j, n), and the price of that, infinite
    beyond the ends of the grid."""

    origin: Index
    price: Array

    @classmethod
    def between(cls, angles: Array) -> "_Turns":
        number = len(angles)
        gap = float(angles[1] - angles[0]) if number > 1 else _MOST
        most = min(int(_MOST / gap + 1e-9), number - 1)
        step = np.arange(-most, most + 1)
        origin = np.arange(number)[:, None] + step
        inside = (origin >= 0) & (origin < number)
        price = (step * (gap / _TENTH)) ** 2
        return cls(np.where(inside, origin, 0), np.where(inside, price, np.inf))

    def beside(self, angles: Index) -> Array:
        """The price of turning to each angle from those of other nodes (i,), (j, i); infinite where it is a jump."""
        middle = self.price.shape[1] // 2
        rows = np.arange(len(self.price))[:, None]
        step = angles - rows
        near = np.abs(step) <= middle
        column = np.where(near, step, 0) + middle
        return np.where(near, self.price[rows, column], np.inf)


class _AngleGraph(NamedTuple):
    """What angles cost at nodes (j, i, k) and which may be turned to from which."""

    price: Array
    usable: Bools
    sides: Index
    shut: Bools
    turns: _Turns

    @classmethod
    def of(cls, widths: Array, angles: Array, gates: SingularSides | None) -> "_AngleGraph":
        sides = np.zeros(widths.shape, dtype=np.intp)
        shut = np.zeros(widths.shape[1:], dtype=bool)
        if gates is not None:
            sides = gates.sides(angles)
            shut = gates.shut
        return cls(_price_of_narrowness(widths), widths > 0, sides, shut, _Turns.between(angles))

    def charge_from(self, beside: int, chosen: Index, k: int) -> Array:
        """What angles of a pass cost beside those chosen for another one, (j, i); infinite across walls and gates."""
        walls = _walls(self.usable[:, :, k], self.usable[:, :, beside])
        over_wall = walls != np.take_along_axis(walls, chosen[None], axis=0)
        side = self.sides[chosen, np.arange(len(chosen)), beside]
        shut = self.shut[:, k] | self.shut[:, beside]
        over_gate = (self.sides[:, :, k] != side) & shut
        charge = _ACROSS * self.turns.beside(chosen)
        return np.where(over_wall | over_gate, np.inf, charge)


def _cheapest(price: Array, graph: _AngleGraph, k: int) -> Index:
    """Places of the angles (i,) of a pass with the least sum of prices (j, i) and charges on turning.

    An angle that both of two nodes forbid is not turned across between them, nor a gate that one of them shuts.
    """
    origins = graph.turns.origin
    charge = _ALONG * graph.turns.price
    usable = graph.usable[:, :, k]
    sides = graph.sides[:, :, k]
    shut = graph.shut[:, k]
    walls = _walls(usable[:, :-1], usable[:, 1:])
    number = price.shape[1]
    rows = np.arange(len(price))
    total = price[:, 0].copy()
    origin = np.empty((number, len(price)), dtype=np.intp)
    for i in range(1, number):
        wall = walls[:, i - 1]
        way = wall[origins] == wall[:, None]
        if shut[i - 1] or shut[i]:
            way &= sides[origins, i - 1] == sides[:, i, None]
        ways = np.where(way, total[origins] + charge, np.inf)
        best = ways.argmin(axis=1)
        origin[i] = origins[rows, best]
        total = ways[rows, best] + price[:, i]
    chosen = np.empty(number, dtype=np.intp)
    chosen[-1] = int(total.argmin())
    for i in range(number - 1, 0, -1):
        chosen[i - 1] = origin[i, chosen[i]]
    return chosen


def narrowest(widths: Array, chosen: Index) -> Array:
    """Least strip width of each pass, (k,).

    Parameters
    ----------
    widths : (j, i, k) array
    chosen : (i, k) array of int
    """
    used = np.take_along_axis(widths, chosen[None], axis=0)[0]
    return np.asarray(used.min(axis=0))


def bands(widths: Array, angles: Array, chosen: Index, share: float,
          gates: SingularSides | None = None) -> tuple[Array, Array]:
    """Angles around those chosen at which no strip is narrower than a share of the narrowest of its pass, (i, k) each.

    Parameters
    ----------
    widths : (j, i, k) array
    angles : (j,) array
        rad
    chosen : (i, k) array of int
    share : float
        Of the width that a pass has at its narrowest place, 0 to 1.
    gates : SingularSides, optional
        No band goes through one that is shut.

    Returns
    -------
    low, high : (i, k) array
        rad; up to half a step short of the first angle that does not do.
    """
    good = widths >= share * narrowest(widths, chosen)
    if gates is not None:
        sides = gates.sides(angles)
        chosen_side = np.take_along_axis(sides, chosen[None], axis=0)
        good &= ~gates.shut | (sides == chosen_side)
    low = chosen.copy()
    high = chosen.copy()
    last = len(angles) - 1
    for _ in angles:
        down = np.maximum(low - 1, 0)
        up = np.minimum(high + 1, last)
        down_is_good = np.take_along_axis(good, down[None], axis=0)[0]
        up_is_good = np.take_along_axis(good, up[None], axis=0)[0]
        low = np.where(down_is_good, down, low)
        high = np.where(up_is_good, up, high)
    return angles[low], angles[high]


def smoothest(low: Array, high: Array, along: Array, step: Array) -> Array:
    """Angles between bounds with the least bends, (i, k) rad.

    Parameters
    ----------
    low, high : (i, k) array
        rad
    along, step : (i,), (k,) array
        Places of the nodes in mm, even.

    Notes
    -----
    **Properties**: 1. inside the bounds; 2. no other angles inside them have a smaller sum of squared second
    differences, mixed ones included, and small shares of first ones; 3. constant where a constant fits in.
    """
    common_low = float(low.max())
    common_high = float(high.min())
    if common_low <= common_high:
        return np.full(low.shape, (common_low + common_high) / 2)
    n, m = low.shape
    gap_along = (along[-1] - along[0]) / (n - 1)
    gap_across = (step[-1] - step[0]) / (m - 1)
    ratio = gap_across / gap_along
    slope_along = _differences(n, 1)
    slope_across = _differences(m, 1) / ratio
    bend_along = _differences(n, 2)
    bend_across = _differences(m, 2) / ratio**2
    rows = np.concatenate([
        np.kron(bend_along, np.eye(m)),
        np.kron(np.eye(n), bend_across),
        np.sqrt(2.0) * np.kron(slope_along, slope_across),
        _SLOPE * np.kron(slope_along, np.eye(m)),
        _SLOPE * np.kron(np.eye(n), slope_across),
    ])
    bounds_high = np.maximum(high, low)
    angles = _least_form(rows.T @ rows, low.ravel(), bounds_high.ravel())
    return angles.reshape(n, m)


def _least_form(form: Array, low: Array, high: Array) -> Array:
    """The least of a form x form x, which only constants make zero, between bounds that let no constant through: those
    that hold are exchanged until none is wrong.
    """
    middle = (float(low.max()) + float(high.min())) / 2
    x = np.full(len(low), middle)
    held = _sides_passed(x, low, high)
    for _ in range(_EXCHANGES):
        free = held == 0
        if free.all():
            break
        x = np.where(held > 0, high, x)
        x = np.where(held < 0, low, x)
        right = -form[np.ix_(free, ~free)] @ x[~free]
        x[free] = _solve_band(form[np.ix_(free, free)], right)
        slope = form @ x
        passed = _sides_passed(x, low - _TOUCH, high + _TOUCH)
        falls_inwards = held * slope > 0
        still_held = np.where(falls_inwards, 0, held)
        new = np.where(free, passed, still_held)
        if (new == held).all():
            return np.asarray(np.clip(x, low, high), dtype=float)
        held = new.astype(np.int8)
    return _by_descent(form, low, high)


def _sides_passed(x: Array, low: Array, high: Array) -> NDArray[np.int8]:
    """Which bound each number passes: -1 the lower one, 1 the upper one, 0 none."""
    above = np.where(x > high, 1, 0)
    return np.where(x < low, -1, above).astype(np.int8)


def _solve_band(matrix: Array, right: Array) -> Array:
    """The solution of equations whose matrix has few diagonals: the same on any number of threads, (n,)."""
    from scipy.linalg import solve_banded

    row, column = np.nonzero(matrix)
    away = row - column
    wide = int(np.abs(away).max(initial=0))
    height = 2 * wide + 1
    spend(_SOLVED * len(matrix) * height ** 2)
    diagonals = np.zeros((height, len(matrix)))
    diagonals[wide + row - column, column] = matrix[row, column]
    return np.asarray(solve_banded((wide, wide), diagonals, right))


def _by_descent(form: Array, low: Array, high: Array) -> Array:
    """The same where exchanging goes round in circles."""
    from scipy.optimize import minimize

    def value_and_slope(x: Array) -> tuple[float, Array]:
        return float(x @ form @ x / 2), form @ x

    bounds = list(zip(low, high, strict=True))
    begin = (low + high) / 2
    found = minimize(value_and_slope, begin, jac=True, method="L-BFGS-B", bounds=bounds, options=_TIGHT)
    return np.asarray(np.clip(found.x, low, high), dtype=float)


def _differences(count: int, order: int) -> Array:
    """First or second differences of so many numbers, as a matrix."""
    return np.asarray(np.diff(np.eye(count), order, axis=0))
