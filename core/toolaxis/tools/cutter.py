"""What every kind of cutter offers: its names, its sizes, and the radii that they make.

The outline of all kinds is that of `toolaxis.tools.profile.Profile`: a flat bottom, a corner arc and a straight side,
of which some may be missing.
"""

from collections.abc import Mapping
from typing import Any, Protocol

#: Sizes that FreeCAD's tool bits may have, mm and degrees.
BIT_SIZES = ("Diameter", "CornerRadius", "FlatRadius", "TaperAngle")


class Cutter(Protocol):
    """A kind of cutter.

    Attributes
    ----------
    name : str
        Word of its short form, of tool files and of plan.json.
    title : str
        In plain words, as FreeCAD's panel offers it.
    sizes : tuple of str
        Of diameter, corner_radius and half_angle_deg those that it has, in the order of its short form.
    example : str
        A short form.
    rank : int
        Place in lists; those of one rank stand by name.
    bits : tuple of (str, str)
        FreeCAD's tool bits for it, shape and type: the first one that FreeCAD has is taken.
    read_from : tuple of str
        What FreeCAD's tool bits and the tool tables of CAM systems call it, in lower case, letters only.
    """

    name: str
    title: str
    sizes: tuple[str, ...]
    example: str
    rank: int = 100
    bits: tuple[tuple[str, str], ...] = (("endmill", "Endmill"),)
    read_from: tuple[str, ...] = ()

    def radii(self, *sizes: Any) -> tuple[float, float, float]:
        """Radius where the corner arc ends and radius of that arc, mm, and inclination of the side, rad.

        Parameters
        ----------
        *sizes
            In the order of the short form, mm and degrees.

        Raises
        ------
        InvalidInput
            When they make no such cutter.
        """
        ...

    def shop_name(self, diameter: float, corner_radius: float, half_angle_deg: float) -> str:
        """What a shop calls it: "Bull nose D12 R1".

        Parameters
        ----------
        diameter, corner_radius : float
            mm
        half_angle_deg : float
            Inclination of the side from the axis, degrees.
        """
        corner = f" R{corner_radius:.6g}" if "corner_radius" in self.sizes else ""
        side = f" {half_angle_deg:.6g} deg" if "half_angle_deg" in self.sizes else ""
        return f"{self.title} D{diameter:.6g}{corner}{side}"

    def sizes_of_bit(self, bit: Mapping[str, float | None]) -> dict[str, float | None]:
        """Sizes from those of a tool bit of FreeCAD.

        Parameters
        ----------
        bit : mapping
            With `BIT_SIZES`, None where the bit does not have one.
        """
        return {"diameter": bit["Diameter"]}
