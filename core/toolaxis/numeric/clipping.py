"""Polygons with holes cut along lines of constant x or y."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import inside, signed_area, slabs

Array = NDArray[np.float64]

SLIVER = 1e-12


def clipped(loops: tuple[Array, ...], axis: int, limit: float, above: bool) -> tuple[Array, ...]:
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
        Loops without area are left out; empty where nothing remains.

    **Properties**: 1. the areas of both sides add up to the whole.
    """
    sign = 1.0 if above else -1.0
    whole: list[Array] = []
    chains: list[Array] = []
    for loop in loops:
        depth = sign * (loop[:, axis] - limit)
        if (depth >= 0).all():
            whole.append(loop)
        elif (depth > 0).any():
            chains += _chains(loop, depth, axis, limit)
    joined = whole + _joined(chains, 1 - axis)
    size = max((float(np.ptp(loop, axis=0).prod()) for loop in loops), default=0.0)
    return tuple(loop for loop in joined if len(loop) > 2 and abs(signed_area(loop)) > SLIVER * size)


def grouped(loops: tuple[Array, ...]) -> list[tuple[Array, ...]]:
    """Loops of several separate polygons, sorted into one tuple a polygon: its border first, then its holes.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Loops that do not cross.
    """
    groups: list[list[Array]] = []
    for loop in sorted(loops, key=lambda one: -abs(signed_area(one))):
        around = [group for group in groups if inside(slabs(tuple(group)), loop).mean() > 0.5]
        if around:
            around[-1].append(loop)
        else:
            groups.append([loop])
    return [tuple(group) for group in groups]


def _chains(loop: Array, depth: Array, axis: int, limit: float) -> list[Array]:
    """Runs of a loop on the kept side, each from the line to the line."""
    inside = depth >= 0
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


def _joined(chains: list[Array], along: int) -> list[Array]:
    """Closed loops from chains, their ends joined in pairs along the line."""
    ends = sorted((float(chain[end][along]), k, end) for k, chain in enumerate(chains) for end in (0, -1))
    partner: dict[tuple[int, int], tuple[int, int]] = {}
    for one, other in zip(ends[::2], ends[1::2], strict=True):
        partner[one[1:]], partner[other[1:]] = other[1:], one[1:]
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
