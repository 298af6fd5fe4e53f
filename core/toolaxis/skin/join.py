"""Smooth skins: patches of a part that are machined, or divided, as one face."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from numbers import Integral

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER, corner_at, joins
from toolaxis.shape.joining.shared_boundary import GAP
from toolaxis.shape.part import AVOIDED_TOO, Part
from toolaxis.skin.smooth_faces import join_faces

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
        When they do not continue each other smoothly, or no direction sees all of them: see
        `toolaxis.skin.unite.unite`.

    Notes
    -----
    Patches in rows and columns whose parameters go together keep these; all others get places in the plane across the
    direction from which they are seen best.

    **Properties**: 1. areas add up; 2. skin and surroundings of a face are the same faces as before.
    """
    return with_skins(part, [join_faces(part, _check_faces(part, faces), tolerance, corner)])


def with_skins(part: Part, skins: Sequence[Face]) -> Part:
    """The part with skins in the place of the faces that they consist of.

    Parameters
    ----------
    part : Part
    skins : sequence of Face
        Of different faces of the part, each as `toolaxis.skin.smooth_faces.join_faces` makes it.
    """
    if not skins:
        return part
    name = {number: skin.number for skin in skins for number in skin.numbers}
    waiting = {skin.number: skin for skin in skins}
    faces: list[Face] = []
    for face in part.faces:
        if face.number not in name:
            faces.append(face)
        elif name[face.number] in waiting:  # it stands where the first of its faces stood
            faces.append(waiting.pop(name[face.number]))
    edges = tuple(replace(edge, faces=(name.get(edge.faces[0], edge.faces[0]), name.get(edge.faces[1], edge.faces[1])))
                  for edge in part.edges if not (edge.kind == "tangent" and _inside_one(edge.faces, name)))
    bodies = tuple(replace(body, faces=_rename(body.faces, name)) for body in part.bodies)
    told = [sentence for skin in skins for sentence in _corner_warning(skin)]
    return replace(part, faces=tuple(faces), edges=edges, bodies=bodies, selected=_rename(part.selected, name),
                   avoided=_rename(part.avoided, name), warnings=(*part.warnings, *told),
                   original=part.original or part)


def take_apart(part: Part, numbers: Collection[int]) -> Part:
    """The part with the faces of some skins in their place again; other skins stay.

    Parameters
    ----------
    part : Part
    numbers : collection of int
        Of the skins.

    Notes
    -----
    **Properties**: 1. it is the part to which only the other skins were joined.
    """
    if part.original is None or not numbers:
        return part
    made = with_skins(part.original, [face for face in part.faces if face.members and face.number not in numbers])
    gone = [part.face(number) for number in numbers]
    back = {skin.number: skin.numbers for skin in gone}
    selected = tuple(own for number in part.selected for own in back.get(number, (number,)))
    told = {sentence for skin in gone for sentence in _corner_warning(skin)}
    kept = tuple(text for text in part.warnings if text not in told)
    return replace(made, selected=selected, stock=part.stock, warnings=kept)


def _inside_one(pair: tuple[int, int], name: Mapping[int, int]) -> bool:
    """Whether both faces of an edge belong to one skin."""
    a, b = pair
    return a in name and name[a] == name.get(b)


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
    avoided = [n for n in numbers if n in part.avoided]
    if avoided and len(avoided) < len(numbers):
        raise InvalidInput(f"face {avoided[0]} {AVOIDED_TOO}")
    return numbers


def _rename(numbers: tuple[int, ...], name: dict[int, int]) -> tuple[int, ...]:
    return tuple(dict.fromkeys(name.get(n, n) for n in numbers))


def _corner_warning(face: Face) -> list[str]:
    """A sentence where iso-curves have corners at joins: passes have them too."""
    worst = max((corner_at(face, axis, t) for axis, t in joins(face)), default=0.0)
    if worst <= _CORNER:
        return []
    return [f"face {face.label}: iso-parametric lines turn by up to {np.degrees(worst):.0f} degrees where they cross a "
            "join, and passes with them"]
