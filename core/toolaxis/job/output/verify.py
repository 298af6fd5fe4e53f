"""Judge a plan through its written form: part copy, plan.json and CL files are all that the judge sees."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import Cancelled, InvalidInput, fault
from toolaxis.feasibility.surroundings import OTHER, SKIN, TOUCHING, group_surroundings
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.verdict_parcel import pack_verdict, unpack_verdict
from toolaxis.job.planning.parallel import abreast, check_workers
from toolaxis.machine.kinematics import placement
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HELD_SIDE
from toolaxis.skin.pieces import own_pieces
from toolaxis.tools.tool import Tool
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.held_side import HeldSide
from toolaxis.verify.maps import MapPoint, MapZone
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.turned_copies import OperationMeasurement, TurnedCopies, transfer_measurement
from toolaxis.verify.verdict import OperationVerdict, Verdict, measure, not_measured, verdict_on

Array = NDArray[np.float64]


def verify(plan: Plan, *, spacing: float | None = None, threads: int = 2, workers: int | None = 1,
           progress: Progress = NO_PROGRESS) -> Verdict:
    """Judge a plan by material removal.

    Parameters
    ----------
    plan : Plan
        Written to a temporary folder and read back, so that the judge sees the CL files and nothing else.
    spacing : float, optional
        Distance of neighbouring rays on the faces, mm; by the size of each face unless given.
    threads : int
        The verdict does not depend on it.
    workers : int, optional
        Processes, with one thread each where they are several; as many as there are cores for None.  The verdict does
        not depend on it.
    progress : Progress

    Returns
    -------
    Verdict
        `passed`, `reasons`, and per operation what was measured; an operation on which the judge itself fails has not
        passed.  Where the progress object asks to stop, those that were judged by then: it has not passed either.

    Raises
    ------
    Cancelled
        When the progress object asks to stop before the first operation was judged.
    InvalidInput
        When it is no plan.
    """
    if not isinstance(plan, Plan):
        raise InvalidInput(f"verify takes the Plan that toolaxis.plan made, not a {type(plan).__name__}: the command "
                           "toolaxis verify judges a folder")
    with activate_progress(progress), tempfile.TemporaryDirectory(prefix="toolaxis-") as folder:
        write_plan(plan, Path(folder))
        return verify_plan(read_plan(Path(folder)), spacing=spacing, threads=threads, workers=check_workers(workers),
                           progress=progress)


def verify_plan(plan: Plan, *, spacing: float | None = None, threads: int = 2, workers: int = 1,
                progress: Progress = NO_PROGRESS) -> Verdict:
    """Judge a plan that `read_plan` has read.

    Parameters
    ----------
    plan : Plan
    spacing, threads, progress
        As for `verify`.
    workers : int
        Processes, with one thread each where they are several; the verdict does not depend on it.
    """
    done = [op for op in plan.operations if op.path is not None]
    families = _find_families(plan, done)
    several = min(workers, len(families)) > 1
    limits = plan.inputs.scallop, plan.inputs.allowance, plan.inputs.tolerance.gouge

    def _judge(k: int, inner: Progress) -> list[OperationVerdict | bytes]:
        found = _judge_family(plan, done, families[k], (spacing, 1 if several else threads), inner)
        if not several:
            return [verdict for verdict, _ in found]
        return [verdict if task is None else pack_verdict(verdict, _faces_of(task)) for verdict, task in found]

    judged = abreast(_judge, len(families), workers, progress)
    found: dict[int, OperationVerdict] = {}
    for k, family in enumerate(families):
        if k in judged.faults:
            lost = judged.faults[k].sentence
            found.update({place: not_measured(done[place].name, limits, lost) for place in family})
        for place, one in zip(family, judged.results.get(k, ()), strict=k in judged.results):
            if isinstance(one, bytes):
                one = unpack_verdict(one, _faces_of(_task_at(plan, done, place)))
            found[place] = one
    if judged.cancelled and not found:
        raise Cancelled("cancelled by the user")
    return Verdict(tuple(found[place] for place in sorted(found)),
                   tuple(op.name for place, op in enumerate(done) if place not in found))


def _find_families(plan: Plan, done: Sequence[Operation]) -> list[list[int]]:
    """Places of operations that are turned copies of one, together; all others by themselves."""
    copies = {} if plan.blades is None or plan.obstacles else plan.blades.copies
    found: dict[int, list[int]] = {}
    for place, op in enumerate(done):
        found.setdefault(copies.get(op.number, op.number), []).append(place)
    return list(found.values())


def _judge_family(plan: Plan, done: Sequence[Operation], family: Sequence[int], how: tuple[float | None, int],
                  progress: Progress) -> list[tuple[OperationVerdict, VerificationTask | None]]:
    """Verdicts on an operation and its turned copies, each with what was judged; without that where it failed.

    how : distance of neighbouring rays, mm, and threads
    """
    limits = plan.inputs.scallop, plan.inputs.allowance, plan.inputs.tolerance.gouge
    turned = TurnedCopies()
    known: tuple[VerificationTask, OperationMeasurement] | None = None
    found: list[tuple[OperationVerdict, VerificationTask | None]] = []
    for place in family:
        op, within = done[place], progress.within(f"{done[place].name} ({place + 1} of {len(done)})")
        try:
            with activate_progress(progress):
                task = _task_at(plan, done, place)
                verdict = None if known is None else _as_copy(turned, task, known, within)
                if verdict is None:
                    measured = measure(task, *how, within)
                    verdict = verdict_on(task, measured, within)
                    known = known or (task, measured)
                found.append((verdict, task))
        except Cancelled:
            raise
        except Exception as reason:  # nothing is known of this operation; the others are judged
            found.append((not_measured(op.name, limits, fault(reason).sentence), None))
    return found


def _faces_of(task: VerificationTask) -> tuple[Face, ...]:
    """The faces of which a verdict has maps."""
    return (*task.targets, *task.skin)


def _as_copy(turned: TurnedCopies, task: VerificationTask, source: tuple[VerificationTask, OperationMeasurement],
             progress: Progress) -> OperationVerdict | None:
    """The verdict on a turned copy of an operation that was measured; None where it is none, or would not pass so."""
    copy = turned.find(source[0], task)
    measured = None if copy is None else transfer_measurement(task, source[1], copy)
    found = None if measured is None else verdict_on(task, measured, progress)
    return found if found is not None and found.passed else None


def _task_at(plan: Plan, done: Sequence[Operation], place: int) -> VerificationTask:
    """What the judge is to look at of one of some operations."""
    return _task(plan, done[place], done[place - 1] if place else None)


def _task(plan: Plan, op: Operation, last: Operation | None = None) -> VerificationTask:
    """What the judge is to look at: the part's own faces, where some were joined for planning."""
    assert op.path is not None
    tolerance = plan.inputs.tolerance.for_cutter(op.tool.radius)
    around = group_surroundings(op.face, tolerance, plan.inputs.allowance_of(op.face),
                                part=plan.part_around(op.face.number),
                                obstacles=[face for body in plan.obstacles for face in body.faces])

    targets = own_pieces(op.face)
    whole = plan.part.original or plan.part
    avoided = tuple(face for face in whole.faces if face.number in plan.inputs.avoid)
    touched = [face for face in avoided if face.number in op.face.numbers]
    if touched:
        raise InvalidInput(f"operation {op.name} machines face {touched[0].label}, which is to be avoided: make the "
                           "plan again")

    def _of(*roles: str) -> tuple[Face, ...]:
        return tuple(own for group in around if group.role in roles for face in group.faces
                     if (face.number, face.label) != (op.face.number, op.face.label) and face not in targets
                     for own in own_pieces(face)
                     if own not in avoided and own.label != HELD_SIDE
                     and (group.role == OTHER or own.number not in plan.inputs.avoid))

    left = tuple(own for zone in op.zones if zone.at_wall
                 for own in own_pieces(op.face.trimmed(zone.loops), only_exact=True))
    machine = plan.machine
    on_table = None if machine is None or machine.table_from_part is None else placement(machine.table_from_part)
    return VerificationTask(op.name, op.path.cl, op.path.axis, op.path.kind, op.tool.profile, targets,
                            plan.inputs.scallop, plan.inputs.allowance_of(op.face), _of(SKIN), _of(TOUCHING),
                            (*_of(OTHER), *avoided), op.tool.outlines, tolerance, left,
                            op.orientation.axis if op.orientation.lead is None else None,
                            machine=None if machine is None else machine.machine, place=on_table,
                            tool_length=op.tool.gauge_length, rotary=op.rotary or (op.time.rotary if op.time else ()),
                            before=_end_of(last, op.tool), held=_side_for_judge(plan), stock=plan.inputs.stock,
                            proud=_proud(plan), greatest_step_over=plan.inputs.greatest_step_over,
                            left_on=_left_on(plan, targets), lead=plan.inputs.lead)


def _side_for_judge(plan: Plan) -> HeldSide | None:
    """The side that is held, from the inputs in plan.json."""
    side = plan.inputs.half_space_held
    return None if side is None else HeldSide(side.point, side.normal)


def _proud(plan: Plan) -> tuple[Face, ...]:
    """The part's own faces that carry stock."""
    stock = plan.part.stock
    if stock is None:
        return ()
    every = [own for face in plan.part.faces for own in own_pieces(face)]
    return tuple(own for own in every if own.number in stock.faces)


def _left_on(plan: Plan, targets: Sequence[Face]) -> tuple[tuple[Face, float], ...]:
    """The part's own faces with an allowance, by the inputs in plan.json, without those that an operation machines."""
    if not plan.inputs.allowance_on:
        return ()
    own = {face.number for face in targets}
    every = [one for face in plan.part.faces for one in own_pieces(face) if one.number not in own]
    rows = [(one, plan.inputs.allowance_of(one)) for one in every]
    return tuple((one, left) for one, left in rows if left > 0)


def _end_of(op: Operation | None, tool: Tool) -> tuple[Array, Array, tuple[float, ...]] | None:
    """Where an operation ends: tip, axis and rotary angles; None where its axis moves, at the start, and before another
    tool."""
    if op is None or op.path is None or not op.rotary or op.orientation.lead is not None or op.tool != tool:
        return None
    return op.path.cl[-1], op.path.axis[-1], op.rotary


def verdict_document(plan: Plan, verdict: Verdict) -> dict[str, Any]:
    """A verdict as a document that `json.dump` takes.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    missing = [op.name for op in plan.operations if op.path is None and outcome_of([op], plan.blades) != "complete"]
    return {"schema": "toolaxis.verdict", "version": 1, "passed": passes(plan, verdict),
            "made_passed": has_passes(plan, verdict),
            "complete": not verdict.unjudged, "unjudged": list(verdict.unjudged),
            "reasons": [*verdict.reasons, *(f"{name}: no axis, nothing to judge" for name in missing),
                        *(f"between operations: {why}" for why in plan.in_the_way),
                        *(f"the plan: {why.sentence}" for why in plan.faults)],
            "not_checked": list(not_judged(plan, verdict)), "part": _account(plan, verdict),
            "operations": [_operation_document(op) for op in verdict.operations]}


def _account(plan: Plan, verdict: Verdict) -> dict[str, float]:
    """How much of the faces that were asked for passed, mm^2."""
    planned = plan.account
    passed = sum(op.area - op.declared for op in verdict.operations if op.passed)
    verified = min(float(passed), planned.area)
    left = planned.area - verified - planned.unreachable - planned.not_begun
    return {"area": planned.area, "verified": verified, "unreachable": planned.unreachable, "open": max(left, 0.0),
            "not_begun": planned.not_begun}


def not_judged(plan: Plan, verdict: Verdict) -> tuple[str, ...]:
    """What the verdict says nothing of.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    missing = [name for name in plan.not_checked if not name.startswith("collision with the machine")]
    if plan.machine is not None and not all("machine" in op.clearance for op in verdict.operations):
        missing.append("collision with the machine itself")
    elif plan.machine is not None and not all("index move" in op.clearance for op in verdict.operations[1:]):
        missing.append("collision with the machine on index moves")
    return tuple(missing)


def passes(plan: Plan, verdict: Verdict) -> bool:
    """Whether every sub-surface has an axis and every operation passed; a cancelled plan never passes.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    return plan.outcome == "complete" and verdict.passed


def has_passes(plan: Plan, verdict: Verdict) -> bool:
    """Whether every operation that was made passed, and nothing is in the way between them, whatever stays open.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    return verdict.passed and not plan.in_the_way and not plan.faults


def _number(value: float) -> float | None:
    return float(value) if abs(value) < float("inf") else None


def _place(place: MapPoint) -> dict[str, Any]:
    return {"face": place.face, "uv": list(place.uv), "point": list(place.point), "value": _number(place.value),
            "cl_point": place.motion + 1}


def _zone(zone: MapZone) -> dict[str, Any]:
    return {"face": zone.face, "area": zone.area, "low": list(zone.low), "high": list(zone.high),
            "largest": _number(zone.largest), "reason": zone.reason, "at_border": zone.at_border}


def _clearances(found: Mapping[str, Clearance | str]) -> dict[str, Any]:
    return {name: _number(room.distance) if isinstance(room, Clearance) else room for name, room in found.items()}


def _operation_document(op: OperationVerdict) -> dict[str, Any]:
    return {"name": op.name, "faces": list(op.faces), "passed": op.passed, "reasons": list(op.reasons),
            "scallop_limit": op.scallop_limit, "allowance": op.allowance, "scallop_max": _number(op.scallop_max),
            "share_within": op.share_within, "declared": op.declared,
            "gouge_max": op.gouge_max if op.measured else None,
            "gouge_allowed": op.gouge_allowed, "clearance": _clearances(op.clearance),
            "worst_scallop": [_place(p) for p in op.worst_scallop],
            "worst_gouge": [_place(p) for p in op.worst_gouge], "zones": [_zone(z) for z in op.zones],
            "area": op.area, "rays": op.rays, "spacing": op.spacing, "uncertainty": op.uncertainty,
            "least_lean": None if op.lean is None else op.lean.angle,
            "step_over": None if op.step_over is None else op.step_over.distance,
            "lead_arcs": None if op.leads is None else {"arcs": op.leads.arcs, "ends": op.leads.ends},
            "stock": op.stock, "clearance_from_stock_faces": _clearances(op.from_stock)}
