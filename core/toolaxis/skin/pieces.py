"""The part's own faces under a skin, or under a piece of one."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.polygon_boolean import divide_nearly, without
from toolaxis.numeric.polygons import polygon_area, signed_area, stations, walk
from toolaxis.shape.face import Face, Member
from toolaxis.shape.joining.joined_surface import name_of
from toolaxis.skin.covered_parts import Loops
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.view_surface import ViewSurface

Array = NDArray[np.float64]

#: Share of a member's area in its parameters that may be missing of the whole.
_WHOLE = 1e-6
#: Pieces of the longest side of a loop that is carried over to a member's own parameters.
_DIVIDED = 128


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
    loops = face.outline
    pieces: list[Face] = []
    for seen, covered in zip(surface.seen, surface.covered, strict=True):
        visible = seen.outline
        for hidden in covered:
            visible = without(visible, hidden)
        parts: list[Loops] | None = [visible]
        if not face.fills_outline:
            parts = _common(visible, loops)
        elif covered:
            parts = outer_with_holes(visible)
        if parts is not None and any(part is seen.outline for part in parts):
            pieces.append(seen.face)
            continue
        own = None if parts is None else _carry_over_all(seen, parts)
        if own is None:
            pieces += [] if only_exact else [seen.face]
        else:
            pieces += [seen.face.trimmed(part, seen.face.label + letters) for part in own]
    return tuple(pieces)


def _carry_over_all(seen: SeenFace, parts: list[Loops]) -> list[Loops] | None:
    """Polygons of the plane in a face's own parameters; None where one of them cannot be carried over."""
    found: list[Loops] = []
    for part in parts:
        own = [_carry_over(seen, loop) for loop in part]
        known = tuple(loop for loop in own if loop is not None)
        if len(known) < len(own):
            return None
        found.append(known)
    return found


def _common(member: Loops, piece: Loops) -> list[Loops] | None:
    """What two polygons with holes have in common, the first one itself where that is all of it; None if unknown."""
    corners = (np.concatenate(loops) for loops in (member, piece))  # of all parts where a piece falls apart
    box, other = (np.stack([one.min(axis=0), one.max(axis=0)]) for one in corners)
    if (box[0] > other[1]).any() or (other[0] > box[1]).any():
        return []
    try:
        both, apart = divide_nearly(member, piece)
    except InvalidInput:
        return None
    if not [loop for loop in apart if abs(signed_area(loop)) > _WHOLE * polygon_area(member)]:
        return [member]
    least = _WHOLE * min(polygon_area(member), polygon_area(piece))
    return [part for part in outer_with_holes(both) if polygon_area(part) > least]


def _carry_over(seen: SeenFace, loop: Array) -> Array | None:
    """A loop of the plane in a face's own parameters; None where the face is closed and the loop goes through its seam.
    """
    size = np.ptp(loop, axis=0) / _DIVIDED
    fine = walk(loop, stations(loop, (float(size[0]), float(size[1]))))
    uv = seen.find(fine)
    u0, u1, v0, v1 = seen.face.bounds
    uv = np.clip(uv, [u0, v0], [u1, v1])
    step = np.abs(np.roll(uv, -1, axis=0) - uv).max(axis=0)
    if (step > 0.5 * np.array([u1 - u0, v1 - v0])).any() and np.isfinite(seen.periods).any():
        return None
    return uv if len(uv) > 2 and signed_area(uv) != 0 else None
