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
        shift = matrix[..., None, :3, 3]
        centre = self.centre @ turn + shift
        size = (len(centre), self.radius.shape[1])
        radius = np.broadcast_to(self.radius, size)
        ball = np.broadcast_to(self.ball, size)
        return ConvexBodies(centre, self.axis @ turn, radius, ball, self.spread @ turn)

    def support(self, ways: Array) -> Array:
        """The point of each body that is farthest along a direction, (n, 3).

        Parameters
        ----------
        ways : (n, 3) array
            Unit vectors; n is k, or any where k is 1.
        """
        number = len(ways)
        every = np.arange(number)
        along = _project(self.axis, ways)
        height = _project(self.centre, ways)
        across = np.sqrt(np.maximum(1.0 - along**2, 0.0))
        farthest = height + self.radius * across + self.ball
        best = np.argmax(farthest, axis=1)
        row = np.zeros(number, dtype=int) if len(self.centre) == 1 else every
        slant = along[every, best][:, None]
        rim = ways - slant * self.axis[row, best]
        size = lengths(rim)[:, None]
        leans = size > _ALONG
        rim = np.where(leans, rim / np.where(leans, size, 1.0), 0.0)
        spread = np.broadcast_to(self.spread, (number, 3, 3))
        rises = np.einsum("nic,nc->ni", spread, ways)
        sides = np.where(rises >= 0, 1.0, -1.0)
        moved = np.einsum("ni,nic->nc", sides, spread)
        radius = self.radius[row, best][:, None]
        ball = self.ball[row, best][:, None]
        centre = self.centre[row, best]
        return np.asarray(centre + radius * rim + ball * ways + moved)

    @property
    def reach(self) -> Array:
        """Radius about the origin that holds each body, (k,) mm."""
        far = np.linalg.norm(self.centre, axis=2) + self.radius + self.ball
        spread = np.linalg.norm(self.spread, axis=2)
        return np.asarray(far.max(axis=1) + spread.sum(axis=1))


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
    one = np.atleast_2d(np.asarray(low, dtype=float))
    other = np.atleast_2d(np.asarray(high, dtype=float))
    half = (other - one) / 2
    middle = (one + other) / 2
    spread = half[:, :, None] * np.eye(3)
    return _discs(middle[:, None], spread)


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
    balls = np.full(rows.shape[:2], float(ball))
    return _discs(rows)._replace(ball=balls)


def places(points: ArrayLike) -> ConvexBodies:
    """Points as bodies of no size: what is carried along them is moved there.

    Parameters
    ----------
    points : (k, 3) array_like
        mm
    """
    rows = np.asarray(points, dtype=float)
    return _discs(rows[:, None])


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
    middle = (rows[1:] + rows[:-1]) / 2
    spread = np.zeros((len(middle), 3, 3))
    spread[:, 0] = np.diff(rows, axis=0) / 2
    return _discs(middle[:, None], spread)


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
    size = (1, len(rows))
    axis = np.broadcast_to(way / np.linalg.norm(way), (*size, 3))
    radii = np.broadcast_to(np.asarray(radius, dtype=float), size)
    balls = np.broadcast_to(np.asarray(ball, dtype=float), size)
    return ConvexBodies(rows[None], axis, radii, balls, np.zeros((1, 3, 3)))


def _discs(centre: Array, spread: Array | None = None) -> ConvexBodies:
    """Points (k, j, 3) as discs of no size."""
    size = centre.shape[:2]
    axis = np.tile([0.0, 0.0, 1.0], (*size, 1))
    if spread is None:
        spread = np.zeros((len(centre), 3, 3))
    return ConvexBodies(centre, axis, np.zeros(size), np.zeros(size), spread)


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
    number = max(len(each.centre) for each in (*one, *other))
    pair = (tuple(one), tuple(other))
    start = _sum_of_middles(one) - _sum_of_middles(other)
    towards = np.broadcast_to(start, (number, 3)).copy()
    towards[lengths(towards) < 1e-9] = [0.0, 0.0, 1.0]
    best, meets = _search_separation(pair, towards, enough, tolerance)
    if inner is not None:
        meets = meets & ~inner
    rows = np.flatnonzero(meets)
    if len(rows):
        depths = _depths(_choose_rows(pair, rows), len(rows))
        best[rows] = np.maximum(best[rows], depths)
    return best


def _sum_of_middles(bodies: Sequence[ConvexBodies]) -> Array:
    """The middle of bodies that are carried along each other, (n, 3) or (3,)."""
    return np.asarray(sum((each.centre.mean(axis=1) for each in bodies), np.zeros(3)))


_Pair = tuple[tuple[ConvexBodies, ...], tuple[ConvexBodies, ...]]


def _choose_rows(pair: _Pair, rows: NDArray[np.int64] | Bools) -> _Pair:
    one, other = pair
    chosen_one = tuple(each.rows(rows) for each in one)
    chosen_other = tuple(each.rows(rows) for each in other)
    return chosen_one, chosen_other


def _nearest_along(pair: _Pair, ways: Array) -> Array:
    """The point of the difference of each pair that is least along a direction, (n, 3)."""
    one, other = pair
    zero = np.zeros_like(ways)
    least_of_one = sum((each.support(-ways) for each in one), zero)
    greatest_of_other = sum((each.support(ways) for each in other), zero)
    return np.asarray(least_of_one - greatest_of_other)


def _search_separation(pair: _Pair, towards: Array, enough: float, tolerance: float) -> tuple[Array, Bools]:
    """The best gap of each pair, and whether the pair seems to meet."""
    number = len(towards)
    best = np.full(number, -np.inf)
    meets = np.zeros(number, dtype=bool)
    simplex = np.zeros((number, 4, 3))
    held = np.zeros((number, 4), dtype=bool)
    near = towards.copy()
    rows = np.arange(number)
    for _ in range(_ROUNDS):
        size = lengths(near[rows])
        inside = size <= 1e-7
        meets[rows[inside]] = True
        rows = rows[~inside]
        size = size[~inside]
        ways = near[rows] / size[:, None]
        found = _nearest_along(_choose_rows(pair, rows), ways)
        gap = (found * ways).sum(axis=1)
        best[rows] = np.maximum(best[rows], gap)
        is_first = ~held[rows].any(axis=1)
        is_inexact = size - gap > tolerance
        going = (best[rows] < enough) & (is_first | is_inexact)
        full = held[rows].all(axis=1)
        meets[rows[full & going]] = True
        goes_on = going & ~full
        rows = rows[goes_on]
        if not len(rows):
            break
        slot = np.argmin(held[rows], axis=1)
        simplex[rows, slot] = found[goes_on]
        held[rows, slot] = True
        near[rows], held[rows] = _nearest(simplex[rows], held[rows])
    return best, meets | (best < 0)


def _nearest(simplex: Array, held: Bools) -> tuple[Array, Bools]:
    """The point of each simplex that is nearest to the origin, (n, 3), and which of its corners it lies between."""
    number = len(simplex)
    best = np.full(number, np.inf)
    near = np.zeros((number, 3))
    kept = np.zeros((number, 4), dtype=bool)
    for some, mask in zip(_SUBSETS, _MASKS, strict=True):
        there = held[:, some].all(axis=1)
        if not there.any():
            continue
        place, within = _nearest_to_origin(simplex[there][:, some])
        length = lengths(place)
        good = within & (length < best[there] * (1 - 1e-12))
        rows = np.flatnonzero(there)[good]
        best[rows] = length[good]
        near[rows] = place[good]
        kept[rows] = mask
    return near, kept


def _nearest_to_origin(corners: Array) -> tuple[Array, Bools]:
    """The place nearest to the origin on what n times k corners span, and whether it lies between them."""
    base = corners[:, 0]
    if corners.shape[1] == 1:
        return base, np.ones(len(corners), dtype=bool)
    edges = corners[:, 1:] - corners[:, :1]
    gram = edges @ edges.transpose(0, 2, 1)
    size = np.trace(gram, axis1=1, axis2=2)
    # Corners that lie in a line or plane leave the shares open: the smallest ones will do.
    slight = 1e-13 * size + 1e-30
    gram = gram + slight[:, None, None] * np.eye(edges.shape[1])
    right = -(edges @ base[:, :, None])
    shares = np.linalg.solve(gram, right)[:, :, 0]
    place = base + (shares[:, :, None] * edges).sum(axis=1)
    is_between = (shares >= 0).all(axis=1)
    return place, is_between & (shares.sum(axis=1) <= 1)


def _depths(pair: _Pair, number: int) -> Array:
    """The best gap along directions of edges, axes and those across two of them, (n,) mm."""
    lines = []
    for each in (*pair[0], *pair[1]):
        directions = (*each.spread.transpose(1, 0, 2), each.axis[:, 0])
        lines += [np.broadcast_to(line, (number, 3)) for line in directions]
    across = [np.cross(a, b) for a, b in combinations(lines, 2)]
    best = np.full(number, -np.inf)
    along = np.tile([0.0, 0.0, 1.0], (number, 1))

    def _try_ways(ways: Array) -> None:
        size = lengths(ways)
        good = np.flatnonzero(size > 1e-9)
        if not len(good):
            return
        unit = ways[good] / size[good, None]
        nearest = _nearest_along(_choose_rows(pair, good), unit)
        gap = (nearest * unit).sum(axis=1)
        better = gap > best[good]
        improved = good[better]
        best[improved] = gap[better]
        along[improved] = unit[better]

    for way in (*lines, *across):
        _try_ways(way)
        _try_ways(-way)
    for step in _STEPS:
        for turn in (*np.eye(3), *-np.eye(3)):
            _try_ways(along + step * turn)
    return best
