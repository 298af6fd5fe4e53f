"""Points in blocks: neighbours along a space-filling curve, with a ball around each block."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Points in a block, and blocks that one call of a kernel works off.
BLOCK, CHUNK = 32, 32

_BITS = 16


def _spread(cells: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Put two zero bits between the bits of 16-bit numbers."""
    spread = np.zeros_like(cells)
    for bit in range(_BITS):
        spread |= ((cells >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit)
    return spread


def curve_order(points: Array) -> Index:
    """Order of points along a space-filling curve through their box (Morton's).

    Parameters
    ----------
    points : (m, 3) array

    Returns
    -------
    (m,) array of int
    """
    low = points.min(axis=0)
    high = points.max(axis=0)
    size = max(float((high - low).max()), 1e-30)
    cells = ((points - low) / size * (2**_BITS - 1)).astype(np.uint64)
    x, y, z = (_spread(cells[:, axis]) for axis in range(3))
    code = x | (y << np.uint64(1)) | (z << np.uint64(2))
    return np.argsort(code, kind="stable")


def balls(points: Array, size: int = BLOCK) -> tuple[Array, Index]:
    """Balls around blocks of consecutive points.

    Parameters
    ----------
    points : (m, 3) array
        Neighbours in the order are neighbours in space.
    size : int
        Points in a block.

    Returns
    -------
    ball : (b, 4) array
        Centre and radius.
    first : (b + 1,) array of int
        Where each block begins.
    """
    count = len(points)
    first = np.append(np.arange(0, count, size), count).astype(np.int64)
    begin = first[:-1]
    low = np.minimum.reduceat(points, begin, axis=0)
    high = np.maximum.reduceat(points, begin, axis=0)
    centre = 0.5 * (low + high)
    owner = np.repeat(np.arange(len(begin)), np.diff(first))
    away = np.linalg.norm(points - centre[owner], axis=1)
    radius = np.maximum.reduceat(away, begin)
    return np.ascontiguousarray(np.column_stack([centre, radius])), first


class Blocks(NamedTuple):
    """Points sorted into blocks of neighbours.

    Attributes
    ----------
    order : (m,) array of int
        Rows of the points, block after block.
    ball : (b, 4) array
        Centre and radius of the ball around each block.
    first : (b + 1,) array of int
        Where each block begins in the order.
    """

    order: Index
    ball: Array
    first: Index


def blocks_of(points: Array) -> Blocks:
    """Points in blocks along a space-filling curve.

    Parameters
    ----------
    points : (m, 3) array
    """
    order = curve_order(points)
    return Blocks(order, *balls(points[order]))
