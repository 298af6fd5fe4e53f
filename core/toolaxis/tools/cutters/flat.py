"""A flat end mill with a sharp corner."""

from typing import Any

from toolaxis.tools.cutter import Cutter
from toolaxis.tools.sizes import positive


class Flat(Cutter):
    """Its diameter."""

    name = "flat"
    title = "Flat end mill"
    sizes = ("diameter",)
    example = "flat:20"
    rank = 2
    read_from = ("endmill", "flat", "flatendmill", "squareendmill", "schaftfräser")

    def radii(self, *sizes: Any) -> tuple[float, float, float]:
        """Half the diameter, and no corner."""
        (diameter,) = sizes
        return positive("diameter", diameter) / 2, 0.0, 0.0


CUTTER = Flat()
