"""Sizes of cutter and strip as kernels take them, checked."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

CAP = 4.0
"""Greatest half width that is looked for, in radii of the tool."""


def cutter_numbers(tool: Tool, scallop: float, allowance: float) -> Array:
    """Flat radius, corner radius, cos and sin of the side's inclination, top of the cutting edge, offset.

    Parameters
    ----------
    tool : Tool
    scallop : float
        Scallop height, mm.
    allowance : float
        Stock left on the surface, mm.

    Raises
    ------
    InvalidInput
        When the scallop height is not above zero and below the tool's radius, or the allowance makes no sense.
    """
    if not (np.isfinite(scallop) and 0 < scallop < tool.radius):
        raise InvalidInput(f"scallop height is {scallop} mm: it must lie above zero and below the tool's radius "
                           f"{tool.radius} mm")
    if not (np.isfinite(allowance) and allowance >= -tool.corner_radius):
        raise InvalidInput(f"allowance is {allowance} mm: it must be finite and not below minus the corner radius "
                           f"{tool.corner_radius} mm")
    return np.array([tool.flat_radius, tool.corner_radius, np.cos(tool.half_angle), np.sin(tool.half_angle),
                     tool.flute_length, tool.corner_radius + allowance])
