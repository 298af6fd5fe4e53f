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
    rows = np.asarray(vectors, dtype=float)
    d = np.asarray(axis, dtype=float)
    turn = np.asarray(angles, dtype=float)[..., None]
    heights = rows @ d
    along = heights[..., None] * d
    level = rows - along
    ahead = np.cross(d, rows)
    turned = along + np.cos(turn) * level + np.sin(turn) * ahead
    return np.asarray(turned)


def across(vectors: Array, axis: Array) -> Array:
    """The part of vectors across a unit axis, (n, 3).

    Parameters
    ----------
    vectors : (n, 3) array
    axis : (3,) array
    """
    heights = vectors @ axis
    along = heights[..., None] * axis
    return np.asarray(vectors - along)


def turn_between(start: Array, end: Array, axis: Array) -> Array:
    """Turn about an axis from one direction to another as seen along the axis, (n,) rad.

    Both are projected first, so that it stays accurate for directions close to the axis.

    Parameters
    ----------
    start, end : (n, 3) array
    axis : (3,) array
        Unit vector.
    """
    u = across(start, axis)
    v = across(end, axis)
    sine = np.cross(u, v) @ axis
    cosine = dot(u, v)
    return np.asarray(np.arctan2(sine, cosine))


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
    a = unit(axis)
    k, t = _pair_directions(start, target)
    angles = turn_between(k, t, a)
    turned = rotate_vectors(k, a, angles)
    reached = angle_between(turned, t) <= ROUNDING
    free = _lies_on(t, a) & _lies_on(k, a)
    return np.where(free, 0.0, angles), reached, free


def _pair_directions(start: ArrayLike, target: ArrayLike) -> tuple[Array, Array]:
    """Unit vectors of two directions, or of n pairs of them, (n, 3) each."""
    begins = unit(as_rows(start, 3, "direction"))
    ends = unit(as_rows(target, 3, "direction"))
    begins, ends = np.broadcast_arrays(begins, ends)
    return begins, ends


def _lies_on(directions: Array, axis: Array) -> Bools:
    """Whether directions lie on an axis, so that no turn about it moves them."""
    distances = np.linalg.norm(across(directions, axis), axis=1)
    return np.asarray(distances <= ON_AXIS)


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
    a = unit(first)
    b = unit(second)
    k, t = _pair_directions(start, target)
    ab = angle_between(a, b)
    bk = angle_between(k, b)
    at = angle_between(t, a)
    corner, reached = _corner_between(ab, bk, at)
    first_axes = np.broadcast_to(a, k.shape)
    begin = turn_between(first_axes, k, b)
    free = _lies_on(t, a)
    angles = np.empty((len(t), 2, 2))
    for branch, sign in enumerate((1.0, -1.0)):
        second_turn = wrap_to_pi(sign * corner - begin)
        halfway = rotate_vectors(k, b, second_turn)
        first_turn = turn_between(halfway, t, a)
        angles[:, branch, 1] = second_turn
        angles[:, branch, 0] = np.where(free, 0.0, first_turn)
    volume = np.sin(ab) * np.sin(bk) * np.sin(corner)
    return Turns(angles, reached, free, np.abs(volume))


def _corner_between(one: Array, other: Array, opposite: Array) -> tuple[Array, Bools]:
    """The angle between two sides of a spherical triangle, and whether three such sides make one."""
    half = (one + other + opposite) / 2
    gaps = np.stack([half - one, half - other, half - opposite, np.pi - half])
    exists = (gaps >= -ROUNDING).all(axis=0)
    s_one, s_other, s_opposite, s_half = np.sin(np.maximum(gaps, 0.0))
    sine = np.sqrt(s_one * s_other)
    cosine = np.sqrt(s_opposite * s_half)
    return 2 * np.arctan2(sine, cosine), np.asarray(exists)


def wrap_to_pi(angles: ArrayLike) -> Array:
    """Angles brought into -pi to pi by whole turns, without change where they lie there.

    Parameters
    ----------
    angles : array_like
        rad.
    """
    values = np.asarray(angles, dtype=float)
    turns = np.round(values / (2 * np.pi))
    return np.asarray(values - 2 * np.pi * turns)
