"""Links of a path with one rotary axis clamped: the other one alone turns on them too."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.kinematics import placement, tool_axes
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.rotations import one_turn
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.strategies.four_plus_one.passes import Clamp

Array = NDArray[np.float64]

#: Greatest turn of the free axis between points of links, rad.
_TURN = np.radians(1.0)


def free_angles(axes: Array, clamp: Clamp) -> Array:
    """Angles of the free axis that come nearest to tool axes in a row, without whole turns between them, (n,) rad.

    Parameters
    ----------
    axes : (n, 3) array
        In the part's frame.
    clamp : Clamp
    """
    machine, which = clamp.machine, clamp.which
    rows = axes @ placement(clamp.table_from_part)[:3, :3].T
    zero = tool_axes(machine, clamp.rotary(np.zeros(1)))[0]
    direction = np.asarray(machine.rotary[1 - which].direction)
    if which == 0:
        direction = rotation(machine.rotary[0].direction, clamp.angle) @ direction
    angles = np.unwrap(one_turn(direction, zero, rows)[0])
    free = machine.rotary[1 - which]
    middle = (angles.min() + angles.max()) / 2
    inside = (max(free.low, -np.pi) + min(free.high, np.pi)) / 2
    return np.asarray(angles + 2 * np.pi * np.round((inside - middle) / (2 * np.pi)))


def on_the_circle(path: ToolPath, clamp: Clamp) -> ToolPath:
    """A path whose axes are those of the clamped machine everywhere: on links too the free axis alone turns.

    Parameters
    ----------
    path : ToolPath
        Its cuts have such axes already.
    clamp : Clamp

    Notes
    -----
    **Properties**: 1. the points of the path are among those of the result, in their order; 2. between two of them the
    free axis turns by one degree at most where nothing is cut.
    """
    free = free_angles(path.axis, clamp)
    turn = np.append(0.0, np.abs(np.diff(free)))
    parts = np.where(path.kind == Motion.CUT, 1, np.maximum(np.ceil(turn / _TURN), 1)).astype(np.int64)
    owner, number = number_parts(parts)
    share = (number + 1) / parts[owner]
    before = np.maximum(owner - 1, 0)
    angles = free[before] + share * (free[owner] - free[before])
    whole = share == 1
    axes = clamp.axes(np.where(whole, free[owner], angles))
    between = [rows[before] + share[:, None] * (rows[owner] - rows[before]) for rows in (path.cc, path.cl)]
    cc, cl = (np.where(whole[:, None], rows[owner], new) for rows, new in zip((path.cc, path.cl), between, strict=True))
    cut = path.kind[owner] == Motion.CUT
    touching = cut | (np.append(path.kind[1:], 0) == Motion.CUT)[owner] & whole
    normal = np.where(touching[:, None], path.normal[owner], axes)
    ends = np.concatenate([[0], np.cumsum(parts)])
    return ToolPath(cc, cl, np.asarray(unit(axes)), normal, path.kind[owner], ends[path.breaks])
