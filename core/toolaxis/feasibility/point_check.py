"""Points of the skin inside the cutter: gouges found for certain, at next to no cost; finding none proves nothing."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters, parameters_of_tool
from toolaxis.contact.strip.swept_cutter import signed_distance
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.tools.solid import piece_distance_numpy, solid_pieces
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]


@jit
def _deepest(cutter: CutterParameters, axis: Array, tips: Array, points: Array) -> float:
    """Least signed distance of points to the cutter at any of the tips, mm."""
    reach = cutter.top**2 + (cutter.flat + cutter.corner + cutter.top * cutter.sin / cutter.cos) ** 2
    best, unit = np.inf, (axis[0], axis[1], axis[2])
    for k in range(tips.shape[0]):
        for i in range(points.shape[0]):
            x, y, z = points[i, 0] - tips[k, 0], points[i, 1] - tips[k, 1], points[i, 2] - tips[k, 2]
            if x * x + y * y + z * z < reach:
                best = min(best, signed_distance(cutter, unit, (x, y, z)))
    return best


def deepest_numpy(tool: Tool, axis: Array, tips: Array, points: Array) -> float:
    """The plain twin of `deepest`; parameters and result as there."""
    piece = solid_pieces(tool.profile, {})[0]
    apart = points[None] - tips[:, None]
    z = apart @ axis
    rho = np.linalg.norm(apart - z[..., None] * axis, axis=-1)
    least = float(piece_distance_numpy(piece, rho, z)[0].min())
    return max(-least, 0.0)


def deepest(tool: Tool, axis: Array, tips: Array, points: Array) -> float:
    """Greatest depth at which any of the points lies inside the cutter at any of the tips.

    Parameters
    ----------
    tool : Tool
    axis : (3,) array
        Unit vector.
    tips : (n, 3) array
        mm
    points : (m, 3) array
        mm

    Returns
    -------
    float, mm; 0 where no point is inside.
    """
    if not _compiled.available:
        return deepest_numpy(tool, axis, tips, points)
    rows = (np.ascontiguousarray(part) for part in (axis, tips, points))
    found = _deepest(parameters_of_tool(tool), *rows)
    return float(max(-found, 0.0))
