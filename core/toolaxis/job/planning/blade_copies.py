"""What is done on one blade, turned to the others and proven again there."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.contact.clearance.gouge import least_distance
from toolaxis.contact.clearance.queries import keeps_limits as decided
from toolaxis.contact.clearance.queries import segment_motions
from toolaxis.errors import Cancelled, Fault, ToolAxisError, fault
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.job.planning.blade_pattern import BladeFaces, Pattern
from toolaxis.job.planning.clean_up_zones import with_zones
from toolaxis.job.planning.edit_axis import evaluate_given_axis, frame_of
from toolaxis.job.planning.failures import fail_face, fail_operation
from toolaxis.job.planning.parallel import Outcome, abreast
from toolaxis.plan.blades import PlannedBlade
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.messages import sentence
from toolaxis.search.path_check import COMPONENTS, prove
from toolaxis.shape.counterparts import SAME, apply_motion, turn_piece
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
#: Operations of one blade, and for each the number of the one that it copies; 0 where its axis was searched anew.
_OnBlade: TypeAlias = tuple[list[Operation], list[int]]

#: By how much figures of a copy may be worse than the original's before they are measured anew, mm.
_SLACK, _FINER = 0.01, 1e-4


class FacePlanner(Protocol):
    """What plans faces of a part."""

    @property
    def workers(self) -> int:
        """Processes to work with."""

    def task(self, part: Part, face: Face, tool: Tool, progress: Progress) -> FaceProblem:
        """What decides about an axis for a face of a part."""

    def search(self, part: Part, op: Operation, progress: Progress) -> Operation:
        """An operation on its face of a part, its axis searched anew."""


def with_refused(first: Plan, pattern: Pattern, share: BladeFaces) -> Plan:
    """The plan of the first blade with the faces that cannot be machined, or are left to clean-up, at its end.

    Parameters
    ----------
    first : Plan
    pattern : Pattern
    share : BladeFaces
    """
    faces = [(pattern.face(number), "infeasible", why) for number, why in share.refused.items()]
    faces += [(pattern.face(number), "not_found", why) for number, why in share.left.items()]
    made = []
    for number, (face, outcome, why) in enumerate(faces, len(first.operations) + 1):
        none = Orientation(None, outcome=outcome, reasons=(why,))
        zones = (Zone(face.outline, face.area),) if face.number in share.left else ()
        made.append(Operation(number, face, first.tools[-1], none, zones=zones))
    return replace(first, operations=(*first.operations, *made))


def append_operations(plan: Plan, other: Plan) -> Plan:
    """A plan with the operations of another one after its own.

    Parameters
    ----------
    plan, other : Plan
    """
    more = tuple(renumber(op, len(plan.operations)) for op in other.operations)
    worst = next((name for name in ("cancelled", "incomplete") if name in (plan.outcome, other.outcome)), "complete")
    return replace(plan, operations=plan.operations + more, outcome=worst, faults=(*plan.faults, *other.faults),
                   unplanned=(*plan.unplanned, *other.unplanned))


def renumber(op: Operation, before: int) -> Operation:
    """An operation behind so many others, with the numbers of those whose rest it machines.

    Parameters
    ----------
    op : Operation
    before : int
    """
    return replace(op, number=op.number + before, rest_of=tuple(one + before for one in op.rest_of))


def spread_out(pattern: Pattern, first: Plan, planner: FacePlanner, progress: Progress) -> Plan:
    """The plan of the first blade carried over to all blades.

    Parameters
    ----------
    pattern : Pattern
    first : Plan
        Operations of the first blade.
    planner : FacePlanner
    progress : Progress

    Returns
    -------
    Plan
        With `blades`; cancelled where the user stopped it, with the blades that were finished.
    """
    count = len(pattern.blades.blades)
    done = abreast(lambda k, inner: _on_blade(pattern, k, first, planner, inner.within(f"blade {k + 2} of {count}")),
                   count - 1, planner.workers, progress)
    with activate_progress(NO_PROGRESS):  # what is finished is put together, whoever wants to stop
        made = _with_blades(pattern, first, done)
    if not done.cancelled:
        assert made.blades is not None
        own = {op.number for op in made.operations[len(first.operations):] if op.done}
        made = _add_zones_anew(made, own - _exact(made), progress)
    with activate_progress(NO_PROGRESS):
        assert made.blades is not None
        measured = tuple(_measure_blade(pattern, k, made.operations) for k in range(count))
        return replace(made, blades=replace(made.blades, blades=measured))


def _with_blades(pattern: Pattern, first: Plan, done: Outcome[_OnBlade]) -> Plan:
    """The plan of the first blade with what came of the others."""
    every = {**done.results, **{k: _fail_blade(pattern, k, first, why) for k, why in done.faults.items()}}
    operations, copies, searched = list(first.operations), {}, []
    for k in sorted(every):
        before = len(operations)
        for original, op, source in zip(first.operations, *every[k], strict=True):
            face = pattern.part.face(op.face.number)
            placed = replace(op, number=original.number, rest_of=original.rest_of,
                             face=face.trimmed(op.face.trims, op.face.label))
            operations.append(renumber(placed, before))
            if source:
                copies[operations[-1].number] = source
            elif op.done:
                searched.append(operations[-1].number)
    outcome = "cancelled" if done.cancelled else outcome_of(operations, pattern.blades)
    blades = replace(pattern.blades, copies=copies, searched=tuple(searched))
    return replace(first, part=pattern.part, operations=tuple(operations), outcome=outcome, blades=blades)


def _fail_blade(pattern: Pattern, k: int, first: Plan, why: Fault) -> _OnBlade:
    """Operations of blade k + 2, on which the program failed."""
    lost = []
    for op in first.operations:
        face = pattern.part.face(pattern.matching[k][op.face.number].face.number)
        lost.append(fail_face(op.number, face, op.tool, why))
    return lost, [0] * len(lost)


def _exact(plan: Plan) -> set[int]:
    """Numbers of the copies whose very path was turned."""
    assert plan.blades is not None
    return {n for n in plan.blades.copies if plan.operations[n - 1].orientation.evaluations == 1}


def _add_zones_anew(plan: Plan, numbers: set[int], progress: Progress) -> Plan:
    """The plan with the clean-up zones of those operations whose passes are not turned copies."""
    made = []
    try:
        for op in plan.operations:
            progress.check()
            made.append(_add_zones(plan, op) if op.number in numbers else op)
    except Cancelled:
        return replace(plan, outcome="cancelled")
    outcome = plan.outcome if plan.outcome == "cancelled" else outcome_of(made, plan.blades)
    return replace(plan, operations=tuple(made), outcome=outcome)


def _add_zones(plan: Plan, op: Operation) -> Operation:
    """An operation with its zones; a failed one where the program fails on them."""
    try:
        return with_zones(plan, op)
    except Cancelled:
        raise
    except Exception as reason:
        return fail_operation(op, fault(reason))


def _measure_blade(pattern: Pattern, k: int, operations: Sequence[Operation]) -> PlannedBlade:
    """A blade with the areas that are machined and left."""
    blade = pattern.blades.blades[k]
    own = [op for op in operations if pattern.blades.blade_of(op.face.number) == k + 1]
    account = PartAccount.of(own)
    return replace(blade, area=account.area, left=account.area - account.machined)


def _on_blade(pattern: Pattern, k: int, first: Plan, planner: FacePlanner, progress: Progress) -> _OnBlade:
    """Operations of blade k + 2, and for each the number of the one it copies; 0 where its axis was searched anew."""
    known: _KnownGroups = {}
    found, taken = [], []
    for index, op in enumerate(first.operations):
        progress.report("proof of turned operations", index, len(first.operations))
        try:
            made, copied = _elsewhere(pattern, k, op, (planner, known, progress))
        except Cancelled:
            raise
        except Exception as reason:
            made, copied = _fail_blade(pattern, k, replace(first, operations=(op,)), fault(reason))[0][0], False
        found.append(made)
        taken.append(op.number if copied else 0)
    return found, taken


_KnownGroups: TypeAlias = dict[tuple[Tool, frozenset[int]], tuple[CheckSurfaces, ...]]
_Means = tuple[FacePlanner, _KnownGroups, Progress]


def _elsewhere(pattern: Pattern, k: int, op: Operation, means: _Means) -> tuple[Operation, bool]:
    """An operation on another blade, and whether it is the turned copy."""
    planner, _, progress = means
    number = op.face.number
    other, matrix = pattern.matching[k][number], pattern.motions[k]
    suffix = op.face.label.removeprefix(str(number))
    piece, away = turn_piece(op.face, pattern.face(number), other, matrix, f"{other.face.number}{suffix}")
    apart = pattern.blades.apart(pattern.part, piece.number)
    if not op.done:
        whole = tuple(Zone(piece.outline, piece.area) for _ in op.zones)
        return Operation(op.number, piece, op.tool, replace(op.orientation, map=None, lobes=()), zones=whole), True
    assert op.path is not None and op.orientation.axis is not None
    task = planner.task(apart, piece, op.tool, progress)
    axis = matrix[:3, :3] @ op.orientation.axis
    swapped = other.chart.swapped if other.chart is not None else None
    if away <= SAME and swapped is not None:
        assert other.chart is not None
        turned = _turn_operation(op, piece, matrix, swapped)
        chart = other.chart
        zones = tuple(replace(zone, loops=tuple(chart(loop) for loop in zone.loops)) for zone in op.zones)
        made, why = _proven(replace(turned, zones=zones), task, _groups(task, means), first_datum(op))
    else:
        made, why = _replan_turned(op, piece, task, axis, swapped)
    if made is not None:
        return made, True
    anew = planner.search(apart, replace(op, face=piece), progress)
    note = f"the turned axis of {op.name} was refused here: {why}"
    return replace(anew, orientation=replace(anew.orientation, reasons=(note, *anew.orientation.reasons))), False


def first_datum(op: Operation) -> Array:
    """The origin of an operation's work coordinate system, (3,) mm.

    Parameters
    ----------
    op : Operation
        With one.
    """
    assert op.frame is not None
    return op.frame.origin


def _turn_operation(op: Operation, piece: Face, matrix: Array, swapped: bool) -> Operation:
    """An operation with everything turned, not yet proven."""
    assert op.path is not None and op.orientation.axis is not None
    turn, path, found = matrix[:3, :3], op.path, op.orientation
    assert found.axis is not None
    axis = turn @ found.axis
    axis /= np.linalg.norm(axis)
    feed = found.feed if not swapped else "v" if found.feed == "u" else "u"
    left = tuple(why for why in found.reasons if why.endswith("left as rest material"))
    return Operation(op.number, piece, op.tool, replace(found, axis=axis, feed=feed, map=None, lobes=(), zones=(),
                                               evaluations=1, reasons=(f"turned copy of {op.name}", *left)),
                     turn_path(path, matrix, axis))


def turn_path(path: ToolPath, matrix: Array, axis: Array) -> ToolPath:
    """A path with one fixed axis after a motion.

    Parameters
    ----------
    path : ToolPath
    matrix : (4, 4) array
        Rigid motion, or one with a mirror.
    axis : (3,) array
        The moved axis, of length 1.
    """
    return ToolPath(apply_motion(matrix, path.cc), apply_motion(matrix, path.cl), np.tile(axis, (len(path.cl), 1)),
                    path.normal @ matrix[:3, :3].T, path.kind, path.breaks)


def _groups(task: FaceProblem, means: _Means) -> tuple[CheckSurfaces, ...]:
    """The surroundings of a task's face; those of one skin share their cells."""
    known = means[1]
    key = task.worth.tool, frozenset(face.number for face in task.groups[0].faces)
    return known.setdefault(key, task.groups)


def _proven(op: Operation, task: FaceProblem, groups: tuple[CheckSurfaces, ...],
            datum: Array) -> tuple[Operation | None, str]:
    """A turned operation with what is proven of it on the real faces, or why it is refused.

    It is decided first whether nothing is worse than on the first blade but for rounding; measured only where it is.
    """
    path, found = op.path, op.orientation
    assert path is not None and found.axis is not None
    limits, tool, allowance = task.feasibility.limits, task.worth.tool, task.worth.allowance
    if limits is not None and not limits.allowed(found.axis[None])[0]:
        return None, "the machine does not allow it"
    moves = segment_motions(path.cl, path.axis[0])
    least = {name: value - _SLACK for name, value in found.clearance.items()}
    depth = found.gouge + _FINER
    keep = [np.tile(_distances_to_keep(group, least, least_distance(tool, depth, allowance)), (len(group.faces), 1))
            for group in groups]
    # Only the proof tells links in stock apart.
    same = not any(group.stock > 0 for group in groups) and all(
        (decided(group.cells, tool, moves, table).blocked < 0).all() for group, table in zip(groups, keep, strict=True))
    if same:
        least = {name: max(value, float(groups[0].required[COMPONENTS.index(name)])) if name != "cutter" else
                 max(value, task.feasibility.tolerance.cutter_clearance) for name, value in least.items()}
        depth = min(depth, task.feasibility.tolerance.gouge)
    else:
        proof = prove(path, tool, groups, allowance, progress=task.progress)
        if proof.witness is not None:
            return None, sentence(proof.witness, task.feasibility)
        least, depth = proof.clearance, proof.gouge
    made = replace(found, clearance=least, gouge=depth)
    return replace(op, orientation=made, frame=frame_of(op.face, made, datum)), ""


def _distances_to_keep(group: CheckSurfaces, least: dict[str, float], depth: float) -> Array:
    """Distances to decide by: those to keep, or the first blade's where these are greater, (3,)."""
    wanted = np.array([least.get(name, -np.inf) for name in COMPONENTS])
    if group.role == SKIN:
        wanted[0] = depth
    elif group.role != OTHER:
        wanted[0] = -np.inf
    return np.maximum(group.required, wanted)


def _replan_turned(op: Operation, piece: Face, task: FaceProblem, axis: Array,
                   swapped: bool | None) -> tuple[Operation | None, str]:
    """The turned axis with passes of its own on the real face, or why it is refused."""
    feeds = {None: None, False: op.orientation.feed, True: "v" if op.orientation.feed == "u" else "u"}
    try:
        found, path = evaluate_given_axis(task, axis, feeds[swapped])
    except Cancelled:
        raise
    except ToolAxisError as reason:
        return None, str(reason)
    if path is None:
        return None, "; ".join(found.reasons)
    note = f"turned copy of {op.name}, its passes laid anew: the faces differ"
    made = replace(found, evaluations=2, reasons=(note, *found.reasons))
    return Operation(op.number, piece, op.tool, made, path, frame_of(piece, made, first_datum(op)), made.zones), ""
