"""Least costs of all rectangles of a lattice with 1, 2, … pieces, by cuts from side to side: compiled, and plain."""

import numpy as np
from numpy.typing import NDArray

import toolaxis.numeric.jit as _compiled
from toolaxis.numeric.jit import jit

Array = NDArray[np.float64]


def least_costs(least: Array) -> None:
    """Fill in the least cost of every rectangle with every number of pieces.

    Parameters
    ----------
    least : (nu + 1, nu + 1, nv + 1, nv + 1, most + 1) array
        By first and last line along u and along v, and by number of pieces; holds what each rectangle costs as none or
        one piece, inf elsewhere.  Filled in.

    Notes
    -----
    Each is the least of itself and of all cuts from side to side with all shares of the pieces.  Compiled and plain
    code add the same pairs of numbers and agree to the last bit.
    """
    (_least_costs if _compiled.available else least_costs_numpy)(least)


@jit
def _least_costs(least: Array) -> None:
    nu, nv = least.shape[0] - 1, least.shape[2] - 1
    for w in range(1, nu + 1):
        for h in range(1, nv + 1):
            for u in range(nu - w + 1):
                for v in range(nv - h + 1):
                    best = least[u, u + w, v, v + h]
                    for c in range(1, w):
                        _merge(best, least[u, u + c, v, v + h], least[u + c, u + w, v, v + h])
                    for c in range(1, h):
                        _merge(best, least[u, u + w, v, v + c], least[u, u + w, v + c, v + h])


@jit
def _merge(best: Array, one: Array, other: Array) -> None:
    """The least of what is known and of all shares of pieces between two sides, in place, (most + 1,) each."""
    most = len(best)
    for k in range(most):
        if one[k] < np.inf:
            for m in range(most - k):
                best[k + m] = min(best[k + m], one[k] + other[m])


def least_costs_numpy(least: Array) -> None:
    """The same as `least_costs` on whole arrays, all rectangles of one size at a time.

    Parameters
    ----------
    least : array
        As for `least_costs`.
    """
    nu, nv = least.shape[0] - 1, least.shape[2] - 1
    for w in range(1, nu + 1):
        for h in range(1, nv + 1):
            u, v = np.arange(nu - w + 1)[:, None], np.arange(nv - h + 1)[None]
            best = least[u, u + w, v, v + h]
            for c in range(1, w):
                _merge_numpy(best, least[u, u + c, v, v + h], least[u + c, u + w, v, v + h])
            for c in range(1, h):
                _merge_numpy(best, least[u, u + w, v, v + c], least[u, u + w, v + c, v + h])
            least[u, u + w, v, v + h] = best


def _merge_numpy(best: Array, one: Array, other: Array) -> None:
    for k in range(best.shape[-1]):
        best[..., k:] = np.minimum(best[..., k:], one[..., k, None] + other[..., : best.shape[-1] - k])
