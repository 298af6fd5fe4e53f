"""Which faces of a part continue each other and are seen from one side: what one tool axis may machine as one."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import join_patches
from toolaxis.shape.joining.patch_grid import arrange_from
from toolaxis.shape.joining.shared_boundary import SharedBoundary, meeting_along
from toolaxis.shape.measure import mean_width
from toolaxis.shape.part import PLAIN_KINDS, Part
from toolaxis.skin.smooth_faces import join_faces, neighbours_of
from toolaxis.skin.unite import normals_of

Array = NDArray[np.float64]

#: Greatest angle between the normals of a skin and the middle of them, rad: what one axis can reach with some room.
_TURN = np.radians(65.0)


@dataclass(frozen=True)
class Skins:
    """What of a part's faces can be machined as one.

    Attributes
    ----------
    faces : tuple of Face
        Each skin as one face, of two faces or more; the skin with the largest of them first.
    single : tuple of int
        Sculptured faces that stay alone.
    reasons : tuple of str
        Sentences: why faces that continue each other smoothly are not joined.
    """

    faces: tuple[Face, ...]
    single: tuple[int, ...]
    reasons: tuple[str, ...]

    @property
    def joined(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the faces of each skin, in their order."""
        return tuple(face.numbers for face in self.faces)


def find_skins(part: Part, width: float = 0.0) -> Skins:
    """Sort a part's sculptured faces into such as continue each other and are seen from one side.

    Parameters
    ----------
    part : Part
    width : float
        Planes, cylinders and cones narrower than that belong to the skin that they continue, mm.

    Notes
    -----
    The largest face is taken first, and of its neighbours the largest that can still be seen with those before it.
    Of what stays alone, patches whose parameters go together are joined even where they turn farther, as around a body.

    **Properties**: 1. every sculptured face is in one of them, or single; 2. moving the part changes nothing.
    """
    open_ = {face.number: face for face in part.faces if not face.members and face.number not in part.avoided
             and (face.kind not in PLAIN_KINDS or mean_width(face) < width)}
    beside = {n: [m for m in others if part.allowance_on(open_[m]) == part.allowance_on(open_[n])]
              for n, others in neighbours_of(part, open_).items()}
    order = sorted(open_, key=lambda n: (-open_[n].area, n))
    skins: list[Face] = []
    refused: list[str] = []
    free = dict.fromkeys(order)
    for first in order:
        if first not in free or open_[first].kind in PLAIN_KINDS:
            continue
        numbers = _grow(first, open_, {n: [m for m in beside[n] if m in free] for n in free})
        numbers, made, why = _join_most(part, numbers)
        refused += why
        for number in numbers:
            del free[number]
        skins += [] if made is None else [made]
    alone = [n for n in sorted(open_) if not any(n in skin.numbers for skin in skins)]
    skins += _rectangles(part, [n for n in alone if open_[n].kind not in PLAIN_KINDS])
    within = {n: k for k, skin in enumerate(skins) for n in skin.numbers}
    single = tuple(face.number for face in part.sculptured if not face.members and face.number not in within)
    return Skins(tuple(skins), single, _reasons(part, within, open_, refused))


def _rectangles(part: Part, free: list[int]) -> list[Face]:
    """The largest rectangles of patches whose parameters go together, closed rings among them; those of two or more."""
    found: list[SharedBoundary] = []
    for edge in part.edges:
        a, b = edge.faces
        if edge.kind != "tangent" or a == b or not {a, b} <= set(free):
            continue
        if part.allowance_on(part.face(a)) != part.allowance_on(part.face(b)):
            continue
        with suppress(UnsupportedGeometry):
            meeting = meeting_along(part.face(a), part.face(b), edge)
            if not any(meeting.faces == other.faces and meeting.sides == other.sides for other in found):
                join_patches([part.face(a), part.face(b)], [meeting])
                found.append(meeting)
    skins: list[Face] = []
    while free:
        made = _join_largest(part, free, found)
        group = (free[0],) if made is None else made.numbers
        free = [n for n in free if n not in group]
        skins += [] if made is None else [made]
    return skins


def _join_largest(part: Part, free: Sequence[int], found: list[SharedBoundary]) -> Face | None:
    """The largest rectangle of free patches around the first of them; None where that is alone."""
    own = [m for m in found if set(m.faces) <= set(free)]
    cells = arrange_from(part.face(free[0]), own)
    by_cell = {cell: number for number, cell in reversed(list(cells.items()))}
    here = cells[free[0]]
    last = [max(cell[axis] for cell in by_cell) for axis in (0, 1)]
    boxes = [(range(a, b + 1), range(c, d + 1)) for a, b, c, d in
             product(range(here[0] + 1), range(here[0], last[0] + 1), range(here[1] + 1), range(here[1], last[1] + 1))]
    for columns, rows in sorted(boxes, key=lambda box: -len(box[0]) * len(box[1])):
        members = [by_cell.get(cell) for cell in product(columns, rows)]
        if None in members or len(members) == 1:
            continue
        numbers = sorted(n for n in members if n is not None)
        with suppress(UnsupportedGeometry):
            between = [m for m in own if set(m.faces) <= set(numbers)]
            return join_patches([part.face(n) for n in numbers], between)
    return None


def _grow(first: int, faces: dict[int, Face], beside: dict[int, list[int]]) -> list[int]:
    """A face and those around it that are seen from one side with it."""
    numbers, normals = [first], normals_of(faces[first])
    front = list(beside[first])
    while front:
        front.sort(key=lambda n: (-faces[n].area, n))
        number = front.pop(0)
        more = np.concatenate([normals, normals_of(faces[number])])
        if not len(more) or smallest_cap(more).radius > _TURN:
            continue
        numbers.append(number)
        normals = more
        front += [n for n in beside[number] if n not in numbers and n not in front]
    return numbers


def _join_most(part: Part, numbers: Sequence[int]) -> tuple[list[int], Face | None, list[str]]:
    """As many of the first of faces as can be machined as one, that one where they are two or more, and why not all."""
    kept = list(numbers)
    why: list[str] = []
    while len(kept) > 1:
        try:
            return kept, join_faces(part, sorted(kept)), why
        except UnsupportedGeometry as reason:
            why.append(str(reason))
            kept.pop()
    return kept, None, why


def _reasons(part: Part, within: dict[int, int], faces: dict[int, Face], refused: Sequence[str]) -> tuple[str, ...]:
    """Why faces that continue each other smoothly are not joined, and how many such pairs there are."""
    apart = [edge.faces for edge in part.edges if edge.kind == "tangent" and edge.faces[0] != edge.faces[1]
             and edge.faces[0] in faces and edge.faces[1] in faces
             and (edge.faces[0] not in within or within[edge.faces[0]] != within.get(edge.faces[1], -1))]
    apart = list(dict.fromkeys((min(pair), max(pair)) for pair in apart))
    if not apart:
        return tuple(refused[:1])
    a, b = apart[0]
    rest = f", and {len(apart) - 1} more pairs" if len(apart) > 1 else ""
    return (*refused[:1], f"faces {a} and {b} meet smoothly and stay apart{rest}: their normals and those of the faces "
                          f"joined to them turn by more than {np.degrees(_TURN):.0f} degrees from any axis")
