"""How deep the cutter reaches below the machined skin: an upper bound that holds between all points."""

from collections.abc import Sequence
from math import pi, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, motions, segment_motions
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import axis_rows
from toolaxis.shape.bounding.bounding_tree import BoundingTree, forest
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

RESOLUTION = 0.0003


def skin_cells(skin: BoundingTree | Sequence[Face]) -> BoundingTree:
    """Cells of a skin, made once and used for any tool and axis.

    Parameters
    ----------
    skin : Cells or sequence of Face
        The machined face and its tangent-continuous neighbours.
    """
    return skin if isinstance(skin, BoundingTree) else forest(skin)


def gouge(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, skin: BoundingTree | Sequence[Face] | None = None, *,
          allowance: float = 0.0) -> Array:
    """Upper bound of the depth to which the cutter reaches below the skin, for contacts of a face.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv : (n, 2) array_like
        Parameters of the contacts.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle, of any length.
    skin : Cells or sequence of Face, optional
        The face (the default) with its tangent-continuous neighbours.
    allowance : float
        Stock left on the skin, mm: the depth is counted from there.

    Returns
    -------
    (n,) array, mm: never below the true depth, and at most `RESOLUTION` (and the faces' tolerance) above it;
    for depths beyond 0.1 mm, at most a twentieth of what is beyond.  Coarser, never too low, where 100,000 cells are
    not enough: next to cracks and spikes of the skin.  A sharp corner is taken to dip with both flanks alike, which is
    up to 1.41 times its true depth.

    Notes
    -----
    **Properties**: 1. zero (within the resolution) where the cutter only touches; 2. moves with the part; 3. does not
    see the shank and the holder.
    """
    tips = place(face, tool, uv, axis, allowance)
    return penetration(tool, tips, axis_rows(axis, len(tips)), (face,) if skin is None else skin, allowance=allowance)


def penetration(tool: Tool, tips: ArrayLike, axis: ArrayLike, skin: BoundingTree | Sequence[Face], *,
                allowance: float = 0.0) -> Array:
    """Upper bound of the depth below the skin, for tool tips.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Unit tool axis, tip to spindle.
    skin : Cells or sequence of Face
    allowance : float
        Stock left on the skin, mm.

    Returns
    -------
    (n,) array, mm, zero or more
    """
    return _depth(tool, motions(tips, axis), skin, allowance)


def segment_penetration(tool: Tool, tips: ArrayLike, axis: ArrayLike, skin: BoundingTree | Sequence[Face], *,
                        allowance: float = 0.0) -> Array:
    """Upper bound of the depth below the skin on the straight motions from each tip to the next, (n - 1,) mm.

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n - 1, 3) array_like
        Unit tool axis.
    skin : Cells or sequence of Face
    allowance : float
        Stock left on the skin, mm.
    """
    return _depth(tool, segment_motions(tips, axis), skin, allowance)


def gouges(tool: Tool, tips: ArrayLike, axis: ArrayLike, skin: BoundingTree | Sequence[Face], limit: float) -> Flags:
    """Whether the cutter may reach below the skin deeper than a limit: False is proven, (n,).

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Unit tool axis, tip to spindle.
    skin : Cells or sequence of Face
    limit : float
        mm, above zero; less the allowance where stock is left.

    Raises
    ------
    InvalidInput
        When the limit is not a finite number.
    """
    return _exceeds(tool, motions(tips, axis), skin, limit)


def segment_gouges(tool: Tool, tips: ArrayLike, axis: ArrayLike, skin: BoundingTree | Sequence[Face],
                   limit: float) -> Flags:
    """Whether the cutter may reach deeper than a limit on the motions from each tip to the next, (n - 1,).

    Parameters
    ----------
    tool : Tool
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n - 1, 3) array_like
        Unit tool axis.
    skin : Cells or sequence of Face
    limit : float
        mm, above zero; less the allowance where stock is left.

    Raises
    ------
    InvalidInput
        When the limit is not a finite number.
    """
    return _exceeds(tool, segment_motions(tips, axis), skin, limit)


def least_distance(tool: Tool, depth: float, allowance: float = 0.0) -> float:
    """The signed distance that points of a skin must keep from the cutter so that it does not reach below a depth, mm.

    A sharp corner that dips between two places reaches farther below the skin than any point of the skin lies inside
    the cutter: up to 1.41 times as far below a plane, where both its flanks slope alike.

    Parameters
    ----------
    tool : Tool
    depth : float
        Below the stock that is left, mm.
    allowance : float
        Stock left on the skin, mm.
    """
    below, corner = depth - allowance, tool.corner_radius
    if below <= corner:
        return -below
    wedge = sin((pi / 2 + tool.half_angle) / 2)
    return -(corner + (below - corner) * wedge)


def depth_from_distance(tool: Tool, distance: Array, allowance: float = 0.0) -> Array:
    """How deep the cutter may reach where points of a skin keep a signed distance from it; undoes `least_distance`.

    Parameters
    ----------
    tool : Tool
    distance : array
        mm
    allowance : float
        Stock left on the skin, mm.
    """
    inside, corner = -np.asarray(distance, dtype=float), tool.corner_radius
    wedge = sin((pi / 2 + tool.half_angle) / 2)
    return np.maximum(allowance + np.where(inside <= corner, inside, corner + (inside - corner) / wedge), 0.0)


def _depth(tool: Tool, moves: Array, skin: BoundingTree | Sequence[Face], allowance: float) -> Array:
    cells = skin_cells(skin)
    only = np.tile([0.0, -np.inf, -np.inf], (len(cells.faces), 1))
    found = lower_bounds(cells, tool, moves, allowance, -least_distance(tool, RESOLUTION), only)
    return depth_from_distance(tool, found.lower[:, 0], allowance)


def _exceeds(tool: Tool, moves: Array, skin: BoundingTree | Sequence[Face], limit: float) -> Flags:
    if not np.isfinite(limit):
        raise InvalidInput(f"gouge limit is {limit} mm: it must be a finite number")
    cells = skin_cells(skin)
    required = np.tile([least_distance(tool, limit), -np.inf, -np.inf], (len(cells.faces), 1))
    return keeps_limits(cells, tool, moves, required).blocked >= 0
