"""What a tool must stay away from: faces with the distance that each component has to keep from each of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.bounding.bounding_tree import BoundingTree, forest
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]

IGNORED = -np.inf


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Faces and the least signed distance of cutter, shank and holder from each.

    Attributes
    ----------
    faces : tuple of Face
    required : (faces, 3) array
        Least signed distance of cutter, shank and holder, mm.  A negative number allows to reach so deep below the
        face, as it is right for faces that meet the machined one at a convex or smooth edge; -inf leaves a pair out.

    Raises
    ------
    InvalidInput
        When the shapes do not fit, or a number is NaN or +inf.
    """

    faces: tuple[Face, ...]
    required: Array

    def __post_init__(self) -> None:
        table = np.ascontiguousarray(self.required, dtype=float)
        object.__setattr__(self, "faces", tuple(self.faces))
        object.__setattr__(self, "required", table)
        if table.shape != (len(self.faces), 3):
            raise InvalidInput(f"required distances have shape {table.shape} for {len(self.faces)} faces: one row of "
                               "cutter, shank and holder for each face is needed")
        bad = np.argwhere(np.isnan(table) | (table == np.inf))
        if len(bad):
            raise InvalidInput(f"required distance {bad[0].tolist()} is {table[tuple(bad[0])]}: it must be a number, "
                               "or -inf to leave the pair out")

    @classmethod
    def of(cls, faces: Sequence[Face], tolerance: Tolerance | None = None, skin: Sequence[Face] = (),
           touching: Sequence[Face] = ()) -> "Surroundings":
        """Surroundings with the distances of a `Tolerance`.

        Parameters
        ----------
        faces : sequence of Face
            Everything, the machined skin included or not.
        tolerance : Tolerance, optional
        skin : sequence of Face
            Those of the faces that the cutter machines: it is not checked against them here (that is what gouge is
            for), shank and holder are.
        touching : sequence of Face
            Those that meet the machined face at an edge without standing in the way: the cutter may touch them, and
            reach below them as deep as a gouge may be.
        """
        limit = Tolerance() if tolerance is None else tolerance
        faces, skin, touching = ([own for face in some for own in face.own_faces] for some in (faces, skin, touching))
        table = np.tile([limit.cutter_clearance, limit.shank_clearance, limit.holder_clearance], (len(faces), 1))
        for row, face in enumerate(faces):
            if any(face.surface is other.surface for other in skin):
                table[row, 0] = IGNORED
            elif any(face.surface is other.surface for other in touching):
                table[row, 0] = -limit.gouge
        return cls(tuple(faces), table)

    @cached_property
    def cells(self) -> BoundingTree:
        """The faces' cells under one root."""
        return forest(self.faces)

    def requiring(self, required: ArrayLike) -> "Surroundings":
        """The same faces, cells included, with other distances.

        Parameters
        ----------
        required : (faces, 3) array_like
        """
        other = Surroundings(self.faces, np.broadcast_to(np.asarray(required, dtype=float), self.required.shape))
        if self.faces:
            other.__dict__["cells"] = self.cells
        return other
