"""Convex solids of revolution about the tool axis, as rows of seven numbers: a cutter, or one frustum of a holder."""

from itertools import pairwise
from math import cos, hypot, sin, tan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.jit import jit_inline
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]


def cutter_solid(profile: Profile) -> Array:
    """The cutting part of a tool, (1, 7).

    Parameters
    ----------
    profile : Profile

    Returns
    -------
    (1, 7) array
        Centre radius and radius of the lower arc, cosine and sine of the side's inclination, height of the bottom,
        height of the top, radius at the top.

    Raises
    ------
    InvalidInput
        When a size is not finite or makes no solid.
    """
    a, r, beta, top = profile.flat_radius, profile.corner_radius, profile.half_angle, profile.top
    if not np.isfinite([a, r, beta, top]).all() or a < 0 or r < 0 or a + r <= 0 or not abs(beta) < 1.5 or top <= 0:
        raise InvalidInput(f"cutter with flat radius {a}, corner radius {r}, half angle {beta} and length {top} "
                           "makes no solid: radii must not be negative, their sum and the length above zero")
    low = r * (1 - sin(beta))
    if top < low:
        raise InvalidInput(f"cutter length is {top} mm, below the end of the corner arc at {low} mm: lengthen it")
    return np.array([[a, r, cos(beta), sin(beta), 0.0, top, a + r * cos(beta) + (top - low) * tan(beta)]])


def frustum_solids(outline: ArrayLike, name: str) -> Array:
    """A shank or holder cut into frusta, (k, 7); steps of no height are the faces of their neighbours.

    Parameters
    ----------
    outline : (m, 2) array_like
        Polyline of radius and height above the tip, mm, heights not decreasing.
    name : str
        What messages call it.

    Raises
    ------
    InvalidInput
        When the polyline is no outline.
    """
    line = np.asarray(outline, dtype=float)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all() or (line[:, 0] < 0).any():
        raise InvalidInput(f"{name} outline of shape {line.shape}: at least two finite rows (radius, z) are needed, "
                           "no radius below zero")
    rise = np.diff(line[:, 1])
    if (rise < 0).any():
        i = int(np.argmax(rise < 0)) + 1
        raise InvalidInput(f"{name} z {i} is {line[i, 1]} mm, below the one before: z must not decrease")
    rows = []
    for (r0, z0), (r1, z1) in pairwise(line):
        slant = hypot(r1 - r0, z1 - z0)
        if z1 - z0 > 1e-9:
            rows.append([r0, 0.0, (z1 - z0) / slant, (r1 - r0) / slant, z0, z1, r1])
    if not rows:
        raise InvalidInput(f"{name} outline has no height: its last z must lie above its first")
    return np.array(rows)


def reach_of(solids: Array) -> float:
    """Greatest distance of a point of the solids from the tip, mm.

    Parameters
    ----------
    solids : (k, 7) array
    """
    wide = np.maximum(solids[:, 0] + solids[:, 1], solids[:, 6])
    return float(np.hypot(wide, solids[:, 5]).max())


@jit_inline
def meridian(solid: Array, rho: float, z: float) -> tuple[float, float, float]:
    """The greatest of all supporting lines of a solid's meridian at one point, and its slopes along rho and z.

    Negative inside and zero on the border; outside it is the distance.  It is convex, which the sweep relies on.
    """
    x, y = rho - solid[0], z - solid[4] - solid[1]
    cb, sb = solid[2], solid[3]
    if x > 0.0 and cb * y + sb * x <= 0.0:
        length = np.sqrt(x * x + y * y)
        if length > 0.0:
            return length - solid[1], x / length, y / length
    x_top, y_top = rho - solid[6], z - solid[5]
    if x_top > 0.0 and cb * y_top + sb * x_top >= 0.0:
        length = np.sqrt(x_top * x_top + y_top * y_top)
        if length > 0.0:
            return length, x_top / length, y_top / length
    best, along_rho, along_z = solid[4] - z, 0.0, -1.0
    side = cb * x - sb * y - solid[1]
    if side > best:
        best, along_rho, along_z = side, cb, -sb
    if y_top > best:
        best, along_rho, along_z = y_top, 0.0, 1.0
    return best, along_rho, along_z


def meridian_numpy(solid: Array, rho: Array, z: Array) -> tuple[Array, Array, Array]:
    """The plain twin of `meridian` on arrays.

    Parameters
    ----------
    solid : (7,) array
    rho, z : array
        mm

    Returns
    -------
    value, slope along rho, slope along z : arrays
    """
    a, r, cb, sb, bottom, top, rim = solid
    x, y, x_top, y_top = rho - a, z - bottom - r, rho - rim, z - top
    lines = np.stack([bottom - z, cb * x - sb * y - r, y_top])
    pick = np.argmax(lines, axis=0)
    value = np.take_along_axis(lines, pick[None], axis=0)[0]
    along_rho, along_z = np.choose(pick, [0.0, cb, 0.0]), np.choose(pick, [-1.0, -sb, 1.0])
    for dx, dy, radius, inside in ((x, y, r, (x > 0) & (cb * y + sb * x <= 0)),
                                   (x_top, y_top, 0.0, (x_top > 0) & (cb * y_top + sb * x_top >= 0))):
        length = np.hypot(dx, dy)
        use = inside & (length > 0)
        safe = np.where(use, length, 1.0)
        value = np.where(use, length - radius, value)
        along_rho, along_z = np.where(use, dx / safe, along_rho), np.where(use, dy / safe, along_z)
    return value, along_rho, along_z
