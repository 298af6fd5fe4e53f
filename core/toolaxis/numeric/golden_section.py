"""The least value of many functions of one variable at once."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GOLDEN = 0.5 * (5**0.5 - 1)


def least_between(function: Callable[[Array], Array], low: Array, high: Array, steps: int = 40) -> tuple[Array, Array]:
    """Where each function is least between two ends, and its value there, by golden section.

    A function with several minima in its range answers with one of them, never with more than at both ends.

    Parameters
    ----------
    function : callable
        Maps (n,) arguments to (n,) values, one function a row.
    low, high : (n,) array
    steps : int
        Each narrows the range to 0.618 of its width; 40 steps to 4e-9.

    Returns
    -------
    argument, value : (n,) arrays
    """
    a, b = np.array(low, dtype=float), np.array(high, dtype=float)
    best, value = a.copy(), function(a)
    _keep(best, value, b, function(b))
    c, d = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
    fc, fd = function(c), function(d)
    for _ in range(steps):
        left = fc < fd
        a, b = np.where(left, a, c), np.where(left, d, b)
        c, d = np.where(left, b - GOLDEN * (b - a), d), np.where(left, c, a + GOLDEN * (b - a))
        fresh = function(np.where(left, c, d))
        fc, fd = np.where(left, fresh, fd), np.where(left, fc, fresh)
    _keep(best, value, c, fc)
    _keep(best, value, d, fd)
    return best, value


def _keep(best: Array, value: Array, argument: Array, found: Array) -> None:
    better = found < value
    best[better], value[better] = argument[better], found[better]
