"""Faces and skins of a part that are alike: a motion or a mirror brings one onto the other, and what is around it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import signed_area
from toolaxis.shape.counterparts import (
    SAME,
    Counterpart,
    ParameterRule,
    apply_motion,
    eight_rules,
    fit_motion,
    places_of,
    refine_loop,
    turn_piece,
)
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part
from toolaxis.skin.view_surface import ViewSurface

Array = NDArray[np.float64]

#: Greatest distance of a moved face from one that it is alike, mm, and as a share of the smaller one's diagonal: blends
#: of one radius differ by more than rounding where a CAD program made each of them by itself.
_ALIKE, _OF_SIZE = 0.05, 2e-3
#: By how much areas and lengths of borders of alike faces may differ, as a share: less than may stay high of a face.
_SIZE = 3e-4
#: How far a neighbour may lie beside the moved border, besides twice as far as its like does there, mm.
_BESIDE = 1e-3
#: Places of a face, about, from which what else lies around is looked for.
_FEET = 40
#: How far what else lies around may be beside its like, besides four times as far as the faces are apart, mm.
_AROUND = 0.05
#: Room around boxes for rounding, as a share of their diagonals.
_BOX_ROUNDING = 1e-5
#: The cosine of the angle by which normals of alike faces, and of their neighbours at the border, may differ.
_ONE_WAY = float(np.cos(np.radians(2.0)))
#: Places of a face each way, besides those on its border, of which there are about four times as many.
_GRID = 5
#: Members of a skin from which a motion is told, the largest first.
_TOLD_FROM = 3
#: Places along an edge at which the neighbour's normal is looked at, as shares of its points.
_ALONG_EDGE = (0.25, 0.5, 0.75)
#: Share of the area in u and v that loops enclose together at or below which one encloses nothing.
_NOTHING = 1e-9


@dataclass(frozen=True, eq=False)
class AlikeFace:
    """A face onto which a motion or a mirror brings another one.

    Attributes
    ----------
    original, face : Face
        The other one, and this one.
    matrix : (4, 4) array
        From the original to this one: its first three rows and columns are a rotation, or a rotation and a mirror.
    apart : float
        How far samples of the original are from this face when they are moved, mm.
    rule : ParameterRule or None
        Parameters here from those of the original; None where they do not follow by a straight rule.
    everywhere : bool
        Whether the whole part is brought onto itself.
    """

    original: Face
    face: Face
    matrix: Array
    apart: float
    rule: ParameterRule | None
    everywhere: bool

    @property
    def same(self) -> bool:
        """Whether the two differ by no more than rounding: passes on one serve the other as they are."""
        return self.apart <= SAME

    def carry_loops(self, loops: Sequence[Array]) -> tuple[Array, ...]:
        """Loops of the original in the parameters of this face, those aside that enclose nothing here.

        Parameters
        ----------
        loops : sequence of (m, 2) arrays
        """
        if self.rule is not None:
            return tuple(self.rule(loop) for loop in loops)
        carried = [_places_on(self.face, apply_motion(self.matrix, self.original.evaluate(refine_loop(loop)).point))
                   for loop in loops]
        # A sliver along the border becomes a line where the border here lies a little farther in.
        least = _NOTHING * sum(abs(signed_area(loop)) for loop in carried)
        return tuple(loop for loop in carried if abs(signed_area(loop)) > least)

    def carry_piece(self, piece: Face) -> Face | None:
        """The piece of this face that is like a piece of the original, with the letters of its label; None where its
        loops enclose nothing here.

        Parameters
        ----------
        piece : Face
        """
        label = self.face.label + piece.label.removeprefix(self.original.label)
        if piece.label == self.original.label:
            return self.face
        if self.rule is not None:
            other = Counterpart(self.face, self.rule, 0.0)
            return turn_piece(piece, self.original, other, self.matrix, label)[0]
        loops = self.carry_loops(piece.outline)
        return self.face.trimmed(loops, label) if loops else None


def find_alike_faces(part: Part, faces: Sequence[Face], reach: float, mirrored: bool = True) -> dict[int, AlikeFace]:
    """Those of some faces that are alike others before them, by their places among these.

    Parameters
    ----------
    part : Part
        To which skins were joined already.
    faces : sequence of Face
        Of the part; skins as one face each, and pieces of faces.
    reach : float
        How far around a face other faces have to be alike too, mm; no farther than it is long itself.
    mirrored : bool
        Whether images in a mirror count.

    Notes
    -----
    Two faces are alike where a rigid motion, or one with a mirror, brings samples of one, border included, within 0.05
    mm of the other, their areas and borders are of one size, normals point to the same side, each neighbour at the
    border has the normal there that its like has, and what else lies within reach does so around both.

    **Properties**: 1. every original is a face that is alike none before it; 2. the motion does not depend on how the
    surfaces of the two are parametrised, but for whether it is found.
    """
    search = _MotionSearch(part.original or part, reach, mirrored)
    originals: list[tuple[int, _Size]] = []
    found: dict[int, AlikeFace] = {}
    for k, face in enumerate(faces):
        size = _size_of(face)
        same = (search.find(faces[j], face) for j, other in originals if size.is_near(other))
        alike = next((one for one in same if one is not None), None)
        if alike is None:
            originals.append((k, size))
        else:
            found[k] = alike
    return found


class _Size(NamedTuple):
    """What is the same of alike faces: area, mm^2, length of the border, mm, and the numbers of members and loops."""

    area: float
    border: float
    members: int
    loops: int

    def is_near(self, other: "_Size") -> bool:
        """Whether another face may be alike."""
        of_one_size = [abs(one - two) <= _SIZE * one for one, two in zip(self[:2], other[:2], strict=True)]
        return all(of_one_size) and self[2:] == other[2:]


def _size_of(face: Face) -> _Size:
    around = [face.evaluate(refine_loop(loop)).point for loop in face.outline]
    border = sum(float(np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1).sum()) for line in around)
    return _Size(face.area, border, len(face.members), len(face.outline))


class _SampledFace(NamedTuple):
    """Places of a face, (n, 2), their points and unit normals, (n, 3)."""

    uv: Array
    point: Array
    normal: Array

    @classmethod
    def of(cls, face: Face) -> "_SampledFace":
        """Places inside of a face and on its border."""
        uv = places_of(face, _GRID)
        return cls(uv, face.evaluate(uv).point, face.normal(uv))


@dataclass(eq=False)
class _MotionSearch:
    """Looks for motions between faces of a part, and remembers those that it found.

    part : Part
        Without skins.
    reach : float
    mirrored : bool
    """

    part: Part
    reach: float
    mirrored: bool
    _motions: list[Array] = field(default_factory=list)
    _everywhere: dict[int, bool] = field(default_factory=dict)
    _samples: dict[Face, _SampledFace] = field(default_factory=dict)
    _feet: dict[Face, Array] = field(default_factory=dict)

    def find(self, face: Face, other: Face) -> AlikeFace | None:
        """How another face is alike, by a motion that is known already where there is one; None where it is not."""
        for number, matrix in enumerate(self._motions):
            found = self._alike(face, other, matrix, number)
            if found is not None:
                return found
        for matrix in self._motions_between(face, other):
            found = self._alike(face, other, matrix, len(self._motions))
            if found is not None:
                self._motions.append(matrix)
                return found
        return None

    def _alike(self, face: Face, other: Face, matrix: Array, number: int) -> AlikeFace | None:
        """How another face is alike by a motion, which has or gets a number; None where it is not."""
        back = np.asarray(np.linalg.inv(matrix), dtype=float)
        apart = max(self._distance(face, other, matrix), self._distance(other, face, back))
        if not np.isfinite(apart):
            return None
        if not self._everywhere.get(number, False) and not (
                self._neighbours_fit(face, other, matrix, apart) and self._others_fit(face, other, matrix, apart)
                and self._others_fit(other, face, back, apart)):
            return None
        if number not in self._everywhere:
            self._everywhere[number] = self._keeps_part(matrix)
        rule = self._rule(face, other, matrix, 2 * apart + SAME)
        return AlikeFace(face, other, matrix, apart, rule, self._everywhere[number])

    def _samples_of(self, face: Face) -> _SampledFace:
        if face not in self._samples:
            self._samples[face] = _SampledFace.of(face)
        return self._samples[face]

    def _distance(self, face: Face, other: Face, matrix: Array) -> float:
        """How far a moved face is from another one, mm, a skin member by member; infinite where they are not alike."""
        if face.members or other.members:
            return self._distance_of_skins(face, other, matrix)
        samples = self._samples_of(face)
        points = apply_motion(matrix, samples.point)
        low, high = _roomy_box(other, _most_apart(face))
        if (points < low).any() or (points > high).any():
            return np.inf
        found = nearest(other, points, 24)
        apart = float(found.distance.max())
        turned = samples.normal @ matrix[:3, :3].T
        one_way = (turned * other.normal(found.uv)).sum(axis=1).min() >= _ONE_WAY
        return apart if apart <= _most_apart(face) and one_way else np.inf

    def _distance_of_skins(self, face: Face, other: Face, matrix: Array) -> float:
        """The same of two skins: that of the members that are farthest apart."""
        left, greatest = list(_members_of(other)), 0.0
        for member in _members_of(face):
            apart = [self._distance(member, one, matrix) for one in left]
            least = int(np.argmin(apart)) if apart else -1
            if least < 0 or not np.isfinite(apart[least]):
                return np.inf
            greatest = max(greatest, apart[least])
            left.pop(least)
        return greatest if not left else np.inf

    def _rule(self, face: Face, other: Face, matrix: Array, most: float) -> ParameterRule | None:
        """The straight rule by which parameters follow to so many mm; None where there is none."""
        if isinstance(face.surface, ViewSurface) or isinstance(other.surface, ViewSurface):
            return None
        samples = self._samples_of(face)
        points = apply_motion(matrix, samples.point)
        for rule in eight_rules(face.surface.domain, other.surface.domain):
            if np.linalg.norm(other.evaluate(rule(samples.uv)).point - points, axis=1).max() <= most:
                return rule
        return None

    def _motions_between(self, face: Face, other: Face) -> Iterator[Array]:
        """Motions that bring a face, or large members of a skin, onto another one, mirrors last."""
        mine, others = _members_of(face), _members_of(other)
        told = sorted(mine, key=lambda one: -one.area)[:_TOLD_FROM]
        made = [matrix for one in told for there in others if _size_of(one).is_near(_size_of(there))
                for matrix in self._motions_by_rules(one, there)]
        yield from sorted(made, key=lambda matrix: -np.linalg.det(matrix[:3, :3]).round())

    def _motions_by_rules(self, face: Face, other: Face) -> Iterator[Array]:
        """Motions for each of the eight ways to lay the parameters of one face onto those of another one."""
        samples = self._samples_of(face)
        for rule in eight_rules(face.surface.domain, other.surface.domain):
            points = other.evaluate(rule(samples.uv)).point
            for mirrored in (False, True) if self.mirrored else (False,):
                matrix = fit_motion(samples.point, points, mirrored)
                if np.linalg.norm(apply_motion(matrix, samples.point) - points, axis=1).max() <= _most_apart(face):
                    yield matrix

    def _neighbours_fit(self, face: Face, other: Face, matrix: Array, apart: float) -> bool:
        """Whether neighbours have, at the border, the normals that those of the other face have there."""
        mine, others = set(face.numbers), set(other.numbers)
        around = {n for edge in self.part.edges for n in edge.faces if set(edge.faces) & others} - others
        there = [self.part.face(n) for n in around]
        for edge in self.part.edges:
            beyond = [n for n in edge.faces if n not in mine]
            if len(beyond) != 1:
                continue
            points = _along(edge.polyline)
            neighbour = self.part.face(beyond[0])
            here = nearest(neighbour, points, 24)
            normals = neighbour.normal(here.uv) @ matrix[:3, :3].T
            room = 2 * (here.distance + apart) + _BESIDE
            moved = apply_motion(matrix, points)
            if not any(_has_normals(one, moved, normals, room) for one in there):
                return False
        return True

    def _others_fit(self, face: Face, other: Face, matrix: Array, apart: float) -> bool:
        """Whether what lies within reach around a face lies so around another one."""
        feet = self._feet_around(face)
        if not len(feet):
            return True
        moved, room = apply_motion(matrix, feet), _AROUND + 4 * apart
        left = np.ones(len(moved), dtype=bool)
        for one in self._faces_near(moved, room):
            if one.number in other.numbers or not left.any():
                continue
            low, high = _roomy_box(one, room)
            near = left & ((moved >= low) & (moved <= high)).all(axis=1)
            if near.any():
                left[np.flatnonzero(near)[nearest(one, moved[near], 24).distance <= room]] = False
        return not left.any()

    def _feet_around(self, face: Face) -> Array:
        """The points of other faces that are nearest to samples of a face, as far as these are within reach, (n, 3)."""
        if face not in self._feet:
            reach = min(self.reach, face.diagonal)
            points = np.concatenate([self._samples_of(one).point for one in _members_of(face)])
            points = points[::max(1, len(points) // _FEET)]
            found = [np.empty((0, 3))]
            for one in self._faces_near(points, reach):
                low, high = _roomy_box(one, reach)
                near = ((points >= low) & (points <= high)).all(axis=1)
                if one.number not in face.numbers and near.any():
                    feet = nearest(one, points[near], 24)
                    found.append(feet.point[feet.distance <= reach])
            self._feet[face] = np.concatenate(found)
        return self._feet[face]

    def _faces_near(self, points: Array, room: float) -> list[Face]:
        """The faces of the part whose boxes, with some room around them, meet the box around points."""
        low, high = self._boxes[:, 0], self._boxes[:, 1]
        more = (room + _BOX_ROUNDING * np.linalg.norm(high - low, axis=1))[:, None]
        near = ((points.max(axis=0) >= low - more) & (points.min(axis=0) <= high + more)).all(axis=1)
        return [self.part.faces[k] for k in np.flatnonzero(near)]

    @cached_property
    def _boxes(self) -> Array:
        """The boxes of all faces of the part, (faces, 2, 3) mm."""
        return np.array([face.box for face in self.part.faces])

    def _keeps_part(self, matrix: Array) -> bool:
        """Whether a motion brings every face of the part onto another one, or itself."""
        sizes = self._sizes
        return all(any(sizes[face.number].is_near(sizes[other.number])
                       and np.isfinite(self._distance(face, other, matrix))
                       for other in self.part.faces) for face in self.part.faces)

    @cached_property
    def _sizes(self) -> dict[int, _Size]:
        return {face.number: _size_of(face) for face in self.part.faces}


def _most_apart(face: Face) -> float:
    """How far a face may be from another one that it is alike, mm."""
    return min(_ALIKE, _OF_SIZE * face.diagonal)


def _roomy_box(face: Face, room: float) -> Array:
    """The box around a face with some room around it, (2, 3) mm."""
    low, high = face.box
    more = room + _BOX_ROUNDING * float(np.linalg.norm(high - low))
    return np.stack([low - more, high + more])


def _members_of(face: Face) -> tuple[Face, ...]:
    """The faces of which a skin consists; the face itself where it is none."""
    return tuple(member.face for member in face.members) or (face,)


def _along(polyline: Array) -> Array:
    """Places along an edge, no ends of it, (n, 3)."""
    if len(polyline) < 3:
        return np.asarray(polyline.mean(axis=0)[None])
    return np.asarray(polyline[[int(share * (len(polyline) - 1)) or 1 for share in _ALONG_EDGE]])


def _has_normals(face: Face, points: Array, normals: Array, room: Array) -> bool:
    """Whether a face lies at points, (n, 3), each within its room, mm, with normals (n, 3) there."""
    low, high = _roomy_box(face, float(room.max()))
    if (points < low).any() or (points > high).any():
        return False
    found = nearest(face, points, 24)
    if (found.distance > room).any():
        return False
    return bool((face.normal(found.uv) * normals).sum(axis=1).min() >= _ONE_WAY)


def _places_on(face: Face, points: Array) -> Array:
    """Parameters (n, 2) of points (n, 3) that lie on a face, or on a skin as far as it is seen."""
    surface = face.surface
    if isinstance(surface, ViewSurface):
        return np.asarray(((points - surface.origin) @ surface.frame.T)[:, :2])
    return nearest(face, points).uv
