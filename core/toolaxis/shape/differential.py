"""Normals, fundamental forms, principal curvatures and directions, on whole arrays.

Curvature is positive where the surface bends towards the normal (concave to a tool that comes from outside).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import dot, lengths
from toolaxis.shape.surface import Derivatives

Array = NDArray[np.float64]

#: Sine between Su and Sv, measured against the larger, below which a point counts as degenerate.
DEGENERATE = 1e-8


class Curvature(NamedTuple):
    """Principal curvatures (1/mm, k1 >= k2) and unit directions at n points.

    k1, k2 : (n,);  d1, d2 : (n, 3), with d1, d2, normal right-handed.
    """

    k1: Array
    k2: Array
    d1: Array
    d2: Array


def normals(d: Derivatives, flip: bool = False, inward: ArrayLike = (1.0, 1.0)) -> Array:
    """Unit normals Su x Sv, reversed with flip; at degenerate points the limit from inside the surface.

    Parameters
    ----------
    d : Derivatives
        At n parameters.
    flip : bool
    inward : (2,) or (n, 2) array_like
        Direction in (u, v) from each point into the surface; only degenerate points need it.  Poles stand at both
        ends of a parameter, and Su x Sv comes to them from opposite sides.

    Returns
    -------
    (n, 3) array; a row of zeros where no limit exists.

    Notes
    -----
    Where Su x Sv vanishes, its change along `inward` gives the direction: a (Suu x Sv + Su x Suv) +
    b (Suv x Sv + Su x Svv).  The two branches meet where the sine between Su and Sv, measured against the larger
    of both, is `DEGENERATE`: there each is good to about 1e-8 rad.
    """
    raw = np.cross(d.su, d.sv)
    size = lengths(raw)
    poor = _spans_nothing(d, size)
    if poor.any():
        raw[poor] = _change(Derivatives(*(x[poor] for x in d)), np.broadcast_to(inward, (len(poor), 2))[poor])
        size[poor] = lengths(raw[poor])
    return np.asarray((-1.0 if flip else 1.0) * raw / np.where(size > 0, size, 1.0)[:, None])


def degenerate(d: Derivatives) -> NDArray[np.bool_]:
    """Whether Su and Sv span no plane: one is next to nothing beside the other, or they are parallel, (n,) bool."""
    return _spans_nothing(d, lengths(np.cross(d.su, d.sv)))


def _spans_nothing(d: Derivatives, size: Array) -> NDArray[np.bool_]:
    """The same from the length of Su x Sv."""
    scale = np.maximum(dot(d.su, d.su), dot(d.sv, d.sv))
    return np.asarray(size <= DEGENERATE * scale)


def _change(d: Derivatives, inward: Array) -> Array:
    """How Su x Sv changes on the way into the surface."""
    along_u = np.cross(d.suu, d.sv) + np.cross(d.su, d.suv)
    along_v = np.cross(d.suv, d.sv) + np.cross(d.su, d.svv)
    change = inward[:, :1] * along_u + inward[:, 1:] * along_v
    longest = np.sqrt(np.maximum(dot(d.su, d.su), dot(d.sv, d.sv)))
    second = np.max([np.linalg.norm(x, axis=1) for x in (d.suu, d.suv, d.svv)], axis=0)
    noise = 1e-12 * longest * second * np.linalg.norm(inward, axis=1)
    return np.where((np.linalg.norm(change, axis=1) > noise)[:, None], change, 0.0)


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
    a, b, c, e = dot(d.su, x), dot(d.sv, x), dot(d.su, y), dot(d.sv, y)
    inverse = _inverse(np.stack([np.stack([a, b], -1), np.stack([c, e], -1)], -2))
    return np.asarray(np.swapaxes(inverse, 1, 2) @ second_form(d, normal) @ inverse)


def _inverse(tangent: Array) -> Array:
    """Inverses of (n, 2, 2) matrices; the pseudo-inverse where the tangents span no plane.

    There the curvature across the only tangent is unknown and comes out as zero.
    """
    (a, b), (c, e) = tangent[:, 0].T, tangent[:, 1].T
    determinant = a * e - b * c
    scale = np.maximum(a * a + c * c, b * b + e * e)
    sound = np.abs(determinant) > DEGENERATE * scale
    inverse = np.stack([np.stack([e, -b], -1), np.stack([-c, a], -1)], -2)
    inverse = inverse / np.where(sound, determinant, 1.0)[:, None, None]
    if not sound.all():
        rest = np.flatnonzero(~sound)
        finite = np.asarray(np.isfinite(tangent[rest]).all(axis=(1, 2)))
        inverse[rest] = np.where(finite[:, None, None],
                                 np.linalg.pinv(np.nan_to_num(tangent[rest]), rcond=DEGENERATE), np.nan)
    return np.asarray(inverse)


def curvatures(d: Derivatives, normal: Array) -> Curvature:
    """Principal curvatures and directions.

    Parameters
    ----------
    d : Derivatives
    normal : (n, 3) array
        Unit normals, with the sign that the curvature's sign refers to.

    Notes
    -----
    At degenerate points the derivatives do not tell the curvature across the only tangent, and zero is answered:
    `Face.curvature` steps into the surface there.
    """
    base = np.where((dot(d.su, d.su) >= dot(d.sv, d.sv))[:, None], d.su, d.sv)
    base = base - dot(base, normal)[:, None] * normal
    size = np.linalg.norm(base, axis=1, keepdims=True)
    x = base / np.where(size > 0, size, 1.0)
    form = curvature_form(d, normal, x)
    mean, half, twist = 0.5 * (form[:, 0, 0] + form[:, 1, 1]), 0.5 * (form[:, 0, 0] - form[:, 1, 1]), form[:, 0, 1]
    spread, angle = np.hypot(half, twist), 0.5 * np.arctan2(twist, half)
    d1 = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * np.cross(normal, x)
    return Curvature(mean + spread, mean - spread, d1, np.cross(normal, d1))
