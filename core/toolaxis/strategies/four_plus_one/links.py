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
    table_from_part = placement(clamp.table_from_part)[:3, :3]
    on_table = axes @ table_from_part.T
    axis_at_zero = tool_axes(machine, clamp.rotary(np.zeros(1)))[0]
    free = machine.rotary[1 - which]
    direction = np.asarray(free.direction)
    if which == 0:
        direction = rotation(machine.rotary[0].direction, clamp.angle) @ direction
    turns = one_turn(direction, axis_at_zero, on_table)[0]
    angles = np.unwrap(turns)
    # The range that is run through is brought by whole turns as near as may be to the middle of the axis' own.
    middle = (angles.min() + angles.max()) / 2
    middle_of_range = (max(free.low, -np.pi) + min(free.high, np.pi)) / 2
    whole_turns = np.round((middle_of_range - middle) / (2 * np.pi))
    return np.asarray(angles + 2 * np.pi * whole_turns)


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
    is_cut = path.kind == Motion.CUT
    turn = np.append(0.0, np.abs(np.diff(free)))
    parts = np.where(is_cut, 1, np.maximum(np.ceil(turn / _TURN), 1)).astype(np.int64)
    # Every point owns the points on the motion to it, of which the last one is the point itself.
    owner, number = number_parts(parts)
    share = (number + 1) / parts[owner]
    is_itself = share == 1

    def _spread(rows: Array) -> Array:
        """Rows of the path's points, and those between them."""
        before = rows[np.maximum(owner - 1, 0)]
        shares = share.reshape(-1, *[1] * (rows.ndim - 1))
        between = before + shares * (rows[owner] - before)
        return np.where(is_itself.reshape(shares.shape), rows[owner], between)

    axes = clamp.axes(_spread(free))
    # Points at which a cut begins touch the face too, and so may the last one.
    may_begin_cut = np.append(is_cut[1:], True)
    is_touching = is_cut[owner] | (may_begin_cut[owner] & is_itself)
    normal = np.where(is_touching[:, None], path.normal[owner], axes)
    ends = np.concatenate([[0], np.cumsum(parts)])
    return ToolPath(_spread(path.cc), _spread(path.cl), np.asarray(unit(axes)), normal, path.kind[owner],
                    ends[path.breaks])
