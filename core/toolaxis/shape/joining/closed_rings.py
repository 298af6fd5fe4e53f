"""Rings of faces around a blade: smooth neighbours, side by side, until the first is met again."""

from contextlib import suppress

from toolaxis.errors import UnsupportedGeometry
from toolaxis.shape.joining.shared_boundary import SharedBoundary, meeting_along
from toolaxis.shape.part import Part


def ring_around(part: Part, number: int) -> tuple[int, ...]:
    """The ring of faces in which one lies: each leaves on the side opposite to that on which it was entered.

    Parameters
    ----------
    part : Part
    number : int
        A face that is not joined.

    Returns
    -------
    tuple of int
        Numbers in order, the given one first; empty where there is no such ring, so also where the face closes by
        itself. Of two rings, along u and along v, the one of fewer faces, then the one along u.

    Notes
    -----
    **Properties**: 1. neighbours in the ring meet along a whole smooth edge; 2. from any of its faces the same ring is
    found.
    """
    rings = [ring for axis in (0, 1) if (ring := _walk_ring(part, number, axis))]
    return min(rings, key=len, default=())


def _walk_ring(part: Part, number: int, axis: int) -> tuple[int, ...]:
    """The ring that leaves a face where its parameter of that axis is largest."""
    found = [number]
    end = 1
    while True:
        meeting = _next(part, found[-1], axis, end)
        if meeting is None:
            return ()
        here = meeting.faces[1]
        axis, end = meeting.sides[1].axis, 1 - meeting.sides[1].end
        if here == number:
            return tuple(found) if len(found) > 1 and end == 1 else ()
        if here in found:
            return ()
        found.append(here)


def _next(part: Part, number: int, axis: int, end: int) -> SharedBoundary | None:
    """How a face meets the one beyond a side; None where none continues it smoothly along its own side."""
    for edge in part.edges_to_touch:
        if edge.kind != "tangent" or number not in edge.faces or edge.faces[0] == edge.faces[1]:
            continue
        with suppress(UnsupportedGeometry):
            meeting = meeting_along(part.face(edge.faces[0]), part.face(edge.faces[1]), edge)
            meeting = meeting if meeting.faces[0] == number else meeting.turned()
            if (meeting.sides[0].axis, meeting.sides[0].end) == (axis, end):
                return meeting
    return None
