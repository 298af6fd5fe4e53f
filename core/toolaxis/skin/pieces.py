"""The part's own faces under a skin, or under a piece of one."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.polygon_boolean import divide_nearly, join_touching, without
from toolaxis.numeric.polygons import polygon_area, signed_area
from toolaxis.shape.face import Face, Member
from toolaxis.shape.joining.joined_surface import name_of
from toolaxis.skin.covered_parts import Loops
from toolaxis.skin.portions import Portion, carry_into_parameters, open_portions
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.view_surface import ViewSurface

Array = NDArray[np.float64]

#: Share of a member's area in its parameters that may be missing of the whole.
_WHOLE = 1e-6


def own_pieces(face: Face, only_exact: bool = False) -> tuple[Face, ...]:
    """The part's own faces under a joined face, or under a piece of one, each with its own surface and loops.

    Parameters
    ----------
    face : Face
    only_exact : bool
        Leave out a face of which it cannot be told what belongs to the piece; else all of that face is given.

    Returns
    -------
    tuple of Face
        The face itself where it was not joined; else its members, those of which it has only a part as pieces, labelled
        with its own letters.

    **Properties**: 1. areas add up, but for what of a member lies under another one as the skin is seen: no piece has
    that.
    """
    if not face.members:
        return (face,)
    letters = face.label.removeprefix(name_of([member.face for member in face.members]))
    if isinstance(face.surface, ViewSurface):
        return _in_view(face, face.surface, letters, only_exact)
    pieces: list[Face] = []
    for member in face.members:
        pieces += _in_box(face, member, letters)
    return tuple(pieces)


def _in_box(face: Face, member: Member, letters: str) -> list[Face]:
    """Pieces of one member of a face whose parameters are those of its members, mapped linearly."""
    assert member.box is not None
    loops = face.outline
    for axis, (low, high) in enumerate(member.box.T):
        loops = clip_half_plane(clip_half_plane(loops, axis, float(low), True), axis, float(high), False)
    own = [tuple(_own(member, loop) for loop in piece) for piece in outer_with_holes(loops)]
    whole = polygon_area(member.face.outline)
    if abs(sum(map(polygon_area, own)) - whole) <= _WHOLE * whole:
        return [member.face]
    return [member.face.trimmed(piece, member.face.label + letters) for piece in own]


def _own(member: Member, uv: Array) -> Array:
    """A member's own parameters, kept in its range, from the joined ones."""
    assert member.matrix is not None
    u0, u1, v0, v1 = member.face.bounds
    return np.clip(uv @ member.matrix[:, :2].T + member.matrix[:, 2], [u0, v0], [u1, v1])


def _in_view(face: Face, surface: ViewSurface, letters: str, only_exact: bool) -> tuple[Face, ...]:
    """Pieces of the members of a face whose parameters are places in a plane."""
    of_piece = None if face.fills_outline else outer_with_holes(join_touching(face.outline))
    pieces: list[Face] = []
    for seen, covered in zip(surface.seen, surface.covered, strict=True):
        own = _cut_member(seen, covered, of_piece)
        if own is None:
            pieces += [] if only_exact else [seen.face]
        elif own.whole:
            pieces.append(seen.face)
        else:
            pieces += [seen.face.trimmed(part, seen.face.label + letters) for part in own.parts]
    return tuple(pieces)


class _CutMember(NamedTuple):
    """What of a member belongs to a piece: polygons in its own parameters, and whether that is all of it."""

    parts: list[Loops]
    whole: bool


def _cut_member(seen: SeenFace, covered: Sequence[Loops], of_piece: Sequence[Loops] | None) -> _CutMember | None:
    """What of a member belongs to polygons in the plane, or to the whole skin: its portions one after the other where
    it is closed, as its outline in the plane runs along its seam twice; None if unknown."""
    if of_piece is None and not covered:
        return _CutMember([], True)
    cut: list[tuple[Portion, list[Loops]]] = []
    whole = not covered
    for portion in open_portions(seen):
        try:
            visible = _uncover(portion, covered)
            parts = outer_with_holes(visible) if of_piece is None or not visible else _common(visible, of_piece)
        except InvalidInput:
            return None
        whole = whole and len(parts) == 1 and parts[0] is visible
        cut.append((portion, parts))
    if whole or not cut:
        return _CutMember([], True)
    found: list[Loops] = []
    for portion, part in ((portion, part) for portion, parts in cut for part in parts):
        own = [carry_into_parameters(portion, loop) for loop in part]
        known = tuple(loop for loop in own if loop is not None)
        if len(known) < len(own):
            return None
        found.append(known)
    return _CutMember(found, False)


def _uncover(portion: Portion, covered: Sequence[Loops]) -> Loops:
    """The outline of a portion less what other members lie above.

    Raises
    ------
    InvalidInput
        When their borders cannot be told apart.
    """
    loops = portion.outline
    for hidden in covered:
        # What hides an open face was cut out of its very outline.
        loops = divide_nearly(loops, hidden)[1] if portion.of_closed else without(loops, hidden)
    return loops


def _common(member: Loops, parts: Sequence[Loops]) -> list[Loops]:
    """What a polygon with holes and others, which do not overlap, have in common; the first one itself where that is
    all of it.

    One of these after the other: their borders may coincide.

    Raises
    ------
    InvalidInput
        When borders cannot be told apart.
    """
    found: list[Loops] = []
    whole = polygon_area(member)
    for part in parts:
        box, other = (np.stack([one.min(axis=0), one.max(axis=0)]) for one in map(np.concatenate, (member, part)))
        if (box[0] > other[1]).any() or (other[0] > box[1]).any():
            continue
        both, apart = divide_nearly(member, part)
        if not [loop for loop in apart if abs(signed_area(loop)) > _WHOLE * whole]:
            return [member]
        least = _WHOLE * min(whole, polygon_area(part))
        found += [one for one in outer_with_holes(both) if polygon_area(one) > least]
    if abs(sum(map(polygon_area, found)) - whole) <= _WHOLE * whole:
        return [member]
    return found
