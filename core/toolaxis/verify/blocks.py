"""Points in blocks: neighbours along a space-filling curve, with a ball around each block."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Points in a block.
BLOCK = 32

_BITS = 16


def _spread(cells: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Put two zero bits between the bits of 16-bit numbers."""
    spread = np.zeros_like(cells)
    for bit in range(_BITS):
        spread |= ((cells >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit)
    return spread


def curve_order(points: Array) -> NDArray[np.int64]:
    """Order of points along a space-filling curve through their box (Morton's).

    Parameters
    ----------
    points : (m, 3) array

    Returns
    -------
    (m,) array of int
    """
    low = points.min(axis=0)
    size = max(float((points.max(axis=0) - low).max()), 1e-30)
    cells = ((points - low) / size * (2**_BITS - 1)).astype(np.uint64)
    code = _spread(cells[:, 0]) | (_spread(cells[:, 1]) << np.uint64(1)) | (_spread(cells[:, 2]) << np.uint64(2))
    return np.argsort(code, kind="stable")


def balls(points: Array) -> tuple[Array, NDArray[np.int64]]:
    """Balls around blocks of consecutive points.

    Parameters
    ----------
    points : (m, 3) array
        In curve order.

    Returns
    -------
    ball : (b, 4) array
        Centre and radius.
    first : (b + 1,) array of int
        Where each block begins.
    """
    first = np.append(np.arange(0, len(points), BLOCK), len(points)).astype(np.int64)
    low, high = (f.reduceat(points, first[:-1], axis=0) for f in (np.minimum, np.maximum))
    centre = 0.5 * (low + high)
    owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
    far = np.maximum.reduceat(np.linalg.norm(points - centre[owner], axis=1), first[:-1])
    return np.ascontiguousarray(np.column_stack([centre, far])), first
