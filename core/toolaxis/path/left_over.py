"""Zones of a sub-surface that its passes leave higher than the scallop limit, as closed loops with their area."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.removed import distance_to_removed
from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import grouped
from toolaxis.numeric.contours import contours
from toolaxis.numeric.overlay import divided, without
from toolaxis.path.left_grid import sampled
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Excess = Callable[[Array], Array]

#: Heights count as left from this multiple of the scallop limit on.
FACTOR = 1.02
#: Zones that do not come to this multiple of the limit, or are smaller than this share of the cutter's radius squared,
#: are no work for anybody, unless they are more than this share of the face together: half of what the judge overlooks.
DEEP, _SPECK, OVERLOOKED = 2.0, 1e-3, 5e-4
#: Size of the cells that outline zones, as shares of the cutter's radius, of the narrowest strip that it may leave, and
#: of a square as large as the face.
_OF_RADIUS, _OF_STRIP, _OF_FACE = 1 / 14, 1 / 20, 1 / 200
_TRIES = 5
#: Distances are told up to this, mm: only their signs are asked for.
_FAR = 1e-3


def motions_of(path: ToolPath) -> tuple[Array, Array]:
    """Tips at the start and the end of every cutting motion, (m, 3) each.

    Parameters
    ----------
    path : ToolPath
    """
    at = np.flatnonzero(path.kind[1:] == Motion.CUT)
    return path.cl[at], path.cl[at + 1]


def excess(face: Face, tool: Tool, path: ToolPath, height: float) -> Excess:
    """By how much points at a height above a face stay outside of what the passes remove.

    Parameters
    ----------
    face : Face
    tool : Tool
    path : ToolPath
        With one fixed axis.
    height : float
        Above the face, allowance included, mm.

    Returns
    -------
    callable
        Takes (n, 2) parameters, beyond the face too, and returns (n,) numbers: above zero where more than that height
        is left.
    """
    starts, ends = motions_of(path)

    def _excess(uv: Array) -> Array:
        points = face.evaluate(uv).point + height * face.normal(uv)
        return distance_to_removed(tool, path.axis[0], starts, ends, points, _FAR, 0.0)

    return _excess


def left_over(face: Face, tool: Tool, path: ToolPath, scallop: float, allowance: float = 0.0,
              walls: Callable[[Array], Bools] | None = None, progress: Progress = NO_PROGRESS) -> tuple[Zone, ...]:
    """Zones that the passes leave higher than the scallop limit.

    Parameters
    ----------
    face : Face
        The sub-surface.
    tool : Tool
    path : ToolPath
        With one fixed axis; its cutting motions count.
    scallop : float
        Limit of the scallop height, mm.
    allowance : float
        Stock left on the face, mm.
    walls : callable, optional
        Takes (n, 2) parameters and tells where the tool may not stand; all zones lie at walls unless given.
    progress : Progress

    Returns
    -------
    tuple of Zone
        The largest first. A zone is what stays higher than `FACTOR` times the limit; small and shallow ones are left
        out while they are less than `OVERLOOKED` of the face together.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    The border of a zone is the line on which the surface, raised by that height, meets the swept cutter: exact at the
    vertices, straight between them, which are a fourteenth of the cutter's radius apart or less. Zones inside the
    sub-surface that lie between the nodes of a coarse grid may be missed; at its border it is looked at closely
    everywhere, and where something is found, as far as it goes.

    **Properties**: 1. zones and machined area are the sub-surface, without overlap.
    """
    if not len(motions_of(path)[0]):
        return (Zone(face.outline, face.area),)
    progress.check()
    high = excess(face, tool, path, allowance + FACTOR * scallop)
    deep = excess(face, tool, path, allowance + DEEP * scallop)
    lines, values = sampled(face, high, _size(face, tool, scallop))
    nodes = _above(lines, values)
    if not len(nodes):
        return ()
    progress.check()
    found = contours(values, lines, high)
    progress.check()
    zones = [face.trimmed(loops) for loops in grouped(split(face.outline, found)[0])]
    measured = sorted(((zone, zone.area) for zone in zones), key=lambda one: -one[1])
    small = [area <= _SPECK * tool.radius**2 or not _deep(zone, deep, nodes) for zone, area in measured]
    overlooked = sum(area for (_, area), one in zip(measured, small, strict=True) if one)
    if overlooked <= OVERLOOKED * face.area:
        measured = [one for one, less in zip(measured, small, strict=True) if not less]
    return tuple(Zone(zone.trims, area, _at_wall(zone, walls)) for zone, area in measured)


def split(outline: tuple[Array, ...], loops: tuple[Array, ...]) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """What of an outline lies inside loops, and the rest; loops are moved by rounding where corners coincide.

    Parameters
    ----------
    outline, loops : tuple of (m, 2) arrays
    """
    size = np.ptp(np.concatenate(outline), axis=0)
    for attempt in range(_TRIES):
        shift = attempt * 3e-10 * size * np.array([1.0, 0.61803398875])
        try:
            return divided(outline, tuple(loop + shift for loop in loops))
        except InvalidInput:
            continue
    raise InvalidInput("zones cannot be cut out of the face: their borders coincide with its own")


def also_machined(face: Face, zone: Zone, others: list[Excess]) -> Zone:
    """A zone with the area of it that other operations machine.

    Parameters
    ----------
    face : Face
    zone : Zone
    others : list of callable
        From `excess`, one an operation.
    """
    piece = face.trimmed(zone.loops)
    uv = piece.grid(48, 48)
    if not others or not len(uv):
        return zone
    d = face.evaluate(uv)
    weight = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    free = np.min([other(uv) for other in others], axis=0) <= 0
    return replace(zone, elsewhere=float(zone.area * weight[free].sum() / max(weight.sum(), np.finfo(float).tiny)))


def machined(face: Face, zones: tuple[Zone, ...]) -> tuple[Face, ...]:
    """A sub-surface without its zones, as pieces.

    Parameters
    ----------
    face : Face
    zones : tuple of Zone
        Of this very sub-surface.
    """
    loops: tuple[Array, ...] = face.outline
    for zone in zones:
        loops = without(loops, zone.loops)
    return tuple(face.trimmed(one) for one in grouped(loops))


def _size(face: Face, tool: Tool, scallop: float) -> float:
    """Size of the cells that outline zones, mm: passes leave pieces as narrow as the ends of their strips."""
    strip = 2 * np.sqrt(2 * (tool.corner_radius or tool.radius) * scallop)
    return float(min(_OF_RADIUS * tool.radius, _OF_STRIP * strip, _OF_FACE * np.sqrt(face.area)))


def _above(lines: tuple[Array, Array], values: Array) -> Array:
    """Nodes of the grid that are above zero, (n, 2)."""
    at = np.argwhere(values > 0)
    return np.column_stack([lines[0][at[:, 0]], lines[1][at[:, 1]]])


def _deep(zone: Face, deep: Excess, nodes: Array) -> bool:
    """Whether a zone comes to `DEEP` times the limit at its border or at nodes, (n, 2), of the grid."""
    u0, u1, v0, v1 = zone.bounds
    near = nodes[(nodes[:, 0] >= u0) & (nodes[:, 0] <= u1) & (nodes[:, 1] >= v0) & (nodes[:, 1] <= v1)]
    return bool((deep(np.concatenate([near[zone.contains(near)], *zone.trims])) > 0).any())


def _at_wall(zone: Face, walls: Callable[[Array], Bools] | None) -> bool:
    if walls is None:
        return True
    uv = zone.grid(12, 12)
    return bool(walls(np.concatenate([uv, *(loop[::5] for loop in zone.trims)])).any())
