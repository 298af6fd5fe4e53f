"""Functions of rows on long arrays: some rows at a time, so that what they need in between stays small."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Made = TypeVar("Made", bound=NDArray[Any])

#: Rows at a time; fewer are taken in one piece.
BLOCK = 50_000


def in_blocks(function: Callable[..., Made], *arrays: Array, size: int = BLOCK) -> Made:
    """What a function of rows makes of arrays.

    Parameters
    ----------
    function : callable
        Takes the arrays, (n, ...) each, and returns (n, ...); what it makes of a row does not depend on the others.
    *arrays : (n, ...) arrays
    size : int
        Rows at a time, at most.

    Examples
    --------
    >>> in_blocks(lambda a, b: a + b, np.arange(5.0), np.ones(5), size=2)
    array([1., 2., 3., 4., 5.])
    >>> in_blocks(np.sqrt, np.empty(0))
    array([], dtype=float64)
    """
    count = len(arrays[0])
    if count <= size:
        return function(*arrays)
    return np.concatenate([function(*(rows[first:first + size] for rows in arrays))  # type: ignore[return-value]
                           for first in range(0, count, size)])
