"""Points of a plane sorted into square cells: the kernel finds the nearest of them to a place."""

from math import floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_unfused, jit_unfused_inline

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Cells along the longer side at most.
_MOST = 512


class PointGrid(NamedTuple):
    """Points sorted into square cells over the box around them.

    points : (n, 2) array, cell by cell;  number : (n,) array of int, what each was before it was sorted
    start : (cells + 1,) array of int, the first point of each cell;  low : (2,) array, lower corner of the box
    size : edge of a cell;  columns, rows : number of cells along x and y
    """

    points: Array
    number: Index
    start: Index
    low: Array
    size: float
    columns: int
    rows: int


def sort_into_cells(points: Array, size: float | None = None) -> PointGrid:
    """Points sorted into cells.

    Parameters
    ----------
    points : (n, 2) array
    size : float, optional
        Edge of a cell, unless that makes too many; as many cells as points unless given.
    """
    low, span = points.min(axis=0), np.ptp(points, axis=0)
    if size is None:
        size = float(np.sqrt(span[0] * span[1] / len(points)))
    edge = max(size, float(span.max()) / _MOST, np.finfo(float).tiny)
    columns, rows = (int(count) for count in np.floor(span / edge) + 1)
    place = np.minimum(np.floor((points - low) / edge).astype(np.int64), [columns - 1, rows - 1])
    cell = place[:, 0] * rows + place[:, 1]
    number = np.argsort(cell, kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=columns * rows))])
    return PointGrid(np.ascontiguousarray(points[number]), number.astype(np.int64), start.astype(np.int64), low, edge,
                     columns, rows)


@jit_unfused_inline
def _cell_at(way: float, size: float, count: int) -> int:
    """The cell in which a distance from the lower corner lies, or the nearest one."""
    position = way / size
    if not position > 0.0:
        return 0
    return count - 1 if position >= count else floor(position)


@jit_unfused_inline
def _look_into_cells(grid: PointGrid, first: int, last: int, x: float, y: float, nearest: Index,
                     square: Array) -> None:
    """Put points of cells first to last into the list of the nearest ones."""
    most = nearest.shape[0]
    for k in range(grid.start[first], grid.start[last + 1]):
        dx, dy = grid.points[k, 0] - x, grid.points[k, 1] - y
        away = dx * dx + dy * dy
        if away >= square[most - 1]:
            continue
        at = most - 1
        while at > 0 and away < square[at - 1]:
            square[at], nearest[at] = square[at - 1], nearest[at - 1]
            at -= 1
        square[at], nearest[at] = away, grid.number[k]


@jit_unfused
def find_nearest(grid: PointGrid, x: float, y: float, limit: float, nearest: Index, square: Array) -> None:
    """Numbers of the nearest points to a place, the nearest first.

    Cells are looked at in rings around that of the place, until what is farther out cannot be nearer.

    Parameters
    ----------
    grid : PointGrid
    x, y : float
    limit : float
        Where no point is nearer than that, the search may end with none; infinite for no limit.
    nearest : (k,) array of int
        Receives the numbers, -1 where there are fewer.
    square : (k,) array
        Receives the squares of the distances.
    """
    most = nearest.shape[0]
    nearest[:], square[:] = -1, np.inf
    i, j = _cell_at(x - grid.low[0], grid.size, grid.columns), _cell_at(y - grid.low[1], grid.size, grid.rows)
    rings = max(max(i, grid.columns - 1 - i), max(j, grid.rows - 1 - j))
    for ring in range(rings + 1):
        seen = (ring - 1) * grid.size  # so far around the place nothing is left to be looked at
        if ring > 0 and (square[most - 1] <= seen * seen or (seen >= limit and square[0] >= limit * limit)):
            return
        low, high = max(j - ring, 0), min(j + ring, grid.rows - 1)
        for column in range(max(i - ring, 0), min(i + ring, grid.columns - 1) + 1):
            first = column * grid.rows
            if column == i - ring or column == i + ring:
                _look_into_cells(grid, first + low, first + high, x, y, nearest, square)
                continue
            if j - ring >= 0:
                _look_into_cells(grid, first + j - ring, first + j - ring, x, y, nearest, square)
            if j + ring < grid.rows and ring > 0:
                _look_into_cells(grid, first + j + ring, first + j + ring, x, y, nearest, square)
