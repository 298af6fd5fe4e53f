"""Which tool axes a machine reaches, and how far an axis is from the nearest one that it reaches.

The axes that two rotary axes reach within their ranges make a patch of the sphere whose border consists of arcs of
small circles: one rotary axis at an end of its range while the other turns, and the circles where the two solutions
meet.
"""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import inverse, placement, rotary_angles
from toolaxis.machine.machine import Machine
from toolaxis.numeric.rotations import ON_AXIS, across, rotate_vectors, turn_between
from toolaxis.numeric.vectors import angle_between, as_rows, unit

Array = NDArray[np.float64]


def reach_excess(machine: Machine, axes: ArrayLike, table_from_part: ArrayLike | None = None) -> Array:
    """Angle from each tool axis to the nearest one that the rotary axes reach within their ranges, (n,) rad.

    Parameters
    ----------
    machine : Machine
        Axes set by hand count like others: they too can be indexed.
    axes : (n, 3) array_like
        In the part's frame.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero; only how it is turned matters here.
    """
    rows = unit(as_rows(axes, 3, "axis")) @ placement(table_from_part)[:3, :3].T
    away = np.min([_to_arc(rows, *arc) for arc in _border(machine)], axis=0)
    reached = rotary_angles(machine, axes, table_from_part=table_from_part).within.any(axis=1)
    return np.where(reached, 0.0, away)


def travel_excess(machine: Machine, points: ArrayLike, axis: ArrayLike, tool_length: float = 0.0,
                  table_from_part: ArrayLike | None = None) -> Array:
    """How far each linear axis leaves its travel with a fixed tool axis, (s, 3) mm, one row for each solution.

    Parameters
    ----------
    machine : Machine
    points : (n, 3) array_like
        Tool tips in the part's frame, mm.
    axis : (3,) array_like
        Tool axis in the part's frame.
    tool_length : float
        From the gauge point to the tip, mm.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.

    Returns
    -------
    (s, 3) array
        0 where an axis stays inside; infinite in a solution outside the rotary ranges.

    Raises
    ------
    InvalidInput
        When more than one axis is given.
    """
    rows = as_rows(points, 3, "points")
    one = as_rows(axis, 3, "tool axis")
    if len(one) != 1:
        raise InvalidInput(f"{len(one)} tool axes: travel is checked for one fixed axis")
    found = inverse(machine, rows, np.repeat(one, len(rows), axis=0), tool_length, table_from_part)
    turning = rotary_angles(machine, one, table_from_part=table_from_part).within[0]
    out = [linear.excess(found.joints[:, :, i]).max(axis=0) for i, linear in enumerate(machine.linear)]
    return np.where(turning[:, None], np.stack(out, axis=1), np.inf)


def _border(machine: Machine) -> list[tuple[Array, Array, float]]:
    """Arcs (axis, start, turn) that bound the reached axes: the start turned about the axis by 0 to turn."""
    rotary = machine.rotary
    spindle = np.asarray(machine.spindle)
    if not rotary:
        return [(spindle, spindle, 0.0)]
    ranges = [(axis.low, axis.high) if axis.high - axis.low < 2 * pi else (-pi, pi) for axis in rotary]
    a = rotary[0].direction
    a_low, a_high = ranges[0]
    if len(rotary) == 1:
        return [(a, _one(spindle, a, a_low), a_high - a_low)]
    b = rotary[1].direction
    b_low, b_high = ranges[1]
    arcs = []
    for turn in (a_low, a_high):
        begin = _one(_one(spindle, b, b_low), a, turn)
        arcs.append((_one(b, a, turn), begin, b_high - b_low))
    # Where the spindle comes into the plane of both axes their two solutions meet.
    meet = float(turn_between(spindle[None], a[None], b)[0])
    meets = [meet + k * pi for k in range(-4, 5) if b_low <= meet + k * pi <= b_high]
    for turn in (b_low, b_high, *meets):
        begin = _one(_one(spindle, b, turn), a, a_low)
        arcs.append((a, begin, a_high - a_low))
    return arcs


def _one(vector: Array, axis: Array, angle: float) -> Array:
    return np.asarray(rotate_vectors(vector, axis, angle))


def _to_arc(rows: Array, axis: Array, start: Array, turn: float) -> Array:
    """Angle from directions to an arc of a small circle."""
    ends = [start, _one(start, axis, turn)]
    near = np.min([angle_between(rows, end) for end in ends], axis=0)
    if np.linalg.norm(across(start, axis)) <= ON_AXIS:
        return np.asarray(near)
    along = np.mod(turn_between(np.broadcast_to(start, rows.shape), rows, axis), 2 * pi)
    level = np.abs(angle_between(rows, axis) - angle_between(start, axis))
    return np.where(along <= turn, level, near)
