"""How much of a face is not asked for: as it lies in the clamped side, or earlier setups machine it."""

from typing import NamedTuple

from toolaxis.shape.face import Face


class FaceShare(NamedTuple):
    """A face of which some or all is not asked for.

    face : int, its number;  label : str;  area : float, mm^2 of it;  whole : bool, whether that is all of it.
    """

    face: int
    label: str
    area: float
    whole: bool

    @staticmethod
    def besides(face: Face, left: Face | None) -> "FaceShare":
        """All of a face but what is left of it, if anything is.

        Parameters
        ----------
        face : Face
        left : Face or None
            A piece of it.
        """
        area = face.area - (0.0 if left is None else left.area)
        return FaceShare(face.number, face.label, max(area, 0.0), left is None)
