"""Smooth skins: patches of a part that are machined, or divided, as one face."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product
from numbers import Integral

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.polygons import signed_area
from toolaxis.shape.face import Face, Member
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER, corner_at, join_patches, joins, name_of
from toolaxis.shape.joining.patch_grid import arrange_from
from toolaxis.shape.joining.shared_boundary import GAP, SharedBoundary, meeting_along, meetings
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: Share of a member's area in its parameters that may be missing of the whole.
_WHOLE = 1e-6
#: Angle between the two directions of an iso-curve at a join above which that is told, rad.
_CORNER = np.radians(5.0)


def join(part: Part, faces: Iterable[int], tolerance: float = GAP, corner: float = GREATEST_CORNER) -> Part:
    """The part with some of its faces, which continue each other smoothly, as one.

    Parameters
    ----------
    part : Part
    faces : iterable of int
        Numbers; the first one's u, v and number are those of the joined face.
    tolerance : float
        How far the joined surface may lie beside the faces at the joins, mm.
    corner : float
        Greatest angle by which iso-parametric lines may turn across a join, rad: of no matter to passes that do not
        follow them.

    Returns
    -------
    Part
        With a face "3+4" in the place of the first one; its `original` is the part as it was.

    Raises
    ------
    InvalidInput
        When there are fewer than two faces, one of them is named twice, is not there, or is joined already.
    UnsupportedGeometry
        When they cannot be joined: see `toolaxis.shape.joining.joined_surface.join_patches`.

    Notes
    -----
    **Properties**: 1. areas add up; 2. skin and surroundings of a face are the same faces as before.
    """
    numbers = _check_faces(part, faces)
    made = join_patches([part.face(n) for n in numbers], meetings(part, numbers), tolerance, corner)
    first = min(k for k, face in enumerate(part.faces) if face.number in numbers)
    kept = [(k, face) for k, face in enumerate(part.faces) if face.number not in numbers]
    order = [face for _, face in sorted([*kept, (first, made)], key=lambda row: row[0])]
    name = dict.fromkeys(numbers, made.number)
    edges = tuple(replace(edge, faces=(name.get(edge.faces[0], edge.faces[0]), name.get(edge.faces[1], edge.faces[1])))
                  for edge in part.edges if not (edge.kind == "tangent" and set(edge.faces) <= set(numbers)))
    bodies = tuple(replace(body, faces=_names_text(body.faces, name)) for body in part.bodies)
    return replace(part, faces=tuple(order), edges=edges, bodies=bodies, selected=_names_text(part.selected, name),
                   warnings=(*part.warnings, *_corner_warning(made)), original=part.original or part)


def _check_faces(part: Part, faces: Iterable[int]) -> list[int]:
    numbers = [int(n) if isinstance(n, Integral) else n for n in faces]
    if len(numbers) < 2:
        raise InvalidInput(f"faces to be joined are {numbers}: give at least two numbers")
    for k, number in enumerate(numbers):
        if not isinstance(number, int):
            raise InvalidInput(f"face {number!r} is no number of a face: give whole numbers from 1")
        if number in numbers[:k]:
            raise InvalidInput(f"face {number} is to be joined with itself: name each face once")
        if part.face(number).members:
            raise InvalidInput(f"face {part.face(number).label} is joined already: join all of them at once")
    return numbers


def _names_text(numbers: tuple[int, ...], name: dict[int, int]) -> tuple[int, ...]:
    return tuple(dict.fromkeys(name.get(n, n) for n in numbers))


def _corner_warning(face: Face) -> list[str]:
    """A sentence where iso-curves have corners at joins: passes have them too."""
    worst = max(corner_at(face, axis, t) for axis, t in joins(face))
    if worst <= _CORNER:
        return []
    return [f"face {face.label}: iso-parametric lines turn by up to {np.degrees(worst):.0f} degrees where they cross a "
            "join, and passes with them"]


def own_pieces(face: Face) -> tuple[Face, ...]:
    """The part's own faces under a joined face, or under a piece of one, each with its own surface and loops.

    Parameters
    ----------
    face : Face

    Returns
    -------
    tuple of Face
        The face itself where it was not joined; else its members, those of which it has only a part as pieces, labelled
        with its own letters.

    **Properties**: 1. areas add up.
    """
    if not face.members:
        return (face,)
    letters = face.label.removeprefix(name_of([member.face for member in face.members]))
    pieces: list[Face] = []
    for member in face.members:
        loops = face.outline
        for axis, (low, high) in enumerate(member.box.T):
            loops = clip_half_plane(clip_half_plane(loops, axis, float(low), True), axis, float(high), False)
        own = [tuple(_own(member, loop) for loop in piece) for piece in outer_with_holes(loops)]
        if abs(sum(map(_area, own)) - _area(member.face.outline)) <= _WHOLE * _area(member.face.outline):
            pieces.append(member.face)
        else:
            pieces += [member.face.trimmed(piece, member.face.label + letters) for piece in own]
    return tuple(pieces)


def _area(loops: tuple[Array, ...]) -> float:
    """Area of a polygon with holes in the parameters."""
    return abs(signed_area(loops[0])) - sum(abs(signed_area(hole)) for hole in loops[1:])


def _own(member: Member, uv: Array) -> Array:
    """A member's own parameters, kept in its range, from the joined ones."""
    u0, u1, v0, v1 = member.face.bounds
    return np.clip(uv @ member.matrix[:, :2].T + member.matrix[:, 2], [u0, v0], [u1, v1])


@dataclass(frozen=True)
class Skins:
    """What of a part's sculptured faces can be joined.

    Attributes
    ----------
    joined : tuple of tuple of int
        Numbers of the faces of each, two or more.
    single : tuple of int
        Sculptured faces that stay alone.
    reasons : tuple of str
        Sentences: why faces that continue each other smoothly are not joined.
    """

    joined: tuple[tuple[int, ...], ...]
    single: tuple[int, ...]
    reasons: tuple[str, ...]


def skins(part: Part) -> Skins:
    """Sort a part's sculptured faces into the largest rectangles of patches that can be joined.

    Parameters
    ----------
    part : Part

    **Properties**: 1. every sculptured face is in one of them, or single.
    """
    numbers = [face.number for face in part.sculptured if not face.members]
    found: list[SharedBoundary] = []
    reasons: dict[tuple[int, int], str] = {}
    for edge in part.edges:
        a, b = edge.faces
        if edge.kind != "tangent" or a == b or not {a, b} <= set(numbers):
            continue
        try:
            meeting = meeting_along(part.face(a), part.face(b), edge)
            if not any(meeting.faces == other.faces and meeting.sides == other.sides for other in found):
                join_patches([part.face(a), part.face(b)], [meeting])
                found.append(meeting)
        except UnsupportedGeometry as reason:
            reasons[a, b] = str(reason)
    groups: list[tuple[int, ...]] = []
    free = list(numbers)
    while free:
        groups.append(_largest(part, free, found))
        free = [n for n in free if n not in groups[-1]]
    owner = {n: k for k, group in enumerate(groups) for n in group}
    apart = [pair for pair in dict.fromkeys([*reasons, *(m.faces for m in found)]) if owner[pair[0]] != owner[pair[1]]]
    return Skins(tuple(group for group in groups if len(group) > 1),
                 tuple(group[0] for group in groups if len(group) == 1), tuple(_sentence_on_pairs(apart, reasons)))


def _largest(part: Part, free: Sequence[int], found: list[SharedBoundary]) -> tuple[int, ...]:
    """The largest rectangle of free patches around the first of them."""
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
            join_patches([part.face(n) for n in numbers], [m for m in own if set(m.faces) <= set(numbers)])
            return tuple(numbers)
    return (free[0],)


def _sentence_on_pairs(apart: list[tuple[int, int]], reasons: dict[tuple[int, int], str]) -> list[str]:
    """One sentence about pairs of faces that continue each other smoothly and are not joined."""
    if not apart:
        return []
    known = next((reasons[key] for pair in apart for key in (pair, pair[::-1]) if key in reasons),
                 f"faces {apart[0][0]} and {apart[0][1]} are neighbours in no full rows and columns")
    more = f"; {len(apart) - 1} further pairs of faces that meet smoothly stay apart too" if len(apart) > 1 else ""
    return [f"{known}{more}"]
