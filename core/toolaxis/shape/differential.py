"""Normals, fundamental forms, principal curvatures and directions, on whole arrays.

Curvature is positive where the surface bends towards the normal (concave to a tool that comes from outside).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.surface import Derivatives

Array = NDArray[np.float64]


class Curvature(NamedTuple):
    """Principal curvatures (1/mm, k1 >= k2) and unit directions at n points.

    k1, k2 : (n,);  d1, d2 : (n, 3), with d1, d2, normal right-handed.
    """

    k1: Array
    k2: Array
    d1: Array
    d2: Array


def normals(d: Derivatives, flip: bool = False) -> Array:
    """Unit normals Su x Sv, reversed with flip; at degenerate points the limit from the second derivatives.

    Parameters
    ----------
    d : Derivatives
        At n parameters.
    flip : bool

    Returns
    -------
    (n, 3) array; a row of zeros where no limit exists.
    """
    raw = np.cross(d.su, d.sv)
    size = np.linalg.norm(raw, axis=1)
    scale = np.maximum(np.linalg.norm(d.su, axis=1), np.linalg.norm(d.sv, axis=1)) ** 2
    poor = size <= 1e-10 * scale
    if poor.any():
        raw[poor] = _limit(d, poor)
        size = np.linalg.norm(raw, axis=1)
    return np.asarray((-1.0 if flip else 1.0) * raw / np.where(size > 0, size, 1.0)[:, None])


def _limit(d: Derivatives, rows: NDArray[np.bool_]) -> Array:
    """Direction of Su x Sv next to a point where it vanishes, by the side from which both terms agree."""
    su_small = np.linalg.norm(d.su[rows], axis=1) < np.linalg.norm(d.sv[rows], axis=1)
    along_v, along_u = np.cross(d.suv[rows], d.sv[rows]), np.cross(d.su[rows], d.suv[rows])
    return np.where(su_small[:, None], along_v, along_u)


def first_form(d: Derivatives) -> Array:
    """E, F, G as an (n, 2, 2) array, mm^2."""
    f = dot(d.su, d.sv)
    return np.stack([np.stack([dot(d.su, d.su), f], -1), np.stack([f, dot(d.sv, d.sv)], -1)], -2)


def second_form(d: Derivatives, normal: Array) -> Array:
    """L, M, N as an (n, 2, 2) array, mm; positive where the surface bends towards the normal."""
    m = dot(d.suv, normal)
    return np.stack([np.stack([dot(d.suu, normal), m], -1), np.stack([m, dot(d.svv, normal)], -1)], -2)


def curvature_form(d: Derivatives, normal: Array, x: Array) -> Array:
    """The second fundamental form in an orthonormal tangent frame (x, y = normal x x), 1/mm.

    Parameters
    ----------
    d : Derivatives
    normal, x : (n, 3) array
        Unit normal and a unit tangent.

    Returns
    -------
    (n, 2, 2) array
    """
    y = np.cross(normal, x)
    tangent = np.stack([np.stack([dot(d.su, x), dot(d.sv, x)], -1), np.stack([dot(d.su, y), dot(d.sv, y)], -1)], -2)
    inverse = np.linalg.pinv(tangent)
    return np.asarray(np.swapaxes(inverse, 1, 2) @ second_form(d, normal) @ inverse)


def curvatures(d: Derivatives, normal: Array) -> Curvature:
    """Principal curvatures and directions.

    Parameters
    ----------
    d : Derivatives
    normal : (n, 3) array
        Unit normals, with the sign that the curvature's sign refers to.
    """
    base = np.where((dot(d.su, d.su) >= dot(d.sv, d.sv))[:, None], d.su, d.sv)
    base = base - dot(base, normal)[:, None] * normal
    size = np.linalg.norm(base, axis=1, keepdims=True)
    x = base / np.where(size > 0, size, 1.0)
    form = curvature_form(d, normal, x)
    values, vectors = np.linalg.eigh(form)
    y = np.cross(normal, x)
    d1 = vectors[:, 0, 1, None] * x + vectors[:, 1, 1, None] * y
    return Curvature(values[:, 1], values[:, 0], d1, np.cross(normal, d1))
