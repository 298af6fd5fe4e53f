"""A part with blades and several tools: one blade is planned with all of them, and turned to the others."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.job.planning.blade_clearances import with_rooms
from toolaxis.job.planning.blade_copies import append_operations, spread_out, with_refused
from toolaxis.job.planning.blade_pattern import Pattern, group_blade_faces
from toolaxis.job.planning.planner import PlannerOfFaces, PlanningJob, went_on
from toolaxis.job.planning.rack import RackPlanner, outcome_of_rack
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part


def plan_blades_with_rack(jobs: Sequence[PlanningJob], pattern: Pattern, most: int | None,
                          progress: Progress) -> Plan:
    """The plan of a part with blades.

    Parameters
    ----------
    jobs : sequence of PlanningJob
        The same job with each tool, in the order in which tools are used.
    pattern : Pattern
    most : int or None
        Greatest number of tools.
    progress : Progress

    Returns
    -------
    Plan
        Fillets that are too tight for the smallest tool, and sides whose neighbours are too near for it, stay open.
    """
    smallest = jobs[-1]
    share = group_blade_faces(pattern, smallest.tool, smallest.inputs.tolerance.cutter_clearance)
    apart = pattern.blades.apart(pattern.part, pattern.first[0].number)
    own = (*share.divided, *share.whole)
    first = _with_part(jobs, apart, own, most).plan(own, progress)
    used = first.used_tools
    first = with_refused(first, pattern, share)
    found = went_on(replace(first, part=pattern.part),
                    lambda plan: spread_out(pattern, plan, PlannerOfFaces(jobs), progress))
    if found.outcome != "cancelled" and pattern.rest:
        others = [job for job in jobs if job.tool in used] if most is not None and used else jobs
        rest = _with_part(others, pattern.part, pattern.rest, most).plan(pattern.rest, progress)
        found = append_operations(found, rest)
    found = _sort_by_tool(found)
    if found.outcome != "cancelled":
        found = replace(found, outcome=outcome_of_rack(found.operations))
    return went_on(found, lambda plan: plan if plan.blades is None else with_rooms(plan, progress))


def _sort_by_tool(plan: Plan) -> Plan:
    """A plan whose operations stand, and are numbered, in the order of its tools."""
    order = sorted(plan.operations, key=lambda op: plan.tools.index(op.tool))
    numbers = {op.number: number for number, op in enumerate(order, 1)}
    operations = []
    for op in order:
        rest_of = tuple(sorted(numbers[one] for one in op.rest_of))
        operations.append(replace(op, number=numbers[op.number], rest_of=rest_of))
    blades = None if plan.blades is None else plan.blades.renumbered(numbers)
    return replace(plan, operations=tuple(operations), blades=blades)


def _with_part(jobs: Sequence[PlanningJob], part: Part, faces: Sequence[Face], most: int | None) -> RackPlanner:
    """What plans some faces of a part."""
    area = sum(face.area for face in faces)
    return RackPlanner([replace(job, part=part, asked_area=area) for job in jobs], most)
