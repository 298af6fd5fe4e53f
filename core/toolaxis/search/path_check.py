"""The last word on an axis: every motion of the passes really made, judged by bounds that hold along it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.gouge import depth_from_distance
from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, segment_motions
from toolaxis.feasibility.interference import COARSE, FINE
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import CUTTER, GOUGE, Violation
from toolaxis.numeric.rounding import round_significant
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.messages import place
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

COMPONENTS = ("cutter", "shank", "holder")
_BATCH = 400
#: Every so manyth motion is measured first: the deepest of them leaves the others little to tell.
_STRIDE = 97
#: Resolution of reported clearances, mm.
_ROUGH = 0.005
#: How far the nearest face of a motion is looked for that turns out to keep its distances, mm.
_FAR = 50.0
#: Share of the motions up to which those that break a limit are worth being left out.
FEW = 0.02


@dataclass(frozen=True, eq=False)
class PathCheck:
    """What is known of a path.

    Attributes
    ----------
    witness : Violation or None
        The first motion that breaks a limit; None when every motion keeps them all.
    gouge : float
        Upper bound of the depth below the skin and below the faces behind its convex edges, mm.
    clearance : dict of str to float
        Lower bound per component that is known, mm; the cutter's is to what it does not machine or touch harmlessly.
    blocked : (k,) array of int
        All motions that are not proven to keep every limit, where they are few; empty where they are many.
    """

    witness: Violation | None
    gouge: float = 0.0
    clearance: dict[str, float] = field(default_factory=dict)
    blocked: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, dtype=np.intp))


def prove(path: ToolPath, tool: Tool, groups: tuple[CheckSurfaces, ...], allowance: float = 0.0, *, most: float = 20.0,
          progress: Progress = NO_PROGRESS) -> PathCheck:
    """Judge every motion of a path with one fixed axis.

    Measuring ends with what is known where a motion needs too many cells, and may then fall short of what deciding has
    proven before: figures are never worse than the distances to keep.

    Parameters
    ----------
    path : ToolPath
    tool : Tool
    groups : tuple of CheckSurfaces
        From `toolaxis.feasibility.surroundings.group_surroundings`, with the distances to keep.
    allowance : float
        Stock left on the skin, mm.
    most : float
        Clearances beyond this are not told apart, mm.
    progress : Progress

    Returns
    -------
    PathCheck

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    moves = segment_motions(path.cl, path.axis[0])
    links = np.flatnonzero(path.kind[1:] == Motion.LINK)
    witness, blocked = None, np.zeros(len(moves), dtype=bool)
    for number, group in enumerate(groups):
        progress.report("proof", number, 2 * len(groups))
        rows = _find_blocked(tool, group, moves, group.required)
        into = links[_find_blocked(tool, group, moves[links], group.required_on_links)] if group.stock > 0 else rows[:0]
        if not len(rows) and not len(into):
            continue
        blocked[rows], blocked[into] = True, True
        if witness is None and len(rows):
            witness = worst_motion(tool, group, moves[rows], group.required, group.required)
        elif witness is None:
            witness = link_into_stock(tool, group, moves[into])
        if blocked.sum() > FEW * len(moves):
            return PathCheck(witness)
    if witness is not None:
        return PathCheck(witness, blocked=np.flatnonzero(blocked))
    gouge = 0.0
    clearance: dict[str, float] = {}
    known = {"cutter", *tool.outlines}
    for number, group in enumerate(groups):
        progress.report("proof", len(groups) + number, 2 * len(groups))
        if group.role != OTHER:
            gouge = max(gouge, greatest_depth(tool, group, moves, allowance if group.role == SKIN else 0.0))
        asked = tuple(c for c, name in enumerate(COMPONENTS) if name in known and (c > 0 or group.role == OTHER))
        for c, value in _least(tool, group, moves, asked, most).items():
            name = COMPONENTS[c]
            clearance[name] = min(clearance.get(name, most), max(value, float(group.required[c])))
    return PathCheck(None, gouge, clearance)


def greatest_depth(tool: Tool, group: CheckSurfaces, moves: Array, allowance: float) -> float:
    """Upper bound of the depth below a group of which motions are proven to keep their distance, mm.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
    moves : (n, 3, 3) array
        Motions, as `segment_motions` gives them.
    allowance : float
        Stock left on the group, mm.
    """
    spread = np.arange(0, len(moves), _STRIDE)
    order = np.concatenate([spread, np.setdiff1d(np.arange(len(moves)), spread)])
    nearest = _bound_least(tool, group, moves[order], (0,), allowance + 2 * FINE, FINE)[0]
    return float(depth_from_distance(tool, np.maximum(nearest, group.required[0]), allowance))


def _only(group: CheckSurfaces, components: tuple[int, ...]) -> Array:
    """Required table that asks for some components only, (faces, 3)."""
    row = np.full(3, -np.inf)
    row[list(components)] = 0.0
    return np.tile(row, (len(group.faces), 1))


def _find_blocked(tool: Tool, group: CheckSurfaces, moves: Array, required: Array) -> NDArray[np.intp]:
    """The motions that are not proven to keep distances (3,) from a group."""
    found = keeps_limits(group.cells, tool, moves, np.tile(required, (len(group.faces), 1)))
    return np.flatnonzero(found.blocked >= 0)


def link_into_stock(tool: Tool, group: CheckSurfaces, moves: Array) -> Violation:
    """The worst of links at rapid traverse of which the cutter is not proven to stay clear of a group's stock.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
        With stock.
    moves : (n, 3, 3) array
        At least one.
    """
    required = np.array([group.required_on_links[0], -np.inf, -np.inf])
    found = worst_motion(tool, group, moves, required, np.maximum(required, 0.0))
    which = f"face {found.label}" if found.label else "what stands around"
    at = f" at {place(found.point)}" if np.isfinite(found.point).all() else ""
    words = f"a rapid move is not proven to clear the stock of {group.stock:g} mm on {which}{at}"
    return found._replace(reason=CUTTER, words=words)


def worst_motion(tool: Tool, group: CheckSurfaces, moves: Array, required: Array, cutoff: Array) -> Violation:
    """The worst of motions that were not proven to keep their distances from a group.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
    moves : (n, 3, 3) array
        At least one.
    required : (3,) array
        Distances to keep, mm; -inf for components that are not asked for.
    cutoff : (3,) array
        Distances beyond which motions are not told apart, mm.

    Notes
    -----
    A motion that lies so near to its limit that deciding gave it up may turn out to keep it when it is measured: of
    that the nearest face is named all the same.
    """
    fine = FINE if group.role != OTHER else COARSE
    asked = np.array([name == "cutter" or name in tool.outlines for name in COMPONENTS]) & ~np.isneginf(required)
    table = np.tile(np.where(asked, 0.0, -np.inf), (len(group.faces), 1))
    found = lower_bounds(group.cells, tool, moves, cutoff + 2 * fine, fine, table)
    amount = np.where(asked, required - found.lower, -np.inf)
    i, c = (int(k) for k in np.unravel_index(int(np.argmax(round_significant(amount))), amount.shape))
    if found.face[i, c] < 0:
        found, i = lower_bounds(group.cells, tool, moves[[i]], _FAR, fine, table), 0
    k = int(found.face[i, c])
    missed = max(float(required[c] - found.lower[i, c]), 0.0)
    code = GOUGE if group.role == SKIN and c == 0 else CUTTER + c
    if k < 0:
        return Violation(code, missed)
    return Violation(code, missed, group.faces[k].label, found.point[i, c], distance=float(found.lower[i, c]))


def _least(tool: Tool, group: CheckSurfaces, moves: Array, components: tuple[int, ...], most: float) -> dict[int,
                                                                                                             float]:
    """Least distance of components to a group over all motions, at most `_ROUGH` too small; `most` where it is more."""
    if not components:
        return {}
    lowest_first = np.argsort(round_significant(moves[:, 0] @ moves[0, 2]), kind="stable")
    found = _bound_least(tool, group, moves[lowest_first], components, most + _ROUGH, _ROUGH)
    return {c: float(found[c]) for c in components}


def _bound_least(tool: Tool, group: CheckSurfaces, moves: Array, components: tuple[int, ...], most: float,
                 resolution: float) -> Array:
    """Lower bounds (3,) of the least distance of components to a group over all motions, up to `most`.

    Only what comes nearer than all before is told exactly: motions that are likely to come near belong first.
    """
    asked, best = _only(group, components), np.full(3, most)
    for first in range(0, len(moves), _BATCH):
        least = lower_bounds(group.cells, tool, moves[first:first + _BATCH], best, resolution, asked).lower.min(axis=0)
        best = np.where(least < best - resolution, least, best)
    return np.asarray(best - resolution)
