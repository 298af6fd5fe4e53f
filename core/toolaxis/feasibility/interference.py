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
    n = len(places)
    moves = motions(places, axis)
    worst = _nothing_wrong(n)
    first = 0  # of the walls in `near`, which go from group to group
    for number, group in enumerate(scene.groups):
        if group.role not in roles:
            continue
        fine = FINE
        left_out = None
        tool = scene.tool
        if group.role == OTHER:
            fine = COARSE
            tool = _extend_tool(scene.tool, places, axis, group)
        elif group.role == SKIN and not thorough:
            left_out = np.tile([-np.inf, 0.0, 0.0], (len(group.faces), 1))
        found = lower_bounds(group.cells, tool, moves, group.required + 2 * fine, fine, left_out)
        beside = np.zeros(n, dtype=bool)
        if len(near) and group.role == OTHER:
            after = first + len(group.faces)
            beside = _beside(tool, group, moves, found, near[:, first:after])
            first = after
        elif len(near) and scene.neighbours:
            beside = _at_neighbours(scene, group, moves, found, near, left_out)
        worst = _worse(worst, found, group, number, beside)
    return worst


def _nothing_wrong(n: int) -> Violations:
    """The verdict on n positions of which nothing is known yet."""
    reason = np.zeros(n, dtype=np.int8)
    amount = np.zeros(n)
    wall = np.zeros(n, dtype=bool)
    face = np.zeros(n, dtype=np.int64)
    group = np.zeros(n, dtype=np.int64)
    point = np.zeros((n, 3))
    return Violations(reason, amount, wall, face, group, point)


def _at_neighbours(scene: InterferenceScene, group: CheckSurfaces, moves: Array, found: DistanceBounds, near: Bools,
                   left_out: Array | None) -> Bools:
    """Which of the positions are near faces that continue this one, and come too near to the group because of it."""
    continued = near[:, -len(scene.neighbours):].any(axis=1)
    too_near = (found.lower < group.required).any(axis=1)
    hit = np.asarray(continued & too_near)
    if group.role != SKIN:
        return hit
    return _into_neighbours(scene, group, moves, hit, left_out)


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
        if group.role not in roles:
            continue
        if group.held is not None:
            free &= group.held.depth(places) <= 0
        some = np.flatnonzero(free)
        if not len(some):
            continue
        tool = scene.tool
        if group.role == OTHER:
            tool = _extend_tool(scene.tool, places, axis, group)
        required = np.tile(group.required, (len(group.faces), 1))
        if not itself and group.role == SKIN:  # obstacles have numbers of their own
            required[_own_faces(scene, group)] = -np.inf
        free[some] = _keeps_distances(group, tool, places[some], axis, required)
    return free


def _own_faces(scene: InterferenceScene, group: CheckSurfaces) -> list[bool]:
    """Which faces of a group are the one that is machined."""
    return [face.number in scene.numbers for face in group.faces]


def _keeps_distances(group: CheckSurfaces, tool: Tool, places: Array, axis: Array, required: Array) -> Bools:
    """Whether the tool keeps its distances at positions, (n,): those close together are decided together if they can.

    A distance changes by no more than the tip moves: what the tool keeps at the centre of a ball, and its radius more,
    it keeps at every tip in the ball.
    """
    kept = np.zeros(len(places), dtype=bool)
    rest = np.arange(len(places))
    for size in _BLOCKS:
        if len(rest) < _WORTH:
            break
        block, number = _blocks(places[rest], size * tool.radius)
        if number * _WORTH > len(rest):
            continue
        low = np.full((number, 3), np.inf)
        high = np.full((number, 3), -np.inf)
        np.minimum.at(low, block, places[rest])
        np.maximum.at(high, block, places[rest])
        longest = np.linalg.norm(high - low, axis=1).max()
        radius = float(longest) / 2
        centres = motions((low + high) / 2, axis)
        found = keeps_limits(group.cells, tool, centres, required + radius)
        done = found.blocked[block] < 0
        kept[rest[done]] = True
        rest = rest[~done]
    if len(rest):
        moves = motions(places[rest], axis)
        found = keeps_limits(group.cells, tool, moves, required)
        kept[rest] = found.blocked < 0
    return kept


def _blocks(places: Array, size: float) -> tuple[NDArray[np.intp], int]:
    """Which cube of a lattice each place lies in, and how many cubes are taken."""
    from_corner = places - places.min(axis=0)
    cube = np.floor(from_corner / size).astype(np.int64)
    _, span_y, span_z = cube.max(axis=0, initial=0) + 1
    x, y, z = cube.T
    number = (x * span_y + y) * span_z + z
    found, block = np.unique(number, return_inverse=True)
    return block, len(found)


def _extend_tool(tool: Tool, places: Array, axis: Array, group: CheckSurfaces) -> Tool:
    """The tool as far up as what stands around: it is drawn back along its axis, and the spindle is above it.

    What is above all that stands there changes no distance: a few lengths do for all axes.
    """
    along_axis = np.maximum(*(group.box * axis))
    highest = float(along_axis.sum())
    lowest = float((places @ axis).min())
    needed = highest - lowest
    if needed <= tool.height:
        return tool
    doublings = np.ceil(np.log2(needed / tool.height))
    return _height_to_extend(tool, float(tool.height * 2.0 ** doublings))


@lru_cache(maxsize=64)
def _height_to_extend(tool: Tool, height: float) -> Tool:
    return tool.carried_on(height)


def _into_neighbours(scene: InterferenceScene, group: CheckSurfaces, moves: Array, hit: Bools,
                     left_out: Array | None) -> Bools:
    """Which of the positions that were hit are so by faces that continue this one alone, as a boss's fillet."""
    into = hit.copy()
    rows = np.flatnonzero(hit)
    if not len(rows):
        return into
    own = _own_faces(scene, group)
    only = np.full((len(group.faces), 3), -np.inf)
    only[own] = 0.0 if left_out is None else left_out[own]
    found = lower_bounds(group.cells, scene.tool, moves[rows], group.required + 2 * FINE, FINE, only)
    into[rows] = (found.lower >= group.required).all(axis=1)
    return into


def _beside(tool: Tool, group: CheckSurfaces, moves: Array, found: DistanceBounds, near: Bools) -> Bools:
    """Which of the positions come too near to a wall that is near them."""
    amount = group.required - found.lower
    hit = (amount > 0).any(axis=1)
    # The nearest face is too near itself where that does not hang on how exactly distances are bounded.
    depth = np.maximum(-found.lower, 0.0)
    inexactness = 2 * COARSE + _DEPTH_SHARE * depth
    row, component = np.nonzero(amount > inexactness)
    face = found.face[row, component]
    is_wall = (face >= 0) & near[row, face]
    beside = np.zeros(len(moves), dtype=bool)
    beside[row[is_wall]] = True
    undecided = near[hit & ~beside].any(axis=0)
    for k in np.flatnonzero(undecided):
        rows = np.flatnonzero(hit & near[:, k] & ~beside)
        if len(rows):
            only = np.full((len(group.faces), 3), -np.inf)
            only[k] = 0.0
            alone = lower_bounds(group.cells, tool, moves[rows], group.required + 2 * COARSE, COARSE, only)
            beside[rows] = (alone.lower < group.required).any(axis=1)
    return beside


def _worse(worst: Violations, found: DistanceBounds, group: CheckSurfaces, number: int, wall: Bools) -> Violations:
    """Merge in what one group does; a contact left as rest material is not visited, whatever else is there."""
    for c in range(3):
        amount = group.required[c] - found.lower[:, c]
        hit = amount > 0
        is_first = worst.reason == FREE
        is_wall_now = wall & ~worst.wall
        is_deeper = (worst.wall == wall) & (amount > worst.amount)
        take = hit & (is_first | is_wall_now | is_deeper)
        is_gouge = group.role == SKIN and c == 0
        code = GOUGE if is_gouge else CUTTER + c
        reason = np.where(take, code, worst.reason).astype(np.int8)
        amount = np.where(take, amount, worst.amount)
        beside = np.where(take, wall, worst.wall)
        face = np.where(take, found.face[:, c], worst.face)
        of_group = np.where(take, number, worst.group)
        point = np.where(take[:, None], found.point[:, c], worst.point)
        worst = Violations(reason, amount, beside, face, of_group, point)
    return worst
