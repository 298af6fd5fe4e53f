"""What a plan with several tools leaves open, held against all tools and axes: what is proven to be out of reach."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.job.planning.parallel import abreast
from toolaxis.job.planning.planner import PlanningJob
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.regions.open_places import LEAST, OpenFace, list_open_faces
from toolaxis.regions.out_of_reach import OutOfReach, prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face

#: Pairs of a cell and a cone of axes that are tried for a part, and the least for one place.
_PAIRS, _FEWEST = 3_000_000, 30_000
#: Places that are looked at, the largest first.
_PLACES = 200


def scene_of(job: PlanningJob) -> ReachScene:
    """What stands around the faces of a job's part.

    Parameters
    ----------
    job : PlanningJob
    """
    return ReachScene.of(job.part, job.obstacles, job.inputs.tolerance, job.axis_limits, job.inputs.allowance)


def prove_unreachable(face: Face, jobs: Sequence[PlanningJob], scene: ReachScene, share: float) -> OutOfReach:
    """What of a face is out of reach of the tools of several jobs.

    Parameters
    ----------
    face : Face
    jobs : sequence of PlanningJob
        The same job with each tool.
    scene : ReachScene
        With the part of the jobs.
    share : float
        Of the work for a whole part that may be spent on it.
    """
    return prove_out_of_reach(face, [job.tool for job in jobs], scene, max(_FEWEST, int(share * _PAIRS)))


def with_unreachable(plan: Plan, jobs: Sequence[PlanningJob], progress: Progress) -> Plan:
    """A plan whose operations and zones tell how much of what they leave open is out of reach of all tools.

    Parameters
    ----------
    plan : Plan
    jobs : sequence of PlanningJob
        The same job with each tool.
    progress : Progress

    Returns
    -------
    Plan
        The same one where the user stops it: what is open is just not proven then.
    """
    places = sorted((one for one in list_open_faces(plan) if one.area >= LEAST), key=lambda one: -one.area)[:_PLACES]
    if not places:
        return plan
    whole = sum(one.face.area for one in places)
    job = replace(jobs[0], part=plan.part)
    around = {one.face.number: plan.part_around(one.face.number) for one in places}
    scenes = {id(part): scene_of(replace(job, part=part)) for part in around.values()}

    def _prove(k: int, inner: Progress) -> float:
        inner.report("proof of what is out of reach", k, len(places))
        one = places[k]
        scene = scenes[id(around[one.face.number])]
        scene = replace(scene, allowance=job.inputs.allowance_of(one.face))
        return prove_unreachable(one.face, jobs, scene, one.face.area / whole).area

    found = abreast(_prove, len(places), job.workers, progress)
    if found.cancelled:
        return plan
    by_operation: dict[int, list[tuple[OpenFace, float]]] = {}
    for k, area in found.results.items():
        by_operation.setdefault(places[k].operation, []).append((places[k], area))
    made = {op.number: _with_areas(op, by_operation.get(op.number, [])) for op in plan.operations}
    if plan.blades is not None and job.axis_limits is None:  # with limits another axis is held on each blade
        for number, original in plan.blades.copies.items():
            made[number] = _as_of(made[number], made[original])
    return replace(plan, operations=tuple(made[op.number] for op in plan.operations))


def _with_areas(op: Operation, found: Sequence[tuple[OpenFace, float]]) -> Operation:
    """An operation that tells of areas that are out of reach."""
    zones = list(op.zones)
    for place, area in found:
        proven = min(area, place.area)
        if place.zone is None:
            return replace(op, unreachable=proven)
        zones[place.zone] = replace(zones[place.zone], unreachable=proven)
    return replace(op, zones=tuple(zones))


def _as_of(op: Operation, original: Operation) -> Operation:
    """The copy of an operation on another blade, with what is out of reach of the original."""
    if op.done != original.done or len(op.zones) != len(original.zones):
        return op
    zones = tuple(replace(zone, unreachable=min(one.unreachable, zone.area - zone.elsewhere))
                  for zone, one in zip(op.zones, original.zones, strict=True))
    return replace(op, zones=zones, unreachable=min(original.unreachable, op.face.area))
