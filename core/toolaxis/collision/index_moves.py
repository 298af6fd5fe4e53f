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
    start, end = _linear(mounting, before), _linear(mounting, after)
    top = float(mounting.machine.linear[2].high)
    up, over = np.append(start[:2], top), np.append(end[:2], top)
    if _is_tilted(mounting.machine, after):
        ways = segments(np.array([up, end]))
    else:
        ways = segments(np.array([up, over, end]))
        rectangle = np.zeros((3, 3))
        rectangle[[0, 1], [0, 1]] = (over - up)[:2] / 2
        ways.spread[0] = rectangle
    for name, stop, way in ((RETRACT, before, segments(np.array([start, up]))), ("on the approach", after, ways)):
        found = meeting_on(mounting, stop.rotary, way, around)
        if found is not None and found.distance < around.required:
            return f"{name} {words(mounting, stop.rotary, found, around.required)}"
    return turning(mounting, up, (before.rotary, after.rotary), around)


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
    told = []
    for name, stop in (("on the approach", first), (RETRACT, last)):
        at = _linear(mounting, stop)
        found = None
        if stop is last or not _is_tilted(mounting.machine, stop):
            above = np.append(at[:2], float(mounting.machine.linear[2].high))
            found = meeting_on(mounting, stop.rotary, segments(np.array([above, at])), around)
        near = found is not None and found.distance < around.required
        told.append(f"{name} {words(mounting, stop.rotary, found, around.required)}" if near and found else "")
    return told[0], told[1]


def _linear(mounting: Mounting, stop: Stop) -> Array:
    """Linear coordinates at a stop, (3,) mm."""
    return np.asarray(linear_coordinates(mounting.machine, stop.tip, stop.rotary, float(mounting.tool_length or 0.0),
                                         mounting.table_from_part)[0])


def _is_tilted(machine: Machine, stop: Stop) -> bool:
    """Whether the spindle leans away from Z at a stop."""
    head = np.concatenate([np.zeros(len(machine.table)), stop.rotary[len(machine.table):]])
    return float(angle_between(tool_axes(machine, head)[0], np.array([0.0, 0.0, 1.0]))) > _TILTED


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
    one, other = (np.asarray(end, dtype=float) for end in ends)
    low, high = np.minimum(one, other)[None], np.maximum(one, other)[None]
    pairs = _pairs(mounting, around, at)
    weight = sum((np.array([_reaches(mounting.machine, solid) for solid in pair]).sum(axis=0) for pair in pairs),
                 np.zeros(len(one)))
    looked = 0
    while len(low):
        looked += len(low)
        middle, half = (low + high) / 2, (high - low) / 2
        proven = np.ones(len(low), dtype=bool)
        for mover, still in pairs:
            swing = half @ (_reaches(mounting.machine, mover) + _reaches(mounting.machine, still))
            gap = separation([_solid_at(mounting.machine, mover, middle)], [_solid_at(mounting.machine, still, middle)],
                             around.required + float(swing.max()))
            row = int(np.argmin(gap))
            if gap[row] < around.required:
                found = CollisionPoint(mover.name, still.name, float(gap[row]), 0)
                return f"while the axes turn {words(mounting, middle[row], found, around.required)}"
            if looked > _MOST:
                return f"while the axes turn the {mover.name} is not proven to keep clear of the {still.name}"
            proven &= gap - swing >= around.required
        low, high = low[~proven], high[~proven]
        if len(low):
            axis = np.argmax((high - low) * (weight + 1e-9), axis=1)
            rows = np.arange(len(low))
            cut = (low[rows, axis] + high[rows, axis]) / 2
            low, high = np.concatenate([low, low]), np.concatenate([high, high])
            high[rows, axis] = cut
            low[rows + len(rows), axis] = cut
    return ""


def arms(mounting: Mounting, around: MachineSurroundings) -> Array:
    """How far anything reaches at most from each rotary axis that turns it, in any position of the others, (m,) mm.

    Parameters
    ----------
    mounting : Mounting
    around : MachineSurroundings
    """
    solids = [solid for pair in _pairs(mounting, around, np.zeros(3)) for solid in pair]
    return np.asarray(np.max([_reaches(mounting.machine, solid) for solid in solids], axis=0, initial=0.0))


def _pairs(mounting: Mounting, around: MachineSurroundings, at: Array) -> list[tuple[_Solid, _Solid]]:
    """What may meet while rotary axes turn."""
    machine = mounting.machine
    carrier = machine.table[0].name if machine.table else BED
    place = placement(mounting.table_from_part)
    part = [_Solid("part", carrier, hull_of(cells).moved(place)) for cells in around.faces]
    still = [_Solid(body.name, body.carried, body.convex) for body in machine.bodies if beside_part(machine, body)]
    movers = [*_tool(mounting, around, at),
              *(_Solid(one.name, one.carried, one.convex, machine.directions @ axes_carrying(machine, one.carried) @ at)
                for one in machine.bodies if not beside_part(machine, one))]
    first = machine.linear[0].name
    pairs = [(mover, other) for mover in movers for other in (*still, *part)
             if not (other.carried == BED and mover.carried == first)]
    return pairs + [(other, one) for other in still if other.carried != carrier for one in part]


def _tool(mounting: Mounting, around: MachineSurroundings, at: Array) -> list[_Solid]:
    """The tool with the linear axes where they are, rotary ones at zero."""
    machine, axis = mounting.machine, np.asarray(mounting.machine.spindle)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([*perpendicular(axis), axis], axis=1)
    frame[:3, 3] = np.asarray(machine.gauge) - float(mounting.tool_length or 0.0) * axis
    rows = solid_pieces(around.tool.profile, around.tool.outlines)
    pieces = convex_pieces(rows).moved(frame)
    carried = machine.head[-1].name if machine.head else machine.linear[2].name
    return [_Solid(COMPONENTS[int(row[7])], carried, pieces.rows(np.array([k])), machine.directions @ at)
            for k, row in enumerate(rows)]


def _solid_at(machine: Machine, solid: _Solid, rotary: Array) -> ConvexBodies:
    """A solid at rotary angles, one for each row."""
    poses = bed_from_body(machine, solid.carried, rotary)
    poses[:, :3, 3] += solid.shift
    return solid.shape.moved(poses)


def _axes(machine: Machine, carried: str) -> list[tuple[int, RotaryAxis]]:
    """The rotary axes that turn what an axis carries, with their numbers, the one next to it first."""
    table, head = [axis.name for axis in machine.table], [axis.name for axis in machine.head]
    if carried in table:
        return [(k, machine.table[k]) for k in range(table.index(carried), len(table))]
    if carried in head:
        return [(len(table) + k, machine.head[k]) for k in reversed(range(head.index(carried) + 1))]
    return []


def _reaches(machine: Machine, solid: _Solid) -> Array:
    """How far a solid reaches from each rotary axis that turns it, mm; 0 for the others, (m,)."""
    reach, found = 0.0, np.zeros(len(machine.rotary))
    before: Array | None = None
    for number, axis in _axes(machine, solid.carried):
        if before is None:
            reach = float(solid.shape._replace(centre=solid.shape.centre - axis.point).reach.max())
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
    shape, link = cells.shape, cells.link
    fine = (link[:, 2] >= 0) & ((shape[:, 9] <= _COARSE) | (link[:, 0] < 0))
    parent = np.full(len(shape), -1)
    for column in (0, 1):
        there = link[:, column] >= 0
        parent[link[there, column]] = np.flatnonzero(there)
    flat = np.array([face.kind == "plane" for face in cells.faces])
    kept = shape[fine & ~(fine[parent] & (parent >= 0)) & ~flat[link[:, 2]]]
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    points = (kept[:, None, :3] + signs[:, :1] * kept[:, None, 3:6] + signs[:, 1:] * kept[:, None, 6:9]).reshape(-1, 3)
    planes = [face.evaluate(loop).point for face in cells.faces if face.kind == "plane" for loop in face.outline]
    points = np.concatenate([points, *planes])
    try:
        points = points[ConvexHull(points).vertices]
    except QhullError:  # flat: the corners of its box
        low, high = points.min(axis=0), points.max(axis=0)
        points = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T
    return hull(points, float(kept[:, 9].max(initial=_LOOPS)) + max(face.tolerance for face in cells.faces))
