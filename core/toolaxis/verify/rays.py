"""Rays on a face: one in every cell of a grid of equal lengths, with the area it stands for, and more on the border."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.parts import number_parts
from toolaxis.shape.face import Face
from toolaxis.verify.kept import SizedCache

Array = NDArray[np.float64]

#: Greatest spacing of rays, mm, and how many a face may hold before it grows.
SPACING, MOST_RAYS = 0.5, 400_000

#: How many rays stand on a gouge that is as deep as one may be, where nothing but gouges is looked for.
_ON_GOUGE = 40

#: Steps of the sequence that places a ray in its cell (Roberts' R2): with it no row of rays runs along a pass.
_R2 = (0.7548776662466927, 0.5698402909980532)

_FINE = 129

#: Places of the grid that are tried at a time, whatever part of them lies on the face.
_TRIED = 200_000

#: Share of the range of v by which rows and edges may miss each other by rounding.
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Rays:
    """Feet and directions of rays on one face.

    Attributes
    ----------
    uv : (m, 2) array
    point, normal : (m, 3) array
        mm, and unit normals out of the material.
    weight : (m,) array
        Area that the ray stands for, mm^2; 0 on the border, where rays only look for the worst.
    border : (m,) array of bool
        Whether the ray stands on a trim loop.
    spacing : float
        Distance of neighbouring rays, mm.
    """

    uv: Array
    point: Array
    normal: Array
    weight: Array
    border: NDArray[np.bool_]
    spacing: float


def default_spacing(face: Face) -> float:
    """Spacing of rays for a face, mm: 0.5, less on small faces, more where the rays would be too many.

    Parameters
    ----------
    face : Face
    """
    size = sqrt(max(face.area, 1e-12))
    return max(min(SPACING, size / 150), size / sqrt(MOST_RAYS))


def gouge_spacing(face: Face, flat_radius: float, corner_radius: float, gouge: float) -> float:
    """Spacing of rays for a face on which nothing but gouges is looked for, mm.

    Wider than `default_spacing` on small faces, where that lays many times as many rays as tell of any gouge.

    Parameters
    ----------
    face : Face
    flat_radius, corner_radius : float
        Of the cutter, mm.
    gouge : float
        How deep a gouge may be, mm.

    Notes
    -----
    A torus of radii R and r that goes to a depth d below a plane takes off an ellipse with half axes sqrt(2 r d) and
    sqrt(2 R d), but for terms of higher order in d; an edge that leans half a right angle takes off no less than d
    across.
    """
    across = max(sqrt(2.0 * corner_radius * gouge), gouge)
    along = sqrt(2.0 * (flat_radius + corner_radius) * gouge)
    enough = sqrt(pi * across * along / _ON_GOUGE)
    return max(default_spacing(face), min(SPACING, enough))


#: The rays of the faces used last, since operations side by side look at the same neighbours.
_KEPT: SizedCache[Rays] = SizedCache(200_000_000, lambda rays: 89 * len(rays.uv))


def face_rays(face: Face, spacing: float | None = None) -> Rays:
    """Rays over a face; those of the faces used last are kept.

    Parameters
    ----------
    face : Face
    spacing : float, optional
        Distance of neighbouring rays, mm; `default_spacing` unless given.

    Raises
    ------
    InvalidInput
        When the spacing is not above zero, or the face has no inside.

    Properties
    ----------
    1. The weights add up to the area of the face.
    2. The same face gives the same rays.
    """
    if spacing is None:
        spacing = default_spacing(face)
    if not (np.isfinite(spacing) and spacing > 0):
        raise InvalidInput(f"ray spacing is {spacing} mm: it must be a finite number above zero")
    return _KEPT.get((face, spacing), lambda: _make_rays(face, spacing))


def _make_rays(face: Face, spacing: float) -> Rays:
    uv, cell = _cells(face, spacing)
    edge = border_points(face, spacing)
    if not len(uv) and not len(edge):
        raise InvalidInput(f"face {face.label} has no inside at a ray spacing of {spacing} mm: use a finer one")
    both = np.vstack([uv, edge])
    d = face.evaluate(both)
    normal = face.normal(both)
    inside = len(uv)
    stretch = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    weight = np.append(stretch[:inside] * cell, np.zeros(len(edge)))
    border = np.arange(len(both)) >= inside
    good = np.linalg.norm(normal, axis=1) > 0.5
    return Rays(both[good], d.point[good], normal[good], weight[good], border[good], float(spacing))


def _cells(face: Face, spacing: float) -> tuple[Array, Array]:
    """One place in each cell of a grid of equal lengths over the face's range, and the cell's area in (u, v) there.

    Of the places only those on the face.
    """
    u0, u1, v0, v1 = face.bounds
    u = np.linspace(u0, u1, _FINE)
    v = np.linspace(v0, v1, _FINE)
    speed = np.linalg.norm(face.evaluate(grid_rows(u, v)).sv, axis=1)
    speed_v = speed.reshape(_FINE, _FINE).max(axis=0)
    length = _lengths(v, speed_v)
    mark = length / length[-1]
    rows = int(_parts(length, spacing))
    middles = np.interp((np.arange(rows) + 0.5) / rows, mark, v)
    lines = np.interp(np.arange(rows + 1) / rows, mark, v)
    across = _lengths_across(face, middles, u)
    cells_of_row = _parts(across, spacing)
    before = np.cumsum(cells_of_row) - cells_of_row
    low, high = _reach_of_rows(face, lines)
    found = [np.empty((0, 3))]
    tried = [np.empty((0, 3))]
    for row in np.flatnonzero(low <= high):
        number = cells_of_row[row]
        column = _columns_within(low[row], high[row], u, across[row], number)
        k = before[row] + 1 + column
        share_u = (column + _place_in_cell(k, 0)) / number
        share_v = (row + _place_in_cell(k, 1)) / rows
        at_u, step_u = _place_at_shares(u, across[row], share_u)
        at_v, step_v = _place_at_shares(v, length, share_v)
        area = step_u * step_v / (number * rows)
        tried.append(np.column_stack([at_u, at_v, area]))
        if sum(map(len, tried)) >= _TRIED:
            found.append(_places_on(face, tried))
            tried = [np.empty((0, 3))]
    places = np.concatenate([*found, _places_on(face, tried)])
    return places[:, :2], places[:, 2]


def _place_in_cell(number: NDArray[np.int64], which: int) -> Array:
    """Where rays stand in their cells along u (0) or v (1), 0 to 1."""
    return np.asarray(np.mod(0.5 + number * _R2[which], 1.0))


def _columns_within(low: float, high: float, u: Array, length: Array, number: int) -> NDArray[np.int64]:
    """Columns of a row's cells that come between two values of u.

    Parameters
    ----------
    low, high : float
    u, length : (k,) arrays
        Values of u, and the lengths along the row up to them.
    number : int
        Cells of equal length in the row.
    """
    shares = np.interp([low, high], u, length / length[-1])
    first, last = np.floor(shares * number).astype(np.int64)
    # A place lies in its cell but for rounding: one more is tried at either end.
    begin = max(first - 1, 0)
    end = min(last + 1, number - 1)
    return np.arange(begin, end + 1)


def _places_on(face: Face, tried: list[Array]) -> Array:
    """Those of some places (u, v, area) that lie on a face."""
    places = np.concatenate(tried)
    return np.asarray(places[face.contains(places[:, :2])])


def _lengths_across(face: Face, middles: Array, u: Array) -> Array:
    """Lengths along lines of constant v up to values of u, (rows, k) mm."""
    parts = []
    at_once = max(1, _TRIED // len(u))
    for first in range(0, len(middles), at_once):
        some = middles[first:first + at_once]
        at_v, at_u = np.meshgrid(some, u, indexing="ij")
        line = np.stack([at_u, at_v], axis=-1).reshape(-1, 2)
        speed = np.linalg.norm(face.evaluate(line).su, axis=1)
        parts.append(_lengths(u, speed.reshape(len(some), len(u))))
    return np.concatenate(parts)


def _reach_of_rows(face: Face, lines: Array) -> tuple[Array, Array]:
    """Least and greatest u of a face in each row between lines of constant v; the least is above the greatest one
    in rows that it does not come to.

    Whatever lies on the face has the edges of a loop on both sides, which cross its row.
    """
    rows = len(lines) - 1
    low = np.full(rows, np.inf)
    high = np.full(rows, -np.inf)
    rounding = _ROUNDING * (lines[-1] - lines[0])
    for loop in face.outline:
        following = np.roll(loop, -1, axis=0)
        left, bottom = np.minimum(loop, following).T
        right, top = np.maximum(loop, following).T
        first = _row_of(lines, bottom - rounding)
        last = _row_of(lines, top + rounding)
        crossed = last - first + 1
        edge, number = number_parts(crossed)
        row = first[edge] + number
        np.minimum.at(low, row, left[edge])
        np.maximum.at(high, row, right[edge])
    return low, high


def _row_of(lines: Array, values: Array) -> NDArray[np.intp]:
    """Numbers of the rows that values of v lie in, or of the nearest row."""
    row = np.searchsorted(lines, values, side="right") - 1
    return np.clip(row, 0, len(lines) - 2)


def _lengths(t: Array, speed: Array) -> Array:
    """Lengths along lines of known speeds, (..., k), strictly increasing from 0."""
    fastest = np.maximum(speed.max(axis=-1, keepdims=True), 1e-300)
    floor = np.maximum(speed, 1e-9 * fastest)
    steps = 0.5 * (floor[..., 1:] + floor[..., :-1]) * np.diff(t)
    begin = np.zeros_like(steps[..., :1])
    return np.concatenate([begin, np.cumsum(steps, axis=-1)], axis=-1)


def _parts(length: Array, spacing: float) -> NDArray[np.int64]:
    """Number of cells along lines of such lengths."""
    whole = length[..., -1] / spacing
    parts = np.ceil(whole - 1e-9)
    return np.maximum(1, parts).astype(np.int64)


def _place_at_shares(t: Array, length: Array, share: Array) -> tuple[Array, Array]:
    """Parameters at shares of a line's length, and their rate of change with the share."""
    mark = length / length[-1]
    piece = np.searchsorted(mark, share, side="right") - 1
    piece = np.clip(piece, 0, len(t) - 2)
    begin = t[piece]
    behind = piece + 1
    rate = (t[behind] - begin) / (mark[behind] - mark[piece])
    return begin + (share - mark[piece]) * rate, rate


def border_points(face: Face, spacing: float) -> Array:
    """Parameters along the trim loops of a face, no further apart than the spacing, (k, 2).

    Parameters
    ----------
    face : Face
    spacing : float
        mm
    """
    return np.concatenate([loop_points(face, loop, spacing) for loop in face.outline])


def loop_points(face: Face, loop: Array, spacing: float) -> Array:
    """Parameters along one loop, no further apart than the spacing, (k, 2).

    Parameters
    ----------
    face : Face
    loop : (m, 2) array
    spacing : float
        mm
    """
    ends = np.roll(loop, -1, axis=0)
    sides = ends - loop
    fine = 257 if len(loop) <= 16 else 9
    share = np.linspace(0.0, 1.0, fine)
    line = loop[:, None] + share[None, :, None] * sides[:, None]
    point = face.evaluate(line.reshape(-1, 2)).point
    chords = np.diff(point.reshape(len(loop), fine, 3), axis=1)
    longest = np.linalg.norm(chords, axis=2).max(axis=1)
    bound = (fine - 1) * longest
    parts = np.maximum(1, np.ceil(bound / spacing)).astype(np.int64)
    edge, number = number_parts(parts)
    step = (number / parts[edge])[:, None]
    return np.asarray(loop[edge] + step * sides[edge])


def patch_around(face: Face, uv: Array, size: float, count: int = 5) -> Array:
    """Parameters of small square patches around given ones, inside the face, (n, 2).

    Parameters
    ----------
    face : Face
    uv : (k, 2) array
    size : float
        Half the side of a patch, mm.
    count : int
        Points along a side.
    """
    d = face.evaluate(uv)
    pace_u = np.linalg.norm(d.su, axis=1)
    pace_v = np.linalg.norm(d.sv, axis=1)
    pace = np.stack([pace_u, pace_v], axis=1)
    u0, u1, v0, v1 = face.bounds
    way = np.minimum(size / np.maximum(pace, 1e-12), [u1 - u0, v1 - v0])
    side = np.linspace(-1.0, 1.0, count)
    offset = grid_rows(side, side)
    around = uv[:, None] + offset * way[:, None]
    around = np.clip(around.reshape(-1, 2), [u0, v0], [u1, v1])
    return np.asarray(around[face.contains(around)], dtype=np.float64)
