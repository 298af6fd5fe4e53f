"""Turns about one or two fixed axes that carry one direction into another."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import angle_between, as_rows, dot, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angle by which a direction may miss what can be reached before it counts as out of reach, rad.
ROUNDING = 1e-9

#: Sine below which a direction lies on the axis of a turn, which then may take any value.
ON_AXIS = 1e-13


class Turns(NamedTuple):
    """Pairs of turns that carry one direction into another.

    Attributes
    ----------
    angles : (n, 2, 2) array
        For each direction two solutions of (first, second) turn, rad, within -pi to pi; equal where there is one only.
    reached : (n,) array of bool
        Whether there is a solution; without one the angles are those of the nearest direction on the same meridian.
    free : (n,) array of bool
        Whether the first turn is free, since the direction lies on its axis; 0 stands there.
    determinant : (n,) array
        Size of first . (second x turned direction), from 0 to 1: 0 where the two solutions meet.
    """

    angles: Array
    reached: Bools
    free: Bools
    determinant: Array


def rotate_vectors(vectors: ArrayLike, axis: ArrayLike, angles: ArrayLike) -> Array:
    """Vectors turned about an axis through the origin, (n, 3).

    Parameters
    ----------
    vectors : (n, 3) or (3,) array_like
    axis : (3,) array_like
        Unit vector.
    angles : (n,) array_like
        rad, right-handed.
    """
    rows, d = np.asarray(vectors, dtype=float), np.asarray(axis, dtype=float)
    turn = np.asarray(angles, dtype=float)[..., None]
    along = (rows @ d)[..., None] * d
    return np.asarray(along + np.cos(turn) * (rows - along) + np.sin(turn) * np.cross(d, rows))


def across(vectors: Array, axis: Array) -> Array:
    """The part of vectors across a unit axis, (n, 3).

    Parameters
    ----------
    vectors : (n, 3) array
    axis : (3,) array
    """
    return np.asarray(vectors - (vectors @ axis)[..., None] * axis)


def turn_between(start: Array, end: Array, axis: Array) -> Array:
    """Turn about an axis from one direction to another as seen along the axis, (n,) rad.

    Both are projected first, so that it stays accurate for directions close to the axis.

    Parameters
    ----------
    start, end : (n, 3) array
    axis : (3,) array
        Unit vector.
    """
    u, v = across(start, axis), across(end, axis)
    return np.asarray(np.arctan2(np.cross(u, v) @ axis, dot(u, v)))


def one_turn(axis: ArrayLike, start: ArrayLike, target: ArrayLike) -> tuple[Array, Bools, Bools]:
    """The turn about one axis that carries a direction into another.

    Parameters
    ----------
    axis : (3,) array_like
    start, target : (n, 3) or (3,) array_like

    Returns
    -------
    angles : (n,) array
        rad.
    reached, free : (n,) array of bool
        Whether it gets there, and whether any turn would do.
    """
    a, k, t = unit(axis), unit(as_rows(start, 3, "direction")), unit(as_rows(target, 3, "direction"))
    k, t = np.broadcast_arrays(k, t)
    angles = turn_between(k, t, a)
    reached = angle_between(rotate_vectors(k, a, angles), t) <= ROUNDING
    free = (np.linalg.norm(across(t, a), axis=1) <= ON_AXIS) & (np.linalg.norm(across(k, a), axis=1) <= ON_AXIS)
    return np.where(free, 0.0, angles), reached, free


def two_turns(first: ArrayLike, second: ArrayLike, start: ArrayLike, target: ArrayLike) -> Turns:
    """All pairs of turns with R(first) R(second) start = target.

    The directions of first, second and the turned start make a spherical triangle with known sides; its angle at the
    second axis follows from the half-angle formula, which stays accurate where a side vanishes.

    Parameters
    ----------
    first, second : (3,) array_like
        The two axes, at zero; not parallel.
    start, target : (n, 3) or (3,) array_like
        Directions, made unit vectors.

    Returns
    -------
    Turns

    Notes
    -----
    Properties: (1) turning the start by a reached solution gives the target to 1e-12 rad, on the axis of the first turn
    and close to it too; (2) there are no other solutions.
    """
    a, b = unit(first), unit(second)
    k, t = unit(as_rows(start, 3, "direction")), unit(as_rows(target, 3, "direction"))
    k, t = np.broadcast_arrays(k, t)
    ab, bk, at = angle_between(a, b), angle_between(k, b), angle_between(t, a)
    half = (ab + bk + at) / 2
    gaps = np.stack([half - ab, half - bk, half - at, np.pi - half])
    reached = (gaps >= -ROUNDING).all(axis=0)
    sines = np.sin(np.maximum(gaps, 0.0))
    corner = 2 * np.arctan2(np.sqrt(sines[0] * sines[1]), np.sqrt(sines[2] * sines[3]))
    begin = turn_between(np.broadcast_to(a, k.shape), k, b)
    free = np.linalg.norm(across(t, a), axis=1) <= ON_AXIS
    angles = np.empty((len(t), 2, 2))
    for branch, sign in enumerate((1.0, -1.0)):
        turn = wrap_to_pi(sign * corner - begin)
        angles[:, branch, 1] = turn
        angles[:, branch, 0] = np.where(free, 0.0, turn_between(rotate_vectors(k, b, turn), t, a))
    return Turns(angles, np.asarray(reached), free, np.abs(np.sin(ab) * np.sin(bk) * np.sin(corner)))


def wrap_to_pi(angles: ArrayLike) -> Array:
    """Angles brought into -pi to pi by whole turns, without change where they lie there.

    Parameters
    ----------
    angles : array_like
        rad.
    """
    values = np.asarray(angles, dtype=float)
    return np.asarray(values - 2 * np.pi * np.round(values / (2 * np.pi)))
