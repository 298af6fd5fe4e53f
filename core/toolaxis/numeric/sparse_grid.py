"""A function at some nodes of a grid: of millions of nodes often a few thousand matter."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]
Lines = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class SparseGrid:
    """A function at some nodes of a grid; at all others it is taken to be -1.

    Attributes
    ----------
    lines : pair of (m,) and (n,) arrays
        Coordinates of the lines of nodes.
    nodes : (k,) array of int
        Numbers of the nodes that are known, ascending: row times n plus column.
    values : (k,) array
        The function there.
    """

    lines: Lines
    nodes: Ints
    values: Array

    @classmethod
    def of_all(cls, lines: Lines, values: Array) -> "SparseGrid":
        """A grid of which all nodes are known.

        Parameters
        ----------
        lines : pair of (m,) and (n,) arrays
        values : (m, n) array
        """
        return cls(lines, np.arange(values.size), values.ravel())

    @classmethod
    def join(cls, lines: Lines, nodes: Sequence[Ints], values: Sequence[Array]) -> "SparseGrid":
        """A grid of parts that hold nodes more than once: what comes last counts.

        Parameters
        ----------
        lines : pair of (m,) and (n,) arrays
        nodes : sequence of (k,) arrays of int
            Of each part.
        values : sequence of (k,) arrays
            Of each part.
        """
        if not nodes:
            return cls(lines, np.empty(0, dtype=np.int64), np.empty(0))
        found, last = np.unique(np.concatenate(nodes)[::-1], return_index=True)
        return cls(lines, found, np.concatenate(values)[::-1][last])

    @property
    def shape(self) -> tuple[int, int]:
        """Number of lines of either coordinate."""
        return len(self.lines[0]), len(self.lines[1])

    @property
    def above(self) -> Ints:
        """Numbers of the nodes above zero, ascending, (k,)."""
        return self.nodes[self.values > 0]

    def places_of(self, nodes: Ints) -> Array:
        """Coordinates of nodes, (k, 2).

        Parameters
        ----------
        nodes : (k,) array of int
        """
        row, column = np.divmod(nodes, self.shape[1])
        return np.column_stack([self.lines[0][row], self.lines[1][column]])

    def values_at(self, nodes: Ints) -> Array:
        """The function at nodes, (k,).

        Parameters
        ----------
        nodes : (k,) array of int
        """
        found = np.full(len(nodes), -1.0)
        if not len(self.nodes):
            return found
        at = np.minimum(np.searchsorted(self.nodes, nodes), len(self.nodes) - 1)
        known = self.nodes[at] == nodes
        found[known] = self.values[at[known]]
        return found

    def mark_above(self) -> Bools:
        """Which nodes are above zero, with one line more on all sides, (m + 2, n + 2)."""
        rows, columns = self.shape
        marked = np.zeros((rows + 2, columns + 2), dtype=bool)  # pages that nobody writes to cost nothing
        row, column = np.divmod(self.above, columns)
        marked[row + 1, column + 1] = True
        return marked

    def cells_on_border(self) -> NDArray[np.intp]:
        """Lower corners of the cells that have corners above zero and others, (k, 2), row by row.

        They are those of `mark_above`, with the cells beyond the border of the grid.
        """
        marked = self.mark_above()
        width = marked.shape[1]
        row, column = np.divmod(self.above, self.shape[1])
        corner = row * width + column
        touched = np.unique(np.concatenate([corner, corner + 1, corner + width, corner + width + 1]))
        i, j = np.divmod(touched, width)
        lower = marked[i, j] & marked[i, j + 1]
        upper = marked[i + 1, j] & marked[i + 1, j + 1]
        whole = lower & upper
        return np.column_stack([i[~whole], j[~whole]])
