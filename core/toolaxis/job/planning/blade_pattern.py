"""A part with blades: counterparts of one blade's faces on the others, and what of it is to be planned."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.bladed.blade_gap import BladeGapPoints, ahead, nearness, reach_along_normal, widest
from toolaxis.bladed.find_blades import Bladed, NoPattern, blades_of
from toolaxis.bladed.strips import strips
from toolaxis.bladed.trim_buried import cut_back_covered
from toolaxis.errors import UnsupportedGeometry
from toolaxis.job.planning.sub_surfaces import why_faceted
from toolaxis.plan.blades import Blades, Gap, PlannedBlade
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.infeasibility import tight_fillet
from toolaxis.shape.counterparts import Counterpart, best_motion, counterpart, off, turn_about
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import letters
from toolaxis.shape.part import PLAIN_KINDS, Body, Part
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Blades whose faces differ by less are told as alike, mm.
ALIKE = 1e-3
#: Closed bodies smaller than this share of the part's diagonal are there by mistake.
_STRAY = 5e-3
#: Greatest turn of normals across a strip of an edge, and of a fillet, rad.
_NOSE, _FILLET = np.radians(95.0), np.radians(50.0)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Blades of a part, their counterparts, and what is to be planned.

    Attributes
    ----------
    part : Part
    blades : Blades
        Without copies yet.
    matching : tuple of dict of int to Counterpart
        For each blade but the first: by face of the first.
    motions : tuple of (4, 4) array
        That bring the first blade onto each of the others.
    pieces : dict of int to tuple of Face
        What other bodies of the part leave of the faces that they cover in part or whole, by number.
    unlike : tuple of int
        Faces of the first blade that have no counterpart on some other one: they are planned by themselves, and so are
        those in their place on all blades.
    """

    part: Part
    blades: Blades
    matching: tuple[dict[int, Counterpart], ...]
    motions: tuple[Array, ...]
    pieces: dict[int, tuple[Face, ...]] = field(default_factory=dict)
    unlike: tuple[int, ...] = ()

    def face(self, number: int) -> Face:
        """A face of a blade without what other bodies cover; where they part it, its largest piece.

        Parameters
        ----------
        number : int
        """
        return (self.pieces.get(number) or (self.part.face(number),))[0]

    @property
    def first(self) -> tuple[Face, ...]:
        """The sculptured faces of the first blade, and its piece of the hub where that is sculptured."""
        named = self.blades.blades[0].faces
        return tuple(face for name in named for face in map(self.face, named[name])
                     if face.kind not in PLAIN_KINDS and self.pieces.get(face.number, (face,)))

    @cached_property
    def stray(self) -> tuple[int, ...]:
        """Sculptured faces of closed bodies that are so small beside the part that they are there by mistake."""
        faces = {n for body in self.part.bodies if body.closed and self._across(body) < _STRAY * self.part.diagonal
                 for n in body.faces}
        return tuple(face.number for face in self.part.sculptured if face.number in faces)

    def _across(self, body: Body) -> float:
        boxes = np.array([self.part.face(n).box for n in body.faces])
        return float(np.linalg.norm(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)))

    @property
    def rest(self) -> tuple[Face, ...]:
        """The sculptured faces that belong to no blade, each piece of them that no other body covers by itself."""
        found: list[Face] = []
        for face in self.part.sculptured:
            if self.blades.blade_of(face.number) is None and face.number not in self.stray:
                left = self.pieces.get(face.number, (face,))
                found += [piece.trimmed(piece.trims, face.label + letters(k)) for k, piece in enumerate(left)] \
                    if len(left) > 1 else left
        return tuple(found)


def find_pattern(part: Part, progress: Progress = NO_PROGRESS) -> tuple[Pattern | None, tuple[str, ...]]:
    """The blades of a part; where it has none that can be planned as one, a warning that says why, if it needs one.

    Parameters
    ----------
    part : Part
    progress : Progress
    """
    if len(part.sculptured) < 4:
        return None, ()
    try:
        rotor = blades_of(part)
        numbers = {face.number for face in part.sculptured}.union(*(blade.faces for blade in rotor.blades))
        bare, pieces = cut_back_covered(part, numbers, progress)
        # tools keep clear of whole faces: only what is machined is cut back
        return _add_warnings(replace(pattern_of(bare, rotor),
                                     part=part.with_warnings(*bare.warnings[len(part.warnings):]),
                                     pieces=pieces)), ()
    except NoPattern:
        return None, ()
    except UnsupportedGeometry as reason:
        return None, (f"blades are not told apart, every face is planned by itself: {reason}",)


def pattern_of(part: Part, rotor: Bladed) -> Pattern:
    """The blades of a part with their counterparts and the least gap between neighbours.

    Parameters
    ----------
    part : Part
    rotor : Bladed
        From `toolaxis.bladed.find_blades.blades_of`.

    Raises
    ------
    UnsupportedGeometry
        When a side of the first blade has no counterpart on another one.
    """
    count = len(rotor.blades)
    own = [{**_name_faces(blade), "hub": ()} for blade in rotor.blades]
    matching: list[dict[int, Counterpart]] = []
    motions: list[Array] = []
    floor = [part.face(n) for n in rotor.hub if part.face(n).kind not in PLAIN_KINDS]
    beside = {m for n in rotor.blades[0].faces for m in part.neighbours(n)}
    hub = next((face for face in floor if face.number in beside), None) if len(floor) == count else None
    for k in range(1, count):
        matrix = turn_about(rotor.point, rotor.axis, 2 * np.pi * k / count)
        others = [part.face(n) for n in rotor.blades[k].faces]
        found = {n: counterpart(part.face(n), matrix, others) for n in rotor.blades[0].faces}
        if hub is not None:
            found[hub.number] = counterpart(hub, matrix, floor)
        kept = {n: other for n, other in found.items() if other is not None}
        matching.append(kept)
        motions.append(best_motion(matrix, [(part.face(n), other) for n, other in kept.items()]))
    unlike = _keep_alike(rotor, own, matching)
    if hub is not None and len({m[hub.number].face.number for m in matching if hub.number in m}) == count - 1:
        own[0]["hub"] = (hub.number,)
        for k, found_on in enumerate(matching, 1):
            own[k]["hub"] = (found_on[hub.number].face.number,)
    bare = tuple(PlannedBlade(faces) for faces in own)
    gap = _gap(part, bare)
    blades = Blades(rotor.point, rotor.axis, rotor.hub, bare, gap, {})
    return Pattern(part, blades, tuple(matching), tuple(motions), unlike=unlike)


def _keep_alike(rotor: Bladed, own: list[dict[str, tuple[int, ...]]],
                matching: list[dict[int, Counterpart]]) -> tuple[int, ...]:
    """Take faces that are not on every blade out of the blades, and tell which ones of the first blade they are."""
    first = rotor.blades[0]
    unlike = [n for n in first.faces if any(n not in found for found in matching)]
    sides = [n for n in unlike if n in first.suction + first.pressure]
    if sides:
        raise UnsupportedGeometry(f"face {sides[0]}, a side of the first blade, has no counterpart on another blade")
    for found in matching:
        for n in unlike:
            found.pop(n, None)
    alike = [set(first.faces).difference(unlike)]
    alike += [{other.face.number for other in found.values()} for found in matching]
    for faces, kept in zip(own, alike, strict=True):
        faces.update({name: tuple(n for n in numbers if n in kept) for name, numbers in faces.items()})
    return tuple(unlike)


def _add_warnings(pattern: Pattern) -> Pattern:
    """The pattern with warnings: blades that differ, and pieces of a blade's faces that are too many to be planned."""
    far, number = max((off(pattern.face(n), other, matrix), other.face.number)
                      for matrix, found in zip(pattern.motions, pattern.matching, strict=True)
                      for n, other in found.items() if other.chart is not None)
    notes = []
    if far > ALIKE:
        notes.append(f"the blades are alike to within {far:.3f} mm only (face {number} is farthest off): where their "
                     "faces differ, passes are laid on each blade's own faces and proven there")
    small = {n: left[1:] for n, left in pattern.pieces.items() if len(left) > 1 and pattern.blades.blade_of(n)}
    if small:
        area = sum(piece.area for left in small.values() for piece in left)
        notes.append(f"other bodies divide {len(small)} faces of blades ({min(small)} the first): their smaller "
                     f"pieces, {area:.2f} mm2, are not machined")
    if pattern.unlike:
        notes.append(f"faces {', '.join(map(str, pattern.unlike))} of the first blade have no counterpart on every "
                     "other blade: they are planned by themselves")
    if pattern.stray:
        notes.append(f"faces {', '.join(map(str, pattern.stray))} belong to stray bodies smaller than "
                     f"{_STRAY * pattern.part.diagonal:.1f} mm: they are kept clear of, not machined")
    return replace(pattern, part=pattern.part.with_warnings(*notes))


def _name_faces(blade: object) -> dict[str, tuple[int, ...]]:
    """Faces of a blade by what they are."""
    names = {"suction": "suction", "pressure": "pressure", "leading": "leading", "trailing": "trailing",
             "fillet": "fillets", "tip": "tip", "other": "others"}
    return {name: tuple(getattr(blade, kind)) for name, kind in names.items()}


def _walls(part: Part, blade: PlannedBlade) -> list[Face]:
    """The faces of a blade between hub and tip."""
    return [part.face(n) for name in ("suction", "pressure", "leading", "trailing") for n in blade.faces[name]]


def _gap(part: Part, blades: Sequence[PlannedBlade]) -> Gap:
    """The least distance of the first blade to the next one."""
    there = _walls(part, blades[1])
    least = min((nearness(face, there) for face in _walls(part, blades[0])), key=lambda one: one.distance)
    return Gap(least.distance, np.stack([least.here, least.there]))


def too_narrow(pattern: Pattern, tool: Tool, clearance: float) -> dict[int, str]:
    """Why sides of the first blade cannot be machined whole: the next blade is nearer than the cutter is wide.

    Parameters
    ----------
    pattern : Pattern
    tool : Tool
    clearance : float
        What the cutter has to keep from a neighbouring blade, mm.

    Returns
    -------
    dict of int to str, by number of the face; proven for every axis.
    """
    blades = pattern.blades.blades
    around = [pattern.face(face.number) for k in {1, len(blades) - 1} for face in _walls(pattern.part, blades[k])]
    found = {}
    for name in ("suction", "pressure"):
        for number in blades[0].faces[name]:
            gap = ahead(pattern.face(number), around)
            if gap is not None and reach_along_normal(tool) > widest(gap, clearance):
                found[number] = _refusal(name, number, gap, tool, clearance)
    return found


def _refusal(name: str, number: int, gap: BladeGapPoints, tool: Tool, clearance: float) -> str:
    here, there = (", ".join(f"{x:.2f}" for x in place) for place in (gap.here, gap.there))
    passes = widest(gap, clearance)
    return (f"infeasible: the {name} side, face {number}, comes within {gap.distance:.3f} mm of face {gap.number} of "
            f"the neighbouring blade, straight along its normal, from ({here}) to ({there}); in contact there the "
            f"cutter reaches {reach_along_normal(tool):g} mm along the normal with every axis; the widest cutter that "
            f"passes, {clearance:g} mm kept, is {max(passes, 0.0):.2f} mm in diameter")


class BladeFaces(NamedTuple):
    """The faces of the first blade as they go into planning.

    divided : to be divided as asked for;  whole : not to be divided any more: strips of edges and fillets, and what
    else there is;  refused : by face number, why it cannot be machined;  left : by face number, why it is left to a
    clean-up tool.
    """

    divided: tuple[Face, ...]
    whole: tuple[Face, ...]
    refused: dict[int, str]
    left: dict[int, str]


def group_blade_faces(pattern: Pattern, tool: Tool, clearance: float) -> BladeFaces:
    """Sides to be divided along span and chord; edges and fillets in strips in which normals turn little.

    Parameters
    ----------
    pattern : Pattern
    tool : Tool
    clearance : float
        What the cutter has to keep from a neighbouring blade, mm.
    """
    refused = too_narrow(pattern, tool, clearance)
    left = {face.number: why for face in pattern.first
            for why in [why_faceted(face, tool) or _tight(face, pattern.blades.side_of(face.number), tool)] if why}
    divided: list[Face] = []
    whole: list[Face] = []
    for face in pattern.first:
        name = pattern.blades.side_of(face.number)
        if face.number in refused or face.number in left:
            continue
        if name in ("suction", "pressure"):
            divided.append(face)
        elif name in ("leading", "trailing"):
            whole += strips(face, _NOSE)
        else:
            whole += strips(face, _FILLET) if name == "fillet" else (face,)
    return BladeFaces(tuple(divided), tuple(whole), refused, left)


def _tight(face: Face, side: str, tool: Tool) -> str:
    """Why a fillet is left to clean-up: it is tighter than the cutter; empty where not."""
    tight = tight_fillet(face, tool) if side == "fillet" else ""
    return tight and (f"face {face.number} is left entirely as rest material: {tight}; a ball end no larger than that "
                      "reaches it")
