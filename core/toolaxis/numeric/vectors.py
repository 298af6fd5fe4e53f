"""Rows of vectors: unit vectors, angles and rotations."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.rounding import round_significant

Array = NDArray[np.float64]


def as_rows(values: ArrayLike, columns: int, name: str) -> Array:
    """Rows of finite numbers with a given number of columns.

    Parameters
    ----------
    values : array_like
        One row or an (n, columns) array.
    columns : int
        Columns wanted.
    name : str
        What the array is called in messages.

    Raises
    ------
    InvalidInput
        When the shape does not fit or a number is not finite.
    """
    try:
        rows = np.atleast_2d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise InvalidInput(f"{name} is {values!r}: rows of {columns} numbers are needed") from None
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise InvalidInput(f"{name} has shape {np.shape(values)}: rows of {columns} numbers are needed")
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if bad.size:
        raise InvalidInput(f"{name} row {bad[0]} is {rows[bad[0]].tolist()}: every number must be finite")
    return rows


def dot(a: Array, b: Array) -> Array:
    """Row-wise scalar product, shape (n,)."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def lengths(rows: Array) -> Array:
    """Lengths of rows, (...,), for (..., k) with a small k: numpy's norm, which takes ten times as long over many rows.

    Parameters
    ----------
    rows : (..., k) array
    """
    square = rows[..., 0] * rows[..., 0]
    for k in range(1, rows.shape[-1]):
        square = square + rows[..., k] * rows[..., k]
    return np.asarray(np.sqrt(square))


def unit(vectors: ArrayLike) -> Array:
    """Vectors divided by their lengths.

    Parameters
    ----------
    vectors : (..., 3) array_like

    Raises
    ------
    InvalidInput
        When a vector has no direction (zero length or not finite).
    """
    rows = np.asarray(vectors, dtype=float)
    length = np.linalg.norm(rows, axis=-1, keepdims=True)
    if not (np.isfinite(length).all() and (length > 0).all()):
        raise InvalidInput(f"vector {rows.tolist() if rows.ndim == 1 else 'array'} has no direction: "
                           "its length must be finite and above zero")
    return np.asarray(rows / length)


def axis_rows(axis: ArrayLike, count: int) -> Array:
    """Unit axes of a number of contacts, (count, 3), from vectors of any length.

    Parameters
    ----------
    axis : (3,) or (count, 3) array_like
    count : int

    Raises
    ------
    InvalidInput
        When there is neither one axis nor one for each contact, or one has no direction.
    """
    rows = unit(as_rows(axis, 3, "axis"))
    if len(rows) not in (1, count):
        raise InvalidInput(f"{len(rows)} axes for {count} contacts: give one axis, or one for each contact")
    return np.broadcast_to(rows, (count, 3))


def angle_between(a: Array, b: Array) -> Array:
    """Angle between rows, rad, accurate at 0 and pi.

    Parameters
    ----------
    a, b : (..., 3) array
        Unit vectors.
    """
    return np.asarray(2 * np.arctan2(lengths(a - b), lengths(a + b)))


def perpendicular(axis: ArrayLike) -> tuple[Array, Array]:
    """Two unit vectors that make a right-handed frame (x, y, axis).

    Parameters
    ----------
    axis : (3,) array_like
    """
    z = unit(axis)
    x = np.zeros(3)
    x[int(np.argmin(round_significant(np.abs(z))))] = 1.0
    x = unit(x - (x @ z) * z)
    return x, np.cross(z, x)


def rotation(axis: ArrayLike, angle: float) -> Array:
    """Rotation matrix (3, 3) about an axis.

    Parameters
    ----------
    axis : (3,) array_like
    angle : float
        rad, right-handed.
    """
    x, y, z = unit(axis)
    c, s = np.cos(angle), np.sin(angle)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + s * k + (1 - c) * (k @ k))
