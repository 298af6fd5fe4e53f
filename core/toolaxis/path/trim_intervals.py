"""Where straight lines in a parameter plane run over the face: even-odd intervals between its loops."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.parts import number_parts

Array = NDArray[np.float64]
Index = NDArray[np.intp]


class Intervals(NamedTuple):
    """Pieces of parallel lines that lie on the face, sorted by line and place.

    line : (k,) array of int, which line;  low, high : (k,) arrays, from where to where.
    """

    line: Index
    low: Array
    high: Array


class RowPoints(NamedTuple):
    """Points along intervals, ends included.

    interval : (n,) array of int, which interval;  along : (n,) array, place on its line.
    """

    interval: Index
    along: Array


def intervals(loops: tuple[Array, ...], values: Array, fixed: int) -> Intervals:
    """Intervals of lines inside closed loops.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Closed loops, the outer one and holes alike.
    values : (n,) array
        Where each line runs: the value of the fixed coordinate.
    fixed : int
        0 for lines on which the first coordinate is fixed, 1 for the second.

    Returns
    -------
    Intervals; a line that misses the loops, or only touches them, has none.
    """
    start = np.concatenate(loops)
    end = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    a, b = start[:, fixed], end[:, fixed]
    line, edge = np.nonzero((a > values[:, None]) != (b > values[:, None]))
    share = (values[line] - a[edge]) / (b[edge] - a[edge])
    free = 1 - fixed
    place = start[edge, free] + share * (end[edge, free] - start[edge, free])
    order = np.lexsort((place, line))
    line, place = line[order], place[order]
    return Intervals(line[::2], place[::2], place[1::2])


def row_points(rows: Intervals, spacing: float, least: int = 4) -> RowPoints:
    """Evenly spaced points along intervals, both ends included.

    Parameters
    ----------
    rows : Intervals
    spacing : float
        Greatest distance between neighbours.
    least : int
        Least number of gaps per interval.
    """
    length = rows.high - rows.low
    gaps = np.maximum(np.ceil(length / spacing - 1e-9).astype(np.int64), least)
    interval, number = number_parts(gaps + 1)
    share = number / gaps[interval]
    along = rows.low[interval] * (1 - share) + rows.high[interval] * share
    return RowPoints(interval, along)


def table(rows: Intervals, lines: int) -> Array:
    """Intervals as one padded array.

    Parameters
    ----------
    rows : Intervals
    lines : int
        Number of lines.

    Returns
    -------
    (lines, k, 2) array of low and high ends, padded with inf; k at least 1
    """
    count = np.bincount(rows.line, minlength=lines)
    out = np.full((lines, max(1, int(count.max(initial=0))), 2), np.inf)
    slot = np.arange(len(rows.line)) - (np.cumsum(count) - count)[rows.line]
    out[rows.line, slot, 0] = rows.low
    out[rows.line, slot, 1] = rows.high
    return out


def merge_intervals(rows: Intervals) -> Intervals:
    """Intervals of the same line that meet or overlap made one.

    Parameters
    ----------
    rows : Intervals
        In any order.
    """
    order = np.lexsort((rows.low, rows.line))
    line, low, high = rows.line[order], rows.low[order], rows.high[order]
    keep: list[tuple[int, float, float]] = []
    for i, a, b in zip(line.tolist(), low.tolist(), high.tolist(), strict=True):
        if keep and keep[-1][0] == i and a <= keep[-1][2]:
            keep[-1] = (i, keep[-1][1], max(keep[-1][2], b))
        else:
            keep.append((i, a, b))
    whole = np.array(keep, dtype=float).reshape(-1, 3)
    return Intervals(whole[:, 0].astype(np.intp), whole[:, 1], whole[:, 2])


def filter_intervals(rows: Intervals, test: Callable[[Index, Array], NDArray[np.bool_]], spacing: float,
                     exact: float) -> Intervals:
    """The parts of intervals where a test holds, their ends found by bisection.

    Parameters
    ----------
    rows : Intervals
    test : callable
        Takes line (n,) and place (n,), returns (n,) bool.
    spacing : float
        Distance at which the test is asked; parts and gaps that are shorter may be missed.
    exact : float
        How far ends may lie inside of where the test ends to hold.
    """
    if not len(rows.line):
        return rows
    points = row_points(rows, spacing)
    line, place = rows.line[points.interval], points.along
    holds = test(line, place)
    before = np.append(False, holds[:-1] & (points.interval[1:] == points.interval[:-1]))
    after = np.append(holds[1:] & (points.interval[1:] == points.interval[:-1]), False)
    low, high = np.flatnonzero(holds & ~before), np.flatnonzero(holds & ~after)
    before_low = np.where(_same(points.interval, low, -1), low - 1, low)
    after_high = np.where(_same(points.interval, high, 1), high + 1, high)
    ends = _edge(test, np.append(line[low], line[high]), place[np.append(low, high)],
                 place[np.append(before_low, after_high)], exact)
    return Intervals(line[low], ends[:len(low)], ends[len(low):])


def _same(interval: Index, i: Index, shift: int) -> NDArray[np.bool_]:
    other = np.clip(i + shift, 0, len(interval) - 1)
    return np.asarray((other != i) & (interval[other] == interval[i]))


def _edge(test: Callable[[Index, Array], NDArray[np.bool_]], line: Index, good: Array, bad: Array,
          exact: float) -> Array:
    """Last place on each line, from a good one towards a bad one, at which the test holds."""
    good, bad = good.copy(), bad.copy()
    while True:
        rows = np.flatnonzero(np.abs(bad - good) > exact)
        if not len(rows):
            return good
        middle = (good[rows] + bad[rows]) / 2
        holds = test(line[rows], middle)
        good[rows[holds]] = middle[holds]
        bad[rows[~holds]] = middle[~holds]


def first_from(columns: Array, place: Array) -> Array:
    """First place on the face at or above given places.

    Parameters
    ----------
    columns : (n, k, 2) array
        As `table` returns it.
    place : (n,) array

    Returns
    -------
    (n,) array; inf where nothing is left.
    """
    start = np.maximum(columns[..., 0], place[:, None])
    return np.asarray(np.where(columns[..., 1] > start, start, np.inf).min(axis=1))


def last_of(columns: Array) -> Array:
    """Last place on the face of each column, (n,); -inf where a column misses it."""
    return np.asarray(np.where(np.isfinite(columns[..., 1]), columns[..., 1], -np.inf).max(axis=1))
