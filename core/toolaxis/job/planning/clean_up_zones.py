"""The clean-up zones of a plan: what each operation leaves, and what of it others machine."""

from dataclasses import replace

import numpy as np

from toolaxis.contact.clearance.clearance import clearance
from toolaxis.errors import Cancelled, fault
from toolaxis.feasibility.surroundings import MARGIN
from toolaxis.job.planning.edit_axis import search_task
from toolaxis.job.planning.failures import fail_operation
from toolaxis.job.planning.parallel import abreast
from toolaxis.path.rest_material import FACTOR, Excess, also_machined
from toolaxis.path.unmachined_ends import beyond_layers
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.infeasibility import corner_too_large, tight_fillet
from toolaxis.search.messages import left_reasons, tells_of_left
from toolaxis.shape.measure import mean_width
from toolaxis.strategies.registry import strategy_of

#: A sub-surface narrower than the cutter is left to the clean-up tool as a whole where its operation would leave more
#: than this share of it: what it machines is not worth an operation.
WHOLLY = 0.9
#: Places each way on a zone at which it is looked which faces keep the cutter from it.
_PLACES = 12


def add_clean_up_zones(plan: Plan, workers: int = 1, progress: Progress = NO_PROGRESS) -> Plan:
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
        Every operation's share for clean-up is that of its zones; "cancelled" where the user asked to stop.  Narrow
        faces that no axis can machine, or hardly, have no operation but one zone; a plan of nothing else is incomplete.
    """
    if plan.outcome == "cancelled":
        return plan
    stage = progress.within("rest material")
    plan = _without_fillets(plan, stage)
    asked = [op for op in plan.operations if op.done and _can_be_outlined(plan, op)]
    while asked:
        stage.check()
        found = abreast(lambda k, _: with_zones(plan, asked[k]), len(asked), workers, stage)  # noqa: B023
        if found.cancelled:
            return replace(plan, outcome="cancelled")
        made = {op.number: replace(op, face=asked[k].face) for k, op in found.results.items()}
        made |= {asked[k].number: fail_operation(asked[k], why) for k, why in found.faults.items()}
        plan = replace(plan, operations=tuple(made.get(op.number, op) for op in plan.operations))
        # What operations lose would have machined stays, for others too.
        lost = {op.face.number for op in made.values() if not op.done}
        asked = [op for op in plan.operations if op.done and op.face.number in lost and _can_be_outlined(plan, op)]
    some = any(op.done for op in plan.operations)
    return replace(plan, outcome=outcome_of(plan.operations, plan.blades) if some else "incomplete")


def _without_fillets(plan: Plan, progress: Progress) -> Plan:
    """A plan in which narrow faces without an axis that are tighter than the cutter are left to clean-up."""
    made = []
    for op in plan.operations:
        if op.done or op.failed:
            made.append(op)
            continue
        try:
            why = "" if mean_width(op.face) >= 2 * op.tool.radius else _too_tight(plan, op, progress)
            made.append(_leave_whole(op, why) if why else op)
        except Cancelled:
            raise
        except Exception as reason:
            made.append(fail_operation(op, fault(reason)))
    return replace(plan, operations=tuple(made))


def _too_tight(plan: Plan, op: Operation, progress: Progress) -> str:
    """Why a face without an axis is one for a smaller tool; empty where it need not be."""
    tight = tight_fillet(op.face, op.tool)
    if tight:
        return f"{tight}, for which no axis was found: a ball end no larger than that reaches it"
    return corner_too_large(search_task(plan, op, progress).feasibility)


def _can_be_outlined(plan: Plan, op: Operation) -> bool:
    """Whether what an operation leaves can be outlined: of a fixed axis, and of layers around a blade."""
    return op.orientation.lead is None or strategy_of(plan.inputs.method).in_layers


def zones_of(plan: Plan, op: Operation) -> tuple[Zone, ...]:
    """The zones that one operation of a plan leaves, with what others machine of them and what keeps the cutter away.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path, of a fixed axis, with the zones that were found with the proof of its passes, or of layers around a
        blade.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    assert op.path is not None
    if strategy_of(plan.inputs.method).in_layers:
        return beyond_layers(op.face, op.path, op.orientation.feed)
    if not op.zones:
        return ()
    height = plan.inputs.allowance_of(op.face) + FACTOR * plan.inputs.scallop
    zones = _name_avoided(plan, op, tuple(replace(zone, elsewhere=0.0) for zone in op.zones))
    others = [Excess(op.face, other.tool, other.path, height) for other in plan.operations
              if other.path is not None and other.number != op.number and other.face.number == op.face.number]
    return tuple(also_machined(op.face, zone, others) for zone in zones)


def _name_avoided(plan: Plan, op: Operation, zones: tuple[Zone, ...]) -> tuple[Zone, ...]:
    """Zones with the faces to be avoided, and the held side, to which the cutter would come too near on them."""
    avoided = [*(plan.part.face(number) for number in plan.part.avoided), *plan.part.faces_of_held_side]
    if not avoided:
        return zones
    assert op.path is not None
    axis, least = op.path.axis[0], plan.inputs.tolerance.cutter_clearance + MARGIN
    alone = replace(op.tool, shank=None, holder=None, stickout=None)
    found = []
    for zone in zones:
        uv = np.concatenate([*zone.loops, op.face.trimmed(zone.loops).places_on(_PLACES)])
        named = tuple(face.label for face in avoided if zone.at_wall and (
            clearance(op.face, alone, uv, axis, face, allowance=plan.inputs.allowance_of(op.face)) < least).any())
        found.append(replace(zone, avoided=named))
    return tuple(found)


def with_zones(plan: Plan, op: Operation) -> Operation:
    """An operation of a plan with the zones that it leaves; see `zones_of` and `describe_zones`.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path, as for `zones_of`.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    return describe_zones(op, zones_of(plan, op))


def describe_zones(op: Operation, zones: tuple[Zone, ...]) -> Operation:
    """An operation with its zones, their share, the width of its strips over the rest, and what is to be said of them.

    Parameters
    ----------
    op : Operation
    zones : tuple of Zone

    Returns
    -------
    Operation
        Without a path where the sub-surface is narrower than the cutter and more than `WHOLLY` of it would be left.
    """
    found, area = op.orientation, op.face.area
    at_walls = min(1.0, sum(zone.area for zone in zones if zone.at_wall) / area)
    if at_walls > WHOLLY and mean_width(op.face) < 2 * op.tool.radius:
        return _leave_whole(op, f"the best axis would leave {100 * at_walls:.1f} % of it")
    notes = (*left_reasons(zones, op.face), *(why for why in found.reasons if not tells_of_left(why)))
    width = area * (1 - at_walls) / found.length if found.length > 0 else 0.0
    return replace(op, zones=zones, orientation=replace(found, unreached=at_walls, average_strip_width=width,
                                                        reasons=notes))


def _leave_whole(op: Operation, why: str) -> Operation:
    """A sub-surface that is left as rest material as a whole."""
    reason = (f"face {op.face.label}, {mean_width(op.face):.2f} mm wide on the mean, is left entirely as rest "
              f"material: {why}")
    none = Orientation(None, op.orientation.feed, reasons=(reason, *op.orientation.reasons), unreached=1.0,
                       evaluations=op.orientation.evaluations, map=op.orientation.map, lobes=op.orientation.lobes)
    return Operation(op.number, op.face, op.tool, none, zones=(Zone(op.face.outline, op.face.area),))
