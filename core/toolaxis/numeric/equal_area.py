"""Lambert's equal-area map of a hemisphere of directions onto the unit disc, there and back."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import perpendicular, unit

Array = NDArray[np.float64]


def _frame(pole: ArrayLike, right: ArrayLike | None) -> tuple[Array, Array, Array]:
    """Unit vectors along the map's x and y, and out of its centre."""
    z = unit(pole)
    x = perpendicular(z)[0] if right is None else unit(np.asarray(right) - np.dot(right, z) * z)
    return x, np.cross(z, x), z


def equal_area(axes: ArrayLike, pole: ArrayLike, right: ArrayLike | None = None) -> Array:
    """Places of directions on the map; the pole's hemisphere fills the unit disc.

    Parameters
    ----------
    axes : (n, 3) array_like
        Unit vectors.
    pole : (3,) array_like
        Maps to the centre.
    right : (3,) array_like, optional
        Direction of the map's x.

    Returns
    -------
    (n, 2) array
        Radius sqrt(2) sin(angle / 2): 1 at 90 degrees.
    """
    x, y, z = _frame(pole, right)
    rows = np.asarray(axes, dtype=float).reshape(-1, 3)
    height = np.clip(rows @ z, -1.0, 1.0)
    flat = rows @ np.stack([x, y], axis=1)
    size = np.linalg.norm(flat, axis=1)
    radius = np.sqrt(np.maximum(1.0 - height, 0.0))
    return np.asarray(flat / np.where(size > 0, size, 1.0)[:, None] * radius[:, None])


def from_equal_area(places: ArrayLike, pole: ArrayLike, right: ArrayLike | None = None) -> Array:
    """Directions of places on the map: the inverse of `equal_area`.

    Parameters
    ----------
    places : (n, 2) array_like
        Places no farther than sqrt(2) from the centre; farther ones map as if they stood there.
    pole, right
        As for `equal_area`.

    Returns
    -------
    (n, 3) array
        Unit vectors.
    """
    x, y, z = _frame(pole, right)
    flat = np.asarray(places, dtype=float).reshape(-1, 2)
    square = np.minimum((flat**2).sum(axis=1), 2.0)
    scale = np.sqrt(2.0 - square)
    return np.asarray((flat[:, :1] * x + flat[:, 1:] * y) * scale[:, None] + (1.0 - square)[:, None] * z)
