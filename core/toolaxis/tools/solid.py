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
    centre[:, 0, 2], centre[:, 1, 2] = pieces[:, 4] + pieces[:, 1], pieces[:, 5]
    ball = np.stack([pieces[:, 1], np.zeros(count)], axis=1)
    return ConvexBodies(centre, np.tile([0.0, 0.0, 1.0], (count, 2, 1)), pieces[:, [0, 6]], ball,
                        np.zeros((count, 3, 3)))


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
    a, r, cb, sb = piece[0], piece[1], piece[2], piece[3]
    x, y = rho - a, z - piece[4] - r
    x_rim, y_rim = rho - piece[6], z - piece[5]
    best, along_rho, along_z, bend = piece[4] - z, 0.0, -1.0, 0.0
    side = cb * x - sb * y - r
    if side > best:
        best, along_rho, along_z = side, cb, -sb
    if y_rim > best:
        best, along_rho, along_z = y_rim, 0.0, 1.0
    if x > 0.0 and cb * y + sb * x < 0.0:
        length = np.sqrt(x * x + y * y)
        if length - r > best:
            best, along_rho, along_z, bend = length - r, x / length, y / length, 1.0 / length
    if x_rim > 0.0 and cb * y_rim + sb * x_rim > 0.0:
        length = np.sqrt(x_rim * x_rim + y_rim * y_rim)
        if length > best:
            best, along_rho, along_z, bend = length, x_rim / length, y_rim / length, 1.0 / length
    return best, along_rho, along_z, bend


def piece_distance_numpy(piece: Array, rho: Array, z: Array) -> tuple[Array, Array, Array, Array]:
    """The plain twin of `piece_distance` on arrays.

    Parameters and result as there; ``piece`` may have leading axes that broadcast against ``rho``.
    """
    a, r, cb, sb, low, top, rim = (piece[..., k] for k in range(7))
    x, y, x_rim, y_rim = rho - a, z - low - r, rho - rim, z - top
    d, d_rim = np.hypot(x, y), np.hypot(x_rim, y_rim)
    ok, ok_rim = (x > 0) & (cb * y + sb * x < 0), (x_rim > 0) & (cb * y_rim + sb * x_rim > 0)
    options = np.stack(np.broadcast_arrays(low - z, cb * x - sb * y - r, y_rim, np.where(ok, d - r, -np.inf),
                                           np.where(ok_rim, d_rim, -np.inf)))
    pick = np.argmax(options, axis=0)
    value = np.take_along_axis(options, pick[None], axis=0)[0]
    safe, safe_rim = np.where(d > 0, d, 1.0), np.where(d_rim > 0, d_rim, 1.0)
    along_rho = np.choose(pick, [0.0, cb, 0.0, x / safe, x_rim / safe_rim])
    along_z = np.choose(pick, [-1.0, -sb, 1.0, y / safe, y_rim / safe_rim])
    return value, along_rho, along_z, np.choose(pick, [0.0, 0.0, 0.0, 1 / safe, 1 / safe_rim])


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
                out[k, 0], out[k, 1], out[k, 2] = value, along_rho, along_z


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
    thick = pieces[pieces[:, 5] > pieces[:, 4]]
    start = thick[:, 4] + thick[:, 1] * (1 - thick[:, 3])
    base = thick[:, 0] + thick[:, 1] * thick[:, 2]
    slope = thick[:, 3] / thick[:, 2]
    heights = [thick[:, 4], thick[:, 5], start]
    for i in range(len(thick)):
        steeper = np.flatnonzero(slope[i] != slope)
        meet = (base[steeper] - slope[steeper] * start[steeper] - base[i] + slope[i] * start[i]) / (
            slope[i] - slope[steeper])
        heights.append(meet[(meet > start[i]) & (meet < thick[i, 5])])
    z = np.unique(np.concatenate(heights))
    z = z[np.concatenate([[True], np.diff(z) > 1e-9 * (z[-1] - z[0])])]
    middle = (z[:-1] + z[1:]) / 2
    over = (middle[:, None] > start) & (middle[:, None] < thick[:, 5])
    radius = np.where(over, base + slope * (middle[:, None] - start), -1.0)
    top = np.argmax(radius, axis=1)
    arc = np.array([((m > thick[:, 4]) & (m < start)).any() for m in middle])
    ends = np.stack([base[top] + slope[top] * (h - start[top]) for h in (z[:-1], z[1:])], axis=1)
    ends[~over.any(axis=1)] = 0.0
    first = int(np.argmin(thick[:, 4]))
    ends[arc] = [[thick[first, 0], base[first]]] if arc.any() else 0.0
    sides = [np.array([[e[0], lo], [e[1], hi]]) for e, lo, hi, bent in zip(ends, z[:-1], z[1:], arc, strict=True)
             if not bent and e.any()]
    inner = np.concatenate([[0.0], ends[:, 1]]), np.concatenate([ends[:, 0], [0.0]])
    steps = [np.array([[lo, h], [hi, h]]) for lo, hi, h in zip(*inner, z, strict=True) if lo != hi]
    arcs = thick[thick[:, 1] > 0]
    return np.array(sides + steps), np.column_stack([arcs[:, 0], arcs[:, 4] + arcs[:, 1], arcs[:, 1], arcs[:, 3]])


def _depth(pieces: Array, rho: Array, z: Array) -> Array:
    """Distance to the border of the union and unit direction towards it in the meridian plane, (n, 3)."""
    lines, arcs = _envelope(pieces)
    p = np.stack([rho, z], axis=-1)
    along = lines[:, 1] - lines[:, 0]
    share = np.clip(np.einsum("nkc,kc->nk", p[:, None] - lines[:, 0], along) / np.einsum("kc,kc->k", along, along),
                    0.0, 1.0)
    foot = lines[:, 0] + share[..., None] * along - p[:, None]
    size = np.linalg.norm(foot, axis=-1)
    pick = np.argmin(size, axis=1)[:, None]
    depth = np.take_along_axis(size, pick, axis=1)[:, 0]
    towards = np.take_along_axis(foot, pick[..., None], axis=1)[:, 0]
    for a, centre, r, sb in arcs:
        d = p - [a, centre]
        length = np.linalg.norm(d, axis=1)
        use = (d[:, 0] >= 0) & (np.sqrt(1 - sb**2) * d[:, 1] + sb * d[:, 0] <= 0) & (r - length < depth) & (length > 0)
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
    rho, z = np.hypot(rows[:, 0], rows[:, 1]), rows[:, 2].copy()
    found = nearest_piece(pieces, rho, z)
    thick = pieces[pieces[:, 5] > pieces[:, 4]]
    within = nearest_piece(thick, rho, z)[:, 0] <= 0
    if within.any() and len(pieces) > 1:
        deep = _depth(pieces, rho[within], z[within])
        found[within, 0] = -deep[:, 0]
        found[within, 1:] = np.where(deep[:, :1] > 0, deep[:, 1:], found[within, 1:])
    radial = np.where(rho[:, None] > 0, rows[:, :2] / np.where(rho > 0, rho, 1.0)[:, None], [1.0, 0.0])
    return Distance(found[:, 0], np.column_stack([radial * found[:, 1:2], found[:, 2]]))
