"""Paths around a blade that were made elsewhere, with their tool angles re-scheduled: cutter centres stay in place."""

from dataclasses import dataclass
from itertools import pairwise
from math import asin, degrees, pi, radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.blade.schedule import CLEARANCE, Layer, ScheduledLayer, SwivelAxis, reschedule
from toolaxis.strategies.blade.section import base_of, section
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Greatest angle by which axes of a four-axis path leave their common cone, rad.
CONE = radians(1.0)
#: Tangents may miss a whole turn by this much where a turn around the blade ends, rad.
_TURNED = 0.8
#: Steps shorter than this are none, mm.
_NO_STEP = 1e-9


@dataclass(frozen=True, eq=False)
class RescheduledPath:
    """A path with new tool angles.

    Attributes
    ----------
    path : ToolPath
        With the old cutter centres; kinds and breaks stay.
    layers : tuple of ScheduledLayer
        Its whole turns around the blade.
    swing : SwivelAxis
    """

    path: ToolPath
    layers: tuple[ScheduledLayer, ...]
    swing: SwivelAxis


def swing_of_path(path: ToolPath, direction: ArrayLike | None = None) -> SwivelAxis:
    """The rotary axis that the tool axes of a path turn about.

    Parameters
    ----------
    path : ToolPath
    direction : (3,) array_like, optional
        That axis; found from the tool axes unless given.

    Raises
    ------
    InvalidInput
        When the tool axes do not move, or lie on no cone around one direction.
    """
    axes = np.asarray(unit(path.axis[path.kind == Motion.CUT]))
    if not len(axes):
        raise InvalidInput("the CL data has no cutting motion: nothing can be re-scheduled")
    if direction is None:
        spread = axes - axes.mean(axis=0)
        _, sizes, rows = np.linalg.svd(spread, full_matrices=False)
        if sizes[min(1, len(sizes) - 1)] < 1e-3 * np.sqrt(len(axes)):
            raise InvalidInput("the CL data tells no tool axes that move, or only one: write it with i,j,k "
                               "(MULTAX/ON), or give the direction of the rotary axis")
        along = rows[-1]
    else:
        along = np.asarray(unit(as_rows(direction, 3, "direction of the rotary axis")[0]))
    lean = np.arcsin(np.clip(axes @ along, -1.0, 1.0))
    mean = asin(float(np.clip(np.median(axes @ along), -1.0, 1.0)))
    off = float(np.abs(lean - mean).max())
    if direction is None and off > CONE:
        raise InvalidInput(f"tool axes of the CL data leave their common cone by {degrees(off):.1f} deg: one rotary "
                           "axis does not make them; give the direction of the one that shall turn")
    return SwivelAxis(along, mean)


def reschedule_path(path: ToolPath, tool: Tool, *, curve: str = "least", clearance: float = CLEARANCE,
                    direction: ArrayLike | None = None, progress: Progress = NO_PROGRESS) -> RescheduledPath:
    """Give a path around a blade new tool angles.

    Parameters
    ----------
    path : ToolPath
        Cuts around a blade, in a helix or to and fro, with a ball end.
    tool : Tool
        With a ball end; its taper, shank and holder keep clear of each turn's own section.
    curve : str
        "least" or "keys".
    clearance : float
        Of tool angles from their limits, rad.
    direction : (3,) array_like, optional
        The rotary axis; that of the path's own tool axes unless given.
    progress : Progress

    Returns
    -------
    RescheduledPath
        Entries, exits and links take the axis of the cut beside them; what stands around is not looked at.

    Raises
    ------
    InvalidInput
        When the tool has no ball end, the axes are none of four-axis milling, or a cut does not go around once.

    Notes
    -----
    A helix is divided at the base points of its turns; what comes before the first one and after the last one follows
    the turn beside it.

    **Source**: [stheta2023] Eq. (1) and Sec. 2.2.

    **Properties**: 1. cutter centres stay; 2. the rotary axis does not turn back within a cut around.
    """
    if tool.flat_radius > 0:
        raise InvalidInput(f"tool {tool.name} has no ball end: only a ball's centre stays where its axis turns")
    swing = swing_of_path(path, direction)
    centre = path.cl + tool.corner_radius * np.asarray(unit(path.axis))
    flat = swing.flat(centre)
    cuts = _cuts(path, flat)
    pieces = [(rows, _turns(flat[rows], k + 1)) for k, rows in enumerate(cuts)]
    layers = [Layer(centre[rows[a:b + 1]]) for rows, ends in pieces for a, b in pairwise(ends)]
    found = reschedule(layers, swing, tool, curve=curve, clearance=clearance, progress=progress)
    theta, left = np.full(len(centre), np.nan), list(found)
    for rows, ends in pieces:
        own = [left.pop(0) for _ in ends[:-1]]
        theta[rows] = _along(flat[rows], ends, own)
    axes = np.full(path.axis.shape, np.nan)
    known = np.isfinite(theta)
    axes[known] = swing.axes(theta[known])
    axes = axes[_beside(path, known)]
    tips = centre - tool.corner_radius * axes
    free = (path.cc == path.cl).all(axis=1)
    contact, normal = np.where(free[:, None], tips, path.cc), np.where(free[:, None], axes, path.normal)
    return RescheduledPath(ToolPath(contact, tips, axes, normal, path.kind, path.breaks), found, swing)


def _cuts(path: ToolPath, flat: Array) -> list[NDArray[np.intp]]:
    """Points of each cut, the one from which it comes first, without repeated ones."""
    arrives = np.flatnonzero(path.kind == Motion.CUT)
    runs = np.split(arrives, np.flatnonzero(np.diff(arrives) > 1) + 1)
    found = []
    for run in runs:
        rows = np.concatenate([[max(run[0] - 1, 0)], run])
        step = np.hypot(*np.diff(flat[rows], axis=0).T)
        found.append(rows[np.concatenate([[True], step > _NO_STEP])])
    return found


def _turns(flat: Array, number: int) -> list[int]:
    """Points of a cut at which turns around the blade begin and end."""
    first = _end_of_turn(flat, 0)
    if first is None:
        raise InvalidInput(f"cut {number} does not go around the blade: its section is open, from "
                           f"{np.round(flat[0], 2).tolist()} to {np.round(flat[-1], 2).tolist()} across the rotary "
                           "axis")
    second = _end_of_turn(flat, first)
    if second is None and first >= len(flat) - 2:
        return [0, len(flat) - 1]
    begin = _base(flat[:first])
    ends = [begin] if _end_of_turn(flat, begin) is not None else [0]
    while (after := _end_of_turn(flat, ends[-1])) is not None:
        ends.append(after)
    return ends


def _base(flat: Array) -> int:
    """The base point among the points of one turn."""
    x, y = flat.T
    onward = float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) > 0
    base = base_of(section(flat))
    return base if onward else (len(flat) - base) % len(flat)


def _end_of_turn(flat: Array, begin: int) -> int | None:
    """The point at which a turn around the blade ends that begins at another; None where it does not end."""
    rows = flat[begin:]
    if len(rows) < 8:
        return None
    step = np.diff(rows, axis=0)
    tangent = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    turned = np.abs(tangent - tangent[0])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*step.T))])
    there = np.flatnonzero(np.append(turned, turned[-1]) > 2 * pi - _TURNED)
    if not len(there):
        return None
    some = there[way[there] <= 1.5 * way[there[0]]]
    away = np.hypot(*(rows[some] - rows[0]).T)
    best = int(some[np.argmin(away)])
    return begin + best if away.min() <= 0.05 * way[best] else None


def _along(flat: Array, ends: list[int], layers: list[ScheduledLayer]) -> Array:
    """Tool angles at the points of a cut, whole turns and what is beside them."""
    theta = np.empty(len(flat))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(flat, axis=0).T))])
    for a, b, one in zip(ends[:-1], ends[1:], layers, strict=True):
        shift = 0.0 if a == ends[0] else theta[a] - one.theta[0]
        theta[a:b + 1] = one.theta + shift
    beside = (slice(0, ends[0]), layers[0], ends[0]), (slice(ends[-1] + 1, None), layers[-1], ends[-1])
    for span, one, joint in beside:
        before = joint == ends[0] and span.stop is not None
        off = way[span] - way[joint]
        length = one.section.length
        place = length + off if before else off  # of the turn beside, on the path's way
        place = np.clip(place if one.onward else length - place, 0.0, length)
        rows = one.curve.at(place)[0]
        level = one.end if before == one.onward else one.start
        theta[span] = rows - level + theta[joint]
    return theta


def _beside(path: ToolPath, known: NDArray[np.bool_]) -> NDArray[np.intp]:
    """For each point the one whose axis it takes: itself, the next cut's for entries, the last one's else."""
    count = len(known)
    at = np.arange(count)
    known_or_first = np.where(known, at, -1)
    known_or_end = np.where(known, at, count)
    last = np.maximum.accumulate(known_or_first)
    after = np.minimum.accumulate(known_or_end[::-1])[::-1]
    onward = ((path.kind == Motion.ENTRY) | (last < 0)) & (after < count)
    neighbour = np.where(onward, after, np.maximum(last, 0))
    return np.where(known, at, neighbour)
