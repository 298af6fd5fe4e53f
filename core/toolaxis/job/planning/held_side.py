"""What of the faces lies in the side that is held in a clamping: it is not asked for, and told by itself."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.contours import contours
from toolaxis.numeric.sparse_grid import SparseGrid
from toolaxis.path.rest_material import split
from toolaxis.plan.face_share import FaceShare
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HalfSpace
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: Cells along each parameter of a face in which it is looked where the plane runs.
_CELLS = 160
#: How much farther than the face the grid goes, in cells, so that none of its lines lies on a border.
_BEYOND = 1.0637
#: Area below which what is left of a face is not worth a sub-surface, mm^2.
_LEAST = 0.01


def cut_face(face: Face, held: HalfSpace | None) -> Face | None:
    """What of a face lies outside of a held side: itself where all does, None where nothing does.

    Parameters
    ----------
    face : Face
        Of a part.
    held : HalfSpace or None

    Notes
    -----
    The border of what is left is exact at vertices that are a 160th of the face apart, and straight in u and v between.

    **Properties**: 1. what is left and what is held add up to the face.
    """
    if held is None:
        return face
    side = held

    def depth(uv: Array) -> Array:
        return side.depth(face.evaluate(uv).point)

    u0, u1, v0, v1 = face.bounds
    lines = _lines(u0, u1), _lines(v0, v1)
    nodes = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)
    values = depth(nodes.reshape(-1, 2)).reshape(nodes.shape[:2])
    on_face = np.concatenate([depth(face.grid(_CELLS, _CELLS)), *(depth(loop) for loop in face.outline)])
    if (on_face <= 0).all():
        return face
    if (on_face > 0).all():
        return None
    _, free = split(face.outline, contours(SparseGrid.of_all(lines, values), depth))
    left = face.trimmed(free) if free else None
    return left if left is not None and left.area >= _LEAST else None


def _lines(low: float, high: float) -> Array:
    """Lines of a grid over a range and a little beyond."""
    pitch = (high - low) / (_CELLS - 0.137)
    return np.asarray(low - _BEYOND * pitch + pitch * np.arange(_CELLS + 3))


def cut_faces(part: Part, faces: Iterable[Face]) -> tuple[tuple[Face, ...], tuple[FaceShare, ...]]:
    """What of faces is to be machined in a clamping, and what of them is held in it.

    Parameters
    ----------
    part : Part
        With the side that is held, if one is.
    faces : iterable of Face
        Of the part.

    Raises
    ------
    InvalidInput
        When all of them lie in the held side.
    """
    asked = tuple(faces)
    cut = [cut_face(face, part.held) for face in asked]
    free = tuple(face for face in cut if face is not None)
    if not free:
        raise InvalidInput("all chosen faces lie in the clamped side: clamp another side, or choose other faces")
    held = tuple(FaceShare.besides(face, left) for face, left in zip(asked, cut, strict=True) if left is not face)
    return free, held
