"""A ball end mill."""

from typing import Any

from toolaxis.tools.cutter import Cutter
from toolaxis.tools.sizes import positive


class Ball(Cutter):
    """Its diameter."""

    name = "ball"
    title = "Ball"
    sizes = ("diameter",)
    example = "ball:8"
    rank = 1
    bits = (("ballend", "Ballend"),)
    read_from = ("ballend", "ball", "ballendmill", "ballnose", "ballnoseendmill", "ballmill", "kugelfräser")

    def radii(self, *sizes: Any) -> tuple[float, float, float]:
        """Half the diameter, twice."""
        (diameter,) = sizes
        radius = positive("diameter", diameter) / 2
        return radius, radius, 0.0


CUTTER = Ball()
