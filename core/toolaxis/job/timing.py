"""The time of a plan on its machine: paths within the axes' limits, and what lies between them."""

from dataclasses import replace
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from toolaxis.feed.profile import travel_time
from toolaxis.feed.schedule import Feeds, index_time, machining_time
from toolaxis.machine.kinematics import linear_coordinates, nearest_turn
from toolaxis.machine.mounting import Mounting
from toolaxis.plan.machine_document import rotary_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import INDEX_SECONDS, Inputs, Plan
from toolaxis.plan.timing import MachiningTime

Array = NDArray[np.float64]

#: Angle by which rotary axes may differ and still stand at one place, rad.
_SAME = 1e-6


def timed(plan: Plan) -> Plan:
    """A plan with the time of each operation where its machine states all limits; as it is elsewhere.

    Paths are what a control takes that follows cuts as smooth curves within half the gouge tolerance and goes as fast
    as its axes do in rapid traverse.  Between operations the rotary axes turn to the solution with the least turn, as
    in programs; where the part's place on the table is known, Z goes up before that and X and Y go over after it.  Axes
    that are set by hand take `INDEX_SECONDS`.

    Parameters
    ----------
    plan : Plan

    Raises
    ------
    InvalidInput
        When a path has no fixed axis, or none that the machine can take.
    """
    plain = replace(plan, operations=tuple(replace(op, time=None) for op in plan.operations))
    if plan.machine is None or plan.machine.machine.unstated:
        return plain
    mounting = replace(plan.machine, tool_length=plan.tool.gauge_length)
    stand, last, done = np.zeros(len(mounting.machine.rotary)), None, []
    for op in plan.operations:
        rows = rotary_of(mounting, op, mounting.tool_length)
        if op.path is None:
            done.append(op)
            continue
        if not len(rows):  # an axis that the machine does not hold
            return plain
        angles = nearest_turn(mounting.machine, rows, stand)
        index = 0.0 if last is None else _between(mounting, (last, stand), (op, angles))
        time = _path_time(mounting, op, angles, plan.inputs)
        done.append(replace(op, time=time.at(tuple(angles.tolist()), index)))
        stand, last = angles, op
    return replace(plan, operations=tuple(done))


def feeds_of(inputs: Inputs) -> Feeds:
    """What a plan's inputs mean to the control of a machine that knows its own rapid traverse.

    Parameters
    ----------
    inputs : Inputs
    """
    return Feeds(inputs.feedrate / 60, rapid=inf, crossing=inputs.rapid / 60, tolerance=inputs.tolerance.gouge / 2,
                 smooth=True)


def _path_time(mounting: Mounting, op: Operation, angles: Array, inputs: Inputs) -> MachiningTime:
    """Time of an operation's path; the known one where the axes stood at the same place, whole turns aside."""
    assert op.path is not None
    if op.time is not None and len(op.time.rotary) == len(angles):
        off = np.mod(np.asarray(op.time.rotary) - angles + np.pi, 2 * np.pi) - np.pi
        if (np.abs(off) < _SAME).all():
            return op.time
    return machining_time(mounting.machine, op.path, feeds_of(inputs), angles, mounting.table_from_part)


def _between(mounting: Mounting, before: tuple[Operation, Array], after: tuple[Operation, Array]) -> float:
    """Time from the end of one operation to the start of the next one, s."""
    machine, top = mounting.machine, mounting.machine.linear[2].high
    turn = index_time(machine, before[1], after[1], INDEX_SECONDS)
    if not (mounting.judges_travel and isfinite(top)):
        return turn
    ends = []
    for (op, angles), row in ((before, -1), (after, 0)):
        assert op.path is not None
        ends.append(linear_coordinates(machine, op.path.cl[[row]], angles, float(mounting.tool_length or 0.0),
                                       mounting.table_from_part)[0])
    ways = np.abs([*(ends[1] - ends[0])[:2], top - ends[0][2], top - ends[1][2]])
    drives = [machine.linear[k].drive.levels(machine.linear[k].name) for k in (0, 1, 2, 2)]
    x, y, up, down = travel_time(ways, *np.array(drives).T)
    return turn + float(up + max(x, y) + down)
