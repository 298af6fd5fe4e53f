"""The cutter as kernels take it, and the checks of the heights that go with it."""

from typing import NamedTuple

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.tools.tool import Tool

CAP = 4.0
"""Greatest half width that is looked for, in radii of the tool."""


class CutterParameters(NamedTuple):
    """Lengths in mm, and the inclination of the side line above the corner arc."""

    flat: float
    """Radius of the flat bottom."""
    corner: float
    """Radius of the corner arc."""
    cos: float
    sin: float
    top: float
    """Height of the cutting edge's end above the tip."""
    offset: float
    """Distance of the corner's centre circle from the surface: corner radius + allowance."""


def parameters_of_tool(tool: Tool, allowance: float = 0.0) -> CutterParameters:
    """The cutter with stock left on the surface, mm."""
    cos, sin = float(np.cos(tool.half_angle)), float(np.sin(tool.half_angle))
    return CutterParameters(float(tool.flat_radius), float(tool.corner_radius), cos, sin, float(tool.flute_length),
                            float(tool.corner_radius + allowance))


def cutter_parameters(tool: Tool, scallop: float, allowance: float) -> CutterParameters:
    """The cutter for a strip of a scallop height.

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
    return parameters_of_tool(tool, allowance)
