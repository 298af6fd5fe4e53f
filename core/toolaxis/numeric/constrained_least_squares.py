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
    a, b = np.atleast_2d(np.asarray(rows, dtype=float)), np.asarray(right, dtype=float)
    first, null = _solve_equations(equal, a.shape[1])
    if null.shape[1] == 0:
        _check(first, at_least)
        return first
    reduced, rest = a @ null, b - a @ first
    if at_least is None:
        return np.asarray(first + null @ np.linalg.lstsq(reduced, rest, rcond=_RANK)[0])
    g, h = (np.asarray(part, dtype=float) for part in at_least)
    q, r = np.linalg.qr(reduced)
    size = np.abs(np.diag(r)) if r.shape[0] == r.shape[1] else np.zeros(1)
    if size.min() <= _RANK * size.max():
        raise InvalidInput("several solutions are least: add rows that tell them apart")
    target = q.T @ rest
    turned = np.linalg.solve(r.T, (g @ null).T).T
    y = np.linalg.solve(r, _least_distance(turned, h - g @ first - turned @ target) + target)
    return np.asarray(first + null @ y)


def _solve_equations(equal: tuple[ArrayLike, ArrayLike] | None, n: int) -> tuple[Array, Array]:
    """The shortest solution of equations, and an orthonormal basis of what is left free, (n, f)."""
    if equal is None:
        return np.zeros(n), np.eye(n)
    c, d = np.atleast_2d(np.asarray(equal[0], dtype=float)), np.asarray(equal[1], dtype=float)
    left, size, basis = np.linalg.svd(c, full_matrices=True)
    rank = int((size > _RANK * size.max(initial=0.0)).sum())
    first = basis[:rank].T @ ((left[:, :rank].T @ d) / size[:rank])
    first = first + basis[:rank].T @ ((left[:, :rank].T @ (d - c @ first)) / size[:rank])
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
    empty = size <= _RANK * max(size.max(initial=0.0), np.finfo(float).tiny)
    if (h[empty] > _AGREE).any():
        raise InvalidInput(f"inequality {int(np.flatnonzero(empty & (h > _AGREE))[0])} can be met by nothing")
    kept = ~empty
    g, h = g[kept] / size[kept, None], h[kept] / size[kept]
    if not len(h) or h.max() <= 0:
        return np.zeros(g.shape[1])
    scale = float(h.max())
    table = np.vstack([g.T, h / scale])
    wanted = np.append(np.zeros(g.shape[1]), 1.0)
    dual = nnls(table, wanted, maxiter=50 * table.shape[1])[0]
    rest = table @ dual - wanted
    if np.linalg.norm(rest) <= _APART or rest[-1] >= 0:
        raise InvalidInput("the inequalities contradict each other: none but a wider one can be met")
    z = -scale * rest[:-1] / rest[-1]
    return _polish_active(g, h, np.asarray(z), dual > 0)


def _polish_active(g: Array, h: Array, z: Array, active: NDArray[np.bool_]) -> Array:
    """The same from its active rows as equations, where that misses the others by less."""
    better = np.linalg.lstsq(g[active], h[active], rcond=_RANK)[0]
    return np.asarray(better if (h - g @ better).max() <= max(float((h - g @ z).max()), 0.0) + 1e-12 else z)
