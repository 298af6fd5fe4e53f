"""Borders of a face as lines: the nearest place on them, and ways across them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.face import Face
from toolaxis.verify.rays import loop_points

Array = NDArray[np.float64]

#: Distance of a border's points, mm, and pieces between them.
STEP, _PIECES = 0.25, 64


class BorderLoop(NamedTuple):
    """A loop as points no farther apart than `STEP`: parameters, places, and way to the next along the loop, mm."""

    uv: Array
    point: Array
    way: Array


def line_of(face: Face, loop: Array) -> BorderLoop:
    """A trim loop of a face as a line.

    Parameters
    ----------
    face : Face
    loop : (m, 2) array
    """
    uv = loop_points(face, loop, STEP)
    point = face.evaluate(uv).point
    steps = np.linalg.norm(np.roll(point, -1, axis=0) - point, axis=1)
    return BorderLoop(uv, point, np.cumsum(steps))


def on_border(face: Face, foot: Array, lines: list[BorderLoop], near: float) -> tuple[Array, Array]:
    """Parameters of the nearest point of the border to each foot, and the border's direction there.

    Parameters
    ----------
    face : Face
    foot : (n, 3) array
        mm
    lines : list of BorderLoop
        The face's loops.
    near : float
        Feet farther than that from the border need not be answered well, mm.
    """
    from scipy.spatial import cKDTree

    uv = np.zeros((len(foot), 2))
    along = np.zeros((len(foot), 3))
    least = np.full(len(foot), np.inf)
    share = np.linspace(-1.0, 1.0, 2 * _PIECES + 1)
    for line in lines:
        distance, k = cKDTree(line.point).query(foot)
        rows = np.flatnonzero(distance < np.minimum(least, STEP) + near)
        if not len(rows):
            continue
        # Densely along the pieces of the loop on both sides of its nearest point.
        k = k[rows]
        count = len(line.uv)
        own = line.uv[k]
        back = line.uv[(k - 1) % count] - own
        ahead = line.uv[(k + 1) % count] - own
        way = np.maximum(-share, 0.0)[:, None] * back[:, None] + np.maximum(share, 0.0)[:, None] * ahead[:, None]
        place = own[:, None] + way
        point = face.evaluate(place.reshape(-1, 2)).point.reshape(len(rows), -1, 3)
        step = np.diff(point, axis=1)
        size = np.maximum(dot(step, step), 1e-300)
        begin = point[:, :-1]
        own_foot = foot[rows][:, None]
        at = np.clip(dot(own_foot - begin, step) / size, 0.0, 1.0)
        gap = np.linalg.norm(begin + at[..., None] * step - own_foot, axis=2)
        i = np.arange(len(rows))
        j = gap.argmin(axis=1)
        nearest = gap[i, j]
        better = nearest < least[rows]
        found = place[i, j] + at[i, j][:, None] * (place[i, j + 1] - place[i, j])
        uv[rows[better]] = found[better]
        along[rows[better]] = step[i, j][better]
        least[rows[better]] = nearest[better]
    return uv, along


def in_parameters(face: Face, uv: Array, way: Array) -> Array:
    """The steps in (u, v) that lead along tangent vectors, (k, 2).

    Parameters
    ----------
    face : Face
    uv : (k, 2) array
    way : (k, 3) array
        mm
    """
    d = face.evaluate(uv)
    e = dot(d.su, d.su)
    f = dot(d.su, d.sv)
    g = dot(d.sv, d.sv)
    a = dot(way, d.su)
    b = dot(way, d.sv)
    determinant = np.maximum(e * g - f * f, 1e-300)
    return np.stack([(g * a - f * b) / determinant, (e * b - f * a) / determinant], axis=1)
