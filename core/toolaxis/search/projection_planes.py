"""Projection planes: planes through the mean normal, turned about it, in which axes are one angle each."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import perpendicular, unit

Array = NDArray[np.float64]


class ProjectionPlane(NamedTuple):
    """A projection plane: unit vectors x and y span it, z is normal to it; right-handed, (3,) each."""

    x: Array
    y: Array
    z: Array


def initial_plane(normals: ArrayLike, directions: ArrayLike) -> ProjectionPlane:
    """The plane of the mean normal (y) and the mean direction of least curvature (x).

    Directions have no sign, so their mean is the eigenvector of the sum of their dyads.

    Parameters
    ----------
    normals : (n, 3) array_like
        Unit normals of the sample points.
    directions : (n, 3) array_like
        Their directions of least principal curvature; each counts as a line.

    Raises
    ------
    InvalidInput
        When the normals add up to nothing.

    Notes
    -----
    **Source**: [zhu2016] Sec. 4.1; there the directions are averaged as vectors, which depends on their signs.

    **Properties**: 1. the sign of no direction matters; 2. turns with normals and directions.
    """
    y = unit(np.asarray(normals, dtype=float).sum(axis=0))
    rows = np.asarray(directions, dtype=float)
    flat = rows - (rows @ y)[:, None] * y
    size = np.linalg.norm(flat, axis=1, keepdims=True)
    lines = flat / np.where(size > 1e-9, size, np.inf)
    values, vectors = np.linalg.eigh(lines.T @ lines)
    if values[2] - values[1] <= 1e-9 * len(rows):
        x = perpendicular(y)[0]
    else:
        x = unit(vectors[:, 2] - (vectors[:, 2] @ y) * y)
    return ProjectionPlane(x, y, np.cross(x, y))


def turn_plane(plane: ProjectionPlane, phi: float) -> ProjectionPlane:
    """The plane turned about its y.

    Parameters
    ----------
    plane : ProjectionPlane
    phi : float
        Roll angle, rad.

    Notes
    -----
    **Source**: [zhu2016] Eq. (7).
    """
    x = plane.x * np.cos(phi) - plane.z * np.sin(phi)
    return ProjectionPlane(x, plane.y, np.cross(x, plane.y))


def project_angles(plane: ProjectionPlane, normals: ArrayLike) -> Array:
    """Angle of each normal, projected on the plane, from x towards y, (n,) rad in (-pi, pi].

    Parameters
    ----------
    plane : ProjectionPlane
    normals : (n, 3) array_like

    Notes
    -----
    **Source**: [zhu2016] Eqs. (10) and (11), with the quadrant: normals may lean beyond y.
    """
    rows = np.asarray(normals, dtype=float)
    return np.asarray(np.arctan2(rows @ plane.y, rows @ plane.x))


def axis_at(plane: ProjectionPlane, gamma: ArrayLike) -> Array:
    """Tool axes in a plane, (n, 3), or (3,) for one angle.

    Parameters
    ----------
    plane : ProjectionPlane
    gamma : float or (n,) array_like
        Inclination from x towards y, rad.

    Notes
    -----
    **Source**: [zhu2016] Eq. (12).
    """
    angle = np.asarray(gamma, dtype=float)[..., None]
    return np.asarray(np.cos(angle) * plane.x + np.sin(angle) * plane.y)


def sector(plane: ProjectionPlane, normals: ArrayLike) -> tuple[float, float]:
    """The quasi-feasible sector of a plane: range of inclinations in front of all projected normals.

    Parameters
    ----------
    plane : ProjectionPlane
    normals : (n, 3) array_like

    Returns
    -------
    low, high : float
        rad; no inclination where low exceeds high.

    Notes
    -----
    **Source**: [zhu2016] Sec. 4.2; Eq. (13) prints the range reversed.

    **Properties**: 1. at high the axis meets the foremost projected normal; 2. at low it is at right angles to the
    hindmost one.
    """
    alpha = project_angles(plane, normals)
    return float(alpha.max()) - np.pi / 2, float(alpha.min())
