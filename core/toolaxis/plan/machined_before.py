"""What of a face is machined in earlier setups."""

from typing import NamedTuple


class MachinedBefore(NamedTuple):
    """A face of which plans of earlier setups machine some or all.

    face : int, its number;  label : str;  area : float, mm^2 of it that they machine;  whole : bool, whether that is
    all of it.
    """

    face: int
    label: str
    area: float
    whole: bool
