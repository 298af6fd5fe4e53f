"""Three turns that carry a work coordinate system into a tilted plane, in the orders that controls use."""

from collections.abc import Sequence
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation

Array = NDArray[np.float64]

#: Each turn is about the axis as the turns before have left it; about fixed axes the same letters are read backwards.
ORDERS = ("ZXZ", "XYZ", "ZYX")
_UNIT = {"X": np.array([1.0, 0.0, 0.0]), "Y": np.array([0.0, 1.0, 0.0]), "Z": np.array([0.0, 0.0, 1.0])}
#: Sine of the middle turn's distance from a singular one, below which the first turn is free and 0 is taken.
_SINGULAR = 1e-12


def matrix_from_turns(order: str, angles: Sequence[float]) -> Array:
    """The plane's axes as columns after three turns, (3, 3).

    Parameters
    ----------
    order : str
        One of `ORDERS`: the axes about which the plane turns, each as the turns before have left it.
    angles : sequence of 3 floats
        rad, in that order.

    Raises
    ------
    InvalidInput
        When the order is not known.
    """
    _check(order)
    first, second, third = (rotation(_UNIT[name], float(angle)) for name, angle in zip(order, angles, strict=True))
    return np.asarray(first @ second @ third)


def turns_from_matrix(order: str, matrix: Array) -> Array:
    """The three turns that lead to a plane, (3,) rad.

    Parameters
    ----------
    order : str
        One of `ORDERS`.
    matrix : (3, 3) array
        The plane's axes as columns, a rotation.

    Returns
    -------
    (3,) array
        The middle turn from 0 to pi for ZXZ and from -pi/2 to pi/2 otherwise, the others from -pi to pi.  Where the
        first and the last turn are about one line (a plane level with the work coordinate system for ZXZ), the first is
        0 for XYZ and ZYX, and the last for ZXZ.

    Raises
    ------
    InvalidInput
        When the order is not known.

    Notes
    -----
    Property: `matrix_from_turns` of the result is the matrix to 1e-12, also at and near the singular planes, for the
    last turn is what is left when the first two are undone.
    """
    _check(order)
    m = np.asarray(matrix, dtype=float)
    if order == "ZXZ":
        level = hypot(m[0, 2], m[1, 2]) < _SINGULAR
        first = atan2(m[1, 0], m[0, 0]) if level else atan2(m[0, 2], -m[1, 2])
        second = atan2(hypot(m[0, 2], m[1, 2]), m[2, 2])
    elif order == "XYZ":
        size = hypot(m[1, 2], m[2, 2])
        first = 0.0 if size < _SINGULAR else atan2(-m[1, 2], m[2, 2])
        second = atan2(m[0, 2], size)
    else:
        size = hypot(m[0, 0], m[1, 0])
        first = 0.0 if size < _SINGULAR else atan2(m[1, 0], m[0, 0])
        second = atan2(-m[2, 0], size)
    left = (rotation(_UNIT[order[0]], first) @ rotation(_UNIT[order[1]], second)).T @ m
    third = atan2(left[2, 1], left[1, 1]) if order[2] == "X" else atan2(left[1, 0], left[0, 0])
    return np.array([first, second, third])


def _check(order: str) -> None:
    if order not in ORDERS:
        raise InvalidInput(f"order of turns {order!r} is not known: use {', '.join(ORDERS)}")
