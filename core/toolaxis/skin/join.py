"""Smooth skins: patches of a part that are machined, or divided, as one face."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from numbers import Integral

import numpy as np

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER, corner_at, join_patches, joins
from toolaxis.shape.joining.shared_boundary import GAP, meetings
from toolaxis.shape.part import Part
from toolaxis.skin.find import check_connected, gap_between
from toolaxis.skin.unite import unite

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
    numbers = _check_faces(part, faces)
    made = _join_faces(part, numbers, tolerance, corner)
    first = min(k for k, face in enumerate(part.faces) if face.number in numbers)
    kept = [(k, face) for k, face in enumerate(part.faces) if face.number not in numbers]
    order = [face for _, face in sorted([*kept, (first, made)], key=lambda row: row[0])]
    name = dict.fromkeys(numbers, made.number)
    edges = tuple(replace(edge, faces=(name.get(edge.faces[0], edge.faces[0]), name.get(edge.faces[1], edge.faces[1])))
                  for edge in part.edges if not (edge.kind == "tangent" and set(edge.faces) <= set(numbers)))
    bodies = tuple(replace(body, faces=_names_text(body.faces, name)) for body in part.bodies)
    return replace(part, faces=tuple(order), edges=edges, bodies=bodies, selected=_names_text(part.selected, name),
                   warnings=(*part.warnings, *_corner_warning(made)), original=part.original or part)


def _join_faces(part: Part, numbers: Sequence[int], tolerance: float, corner: float) -> Face:
    """One face from some of a part's: in their own parameters if these go together, else as they are seen."""
    faces = [part.face(n) for n in numbers]
    with suppress(UnsupportedGeometry):
        return join_patches(faces, meetings(part, numbers), tolerance, corner)
    check_connected(part, numbers)
    return unite(faces, gap_between(part, numbers))


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
    worst = max((corner_at(face, axis, t) for axis, t in joins(face)), default=0.0)
    if worst <= _CORNER:
        return []
    return [f"face {face.label}: iso-parametric lines turn by up to {np.degrees(worst):.0f} degrees where they cross a "
            "join, and passes with them"]
