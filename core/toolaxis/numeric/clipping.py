"""Polygons with holes cut along lines of constant x or y."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import chords, inside, signed_area, slabs

Array = NDArray[np.float64]

#: Loops whose mean width is less than this share of the polygon's size are left out.
SLIVER = 1e-6
#: Vertices nearer to the line than this share of the polygon's size lie on it: rounding must not decide on which side.
ON_LINE = 1e-9


def clip_half_plane(loops: tuple[Array, ...], axis: int, limit: float, above: bool) -> tuple[Array, ...]:
    """The part of a polygon with holes on one side of an axis-parallel line.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Closed loops without repeated end points; points inside an odd number of them belong to the polygon.
    axis : int
        0 cuts along x = limit, 1 along y = limit.
    limit : float
    above : bool
        Keep the side of larger coordinates.

    Returns
    -------
    tuple of (k, 2) arrays
        Loops without area or as thin as rounding makes them are left out; empty where nothing remains.

    **Properties**: 1. the areas of both sides add up to the whole, but for `SLIVER`; 2. vertices moved by less than
    `ON_LINE` change the loops by no more than that.
    """
    if not loops:
        return ()
    sign = 1.0 if above else -1.0
    size = np.ptp(np.concatenate(loops), axis=0)
    snapped = [_snap_to_line(loop, axis, limit, ON_LINE * float(size[axis])) for loop in loops]
    depths = [sign * (loop[:, axis] - limit) for loop in snapped]
    if all((depth >= 0).all() for depth in depths):
        return _with_width(snapped, size)
    whole: list[Array] = []
    chains: list[Array] = []
    for loop, depth in zip(snapped, depths, strict=True):
        if (depth >= 0).all() and (depth == 0).sum() < 2:
            whole.append(loop)
        elif (depth > 0).any():
            chains += _chains(loop, depth, axis, limit)
    return _with_width(whole + _join_chains(chains, axis), size)


def _snap_to_line(loop: Array, axis: int, limit: float, reach: float) -> Array:
    """A loop with its vertices next to the line moved onto it."""
    moved = loop.copy()
    moved[np.abs(loop[:, axis] - limit) <= reach, axis] = limit
    return moved


def _with_width(loops: list[Array], size: Array) -> tuple[Array, ...]:
    """The loops that are more than slivers of a polygon of given size."""
    scale = np.where(size > 0, size, 1.0)
    kept = []
    for loop in loops:
        unit = (loop - loop[0]) / scale
        if len(loop) > 2 and abs(signed_area(unit)) > SLIVER * float(np.ptp(unit, axis=0).max()):
            kept.append(loop)
    return tuple(kept)


def outer_with_holes(loops: tuple[Array, ...]) -> list[tuple[Array, ...]]:
    """Loops of several separate polygons, sorted into one tuple a polygon: its border first, then its holes.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Loops that do not cross.
    """
    groups: list[list[Array]] = []
    lowest, highest = np.empty((len(loops), 2)), np.empty((len(loops), 2))
    for loop in sorted(loops, key=lambda one: -abs(signed_area(one))):
        within, count = _inner_point(loop), len(groups)
        # Most of many small polygons are told apart by their boxes.
        near = np.flatnonzero(((lowest[:count] <= within) & (within <= highest[:count])).all(axis=1))
        around = [groups[k] for k in near if inside(slabs(tuple(groups[k])), within)[0]]
        if around:
            around[-1].append(loop)
        else:
            lowest[count], highest[count] = loop.min(axis=0), loop.max(axis=0)
            groups.append([loop])
    return [tuple(group) for group in groups]


def _inner_point(loop: Array) -> Array:
    """A point inside a loop and well off it, (1, 2): whatever touches the loop does not hold it by rounding."""
    heights = np.unique(loop[:, 1])
    if len(heights) < 2:
        return loop[:1]
    k = int(np.argmax(np.diff(heights)))
    y = (heights[k] + heights[k + 1]) / 2
    across = chords((loop,), y)
    return np.array([[across[np.argmax(np.diff(across)[:, 0])].mean(), y]])


def _chains(loop: Array, depth: Array, axis: int, limit: float) -> list[Array]:
    """Runs of a loop strictly on the kept side, each from the line to the line."""
    inside = depth > 0
    start = int(np.flatnonzero(~inside)[0])
    order = np.r_[start:len(loop), 0:start + 1]
    loop, depth, inside = loop[order], depth[order], inside[order]
    chains = []
    enter = np.flatnonzero(~inside[:-1] & inside[1:])
    leave = np.flatnonzero(inside[:-1] & ~inside[1:])
    for a, b in zip(enter, leave, strict=True):
        ends = [_crossing(loop[k], loop[k + 1], depth[k], depth[k + 1], axis, limit) for k in (a, b)]
        chains.append(np.concatenate([ends[:1], loop[a + 1:b + 1], ends[1:]]))
    return chains


def _crossing(p: Array, q: Array, dp: float, dq: float, axis: int, limit: float) -> Array:
    point = p + (q - p) * dp / (dp - dq)
    point[axis] = limit
    return np.asarray(point)


def _join_chains(chains: list[Array], axis: int) -> list[Array]:
    """Closed loops from chains, their ends joined in pairs along the line, in the order in which they leave it."""
    ends = []
    for k, chain in enumerate(chains):
        for end, after in ((0, 1), (-1, -2)):
            way = chain[after] - chain[end]
            ends.append((float(chain[end][1 - axis]), float(way[1 - axis] / abs(way[axis])), k, end))
    ends.sort()
    partner: dict[tuple[int, int], tuple[int, int]] = {}
    for one, other in zip(ends[::2], ends[1::2], strict=True):
        partner[one[2:]], partner[other[2:]] = other[2:], one[2:]
    loops, free = [], set(range(len(chains)))
    while free:
        first = key = (min(free), 0)
        pieces = []
        while True:
            k, end = key
            free.discard(k)
            pieces.append(chains[k] if end == 0 else chains[k][::-1])
            key = partner[k, -1 - end]
            if key == first:
                break
        loops.append(_without_repeats(np.concatenate(pieces)))
    return loops


def _without_repeats(loop: Array) -> Array:
    return np.asarray(loop[(loop != np.roll(loop, 1, axis=0)).any(axis=1)])
