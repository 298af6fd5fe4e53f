"""A face as it is seen along a direction: which of its places lies at a point of the plane across that."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import EdgeIndex, inside, slabs, stations, walk
from toolaxis.progress import breathe
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.surface import Derivatives
from toolaxis.skin.place_kernel import (
    BESIDE,
    FAR,
    ITERATIONS,
    LAST,
    PARALLEL,
    PlaceFrame,
    find_places,
    turn_into_plane,
)

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Places along each parameter, and pieces of the longest loop, from which a point is looked for.
_GRID, _PIECES = 24, 192
#: How near to the middle of a cell the point must lie that is found there, as a share of the cell, and how far rates
#: may lead within the cell, as a share of the range: beyond that they tell nothing.
_FOUND, _LED = 1e-6, 0.1
#: Ends of a parameter range that lie nearer to each other than this share of the face's diagonal are the same.
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class SeenFace:
    """A face in a plane.

    Attributes
    ----------
    face : Face
    rows : (2, 3) array
        Coordinates in the plane are rows @ (p - origin).
    origin : (3,) array
        mm
    """

    face: Face
    rows: Array
    origin: Array

    def project(self, points: Array) -> Array:
        """Places of points in the plane, (n, 2).

        Parameters
        ----------
        points : (n, 3) array
            mm
        """
        return np.asarray((points - self.origin) @ self.rows.T)

    def heights_of(self, points: Array) -> Array:
        """Heights of points along the direction from which the face is seen, (n,) mm.

        Parameters
        ----------
        points : (n, 3) array
            mm
        """
        return np.asarray((points - self.origin) @ np.cross(self.rows[0], self.rows[1]))

    def heights_at(self, places: Array) -> Array:
        """Heights of the face at places of the plane, (n,) mm.

        Parameters
        ----------
        places : (n, 2) array
        """
        return self.heights_of(self.evaluate(places).point)

    @cached_property
    def outline_uv(self) -> tuple[Array, ...]:
        """The face's loops with further points on them, in its own parameters."""
        u0, u1, v0, v1 = self.face.bounds
        step = ((u1 - u0) / _PIECES, (v1 - v0) / _PIECES)
        return tuple(walk(loop, stations(loop, step)) for loop in self.face.outline)

    @cached_property
    def outline(self) -> tuple[Array, ...]:
        """The same loops in the plane."""
        return tuple(self.project(self.face.evaluate(loop).point) for loop in self.outline_uv)

    @cached_property
    def box(self) -> Array:
        """Lower and upper corner of the outline, (2, 2)."""
        points = np.concatenate(self.outline)
        return np.stack([points.min(axis=0), points.max(axis=0)])

    @cached_property
    def _index(self) -> EdgeIndex:
        return slabs(self.outline)

    def contains(self, places: Array) -> Bools:
        """Whether places of the plane lie within the outline, (n,).

        Parameters
        ----------
        places : (n, 2) array
        """
        near = ((places >= self.box[0]) & (places <= self.box[1])).all(axis=1)
        if near.any():
            near[near] = inside(self._index, places[near])
        return np.asarray(near)

    @cached_property
    def samples(self) -> Array:
        """Parameters of places inside and along the border, (n, 2)."""
        return np.concatenate([self.face.grid(_GRID, _GRID), *self.outline_uv])

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.project(self.face.evaluate(self.samples).point))

    @cached_property
    def periods(self) -> Array:
        """Range of each parameter in which the face is closed, (2,); infinite where it is open."""
        (u0, u1), (v0, v1) = self.face.surface.domain
        share = np.linspace(0.0, 1.0, 5)
        u = u0 + (u1 - u0) * share
        v = v0 + (v1 - v0) * share
        closed_along_u = self._is_closed(_line_at(0, u0, v), _line_at(0, u1, v))
        closed_along_v = self._is_closed(_line_at(1, v0, u), _line_at(1, v1, u))
        period_u = u1 - u0 if closed_along_u else np.inf
        period_v = v1 - v0 if closed_along_v else np.inf
        return np.array([period_u, period_v])

    def _is_closed(self, low: Array, high: Array) -> bool:
        """Whether the face comes together at these parameters, (n, 2) each, of two opposite borders."""
        gap = self.face.evaluate(low).point - self.face.evaluate(high).point
        apart = np.linalg.norm(gap, axis=1)
        return bool((apart <= _SAME * self.face.diagonal).all())

    def find(self, places: Array) -> Array:
        """Parameters (n, 2) of the face at places of the plane, by Newton's method; beyond its border too.

        Parameters
        ----------
        places : (n, 2) array
        """
        return self._find_by_kernel(places)[0] if self.has_kernel else self._find_plainly(places, self._begin(places))

    def _find_by_kernel(self, places: Array) -> tuple[Array, Array]:
        """The parameters, and the six vectors S, Su, Sv, Suu, Suv, Svv there, (n, 6, 3)."""
        uv = self._begin(places)
        table = np.empty((len(uv), 6, 3))
        find_places(self.face.surface.data, self.frame, np.ascontiguousarray(places, dtype=float), uv, table)
        return uv, table

    def _begin(self, places: Array) -> Array:
        """The parameters of the nearest sample to each place, (n, 2)."""
        breathe()
        return self.samples[self._tree.query(places)[1]].copy()

    def begin_in_cells(self, count: int) -> Array:
        """From which parameters places are looked for, by the cell of the box in which they lie, (count, count, 6).

        The parameters u, v of the middle of the cell, and the rates of u with x, u with y, v with x and v with y. Where
        they would lead far within the cell, or the middle is not found, the rates are zero.

        Parameters
        ----------
        count : int
            Cells each way.
        """
        low, high = self.box
        size = (high - low) / count
        share = np.arange(count) + 0.5
        middles = grid_rows(*(low + share[:, None] * size).T)
        near = self._begin(middles)
        uv, table = self._find_by_kernel(middles)
        rates = _rates_with_place(table[:, 1] @ self.rows.T, table[:, 2] @ self.rows.T)
        missed = np.linalg.norm(self.project(table[:, 0]) - middles, axis=1) > _FOUND * size.max()
        far = (np.abs(rates) @ size > _LED * self.frame.ends[:, 1]).any(axis=1)
        uv[missed], rates[missed | far] = near[missed], 0.0
        return np.column_stack([uv, rates.reshape(-1, 4)]).reshape(count, count, 6)

    @cached_property
    def has_kernel(self) -> bool:
        """Whether there is a kernel for the face's surface."""
        return _compiled.available and type(self.face.surface) is NurbsSurface

    @cached_property
    def frame(self) -> PlaceFrame:
        """The plane and the face's range for kernels."""
        (u0, u1), (v0, v1) = self.face.surface.domain
        ends = np.array([[u0, u1 - u0, self.periods[0]], [v0, v1 - v0, self.periods[1]]])
        return PlaceFrame(np.ascontiguousarray(self.rows, dtype=float), np.asarray(self.origin, dtype=float), ends)

    def _find_plainly(self, places: Array, uv: Array) -> Array:
        """The plain twin of `toolaxis.skin.place_kernel.find_places`."""
        span = self.frame.ends[:, 1]
        found, away = self._search_plainly(places, uv)
        for share in BESIDE:
            for beside in ((-share, 0.0), (share, 0.0), (0.0, -share), (0.0, share)):
                rows = np.flatnonzero(away > 0)
                other, left = self._search_plainly(places[rows], uv[rows] + beside * span)
                better = left < away[rows]
                found[rows[better]], away[rows[better]] = other[better], left[better]
        return found

    def _search_plainly(self, places: Array, begin: Array) -> tuple[Array, Array]:
        """The plain twin of the search from one place: parameters (n, 2), and the squares of how far from the places it
        gave up, mm^2, 0 where it ended, (n,)."""
        low, span = self.frame.ends[:, 0], self.frame.ends[:, 1]
        uv, away, todo = begin.copy(), np.zeros(len(begin)), np.arange(len(begin))
        for _ in range(ITERATIONS):
            if not len(todo):
                break
            d = self.face.evaluate(uv[todo])
            miss = places[todo] - self.project(d.point)
            move = _solve(d.su @ self.rows.T, d.sv @ self.rows.T, miss)
            size = (np.abs(move) / span).max(axis=1)
            move *= np.minimum(1.0, FAR / np.maximum(size, np.finfo(float).tiny))[:, None]
            uv[todo] = self._wrap(uv[todo] + move, low)
            away[todo] = np.where(size > LAST, (miss**2).sum(axis=1), 0.0)
            todo = todo[size > LAST]
        return uv, away

    def evaluate(self, places: Array) -> Derivatives:
        """The face's points at places of the plane, and their derivatives with these.

        Parameters
        ----------
        places : (n, 2) array
        """
        if not self.has_kernel:
            return self._evaluate_plainly(self.find(places))
        table = self._find_by_kernel(places)[1]
        turn_into_plane(self.frame.rows, table)
        return Derivatives(*(table[:, k] for k in range(6)))

    def _evaluate_plainly(self, uv: Array) -> Derivatives:
        """The plain twin of `toolaxis.skin.place_kernel.turn_into_plane`, at parameters (n, 2)."""
        d = self.face.evaluate(uv)
        a, b = d.su @ self.rows.T, d.sv @ self.rows.T
        (ux, uy), (vx, vy) = np.moveaxis(_rates_with_place(a, b), 0, -1)
        sx = d.su * ux[:, None] + d.sv * vx[:, None]
        sy = d.su * uy[:, None] + d.sv * vy[:, None]
        with_x, with_y = (ux, vx), (uy, vy)
        second = []
        for (u1, v1), (u2, v2) in ((with_x, with_x), (with_x, with_y), (with_y, with_y)):
            twice_u = (u1 * u2)[:, None]
            mixed = (u1 * v2 + v1 * u2)[:, None]
            twice_v = (v1 * v2)[:, None]
            bend = d.suu * twice_u + d.suv * mixed + d.svv * twice_v
            aside = bend @ self.rows.T  # places in the plane move evenly: what the bend moves aside, u and v take back
            second.append(bend - sx * aside[:, :1] - sy * aside[:, 1:])
        return Derivatives(d.point, sx, sy, *second)

    def _wrap(self, uv: Array, low: Array) -> Array:
        """Parameters taken once round where the face is closed."""
        for k in (0, 1):
            if np.isfinite(self.periods[k]):
                uv[:, k] = low[k] + np.mod(uv[:, k] - low[k], self.periods[k])
        return uv


def _line_at(fixed: int, value: float, other: Array) -> Array:
    """Parameters, (n, 2), of which one has a fixed value."""
    uv = np.empty((len(other), 2))
    uv[:, fixed] = value
    uv[:, 1 - fixed] = other
    return uv


def _rates_with_place(a: Array, b: Array) -> Array:
    """Rates of u with x and y, and of v with x and y, (n, 2, 2), from Su and Sv in the plane, (n, 2) each."""
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    det = np.where(np.abs(det) > 0, det, np.finfo(float).tiny)
    turned = np.stack([b[:, 1], -b[:, 0], -a[:, 1], a[:, 0]], axis=1)
    return np.asarray(turned / det[:, None]).reshape(-1, 2, 2)


def _solve(a: Array, b: Array, right: Array) -> Array:
    """Solutions (n, 2) of a x + b y = right, all (n, 2); none moves where a and b have one direction."""
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    size = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    good = np.abs(det) > PARALLEL * size
    # Cramer's rule.
    over_x = right[:, 0] * b[:, 1] - right[:, 1] * b[:, 0]
    over_y = a[:, 0] * right[:, 1] - a[:, 1] * right[:, 0]
    divisor = np.where(good, det, 1.0)
    found = np.column_stack([over_x, over_y]) / divisor[:, None]
    return np.asarray(np.where(good[:, None], found, 0.0))
