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
    t = np.clip(rho - flat, 0.0, corner * cosine)
    beyond = np.maximum(rho - flat - corner * cosine, 0.0)
    depth = np.sqrt(corner**2 - t**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(beyond > 0, cotangent, np.where(t > 0, t / depth, 0.0))
    return corner - depth + (beyond * cotangent if sine > 0 else 0.0), slope


def edge_tips_numpy(cutter: Cutter, low: Array, high: Array) -> Array:
    """Tips at the origin that rest on edges, -inf where an edge is out of reach, (n,).

    Parameters
    ----------
    cutter : Cutter
    low, high : (n, 3) array
        Lower and upper ends, relative to the axis, mm.
    """
    along = high - low
    span = (along[:, :2] ** 2).sum(axis=1)
    safe = np.where(span > 0, span, 1.0)
    foot = np.where(span > 0, -(low[:, :2] * along[:, :2]).sum(axis=1) / safe, 0.0)
    off = low[:, :2] + foot[:, None] * along[:, :2]
    square = (off**2).sum(axis=1)
    with np.errstate(invalid="ignore"):
        reach = np.where(span > 0, np.sqrt((cutter[4] ** 2 - square) / safe), np.inf)
    out = np.where(span > 0, np.isnan(reach), square > cutter[4] ** 2)
    first, last = np.maximum(0.0, foot - reach), np.minimum(1.0, foot + reach)
    out |= ~(first <= last)
    begin, end = np.where(out, 0.0, first), np.where(out, 0.0, last)
    first, last = begin, end
    for _ in range(_HALVINGS):
        t = 0.5 * (first + last)
        rho = np.sqrt(square + span * (t - foot) ** 2)
        slope = underside_numpy(cutter, rho)[1]
        with np.errstate(invalid="ignore"):
            rises = along[:, 2] * rho >= slope * span * (t - foot)
        first, last = np.where(rises, t, first), np.where(rises, last, t)
    tips = np.full(len(low), -np.inf)
    for t in (begin, first, last, end):
        rho = np.minimum(np.sqrt(square + span * (t - foot) ** 2), cutter[4])
        tips = np.maximum(tips, low[:, 2] + t * along[:, 2] - underside_numpy(cutter, rho)[0])
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
    low, sides = corners[:, 0], corners[:, 1:] - corners[:, :1]
    area = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    longest = (sides[..., :2] ** 2).sum(axis=2).max(axis=1)
    with np.errstate(all="ignore"):
        slope = np.stack([sides[:, 0, 2] * sides[:, 1, 1] - sides[:, 1, 2] * sides[:, 0, 1],
                          sides[:, 1, 2] * sides[:, 0, 0] - sides[:, 0, 2] * sides[:, 1, 0]], axis=1) / area[:, None]
        steep = np.hypot(*slope.T)
        rho = np.where(sine * steep > cosine, widest, flat + corner * steep / np.hypot(1.0, steep))
        touch = np.where(steep > 0, rho / steep, 0.0)[:, None] * slope
        rest = low[:, 2] + (slope * (touch - low[:, :2])).sum(axis=1)
        fall = underside_numpy(cutter, np.where(steep > 0, rho, 0.0))[0]
        turned = np.roll(corners, -1, axis=1)[..., :2] - corners[..., :2]
        aside = touch[:, None] - corners[..., :2]
        inside = ((turned[..., 0] * aside[..., 1] - turned[..., 1] * aside[..., 0]) * area[:, None] >= 0).all(axis=1)
        miss = np.abs((slope[:, None] * sides[..., :2]).sum(axis=2) - sides[..., 2]).max(axis=1)
        thin = ~(np.abs(area) >= THIN * longest)
        real = (miss <= MISS) | (steep > STEEP) | ~thin
        plain = (miss <= MISS) & (steep <= STEEP) & ~thin
    tips = np.where(plain, rest, np.minimum(rest, corners[..., 2].max(axis=1))) - fall
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
    low, high, top = corners[..., :2].min(axis=1), corners[..., :2].max(axis=1), corners[..., 2].max(axis=1)
    out = np.full(len(xy), -np.inf)
    for i, point in enumerate(xy):
        away = np.hypot(*np.maximum(np.maximum(low - point, point - high), 0.0).T)
        near = np.flatnonzero(away <= cutter[4])
        bound = top[near] - underside_numpy(cutter, away[near])[0]
        near, bound = near[order := np.argsort(-bound, kind="stable")], bound[order]
        for some in (slice(0, _FIRST), slice(_FIRST, None)):
            chosen = near[some][bound[some] > out[i]]
            out[i] = max(out[i], _highest(cutter, corners[chosen] - [*point, 0.0], out[i]))
    return out


def _highest(cutter: Cutter, corners: Array, best: float) -> float:
    """Highest tip at the origin over triangles, or best."""
    tips, ceilings = facet_tips_numpy(cutter, corners)
    best = max(best, float(np.max(tips, initial=-np.inf)))
    rest = corners[ceilings > best]
    ends = np.stack([rest, np.roll(rest, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    swap = ends[:, 0, 2] > ends[:, 1, 2]
    ends[swap] = ends[swap, ::-1]
    return max(best, float(np.max(edge_tips_numpy(cutter, ends[:, 0], ends[:, 1]), initial=-np.inf)))
