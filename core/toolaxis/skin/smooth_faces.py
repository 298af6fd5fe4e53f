"""Faces of a part that continue each other smoothly: which they are, how far they lie apart, and one face from them."""

from collections.abc import Collection, Sequence
from contextlib import suppress

import numpy as np

from toolaxis.errors import UnsupportedGeometry
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER, join_patches
from toolaxis.shape.joining.shared_boundary import GAP as JOIN_GAP
from toolaxis.shape.joining.shared_boundary import meetings
from toolaxis.shape.part import Part
from toolaxis.skin.unite import GAP, unite

#: Share by which borders are taken to lie farther apart than was found at points of them.
_WIDER = 1.5


def join_faces(part: Part, numbers: Sequence[int], tolerance: float = JOIN_GAP,
               corner: float = GREATEST_CORNER) -> Face:
    """One face from some of a part's: in their own parameters if these go together, else as they are seen.

    Parameters
    ----------
    part : Part
    numbers : sequence of int
        The first one's number is that of the result.
    tolerance : float
        How far the joined surface may lie beside the faces at the joins, mm.
    corner : float
        Greatest angle by which iso-parametric lines may turn across a join, rad.

    Raises
    ------
    UnsupportedGeometry
        When they do not hang together smoothly, or no direction sees all of them.
    """
    faces = [part.face(n) for n in numbers]
    with suppress(UnsupportedGeometry):
        return join_patches(faces, meetings(part, numbers), tolerance, corner)
    check_connected(part, numbers)
    return unite(faces, gap_between(part, numbers))


def check_connected(part: Part, numbers: Sequence[int]) -> None:
    """That faces of a part hang together over smooth edges.

    Parameters
    ----------
    part : Part
    numbers : sequence of int

    Raises
    ------
    UnsupportedGeometry
        When one does not.
    """
    beside = neighbours_of(part, numbers)
    reached = [numbers[0]]
    for number in reached:
        reached += [n for n in beside[number] if n not in reached]
    apart = [n for n in numbers if n not in reached]
    if apart:
        raise UnsupportedGeometry(f"face {part.face(apart[0]).label} does not continue any of the others smoothly: "
                                  "machine it by itself")


def gap_between(part: Part, numbers: Collection[int]) -> float:
    """How far borders of faces that meet may lie apart, mm: what was found along the edges between them and more.

    Parameters
    ----------
    part : Part
    numbers : collection of int
    """
    found = [float(edge.gap.max()) for edge in part.edges if set(edge.faces) <= set(numbers) and len(edge.gap)]
    return max([GAP, *(_WIDER * gap for gap in found)])


def neighbours_of(part: Part, among: Collection[int]) -> dict[int, list[int]]:
    """Faces of some that continue each of them smoothly, the largest first.

    Parameters
    ----------
    part : Part
    among : collection of int
        Numbers.
    """
    found: dict[int, set[int]] = {n: set() for n in among}
    for edge in part.edges:
        a, b = edge.faces
        length = float(np.linalg.norm(np.diff(edge.polyline, axis=0), axis=1).sum())
        if edge.kind == "tangent" and a != b and a in found and b in found and length > GAP:
            found[a].add(b)
            found[b].add(a)
    return {n: sorted(others, key=lambda m: (-part.face(m).area, m)) for n, others in found.items()}
