"""From cutter contact to cutter location: where the tool tip stands."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import as_rows, axis_rows, dot, lengths
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]


def tips(points: Array, normal: Array, axis: ArrayLike, tool: Tool, allowance: float = 0.0) -> Array:
    """Tool tips for contacts at points with given normals.

    Parameters
    ----------
    points, normal : (n, 3) array
        Cutter contacts, mm, and unit normals out of the material.
    axis : (3,) or (n, 3) array_like
        Unit tool axis, tip to spindle.
    tool : Tool
    allowance : float
        Stock left on the surface, mm.

    Returns
    -------
    (n, 3) array of tips, mm.  Where a cutter with a flat bottom stands upright on the normal (closer than 1e-12)
    the contact may lie anywhere on the bottom: its centre is taken.

    Notes
    -----
    **Source**: [zhu2016] Eq. (1), with the unit projection of n on the plane normal to T.
    """
    t = np.broadcast_to(np.asarray(axis, dtype=float), points.shape)
    tip = points + (tool.corner_radius + allowance) * normal - tool.corner_radius * t
    if tool.flat_radius > 0:
        across = normal - dot(normal, t)[:, None] * t
        size = lengths(across)[:, None]
        tip = tip + tool.flat_radius * np.where(size > 1e-12, across / np.where(size > 0, size, 1.0), 0.0)
    return tip


def place(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, allowance: float = 0.0) -> Array:
    """Tool tips for contacts at parameters of a face.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv : (n, 2) array_like
        Parameters of the contacts.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle, of any length.
    allowance : float
        Stock left on the surface, mm.

    Returns
    -------
    (n, 3) array of tips, mm

    Raises
    ------
    InvalidInput
        When an array has a wrong shape, a number is not finite, or an axis has no direction.
    """
    rows = as_rows(uv, 2, "uv")
    return tips(face.evaluate(rows).point, face.normal(rows), axis_rows(axis, len(rows)), tool, allowance)
