"""The plain twin of `touch`: every triangle at every point, edges solved by bisection."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.drop_cutter.kernel import MISS, STEEP, THIN, Cutter

Array = NDArray[np.float64]

#: Halvings of an edge: enough for the last bit.
_HALVINGS = 60
#: Triangles looked at first, to leave out most of the others.
_FIRST = 32


def underside_numpy(cutter: Cutter, rho: Array) -> tuple[Array, Array]:
    """Height of the cutter's underside above its tip, mm, and its slope, at distances from the axis.

    Parameters
    ----------
    cutter : Cutter
    rho : array
        mm
    """
    flat, corner, sine, cosine, _ = cutter
    cotangent = cosine / sine if sine > 0 else np.inf
    on_corner = np.clip(rho - flat, 0.0, corner * cosine)
    on_cone = np.maximum(rho - flat - corner * cosine, 0.0)
    depth = np.sqrt(corner**2 - on_corner**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        corner_slope = np.where(on_corner > 0, on_corner / depth, 0.0)
    slope = np.where(on_cone > 0, cotangent, corner_slope)
    cone_height = on_cone * cotangent if sine > 0 else 0.0
    return corner - depth + cone_height, slope


def edge_tips_numpy(cutter: Cutter, low: Array, high: Array) -> Array:
    """Tips at the origin that rest on edges, -inf where an edge is out of reach, (n,).

    Parameters
    ----------
    cutter : Cutter
    low, high : (n, 3) array
        Lower and upper ends, relative to the axis, mm.
    """
    widest = cutter[4]
    along = high - low
    rise = along[:, 2]
    flat_along = along[:, :2]
    span = (flat_along**2).sum(axis=1)
    safe = np.where(span > 0, span, 1.0)
    # Where the edge comes nearest to the axis, as a share of it, and the square of its distance there.
    foot = np.where(span > 0, -(low[:, :2] * flat_along).sum(axis=1) / safe, 0.0)
    off = low[:, :2] + foot[:, None] * flat_along
    square = (off**2).sum(axis=1)
    with np.errstate(invalid="ignore"):
        reach = np.where(span > 0, np.sqrt((widest**2 - square) / safe), np.inf)
    out = np.where(span > 0, np.isnan(reach), square > widest**2)
    begin = np.maximum(0.0, foot - reach)
    end = np.minimum(1.0, foot + reach)
    out |= ~(begin <= end)
    begin = np.where(out, 0.0, begin)
    end = np.where(out, 0.0, end)
    # The tip is highest where the edge rises no more than the cutter's underside does over it.
    first = begin
    last = end
    for _ in range(_HALVINGS):
        t = 0.5 * (first + last)
        rho = np.sqrt(square + span * (t - foot) ** 2)
        _, slope = underside_numpy(cutter, rho)
        with np.errstate(invalid="ignore"):
            rises = rise * rho >= slope * span * (t - foot)
        first = np.where(rises, t, first)
        last = np.where(rises, last, t)
    tips = np.full(len(low), -np.inf)
    for t in (begin, first, last, end):
        rho = np.minimum(np.sqrt(square + span * (t - foot) ** 2), widest)
        underside, _ = underside_numpy(cutter, rho)
        tips = np.maximum(tips, low[:, 2] + t * rise - underside)
    return np.where(out, -np.inf, tips)


def facet_tips_numpy(cutter: Cutter, corners: Array) -> tuple[Array, Array]:
    """Tips at the origin that rest inside facets, -inf where none does, and what no tip on a triangle exceeds, (n,).

    What a steep or thin facet allows is inf, for rounding may turn its plane.

    Parameters
    ----------
    cutter : Cutter
    corners : (n, 3, 3) array
        Relative to the axis, mm.
    """
    flat, corner, sine, cosine, widest = cutter
    low = corners[:, 0]
    flat_corners = corners[..., :2]
    sides = corners[:, 1:] - corners[:, :1]
    (ax, ay, az), (bx, by, bz) = sides[:, 0].T, sides[:, 1].T
    area = ax * by - ay * bx
    longest = (sides[..., :2] ** 2).sum(axis=2).max(axis=1)
    with np.errstate(all="ignore"):
        slope = np.stack([az * by - bz * ay, bz * ax - az * bx], axis=1) / area[:, None]
        steep = np.hypot(*slope.T)
        # Where the underside is as steep as the facet, and the place on it that touches there.
        rho = np.where(sine * steep > cosine, widest, flat + corner * steep / np.hypot(1.0, steep))
        touch = np.where(steep > 0, rho / steep, 0.0)[:, None] * slope
        rest = low[:, 2] + (slope * (touch - low[:, :2])).sum(axis=1)
        fall, _ = underside_numpy(cutter, np.where(steep > 0, rho, 0.0))
        around = np.roll(flat_corners, -1, axis=1) - flat_corners
        aside = touch[:, None] - flat_corners
        crossed = around[..., 0] * aside[..., 1] - around[..., 1] * aside[..., 0]
        inside = (crossed * area[:, None] >= 0).all(axis=1)
        plane_rises = (slope[:, None] * sides[..., :2]).sum(axis=2)
        miss = np.abs(plane_rises - sides[..., 2]).max(axis=1)
        thin = ~(np.abs(area) >= THIN * longest)
        exact = miss <= MISS
        real = exact | (steep > STEEP) | ~thin
        plain = exact & (steep <= STEEP) & ~thin
    ceiling = corners[..., 2].max(axis=1)
    tips = np.where(plain, rest, np.minimum(rest, ceiling)) - fall
    return np.where(inside & real, tips, -np.inf), np.where(plain, tips, np.inf)


def drop_numpy(cutter: Cutter, corners: Array, xy: Array) -> Array:
    """Heights of the tip at points (k, 2) over triangles (n, 3, 3), -inf where there is nothing to rest on.

    Parameters
    ----------
    cutter : Cutter
    corners : (n, 3, 3) array
        In the tool's frame, mm.
    xy : (k, 2) array
        mm
    """
    low = corners[..., :2].min(axis=1)
    high = corners[..., :2].max(axis=1)
    top = corners[..., 2].max(axis=1)
    out = np.full(len(xy), -np.inf)
    for i, point in enumerate(xy):
        outside = np.maximum(np.maximum(low - point, point - high), 0.0)
        away = np.hypot(*outside.T)
        near = np.flatnonzero(away <= cutter[4])
        underside, _ = underside_numpy(cutter, away[near])
        bound = top[near] - underside
        order = np.argsort(-bound, kind="stable")
        near = near[order]
        bound = bound[order]
        for some in (slice(0, _FIRST), slice(_FIRST, None)):
            chosen = near[some][bound[some] > out[i]]
            relative = corners[chosen] - [*point, 0.0]
            out[i] = max(out[i], _highest(cutter, relative, out[i]))
    return out


def _highest(cutter: Cutter, corners: Array, best: float) -> float:
    """Highest tip at the origin over triangles, or best."""
    tips, ceilings = facet_tips_numpy(cutter, corners)
    best = max(best, float(np.max(tips, initial=-np.inf)))
    rest = corners[ceilings > best]
    ends = np.stack([rest, np.roll(rest, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    swap = ends[:, 0, 2] > ends[:, 1, 2]
    ends[swap] = ends[swap, ::-1]
    edge_tips = edge_tips_numpy(cutter, ends[:, 0], ends[:, 1])
    return max(best, float(np.max(edge_tips, initial=-np.inf)))
