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
from toolaxis.numeric.polygons import inside, slabs
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Excess = Callable[[Array], Array]

#: Heights count as left from this multiple of the scallop limit on, and zones where they come to twice the limit.
FACTOR, DEEP = 1.02, 2.0
#: Coarse cells along the longer side, fine ones in each, and the fine cells' size as a share of the cutter's radius.
_COARSE, _FINE, _SHARE = 72, 8, 1 / 14
#: Zones smaller than this share of the cutter's radius squared are no work for anybody.
_SPECK = 1e-3
_TRIES = 5
#: Distances are told up to this multiple of the cutter's radius.
_FAR = 0.05


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
        Takes (n, 2) parameters, beyond the face too, and returns (n,) signed distances, mm: above zero where more than
        that height is left.
    """
    starts, ends = motions_of(path)

    def _excess(uv: Array) -> Array:
        points = face.evaluate(uv).point + height * face.normal(uv)
        return distance_to_removed(tool, path.axis[0], starts, ends, points, _FAR * tool.radius)

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
        The largest first. A zone is what stays higher than `FACTOR` times the limit, where it reaches `DEEP` times.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    The border of a zone is the line on which the surface, raised by that height, meets the swept cutter: exact at the
    vertices, straight between them, which are a fourteenth of the cutter's radius apart or less. Zones inside the
    sub-surface that are smaller than a 72nd of it may be missed; at its border it is looked at closely everywhere.

    **Properties**: 1. zones and machined area are the sub-surface, without overlap.
    """
    if not len(motions_of(path)[0]):
        return (Zone(face.outline, face.area),)
    progress.check()
    high = excess(face, tool, path, allowance + FACTOR * scallop)
    deep = excess(face, tool, path, allowance + DEEP * scallop)
    lines, values = _sampled(face, high, _SHARE * tool.radius)
    found = contours(values, lines, high)
    kept: list[Array] = []
    for loops in grouped(found):
        uv = _places(loops, lines, values)
        if len(uv) and (deep(uv[face.contains(uv)]) > 0).any():
            kept += loops
    progress.check()
    zones = [face.trimmed(loops) for loops in grouped(split(face.outline, tuple(kept))[0])]
    worth = [(zone, area) for zone in zones if (area := zone.area) > _SPECK * tool.radius**2]
    return tuple(Zone(zone.trims, area, _at_wall(zone, walls)) for zone, area in sorted(worth, key=lambda one: -one[1]))


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


def _sampled(face: Face, high: Excess, size: float) -> tuple[tuple[Array, Array], Array]:
    """A grid somewhat beyond the face, and the excess at its nodes; -1 where coarse cells around show none."""
    coarse = [_lines(face, axis, size) for axis in (0, 1)]
    share = np.arange(_FINE) / _FINE
    lines = tuple(np.append((one[:-1, None] + np.diff(one)[:, None] * share).ravel(), one[-1]) for one in coarse)
    nodes = np.stack(np.meshgrid(*coarse, indexing="ij"), axis=-1)
    left = high(nodes.reshape(-1, 2)).reshape(nodes.shape[:2]) > 0
    cells = left[1:, 1:] | left[:-1, 1:] | left[1:, :-1] | left[:-1, :-1]
    on, near = _on(face, coarse), cells.copy()
    for axis in (0, 1):
        rows = np.moveaxis(near, axis, 0)
        rows[:-1] |= np.moveaxis(cells, axis, 0)[1:]
        rows[1:] |= np.moveaxis(cells, axis, 0)[:-1]
    wanted = (near | (on == 1)) & (on > 0)
    fine = np.zeros(tuple(len(line) for line in lines), dtype=bool)
    for i, j in np.argwhere(wanted):
        fine[i * _FINE:(i + 1) * _FINE + 1, j * _FINE:(j + 1) * _FINE + 1] = True
    values = np.full(fine.shape, -1.0)
    at = np.argwhere(fine)
    values[fine] = high(np.column_stack([lines[0][at[:, 0]], lines[1][at[:, 1]]])) if len(at) else 0.0
    return (lines[0], lines[1]), values


def _lines(face: Face, axis: int, size: float) -> Array:
    """Lines of coarse cells along one parameter, one cell farther than the face on both sides."""
    low, high = face.bounds[2 * axis], face.bounds[2 * axis + 1]
    at = np.linspace(*face.bounds[:2], 17), np.linspace(*face.bounds[2:], 17)
    points = face.evaluate(np.stack(np.meshgrid(*at, indexing="ij"), axis=-1).reshape(-1, 2)).point.reshape(17, 17, 3)
    length = float(np.linalg.norm(np.diff(points, axis=axis), axis=-1).sum(axis=axis).max())
    count = int(np.clip(np.ceil(length / (_FINE * size)), 4, _COARSE))
    pitch = (high - low) / (count - 0.137)
    return np.asarray(low - 1.0637 * pitch + pitch * np.arange(count + 3))


def _on(face: Face, coarse: list[Array]) -> NDArray[np.int8]:
    """Whether coarse cells hold nothing of the face (0), its border (1), or lie on it (2)."""
    nodes = np.stack(np.meshgrid(*coarse, indexing="ij"), axis=-1)
    inside = face.contains(nodes.reshape(-1, 2)).reshape(nodes.shape[:2])
    corners = np.stack([inside[1:, 1:], inside[:-1, 1:], inside[1:, :-1], inside[:-1, :-1]])
    found = np.where(corners.all(axis=0), 2, 0).astype(np.int8)
    found[corners.any(axis=0) & ~corners.all(axis=0)] = 1
    for loop in face.outline:
        ends = np.roll(loop, -1, axis=0)
        pitch = np.array([np.diff(one)[0] for one in coarse])
        parts = np.maximum(np.ceil((np.abs(ends - loop) / pitch).max(axis=1) * 4), 1).astype(int)
        share = np.concatenate([np.arange(n) / n for n in parts])[:, None]
        rows = np.repeat(loop, parts, axis=0) * (1 - share) + np.repeat(ends, parts, axis=0) * share
        cell = [np.clip(np.searchsorted(coarse[k], rows[:, k], side="right") - 1, 0, len(coarse[k]) - 2)
                for k in (0, 1)]
        found[cell[0], cell[1]] = 1
    return found


def _places(loops: tuple[Array, ...], lines: tuple[Array, Array], values: Array) -> Array:
    """Nodes of the grid inside a polygon that are above zero, (n, 2)."""
    at = np.argwhere(values > 0)
    uv = np.column_stack([lines[0][at[:, 0]], lines[1][at[:, 1]]])
    return uv[inside(slabs(loops), uv)] if len(uv) else uv


def _at_wall(zone: Face, walls: Callable[[Array], Bools] | None) -> bool:
    if walls is None:
        return True
    uv = zone.grid(12, 12)
    return bool(walls(np.concatenate([uv, *(loop[::5] for loop in zone.trims)])).any())
