"""Rows that are divided, each into a number of parts of its own: edges into steps, motions into shorter ones."""

import numpy as np
from numpy.typing import NDArray


def number_parts(counts: NDArray[np.integer]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The row that each part belongs to, and its number within that row.

    Parameters
    ----------
    counts : (n,) array of int
        Parts of each row; none is a number too.

    Returns
    -------
    row, number : (sum of counts,) arrays of int
        All parts, row by row: 0, 1, ... for each of them.

    Examples
    --------
    >>> row, number = number_parts(np.array([2, 0, 3]))
    >>> row.tolist(), number.tolist()
    ([0, 0, 2, 2, 2], [0, 1, 0, 1, 2])
    """
    row = np.repeat(np.arange(len(counts)), counts)
    first = np.cumsum(counts) - counts
    return row, np.arange(len(row)) - first[row]
