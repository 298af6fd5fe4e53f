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
    begins_above = start[:, fixed] > values[:, None]
    ends_above = end[:, fixed] > values[:, None]
    line, edge = np.nonzero(begins_above != ends_above)
    start, end = start[edge], end[edge]
    share = (values[line] - start[:, fixed]) / (end[:, fixed] - start[:, fixed])
    free = 1 - fixed
    crossing = start[:, free] + share * (end[:, free] - start[:, free])
    order = np.lexsort((crossing, line))
    line, crossing = line[order], crossing[order]
    # Lines are inside the loops from every other crossing to the next.
    return Intervals(line[::2], crossing[::2], crossing[1::2])


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
    most = max(1, int(count.max(initial=0)))
    out = np.full((lines, most, 2), np.inf)
    first = np.cumsum(count) - count
    slot = np.arange(len(rows.line)) - first[rows.line]
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
    lines: list[int] = []
    lows: list[float] = []
    highs: list[float] = []
    for k in order.tolist():
        line, low, high = int(rows.line[k]), float(rows.low[k]), float(rows.high[k])
        goes_on = bool(lines) and lines[-1] == line and low <= highs[-1]
        if goes_on:
            highs[-1] = max(highs[-1], high)
        else:
            lines.append(line)
            lows.append(low)
            highs.append(high)
    return Intervals(np.array(lines, dtype=np.intp), np.array(lows, dtype=float), np.array(highs, dtype=float))


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
    is_same_interval = points.interval[1:] == points.interval[:-1]
    holds_before = np.append(False, holds[:-1] & is_same_interval)
    holds_after = np.append(holds[1:] & is_same_interval, False)
    low = np.flatnonzero(holds & ~holds_before)
    high = np.flatnonzero(holds & ~holds_after)
    # The ends of each part lie between these points and their neighbours, where the interval goes on to these.
    has_before = np.append(False, is_same_interval)[low]
    has_after = np.append(is_same_interval, False)[high]
    good = np.append(low, high)
    bad = np.append(low - has_before, high + has_after)
    ends = _find_ends(test, line[good], place[good], place[bad], exact)
    return Intervals(line[low], ends[:len(low)], ends[len(low):])


def _find_ends(test: Callable[[Index, Array], NDArray[np.bool_]], line: Index, good: Array, bad: Array,
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
    low, high = columns[..., 0], columns[..., 1]
    start = np.maximum(low, place[:, None])
    return np.asarray(np.where(high > start, start, np.inf).min(axis=1))


def last_of(columns: Array) -> Array:
    """Last place on the face of each column, (n,); -inf where a column misses it."""
    high = columns[..., 1]
    return np.asarray(np.where(np.isfinite(high), high, -np.inf).max(axis=1))
