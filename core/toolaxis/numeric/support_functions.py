"""Convex bodies by what is farthest along a direction, and lower bounds of the distance between two of them.

A direction n separates two bodies by the gap between the first one's least and the other's greatest coordinate along n.
Every such gap is a lower bound of their signed distance, so that a search for the best n can end anywhere.
"""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import lengths

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Sine of the angle to a disc's axis below which a direction is along it: what is left across is rounding.
_ALONG = 1e-9
_ROUNDS = 40
#: Steps by which the direction of a depth is improved.
_STEPS = (0.3, 0.1, 0.03)
#: Corners of simplices of up to four points, the smaller ones first, and which of the four these are.
_SUBSETS = tuple(some for size in range(1, 5) for some in combinations(range(4), size))
_MASKS = tuple(np.isin(np.arange(4), some) for some in _SUBSETS)


class ConvexBodies(NamedTuple):
    """k convex bodies: each the hull of j discs with rounded rims, moved along all sums of three vectors.

    centre (k, j, 3), mm;  axis (k, j, 3): unit normals of the discs;  radius (k, j): of the discs, mm;  ball (k, j):
    radius of a ball that is carried around them, mm;  spread (k, 3, 3): rows g, each moves the body from -g to +g, mm.
    """

    centre: Array
    axis: Array
    radius: Array
    ball: Array
    spread: Array

    def rows(self, chosen: NDArray[np.int64] | Bools) -> "ConvexBodies":
        """Some of the bodies; a single one stands for all."""
        return self if len(self.centre) == 1 else ConvexBodies(*(each[chosen] for each in self))

    def moved(self, matrix: Array) -> "ConvexBodies":
        """The bodies after a rigid motion (4, 4), or a single one after each of some (n, 4, 4)."""
        turn = np.swapaxes(matrix[..., :3, :3], -1, -2)
        centre = self.centre @ turn + matrix[..., None, :3, 3]
        size = (len(centre), self.radius.shape[1])
        return ConvexBodies(centre, self.axis @ turn, np.broadcast_to(self.radius, size),
                            np.broadcast_to(self.ball, size), self.spread @ turn)

    def support(self, ways: Array) -> Array:
        """The point of each body that is farthest along a direction, (n, 3).

        Parameters
        ----------
        ways : (n, 3) array
            Unit vectors; n is k, or any where k is 1.
        """
        count = len(ways)
        every = np.arange(count)
        along = _project(self.axis, ways)
        height = _project(self.centre, ways)
        across = np.sqrt(np.maximum(1.0 - along**2, 0.0))
        best = np.argmax(height + self.radius * across + self.ball, axis=1)
        row = np.zeros(count, dtype=int) if len(self.centre) == 1 else every
        slant = along[every, best][:, None]
        rim = ways - slant * self.axis[row, best]
        size = lengths(rim)[:, None]
        leans = size > _ALONG
        rim = np.where(leans, rim / np.where(leans, size, 1.0), 0.0)
        spread = np.broadcast_to(self.spread, (count, 3, 3))
        sides = np.where(np.einsum("nic,nc->ni", spread, ways) >= 0, 1.0, -1.0)
        moved = np.einsum("ni,nic->nc", sides, spread)
        radius = self.radius[row, best][:, None]
        ball = self.ball[row, best][:, None]
        return np.asarray(self.centre[row, best] + radius * rim + ball * ways + moved)

    @property
    def reach(self) -> Array:
        """Radius about the origin that holds each body, (k,) mm."""
        far = np.linalg.norm(self.centre, axis=2) + self.radius + self.ball
        return np.asarray(far.max(axis=1) + np.linalg.norm(self.spread, axis=2).sum(axis=1))


def _project(vectors: Array, ways: Array) -> Array:
    """Coordinates along directions (n, 3) of the vectors of each body (k, j, 3), (n, j); a single body has all."""
    if len(vectors) == 1:
        return np.asarray(np.einsum("kjc,nc->nj", vectors, ways))
    return np.asarray((vectors * ways[:, None]).sum(-1))


def boxes(low: ArrayLike, high: ArrayLike) -> ConvexBodies:
    """Boxes along the coordinate axes.

    Parameters
    ----------
    low, high : (k, 3) or (3,) array_like
        mm
    """
    one, other = np.atleast_2d(np.asarray(low, dtype=float)), np.atleast_2d(np.asarray(high, dtype=float))
    half = (other - one) / 2
    return _discs(((one + other) / 2)[:, None], spread=half[:, :, None] * np.eye(3))


def hull(points: ArrayLike, ball: float = 0.0) -> ConvexBodies:
    """The hull of points, with a ball carried around it.

    Parameters
    ----------
    points : (j, 3) array_like
        mm
    ball : float
        mm
    """
    rows = np.asarray(points, dtype=float)[None]
    return _discs(rows)._replace(ball=np.full(rows.shape[:2], float(ball)))


def places(points: ArrayLike) -> ConvexBodies:
    """Points as bodies of no size: what is carried along them is moved there.

    Parameters
    ----------
    points : (k, 3) array_like
        mm
    """
    return _discs(np.asarray(points, dtype=float)[:, None])


def segments(points: ArrayLike) -> ConvexBodies:
    """The straight ways from each point to the next one.

    Parameters
    ----------
    points : (n, 3) array_like
        mm; a single one stands still.
    """
    rows = np.asarray(points, dtype=float)
    if len(rows) == 1:
        return _discs(rows[:, None])
    spread = np.zeros((len(rows) - 1, 3, 3))
    spread[:, 0] = np.diff(rows, axis=0) / 2
    return _discs(((rows[1:] + rows[:-1]) / 2)[:, None], spread=spread)


def revolve_body(ends: ArrayLike, radius: ArrayLike, ball: ArrayLike = 0.0) -> ConvexBodies:
    """One body of revolution: the hull of discs along a line.

    Parameters
    ----------
    ends : (j, 3) array_like
        Middles of the discs, mm; the first and the last one apart.
    radius, ball : float or (j,) array_like
        Of the discs, and of the ball carried around each, mm.
    """
    rows = np.asarray(ends, dtype=float)
    way = rows[-1] - rows[0]
    count = (1, len(rows))
    return ConvexBodies(rows[None], np.broadcast_to(way / np.linalg.norm(way), (*count, 3)),
                        np.broadcast_to(np.asarray(radius, dtype=float), count),
                        np.broadcast_to(np.asarray(ball, dtype=float), count), np.zeros((1, 3, 3)))


def _discs(centre: Array, spread: Array | None = None) -> ConvexBodies:
    """Points (k, j, 3) as discs of no size."""
    count = centre.shape[:2]
    return ConvexBodies(centre, np.tile([0.0, 0.0, 1.0], (*count, 1)), np.zeros(count), np.zeros(count),
                        np.zeros((len(centre), 3, 3)) if spread is None else spread)


def separation(one: Sequence[ConvexBodies], other: Sequence[ConvexBodies], enough: float = np.inf,
               tolerance: float = 1e-3, inner: Bools | None = None) -> Array:
    """Lower bounds of the signed distance between pairs of bodies, (n,) mm; negative where they may meet.

    Parameters
    ----------
    one, other : sequences of Convex
        What is carried along what: the bodies of a pair are the sums of those in each.  Each holds n of them, or one
        for all pairs.
    enough : float
        Pairs that are proven to be this far apart are not looked at any closer, mm.
    tolerance : float
        How far below the distance a bound may be where they are apart, mm.
    inner : (n,) array of bool, optional
        Pairs of which nobody asks how deep they meet.

    Notes
    -----
    The nearest point of the difference of both to the origin, by simplices of its points: the algorithm of Gilbert,
    Johnson and Keerthi (1988).  Where they meet, the directions of edges and axes and those across two of them are
    tried, and then those beside the best: exact for boxes, and for a face of one body against the other.
    """
    count = max(len(each.centre) for each in (*one, *other))
    pair = (tuple(one), tuple(other))
    start = (sum((each.centre.mean(axis=1) for each in one), np.zeros(3))
             - sum((each.centre.mean(axis=1) for each in other), np.zeros(3)))
    towards = np.broadcast_to(start, (count, 3)).copy()
    towards[lengths(towards) < 1e-9] = [0.0, 0.0, 1.0]
    best, meets = _search_separation(pair, towards, (enough, tolerance))
    rows = np.flatnonzero(meets if inner is None else meets & ~inner)
    if len(rows):
        best[rows] = np.maximum(best[rows], _depths(_choose_rows(pair, rows), len(rows)))
    return best


_Pair = tuple[tuple[ConvexBodies, ...], tuple[ConvexBodies, ...]]


def _choose_rows(pair: _Pair, rows: NDArray[np.int64] | Bools) -> _Pair:
    return tuple(each.rows(rows) for each in pair[0]), tuple(each.rows(rows) for each in pair[1])


def _nearest_along(pair: _Pair, ways: Array) -> Array:
    """The point of the difference of each pair that is least along a direction, (n, 3)."""
    zero = np.zeros_like(ways)
    return np.asarray(sum((each.support(-ways) for each in pair[0]), zero)
                      - sum((each.support(ways) for each in pair[1]), zero))


def _search_separation(pair: _Pair, towards: Array, limits: tuple[float, float]) -> tuple[Array, Bools]:
    """The best gap of each pair, and whether the pair seems to meet."""
    enough, tolerance = limits
    count = len(towards)
    best, meets = np.full(count, -np.inf), np.zeros(count, dtype=bool)
    simplex, held = np.zeros((count, 4, 3)), np.zeros((count, 4), dtype=bool)
    near, rows = towards.copy(), np.arange(count)
    for _ in range(_ROUNDS):
        size = lengths(near[rows])
        inside = size <= 1e-7
        meets[rows[inside]] = True
        rows, size = rows[~inside], size[~inside]
        ways = near[rows] / size[:, None]
        found = _nearest_along(_choose_rows(pair, rows), ways)
        gap = (found * ways).sum(axis=1)
        best[rows] = np.maximum(best[rows], gap)
        going = (best[rows] < enough) & (~held[rows].any(axis=1) | (size - gap > tolerance))
        full = held[rows].all(axis=1)
        meets[rows[full & going]] = True
        rows, found = rows[going & ~full], found[going & ~full]
        if not len(rows):
            break
        slot = np.argmin(held[rows], axis=1)
        simplex[rows, slot], held[rows, slot] = found, True
        near[rows], held[rows] = _nearest(simplex[rows], held[rows])
    return best, meets | (best < 0)


def _nearest(simplex: Array, held: Bools) -> tuple[Array, Bools]:
    """The point of each simplex that is nearest to the origin, (n, 3), and which of its corners it lies between."""
    count = len(simplex)
    best, near = np.full(count, np.inf), np.zeros((count, 3))
    kept = np.zeros((count, 4), dtype=bool)
    for some, mask in zip(_SUBSETS, _MASKS, strict=True):
        there = held[:, some].all(axis=1)
        if not there.any():
            continue
        corners = simplex[there][:, some]
        place, within = corners[:, 0], np.ones(len(corners), dtype=bool)
        if len(some) > 1:
            base, edges = place, corners[:, 1:] - corners[:, :1]
            gram = edges @ edges.transpose(0, 2, 1)
            size = np.trace(gram, axis1=1, axis2=2)
            gram = gram + (1e-13 * size + 1e-30)[:, None, None] * np.eye(len(some) - 1)
            shares = np.linalg.solve(gram, -(edges @ base[:, :, None]))[:, :, 0]
            place = base + (shares[:, :, None] * edges).sum(axis=1)
            within = (shares >= 0).all(axis=1) & (shares.sum(axis=1) <= 1)
        length = lengths(place)
        good = within & (length < best[there] * (1 - 1e-12))
        rows = np.flatnonzero(there)[good]
        best[rows], near[rows] = length[good], place[good]
        kept[rows] = mask
    return near, kept


def _depths(pair: _Pair, count: int) -> Array:
    """The best gap along directions of edges, axes and those across two of them, (n,) mm."""
    lines = [np.broadcast_to(line, (count, 3)) for each in (*pair[0], *pair[1])
             for line in (*each.spread.transpose(1, 0, 2), each.axis[:, 0])]
    ways = [*lines, *(np.cross(a, b) for a, b in combinations(lines, 2))]
    best, along = np.full(count, -np.inf), np.tile([0.0, 0.0, 1.0], (count, 1))

    def _tried(ways: Array) -> None:
        size = lengths(ways)
        good = np.flatnonzero(size > 1e-9)
        if len(good):
            unit = ways[good] / size[good, None]
            gap = (_nearest_along(_choose_rows(pair, good), unit) * unit).sum(axis=1)
            better = gap > best[good]
            best[good[better]], along[good[better]] = gap[better], unit[better]

    for way in ways:
        _tried(way)
        _tried(-way)
    for step in _STEPS:
        for turn in (*np.eye(3), *-np.eye(3)):
            _tried(along + step * turn)
    return best
