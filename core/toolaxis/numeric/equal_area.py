"""Lambert's equal-area map of a hemisphere of directions onto the unit disc, there and back."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import perpendicular, unit

Array = NDArray[np.float64]


class _MapFrame(NamedTuple):
    """Unit vectors along the map's x and y, and out of its centre, (3,) each."""

    x: Array
    y: Array
    z: Array


def _frame(pole: ArrayLike, right: ArrayLike | None) -> _MapFrame:
    z = unit(pole)
    if right is None:
        x = perpendicular(z)[0]
    else:
        x = unit(np.asarray(right) - np.dot(right, z) * z)
    return _MapFrame(x, np.cross(z, x), z)


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
    frame = _frame(pole, right)
    rows = np.asarray(axes, dtype=float).reshape(-1, 3)
    height = np.clip(rows @ frame.z, -1.0, 1.0)
    flat = rows @ np.stack([frame.x, frame.y], axis=1)
    size = np.linalg.norm(flat, axis=1)
    size = np.where(size > 0, size, 1.0)
    radius = np.sqrt(np.maximum(1.0 - height, 0.0))
    return np.asarray(flat / size[:, None] * radius[:, None])


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
    frame = _frame(pole, right)
    flat = np.asarray(places, dtype=float).reshape(-1, 2)
    square = np.minimum((flat**2).sum(axis=1), 2.0)
    scale = np.sqrt(2.0 - square)
    height = 1.0 - square
    in_plane = flat[:, :1] * frame.x + flat[:, 1:] * frame.y
    return np.asarray(in_plane * scale[:, None] + height[:, None] * frame.z)
