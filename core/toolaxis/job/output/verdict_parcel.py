"""Verdicts on their way from one process to another: the faces that both know stay where they are."""

import io
import pickle
from collections.abc import Sequence
from typing import Any

from toolaxis.shape.face import Face
from toolaxis.verify.verdict import OperationVerdict


def pack_verdict(found: OperationVerdict, faces: Sequence[Face]) -> bytes:
    """A verdict as bytes, faces by their places among those that the judge looked at.

    Parameters
    ----------
    found : OperationVerdict
    faces : sequence of Face
        Of the operation: those machined, and the skin around them.
    """
    made = io.BytesIO()
    _Packing(made, faces).dump(found)
    return made.getvalue()


def unpack_verdict(parcel: bytes, faces: Sequence[Face]) -> OperationVerdict:
    """The verdict that was packed.

    Parameters
    ----------
    parcel : bytes
    faces : sequence of Face
        The same faces in the same order, as this process has them.
    """
    found: OperationVerdict = _Unpacking(io.BytesIO(parcel), faces).load()
    return found


class _Packing(pickle.Pickler):
    """Writes the place of a face that is known instead of the face."""

    def __init__(self, made: io.BytesIO, faces: Sequence[Face]) -> None:
        super().__init__(made, protocol=pickle.HIGHEST_PROTOCOL)
        self._places = {id(face): place for place, face in enumerate(faces)}

    def persistent_id(self, one: Any) -> int | None:
        """The place of a face; None of all else, which is written as it is."""
        return self._places.get(id(one))


class _Unpacking(pickle.Unpickler):
    """Puts the faces of this process in their places."""

    def __init__(self, parcel: io.BytesIO, faces: Sequence[Face]) -> None:
        super().__init__(parcel)
        self._faces = faces

    def persistent_load(self, place: int) -> Face:
        """The face in a place."""
        return self._faces[place]
