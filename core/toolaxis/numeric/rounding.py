"""Numbers rounded to where they count as equal.

The same surface read by two geometry kernels differs in its last digits, and so do sums taken in another order.  Where
many axes cost the same, these digits alone would decide which one comes first, and the search would go another way.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Decimals of amounts in mm and rad, and of shares; and of prices, which are sums over many passes.
_AMOUNT, _PRICE = 9, 6


def round_significant(values: ArrayLike) -> NDArray[np.float64]:
    """Amounts rounded, so that those that are equal but for rounding are ties.

    Parameters
    ----------
    values : array_like
        mm, rad or shares; infinite ones stay.
    """
    return np.asarray(np.round(np.asarray(values, dtype=float), _AMOUNT))


def round_costs(values: ArrayLike) -> NDArray[np.float64]:
    """Prices of axes rounded, so that those that are equal but for rounding are ties.

    Parameters
    ----------
    values : array_like
        Lengths, mm; times, s; or numbers of passes; infinite ones stay.
    """
    return np.asarray(np.round(np.asarray(values, dtype=float), _PRICE))


def canonical_sign(direction: ArrayLike) -> NDArray[np.float64]:
    """A direction whose sense says nothing, such as an eigenvector, in a sense that does not hang on rounding.

    Parameters
    ----------
    direction : (n,) array_like
        Not zero.

    Returns
    -------
    (n,) array
        The direction or its opposite: the one whose first component that is not zero is above zero.
    """
    row = np.asarray(direction, dtype=float)
    named = round_significant(row)
    return row if named[np.flatnonzero(named)[0]] > 0 else -row
