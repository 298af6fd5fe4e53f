"""A cutter with a conical side."""

from collections.abc import Mapping
from math import radians
from typing import Any

from toolaxis.errors import InvalidInput
from toolaxis.tools.cutter import Cutter
from toolaxis.tools.sizes import number, positive


class Tapered(Cutter):
    """Diameter at the tip, corner radius and inclination of the side."""

    name = "tapered"
    title = "Tapered"
    sizes = ("diameter", "corner_radius", "half_angle_deg")
    example = "tapered:6x3x4"
    rank = 3
    bits = (("taperedballnose", "TaperedBallNose"), ("ballend", "Ballend"))
    read_from = ("taperedballnose", "tapered", "taperedmill", "taperedball", "taperedballend", "taperedballendmill",
                 "taperedendmill")

    def radii(self, *sizes: Any) -> tuple[float, float, float]:
        """Half the diameter, the corner radius, which may be zero, and the angle."""
        diameter, corner_radius, half_angle_deg = sizes
        angle, corner = number("half angle", half_angle_deg, "deg"), number("corner radius", corner_radius)
        if not 0 < angle < 80:
            raise InvalidInput(f"half angle is {angle} deg: it must lie between 0 and 80")
        if corner < 0:
            raise InvalidInput(f"corner radius is {corner} mm: it must be zero or more")
        return positive("diameter", diameter) / 2, corner, radians(angle)

    def shop_name(self, diameter: float, corner_radius: float, half_angle_deg: float) -> str:
        """A tapered ball by its diameter, any other one by its corner too; the angle is that of a side."""
        if 2 * corner_radius == diameter:
            return f"Tapered ball D{diameter:.6g} {half_angle_deg:.6g} deg"
        return super().shop_name(diameter, corner_radius, half_angle_deg)

    def sizes_of_bit(self, bit: Mapping[str, float | None]) -> dict[str, float | None]:
        """FreeCAD's has a ball at its end and tells the whole angle."""
        return {"diameter": bit["Diameter"], "corner_radius": (bit["Diameter"] or 0) / 2,
                "half_angle_deg": (bit["TaperAngle"] or 0) / 2}


CUTTER = Tapered()
