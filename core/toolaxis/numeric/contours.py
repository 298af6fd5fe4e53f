"""Closed lines around the places where a function is above zero, by marching squares on a grid."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.sparse_grid import SparseGrid

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

_STEPS = 24
#: Corners of a cell, anticlockwise, and the edges between them: (di, dj) of a corner; edge k runs from k to k + 1.
_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


def contours(grid: SparseGrid, function: Callable[[Array], Array] | None = None,
             halvings: int = _STEPS) -> tuple[Array, ...]:
    """Closed polygons around the places where a function is above zero.

    Parameters
    ----------
    grid : SparseGrid
        The function at the nodes of a grid; what is above zero on the grid's border is closed along the border.
    function : callable, optional
        Takes (k, 2) points and returns (k,) values: vertices are put where it vanishes, by bisection, instead of where
        a straight line between the nodes does.
    halvings : int
        Of the edge of a cell, to find where it vanishes.

    Returns
    -------
    tuple of (k, 2) arrays
        Points inside an odd number of them are above zero; features smaller than a cell may be missed.

    **Properties**: 1. no two polygons cross; 2. every vertex lies on a line of the grid.
    """
    above = grid.mark_above()
    at = _vertices(grid, above, function, halvings)
    joined: dict[tuple[int, int, int], list[tuple[int, int, int]]] = {}
    for i, j in grid.cells_on_border().tolist():
        for one, other in _segments(grid, above, i, j):
            joined.setdefault(one, []).append(other)
            joined.setdefault(other, []).append(one)
    return _trace_lines(joined, at)


def _vertices(grid: SparseGrid, above: Bools, function: Callable[[Array], Array] | None,
              halvings: int) -> dict[tuple[int, int, int], Array]:
    """Where edges of the grid cross zero, by axis along which the edge runs and its lower node.

    above : of the nodes of the grid with one more around it
    """
    along_first = _crossed_edges(grid, above, (1, 0))
    along_second = _crossed_edges(grid, above, (0, 1))
    along_second = along_second[np.lexsort(along_second.T)]  # one column after the other
    low = np.concatenate([along_first, along_second])
    if not len(low):
        return {}
    high = np.concatenate([along_first + np.array([1, 0]), along_second + np.array([0, 1])])
    turned = ~above[low[:, 0], low[:, 1]][:, None]
    inner = np.where(turned, high, low)
    beyond = np.where(turned, low, high)
    good = _places_of(grid, inner)
    bad = _places_of(grid, beyond)
    high_value = _values_at(grid, inner)
    low_value = _values_at(grid, beyond)
    share = (high_value / (high_value - low_value))[:, None]
    # Beyond the grid's border there is nothing: lines run along it.
    last = np.array(above.shape) - 1
    outer = ((beyond == 0) | (beyond == last)).any(axis=1)
    points = np.where(outer[:, None], good, (1 - share) * good + share * bad)
    if function is not None and not outer.all():
        points[~outer] = _bisect(function, good[~outer], bad[~outer], halvings)
    axis = [0] * len(along_first) + [1] * len(along_second)
    keys = zip(axis, *low.T.tolist(), strict=True)
    return dict(zip(keys, points, strict=True))


def _crossed_edges(grid: SparseGrid, above: Bools, step: tuple[int, int]) -> Ints:
    """Lower nodes of the edges along one coordinate that cross zero, one row after the other, (k, 2)."""
    row_and_column = np.divmod(grid.above, grid.shape[1])
    node = np.column_stack(row_and_column) + 1  # of the grid with one more around it
    before = node - step
    behind = node + step
    is_first = ~above[before[:, 0], before[:, 1]]
    is_last = ~above[behind[:, 0], behind[:, 1]]
    low = np.concatenate([before[is_first], node[is_last]])
    order = np.lexsort((low[:, 1], low[:, 0]))
    return np.asarray(low[order])


def _places_of(grid: SparseGrid, nodes: Ints) -> Array:
    """Coordinates of nodes, (k, 2), of the grid with one more around it, which lie where its border does."""
    last = np.array(grid.shape) - 1
    inner = np.clip(nodes - 1, 0, last)
    return np.column_stack([grid.lines[0][inner[:, 0]], grid.lines[1][inner[:, 1]]])


def _values_at(grid: SparseGrid, nodes: Ints) -> Array:
    """Values at nodes, (k, 2), of the grid with one more around it, where they are -1."""
    rows, columns = grid.shape
    inside = ((nodes > 0) & (nodes <= (rows, columns))).all(axis=1)
    found = np.full(len(nodes), -1.0)
    found[inside] = grid.values_at((nodes[inside, 0] - 1) * columns + nodes[inside, 1] - 1)
    return found


def _bisect(function: Callable[[Array], Array], good: Array, bad: Array, halvings: int) -> Array:
    for _ in range(halvings):
        middle = (good + bad) / 2
        holds = (function(middle) > 0)[:, None]
        good = np.where(holds, middle, good)
        bad = np.where(holds, bad, middle)
    return (good + bad) / 2


def _segments(grid: SparseGrid, above: Bools, i: int,
              j: int) -> list[tuple[tuple[int, int, int], tuple[int, int, int]]]:
    """Pieces of the line through one cell; where all four edges are crossed, the mean of the corners decides."""
    edges = ((0, i, j), (1, i + 1, j), (0, i, j + 1), (1, i, j))
    corner = [bool(above[i + a, j + b]) for a, b in _CORNERS]
    crossed = [k for k in range(4) if corner[k] != corner[(k + 1) % 4]]
    if len(crossed) == 2:
        first, second = crossed
        return [(edges[first], edges[second])]
    around = np.array([(i + a, j + b) for a, b in _CORNERS])
    middle = float(_values_at(grid, around).sum()) > 0
    if middle != corner[1]:
        return [(edges[0], edges[1]), (edges[2], edges[3])]
    return [(edges[3], edges[0]), (edges[1], edges[2])]


def _trace_lines(joined: dict[tuple[int, int, int], list[tuple[int, int, int]]],
                 at: dict[tuple[int, int, int], Array]) -> tuple[Array, ...]:
    """Vertices one after the other around each polygon."""
    loops = []
    left = dict.fromkeys(joined)
    while left:
        key = next(iter(left))
        line = []
        while key in left:
            del left[key]
            line.append(at[key])
            key = next((other for other in joined[key] if other in left), key)
        loop = np.array(line)
        loop = loop[(loop != np.roll(loop, 1, axis=0)).any(axis=1)]
        if len(loop) > 2:
            loops.append(loop)
    return tuple(loops)
