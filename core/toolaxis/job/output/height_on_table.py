"""How far a part has to be raised on a machine's table until nothing of the machine is in the way of its passes."""

from dataclasses import replace
from math import ceil, inf

import numpy as np
from numpy.typing import NDArray

from toolaxis.collision.machine_collision import MachineSurroundings, carrier_of, free_solutions
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.kinematics import placement
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.common.passes import machine_violation

Array = NDArray[np.float64]

#: Heights are told in steps of this, and looked for up to the other, mm.
_STEP, _HIGHEST = 5.0, 400.0
#: Boxes of faces may be larger than these by so much, mm.
_LOOSE = 0.05


def find_missing_height(plan: Plan, mounting: Mounting, progress: Progress = NO_PROGRESS) -> float:
    """How far to raise the part on the table so that the machine can follow each operation's passes, mm.

    Parameters
    ----------
    plan : Plan
    mounting : Mounting
        The machine and where the part stands on it now.
    progress : Progress

    Returns
    -------
    float
        Zero where the part need not be raised, or where that does not help.

    Notes
    -----
    The part then stands on top of what carries it, and each operation has rotary angles at which the machine's bodies
    keep clear of each other and of the table.  Part, obstacles and index moves are left to whoever writes the program:
    this is an offer, not a proof.
    """
    done = [(op, one) for one in plan.by_tool() for op in one.operations if op.path is not None and len(op.path.cl)]
    if mounting.table_from_part is None or not done:
        return 0.0
    height, before = _in_steps(_depth_in_table(plan, mounting)), -1.0
    while height != before:
        before = height
        for k, (op, one) in enumerate(done):
            progress.report("height on the table", k, len(done))
            raised = replace(mounting, tool_length=one.tools[0].gauge_length)
            around = MachineSurroundings(one.tools[0], (), plan.inputs.tolerance.holder_clearance + plan.inputs.stock)
            while (lack := _lack_of(op, _raise_part(raised, height), around)) > 0:
                height = _in_steps(height + lack)
                if height > _HIGHEST:
                    return 0.0
    return height


def _in_steps(height: float) -> float:
    return inf if height == inf else _STEP * ceil(height / _STEP - 1e-9)


def _raise_part(mounting: Mounting, height: float) -> Mounting:
    """The same with the part higher on the table."""
    matrix = np.array(placement(mounting.table_from_part))
    matrix[2, 3] += height
    return replace(mounting, table_from_part=matrix)


def _depth_in_table(plan: Plan, mounting: Mounting) -> float:
    """How far part and obstacles reach below the top of what carries them, mm; zero where they stand above it."""
    matrix = placement(mounting.table_from_part)
    boxes = np.array([face.box for body in (plan.part, *plan.obstacles) for face in body.faces])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T
    on_table = corners @ matrix[:3, :3].T + matrix[:3, 3]
    lowest, highest = on_table.min(axis=0), on_table.max(axis=0)
    directions = np.concatenate([np.eye(3), -np.eye(3)])
    depth = 0.0
    for body in mounting.machine.bodies:
        ends = np.einsum("nc,nc->n", body.convex.support(directions), directions)
        body_highest, body_lowest = ends[:3], -ends[3:]
        is_beside = (body_highest[:2] <= lowest[:2]).any() or (body_lowest[:2] >= highest[:2]).any()
        if body.carried == carrier_of(mounting.machine) and not is_beside:
            depth = max(depth, float(body_highest[2] - lowest[2]) - _LOOSE)
    return depth


def _lack_of(op: Operation, mounting: Mounting, around: MachineSurroundings) -> float:
    """A height by which the part has to be raised at least for an operation, mm: zero where the machine can follow it,
    infinite where the rotary axes do not get there."""
    assert op.path is not None
    if op.orientation.lead is not None:
        try:
            along = following(mounting.machine, op.path, mounting.table_from_part, float(mounting.tool_length or 0.0),
                              near=np.zeros(len(mounting.machine.rotary)), travel=True)
        except InvalidInput:
            return inf
        met = machine_violation(mounting, along, around) if mounting.judges_bodies else None
        return 0.0 if met is None else _step_or_more(around.required - met[0].distance)
    rows, _, distance = free_solutions(mounting, op.path.cl, op.path.axis[0], around)
    if len(rows):
        return 0.0
    if distance < inf:
        return _step_or_more(around.required - distance)
    out = float(mounting.travel(op.path.cl, op.path.axis[0]).max())
    return _step_or_more(out) if out > 0 else inf


def _step_or_more(height: float) -> float:
    """At least a step: what is missing was found to be more than nothing."""
    return max(height, _STEP)
