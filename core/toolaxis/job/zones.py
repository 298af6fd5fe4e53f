"""The clean-up zones of a plan: what each operation leaves, and what of it others machine."""

from dataclasses import replace

import numpy as np

from toolaxis.job.abreast import abreast
from toolaxis.job.axes import search_task
from toolaxis.path.left_over import FACTOR, also_machined, excess, left_over
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress

_LEFT = "is left to clean-up"


def zoned(plan: Plan, workers: int = 1, progress: Progress = NO_PROGRESS) -> Plan:
    """A plan with the clean-up zones of its operations.

    Parameters
    ----------
    plan : Plan
        Made to the end, or stopped; a stopped one stays as it is.
    workers : int
        Processes; the result is the same for any number.
    progress : Progress

    Returns
    -------
    Plan
        Every operation's share for clean-up is that of its zones; "cancelled" where the user asked to stop.
    """
    if plan.outcome == "cancelled":
        return plan
    done = [op for op in plan.operations if op.done]
    stage = progress.within("clean-up zones")
    found = abreast(lambda k, inner: zones_of(plan, done[k], inner), len(done), workers, stage)
    if found.cancelled:
        return replace(plan, outcome="cancelled")
    by_number = {op.number: told(op, zones) for op, zones in zip(done, found.results, strict=True)}
    return replace(plan, operations=tuple(by_number.get(op.number, op) for op in plan.operations))


def zones_of(plan: Plan, op: Operation, progress: Progress = NO_PROGRESS) -> tuple[Zone, ...]:
    """The zones that one operation of a plan leaves.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    progress : Progress

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    assert op.path is not None and op.orientation.axis is not None
    axis, feasibility = op.orientation.axis, search_task(plan, op, progress).feasibility
    zones = left_over(op.face, plan.tool, op.path, plan.inputs.scallop, plan.inputs.allowance,
                      lambda uv: ~feasibility.reach(uv, axis), progress)
    if not zones:
        return ()
    height = plan.inputs.allowance + FACTOR * plan.inputs.scallop
    others = [excess(op.face, plan.tool, other.path, height) for other in plan.operations
              if other.path is not None and other.number != op.number and other.face.number == op.face.number]
    return tuple(also_machined(op.face, zone, others) for zone in zones)


def told(op: Operation, zones: tuple[Zone, ...]) -> Operation:
    """An operation with its zones, their share, the width of its strips over the rest, and what is to be said of them.

    Parameters
    ----------
    op : Operation
    zones : tuple of Zone
    """
    found, area = op.orientation, op.face.area
    share = min(1.0, sum(zone.area for zone in zones if zone.at_wall) / area)
    notes = [why for why in found.reasons if not why.endswith(_LEFT)]
    if share > 0:
        notes.insert(0, f"{100 * share:.1f} % of the area lies at walls and {_LEFT}")
    under = [zone for zone in zones if not zone.at_wall]
    if under:
        u, v = np.concatenate([zone.loops[0] for zone in under[:1]]).mean(axis=0)
        notes.append(f"undercut: {sum(zone.area for zone in under):.2f} mm2 at the border stay higher than the scallop "
                     f"limit, the largest zone around u {u:.4g}, v {v:.4g}: machine that edge again with a neighbour's "
                     "axis, or give the sub-surface a smoother border")
    width = area * (1 - share) / found.length if found.length > 0 else 0.0
    return replace(op, zones=zones, orientation=replace(found, unreached=share, average_strip_width=width,
                                                        reasons=tuple(notes)))
