"""What the faces of a file miss each other by where they meet: measured once, and not counted as the cutter's gouge.

Where the border of a face stands out over the face beside it, a cutter that touches the one enters the other by as
much.  That depth is in the file and not in the cut, so it is taken off there: in full up to `REACH` from the edge, and
less and less up to twice that.  A step higher than `GREATEST` is no mismatch but an edge, and nothing is taken off.
"""

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.adjacency import Edge
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Distance from an edge up to which a mismatch is taken off in full, mm.
REACH = 0.5
#: Steps below the first are exact enough, those above the second are edges, mm.
SMALLEST, GREATEST = 0.0005, 0.02
#: Gaps from which on a mismatch is named, mm, and how many pairs of faces are.
NOTICED, NAMED = 0.001, 5
#: Edges at which a cutter in contact with one face may touch the other.
_KINDS = ("tangent", "convex")


@dataclass(frozen=True)
class Seam:
    """Two faces that do not quite meet along their shared edge.

    Attributes
    ----------
    faces : (int, int)
        Numbers.
    kind : str
        "tangent" or "convex".
    gap : float
        Greatest distance of their borders, mm.
    step : float
        Greatest height by which one stands out over the other, mm.
    point : (float, float, float)
        Where the gap is greatest, mm.
    """

    faces: tuple[int, int]
    kind: str
    gap: float
    step: float
    point: tuple[float, float, float]

    @property
    def counted(self) -> bool:
        """Whether the step is too high to be a mismatch: what a cutter gouges there counts in full."""
        return self.step > GREATEST

    @property
    def document(self) -> dict[str, Any]:
        """The seam as JSON has it."""
        return {**asdict(self), "faces": list(self.faces), "point": list(self.point), "counted": self.counted}


class Mismatch(NamedTuple):
    """By how much faces stand out over their neighbours, as straight pieces of their edges.

    segment : (k, 7) array
        Both ends of each piece, mm, and the height, mm.
    span : (faces + 1, 2) array of int
        First piece of each face and the one after its last; in the last row those of all faces.
    stock : float
        What is left on the faces, mm: a cutter that stays farther away than that enters nothing.
    """

    segment: Array
    span: Indices
    stock: float

    @property
    def plain(self) -> tuple[Array, Indices, float]:
        """The fields as kernels take them."""
        return self.segment, self.span, self.stock


def seams(edges: Sequence[Edge]) -> tuple[Seam, ...]:
    """Pairs of faces that do not quite meet, the widest gap first.

    Parameters
    ----------
    edges : sequence of Edge

    Returns
    -------
    tuple of Seam
        One for each pair of faces and kind of edge, those of `NOTICED` and more.
    """
    worst: dict[tuple[tuple[int, int], str], Seam] = {}
    for edge in edges:
        if edge.kind not in _KINDS or not len(edge.gap) or edge.gap.max() < NOTICED:
            continue
        k = int(edge.gap.argmax())
        x, y, z = (float(c) for c in edge.polyline[k])
        found = Seam(edge.faces, edge.kind, float(edge.gap[k]), max(float(edge.step.max()), 0.0), (x, y, z))
        key = ((min(edge.faces), max(edge.faces)), edge.kind)
        if key not in worst or worst[key].gap < found.gap:
            worst[key] = found
    return tuple(sorted(worst.values(), key=lambda seam: (-seam.gap, seam.faces)))


def seam_warnings(edges: Sequence[Edge]) -> tuple[str, ...]:
    """Sentences about the widest seams, and one about how many more there are.

    Parameters
    ----------
    edges : sequence of Edge
    """
    found = seams(edges)
    told = [_sentence(seam) for seam in found[:NAMED]]
    if len(found) > NAMED:
        rest = found[NAMED:]
        more = f"{len(rest)} more pairs of faces are up to {rest[0].gap:.4f} mm apart along their shared edges"
        high = sum(seam.counted for seam in rest)
        told.append(f"{more}; steps of more than {GREATEST:g} mm between {high} of them count as gouge" if high else
                    f"{more}: not counted as gouge")
    return tuple(told)


def _sentence(seam: Seam) -> str:
    place = "(" + ", ".join(f"{x:.2f}" for x in seam.point) + ")"
    pair = f"faces {seam.faces[0]} and {seam.faces[1]}"
    apart = f"{pair} are {seam.gap:.4f} mm apart along their shared edge near {place}"
    if seam.counted:
        return (f"{apart}, with a step of {seam.step:.4f} mm: more than {GREATEST:g} mm counts as an edge, and what "
                "the cutter takes off it as gouge")
    return f"{apart}: not counted as gouge"


def mismatch_of(faces: Sequence[Face], edges: Sequence[Edge], touched: Collection[int],
                stock: float = 0.0) -> Mismatch | None:
    """By how much faces stand out over faces that a cutter may touch; None where nothing does.

    Parameters
    ----------
    faces : sequence of Face
        Of which it is asked.
    edges : sequence of Edge
        Of the part.
    touched : collection of int
        Numbers of the faces that a cutter may touch.
    stock : float
        What is left on the faces of which it is asked, mm.

    Notes
    -----
    The height of a piece is the lesser one of its two ends, so that it is not taken for greater than it is.
    """
    pieces: dict[int, list[Array]] = {}
    asked = {face.number for face in faces}
    for edge in edges:
        if edge.kind not in _KINDS or not len(edge.step):
            continue
        for own, other in ((0, 1), (1, 0)):
            if edge.faces[own] not in asked or edge.faces[other] not in touched:
                continue
            height = np.minimum(edge.step[:-1, own], edge.step[1:, own])
            rows = (height >= SMALLEST) & (np.maximum(edge.step[:-1, own], edge.step[1:, own]) <= GREATEST)
            if rows.any():
                ends = np.hstack([edge.polyline[:-1], edge.polyline[1:], height[:, None]])
                pieces.setdefault(edge.faces[own], []).append(ends[rows])
    found = [np.concatenate(pieces.get(face.number, [np.empty((0, 7))])) for face in faces]
    ends = np.cumsum([len(one) for one in found])
    if not len(ends) or not ends[-1]:
        return None
    span = np.stack([np.append(ends - [len(one) for one in found], 0), np.append(ends, ends[-1])], axis=1)
    return Mismatch(np.concatenate(found), span.astype(np.int64), stock)
