"""Least squares under linear equations and inequalities, exactly: by the null space and non-negative least squares."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

#: Share of the largest singular value below which a direction counts as not determined.
_RANK = 1e-12
#: How exactly equations must agree, relative to their right side and 1, and the residual at which inequalities count
#: as contradicting each other.
_AGREE, _APART = 1e-9, 1e-9


def constrained_least_squares(rows: ArrayLike, right: ArrayLike, equal: tuple[ArrayLike, ArrayLike] | None = None,
                              at_least: tuple[ArrayLike, ArrayLike] | None = None) -> Array:
    """The x that makes |A x - b| least with C x = d and G x >= h, (n,).

    Parameters
    ----------
    rows, right : (k, n), (k,) array_like
        A and b.
    equal : (e, n), (e,) array_like, optional
        C and d.
    at_least : (m, n), (m,) array_like, optional
        G and h.

    Raises
    ------
    InvalidInput
        When equations or inequalities contradict each other, or inequalities are given and several x are least.

    Notes
    -----
    Without inequalities the shortest of several least x on the null space of C is taken.

    **Source**: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, Prentice-Hall 1974, chapters 20 and 23.

    **Properties**: 1. equations are met to rounding; 2. the conditions of Karush, Kuhn and Tucker hold, which make the
    result the least one, for the problem is convex.

    Examples
    --------
    >>> constrained_least_squares([[1, 0], [0, 1]], [2, 2], at_least=([[-1, -1]], [-2])).round(12).tolist()
    [1.0, 1.0]
    """
    a = np.atleast_2d(np.asarray(rows, dtype=float))
    b = np.asarray(right, dtype=float)
    first, null = _solve_equations(equal, a.shape[1])
    if null.shape[1] == 0:
        _check(first, at_least)
        return first
    reduced = a @ null
    rest = b - a @ first
    if at_least is None:
        free, *_ = np.linalg.lstsq(reduced, rest, rcond=_RANK)
        return np.asarray(first + null @ free)
    g, h = (np.asarray(part, dtype=float) for part in at_least)
    q, r = np.linalg.qr(reduced)
    is_square = r.shape[0] == r.shape[1]
    size = np.abs(np.diag(r)) if is_square else np.zeros(1)
    if size.min() <= _RANK * size.max():
        raise InvalidInput("several solutions are least: add rows that tell them apart")
    target = q.T @ rest
    # With y = R^-1 (z + Q^T rest) the sum of squares is |z|^2, and G x >= h is turned z >= what is left of h.
    turned = np.linalg.solve(r.T, (g @ null).T).T
    left = h - g @ first - turned @ target
    z = _least_distance(turned, left)
    y = np.linalg.solve(r, z + target)
    return np.asarray(first + null @ y)


def _solve_equations(equal: tuple[ArrayLike, ArrayLike] | None, n: int) -> tuple[Array, Array]:
    """The shortest solution of equations, and an orthonormal basis of what is left free, (n, f)."""
    if equal is None:
        return np.zeros(n), np.eye(n)
    c = np.atleast_2d(np.asarray(equal[0], dtype=float))
    d = np.asarray(equal[1], dtype=float)
    left, size, basis = np.linalg.svd(c, full_matrices=True)
    rank = int((size > _RANK * size.max(initial=0.0)).sum())
    range_left = left[:, :rank].T
    range_basis = basis[:rank].T
    first = range_basis @ ((range_left @ d) / size[:rank])
    # A second step takes away what rounding has left.
    missing = d - c @ first
    first = first + range_basis @ ((range_left @ missing) / size[:rank])
    off = np.abs(c @ first - d)
    if len(d) and off.max() > _AGREE * max(1.0, float(np.abs(d).max())):
        raise InvalidInput(f"equation {int(off.argmax())} misses by {off.max():.3g}: the equations contradict each "
                           "other; leave some out, or take more unknowns")
    return first, basis[rank:].T


def _check(x: Array, at_least: tuple[ArrayLike, ArrayLike] | None) -> None:
    if at_least is None:
        return
    g, h = (np.asarray(part, dtype=float) for part in at_least)
    short = h - g @ x
    if len(h) and short.max() > _AGREE * max(1.0, float(np.abs(h).max())):
        raise InvalidInput(f"inequality {int(short.argmax())} misses by {short.max():.3g} where the equations leave "
                           "nothing free")


def _least_distance(g: Array, h: Array) -> Array:
    """The shortest z with G z >= h."""
    from scipy.optimize import nnls

    size = np.linalg.norm(g, axis=1)
    longest = max(size.max(initial=0.0), np.finfo(float).tiny)
    empty = size <= _RANK * longest
    if (h[empty] > _AGREE).any():
        unmet = np.flatnonzero(empty & (h > _AGREE))
        raise InvalidInput(f"inequality {int(unmet[0])} can be met by nothing")
    kept = ~empty
    g = g[kept] / size[kept, None]
    h = h[kept] / size[kept]
    if not len(h) or h.max() <= 0:
        return np.zeros(g.shape[1])
    scale = float(h.max())
    table = np.vstack([g.T, h / scale])
    wanted = np.append(np.zeros(g.shape[1]), 1.0)
    dual, _ = nnls(table, wanted, maxiter=50 * table.shape[1])
    rest = table @ dual - wanted
    if np.linalg.norm(rest) <= _APART or rest[-1] >= 0:
        raise InvalidInput("the inequalities contradict each other: none but a wider one can be met")
    z = -scale * rest[:-1] / rest[-1]
    return _polish_active(g, h, np.asarray(z), dual > 0)


def _polish_active(g: Array, h: Array, z: Array, active: NDArray[np.bool_]) -> Array:
    """The same from its active rows as equations, where that misses the others by less."""
    better, *_ = np.linalg.lstsq(g[active], h[active], rcond=_RANK)
    missed = (h - g @ better).max()
    missed_before = max(float((h - g @ z).max()), 0.0)
    if missed <= missed_before + 1e-12:
        return np.asarray(better)
    return z
