"""Judge a plan through its written form: part copy, plan.json and CL files are all that the judge sees."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

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
                           "toolaxis verify checks a folder")
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
    in_processes = min(workers, len(families)) > 1
    settings = _Measuring(spacing, 1 if in_processes else threads)

    def _judge(k: int, inner: Progress) -> list[OperationVerdict | bytes]:
        found = _judge_family(plan, done, families[k], settings, inner)
        if in_processes:
            return [_pack(one) for one in found]
        return [one.verdict for one in found]

    judged = abreast(_judge, len(families), workers, progress)
    found: dict[int, OperationVerdict] = {}
    for k, family in enumerate(families):
        if k in judged.faults:
            why = judged.faults[k].sentence
            found.update({place: _not_measured(plan, done[place], why) for place in family})
        elif k in judged.results:
            for place, one in zip(family, judged.results[k], strict=True):
                if isinstance(one, bytes):
                    task = _task_at(plan, done, place)
                    one = unpack_verdict(one, _faces_of(task))
                found[place] = one
    if judged.cancelled and not found:
        raise Cancelled("cancelled by the user")
    verdicts = tuple(found[place] for place in sorted(found))
    unjudged = tuple(op.name for place, op in enumerate(done) if place not in found)
    return Verdict(verdicts, unjudged)


def _find_families(plan: Plan, done: Sequence[Operation]) -> list[list[int]]:
    """Places of operations that are turned copies of one, together; all others by themselves."""
    copies = {} if plan.blades is None or plan.obstacles else plan.blades.copies
    found: dict[int, list[int]] = {}
    for place, op in enumerate(done):
        original = copies.get(op.number, op.number)
        found.setdefault(original, []).append(place)
    return list(found.values())


class _Measuring(NamedTuple):
    """Distance of neighbouring rays, mm, by the size of each face for None, and threads."""

    spacing: float | None
    threads: int


class _Judged(NamedTuple):
    """A verdict on an operation, and what was judged; None where that failed."""

    verdict: OperationVerdict
    task: VerificationTask | None


class _Measured(NamedTuple):
    """What was judged, and what was measured of it."""

    task: VerificationTask
    measurement: OperationMeasurement


def _judge_family(plan: Plan, done: Sequence[Operation], family: Sequence[int], settings: _Measuring,
                  progress: Progress) -> list[_Judged]:
    """Verdicts on an operation and its turned copies."""
    turned = TurnedCopies()
    original: _Measured | None = None
    found: list[_Judged] = []
    for place in family:
        op = done[place]
        within = progress.within(f"{op.name} ({place + 1} of {len(done)})")
        try:
            with activate_progress(progress):
                task = _task_at(plan, done, place)
                verdict = None if original is None else _judge_copy(turned, task, original, within)
                if verdict is None:
                    measurement = measure(task, settings.spacing, settings.threads, within)
                    verdict = verdict_on(task, measurement, within)
                    original = original or _Measured(task, measurement)
                found.append(_Judged(verdict, task))
        except Cancelled:
            raise
        except Exception as reason:  # nothing is known of this operation; the others are judged
            found.append(_Judged(_not_measured(plan, op, fault(reason).sentence), None))
    return found


def _not_measured(plan: Plan, op: Operation, why: str) -> OperationVerdict:
    """The verdict on an operation on which the judge itself failed."""
    limits = plan.inputs.scallop, plan.inputs.allowance, plan.inputs.tolerance.gouge
    return not_measured(op.name, limits, why)


def _pack(judged: _Judged) -> OperationVerdict | bytes:
    """A verdict as it goes from one process to another."""
    if judged.task is None:
        return judged.verdict
    return pack_verdict(judged.verdict, _faces_of(judged.task))


def _faces_of(task: VerificationTask) -> tuple[Face, ...]:
    """The faces of which a verdict has maps."""
    return (*task.targets, *task.skin)


def _judge_copy(turned: TurnedCopies, task: VerificationTask, original: _Measured,
                progress: Progress) -> OperationVerdict | None:
    """The verdict on a turned copy of an operation that was measured; None where it is none, or would not pass so."""
    copy = turned.find(original.task, task)
    if copy is None:
        return None
    measurement = transfer_measurement(task, original.measurement, copy)
    if measurement is None:
        return None
    verdict = verdict_on(task, measurement, progress)
    return verdict if verdict.passed else None


def _task_at(plan: Plan, done: Sequence[Operation], place: int) -> VerificationTask:
    """What the judge is to look at of one of some operations."""
    before = done[place - 1] if place else None
    return _task(plan, done[place], before)


def _task(plan: Plan, op: Operation, before: Operation | None = None) -> VerificationTask:
    """What the judge is to look at: the part's own faces, where some were joined for planning."""
    assert op.path is not None
    targets = own_pieces(op.face)
    around = _surroundings_for_judge(plan, op, targets)
    at_walls = [op.face.trimmed(zone.loops) for zone in op.zones if zone.at_wall]
    declared = tuple(own for face in at_walls for own in own_pieces(face, only_exact=True))
    fixed_axis = op.orientation.axis if op.orientation.lead is None else None
    angles_at_start = op.time.rotary if op.time else ()
    machine = plan.machine
    on_table = None if machine is None or machine.table_from_part is None else placement(machine.table_from_part)
    return VerificationTask(
        op.name, op.path.cl, op.path.axis, op.path.kind, op.tool.profile, targets,
        plan.inputs.scallop, plan.inputs.allowance_of(op.face), around.skin, around.touching, around.others,
        op.tool.outlines, plan.inputs.tolerance.for_cutter(op.tool.radius), declared, fixed_axis,
        machine=None if machine is None else machine.machine, place=on_table, tool_length=op.tool.gauge_length,
        rotary=op.rotary or angles_at_start, before=_end_of(before, op.tool), held=_side_for_judge(plan),
        stock=plan.inputs.stock, proud=_proud(plan), greatest_step_over=plan.inputs.greatest_step_over,
        left_on=_left_on(plan, targets), lead=plan.inputs.lead)


class _Surroundings(NamedTuple):
    """The part's own faces around those that an operation machines, as the judge tells them apart."""

    skin: tuple[Face, ...]
    touching: tuple[Face, ...]
    others: tuple[Face, ...]


def _surroundings_for_judge(plan: Plan, op: Operation, targets: Sequence[Face]) -> _Surroundings:
    tolerance = plan.inputs.tolerance.for_cutter(op.tool.radius)
    obstacles = [face for body in plan.obstacles for face in body.faces]
    around = group_surroundings(op.face, tolerance, plan.inputs.allowance_of(op.face),
                                part=plan.part_around(op.face.number), obstacles=obstacles)
    avoided = _avoided_faces(plan, op)
    own_key = op.face.number, op.face.label
    found: dict[str, list[Face]] = {SKIN: [], TOUCHING: [], OTHER: []}
    for group in around:
        beside = [face for face in group.faces if (face.number, face.label) != own_key and face not in targets]
        for own in (own for face in beside for own in own_pieces(face)):
            is_another_role = own in avoided or own.label == HELD_SIDE
            if not is_another_role and (group.role == OTHER or own.number not in plan.inputs.avoid):
                found[group.role].append(own)
    return _Surroundings(tuple(found[SKIN]), tuple(found[TOUCHING]), (*found[OTHER], *avoided))


def _avoided_faces(plan: Plan, op: Operation) -> tuple[Face, ...]:
    """The part's own faces that no tool may touch, none of which an operation may machine."""
    whole = plan.part.original or plan.part
    avoided = tuple(face for face in whole.faces if face.number in plan.inputs.avoid)
    touched = [face for face in avoided if face.number in op.face.numbers]
    if touched:
        raise InvalidInput(f"operation {op.name} machines face {touched[0].label}, which is to be avoided: make the "
                           "plan again")
    return avoided


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
    machined = {face.number for face in targets}
    every = [own for face in plan.part.faces for own in own_pieces(face)]
    others = [own for own in every if own.number not in machined]
    with_allowance = [(own, plan.inputs.allowance_of(own)) for own in others]
    return tuple((own, left) for own, left in with_allowance if left > 0)


def _end_of(op: Operation | None, tool: Tool) -> tuple[Array, Array, tuple[float, ...]] | None:
    """Where an operation ends: tip, axis and rotary angles; None where its axis moves, at the start, and before another
    tool."""
    if op is None or op.path is None or op.tool != tool:
        return None
    axis_moves = op.orientation.lead is not None
    if axis_moves or not op.rotary:
        return None
    return op.path.cl[-1], op.path.axis[-1], op.rotary


def verdict_document(plan: Plan, verdict: Verdict) -> dict[str, Any]:
    """A verdict as a document that `json.dump` takes.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    return {
        "schema": "toolaxis.verdict",
        "version": 1,
        "passed": passes(plan, verdict),
        "made_passed": has_passes(plan, verdict),
        "complete": not verdict.unjudged,
        "unjudged": list(verdict.unjudged),
        "reasons": _reasons(plan, verdict),
        "not_checked": list(not_judged(plan, verdict)),
        "part": _account(plan, verdict),
        "operations": [_operation_document(op) for op in verdict.operations],
    }


def _reasons(plan: Plan, verdict: Verdict) -> list[str]:
    """Why a plan does not pass: what the judge found, what has no axis, and what the plan itself tells."""
    without_path = [op for op in plan.operations if op.path is None]
    missing = [op.name for op in without_path if outcome_of([op], plan.blades) != "complete"]
    return [*verdict.reasons,
            *(f"{name}: no axis, nothing to verify" for name in missing),
            *(f"between operations: {why}" for why in plan.in_the_way),
            *(f"the plan: {why.sentence}" for why in plan.faults)]


def _account(plan: Plan, verdict: Verdict) -> dict[str, float]:
    """How much of the faces that were asked for passed, mm^2."""
    planned = plan.account
    passed = sum(op.area - op.declared for op in verdict.operations if op.passed)
    verified = min(float(passed), planned.area)
    left = planned.area - verified - planned.unreachable - planned.not_begun
    return {
        "area": planned.area,
        "verified": verified,
        "unreachable": planned.unreachable,
        "open": max(left, 0.0),
        "not_begun": planned.not_begun,
    }


def not_judged(plan: Plan, verdict: Verdict) -> tuple[str, ...]:
    """What the verdict says nothing of.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    missing = [name for name in plan.not_checked if not name.startswith("collision with the machine")]
    if plan.machine is None:
        return tuple(missing)
    on_paths = all("machine" in op.clearance for op in verdict.operations)
    on_index_moves = all("index move" in op.clearance for op in verdict.operations[1:])
    if not on_paths:
        missing.append("collision with the machine itself")
    elif not on_index_moves:
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
    return {
        "face": place.face,
        "uv": list(place.uv),
        "point": list(place.point),
        "value": _number(place.value),
        "cl_point": place.motion + 1,
    }


def _zone(zone: MapZone) -> dict[str, Any]:
    return {
        "face": zone.face,
        "area": zone.area,
        "low": list(zone.low),
        "high": list(zone.high),
        "largest": _number(zone.largest),
        "reason": zone.reason,
        "at_border": zone.at_border,
    }


def _clearances(found: Mapping[str, Clearance | str]) -> dict[str, Any]:
    return {name: _number(room.distance) if isinstance(room, Clearance) else room for name, room in found.items()}


def _operation_document(op: OperationVerdict) -> dict[str, Any]:
    return {
        "name": op.name,
        "faces": list(op.faces),
        "passed": op.passed,
        "reasons": list(op.reasons),
        "scallop_limit": op.scallop_limit,
        "allowance": op.allowance,
        "scallop_max": _number(op.scallop_max),
        "share_within": op.share_within,
        "declared": op.declared,
        "gouge_max": op.gouge_max if op.measured else None,
        "gouge_allowed": op.gouge_allowed,
        "clearance": _clearances(op.clearance),
        "worst_scallop": [_place(place) for place in op.worst_scallop],
        "worst_gouge": [_place(place) for place in op.worst_gouge],
        "zones": [_zone(zone) for zone in op.zones],
        "area": op.area,
        "rays": op.rays,
        "spacing": op.spacing,
        "uncertainty": op.uncertainty,
        "least_lean": None if op.lean is None else op.lean.angle,
        "step_over": None if op.step_over is None else op.step_over.distance,
        "lead_arcs": None if op.leads is None else {"arcs": op.leads.arcs, "ends": op.leads.ends},
        "stock": op.stock,
        "clearance_from_stock_faces": _clearances(op.from_stock),
    }
