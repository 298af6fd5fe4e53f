"""What of a face lies in the side that is held in a clamping."""

from typing import NamedTuple


class HeldFace(NamedTuple):
    """A face of which some or all was asked for and lies in the held side.

    face : int, its number;  label : str;  area : float, mm^2 of it in the held side;  whole : bool, whether it lies
    there all.
    """

    face: int
    label: str
    area: float
    whole: bool
