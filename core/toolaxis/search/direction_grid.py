"""Even sets of axes: a spiral over a cap of the sphere, and rings around an axis."""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.rounding import canonical_sign
from toolaxis.numeric.vectors import perpendicular, unit

Array = NDArray[np.float64]

_GOLDEN = pi * (3.0 - 5.0**0.5)
#: No axis of the cap is farther from the nearest one of the spiral than this many spacings (tested).
COVER = 0.98
#: Normals that spread alike to within this share, or as much to one side as to the other, tell no direction.
_EVEN = 1e-9


def spiral(frame: ArrayLike, spacing: float, most: float = pi / 2) -> Array:
    """Axes spread evenly over a cap, one for each square of the spacing.

    Parameters
    ----------
    frame : (3, 3) array_like
        Right-handed rows x, y, z; the cap lies around z.
    spacing : float
        rad
    most : float
        Greatest angle to z, rad.

    Returns
    -------
    (n, 3) array of unit vectors, from z outwards

    Notes
    -----
    Fibonacci's lattice: the k-th of n axes at height 1 - (k + 1/2) (1 - cos most) / n, turned by the golden angle.
    """
    count = max(1, round(2 * pi * (1 - np.cos(most)) / spacing**2))
    k = np.arange(count)
    z = 1 - (k + 0.5) * (1 - np.cos(most)) / count
    across = np.sqrt(np.maximum(1 - z * z, 0.0))
    turn = _GOLDEN * k
    return np.asarray(np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1) @ np.asarray(frame))


def ring(axis: Array, angle: float, turn: float = 0.0, count: int = 6) -> Array:
    """Axes evenly around an axis, (count, 3).

    Parameters
    ----------
    axis : (3,) array
        Unit vector.
    angle : float
        Angle to it, rad.
    turn : float
        Angle of the first one about it, rad.
    count : int
    """
    x, y = perpendicular(axis)
    way = turn + 2 * pi * np.arange(count)[:, None] / count
    return np.asarray(unit(np.cos(angle) * axis + np.sin(angle) * (np.cos(way) * x + np.sin(way) * y)))


def own_frame(normals: Array, middle: Array) -> Array:
    """A frame that moves with a set of normals: z in their middle, x where they spread most, towards the longer side.

    Where they spread alike, the axes of space decide, not the last digits of the normals.

    Parameters
    ----------
    normals : (n, 3) array
    middle : (3,) array
        Unit vector.

    Returns
    -------
    (3, 3) array, rows x, y, z
    """
    flat = normals - (normals @ middle)[:, None] * middle
    values, vectors = np.linalg.eigh(flat.T @ flat)
    x = vectors[:, 2] - (vectors[:, 2] @ middle) * middle
    alike = values[2] <= 1e-12 * len(normals)
    if alike or values[2] - values[1] <= _EVEN * values[2] or np.linalg.norm(x) < 0.5:
        x = perpendicular(middle)[0]
    x = canonical_sign(unit(x))
    cubes = (flat @ x) ** 3
    if not alike and cubes.sum() < -_EVEN * np.abs(cubes).sum():
        x = -x
    return np.stack([x, np.cross(middle, x), middle])
