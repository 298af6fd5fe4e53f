"""A bull-nose end mill: flat bottom, corner arc, cylindrical side."""

from collections.abc import Mapping
from typing import Any

from toolaxis.errors import InvalidInput
from toolaxis.tools.cutter import Cutter
from toolaxis.tools.sizes import number, positive


class Torus(Cutter):
    """Diameter and corner radius."""

    name = "torus"
    title = "Bull nose"
    sizes = ("diameter", "corner_radius")
    example = "torus:12x1"
    rank = 0
    bits = (("bullnose", "Bullnose"),)
    read_from = ("bullnose", "torus", "bullnoseendmill", "bullnosemill", "cornerradiusendmill", "torusfräser")

    def radii(self, *sizes: Any) -> tuple[float, float, float]:
        """Half the diameter, and the corner radius above zero."""
        diameter, corner_radius = sizes
        radius, corner = positive("diameter", diameter) / 2, number("corner radius", corner_radius)
        if corner <= 0:
            raise InvalidInput(f"corner radius is {corner} mm: a torus needs one above zero; use a flat tool for a "
                               "sharp corner")
        return radius, corner, 0.0

    def sizes_of_bit(self, bit: Mapping[str, float | None]) -> dict[str, float | None]:
        """FreeCAD 1.0 gives the radius of the flat bottom, later ones that of the corner."""
        flat = bit["FlatRadius"]
        return {"diameter": bit["Diameter"],
                "corner_radius": bit["CornerRadius"] if flat is None else (bit["Diameter"] or 0) / 2 - flat}


CUTTER = Torus()
