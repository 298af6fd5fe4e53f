"""From machine coordinates to the tool's place on the part, and all ways back.

With the rotary axes numbered from the part to the tool, turning by R_i about their points, the linear axes' motion m
and the tool of length L, a tip p and a tool axis T on the part are

    part p = R_1 R_2 (m + H (gauge - L spindle)),   T = R_1 R_2 spindle,

where those of the table stand before m and those of the head make up H.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.machine import Machine
from toolaxis.numeric.rotations import one_turn, rotate_vectors, two_turns
from toolaxis.numeric.vectors import angle_between, as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angle by which a machine without rotary axes may miss a tool axis, rad.
STRAIGHT = 1e-9


@dataclass(frozen=True, eq=False)
class AxisSolutions:
    """All ways in which a machine takes tool axes, or tool axes at points.

    Attributes
    ----------
    joints : (n, s, m) array
        Joint coordinates: rotary angles, rad, in the order of `Machine.rotary`; after an `inverse` the three linear
        coordinates, mm, stand before them.  s is 2 for two rotary axes, 1 otherwise.
    reached : (n,) array of bool
        Whether the axes can turn there at all, limits aside.
    within : (n, s) array of bool
        Whether every axis is also inside its limits.
    free : (n,) array of bool
        Whether the rotary axis next to the part is free, since the tool axis lies along it; it then stands where it is.
    determinant : (n,) array
        0 to 1; 0 in the singular directions, where the two solutions meet and the axes would have to race near by.
    """

    joints: Array
    reached: Bools
    within: Bools
    free: Bools
    determinant: Array


def rotary_angles(machine: Machine, axes: ArrayLike, near: ArrayLike = (), table_from_part: ArrayLike | None = None,
                  ) -> AxisSolutions:
    """All rotary angles that give tool axes, each by whole turns inside its limits and there nearest to where it is.

    Parameters
    ----------
    machine : Machine
    axes : (n, 3) array_like
        Tool axes in the part's frame, tip to spindle.
    near : (m,) array_like
        Where the rotary axes stand, rad; zero unless given.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.

    Raises
    ------
    InvalidInput
        When shapes do not fit or a number is not finite.
    """
    where = placement(table_from_part)
    rows = unit(as_rows(axes, 3, "tool axis")) @ where[:3, :3].T
    rotary = machine.rotary
    stand = np.zeros(len(rotary)) if len(np.atleast_1d(np.asarray(near))) == 0 else np.asarray(near, dtype=float)
    if stand.shape != (len(rotary),) or not np.isfinite(stand).all():
        raise InvalidInput(f"angles to stay near to are {np.asarray(near).tolist()}: {len(rotary)} finite ones are "
                           "needed")
    angles, reached, free, determinant = _turns(machine, rows)
    within = np.repeat(reached[:, None], angles.shape[1], axis=1)
    for i, axis in enumerate(rotary):
        wanted = angles[..., i]
        if i == 0:
            wanted = np.where(free[:, None], np.clip(stand[0], axis.low, axis.high), wanted)
        angles[..., i], inside = axis.within(wanted, stand[i])
        within &= inside
    return AxisSolutions(angles, reached, within, free, determinant)


class _RotarySolutions(NamedTuple):
    """Angles (n, branches, m) that give tool axes on the table, with the rest as in `AxisSolutions`."""

    angles: Array
    reached: Bools
    free: Bools
    determinant: Array


def _turns(machine: Machine, rows: Array) -> _RotarySolutions:
    """Angles of each branch for tool axes on the table."""
    number = len(rows)
    rotary = machine.rotary
    spindle = np.asarray(machine.spindle)
    regular = np.ones(number)
    if len(rotary) == 2:
        found = two_turns(rotary[0].direction, rotary[1].direction, spindle, rows)
        return _RotarySolutions(found.angles, found.reached, found.free, found.determinant)
    if len(rotary) == 1:
        angles, reached, free = one_turn(rotary[0].direction, spindle, rows)
        return _RotarySolutions(angles[:, None, None], reached, free, regular)
    reached = angle_between(rows, spindle) <= STRAIGHT
    none_free = np.zeros(number, dtype=bool)
    return _RotarySolutions(np.empty((number, 1, 0)), reached, none_free, regular)


def nearest_turn(machine: Machine, solutions: ArrayLike, stand: ArrayLike) -> Array:
    """The solution with the least largest turn from where the rotary axes stand, by whole turns where they turn
    further, (m,) rad.

    Parameters
    ----------
    machine : Machine
    solutions : (s, m) array_like
        rad; one at least.
    stand : (m,) array_like
        rad
    """
    near = np.array(solutions, dtype=float)
    here = np.asarray(stand, dtype=float)
    for i, axis in enumerate(machine.rotary):
        near[:, i], _ = axis.within(near[:, i], here[i])
    turns = np.abs(near - here)
    largest = turns.max(axis=1, initial=0.0)
    best = int(np.argmin(np.round(largest, 9)))
    return np.asarray(near[best])


def linear_coordinates(machine: Machine, points: ArrayLike, rotary: ArrayLike, tool_length: float = 0.0,
                       table_from_part: ArrayLike | None = None) -> Array:
    """Linear coordinates that bring the tool tip to points of the part at given rotary angles, (n, 3) mm.

    Parameters
    ----------
    machine : Machine
    points : (n, 3) array_like
        Tool tips in the part's frame, mm.
    rotary : (n, m) or (m,) array_like
        Rotary angles, rad.
    tool_length : float
        From the gauge point to the tip along the spindle, mm.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    """
    where = placement(table_from_part)
    turn = where[:3, :3]
    shift = where[:3, 3]
    rows = as_rows(points, 3, "points") @ turn.T + shift
    angles = _angles(machine, rotary, len(rows))
    for i, axis in enumerate(machine.table):
        rows = _about(rows, axis, -angles[:, i])
    moved = rows - _tip(machine, angles, tool_length)
    coordinates = np.linalg.solve(machine.directions, moved.T)
    return np.asarray(coordinates.T)


def inverse(machine: Machine, points: ArrayLike, axes: ArrayLike, tool_length: float = 0.0,
            table_from_part: ArrayLike | None = None, *, near: ArrayLike = ()) -> AxisSolutions:
    """All joint coordinates that bring the tool to points with tool axes.

    Parameters
    ----------
    machine : Machine
    points, axes : (n, 3) array_like
        Tool tips, mm, and tool axes in the part's frame.
    tool_length : float
        From the gauge point to the tip, mm.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    near : (m,) array_like
        Where the rotary axes stand, rad.

    Notes
    -----
    Property: `forward` of every solution that is reached returns points and axes to 1e-12 of their size.
    """
    rows = as_rows(points, 3, "points")
    found = rotary_angles(machine, axes, near, table_from_part)
    if len(found.reached) != len(rows):
        raise InvalidInput(f"{len(found.reached)} tool axes for {len(rows)} points: one for each is needed")
    number, branches = found.joints.shape[:2]
    joints = np.empty((number, branches, 3 + len(machine.rotary)))
    within = found.within.copy()
    for branch in range(branches):
        rotary = found.joints[:, branch]
        linear = linear_coordinates(machine, rows, rotary, tool_length, table_from_part)
        joints[:, branch, 3:] = rotary
        joints[:, branch, :3] = linear
        for i, axis in enumerate(machine.linear):
            within[:, branch] &= axis.excess(linear[:, i]) <= 0
    return AxisSolutions(joints, found.reached, within, found.free, found.determinant)


def forward(machine: Machine, joints: ArrayLike, tool_length: float = 0.0,
            table_from_part: ArrayLike | None = None) -> tuple[Array, Array]:
    """Tool tips, mm, and tool axes in the part's frame, (n, 3) each, for joint coordinates.

    Parameters
    ----------
    machine : Machine
    joints : (n, 3 + m) array_like
        Linear coordinates, mm, then rotary angles, rad.
    tool_length : float
        From the gauge point to the tip, mm.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    """
    rows = as_rows(joints, 3 + len(machine.rotary), "joint coordinates")
    where = placement(table_from_part)
    turn = where[:3, :3]
    shift = where[:3, 3]
    angles = rows[:, 3:]
    motion = rows[:, :3] @ machine.directions.T
    tips = motion + _tip(machine, angles, tool_length)
    for i in reversed(range(len(machine.table))):
        tips = _about(tips, machine.table[i], angles[:, i])
    axes = tool_axes(machine, angles)
    return (tips - shift) @ turn, axes @ turn


def tool_axes(machine: Machine, rotary: ArrayLike) -> Array:
    """Tool axes on the table for rotary angles, (n, 3).

    Parameters
    ----------
    machine : Machine
    rotary : (n, m) array_like
        rad.
    """
    angles = np.atleast_2d(np.asarray(rotary, dtype=float))
    axes = np.broadcast_to(np.asarray(machine.spindle), (len(angles), 3))
    for i in reversed(range(len(machine.rotary))):
        axes = rotate_vectors(axes, machine.rotary[i].direction, angles[:, i])
    return axes


def part_from_machine(machine: Machine, rotary: ArrayLike, table_from_part: ArrayLike | None = None) -> Array:
    """What the three linear axes' velocities are on the part at rotary angles that stand still, (n, 3, 3).

    The columns are the directions on the part in which the axes move the tool.

    Parameters
    ----------
    machine : Machine
    rotary : (n, m) array_like
        rad.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (16) is the case of a table that tilts A and turns C.
    """
    angles = np.atleast_2d(np.asarray(rotary, dtype=float))
    part_turn = placement(table_from_part)[:3, :3]
    columns = []
    for direction in machine.directions.T:
        rows = np.broadcast_to(direction, (len(angles), 3))
        for i in reversed(range(len(machine.table))):
            rows = rotate_vectors(rows, machine.table[i].direction, angles[:, i])
        columns.append(rows @ part_turn)
    return np.stack(columns, axis=2)


def placement(table_from_part: ArrayLike | None) -> Array:
    """The matrix (4, 4) of a work offset; the identity for none.

    Parameters
    ----------
    table_from_part : (4, 4) or (3,) array_like, optional
        A rigid motion, or the part's origin on the table, mm.

    Raises
    ------
    InvalidInput
        When it is neither.
    """
    if table_from_part is None:
        return np.eye(4)
    matrix = np.asarray(table_from_part, dtype=float)
    if matrix.shape == (3,):
        moved = np.eye(4)
        moved[:3, 3] = matrix
        matrix = moved
    good = matrix.shape == (4, 4) and bool(np.isfinite(matrix).all())
    if not good or np.abs(matrix[:3, :3].T @ matrix[:3, :3] - np.eye(3)).max() > 1e-9 \
            or np.linalg.det(matrix[:3, :3]) < 0 or matrix[3].tolist() != [0, 0, 0, 1]:
        raise InvalidInput(f"work offset is {matrix.tolist()}: the part's origin on the table (3 numbers), or a rigid "
                           "4 x 4 matrix, is needed")
    return matrix


def _angles(machine: Machine, rotary: ArrayLike, count: int) -> Array:
    angles = np.atleast_2d(np.asarray(rotary, dtype=float))
    if angles.shape[-1] != len(machine.rotary) or len(angles) not in (1, count):
        raise InvalidInput(f"rotary angles have shape {np.shape(rotary)}: ({count}, {len(machine.rotary)}) is needed")
    return np.broadcast_to(angles, (count, len(machine.rotary)))


def _tip(machine: Machine, angles: Array, tool_length: float) -> Array:
    """The tool tip before the linear axes move it."""
    tips = np.broadcast_to(np.asarray(machine.gauge) - tool_length * np.asarray(machine.spindle), (len(angles), 3))
    for i in reversed(range(len(machine.head))):
        tips = _about(tips, machine.head[i], angles[:, len(machine.table) + i])
    return tips


def _about(points: Array, axis: RotaryAxis, angles: Array) -> Array:
    return rotate_vectors(points - axis.point, axis.direction, angles) + axis.point
