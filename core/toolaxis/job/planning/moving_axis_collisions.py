"""Operations with a moving axis among the bodies of the machine, as programs follow them one after the other."""

from dataclasses import replace

import numpy as np

from toolaxis.collision.index_moves import Stop, trouble_at_the_ends, trouble_between
from toolaxis.collision.machine_collision import MachineSurroundings, words
from toolaxis.errors import InvalidInput, about
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.strategies.common.passes import machine_violation


def refuse_operation(op: Operation, why: str) -> Operation:
    """An operation that the machine cannot carry out.

    Parameters
    ----------
    op : Operation
    why : str
    """
    none = Orientation(None, op.orientation.feed, outcome="infeasible",
                       reasons=(f"infeasible: {why}", *op.orientation.reasons), map=op.orientation.map)
    return replace(op, path=None, frame=None, time=None, rotary=(), orientation=none)


def check_machine_collisions(plan: Plan, mounting: Mounting, around: MachineSurroundings) -> Plan:
    """A plan without operations on which, while the axis moves, the machine meets something; what is in the way between
    others is told.

    Parameters
    ----------
    plan : Plan
        Operations with one axis stand at their rotary angles.
    mounting : Mounting
    around : MachineSurroundings

    Notes
    -----
    Rotary axes go on from where the operation before leaves them, as in programs.
    """
    moving = [op for op in plan.operations if op.path is not None and op.orientation.lead is not None]
    if not (moving and mounting.judges_bodies):
        return plan
    while True:
        operations, troubles = _walk_operations(plan, mounting, around)
        if operations is plan.operations:
            break
        outcome = plan.outcome if plan.outcome == "cancelled" else outcome_of(operations, plan.blades)
        plan = replace(plan, operations=operations, outcome=outcome)
    outcome = "incomplete" if troubles and plan.outcome == "complete" else plan.outcome
    return replace(plan, outcome=outcome, in_the_way=(*plan.in_the_way, *troubles))


def _walk_operations(plan: Plan, mounting: Mounting, around: MachineSurroundings) -> tuple[tuple[Operation, ...],
                                                                                           list[str]]:
    """The operations, the first one that meets something refused, and what is in the way between those so far."""
    stand, last, after_moving, troubles = np.zeros(len(mounting.machine.rotary)), None, False, list[str]()
    for k, op in enumerate(plan.operations):
        if op.path is None or not len(op.path.cl):
            continue
        moves = op.orientation.lead is not None
        if moves:
            try:
                with about(op.face.label):
                    along = following(mounting.machine, op.path, mounting.table_from_part,
                                      float(mounting.tool_length or 0.0), near=stand, travel=True)
            except InvalidInput as reason:
                return _but(plan, k, str(reason)), []
            with about(op.face.label):
                found = machine_violation(mounting, along, around)
            if found is not None:
                return _but(plan, k, f"{words(mounting, found[1], found[0], around.required)}, at point "
                                     f"{found[0].motion} of the path"), []
            first, end = along.rotary[0], along.rotary[-1]
        elif len(op.rotary) == len(stand):
            first = end = np.array(op.rotary, dtype=float)
        else:
            continue
        begin = Stop(op.path.cl[0], first)
        if mounting.judges_index_moves and (moves or after_moving):
            why = trouble_between(mounting, last, begin, around) if last is not None else \
                trouble_at_the_ends(mounting, begin, begin, around)[0]
            troubles += [f"before face {op.face.label}: {why}"] if why else []
        stand, last, after_moving = end, Stop(op.path.cl[-1], end), moves
    if last is not None and after_moving and mounting.judges_index_moves:
        why = trouble_at_the_ends(mounting, last, last, around)[1]
        troubles += [f"at the end: {why}"] if why else []
    return plan.operations, troubles


def _but(plan: Plan, k: int, why: str) -> tuple[Operation, ...]:
    return tuple(refuse_operation(op, why) if i == k else op for i, op in enumerate(plan.operations))
