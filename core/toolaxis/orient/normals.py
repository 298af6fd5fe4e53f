"""All normals of a face at once: the cap that holds them, and the range of their angles to an axis, proven."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import combinations
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.numeric.vectors import angle_between
from toolaxis.progress import breathe
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

_CELLS = 24
_ROUNDS = 13
#: Cells that are looked at between two moments to stop.
_AT_ONCE = 4096
#: Cells are not divided further once their normals are known to this angle, rad.
_FINE = 1e-4
#: More cells than this are not divided further: at a pole, where the normal has no bound, they would only multiply.
_MOST = 100_000
#: Size, mm, of a cell at a pole, where normals have no bound, below which it counts with the normal in its middle.
_SPECK = 0.01


class Cap(NamedTuple):
    """The smallest cap of the unit sphere around unit vectors: centre (3,), radius in rad, and the vectors on its rim.

    A radius of pi / 2 with a centre of zeros means that no open hemisphere holds them.
    """

    centre: Array
    radius: float
    rim: NDArray[np.intp]


def smallest_cap(vectors: Array) -> Cap:
    """The smallest cap around unit vectors.

    Parameters
    ----------
    vectors : (n, 3) array

    Notes
    -----
    It is where their smallest enclosing ball meets the sphere; the ball's centre is 0 when no hemisphere holds them.

    **Properties**: 1. every vector is inside, to 1e-9; 2. at least two are on the rim unless all are equal.
    """
    support = np.array([0], dtype=np.intp)
    centre, square = vectors[0], 0.0
    for _ in range(200):
        away = np.sum((vectors - centre) ** 2, axis=1)
        far = int(np.argmax(away))
        if away[far] <= square * (1 + 1e-12) + 1e-18:
            break
        support, centre, square = _ball(vectors, np.append(support, far))
    size = float(np.linalg.norm(centre))
    if size <= 1e-7:
        return Cap(np.zeros(3), pi / 2, support)
    middle = centre / size
    return Cap(middle, float(angle_between(vectors[support], middle).max()), support)


def _ball(vectors: Array, rows: NDArray[np.intp]) -> tuple[NDArray[np.intp], Array, float]:
    """Smallest ball around at most five points: the smallest circumscribed ball of a subset that holds them all."""
    best: tuple[NDArray[np.intp], Array, float] = (rows, np.zeros(3), np.inf)
    for count in range(1, min(len(rows), 4) + 1):
        for chosen in combinations(range(len(rows)), count):
            some = vectors[rows[list(chosen)]]
            edges = some[1:] - some[0]
            offset = np.linalg.lstsq(2 * edges, np.sum(edges**2, axis=1), rcond=None)[0] if count > 1 else np.zeros(3)
            square = float(offset @ offset)
            inside = np.sum((vectors[rows] - some[0] - offset) ** 2, axis=1) <= square * (1 + 1e-10) + 1e-18
            if square < best[2] and inside.all():
                best = rows[list(chosen)], some[0] + offset, square
    return best


class Range(NamedTuple):
    """Proven range of a quantity over a face: it lies within low to high, and where its extremes were met.

    low, high : float;  least, greatest : (2,) array, parameters (u, v).
    """

    low: float
    high: float
    least: Array
    greatest: Array


@dataclass(frozen=True, eq=False)
class NormalField:
    """The normals of a face.

    Attributes
    ----------
    face : Face
    """

    face: Face

    @cached_property
    def uv(self) -> Array:
        """Parameters of the samples: an even grid inside, and points along every loop, (n, 2)."""
        loops = [_along(loop, 96) for loop in self.face.outline]
        return np.concatenate([self.face.grid(24, 24), *loops])

    @cached_property
    def kept(self) -> Array:
        """Those of `uv` at which there is a normal, (n, 2); InvalidInput where there is none."""
        found = np.asarray(self.uv[np.linalg.norm(self.face.normal(self.uv), axis=1) > 0.5])
        if len(found) == 0:
            raise InvalidInput(f"face {self.face.label} has no area: its normal is defined nowhere; leave it out")
        return found

    @cached_property
    def samples(self) -> Array:
        """Unit normals at `kept`, (n, 3)."""
        return self.face.normal(self.kept)

    @cached_property
    def cap(self) -> Cap:
        """The smallest cap around the samples."""
        return smallest_cap(self.samples)

    @cached_property
    def mean(self) -> Array:
        """Unit mean normal over the area, (3,); the cap's centre where the mean vanishes."""
        d = self.face.evaluate(self.face.grid(48, 48))
        total = (-1.0 if self.face.flip else 1.0) * np.cross(d.su, d.sv).sum(axis=0)
        size = float(np.linalg.norm(total))
        return total / size if size > 0 else self.cap.centre

    def angles(self, axes: ArrayLike) -> tuple[Array, Array]:
        """Least and greatest angle of each axis to the sampled normals, (n,) rad each: no bound.

        Parameters
        ----------
        axes : (n, 3) array_like
            Unit vectors.
        """
        cosine = np.clip(np.asarray(axes, dtype=float) @ self.samples.T, -1.0, 1.0)
        return np.arccos(cosine.max(axis=1)), np.arccos(cosine.min(axis=1))

    @cached_property
    def _cells(self) -> tuple[Array, Array]:
        """Rectangles u0, u1, v0, v1 over the face, (m, 4), and bounds of |Suu|, |Suv|, |Svv| on them, (m, 3)."""
        u0, u1, v0, v1 = self.face.bounds
        data = self.face.surface.data
        lines = [_grid_lines(data[0], u0, u1), _grid_lines(data[1], v0, v1)]
        bounds = derivative_bounds(bezier_nets(data, *lines), np.diff(lines[0]), np.diff(lines[1]), 2)
        u, v = np.meshgrid(*(np.arange(len(line) - 1) for line in lines), indexing="ij")
        u, v = u.ravel(), v.ravel()
        rectangles = np.stack([lines[0][u], lines[0][u + 1], lines[1][v], lines[1][v + 1]], axis=1)
        met = _touching(self.face, rectangles)
        return rectangles[met], bounds.reshape(-1, 3)[met]

    def range_of_angles(self, axis: ArrayLike, least: float, greatest: float) -> Range:
        """Range of the angle between an axis and all normals of the face, proven between the samples too.

        Cells are halved until both limits are decided, or the normals in the cells in question are known to 1e-4 rad,
        or (around a pole) too many cells are in question; the range is wider then.

        Parameters
        ----------
        axis : (3,) array_like
            Unit vector.
        least, greatest : float
            Limits that the caller wants decided, rad.

        Returns
        -------
        Range
            All angles lie within low to high; rad.

        Notes
        -----
        **Properties**: 1. no normal of the face has an angle outside, but within 0.01 mm of a pole, where the normals
        in the middles of cells stand for all; 2. low and high are met to 1e-4 rad by a normal of the face where they
        decide against the limits.
        """
        t = np.asarray(axis, dtype=float)
        rectangles, bounds = self._cells
        low, high = np.inf, -np.inf
        seen = [np.inf, -np.inf]
        where = [rectangles[0, :2], rectangles[0, :2]]
        for rounds in range(_ROUNDS + 1):
            middle, inside, angle, spread = _in_pieces(partial(self._looked, t), rectangles, bounds)
            for k, best in enumerate((np.argmin, np.argmax)):
                if inside.any():
                    i = np.flatnonzero(inside)[best(angle[inside])]
                    if (angle[i] - seen[k]) * (1 if k else -1) > 0:
                        seen[k], where[k] = float(angle[i]), middle[i]
            doubtful = ((angle - spread < min(least, seen[0])) & (seen[0] >= least)) | (
                (angle + spread > max(greatest, seen[1])) & (seen[1] <= greatest))
            doubtful &= (spread > _FINE) & (rounds < _ROUNDS)
            doubtful &= np.count_nonzero(doubtful) <= _MOST
            low = min(low, float((angle - spread)[~doubtful].min(initial=np.inf)))
            high = max(high, float((angle + spread)[~doubtful].max(initial=-np.inf)))
            if not doubtful.any():
                break
            rectangles, bounds = _in_pieces(partial(_divided, self.face), rectangles[doubtful], bounds[doubtful])
            if not len(rectangles):
                break
        return Range(max(low, 0.0), min(high, pi), where[0], where[1])

    def _looked(self, t: Array, rectangles: Array, bounds: Array) -> tuple[Array, Bools, Array, Array]:
        """Middles of cells, which of them lie on the face, the angle of t to the normal in each, and how far normals
        of the cell are from it at most."""
        middle = _middles(rectangles)
        d, n = self.face.evaluate(middle), self.face.normal(middle)
        hu, hv = np.diff(rectangles[:, :2])[:, 0] / 2, np.diff(rectangles[:, 2:])[:, 0] / 2
        off_u, off_v = bounds[:, 0] * hu + bounds[:, 1] * hv, bounds[:, 1] * hu + bounds[:, 2] * hv
        su, sv = np.linalg.norm(d.su, axis=1), np.linalg.norm(d.sv, axis=1)
        size = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
        share = (off_u * sv + su * off_v + off_u * off_v) / np.where(size > 0, size, np.finfo(float).tiny)
        spread = np.where(share < 1, np.arcsin(np.minimum(share, 1.0)), pi)
        across = 2 * (su * hu + sv * hv) + off_u * hu + off_v * hv
        spread[(share >= 1) & (across < _SPECK) & (np.linalg.norm(n, axis=1) > 0.5)] = 0.0
        return middle, self.face.contains(middle), angle_between(np.broadcast_to(t, n.shape), n), spread


def _in_pieces(work: Callable[[Array, Array], tuple[Any, ...]], rectangles: Array, bounds: Array) -> tuple[Any, ...]:
    """What work makes of cells, a few thousand at once, with a moment to stop between."""
    found = []
    for first in range(0, len(rectangles), _AT_ONCE):
        breathe()
        some = slice(first, first + _AT_ONCE)
        found.append(work(rectangles[some], bounds[some]))
    return found[0] if len(found) == 1 else tuple(np.concatenate(parts) for parts in zip(*found, strict=True))


def _middles(rectangles: Array) -> Array:
    u0, u1, v0, v1 = rectangles.T
    return np.stack([(u0 + u1) / 2, (v0 + v1) / 2], axis=1)


def _divided(face: Face, rectangles: Array, bounds: Array) -> tuple[Array, Array]:
    """The quarters of cells that may hold a point of the face, with the bounds of what they are quarters of."""
    quarters = _quartered(rectangles)
    met = _touching(face, quarters)
    return quarters[met], np.repeat(bounds, 4, axis=0)[met]


def _along(loop: Array, count: int) -> Array:
    """Points along a closed loop: its corners, and between them as many as its share of the outline asks for."""
    ends = np.roll(loop, -1, axis=0)
    size = np.ptp(loop, axis=0)
    length = np.linalg.norm((ends - loop) / np.where(size > 0, size, 1.0), axis=1)
    parts = np.maximum(np.ceil(count * length / max(length.sum(), 1e-300)).astype(int), 1)
    edge = np.repeat(np.arange(len(loop)), parts)
    share = np.concatenate([np.arange(k) / k for k in parts])
    return np.asarray(loop[edge] + share[:, None] * (ends[edge] - loop[edge]))


def _grid_lines(knots: Array, low: float, high: float) -> Array:
    """Even lines from low to high, with the knots between them."""
    inner = np.unique(knots)
    inner = inner[(inner > low) & (inner < high)]
    even = np.linspace(low, high, max(2, _CELLS // (len(inner) + 1)) * (len(inner) + 1) + 1)
    apart = np.abs(even[:, None] - inner).min(axis=1, initial=np.inf) > 1e-9 * (high - low)
    return np.sort(np.concatenate([even[apart], inner]))


def _quartered(rectangles: Array) -> Array:
    u0, u1, v0, v1 = rectangles.T
    u, v = (u0 + u1) / 2, (v0 + v1) / 2
    return np.stack([np.stack([a, b, c, d], axis=1) for a, b in ((u0, u), (u, u1)) for c, d in ((v0, v), (v, v1))],
                    axis=1).reshape(-1, 4)


def _touching(face: Face, rectangles: Array) -> Bools:
    """Whether rectangles may hold a point of the face: their middle lies on it, or an edge of a loop comes near."""
    middle = _middles(rectangles)
    if not face.trims:
        return np.ones(len(rectangles), dtype=bool)
    half = np.stack([np.diff(rectangles[:, :2])[:, 0], np.diff(rectangles[:, 2:])[:, 0]], axis=1) / 2
    met = face.contains(middle)
    for loop in face.trims:
        ends = np.roll(loop, -1, axis=0)
        for k in np.flatnonzero(~met):
            breathe()
            met[k] = _edge_meets(loop - middle[k], ends - middle[k], half[k])
    return met


def _edge_meets(start: Array, end: Array, half: Array) -> bool:
    """Whether any segment meets the box of half sizes around the origin (separating axes)."""
    middle, reach = (start + end) / 2, np.abs(end - start) / 2
    apart = (np.abs(middle) > reach + half).any(axis=1)
    way = end - start
    cross = np.abs(middle[:, 0] * way[:, 1] - middle[:, 1] * way[:, 0])
    apart |= cross > half[0] * np.abs(way[:, 1]) + half[1] * np.abs(way[:, 0])
    return bool((~apart).any())
