"""Polygons with holes divided by other polygons: what lies inside them, and what outside."""

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.numeric.polygons import inside, slabs

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Loops = tuple[Array, ...]
Corner = tuple[float, float]
Edge = tuple[Corner, Corner]

#: Share of a loop's size up to which corners coincide and spikes have no width.
_SPIKE = 1e-8
#: Edges of a stretch that tell on which side of a border it lies, of those that are no shorter than this share of the
#: longest: others may be the ends at a crossing.
_ASKED, _LONG = 9, 1e-3
_ON_BORDER = "a corner of one polygon lies on the border of the other: move one of them a little"
#: Shares of its size by which a polygon is moved so that no corner lies on another one's border, and the way.
_MOVES, _ASLANT = (0.0, 1.7e-7, -3.1e-7, 7.3e-7, -1.3e-6), np.array([0.8, 0.6])
#: Rows of one polygon's edges that are held against all of the other's at a time.
_ROWS = 256


class _Chain(NamedTuple):
    """A stretch of a loop between two crossings, or a whole loop (ends -1): its points, and its two crossings."""

    points: Array
    first: int
    last: int


def divide_polygon(loops: Loops, by: Loops) -> tuple[Loops, Loops]:
    """A polygon divided by another one.

    Parameters
    ----------
    loops, by : tuple of (m, 2) arrays
        Closed loops without repeated end points; points inside an odd number of them belong to the polygon.

    Returns
    -------
    inside, outside : tuples of (k, 2) arrays
        What of the first lies in the second, and the rest; both have the very same points on the border between them.

    Raises
    ------
    InvalidInput
        When a corner of the one lies on the border of the other, so that rounding would decide: move one of them a
        little.

    Notes
    -----
    Where two borders cross, one of the two stretches of each lies inside the other polygon: so two stretches that
    belong to a result meet at every crossing, and loops close without regard to their sense.

    **Properties**: 1. the areas of both results add up to the whole; 2. what is divided by nothing lies outside.
    """
    if not loops or not by:
        return (), loops
    one, other, points = _crossings(loops, by)
    own, cutting = _chains(loops, one, points), _chains(by, other, points)
    own_in, cutting_in = _within(own, by), _within(cutting, loops)
    within = [chain for chain, kept in zip(cutting, cutting_in, strict=True) if kept]
    return (_close_chains([chain for chain, kept in zip(own, own_in, strict=True) if kept] + within, len(points)),
            _close_chains([chain for chain, kept in zip(own, own_in, strict=True) if not kept] + within, len(points)))


def divide_nearly(loops: Loops, by: Loops) -> tuple[Loops, Loops]:
    """A polygon divided by another one, which is moved by a millionth of its size where a corner lies on a border.

    Where that is not enough, spikes without width are cut off both first, and edges that two loops of the polygon share
    are taken out: they cross a border twice in one place.

    Parameters
    ----------
    loops, by
        As for `divide_polygon`.

    Returns
    -------
    inside, outside : tuples of (k, 2) arrays
        As of `divide_polygon`.

    Raises
    ------
    InvalidInput
        When none of the moves that are tried parts corners and borders.

    **Properties**: 1. the areas of both results add up to the whole.
    """
    if not loops or not by:
        return (), loops
    size = np.ptp(np.concatenate(by), axis=0).max()
    for share in _MOVES:
        with suppress(InvalidInput):
            return divide_polygon(loops, tuple(loop + share * size * _ASLANT for loop in by))
    loops, by = (tuple(kept for loop in some if len(kept := cut_spikes(loop)) > 2) for some in (loops, by))
    loops = join_touching(loops)
    for share in _MOVES[:-1]:
        with suppress(InvalidInput):
            return divide_polygon(loops, tuple(loop + share * size * _ASLANT for loop in by))
    return divide_polygon(loops, tuple(loop + _MOVES[-1] * size * _ASLANT for loop in by))


def cut_spikes(loop: Array) -> Array:
    """A loop without corners that coincide with the one before, and without those at which it turns back on itself.

    Parameters
    ----------
    loop : (n, 2) array
        Closed, without repeated end points.

    Returns
    -------
    (m, 2) array
        Fewer than three corners where the loop holds no area.
    """
    least = _SPIKE * float(np.ptp(loop, axis=0).max())
    while len(loop) > 2:
        into = loop - np.roll(loop, 1, axis=0)
        out = np.roll(into, -1, axis=0)
        lengths = np.hypot(*into.T), np.hypot(*out.T)
        back = (into * out).sum(axis=1) < 0
        width = np.abs(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0]) / np.maximum(*lengths).clip(least)
        gone = np.flatnonzero((lengths[0] <= least) | (back & (width <= least)))
        if not len(gone):
            break
        # One of two neighbours at a time: cutting off the one may part the other from its spike.
        kept = np.ones(len(loop), dtype=bool)
        kept[gone[np.diff(gone, prepend=-2) > 1]] = False
        loop = loop[kept]
    return loop


def _edges(loops: Loops) -> tuple[Array, Array]:
    return np.concatenate(loops), np.concatenate([np.roll(loop, -1, axis=0) - loop for loop in loops])


def _crossings(loops: Loops, by: Loops) -> tuple[Array, Array, Array]:
    """Where borders cross: edge and share of it, (n, 2), on each, edges counted through all loops; and the points."""
    (a, p), (b, q) = _edges(loops), _edges(by)
    table = np.empty((len(a) + len(b), 4))
    if _compiled.available:
        count = _find_crossings(a, p, b, q, table)
        if count > len(table):
            table = np.empty((count, 4))
            _find_crossings(a, p, b, q, table)
        table = table[:count]
    else:
        table = _find_crossings_plainly(a, p, b, q)
    edge = table[:, 0].astype(np.intp)
    return table[:, :2], table[:, 2:], a[edge] + table[:, 1:2] * p[edge]


@jit
def _find_crossings(a: Array, p: Array, b: Array, q: Array, out: Array) -> int:
    """How often edges from a by p cross those from b by q; as many as fit into rows of edge, share, edge, share."""
    count = 0
    for i in range(a.shape[0]):
        for j in range(b.shape[0]):
            turn = p[i, 0] * q[j, 1] - p[i, 1] * q[j, 0]
            x, y = b[j, 0] - a[i, 0], b[j, 1] - a[i, 1]
            s = (x * q[j, 1] - y * q[j, 0]) / turn
            t = (x * p[i, 1] - y * p[i, 0]) / turn
            if 0.0 <= s < 1.0 and 0.0 <= t < 1.0:
                if count < out.shape[0]:
                    out[count, 0], out[count, 1], out[count, 2], out[count, 3] = i, s, j, t
                count += 1
    return count


def _find_crossings_plainly(a: Array, p: Array, b: Array, q: Array) -> Array:
    """The plain twin: all rows, (n, 4)."""
    found = []
    for low in range(0, len(a), _ROWS):
        start, way = a[low:low + _ROWS, None], p[low:low + _ROWS, None]
        turn = way[..., 0] * q[:, 1] - way[..., 1] * q[:, 0]
        gap = b - start
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (gap[..., 0] * q[:, 1] - gap[..., 1] * q[:, 0]) / turn
            t = (gap[..., 0] * way[..., 1] - gap[..., 1] * way[..., 0]) / turn
        i, j = np.nonzero((s >= 0) & (s < 1) & (t >= 0) & (t < 1))
        found.append(np.column_stack([i + low, s[i, j], j, t[i, j]]))
    return np.concatenate(found)


def _chains(loops: Loops, crossings: Array, points: Array) -> list[_Chain]:
    """The stretches of loops between crossings."""
    chains, before = [], 0
    for loop in loops:
        on = np.flatnonzero((crossings[:, 0] >= before) & (crossings[:, 0] < before + len(loop)))
        place = crossings[on].sum(axis=1) - before
        before += len(loop)
        if not len(on):
            chains.append(_Chain(loop, -1, -1))
            continue
        order = np.argsort(place, kind="stable")
        on, place = on[order], place[order]
        for k in range(len(on)):
            start, end = place[k], place[(k + 1) % len(on)] + (len(loop) if k + 1 == len(on) else 0)
            between = np.arange(int(np.floor(start)) + 1, int(np.ceil(end))) % len(loop)
            first, last = int(on[k]), int(on[(k + 1) % len(on)])
            chains.append(_Chain(np.concatenate([points[[first]], loop[between], points[[last]]]), first, last))
    return chains


def _within(chains: list[_Chain], loops: Loops) -> list[bool]:
    """Whether chains lie inside loops that they do not cross: the middles of some edges of each decide.

    Raises
    ------
    InvalidInput
        When these disagree: the chain runs along a border, where rounding decides.
    """
    middles, counts = [], []
    for chain in chains:
        start = chain.points if chain.first < 0 else chain.points[:-1]
        end = np.roll(chain.points, -1, axis=0)[:len(start)]
        length = np.abs(end - start).sum(axis=1)
        long = np.flatnonzero(length >= _LONG * length.max())
        some = long[np.linspace(0, len(long) - 1, min(len(long), _ASKED)).astype(np.intp)]
        middles.append((start[some] + end[some]) / 2)
        counts.append(len(some))
    within = np.split(inside(slabs(loops), np.concatenate(middles)), np.cumsum(counts)[:-1])
    if any(one.any() != one.all() for one in within):
        raise InvalidInput(_ON_BORDER)
    return [bool(one[0]) for one in within]


def _close_chains(chains: list[_Chain], crossings: int) -> Loops:
    """Loops from chains of which two meet at every crossing."""
    loops = [chain.points for chain in chains if chain.first < 0]
    open_ = [chain for chain in chains if chain.first >= 0]
    at: list[list[tuple[int, int]]] = [[] for _ in range(crossings)]
    for k, chain in enumerate(open_):
        at[chain.first].append((k, 0))
        at[chain.last].append((k, 1))
    if any(len(ends) not in (0, 2) for ends in at):
        raise InvalidInput(_ON_BORDER)
    free = dict.fromkeys(range(len(open_)))
    while free:
        k, end, parts = next(iter(free)), 0, []
        while k in free:
            del free[k]
            points = open_[k].points
            parts.append((points if end == 0 else points[::-1])[:-1])
            away = open_[k].last if end == 0 else open_[k].first
            k, end = at[away][1] if at[away][0] == (k, 1 - end) else at[away][0]
        loops.append(_without_repeats(np.concatenate(parts)))
    return tuple(loop for loop in loops if len(loop) > 2)


def _without_repeats(loop: Array) -> Array:
    return np.asarray(loop[(loop != np.roll(loop, 1, axis=0)).any(axis=1)])


def without(loops: Loops, zone: Loops) -> Loops:
    """A polygon less a piece of it that has been cut out of it: edges that both have cancel out.

    Parameters
    ----------
    loops, zone : tuple of (m, 2) arrays
        Closed loops; corners and edges of the piece that lie on the border are the border's own, as `divide_polygon`
        and `toolaxis.numeric.clipping.clip_half_plane` leave them.
    """
    return _not_in_both(loops, zone)


def unite_polygons(loops: Loops, beside: Loops) -> Loops:
    """A polygon and another one beside it as one: edges that both have cancel out.

    Parameters
    ----------
    loops, beside : tuple of (m, 2) arrays
        Closed loops; the polygons share stretches of their borders at most, and corners there agree exactly.

    **Properties**: 1. areas add up.
    """
    return _not_in_both(loops, beside)


def join_touching(loops: Loops) -> Loops:
    """The same polygon without edges that two of its loops have, or that one loop runs along twice: they cancel out.

    Parameters
    ----------
    loops : tuple of (m, 2) arrays
        Closed loops, of several polygons side by side too; corners along shared borders agree exactly.

    **Properties**: 1. the same points lie inside an odd number of loops.
    """
    return _single_edges(_with_corners(loops, loops)) if loops else ()


def _not_in_both(loops: Loops, others: Loops) -> Loops:
    """Closed loops of the edges that only one of two polygons has."""
    if not loops or not others:
        return (*loops, *others)
    return _single_edges([*_with_corners(loops, others), *_with_corners(others, loops)])


def _single_edges(loops: Sequence[Array]) -> Loops:
    """Closed loops of the edges that an odd number of loops has."""
    edges: dict[Edge, None] = {}
    for loop in loops:
        rows = [(float(x), float(y)) for x, y in loop]
        for a, b in zip(rows, [*rows[1:], rows[0]], strict=True):
            if (a, b) in edges:
                del edges[a, b]
            elif (b, a) in edges:
                del edges[b, a]
            else:
                edges[a, b] = None
    return _chain_edges(list(edges))


def _with_corners(loops: Loops, others: Loops) -> list[Array]:
    """Loops with those corners of others put in that lie on their edges."""
    every = np.concatenate(others)
    every = every[np.argsort(every[:, 0], kind="stable")]
    made = []
    for loop in loops:
        ends = np.roll(loop, -1, axis=0)
        off = 1e-12 * float(np.abs(loop).max())
        first = np.searchsorted(every[:, 0], np.minimum(loop[:, 0], ends[:, 0]) - off, side="left")
        last = np.searchsorted(every[:, 0], np.maximum(loop[:, 0], ends[:, 0]) + off, side="right")
        rows = []
        for a, b, near in zip(loop, ends, map(slice, first, last), strict=True):
            rows += [a[None], _corners_between(a, b, every[near], off)]
        made.append(np.concatenate(rows))
    return made


def _corners_between(a: Array, b: Array, points: Array, off: float) -> Array:
    """Of some points those between the ends of an edge, no farther from it than allowed, in their order along it."""
    way = b - a
    share = (points - a) @ way / max(float(way @ way), np.finfo(float).tiny)
    away = np.abs((points - a)[:, 0] * way[1] - (points - a)[:, 1] * way[0])
    on = (share > 0) & (share < 1) & (away <= off * float(way @ way) ** 0.5)
    on &= (points != a).any(axis=1) & (points != b).any(axis=1)
    return np.asarray(points[on][np.argsort(share[on], kind="stable")])


def _chain_edges(edges: list[Edge]) -> Loops:
    """Closed loops from edges in any order."""
    beside: dict[Corner, list[int]] = {}
    for k, pair in enumerate(edges):
        for end in pair:
            beside.setdefault(end, []).append(k)
    free, loops = dict.fromkeys(range(len(edges))), []
    while free:
        k = next(iter(free))
        start, here = edges[k]
        line = [start]
        del free[k]
        while here != start:
            line.append(here)
            step = next((m for m in beside[here] if m in free), None)
            if step is None:
                break
            del free[step]
            here = edges[step][1] if edges[step][0] == here else edges[step][0]
        if len(line) > 2:
            loops.append(np.array(line))
    return tuple(loops)
