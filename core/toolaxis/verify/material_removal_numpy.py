"""The plain twin of the removal kernel: pairs of rays and motions on whole arrays."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.verify.revolved_solids import meridian_numpy
from toolaxis.verify.swept_solid import LEAST, LOOK, ROOT

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Motion = tuple[Array, Array, Array, Array]
Pairs = tuple[Array, Motion, Array]

#: Pairs of a block of rays and a motion, and of a ray and a motion, that are looked at together.
_BLOCK_PAIRS, _PAIRS = 2_000_000, 200_000
_NEAREST = 4


def _moment(pairs: Pairs, s: Array, t: Array) -> tuple[Array, Array, Array]:
    """`sweep.moment` for pairs (solid, motions, rays) of one row each."""
    solid, (start, step, axis, turn), ray = pairs
    w = ray[:, :3] + t[:, None] * ray[:, 3:6] - start - s[:, None] * step
    lean = axis + s[:, None] * turn
    m = 1.0 / np.linalg.norm(lean, axis=1)
    lean = lean * m[:, None]
    z = np.einsum("ij,ij->i", w, lean)
    across = w - z[:, None] * lean
    rho = np.linalg.norm(across, axis=1)
    value, along_rho, along_z = meridian_numpy(solid, rho, z)
    share = np.where(rho > 1e-12, along_rho / np.maximum(rho, 1e-12), 0.0)
    gradient = share[:, None] * across + along_z[:, None] * lean
    slope = -np.einsum("ij,ij->i", gradient, step) + m * np.einsum("ij,ij->i", across, turn) * (along_z - share * z)
    return value, slope, np.einsum("ij,ij->i", gradient, ray[:, 3:6])


def _rows(pairs: Pairs, which: NDArray[np.bool_]) -> Pairs:
    solid, motion, ray = pairs
    start, step, axis, turn = motion
    return solid, (start[which], step[which], axis[which], turn[which]), ray[which]


def _zero_numpy(width: Array, slope: tuple[Array, Array], other: tuple[Array, Array]) -> Array:
    """`sweep._zero` on arrays."""
    da, db = slope
    c, dc = other
    three = (dc != da) & (dc != db)
    safe = np.where(three, dc, 2 * db + 1.0)
    of_end = width * da * safe / ((db - da) * (db - safe))
    of_other = c * da * db / ((safe - da) * (safe - db))
    part = of_end + of_other
    chord = -da / (db - da) * width
    return np.asarray(np.where(three & (0.0 < part) & (part < width), part, chord))


def least_over_motion_numpy(pairs: Pairs, t: Array) -> tuple[Array, Array, Array]:
    """Least of the solid's function over the motion, for each pair of a motion and a ray's point.

    Parameters
    ----------
    pairs : solid, motions (four arrays of (n, 3)), rays (n, 6 or more)
    t : (n,) array
        Place on each ray, mm.

    Returns
    -------
    value, low, along : (n,) arrays
        As `sweep.least_over_motion` returns them.
    """
    count = len(t)
    # Both ends of the span in which the least value lies: place, value, slope over the motion, and slope along the ray.
    a = np.zeros(count)
    b = np.ones(count)
    va, da, ta = _moment(pairs, a, t)
    vb, db, tb = _moment(pairs, b, t)
    at_start = da >= 0
    at_end = (da < 0) & (db <= 0)
    low = np.where(at_end, vb, va)
    along = np.where(at_end, tb, ta)
    value = low.copy()
    open_ = ~(at_start | at_end)
    c = a.copy()  # the end before the last step, for an interpolation through three places
    dc = da.copy()
    for turn in range(120):
        if not open_.any():
            break
        width = b - a
        gap = np.where(open_, db - da, 1.0)
        low = np.where(open_, (va * db - vb * da + da * db * width) / gap, low)
        along = np.where(open_, (db * ta - da * tb) / gap, along)
        value = np.where(open_, np.minimum(va, vb), value)
        open_ &= value - low > LEAST
        i = np.flatnonzero(open_)
        if turn % 4 < 3:
            part = _zero_numpy(width[i], (da[i], db[i]), (c[i] - a[i], dc[i]))
        elif turn % 8 == 3:
            part = (low[i] - va[i]) / da[i]
        else:
            part = 0.5 * width[i]
        s = a[i] + np.clip(part, 1e-3 * width[i], 0.999 * width[i])
        v, d, slope = _moment(_rows(pairs, open_), s, t[i])
        below = d <= 0
        for which, end in ((below, (a, va, da, ta)), (~below, (b, vb, db, tb))):
            rows = i[which]
            place, _, steepness, _ = end
            c[rows] = place[rows]
            dc[rows] = steepness[rows]
            for old, new in zip(end, (s, v, d, slope), strict=True):
                old[rows] = new[which]
    return value, np.minimum(low, value), along


def first_entry_numpy(pairs: Pairs, low: Array, high: Array) -> Array:
    """`sweep.first_entry` for pairs of a motion and a ray.

    Parameters
    ----------
    pairs : solid, motions, rays
    low, high : (n,) array
        Span of each ray, mm.

    Returns
    -------
    (n,) array, inf where the ray stays outside
    """
    t = np.array(low, dtype=float)
    entry = np.full(len(low), np.inf)
    open_ = t <= high
    _, _, axis, turn = pairs[1]
    change = np.linalg.norm(turn, axis=1) / np.linalg.norm(axis + 0.5 * turn, axis=1)
    for _ in range(200):
        i = np.flatnonzero(open_)
        if not len(i):
            break
        value, least, along = least_over_motion_numpy(_rows(pairs, open_), t[i])
        slope = along - change[i]
        found = value <= ROOT
        lost = (value > ROOT) & (slope >= 0)
        entry[i[found]] = t[i[found]]
        ahead = np.where(slope < 0, np.maximum(least, 0.5 * ROOT) / np.where(slope < 0, -slope, 1.0), 0.0)
        t[i] += np.where(found, 0.0, ahead)
        open_[i] = ~(found | lost) & (t[i] <= high[i])
    return entry


def _update(body: tuple[Array, Motion], pair: tuple[Index, Index], ray: Array,
            out: tuple[Array, Array, Index, Index], kinds: tuple[NDArray[np.bool_], Index]) -> None:
    """Meet pairs (rays, motions) and lower what remains, deepen what is gouged."""
    i, k = pair
    remaining, gouge, cut_by, gouged_by = out
    cutting, arrival = kinds
    solid, (start, step, axis, turn) = body
    pairs = (solid, (start[k], step[k], axis[k], turn[k]), ray[i])
    level = np.where(cutting[k] & (remaining[i] > 0), np.minimum(remaining[i], ray[i, 7]), -gouge[i])
    value, slope, along = _moment(pairs, np.full(len(i), 0.5), level)
    change = np.linalg.norm(turn[k], axis=1) / np.linalg.norm(axis[k] + 0.5 * turn[k], axis=1)
    least = value - 0.5 * np.abs(slope) - np.maximum(along + change, 0) * (level + ray[i, 6])
    keep = least <= LOOK
    i = i[keep]
    k = k[keep]
    level = level[keep]
    pairs = _rows(pairs, keep)
    entry = first_entry_numpy(pairs, -ray[i, 6], level)
    order = np.argsort(-entry, kind="stable")
    deep = order[np.isfinite(entry[order]) & (-entry[order] > gouge[i[order]])]
    gouge[i[deep]] = 0.0
    np.maximum.at(gouge, i[deep], -entry[deep])
    deepest = deep[-entry[deep] >= gouge[i[deep]]]
    gouged_by[i[deepest]] = arrival[k[deepest]]
    below = (entry < 0) & cutting[k]
    entry[below] = first_entry_numpy(_rows(pairs, below), np.zeros(below.sum()), level[below])
    cut = np.flatnonzero(cutting[k] & (entry >= 0) & (entry < remaining[i]))
    np.minimum.at(remaining, i[cut], entry[cut])
    lowest = cut[entry[cut] <= remaining[i[cut]]]
    cut_by[i[lowest]] = arrival[k[lowest]]


def remove_numpy(body: tuple[Array, Motion], tables: tuple[Array, NDArray[np.bool_], Index],
                 rays: tuple[Array, Array, Index], out: tuple[Array, Array, Index, Index]) -> None:
    """Meet every ray with every motion near it.

    Parameters
    ----------
    body : (7,) array, and four (n, 3) arrays
        The solid; start, step, axis and turn of its motions.
    tables : slack (n,), cutting (n,), arrival (n,)
    rays : ray (m, 8), ball (b, 4), first (b + 1,)
    out : remaining, gouge, cut_by, gouged_by, each (m,); changed in place
    """
    slack, cutting, arrival = tables
    ray, ball, first = rays
    solid, (start, step, axis, turn) = body
    middle = start + 0.5 * step
    lean = axis + 0.5 * turn
    lean = lean / np.linalg.norm(lean, axis=1, keepdims=True)
    kinds = (cutting, arrival)
    together = max(1, _BLOCK_PAIRS // len(start))
    for b in range(0, len(ball), together):
        part = ball[b:b + together]
        w = part[:, None, :3] - middle
        z = np.einsum("bkj,kj->bk", w, lean)
        rho = np.linalg.norm(w - z[..., None] * lean, axis=2)
        bound = meridian_numpy(solid, rho, z)[0] - slack - part[:, 3:]
        # The nearest motions first: after them little is left for most of the others.
        near = np.zeros_like(bound, dtype=bool)
        nearest = np.argsort(bound, axis=1, kind="stable")[:, :_NEAREST]
        np.put_along_axis(near, nearest, True, axis=1)
        for chosen in (near, ~near):
            for j in range(len(part)):
                i = np.arange(first[b + j], first[b + j + 1])
                lever = np.maximum(ray[i, 6], np.minimum(out[0][i], ray[i, 7])).max()
                k = np.flatnonzero(chosen[j] & (bound[j] <= lever))
                for some in np.array_split(k, len(i) * len(k) // _PAIRS + 1):
                    pair = (np.repeat(i, len(some)), np.tile(some, len(i)))
                    _update(body, pair, ray, out, kinds)
