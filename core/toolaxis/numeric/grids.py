"""Nodes of grids from the lines of each coordinate."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def grid_nodes(*lines: ArrayLike) -> Array:
    """Nodes of a grid, (m, n, ..., k) for k coordinates.

    Parameters
    ----------
    *lines : (m,), (n,), ... array_like
        Where the lines of each coordinate lie.
    """
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)


def grid_rows(*lines: ArrayLike) -> Array:
    """Nodes of a grid as rows, (m n ..., k) for k coordinates: the last one changes fastest.

    Parameters
    ----------
    *lines : (m,), (n,), ... array_like
        Where the lines of each coordinate lie.

    Examples
    --------
    >>> grid_rows([0.0, 1.0], [5.0, 6.0]).tolist()
    [[0.0, 5.0], [0.0, 6.0], [1.0, 5.0], [1.0, 6.0]]
    """
    return grid_nodes(*lines).reshape(-1, len(lines))
