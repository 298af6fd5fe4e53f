"""The way from one indexed position to the next: up, turn, over and down, held apart from everything on it.

While rotary axes turn, nothing is farther from where it stands with the angles in the middle than the angles times its
distance from the axes.  So the whole rectangle of angles between two positions is covered by boxes, each proven by the
distances in its middle, in whatever order and at whatever speed the axes turn.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull, QhullError

from toolaxis.collision.machine_collision import CollisionPoint, MachineSurroundings, meeting_on, words
from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.bodies import BED
from toolaxis.machine.body_poses import axes_carrying, bed_from_body, beside_part
from toolaxis.machine.kinematics import linear_coordinates, placement, tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.support_functions import ConvexBodies, hull, segments, separation
from toolaxis.numeric.vectors import angle_between, perpendicular
from toolaxis.shape.bounding.bounding_tree import BoundingTree
from toolaxis.tools.solid import COMPONENTS, convex_pieces, solid_pieces

Array = NDArray[np.float64]

#: Boxes of angles that are looked at before a turn counts as not proven.
_MOST = 3000
#: Fineness of the cells whose hull stands for a part, mm.
_COARSE = 0.5
#: How the words begin where the way up is not free, whatever comes after it.
RETRACT = "on the retract"
#: What the loops of plane faces may miss their edges by, mm.
_LOOPS = 0.05
#: Angle between spindle and Z above which programs approach along one straight line, rad.
_TILTED = 1e-6


class Stop(NamedTuple):
    """A tool tip, part's frame, mm, and rotary angles, rad."""

    tip: Array
    rotary: Array


class _Solid(NamedTuple):
    """Something that turns: its name, what carries it, its shape with all axes at zero, machine coordinates, and where
    the linear axes have taken it, mm."""

    name: str
    carried: str
    shape: ConvexBodies
    shift: Array = np.zeros(3)


def trouble_between(mounting: Mounting, before: Stop, after: Stop, around: MachineSurroundings) -> str:
    """What is in the way from the end of one path to the begin of the next, in words; empty where nothing is.

    Parameters
    ----------
    mounting : Mounting
        One that `judges_index_moves`.
    before, after : Stop
        Angles turn the way their numbers say.
    around : MachineSurroundings

    Notes
    -----
    Z goes up to the end of its travel, the rotary axes turn there, X and Y go over in any way, and Z down; with a
    tilted spindle one straight motion leads from the retracted place to the first point.  So do the programs that
    `toolaxis.post` writes.
    """
    start = _linear(mounting, before)
    end = _linear(mounting, after)
    top = float(mounting.machine.linear[2].high)
    up = np.append(start[:2], top)
    over = np.append(end[:2], top)
    if _is_tilted(mounting.machine, after):
        way_down = segments(np.array([up, end]))
    else:
        way_down = segments(np.array([up, over, end]))
        # X and Y go over in any way: all of the rectangle between the two places is swept.
        half_x, half_y, _ = (over - up) / 2
        way_down.spread[0] = np.diag([half_x, half_y, 0.0])
    way_up = segments(np.array([start, up]))
    found = _trouble_on(mounting, RETRACT, before, way_up, around)
    if not found:
        found = _trouble_on(mounting, "on the approach", after, way_down, around)
    return found or turning(mounting, up, (before.rotary, after.rotary), around)


def _trouble_on(mounting: Mounting, name: str, stop: Stop, way: ConvexBodies, around: MachineSurroundings) -> str:
    """What comes too near on a way of the linear axes, in words; empty where nothing does."""
    found = meeting_on(mounting, stop.rotary, way, around)
    if found is None or found.distance >= around.required:
        return ""
    return f"{name} {words(mounting, stop.rotary, found, around.required)}"


def trouble_at_the_ends(mounting: Mounting, first: Stop, last: Stop, around: MachineSurroundings) -> tuple[str, str]:
    """What is in the way from above down to the begin of the first path, and up from the end of the last one, in words;
    empty where nothing is.

    Parameters
    ----------
    mounting : Mounting
        One that `judges_index_moves`.
    first, last : Stop
    around : MachineSurroundings

    Notes
    -----
    Where a program starts is not known: with a tilted spindle, which goes to the first point in one straight line from
    there, nothing is said of the approach.
    """
    approach = ""
    if first is last or not _is_tilted(mounting.machine, first):
        approach = _trouble_above(mounting, "on the approach", first, around)
    return approach, _trouble_above(mounting, RETRACT, last, around)


def _trouble_above(mounting: Mounting, name: str, stop: Stop, around: MachineSurroundings) -> str:
    """What comes too near on the way between a stop and the end of Z's travel, in words; empty where nothing does."""
    at = _linear(mounting, stop)
    top = float(mounting.machine.linear[2].high)
    above = np.append(at[:2], top)
    return _trouble_on(mounting, name, stop, segments(np.array([above, at])), around)


def _linear(mounting: Mounting, stop: Stop) -> Array:
    """Linear coordinates at a stop, (3,) mm."""
    length = float(mounting.tool_length or 0.0)
    rows = linear_coordinates(mounting.machine, stop.tip, stop.rotary, length, mounting.table_from_part)
    return np.asarray(rows[0])


def _is_tilted(machine: Machine, stop: Stop) -> bool:
    """Whether the spindle leans away from Z at a stop."""
    of_table = len(machine.table)
    head_alone = np.concatenate([np.zeros(of_table), stop.rotary[of_table:]])
    spindle = tool_axes(machine, head_alone)[0]
    upright = np.array([0.0, 0.0, 1.0])
    return float(angle_between(spindle, upright)) > _TILTED


def turning(mounting: Mounting, at: Array, ends: tuple[ArrayLike, ArrayLike], around: MachineSurroundings) -> str:
    """What comes too near while the rotary axes turn, in words; empty where nothing does.

    Parameters
    ----------
    mounting : Mounting
    at : (3,) array
        Linear coordinates, mm.
    ends : two (m,) array_like
        Rotary angles, rad.
    around : MachineSurroundings
    """
    machine = mounting.machine
    one, other = (np.asarray(end, dtype=float) for end in ends)
    low = np.minimum(one, other)[None]
    high = np.maximum(one, other)[None]
    pairs = _pairs(mounting, around, at)
    reaches = [_reaches(machine, mover) + _reaches(machine, still) for mover, still in pairs]
    weight = sum(reaches, np.zeros(len(one)))
    looked = 0
    while len(low):
        looked += len(low)
        middle = (low + high) / 2
        half = (high - low) / 2
        proven = np.ones(len(low), dtype=bool)
        for (mover, still), reach in zip(pairs, reaches, strict=True):
            swing = half @ reach
            bodies = _solid_at(machine, mover, middle)
            others = _solid_at(machine, still, middle)
            enough = around.required + float(swing.max())
            gap = separation([bodies], [others], enough)
            row = int(np.argmin(gap))
            if gap[row] < around.required:
                found = CollisionPoint(mover.name, still.name, float(gap[row]), 0)
                return f"while the axes turn {words(mounting, middle[row], found, around.required)}"
            if looked > _MOST:
                return f"while the axes turn the {mover.name} is not proven to keep clear of the {still.name}"
            proven &= gap - swing >= around.required
        low = low[~proven]
        high = high[~proven]
        if len(low):
            low, high = _halve(low, high, weight)
    return ""


def _halve(low: Array, high: Array, weight: Array) -> tuple[Array, Array]:
    """Boxes of angles cut in two across the axis that swings things the farthest."""
    axis = np.argmax((high - low) * (weight + 1e-9), axis=1)
    number = len(low)
    rows = np.arange(number)
    cut = (low[rows, axis] + high[rows, axis]) / 2
    low = np.concatenate([low, low])
    high = np.concatenate([high, high])
    high[rows, axis] = cut
    low[rows + number, axis] = cut
    return low, high


def arms(mounting: Mounting, around: MachineSurroundings) -> Array:
    """How far anything reaches at most from each rotary axis that turns it, in any position of the others, (m,) mm.

    Parameters
    ----------
    mounting : Mounting
    around : MachineSurroundings
    """
    reaches = []
    for mover, still in _pairs(mounting, around, np.zeros(3)):
        reaches.append(_reaches(mounting.machine, mover))
        reaches.append(_reaches(mounting.machine, still))
    return np.asarray(np.max(reaches, axis=0, initial=0.0))


def _pairs(mounting: Mounting, around: MachineSurroundings, at: Array) -> list[tuple[_Solid, _Solid]]:
    """What may meet while rotary axes turn."""
    machine = mounting.machine
    carrier = machine.table[0].name if machine.table else BED
    place = placement(mounting.table_from_part)
    part = [_Solid("part", carrier, hull_of(cells).moved(place)) for cells in around.faces]
    still = []
    movers = _tool(mounting, around, at)
    for body in machine.bodies:
        if beside_part(machine, body):
            still.append(_Solid(body.name, body.carried, body.convex))
        else:
            shift = machine.directions @ axes_carrying(machine, body.carried) @ at
            movers.append(_Solid(body.name, body.carried, body.convex, shift))
    first = machine.linear[0].name
    pairs = []
    for mover in movers:
        for other in (*still, *part):
            # What the first axis carries slides over the bed: they always touch.
            if not (other.carried == BED and mover.carried == first):
                pairs.append((mover, other))
    for other in still:
        if other.carried != carrier:
            pairs += [(other, one) for one in part]
    return pairs


def _tool(mounting: Mounting, around: MachineSurroundings, at: Array) -> list[_Solid]:
    """The tool with the linear axes where they are, rotary ones at zero."""
    machine = mounting.machine
    axis = np.asarray(machine.spindle)
    length = float(mounting.tool_length or 0.0)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([*perpendicular(axis), axis], axis=1)
    frame[:3, 3] = np.asarray(machine.gauge) - length * axis
    rows = solid_pieces(around.tool.profile, around.tool.outlines)
    pieces = convex_pieces(rows).moved(frame)
    carrier = machine.head[-1] if machine.head else machine.linear[2]
    shift = machine.directions @ at
    solids = []
    for k, row in enumerate(rows):
        name = COMPONENTS[int(row[7])]
        solids.append(_Solid(name, carrier.name, pieces.rows(np.array([k])), shift))
    return solids


def _solid_at(machine: Machine, solid: _Solid, rotary: Array) -> ConvexBodies:
    """A solid at rotary angles, one for each row."""
    poses = bed_from_body(machine, solid.carried, rotary)
    poses[:, :3, 3] += solid.shift
    return solid.shape.moved(poses)


def _axes(machine: Machine, carried: str) -> list[tuple[int, RotaryAxis]]:
    """The rotary axes that turn what an axis carries, with their numbers, the one next to it first."""
    table = [axis.name for axis in machine.table]
    head = [axis.name for axis in machine.head]
    if carried in table:
        outwards = range(table.index(carried), len(table))
        return [(k, machine.table[k]) for k in outwards]
    if carried in head:
        inwards = reversed(range(head.index(carried) + 1))
        return [(len(table) + k, machine.head[k]) for k in inwards]
    return []


def _reaches(machine: Machine, solid: _Solid) -> Array:
    """How far a solid reaches from each rotary axis that turns it, mm; 0 for the others, (m,)."""
    reach = 0.0
    found = np.zeros(len(machine.rotary))
    before: Array | None = None
    for number, axis in _axes(machine, solid.carried):
        if before is None:
            about_axis = solid.shape.centre - axis.point
            around_axis = solid.shape._replace(centre=about_axis)
            reach = float(around_axis.reach.max())
        else:
            reach += float(np.linalg.norm(before - axis.point))
        before = axis.point
        found[number] = reach
    return found


@lru_cache(maxsize=8)
def hull_of(cells: BoundingTree) -> ConvexBodies:
    """A convex body that holds faces, part's frame.

    Parameters
    ----------
    cells : BoundingTree
    """
    shape = cells.shape
    link = cells.link
    face_of_cell = link[:, 2]
    is_leaf = link[:, 0] < 0
    fine = (face_of_cell >= 0) & ((shape[:, 9] <= _COARSE) | is_leaf)
    parent = np.full(len(shape), -1)
    for column in (0, 1):
        there = link[:, column] >= 0
        parent[link[there, column]] = np.flatnonzero(there)
    below_fine = fine[parent] & (parent >= 0)
    flat = np.array([face.kind == "plane" for face in cells.faces])
    kept = shape[fine & ~below_fine & ~flat[face_of_cell]]
    middle = kept[:, None, :3]
    half_u = kept[:, None, 3:6]
    half_v = kept[:, None, 6:9]
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    corners = middle + signs[:, :1] * half_u + signs[:, 1:] * half_v
    planes = [face.evaluate(loop).point for face in cells.faces if face.kind == "plane" for loop in face.outline]
    points = np.concatenate([corners.reshape(-1, 3), *planes])
    try:
        points = points[ConvexHull(points).vertices]
    except QhullError:  # flat: the corners of its box
        sides = np.stack([points.min(axis=0), points.max(axis=0)], axis=1)
        points = np.array(np.meshgrid(*sides)).reshape(3, -1).T
    margin = float(kept[:, 9].max(initial=_LOOPS))
    return hull(points, margin + max(face.tolerance for face in cells.faces))
