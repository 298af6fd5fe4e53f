"""What a sub-surface must not be cut into, and what must be kept clear of."""

from collections.abc import Sequence

from toolaxis.shape.face import Face
from toolaxis.shape.part import Part


def neighbourhood(part: Part, face: Face, obstacles: Sequence[Part] = ()) -> tuple[tuple[Face, ...], tuple[Face, ...]]:
    """The faces around a sub-surface, in two groups.

    Parameters
    ----------
    part : Part
    face : Face
        A face of the part, or a piece of one.
    obstacles : sequence of Part
        Further bodies.

    Returns
    -------
    skin, surroundings : tuple of Face
        The skin continues the face: tangent neighbours, directly or over others, and faces behind a convex edge of
        these.  The cutter touches it where it runs out over a border, so it is protected against gouges and no
        clearance can be asked for.  The surroundings are all else; a clearance is kept from them.
    """
    tangent = part.skin(face.number)
    own = {one.number for one in tangent}
    beside = {n for one in tangent for n in part.neighbours(one.number, "convex")}
    walls = {n for one in tangent for n in part.neighbours(one.number, "concave")}
    near = (own | (beside - walls)) - {face.number}
    skin = tuple(one for one in part.faces if one.number in near)
    rest = tuple(one for one in part.faces if one.number not in near | {face.number})
    return skin, (*rest, *(one for body in obstacles for one in body.faces))
