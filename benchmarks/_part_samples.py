"""Points on all faces of a part, the denser the nearer they are to a place: what brute force holds tools against.

Each face is cut into patches of its parameters, which are quartered until they are small.  The middle of a patch stands
for it where it is small beside its distance from the place; near to the place patches are quartered on.  Between points
a cutter may be deeper than at them, never less deep: what is too near to a point is too near to the part.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Patches of a face each way at first, and how many of a part there may be in all, about, that are kept.
_ROOTS, _MOST = 6, 300_000
#: Least radius of the patches that are kept, and greatest distance of the places along borders, mm.
_FINE, _ALONG = 0.2, 0.1
#: Steps between faces in the file that count as none, mm, and how far from the edge on, mm: as the manual says.
_STEPS, _REACH = (0.0005, 0.02), 0.5


class Density(NamedTuple):
    """How dense points are.

    share : float, radius of a patch over its distance from the place;  least : float, mm, radius that is small enough.
    """

    share: float = 0.03
    least: float = 0.02

    def radius(self, distance: Array) -> Array:
        """Greatest radius of patches at distances, mm."""
        return np.maximum(self.share * distance, self.least)


DENSE, DENSER = Density(), Density(0.008, 0.004)


class Samples(NamedTuple):
    """Points around a place.

    point : (n, 3) array, mm;  face : (n,) array of int, places of their faces in the part;  step : (n,) array, mm, by
    how much the face stands out there over the one beside it in the file.
    """

    point: Array
    face: Indices
    step: Array


@dataclass(frozen=True, eq=False)
class _Patches:
    """Rectangles of the parameters of one face: middle, half (n, 2); point (n, 3) and radius (n,), mm."""

    middle: Array
    half: Array
    point: Array
    radius: Array

    @staticmethod
    def of(face: Face, middle: Array, half: Array) -> "_Patches":
        """Measure rectangles."""
        ways = np.array([[0, 0], [-1, -1], [-1, 1], [1, -1], [1, 1]])
        places = face.evaluate((middle[:, None] + ways * half[:, None]).reshape(-1, 2)).point.reshape(-1, 5, 3)
        radius = np.linalg.norm(places[:, 1:] - places[:, :1], axis=2).max(axis=1, initial=0.0)
        return _Patches(middle, half, places[:, 0], radius)

    def quarter(self, face: Face, rows: NDArray[np.bool_]) -> "_Patches":
        """Four in place of each of some."""
        ways = np.array([[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]])
        middle = (self.middle[rows, None] + ways * self.half[rows, None]).reshape(-1, 2)
        return _Patches.of(face, middle, np.repeat(self.half[rows] / 2, 4, axis=0))


@dataclass(frozen=True, eq=False)
class PartSamples:
    """The patches of a part; make them with `PartSamples.of`.

    Attributes
    ----------
    faces : tuple of Face
    fine : float
        Radius of the smallest patches that are kept, mm.
    face, middle, half, point, radius, above : arrays over all patches
        Place of the face, rectangle, middle (mm), radius and that of the patch around it (mm; infinite without one).
    last : (n,) array of bool
        Whether the patch is not quartered.
    border : (m, 6) array
        Face, u, v of places along the borders, and the point, mm.
    seams : (k, 4) array
        Points of edges at which faces stand out over others, mm, and by how much, by face.
    """

    faces: tuple[Face, ...]
    fine: float
    face: Indices
    middle: Array
    half: Array
    point: Array
    radius: Array
    above: Array
    last: NDArray[np.bool_]
    border: Array
    seams: dict[int, Array]

    @staticmethod
    def of(part: Part) -> "PartSamples":
        """Cut the faces of a part, as it was read from its file.

        Parameters
        ----------
        part : Part
        """
        fine = max(_FINE, float(np.sqrt(sum(face.area for face in part.faces) / _MOST)))
        rows = [_cut_face(k, face, fine) for k, face in enumerate(part.faces)]
        columns = [np.concatenate(column) for column in zip(*rows, strict=True)]
        border = np.concatenate([_walk_border(k, face) for k, face in enumerate(part.faces)])
        return PartSamples(part.faces, fine, *columns, border, _find_steps(part))

    def around(self, place: Array, density: Density = DENSE) -> Samples:
        """Points around a place.

        Parameters
        ----------
        place : (3,) array
            mm
        density : Density
        """
        distance = np.linalg.norm(self.point - place, axis=1)
        small = self.radius <= density.radius(distance - self.radius)
        coarse = self.above <= density.radius(distance - 2 * self.above)
        far = np.flatnonzero(small & ~coarse)
        far = far[self._on_face(self.face[far], self.middle[far])]
        found, numbers = [self.point[far]], [self.face[far]]
        near = np.flatnonzero(self.last & ~small)
        for k in np.unique(self.face[near]):
            own = near[self.face[near] == k]
            points = _quarter_on(self.faces[k], _Patches(self.middle[own], self.half[own], self.point[own],
                                                         self.radius[own]), place, density)
            found.append(points)
            numbers.append(np.full(len(points), k))
        for k, points in self._along_borders(place, density):
            found.append(points)
            numbers.append(np.full(len(points), k))
        point, face = np.concatenate(found), np.concatenate(numbers)
        return Samples(point, face, self._steps(point, face))

    def _on_face(self, face: Indices, uv: Array) -> NDArray[np.bool_]:
        found = np.zeros(len(face), dtype=bool)
        for k in np.unique(face):
            own = np.flatnonzero(face == k)
            found[own] = self.faces[k].contains(uv[own])
        return found

    def _along_borders(self, place: Array, density: Density) -> list[tuple[int, Array]]:
        """Places along the borders of faces: few of those far away, more between those that are near."""
        distance = np.linalg.norm(self.border[:, 3:] - place, axis=1)
        wanted = density.radius(np.maximum(distance - _ALONG, 0.0))
        number = np.arange(len(distance))
        every = 2.0 ** np.floor(np.log2(np.maximum(wanted / _ALONG, 1.0)))
        far = np.flatnonzero((number % every == 0) & (wanted >= _ALONG))
        near = np.flatnonzero(wanted[:-1] < _ALONG)
        near = near[self.border[near, 0] == self.border[near + 1, 0]]
        found = [(int(k), self.border[far[self.border[far, 0] == k], 3:]) for k in np.unique(self.border[far, 0])]
        for k in np.unique(self.border[near, 0]):
            own = near[self.border[near, 0] == k]
            start, end = self.border[own, 1:3], self.border[own + 1, 1:3]
            count = np.ceil(_ALONG / wanted[own]).astype(int) + 1
            row = np.repeat(np.arange(len(own)), count)
            part = (np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)) / count[row]
            uv = start[row] + part[:, None] * (end - start)[row]
            face = self.faces[int(k)]
            found.append((int(k), face.evaluate(uv[face.contains(uv)]).point))
        return found

    def _steps(self, point: Array, face: Indices) -> Array:
        """By how much faces stand out at points: in full near to the edge, less and less on."""
        found = np.zeros(len(point))
        for k in np.intersect1d(list(self.seams), face):
            own, seam = np.flatnonzero(face == k), self.seams[int(k)]
            distance, row = cKDTree(seam[:, :3]).query(point[own], distance_upper_bound=2 * _REACH)
            near = np.isfinite(distance)
            share = np.clip(2 - distance[near] / _REACH, 0.0, 1.0)
            found[own[near]] = share * seam[row[near], 3]
        return found


def _cut_face(number: int, face: Face, fine: float) -> tuple[Array, ...]:
    """All patches of a face, the large ones that are quartered among them."""
    u0, u1, v0, v1 = face.bounds
    line = (2 * np.arange(_ROOTS) + 1) / (2 * _ROOTS)
    middle = np.stack(np.meshgrid(u0 + (u1 - u0) * line, v0 + (v1 - v0) * line, indexing="ij"), axis=-1).reshape(-1, 2)
    now = _Patches.of(face, middle, np.tile([(u1 - u0) / (2 * _ROOTS), (v1 - v0) / (2 * _ROOTS)], (len(middle), 1)))
    above, rows = np.full(len(middle), np.inf), []
    while len(now.radius):
        large = now.radius > fine
        rows.append((np.full(len(above), number), now.middle, now.half, now.point, now.radius, above, ~large))
        above, now = np.repeat(now.radius[large], 4), now.quarter(face, large)
    return tuple(np.concatenate(column) for column in zip(*rows, strict=True))


def _quarter_on(face: Face, patches: _Patches, place: Array, density: Density) -> Array:
    """Points of patches of a face that are quartered until they are small beside their distance, (n, 3)."""
    found = []
    while len(patches.radius):
        distance = np.linalg.norm(patches.point - place, axis=1)
        large = patches.radius > density.radius(distance - patches.radius)
        on = ~large
        on[on] = face.contains(patches.middle[on])
        found.append(patches.point[on])
        patches = patches.quarter(face, large)
    return np.concatenate(found)


def _walk_border(number: int, face: Face) -> Array:
    """Places along the loops of a face, (m, 6): number, u, v and the point."""
    rows = []
    for loop in face.outline:
        closed = np.concatenate([loop, loop[:1]])
        while True:
            points = face.evaluate(closed).point
            long = np.flatnonzero(np.linalg.norm(np.diff(points, axis=0), axis=1) > _ALONG)
            if not len(long) or len(closed) > 200_000:
                break
            closed = np.insert(closed, long + 1, (closed[long] + closed[long + 1]) / 2, axis=0)
        rows.append(np.column_stack([np.full(len(closed), number), closed, points]))
    return np.concatenate(rows)


def _find_steps(part: Part) -> dict[int, Array]:
    """Points of edges at which faces stand out so little that it counts as none, by place of the face."""
    place = {face.number: k for k, face in enumerate(part.faces)}
    rows: dict[int, list[Array]] = {}
    for edge in part.edges:
        if edge.kind == "concave" or not len(edge.step):
            continue
        for side, number in enumerate(edge.faces):
            step = edge.step[:, side]
            some = (step > _STEPS[0]) & (step <= _STEPS[1])
            if some.any():
                rows.setdefault(place[number], []).append(np.column_stack([edge.polyline[some], step[some]]))
    return {k: np.concatenate(found) for k, found in rows.items()}


def numbers_around(part: Part, numbers: Sequence[int]) -> tuple[set[int], set[int]]:
    """Numbers of the faces that go on smoothly from some, themselves among them, and of those behind a convex edge.

    The cutter may touch the former and the latter; it keeps its clearance from all others.

    Parameters
    ----------
    part : Part
    numbers : sequence of int
    """
    own = set(numbers)
    while True:
        more = {number for edge in part.edges if edge.kind == "tangent" and own & set(edge.faces)
                for number in edge.faces} - own
        if not more:
            break
        own |= more
    beside = [edge for edge in part.edges if own & set(edge.faces)]
    convex = {number for edge in beside if edge.kind == "convex" for number in edge.faces}
    concave = {number for edge in beside if edge.kind == "concave" for number in edge.faces}
    ends = [edge.polyline[[0, -1]] for edge in beside]
    if ends:
        corners = cKDTree(np.concatenate(ends))
        for edge in part.edges:
            if corners.query(edge.polyline[[0, -1]])[0].min() <= 1e-6 * part.diagonal:
                convex |= set(edge.faces)
    return own, convex - concave - own
