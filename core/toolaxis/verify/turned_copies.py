"""Operations that are turned copies of one that was measured: only what differs is measured again.

Nothing is taken from the plan but which operation to look at.  The turn is found from the cutter locations of both.
Faces are images of each other where control points, knots and trim loops agree after the turn.  Every face around a
copy must be the image of one with the same role at the source, or its own (a bore, an end face); else all is measured
anew.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.borders import line_of, on_border
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.declared import STRIP, DeclaredZones
from toolaxis.verify.maps import MapPoint, SurfaceMap
from toolaxis.verify.rays import border_points, face_rays
from toolaxis.verify.task import VerificationTask

Array = NDArray[np.float64]

#: By how much cutter locations may miss each other after the turn, mm and as a sine: files have six and nine digits.
_TIPS, _AXES = 5e-6, 1e-8
#: By how much control points may, mm; knots, weights and trim loops, as a share of their range.
_NET, _SHARE = 1e-5, 1e-9
#: By how much a face may miss itself that has no other image, mm: trim loops follow its border up to 0.0002 mm.
_OWN = 5e-4
#: Points across such a face, spacing of points on its border, mm, and the cosine up to which normals are the same.
_ACROSS, _RIM, _SAME_WAY = 25.0, 1.0, 1.0 - 1e-6


class OperationMeasurement(NamedTuple):
    """What was measured of an operation, before it is held against what is allowed.

    targets : maps of what is machined;
    skin : maps of the skin, only the rays that something cut or gouged, each with how many there were;
    rooms : clearance of each component, or that it was not checked;
    edge : how far faces behind convex edges stay out of the cutter;
    link_cut : where a link goes deepest into what the cutting motions leave, or None;
    uncertainty : bound of the error of a height or depth, mm;
    from_stock : distance of shank, holder and of the cutter on links from faces that carry stock.
    """

    targets: tuple[SurfaceMap, ...]
    skin: tuple[tuple[SurfaceMap, int], ...]
    rooms: dict[str, Clearance | str]
    edge: Clearance
    link_cut: MapPoint | None
    uncertainty: float
    from_stock: dict[str, Clearance]


class RigidMotion(NamedTuple):
    """A rotation (3, 3) and a shift (3,), mm, and by how much cutter locations miss each other after it, mm."""

    rotation: Array
    shift: Array
    error: float

    def moved(self, points: Array) -> Array:
        """Points after the turn."""
        return np.asarray(points @ self.rotation.T + self.shift)

    def after(self, first: "RigidMotion") -> "RigidMotion":
        """This turn after another one."""
        return RigidMotion(self.rotation @ first.rotation, self.moved(first.shift), self.error + first.error)

    def is_near(self, other: "RigidMotion") -> bool:
        """Whether it brings points where another one does, up to the digits of cutter locations."""
        apart = np.abs(self.rotation - other.rotation).max(), np.abs(self.shift - other.shift).max()
        return bool(apart[0] <= _AXES and apart[1] <= _TIPS)


class OwnTurn(NamedTuple):
    """A turn that brings a face onto itself but for an error, mm.  Holding the face keeps its identity from others."""

    face: Face
    turn: RigidMotion
    error: float


class TurnedCopy(NamedTuple):
    """A copy of a measured operation.

    turn : from the source to the copy;
    images : by a source face's identity, the copy's face;
    names : by a source face's label, the label of the copy's face;
    error : by how much anything measured there may differ here, mm.
    """

    turn: RigidMotion
    images: dict[int, Face]
    names: dict[str, str]
    error: float


class TurnedCopies:
    """Finds turned copies, and remembers which turns bring a face onto itself."""

    def __init__(self) -> None:
        self._own: dict[tuple[int, bool], list[OwnTurn]] = {}

    def find(self, source: VerificationTask, task: VerificationTask) -> TurnedCopy | None:
        """How an operation is a copy of another one; None where it is not, or not in all that counts.

        Parameters
        ----------
        source, task : VerificationTask
        """
        if not _same_inputs(source, task):
            return None
        turn = _turn_between(source, task)
        if turn is None:
            return None
        images: dict[int, Face] = {}
        error = 0.0
        for role in ("targets", "skin", "touching", "surroundings"):
            faces, others = getattr(source, role), getattr(task, role)
            found = _images(faces, others, turn)
            images |= found
            reached = {id(face) for face in found.values()}
            rest = tuple(face for face in others if id(face) not in reached)
            alone = {id(face) for face in faces if id(face) not in found}
            if len(faces) != len(others) or {id(face) for face in rest} != alone:
                return None
            for face in rest:
                error = max(error, self._own_error(face, role != "surroundings", turn))
                images[id(face)] = face
        if error > _OWN:
            return None
        of_source = (*source.targets, *source.skin, *source.touching, *source.surroundings)
        names = {face.label: images[id(face)].label for face in of_source}
        return TurnedCopy(turn, images, names, turn.error + _NET + error)

    def _own_error(self, face: Face, rim: bool, turn: RigidMotion) -> float:
        """By how much a face after a turn misses itself, mm, as the sum of two turns where their errors are known."""
        known = self._own.setdefault((id(face), rim), [])
        for one in known:
            if one.turn.is_near(turn):
                return one.error
            for two in known:
                if one.turn.after(two.turn).is_near(turn):
                    known.append(OwnTurn(face, turn, one.error + two.error))
                    return one.error + two.error
        known.append(OwnTurn(face, turn, _own_deviation(face, rim, turn)))
        return known[-1].error


def _same_inputs(source: VerificationTask, task: VerificationTask) -> bool:
    """Whether all is the same that does not turn; stock is looked for anew around each copy."""
    if source.stock > 0 or task.stock > 0:
        return False
    same = (source.scallop, source.allowance, source.depth, source.tolerance, source.profile) == \
        (task.scallop, task.allowance, task.depth, task.tolerance, task.profile)
    return same and source.outlines.keys() == task.outlines.keys() and \
        all(np.array_equal(source.outlines[name], task.outlines[name]) for name in task.outlines) and \
        len(source.tips) == len(task.tips) and np.array_equal(source.kind, task.kind)


def _turn_between(source: VerificationTask, task: VerificationTask) -> RigidMotion | None:
    """The rigid motion that brings the cutter locations of one operation onto those of another."""
    arm = 1.0 + float(np.ptp(source.tips, axis=0).max())
    here = np.concatenate([source.tips, source.tips + arm * source.axes])
    there = np.concatenate([task.tips, task.tips + arm * task.axes])
    middle, other = here.mean(axis=0), there.mean(axis=0)
    # The rotation that fits best, by the singular vectors of the covariance; its last sign keeps it from mirroring.
    u, _, v = np.linalg.svd((here - middle).T @ (there - other))
    handedness = np.sign(np.linalg.det(v.T @ u.T))
    rotation = v.T @ np.diag([1.0, 1.0, handedness]) @ u.T
    shift = other - rotation @ middle
    missed = source.tips @ rotation.T + shift - task.tips
    turned_away = source.axes @ rotation.T - task.axes
    error = float(np.linalg.norm(missed, axis=1).max())
    leaning = float(np.linalg.norm(turned_away, axis=1).max())
    same = error <= _TIPS and leaning <= _AXES
    return RigidMotion(rotation, shift, error) if same else None


def _images(faces: Sequence[Face], others: Sequence[Face], turn: RigidMotion) -> dict[int, Face]:
    """By the identity of each face the other one that is its image, where there is one."""
    found: dict[int, Face] = {}
    middles = np.array([turn.moved(_net(face)).mean(axis=0) for face in faces]).reshape(-1, 3)
    for other in others:
        near = np.flatnonzero(np.abs(middles - _net(other).mean(axis=0)).max(axis=1, initial=0.0) <= _NET)
        image = next((faces[int(k)] for k in near if id(faces[int(k)]) not in found
                      and _is_image(faces[int(k)], other, turn)), None)
        if image is not None:
            found[id(image)] = other
    return found


def _net(face: Face) -> Array:
    """Control points of a face's surface, (n, 3) mm."""
    control = face.surface.control
    return np.asarray((control[..., :3] / control[..., 3:]).reshape(-1, 3))


def _is_image(face: Face, other: Face, turn: RigidMotion) -> bool:
    """Whether a face after a turn is another one, with the same parameters."""
    one, two = face.surface, other.surface
    if one.degree != two.degree or one.control.shape != two.control.shape or face.flip != other.flip:
        return False
    if (face.kind, face.tolerance, len(face.outline)) != (other.kind, other.tolerance, len(other.outline)):
        return False
    pairs = [(one.knots_u, two.knots_u), (one.knots_v, two.knots_v), (one.control[..., 3], two.control[..., 3]),
             *zip(face.outline, other.outline, strict=True)]
    if any(a.shape != b.shape or np.abs(a - b).max() > _SHARE * max(float(np.abs(a).max()), 1.0) for a, b in pairs):
        return False
    return bool(np.abs(turn.moved(_net(face)) - _net(other)).max() <= _NET)


def _own_deviation(face: Face, rim: bool, turn: RigidMotion) -> float:
    """By how much a face after a turn misses itself, mm: an end face or a bore does not, whatever its parameters.

    Looked at both ways on points all over the face and along its border, which with `rim` must fall on its border
    again; infinite where it faces the other way there.
    """
    rays = face_rays(face, face.diagonal / _ACROSS)
    uv = np.concatenate([rays.uv, border_points(face, _RIM)])
    point, normal = face.evaluate(uv).point, face.normal(uv)
    lines = [line_of(face, loop) for loop in face.outline]
    worst = 0.0
    for rotation, shift in ((turn.rotation, turn.shift), (turn.rotation.T, -turn.rotation.T @ turn.shift)):
        moved = point @ rotation.T + shift
        found = nearest(face, moved)
        if dot(face.normal(found.uv), normal @ rotation.T).min() < _SAME_WAY:
            return float("inf")
        worst = max(worst, float(found.distance.max()))
        if rim:
            border = moved[len(rays.uv):]
            on_rim = face.evaluate(on_border(face, border, lines, _RIM)[0]).point
            worst = max(worst, float(np.linalg.norm(border - on_rim, axis=1).max()))
    return worst


def transfer_measurement(task: VerificationTask, source: OperationMeasurement,
                         copy: TurnedCopy) -> OperationMeasurement | None:
    """What was measured of the source, as it is at the copy; None where the plan declares other zones there.

    Parameters
    ----------
    task : VerificationTask
        The copy.
    source : OperationMeasurement
    copy : TurnedCopy
    """
    zones = DeclaredZones(task.left, STRIP * (task.profile.flat_radius + task.profile.corner_radius))
    targets = tuple(_map_on_copy(one, copy) for one in source.targets)
    if any((zones.holds(one.face, one.uv, one.point) != one.declared).any() for one in targets):
        return None
    skin = tuple((_map_on_copy(one, copy), rays) for one, rays in source.skin)
    rooms = {name: _clearance_on_copy(room, copy) if isinstance(room, Clearance) else room
             for name, room in source.rooms.items()}
    link_cut = None if source.link_cut is None else _place_on_copy(source.link_cut, copy)
    return OperationMeasurement(targets, skin, rooms, _clearance_on_copy(source.edge, copy), link_cut,
                                source.uncertainty + copy.error, {})


def _map_on_copy(one: SurfaceMap, copy: TurnedCopy) -> SurfaceMap:
    """A map as it is at the copy, heights and depths greater by what may differ there."""
    worst = [None if place is None else _place_on_copy(place, copy) for place in (one.worst_scallop, one.worst_gouge)]
    return replace(one, face=copy.images[id(one.face)], point=copy.turn.moved(one.point),
                   remaining=_greater(one.remaining, copy.error), gouge=_greater(one.gouge, copy.error),
                   worst_scallop=worst[0], worst_gouge=worst[1])


def _greater(heights: Array, error: float) -> Array:
    return np.where(heights > 0.0, heights + error, heights)


def _place_on_copy(place: MapPoint, copy: TurnedCopy) -> MapPoint:
    x, y, z = (float(c) for c in copy.turn.moved(np.array(place.point)))
    return replace(place, face=copy.names.get(place.face, place.face), point=(x, y, z), value=place.value + copy.error)


def _clearance_on_copy(room: Clearance, copy: TurnedCopy) -> Clearance:
    """A clearance as it is at the copy, less by what may differ there."""
    if room.motion < 0:
        return room
    x, y, z = (float(c) for c in copy.turn.moved(np.array(room.point)))
    return replace(room, face=copy.names.get(room.face, room.face), point=(x, y, z),
                   distance=room.distance - copy.error)
