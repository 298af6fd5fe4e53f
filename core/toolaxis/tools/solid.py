"""Exact signed distance to the rotating solid, made of convex pieces: the cutter and the frusta of shank and holder.

A piece is a row of eight numbers: radius of the flat bottom, radius of the lower corner arc, cosine and sine of the
side's inclination, height of the bottom, height of the top, radius of the top edge, number of the component.  The
signed distance to a convex piece is the greatest of all its supporting planes: a convex function of the point, and
never less than its linear continuation from any other point.  Every bound of `contact` stands on that.
"""

from itertools import pairwise
from math import cos, hypot, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_fma_inline
from toolaxis.numeric.support_functions import ConvexBodies
from toolaxis.numeric.vectors import as_rows
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]

COMPONENTS = ("cutter", "shank", "holder")


def cutter_piece(profile: Profile) -> Array:
    """The cutter as one convex piece, (8,).

    Parameters
    ----------
    profile : Profile
    """
    return np.array([profile.flat_radius, profile.corner_radius, cos(profile.half_angle), sin(profile.half_angle),
                     0.0, profile.top, profile.top_radius, 0.0])


def outline_pieces(line: Array, component: int) -> Array:
    """A turned body as convex frusta, (k, 8); flanges of no thickness are discs.

    Parameters
    ----------
    line : (m, 2) array
        (radius, z) with z not decreasing, mm.
    component : int
        Number written into the rows.
    """
    rows = []
    for (r0, z0), (r1, z1) in pairwise(line):
        if z1 > z0:
            slant = hypot(r1 - r0, z1 - z0)
            rows.append([r0, 0.0, (z1 - z0) / slant, (r1 - r0) / slant, z0, z1, r1, component])
    for z in np.unique(line[:, 1]):
        level = np.flatnonzero(line[:, 1] == z)
        below = line[level[0], 0] if level[0] > 0 else 0.0
        above = line[level[-1], 0] if level[-1] < len(line) - 1 else 0.0
        widest = float(line[level, 0].max())
        if widest > max(below, above):
            rows.append([widest, 0.0, 1.0, 0.0, z, z, widest, component])
    return np.array(rows, dtype=float).reshape(-1, 8)


def solid_pieces(profile: Profile, outlines: dict[str, Array]) -> Array:
    """All convex pieces of a tool, the cutter first, (k, 8).

    Parameters
    ----------
    profile : Profile
    outlines : dict of (m, 2) arrays
        Polylines (radius, z) named "shank" and "holder".
    """
    bodies = [outline_pieces(outlines[name], COMPONENTS.index(name)) for name in COMPONENTS if name in outlines]
    return np.vstack([cutter_piece(profile)[None], *bodies])


def convex_pieces(pieces: Array) -> ConvexBodies:
    """The pieces as hulls of two discs, tip at the origin, axis along +z: what encloses each of them.

    Parameters
    ----------
    pieces : (k, 8) array
        From `solid_pieces`.
    """
    count = len(pieces)
    centre = np.zeros((count, 2, 3))
    centre[:, 0, 2] = pieces[:, 4] + pieces[:, 1]
    centre[:, 1, 2] = pieces[:, 5]
    upwards = np.tile([0.0, 0.0, 1.0], (count, 2, 1))
    radii = pieces[:, [0, 6]]
    ball = np.stack([pieces[:, 1], np.zeros(count)], axis=1)
    return ConvexBodies(centre, upwards, radii, ball, np.zeros((count, 3, 3)))


@jit_fma_inline
def piece_distance(piece: Array | tuple[float, ...], rho: float, z: float) -> tuple[float, float, float, float]:
    """Signed distance of a meridian point from a convex piece, its slopes along rho and z, and its curvature.

    Parameters
    ----------
    piece : (8,) array or tuple
    rho, z : float
        Distance from the axis and height, mm.

    Returns
    -------
    distance, slope along rho, slope along z, curvature in the meridian plane (1/mm; 0 next to straight parts)
    """
    r = piece[1]
    cb = piece[2]
    sb = piece[3]
    # From the middle of the corner's arc, and from the top edge.
    x = rho - piece[0]
    y = z - piece[4] - r
    x_rim = rho - piece[6]
    y_rim = z - piece[5]
    best = piece[4] - z
    along_rho = 0.0
    along_z = -1.0
    bend = 0.0
    side = cb * x - sb * y - r
    if side > best:
        best = side
        along_rho = cb
        along_z = -sb
    if y_rim > best:
        best = y_rim
        along_rho = 0.0
        along_z = 1.0
    if x > 0.0 and cb * y + sb * x < 0.0:
        length = np.sqrt(x * x + y * y)
        if length - r > best:
            best = length - r
            along_rho = x / length
            along_z = y / length
            bend = 1.0 / length
    if x_rim > 0.0 and cb * y_rim + sb * x_rim > 0.0:
        length = np.sqrt(x_rim * x_rim + y_rim * y_rim)
        if length > best:
            best = length
            along_rho = x_rim / length
            along_z = y_rim / length
            bend = 1.0 / length
    return best, along_rho, along_z, bend


def piece_distance_numpy(piece: Array, rho: Array, z: Array) -> tuple[Array, Array, Array, Array]:
    """The plain twin of `piece_distance` on arrays.

    Parameters and result as there; ``piece`` may have leading axes that broadcast against ``rho``.
    """
    a, r, cb, sb, low, top, rim = (piece[..., k] for k in range(7))
    # From the middle of the corner's arc, and from the top edge.
    x = rho - a
    y = z - low - r
    x_rim = rho - rim
    y_rim = z - top
    d = np.hypot(x, y)
    d_rim = np.hypot(x_rim, y_rim)
    on_arc = (x > 0) & (cb * y + sb * x < 0)
    on_rim = (x_rim > 0) & (cb * y_rim + sb * x_rim > 0)
    from_bottom = low - z
    from_side = cb * x - sb * y - r
    from_arc = np.where(on_arc, d - r, -np.inf)
    from_rim = np.where(on_rim, d_rim, -np.inf)
    options = np.stack(np.broadcast_arrays(from_bottom, from_side, y_rim, from_arc, from_rim))
    pick = np.argmax(options, axis=0)
    value = np.take_along_axis(options, pick[None], axis=0)[0]
    safe = np.where(d > 0, d, 1.0)
    safe_rim = np.where(d_rim > 0, d_rim, 1.0)
    along_rho = np.choose(pick, [0.0, cb, 0.0, x / safe, x_rim / safe_rim])
    along_z = np.choose(pick, [-1.0, -sb, 1.0, y / safe, y_rim / safe_rim])
    bend = np.choose(pick, [0.0, 0.0, 0.0, 1 / safe, 1 / safe_rim])
    return value, along_rho, along_z, bend


class Distance(NamedTuple):
    """Signed distances, negative inside, mm, and their unit gradients: value (n,), gradient (n, 3)."""

    value: Array
    gradient: Array


@jit
def _nearest_piece(pieces: Array, rho: Array, z: Array, out: Array) -> None:
    for k in range(rho.shape[0]):
        out[k, 0] = np.inf
        for p in range(pieces.shape[0]):
            value, along_rho, along_z, _ = piece_distance(pieces[p], rho[k], z[k])
            if value < out[k, 0]:
                out[k, 0] = value
                out[k, 1] = along_rho
                out[k, 2] = along_z


def nearest_piece(pieces: Array, rho: Array, z: Array) -> Array:
    """Least signed distance over convex pieces and its slopes along rho and z, (n, 3).

    Parameters
    ----------
    pieces : (k, 8) array
    rho, z : (n,) array
        Meridian points, mm.
    """
    if not _compiled.available:
        return nearest_piece_numpy(pieces, rho, z)
    out = np.empty((len(rho), 3))
    _nearest_piece(pieces, np.ascontiguousarray(rho), np.ascontiguousarray(z), out)
    return out


def nearest_piece_numpy(pieces: Array, rho: Array, z: Array) -> Array:
    """The plain twin of `nearest_piece`.

    Parameters and result as there.
    """
    table = np.stack(piece_distance_numpy(pieces[:, None], rho[None], z[None])[:3], axis=-1)
    pick = np.argmin(table[..., 0], axis=0)
    return np.asarray(np.take_along_axis(table, pick[None, :, None], axis=0)[0])


def _envelope(pieces: Array) -> tuple[Array, Array]:
    """Straight border lines of the union in the meridian plane, (k, 2, 2), and the cutter's arc rows, (m, 4)."""
    flat, corner, cosine, sine, bottom, top = pieces[pieces[:, 5] > pieces[:, 4], :6].T
    # The straight side of each begins where its corner's arc ends, with that radius, and widens by the slope.
    start = bottom + corner * (1 - sine)
    base = flat + corner * cosine
    slope = sine / cosine
    z = _envelope_heights(bottom, top, start, base, slope)
    low = z[:-1]
    high = z[1:]
    middle = (low + high) / 2
    # Between two heights that follow each other, one side is the widest all the way.
    over = (middle[:, None] > start) & (middle[:, None] < top)
    radius = np.where(over, base + slope * (middle[:, None] - start), -1.0)
    widest = np.argmax(radius, axis=1)
    ends = np.stack([base[widest] + slope[widest] * (h - start[widest]) for h in (low, high)], axis=1)
    ends[~over.any(axis=1)] = 0.0
    on_arc = ((middle[:, None] > bottom) & (middle[:, None] < start)).any(axis=1)
    first = int(np.argmin(bottom))
    if on_arc.any():
        ends[on_arc] = [flat[first], base[first]]
    sides = [np.array([[end[0], lo], [end[1], hi]]) for end, lo, hi, bent in zip(ends, low, high, on_arc, strict=True)
             if not bent and end.any()]
    below = np.concatenate([[0.0], ends[:, 1]])
    above = np.concatenate([ends[:, 0], [0.0]])
    steps = [np.array([[inner, h], [outer, h]]) for inner, outer, h in zip(below, above, z, strict=True)
             if inner != outer]
    arcs = np.column_stack([flat, bottom + corner, corner, sine])
    return np.array(sides + steps), arcs[corner > 0]


def _envelope_heights(bottom: Array, top: Array, start: Array, base: Array, slope: Array) -> Array:
    """Heights at which the border of the union may go over from one piece to another, ascending."""
    heights = [bottom, top, start]
    for i in range(len(bottom)):
        others = np.flatnonzero(slope[i] != slope)
        apart = base[others] - slope[others] * start[others] - base[i] + slope[i] * start[i]
        meet = apart / (slope[i] - slope[others])
        heights.append(meet[(meet > start[i]) & (meet < top[i])])
    z = np.unique(np.concatenate(heights))
    fresh = np.diff(z) > 1e-9 * (z[-1] - z[0])
    return np.asarray(z[np.concatenate([[True], fresh])])


def _depth(pieces: Array, rho: Array, z: Array) -> Array:
    """Distance to the border of the union and unit direction towards it in the meridian plane, (n, 3)."""
    lines, arcs = _envelope(pieces)
    p = np.stack([rho, z], axis=-1)
    along = lines[:, 1] - lines[:, 0]
    passed = np.einsum("nkc,kc->nk", p[:, None] - lines[:, 0], along)
    share = np.clip(passed / np.einsum("kc,kc->k", along, along), 0.0, 1.0)
    foot = lines[:, 0] + share[..., None] * along - p[:, None]
    size = np.linalg.norm(foot, axis=-1)
    pick = np.argmin(size, axis=1)[:, None]
    depth = np.take_along_axis(size, pick, axis=1)[:, 0]
    towards = np.take_along_axis(foot, pick[..., None], axis=1)[:, 0]
    for a, centre, r, sb in arcs:
        d = p - [a, centre]
        length = np.linalg.norm(d, axis=1)
        on_arc = (d[:, 0] >= 0) & (np.sqrt(1 - sb**2) * d[:, 1] + sb * d[:, 0] <= 0)
        use = on_arc & (r - length < depth) & (length > 0)
        depth = np.where(use, r - length, depth)
        towards = np.where(use[:, None], d, towards)
    size = np.linalg.norm(towards, axis=1, keepdims=True)
    return np.column_stack([depth, towards / np.where(size > 0, size, 1.0)])


def signed_distance(pieces: Array, points: ArrayLike) -> Distance:
    """Exact signed distance of points from a union of pieces that are stacked along one axis.

    Parameters
    ----------
    pieces : (k, 8) array
        From `solid_pieces`, or the rows of one component.
    points : (n, 3) array_like
        In the tool's frame: tip at the origin, axis along +z, mm.

    Returns
    -------
    Distance
        Outside, the distance; inside, minus the distance to the border of the union: the faces in which one piece
        stands on another are no border.  On the axis, where the direction is not unique, the gradient points along x.

    Raises
    ------
    InvalidInput
        When the points are not rows of three finite numbers.

    Notes
    -----
    **Properties**: 1. zero on the border; 2. 1-Lipschitz; 3. convex for the cutter alone; 4. turns with the tool.
    """
    rows = as_rows(points, 3, "points")
    rho = np.hypot(rows[:, 0], rows[:, 1])
    z = rows[:, 2].copy()
    found = nearest_piece(pieces, rho, z)
    thick = pieces[pieces[:, 5] > pieces[:, 4]]
    within = nearest_piece(thick, rho, z)[:, 0] <= 0
    if within.any() and len(pieces) > 1:
        deep = _depth(pieces, rho[within], z[within])
        found[within, 0] = -deep[:, 0]
        found[within, 1:] = np.where(deep[:, :1] > 0, deep[:, 1:], found[within, 1:])
    away = rows[:, :2] / np.where(rho > 0, rho, 1.0)[:, None]
    radial = np.where(rho[:, None] > 0, away, [1.0, 0.0])
    return Distance(found[:, 0], np.column_stack([radial * found[:, 1:2], found[:, 2]]))
