"""The time of a plan on its machine: paths within the axes' limits, and what lies between them."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, about
from toolaxis.feed.feed_drop import SLOW, FeedDrop
from toolaxis.feed.fixed_axis_time import Feeds, index_time, machining_time
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.moving_axis_time import FiveAxisMotion, five_axis_motion
from toolaxis.job.planning.sequencing import sequence_operations
from toolaxis.machine.kinematics import linear_coordinates
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import INDEX_SECONDS, Plan, PlanInputs
from toolaxis.plan.timing import CRAWLING, MOTION_WARNINGS, UNTIMED, MachiningTime, Order

Array = NDArray[np.float64]

#: Angle by which rotary axes may differ and still stand at one place, rad.
_SAME = 1e-6


def add_times(plan: Plan, reorder: bool = False) -> Plan:
    """A plan with the rotary angles of each operation on its machine, and the time where that states all limits.

    Paths are what a control takes that follows cuts as smooth curves within their chord tolerance and goes as fast
    as its axes do in rapid traverse.  Between operations the rotary axes turn to those solutions that take least time
    together, as in programs; where the part's place on the table is known, Z goes up before that and X and Y go over
    after it.  Axes that are set by hand take `INDEX_SECONDS`.  Where the tool axis moves, all axes keep their limits
    along the path; with a path that the machine cannot follow a plan stays without times.  The reasons of an operation
    say so, and where the tip would crawl.

    Parameters
    ----------
    plan : Plan
    reorder : bool
        Whether operations of one tool may be put in the order that takes least time between them, see `sequencing`.
    """
    made = [_add_times_of_tool(one, reorder) for one in plan.by_tool()]
    if len(made) == 1:
        return replace(made[0], tools=plan.tools, inputs=plan.inputs)
    outcome = plan.outcome
    if outcome == "complete" and any(one.outcome != "complete" for one in made):
        outcome = "incomplete"
    operations = [op for one in made for op in one.operations]
    number = {op.face.label: op.number for op in operations}
    now = {op.number: number[op.face.label] for op in plan.operations}
    rests = tuple(replace(op, rest_of=tuple(sorted(now[one] for one in op.rest_of))) for op in operations)
    return replace(plan, operations=rests, outcome=outcome, order=_add_orders([one.order for one in made]),
                   blades=None if plan.blades is None else plan.blades.renumbered(now),
                   in_the_way=tuple(f"{one.named_tools}: {why}" for one in made for why in one.in_the_way))


def _add_orders(orders: Sequence[Order | None]) -> Order | None:
    """What the orders of several tools' operations save together."""
    known = [one for one in orders if one is not None]
    if not known:
        return None
    return Order(*(sum(getattr(one, name) for one in known) for name in ("seconds", "listed", "bound")))


def _add_times_of_tool(plan: Plan, reorder: bool) -> Plan:
    """A plan with one tool with angles and times."""
    plan = plan if reorder and plan.order is not None else sequence_operations(plan, reorder)
    plain = replace(plan, operations=tuple(replace(op, time=None) for op in plan.operations))
    if plan.machine is None or plan.machine.machine.unstated:
        return plain
    mounting = replace(plan.machine, tool_length=plan.tools[0].gauge_length)
    stand, last, done = np.zeros(len(mounting.machine.rotary)), None, []
    for op in plan.operations:
        if op.path is None:
            done.append(op)
            continue
        if op.orientation.lead is not None:
            try:
                with about(op.face.label):
                    moved = _moving(mounting, op, stand, plan.inputs)
            except InvalidInput as reason:
                return replace(plain, operations=tuple(
                    _replace_time_warning(one, f"{UNTIMED} {reason}") if one.number == op.number else one
                                                       for one in plain.operations))
            time, angles, end = moved.time, moved.begin, moved.end
            op = _replace_time_warning(op, _crawls(moved.crawl, plan.inputs))
            index = 0.0 if last is None else _between(mounting, (last, stand), (op, angles))
            done.append(replace(op, time=time.at(tuple(angles.tolist()), index)))
            stand, last = end, op
            continue
        if len(op.rotary) != len(stand):  # an axis that the machine does not hold
            return plain
        angles = np.array(op.rotary, dtype=float)
        index = 0.0 if last is None else _between(mounting, (last, stand), (op, angles))
        with about(op.face.label):
            time = _path_time(mounting, op, angles, plan.inputs)
        done.append(replace(op, time=time.at(tuple(angles.tolist()), index)))
        stand, last = angles, op
    return replace(plan, operations=tuple(done))


def feeds_of(inputs: PlanInputs) -> Feeds:
    """What a plan's inputs mean to the control of a machine that knows its own rapid traverse.

    Parameters
    ----------
    inputs : PlanInputs
    """
    return Feeds(inputs.feedrate / 60, rapid=inf, crossing=inputs.rapid / 60, tolerance=inputs.chord,
                 smooth=True)


def _moving(mounting: Mounting, op: Operation, stand: Array, inputs: PlanInputs) -> FiveAxisMotion:
    """Time of a path with a moving axis, and where the rotary axes stand at its ends."""
    assert op.path is not None
    return five_axis_motion(mounting.machine, op.path, feeds_of(inputs), mounting.table_from_part,
                            float(mounting.tool_length or 0.0), stand)


def _crawls(found: FeedDrop | None, inputs: PlanInputs) -> str:
    """A sentence on where the tip crawls; empty where it does so nowhere."""
    if found is None:
        return ""
    return (f"{CRAWLING} {100 * SLOW:g} % of the programmed {inputs.feedrate:g} mm/min for {found.seconds:.3g} s on "
            f"{found.way:.3g} mm at {np.round(found.place, 2).tolist()}: the axes of the machine have to turn too fast "
            "there; take another machine, offset or strategy")


def _replace_time_warning(op: Operation, sentence: str) -> Operation:
    """An operation with a sentence on its motion in place of that of an earlier timing."""
    before = tuple(why for why in op.orientation.reasons if not why.startswith(MOTION_WARNINGS))
    return replace(op, orientation=replace(op.orientation, reasons=(*before, sentence) if sentence else before))


def _path_time(mounting: Mounting, op: Operation, angles: Array, inputs: PlanInputs) -> MachiningTime:
    """Time of an operation's path; the known one where the axes stood at the same place, whole turns aside."""
    assert op.path is not None
    if op.time is not None and len(op.time.rotary) == len(angles):
        off = np.mod(np.asarray(op.time.rotary) - angles + np.pi, 2 * np.pi) - np.pi
        if (np.abs(off) < _SAME).all():
            return op.time
    return machining_time(mounting.machine, op.path, feeds_of(inputs), angles, mounting.table_from_part)


def seconds_to_index(mounting: Mounting, before: tuple[Array, Array], after: tuple[Array, Array]) -> float:
    """Time from the end of one operation to the start of the next one, s.

    Up, turn, over and down, each from rest to rest, where the part's place on the table is known and Z has an upper
    end; else the turn alone.

    Parameters
    ----------
    mounting : Mounting
        With the tool's length.
    before, after : ((3,) array, (m,) array)
        Last tip of the one and first tip of the other, part's frame, mm, with the rotary angles, rad.
    """
    machine, top = mounting.machine, mounting.machine.linear[2].high
    turn = index_time(machine, before[1], after[1], INDEX_SECONDS)
    if not (mounting.judges_travel and isfinite(top)):
        return turn
    ends = [linear_coordinates(machine, tip[None], angles, float(mounting.tool_length or 0.0),
                               mounting.table_from_part)[0] for tip, angles in (before, after)]
    ways = np.abs([*(ends[1] - ends[0])[:2], top - ends[0][2], top - ends[1][2]])
    drives = [machine.linear[k].drive.levels(machine.linear[k].name) for k in (0, 1, 2, 2)]
    x, y, up, down = travel_time(ways, *np.array(drives).T)
    return turn + float(up + max(x, y) + down)


def _between(mounting: Mounting, before: tuple[Operation, Array], after: tuple[Operation, Array]) -> float:
    """Time from the end of one operation to the start of the next one, s."""
    assert before[0].path is not None and after[0].path is not None
    return seconds_to_index(mounting, (before[0].path.cl[-1], before[1]), (after[0].path.cl[0], after[1]))
