"""A grid over a face on which it is looked where a function is above zero: closely where it is, and along the border.

What passes leave lies at the border nearly always, in pieces much smaller than the face: the function is asked along
all of the border, at the nodes of coarse cells and at places that are given, and at all fine nodes of the
cells in which that finds something and of those beside them, as far as it goes on. Inside of large pieces it is not
asked at each node: cells of which all is far above zero are known from their middle.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_nodes
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.sparse_grid import SparseGrid
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]
Lines = tuple[Array, Array]

#: Coarse cells along a side, fewest and most, and the greatest number of fine ones unless another one is given.
_FEWEST, _COARSE, FINE = 24, 72, 1500
#: Pieces into which a loop is divided at least to measure it, and the most places along it.
_PIECES, _PLACES = 64, 20_000
#: Cells along a side whose lengths tell how long it is.
_MEASURED = 16
#: Cells with no more fine ones along a side are looked at node by node.
_SMALL = 2
#: Fine cells along a side of the blocks that are looked at again.
_BLOCK = 16
#: Corners and middles of the sides of a cell, as shares of it.
_AROUND = np.array([[0, 0], [0.5, 0], [1, 0], [1, 0.5], [1, 1], [0.5, 1], [0, 1], [0, 0.5]])


def sample_grid(face: Face, function: Callable[[Array], Array], size: float,
                whole: Callable[[Array, Array], Bools], between: Array | None = None,
                most: int = FINE) -> SparseGrid:
    """A function at nodes of a grid somewhat beyond a face, as far as cells around hold something above zero.

    Parameters
    ----------
    face : Face
    function : callable
        Takes (n, 2) parameters, beyond the face too, and returns (n,) numbers.
    size : float
        Size of the fine cells, mm.
    whole : callable
        Takes the middles of cells, (k, 2), with corners and middles of the sides of each, (k, 8, 2), and tells which
        cells are above zero everywhere, (k,) bool; False where that is not known.
    between : (k, 2) array, optional
        Further parameters at which it is asked, those beside the face left out.
    most : int
        Fine cells along a side of the face at most: they are larger than asked for where it is longer.

    Returns
    -------
    SparseGrid
        Over the parameters u and v, with the nodes at which it was asked.
    """
    coarse_u, parts_u = _lines(face, 0, size, most)
    coarse_v, parts_v = _lines(face, 1, size, most)
    coarse = (coarse_u, coarse_v)
    nodes = grid_nodes(*coarse)
    inside = face.contains(nodes.reshape(-1, 2)).reshape(nodes.shape[:2])
    above = np.zeros_like(inside)
    above[inside] = function(nodes[inside]) > 0
    wanted = _touches_corner(above)
    asked = [_places(face, loop, size) for loop in face.outline]
    if between is not None:
        asked.append(between[face.contains(between)])
    places = np.concatenate(asked)
    wanted[_cells_of(coarse, places[function(places) > 0])] = True
    lines = (_divide_line(coarse_u, parts_u), _divide_line(coarse_v, parts_v))
    found = _AskedNodes(function, whole, lines)
    own = _own(face, coarse, inside)
    done = np.zeros_like(wanted)
    while wanted.any():
        further = np.zeros_like(wanted)
        cells = np.argwhere(wanted)
        first = cells * (parts_u, parts_v)
        last = (cells + 1) * (parts_u, parts_v)
        found.ask(np.hstack([first, last]))
        for (i, j), (i0, j0), (i1, j1) in zip(cells, first, last, strict=True):
            _go_on(found.above[i0:i1 + 1, j0:j1 + 1], (int(i), int(j)), further)
        done |= wanted
        wanted = further & own & ~done
    return SparseGrid.join(lines, found.nodes, found.values)


def sample_again(grid: SparseGrid, function: Callable[[Array], Array],
                 whole: Callable[[Array, Array], Bools]) -> SparseGrid:
    """The lesser of a function at the nodes of a grid and of what was found there before, where that is above zero.

    Parameters
    ----------
    grid : SparseGrid
        As from `sample_grid`.
    function, whole
        As for `sample_grid`.
    """
    found = _AskedNodes(function, whole, grid.lines, among=grid.above)
    found.ask(_blocks_above(grid))
    new = SparseGrid.join(grid.lines, found.nodes, found.values)
    above = np.flatnonzero(grid.values > 0)
    known = np.isin(grid.nodes[above], new.nodes, assume_unique=True)
    seen = above[known]
    values = grid.values.copy()
    values[seen] = np.minimum(values[seen], new.values_at(grid.nodes[seen]))
    return SparseGrid(grid.lines, grid.nodes, values)


def _blocks_above(grid: SparseGrid) -> Ints:
    """Blocks that hold nodes above zero, (k, 4) first and last lines of each.

    The last line of a block is the first of the next one, and the last line of the grid begins none.
    """
    rows, columns = grid.shape
    last_row = (rows - 2) // _BLOCK
    last_column = (columns - 2) // _BLOCK
    row, column = np.divmod(grid.above, columns)
    i = np.minimum(row // _BLOCK, last_row)
    j = np.minimum(column // _BLOCK, last_column)
    numbers = np.unique(i * (last_column + 1) + j)
    first = np.column_stack(np.divmod(numbers, last_column + 1)) * _BLOCK
    last = np.minimum(first + _BLOCK, (rows - 1, columns - 1))
    return np.hstack([first, last])


def _touches_corner(nodes: Bools) -> Bools:
    """Cells of which some corner is marked."""
    return np.asarray(nodes[1:, 1:] | nodes[:-1, 1:] | nodes[1:, :-1] | nodes[:-1, :-1])


class _AskedNodes:
    """What a function says at nodes of a grid.

    nodes : list of (k,) arrays of int, their numbers;  values : list of (k,) arrays, 1 where it is sure to be above
    zero;  above : (m, n) array of bool, of all that was asked last.
    """

    def __init__(self, function: Callable[[Array], Array], whole: Callable[[Array, Array], Bools], lines: Lines,
                 among: Ints | None = None) -> None:
        """Of the nodes that are not sure it is asked only among some, ascending, where these are given."""
        self._function, self._whole, self._lines, self._among = function, whole, lines, among
        self.nodes: list[Ints] = []
        self.values: list[Array] = []
        # Nobody writes to most of it, and pages without writing cost nothing.
        self.above = np.zeros((len(lines[0]), len(lines[1])), dtype=bool)

    def ask(self, blocks: Ints) -> None:
        """Ask at all nodes of blocks, (k, 4) first and last lines of each."""
        columns = self.above.shape[1]
        small_ones = []
        while len(blocks):
            small = (blocks[:, 2:] - blocks[:, :2]).max(axis=1) <= _SMALL
            small_ones.append(blocks[small])
            blocks = blocks[~small]
            low = np.column_stack([line[blocks[:, k]] for k, line in enumerate(self._lines)])
            high = np.column_stack([line[blocks[:, k + 2]] for k, line in enumerate(self._lines)])
            around = low[:, None] + _AROUND * (high - low)[:, None]
            sure = self._whole((low + high) / 2, around)
            for i0, j0, i1, j1 in blocks[sure]:
                nodes = np.arange(i0, i1 + 1)[:, None] * columns + np.arange(j0, j1 + 1)
                self._keep(nodes.ravel(), np.ones(nodes.size))
            blocks = _quarters(blocks[~sure])
        nodes = _nodes_of(small_ones, columns)
        if self._among is not None:
            nodes = nodes[np.isin(nodes, self._among, assume_unique=True)]
        row, column = np.divmod(nodes, columns)
        self._keep(nodes, self._function(np.column_stack([self._lines[0][row], self._lines[1][column]])))

    def _keep(self, nodes: Ints, values: Array) -> None:
        self.nodes.append(nodes)
        self.values.append(values)
        self.above.ravel()[nodes] = values > 0


def _nodes_of(blocks: list[Ints], columns: int) -> Ints:
    """Numbers of all nodes of small blocks, each once, ascending; a grid may have millions of others."""
    if not blocks:
        return np.empty(0, dtype=np.int64)
    i0, j0, i1, j1 = np.concatenate(blocks).T
    found = []
    for down in range(_SMALL + 1):
        for across in range(_SMALL + 1):
            there = (i0 + down <= i1) & (j0 + across <= j1)
            found.append((i0[there] + down) * columns + j0[there] + across)
    return np.unique(np.concatenate(found))


def _quarters(blocks: Ints) -> Ints:
    """Blocks divided along both sides, those of one cell along that side across it alone."""
    i0, j0, i1, j1 = blocks.T
    i = (i0 + i1 + 1) // 2
    j = (j0 + j1 + 1) // 2
    quarters = [(i0, j0, i, j), (i0, j, i, j1), (i, j0, i1, j), (i, j, i1, j1)]
    found = np.concatenate([np.column_stack(quarter) for quarter in quarters])
    real = (found[:, 0] < found[:, 2]) & (found[:, 1] < found[:, 3])
    return np.asarray(found[real])


def _go_on(above: Bools, cell: tuple[int, int], further: Bools) -> None:
    """Mark the cells beside one into which what is above zero in it goes on."""
    i, j = cell
    rows, columns = further.shape
    beside = ((i - 1, j, above[0]), (i + 1, j, above[-1]), (i, j - 1, above[:, 0]), (i, j + 1, above[:, -1]))
    for row, column, side in beside:
        there = 0 <= row < rows and 0 <= column < columns
        if there and side.any():
            further[row, column] = True


def _lines(face: Face, axis: int, size: float, most: int) -> tuple[Array, int]:
    """Lines of coarse cells along one parameter, one cell farther than the face on both sides; fine cells in each."""
    low = face.bounds[2 * axis]
    high = face.bounds[2 * axis + 1]
    u = np.linspace(*face.bounds[:2], _MEASURED + 1)
    v = np.linspace(*face.bounds[2:], _MEASURED + 1)
    nodes = grid_nodes(u, v)
    points = face.evaluate(nodes.reshape(-1, 2)).point.reshape(*nodes.shape[:2], 3)
    steps = np.linalg.norm(np.diff(points, axis=axis), axis=-1)
    length = float(steps.sum(axis=axis).max())
    fine = float(np.clip(np.ceil(length / size), _FEWEST, most))
    count = int(np.clip(np.ceil(fine / 8), _FEWEST, _COARSE))
    pitch = (high - low) / (count - 0.137)  # no line lies on an end of the range
    lines = low - 1.0637 * pitch + pitch * np.arange(count + 3)
    return np.asarray(lines), int(np.ceil(fine / count))


def _divide_line(line: Array, parts: int) -> Array:
    share = np.arange(parts) / parts
    between = line[:-1, None] + np.diff(line)[:, None] * share
    return np.append(between.ravel(), line[-1])


def _cells_of(coarse: tuple[Array, ...], places: Array) -> tuple[NDArray[np.intp], ...]:
    """Coarse cells in which places lie."""
    found = []
    for line, along in zip(coarse, places.T, strict=True):
        cell = np.searchsorted(line, along, side="right") - 1
        found.append(np.clip(cell, 0, len(line) - 2))
    return tuple(found)


def _own(face: Face, coarse: tuple[Array, ...], inside: Bools) -> Bools:
    """Which coarse cells hold some of the face; with the nodes that are inside of it."""
    found = _touches_corner(inside)
    pitch = np.array([line[1] - line[0] for line in coarse])
    for loop in face.outline:
        edges = np.roll(loop, -1, axis=0) - loop
        crossed = (np.abs(edges) / pitch).max(axis=1)
        parts = np.maximum(np.ceil(crossed * 4), 1).astype(int)
        found[_cells_of(coarse, _between(loop, parts))] = True
    return np.asarray(found)


def _places(face: Face, loop: Array, size: float) -> Array:
    """Places along a loop, no farther apart than a size, mm, (n, 2)."""
    parts_each = max(1, math.ceil(_PIECES / len(loop)))
    pieces = _between(loop, np.full(len(loop), parts_each))
    point = face.evaluate(pieces).point
    length = np.linalg.norm(np.roll(point, -1, axis=0) - point, axis=1)
    step = max(size, float(length.sum()) / _PLACES)
    return _between(pieces, np.ceil(length / step).astype(int) + 1)


def _between(loop: Array, parts: NDArray[np.int64]) -> Array:
    """Vertices of a loop and places between them, that divide each edge into parts."""
    edge, number = number_parts(parts)
    share = (number / parts[edge])[:, None]
    start = loop[edge]
    end = np.roll(loop, -1, axis=0)[edge]
    return np.asarray(start * (1 - share) + end * share)
