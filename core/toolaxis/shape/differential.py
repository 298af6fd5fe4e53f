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
        there = Derivatives(*(each[poor] for each in d))
        ways = np.broadcast_to(inward, (len(poor), 2))[poor]
        raw[poor] = _change(there, ways)
        size[poor] = lengths(raw[poor])
    sign = -1.0 if flip else 1.0
    return np.asarray(sign * raw / np.where(size > 0, size, 1.0)[:, None])


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
    longest_first = np.sqrt(np.maximum(dot(d.su, d.su), dot(d.sv, d.sv)))
    second = [np.linalg.norm(each, axis=1) for each in (d.suu, d.suv, d.svv)]
    longest_second = np.max(second, axis=0)
    noise = 1e-12 * longest_first * longest_second * np.linalg.norm(inward, axis=1)
    real = np.linalg.norm(change, axis=1) > noise
    return np.where(real[:, None], change, 0.0)


def first_form(d: Derivatives) -> Array:
    """E, F, G as an (n, 2, 2) array, mm^2."""
    f = dot(d.su, d.sv)
    return _matrices(dot(d.su, d.su), f, f, dot(d.sv, d.sv))


def second_form(d: Derivatives, normal: Array) -> Array:
    """L, M, N as an (n, 2, 2) array, mm; positive where the surface bends towards the normal."""
    m = dot(d.suv, normal)
    return _matrices(dot(d.suu, normal), m, m, dot(d.svv, normal))


def _matrices(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Matrices ((a, b), (c, d)), (n, 2, 2)."""
    return np.stack([np.stack([a, b], -1), np.stack([c, d], -1)], -2)


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
    tangents = _matrices(dot(d.su, x), dot(d.sv, x), dot(d.su, y), dot(d.sv, y))
    inverse = _inverse(tangents)
    return np.asarray(np.swapaxes(inverse, 1, 2) @ second_form(d, normal) @ inverse)


def _inverse(tangent: Array) -> Array:
    """Inverses of (n, 2, 2) matrices; the pseudo-inverse where the tangents span no plane.

    There the curvature across the only tangent is unknown and comes out as zero.
    """
    a, b = tangent[:, 0].T
    c, d = tangent[:, 1].T
    determinant = a * d - b * c
    scale = np.maximum(a * a + c * c, b * b + d * d)
    sound = np.abs(determinant) > DEGENERATE * scale
    adjugate = _matrices(d, -b, -c, a)
    inverse = adjugate / np.where(sound, determinant, 1.0)[:, None, None]
    if not sound.all():
        rest = np.flatnonzero(~sound)
        finite = np.asarray(np.isfinite(tangent[rest]).all(axis=(1, 2)))
        pseudo = np.linalg.pinv(np.nan_to_num(tangent[rest]), rcond=DEGENERATE)
        inverse[rest] = np.where(finite[:, None, None], pseudo, np.nan)
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
    # A tangent frame whose x lies along the longer derivative: the shorter one may be next to nothing.
    along_u = dot(d.su, d.su) >= dot(d.sv, d.sv)
    base = np.where(along_u[:, None], d.su, d.sv)
    base = base - dot(base, normal)[:, None] * normal
    size = np.linalg.norm(base, axis=1, keepdims=True)
    x = base / np.where(size > 0, size, 1.0)
    form = curvature_form(d, normal, x)
    # Mohr's circle of the form: its middle, and its radius at twice the angle of the first direction.
    mean = 0.5 * (form[:, 0, 0] + form[:, 1, 1])
    half = 0.5 * (form[:, 0, 0] - form[:, 1, 1])
    twist = form[:, 0, 1]
    spread = np.hypot(half, twist)
    angle = 0.5 * np.arctan2(twist, half)
    d1 = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * np.cross(normal, x)
    return Curvature(mean + spread, mean - spread, d1, np.cross(normal, d1))
