"""The band beyond an outline in which faces go on along their tangent planes: the kernel.

Its plain twin, which says what it does, is `toolaxis.skin.continuation.Continuation.blend_heights`.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_unfused, jit_unfused_inline
from toolaxis.skin.point_grid import PointGrid, find_nearest

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Share of the band's width within which only tangent planes count.
PLAIN = 0.5
#: How many of the points along the outline the nearest place on it is looked for from.
TRIED = 3


class BandTable(NamedTuple):
    """The outline around faces and the band along it.

    stations : PointGrid, points along the outline
    edges : (n, 2) array of int, the edges before and behind each of them
    line : (m, 4) array, start and end of each edge
    up : (3,) array, heights over the plane are up @ (p - origin)
    along : (3,) array, what moves a point by 1 mm in height and not aside
    width, rise : float, mm, of the band, and what tangent planes rise or fall at most
    """

    stations: PointGrid
    edges: Index
    line: Array
    up: Array
    along: Array
    width: float
    rise: float


class Foot(NamedTuple):
    """The nearest place on an outline to a place beside it.

    near : bool, False where it is none of the band's;  x, y : the place
    way_x, way_y : unit direction of the line there, zero where it is a corner;  distance : mm
    """

    near: bool
    x: float
    y: float
    way_x: float
    way_y: float
    distance: float


class Height(NamedTuple):
    """A height over a plane, its slopes along x and y, and its second derivatives."""

    value: float
    sx: float
    sy: float
    xx: float
    xy: float
    yy: float


@jit_unfused
def find_foot(band: BandTable, x: float, y: float, nearest: Index, square: Array) -> Foot:
    """The nearest place on the outline.

    Parameters
    ----------
    band : BandTable
    x, y : float
    nearest, square : (`TRIED`,) arrays
        What is in them does not count.
    """
    find_nearest(band.stations, x, y, band.width, nearest, square)
    found = Foot(False, 0.0, 0.0, 0.0, 0.0, np.inf)
    if not sqrt(square[0]) < band.width:
        return found
    for side in range(2):
        for k in range(nearest.shape[0]):
            if nearest[k] < 0:
                continue
            edge = band.line[band.edges[nearest[k], side]]
            way_x, way_y = edge[2] - edge[0], edge[3] - edge[1]
            length = max(sqrt(way_x * way_x + way_y * way_y), np.finfo(np.float64).tiny)
            way_x, way_y = way_x / length, way_y / length
            along = (x - edge[0]) * way_x + (y - edge[1]) * way_y
            held = min(max(along, 0.0), length)
            foot_x, foot_y = edge[0] + held * way_x, edge[1] + held * way_y
            distance = sqrt((x - foot_x) ** 2 + (y - foot_y) ** 2)
            if distance < found.distance:
                inner = 1.0 if held == along else 0.0
                found = Foot(True, foot_x, foot_y, inner * way_x, inner * way_y, distance)
    return found


@jit_unfused_inline
def height_of(band: BandTable, origin: Array, d: Array) -> Height:
    """The height of a point, from its six vectors (6, 3) S, Su, Sv, Suu, Suv, Svv with the place in the plane.

    Parameters
    ----------
    band : BandTable
    origin : (3,) array
        mm
    d : (6, 3) array
    """
    a, b, c = band.up[0], band.up[1], band.up[2]
    value = (d[0, 0] - origin[0]) * a + (d[0, 1] - origin[1]) * b + (d[0, 2] - origin[2]) * c
    return Height(value, d[1, 0] * a + d[1, 1] * b + d[1, 2] * c, d[2, 0] * a + d[2, 1] * b + d[2, 2] * c,
                  d[3, 0] * a + d[3, 1] * b + d[3, 2] * c, d[4, 0] * a + d[4, 1] * b + d[4, 2] * c,
                  d[5, 0] * a + d[5, 1] * b + d[5, 2] * c)


@jit_unfused_inline
def _plane_at(foot: Foot, at: Height, x: float, y: float, rise: float) -> Height:
    """The tangent plane at the foot, which levels off, at a place."""
    away_x, away_y, way_x, way_y = x - foot.x, y - foot.y, foot.way_x, foot.way_y
    turn_x, turn_y = at.xx * way_x + at.xy * way_y, at.xy * way_x + at.yy * way_y  # of the slope along the line
    climb = away_x * at.sx + away_y * at.sy
    share = 1.0 / (1.0 + abs(climb) / rise)
    flatter = share * share
    along, bent = at.sx * way_x + at.sy * way_y, turn_x * way_x + turn_y * way_y
    swing = away_x * turn_x + away_y * turn_y
    aside_x, aside_y = at.sx - along * way_x + swing * way_x, at.sy - along * way_y + swing * way_y
    across_x, across_y = turn_x - bent * way_x, turn_y - bent * way_y
    sense = 0.0
    if climb != 0.0:
        sense = 1.0 if climb > 0.0 else -1.0
    level = 2.0 * sense * flatter * share / rise
    return Height(at.value + climb * share, along * way_x + flatter * aside_x, along * way_y + flatter * aside_y,
                  bent * way_x * way_x + flatter * (2.0 * across_x * way_x) - level * aside_x * aside_x,
                  bent * way_x * way_y + flatter * (across_x * way_y + way_x * across_y) - level * aside_x * aside_y,
                  bent * way_y * way_y + flatter * (2.0 * across_y * way_y) - level * aside_y * aside_y)


@jit_unfused
def blend_into_spline(band: BandTable, foot: Foot, at: Height, spline: Height, x: float, y: float) -> Height:
    """What the band adds to the height of a spline at a place.

    Parameters
    ----------
    band : BandTable
    foot : Foot
        Of the place.
    at : Height
        Of the face at the foot.
    spline : Height
        At the place.
    x, y : float
    """
    plane = _plane_at(foot, at, x, y, band.rise)
    distance = max(foot.distance, np.finfo(np.float64).tiny)
    out_x, out_y = (x - foot.x) / distance, (y - foot.y) / distance
    t = min(max((foot.distance / band.width - PLAIN) / (1.0 - PLAIN), 0.0), 1.0)
    per_mm = 1.0 / ((1.0 - PLAIN) * band.width)
    weight = 1.0 - t**3 * (10.0 - 15.0 * t + 6.0 * t**2)
    first = -30.0 * t**2 * (1.0 - t) ** 2 * per_mm
    second = -60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) * per_mm**2
    off = plane.value - spline.value
    turn_x, turn_y = plane.sx - spline.sx, plane.sy - spline.sy
    xx, xy, yy = out_x * out_x, out_x * out_y, out_y * out_y
    # around a corner of the line the distance bends too
    bend = 1.0 / distance if foot.way_x == 0.0 and foot.way_y == 0.0 else 0.0
    around = first * off * bend
    swell = off * second
    return Height(weight * off, weight * turn_x + first * off * out_x, weight * turn_y + first * off * out_y,
                  weight * (plane.xx - spline.xx) + first * 2.0 * out_x * turn_x + around * (1.0 - xx) + swell * xx,
                  weight * (plane.xy - spline.xy) + first * (out_x * turn_y + turn_x * out_y) - around * xy
                  + swell * xy,
                  weight * (plane.yy - spline.yy) + first * 2.0 * out_y * turn_y + around * (1.0 - yy) + swell * yy)


@jit_unfused_inline
def add_height(band: BandTable, more: Height, d: Array) -> None:
    """Raise a point and its derivatives, six vectors (6, 3), over the plane.

    Parameters
    ----------
    band : BandTable
    more : Height
    d : (6, 3) array
        Changed in place.
    """
    for c in range(3):
        step = band.along[c]
        d[0, c] += more.value * step
        d[1, c] += more.sx * step
        d[2, c] += more.sy * step
        d[3, c] += more.xx * step
        d[4, c] += more.xy * step
        d[5, c] += more.yy * step
