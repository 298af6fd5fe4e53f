"""What stands in the way of a tool at given positions: which face, with what part of the tool, and by how much."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import DistanceBounds, keeps_limits, lower_bounds, motions
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import CUTTER, FREE, GOUGE, Violations
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: How far below the true distance bounds may lie, mm: for the skin, and for everything else.
FINE, COARSE = 0.0003, 0.002
#: Edges of the cubes in which positions are first decided together, in radii of the tool; how many positions a cube
#: must hold on average for that.
_BLOCKS, _WORTH = (0.8, 0.2, 0.05), 4
#: Depths are bounded to this share of themselves and a little more, see
#: `toolaxis.contact.clearance.queries.lower_bounds`.
_DEPTH_SHARE = 0.06


class InterferenceScene(NamedTuple):
    """A tool at a face: the face's numbers, the tool, the groups around, and the faces that continue the face."""

    numbers: tuple[int, ...]
    tool: Tool
    groups: tuple[CheckSurfaces, ...]
    neighbours: tuple[Face, ...]


def trouble_at(scene: InterferenceScene, places: Array, axis: Array, near: Bools,
               asked: tuple[bool, tuple[str, ...]]) -> Violations:
    """What is worst at each position.

    Parameters
    ----------
    scene : InterferenceScene
    places : (n, 3) array
        Tool tips, mm.
    axis : (3,) array
    near : (n, k) bool
        Which walls are near, as in `toolaxis.feasibility.check_points.CheckPoints`.
    asked : bool, tuple of str
        Whether gouges of the skin are looked for too; the groups that are looked at.
    """
    thorough, roles = asked
    moves, n = motions(places, axis), len(places)
    worst = Violations(np.zeros(n, dtype=np.int8), np.zeros(n), np.zeros(n, dtype=bool), np.zeros(n, dtype=np.int64),
                       np.zeros(n, dtype=np.int64), np.zeros((n, 3)))
    first = 0  # of the walls in `near`, which go from group to group
    for number, group in enumerate(scene.groups):
        if group.role not in roles:
            continue
        fine = FINE if group.role != OTHER else COARSE
        left_out = None if thorough or group.role != SKIN else np.tile([-np.inf, 0.0, 0.0], (len(group.faces), 1))
        tool = _extend_tool(scene.tool, places, axis, group) if group.role == OTHER else scene.tool
        found = lower_bounds(group.cells, tool, moves, group.required + 2 * fine, fine, left_out)
        beside = np.zeros(n, dtype=bool)
        if group.role == OTHER and len(near):
            beside = _beside(tool, group, moves, (found, near[:, first:first + len(group.faces)]))
            first += len(group.faces)
        elif len(near) and scene.neighbours:
            continued = near[:, -len(scene.neighbours):].any(axis=1)
            hit = np.asarray(continued & (found.lower < group.required).any(axis=1))
            beside = _into_neighbours(scene, group, moves, hit, left_out) if group.role == SKIN else hit
        worst = _worse(worst, found, (group, number), beside)
    return worst


def stands_free(scene: InterferenceScene, places: Array, axis: Array, asked: tuple[bool, tuple[str, ...]]) -> Bools:
    """Whether the tool keeps its distances from some groups at positions, (n,).

    Parameters
    ----------
    scene : InterferenceScene
    places : (n, 3) array
        Tool tips, mm.
    axis : (3,) array
    asked : bool, tuple of str
        Whether the face itself is looked at; the groups that are looked at.
    """
    itself, roles = asked
    free = np.ones(len(places), dtype=bool)
    for group in scene.groups:
        if group.held is not None and group.role in roles:
            free &= group.held.depth(places) <= 0
        some = np.flatnonzero(free)
        if group.role in roles and len(some):
            tool = _extend_tool(scene.tool, places, axis, group) if group.role == OTHER else scene.tool
            required = np.tile(group.required, (len(group.faces), 1))
            if not itself and group.role == SKIN:  # obstacles have numbers of their own
                required[[face.number in scene.numbers for face in group.faces]] = -np.inf
            free[some] = _keeps_distances(group, tool, places[some], axis, required)
    return free


def _keeps_distances(group: CheckSurfaces, tool: Tool, places: Array, axis: Array, required: Array) -> Bools:
    """Whether the tool keeps its distances at positions, (n,): those close together are decided together if they can.

    A distance changes by no more than the tip moves: what the tool keeps at the centre of a ball, and its radius more,
    it keeps at every tip in the ball.
    """
    kept, rest = np.zeros(len(places), dtype=bool), np.arange(len(places))
    for size in _BLOCKS:
        if len(rest) < _WORTH:
            break
        block, count = _blocks(places[rest], size * tool.radius)
        if count * _WORTH > len(rest):
            continue
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, block, places[rest])
        np.maximum.at(high, block, places[rest])
        radius = float(np.linalg.norm(high - low, axis=1).max()) / 2
        found = keeps_limits(group.cells, tool, motions((low + high) / 2, axis), required + radius)
        done = found.blocked[block] < 0
        kept[rest[done]], rest = True, rest[~done]
    if len(rest):
        kept[rest] = keeps_limits(group.cells, tool, motions(places[rest], axis), required).blocked < 0
    return kept


def _blocks(places: Array, size: float) -> tuple[NDArray[np.intp], int]:
    """Which cube of a lattice each place lies in, and how many cubes are taken."""
    cube = np.floor((places - places.min(axis=0)) / size).astype(np.int64)
    span = cube.max(axis=0, initial=0) + 1
    found, block = np.unique((cube[:, 0] * span[1] + cube[:, 1]) * span[2] + cube[:, 2], return_inverse=True)
    return block, len(found)


def _extend_tool(tool: Tool, places: Array, axis: Array, group: CheckSurfaces) -> Tool:
    """The tool as far up as what stands around: it is drawn back along its axis, and the spindle is above it.

    What is above all that stands there changes no distance: a few lengths do for all axes.
    """
    highest = float(np.maximum(*(group.box * axis)).sum())
    needed = highest - float((places @ axis).min())
    if needed <= tool.height:
        return tool
    return _height_to_extend(tool, float(tool.height * 2.0 ** np.ceil(np.log2(needed / tool.height))))


@lru_cache(maxsize=64)
def _height_to_extend(tool: Tool, height: float) -> Tool:
    return tool.carried_on(height)


def _into_neighbours(scene: InterferenceScene, group: CheckSurfaces, moves: Array, hit: Bools,
                     left_out: Array | None) -> Bools:
    """Which of the positions that were hit are so by faces that continue this one alone, as a boss's fillet."""
    into, rows = hit.copy(), np.flatnonzero(hit)
    if len(rows):
        only = np.full((len(group.faces), 3), -np.inf)
        own = [face.number in scene.numbers for face in group.faces]
        only[own] = 0.0 if left_out is None else left_out[own]
        found = lower_bounds(group.cells, scene.tool, moves[rows], group.required + 2 * FINE, FINE, only)
        into[rows] = (found.lower >= group.required).all(axis=1)
    return into


def _beside(tool: Tool, group: CheckSurfaces, moves: Array, at: tuple[DistanceBounds, Bools]) -> Bools:
    """Which of the positions come too near to a wall that is near them."""
    found, near = at
    amount = group.required - found.lower
    hit = (amount > 0).any(axis=1)
    # The nearest face is too near itself where that does not hang on how exactly distances are bounded.
    row, component = np.nonzero(amount > 2 * COARSE + _DEPTH_SHARE * np.maximum(-found.lower, 0.0))
    face = found.face[row, component]
    beside = np.zeros(len(moves), dtype=bool)
    beside[row[(face >= 0) & near[row, face]]] = True
    for k in np.flatnonzero(near[hit & ~beside].any(axis=0)):
        rows = np.flatnonzero(hit & near[:, k] & ~beside)
        if len(rows):
            only = np.full((len(group.faces), 3), -np.inf)
            only[k] = 0.0
            alone = lower_bounds(group.cells, tool, moves[rows], group.required + 2 * COARSE, COARSE, only)
            beside[rows] = (alone.lower < group.required).any(axis=1)
    return beside


def _worse(worst: Violations, found: DistanceBounds, which: tuple[CheckSurfaces, int], wall: Bools) -> Violations:
    """Merge in what one group does; a contact left as rest material is not visited, whatever else is there."""
    group, number = which
    for c in range(3):
        amount = group.required[c] - found.lower[:, c]
        hit = amount > 0
        before = worst.reason != FREE
        take = hit & (~before | (wall & ~worst.wall) | ((worst.wall == wall) & (amount > worst.amount)))
        code = GOUGE if group.role == SKIN and c == 0 else CUTTER + c
        point = np.where(take[:, None], found.point[:, c], worst.point)
        worst = Violations(np.where(take, code, worst.reason).astype(np.int8), np.where(take, amount, worst.amount),
                           np.where(take, wall, worst.wall), np.where(take, found.face[:, c], worst.face),
                           np.where(take, number, worst.group), point)
    return worst
