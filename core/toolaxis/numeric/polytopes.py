"""Boxes of what independent axes can do, and how far they reach in a direction."""

from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]


def box_limits(limits: ArrayLike) -> Array:
    """Half widths of a box about the origin, (m,).

    Parameters
    ----------
    limits : (m,) array_like

    Raises
    ------
    InvalidInput
        When one is not above zero.
    """
    sizes = np.asarray(limits, dtype=float)
    if sizes.ndim != 1 or not sizes.size or not (np.isfinite(sizes).all() and (sizes > 0).all()):
        raise InvalidInput(f"limits of the axes are {sizes.tolist()}: each must be a finite number above zero")
    return sizes


def box_vertices(limits: ArrayLike) -> Array:
    """The corners of a box about the origin, (2^m, m); the first is that of all positive signs.

    Parameters
    ----------
    limits : (m,) array_like
        Half widths.
    """
    sizes = box_limits(limits)
    return np.array(list(product((1.0, -1.0), repeat=len(sizes)))) * sizes


def halfspaces(limits: ArrayLike, target_from_box: ArrayLike | None = None) -> tuple[Array, Array]:
    """A box, moved by a linear map, as half-spaces A x <= b.

    Parameters
    ----------
    limits : (m,) array_like
        Half widths.
    target_from_box : (m, m) array_like, optional
        The map; the identity unless given.

    Returns
    -------
    (2 m, m) array, (2 m,) array

    Raises
    ------
    InvalidInput
        When the map is singular.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (5).
    """
    sizes = box_limits(limits)
    matrix = np.eye(len(sizes)) if target_from_box is None else np.asarray(target_from_box, dtype=float)
    if matrix.shape != (len(sizes),) * 2 or not abs(np.linalg.det(matrix)) > 1e-12:
        raise InvalidInput(f"map of the box is {matrix.tolist()}: a regular {len(sizes)} x {len(sizes)} matrix is "
                           "needed")
    rows = np.linalg.inv(matrix)
    return np.concatenate([rows, -rows]), np.concatenate([sizes, sizes])


def reach(limits: ArrayLike, directions: ArrayLike) -> Array:
    """Distance from the middle of a box to its surface in unit directions, (n,).

    Parameters
    ----------
    limits : (m,) array_like
        Half widths.
    directions : (n, m) array_like
        Unit vectors in the box's own coordinates.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (7).
    """
    sizes = box_limits(limits)
    rows = np.abs(as_rows(directions, len(sizes), "direction"))
    with np.errstate(divide="ignore"):
        return np.asarray((sizes / rows).min(axis=1))
