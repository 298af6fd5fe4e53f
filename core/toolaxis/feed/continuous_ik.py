"""Machine axes along a path whose tool axis moves: one continuous solution of the inverse kinematics.

Between the points of a path the tool axis turns straight from one to the next, and rotary axes turn evenly.  Where
these differ, as near the singular directions, points are put between until they do not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import ceil, floor, inf, isfinite, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import linear_coordinates, placement, rotary_angles, tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.jit import jit
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import angle_between, unit

Array = NDArray[np.float64]

#: Greatest angle between the tool axis and that of evenly turning rotary axes halfway between two points, rad.
OFF = 1e-4
#: How often gaps are divided, and how many points a path may grow to.
_ROUNDS, _MOST = 16, 2_000_000
#: By how much rotary angles may pass their limits, rad, and linear ones theirs, mm.
_ROUNDING = 1e-9
#: Digits of turns, rad, to which two are as much.
_SAME = 6
#: Turn of a rotary axis that shows how far the linear axes go along with it, rad.
_PROBE = 1e-4


@dataclass(frozen=True, eq=False)
class AxisTrajectory:
    """Machine axes at the points of a path, and at those put between them.

    Attributes
    ----------
    tips, axes : (n, 3) array
        mm; unit vectors.
    rotary : (n, m) array
        rad; without jumps.
    linear : (n, 3) array
        mm
    arrival : (n,) array of int
        Point of the path at which the motion arrives that ends at each point.
    """

    tips: Array
    axes: Array
    rotary: Array
    linear: Array
    arrival: NDArray[np.int64]


def following(machine: Machine, path: ToolPath, table_from_part: ArrayLike | None = None, tool_length: float = 0.0, *,
              near: ArrayLike = (), travel: bool = False) -> AxisTrajectory:
    """Machine axes along a path, turning without jumps.

    Of the solutions and whole turns to begin with, that whose rotary axes turn least in all is taken; of two that turn
    as much, the one that begins nearer to where they stand.

    Parameters
    ----------
    machine : Machine
    path : ToolPath
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    tool_length : float
        From the gauge point to the tip, mm.
    near : (m,) array_like
        Where the rotary axes stand before, rad; zero unless given.  Endless axes begin within half a turn of it.
    travel : bool
        Whether linear axes must stay inside their travel.

    Raises
    ------
    InvalidInput
        When no solution goes from the first point to the last inside the limits without a jump.

    Notes
    -----
    **Properties**: 1. forward kinematics of every point gives its tip and axis; 2. halfway between two points the tool
    axis of evenly turning rotary axes misses that of the path by `OFF` at most.
    """
    stand = np.asarray(near, dtype=float) if np.size(near) else np.zeros(len(machine.rotary))
    found, why = [], ""
    for begin in _begins(machine, path, table_from_part, stand):
        try:
            one = _track_path(machine, path, table_from_part, begin)
        except InvalidInput as reason:
            why = why or str(reason)
            continue
        linear = linear_coordinates(machine, one[0], one[2], tool_length, table_from_part)
        beyond = _beyond(machine, linear) if travel else ""
        if beyond:
            why = why or beyond
            continue
        found.append(AxisTrajectory(one[0], one[1], one[2], linear, one[3]))
    if not found:
        raise InvalidInput(why or f"no position of {machine.name} takes the first axis of the path: choose another "
                           "machine, offset or strategy")
    return min(found, key=lambda one: (round(float(np.abs(np.diff(one.rotary, axis=0)).sum()), _SAME),
                                       round(float(np.abs(one.rotary[0] - stand).max(initial=0.0)), _SAME)))


def _begins(machine: Machine, path: ToolPath, place: ArrayLike | None, stand: Array) -> list[Array]:
    """Rotary angles that take the first axis: every solution, by every whole turn inside ranges that end.

    Where the axis next to the part is free at first, it may also stand where the first axis that turns it needs it.
    """
    found = rotary_angles(machine, path.axis[:1], stand, place)
    rows, firsts = [], list(found.joints[0][found.within[0]])
    if found.free[0] and firsts:
        later = rotary_angles(machine, path.axis, stand, place)
        k = int(np.argmin(later.free))
        firsts += [np.concatenate([angles[:1], firsts[0][1:]]) for angles in later.joints[k][later.within[k]]]
    for angles in firsts:
        turns = [_whole_turns(axis.low - angle, axis.high - angle) for axis, angle in
                 zip(machine.rotary, angles, strict=True)]
        rows += [angles + 2 * pi * np.array(some) for some in product(*turns)]
    return rows


def _whole_turns(low: float, high: float) -> Sequence[int]:
    """Numbers of whole turns in a range, rad; none but 0 where it has no end."""
    if not (isfinite(low) and isfinite(high)):
        return [0]
    return range(ceil((low - _ROUNDING) / (2 * pi)), floor((high + _ROUNDING) / (2 * pi)) + 1)


def _beyond(machine: Machine, linear: Array) -> str:
    for i, axis in enumerate(machine.linear):
        out = float(axis.excess(linear[:, i]).max())
        if out > 0:
            return (f"{axis.name} of {machine.name} would leave its travel by {out:.1f} mm while the axis moves: move "
                    "the part on the table")
    return ""


def _track_path(machine: Machine, path: ToolPath, place: ArrayLike | None,
                begin: Array) -> tuple[Array, Array, Array, NDArray[np.int64]]:
    """Tips, axes, rotary angles and arrivals, with points between where rotary axes would leave the way."""
    tips, axes = path.cl, np.asarray(unit(path.axis))
    arrival = np.arange(len(tips), dtype=np.int64)
    turn = placement(place)[:3, :3]
    for _ in range(_ROUNDS):
        angles = _follow_nearest(machine, axes, place, begin)
        middle = tool_axes(machine, (angles[1:] + angles[:-1]) / 2) @ turn
        off = angle_between(middle, unit(axes[1:] + axes[:-1]))
        parts = np.clip(np.ceil(np.sqrt(off / OFF)), 1, 8).astype(np.int64)
        if (parts == 1).all():
            return tips, axes, angles, arrival
        if parts.sum() > _MOST:
            break
        tips, axes, arrival = _divide_gaps(tips, axes, arrival, parts)
    k = int(arrival[1:][np.argmax(parts)])
    raise InvalidInput(f"rotary axes of {machine.name} cannot follow the tool axis to point {k}, near a singular "
                       "direction or where their range ends: choose another machine, offset or strategy")


def _divide_gaps(tips: Array, axes: Array, arrival: NDArray[np.int64],
                 parts: NDArray[np.int64]) -> tuple[Array, Array, NDArray[np.int64]]:
    """Points put between those whose gaps are in parts, on the straight ways of tips and axes."""
    owner, number = number_parts(parts)
    share = ((number + 1) / parts[owner])[:, None]

    def divide(rows: Array) -> Array:
        before = rows[owner]
        after = rows[owner + 1]
        between = before + share * (after - before)
        return np.concatenate([rows[:1], np.where(share < 1, between, after)])  # points that were given stay exact

    arrivals = np.concatenate([arrival[:1], arrival[owner + 1]])
    return divide(tips), np.asarray(unit(divide(axes))), arrivals


def _follow_nearest(machine: Machine, axes: Array, place: ArrayLike | None, begin: Array) -> Array:
    """Rotary angles from the first ones on, at each axis those of the solution that is nearest to the last, (n, m)."""
    found = rotary_angles(machine, axes, table_from_part=place)
    ranges = np.array([(axis.low - _ROUNDING, axis.high + _ROUNDING) for axis in machine.rotary]).reshape(-1, 2)
    out = np.empty((len(axes), len(ranges)))
    lost = _follow(np.ascontiguousarray(found.joints), found.reached, found.free, ranges, np.asarray(begin), out)
    if lost >= 0:
        raise InvalidInput(f"rotary axes of {machine.name} cannot follow the tool axis to "
                           f"{np.round(axes[lost], 4).tolist()} inside their ranges: choose another machine, offset "
                           "or strategy")
    return out


@jit
def _follow(joints: Array, reached: NDArray[np.bool_], free: NDArray[np.bool_], ranges: Array, begin: Array,
            out: Array) -> int:
    """Fill in what `_follow_nearest` gives from solutions (n, k, m) and ranges (m, 2); where none is left, else -1."""
    last, row = begin.copy(), begin.copy()
    for i in range(len(joints)):
        least = inf
        for k in range(joints.shape[1] if reached[i] else 0):
            size, inside = 0.0, True
            for axis in range(len(last)):
                row[axis] = joints[i, k, axis]
                row[axis] += 2 * pi * np.rint((last[axis] - row[axis]) / (2 * pi))
                if axis == 0 and free[i]:
                    row[axis] = last[axis]
                size = max(size, abs(row[axis] - last[axis]))
                inside = inside and ranges[axis, 0] <= row[axis] <= ranges[axis, 1]
            if inside and size < least:
                least = size
                out[i] = row
        if least == inf:
            return i
        last[:] = out[i]
    return -1


def levers(machine: Machine, along: AxisTrajectory, tool_length: float = 0.0, table_from_part: ArrayLike | None = None,
           ) -> Array:
    """How far the linear axes go at most for a turn of each rotary axis that leaves the tip in its place, (m,) mm.

    Parameters
    ----------
    machine : Machine
    along : AxisTrajectory
    tool_length : float
        mm
    table_from_part : (4, 4) array_like, optional
    """
    some = np.unique(np.linspace(0, len(along.tips) - 1, 64).astype(int))
    sizes = []
    for i in range(along.rotary.shape[1]):
        turned = along.rotary[some].copy()
        turned[:, i] += _PROBE
        moved = linear_coordinates(machine, along.tips[some], turned, tool_length, table_from_part)
        sizes.append(float(np.linalg.norm(moved - along.linear[some], axis=1).max()) / _PROBE)
    return np.array(sizes)
