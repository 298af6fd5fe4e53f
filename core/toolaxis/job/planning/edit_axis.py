"""One operation of a plan with another axis: what it comes to, and the plan that takes it over."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.job.planning.timing import add_times, feeds_of
from toolaxis.machine.limits import AxisLimits
from toolaxis.machine.work_coordinates import WorkCoordinates, work_coordinates
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.pass_pattern import feeds_over
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.local_search import count_row
from toolaxis.search.machine_limits import intersect_limits, limit_axes, nearest_held_axis
from toolaxis.search.messages import sentence
from toolaxis.search.other_feed import check_other_feed
from toolaxis.search.sectors import roman_axis
from toolaxis.shape.face import Face

Array = NDArray[np.float64]


def _limits(plan: Plan) -> AxisLimits | None:
    """The limits that the plan was made with, its machine's and those of the held side among them.

    Raises
    ------
    InvalidInput
        When they were of a class that has no short form: leaving them out could call a forbidden axis free.
    """
    return limit_axes(intersect_limits(plan.machine, plan.inputs.limits or None), plan.part.held)


def search_task(plan: Plan, op: Operation, progress: Progress = NO_PROGRESS) -> FaceProblem:
    """What the search for an operation's axis went by.

    Parameters
    ----------
    plan : Plan
    op : Operation
    progress : Progress
    """
    feeds = feeds_of(plan.inputs.at_rates_of(op.tool))
    return task(op.face, op.tool, plan.inputs.scallop, _limits(plan),
                [face for body in plan.obstacles for face in body.faces], objective=plan.inputs.objective,
                part=plan.part_around(op.face.number), tolerance=plan.inputs.tolerance,
                allowance=plan.inputs.allowance_of(op.face),
                direction=plan.inputs.direction, passes=plan.inputs.passes, feeds=feeds,
                greatest_step_over=plan.inputs.step_over, lead=plan.inputs.lead, progress=progress)


def rule_of_thumb(plan: Plan, op: Operation, progress: Progress = NO_PROGRESS) -> Array:
    """The axis that Roman's rule gives an operation, (3,); it may be forbidden.

    Parameters
    ----------
    plan : Plan
    op : Operation
    progress : Progress
    """
    job = search_task(plan, op, progress)
    return roman_axis(AxisTable(job.feasibility, job.worth, progress))


def frame_of(face: Face, found: Orientation, datum: ArrayLike) -> WorkCoordinates:
    """The work coordinate system that an orientation gives a face, drawn in its middle.

    Parameters
    ----------
    face : Face
    found : Orientation
        With an axis.
    datum : (3,) array_like
        Its origin, mm.
    """
    points = face.evaluate(face.places_on(16)).point
    middle = points[int(np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    assert found.axis is not None
    return work_coordinates(found.axis, feeds_over(face, found.feed), datum, middle)


def try_axis(plan: Plan, op: Operation, axis: ArrayLike, feed: str | None = None,
             progress: Progress = NO_PROGRESS) -> Operation:
    """The operation as it would be with a given axis, judged as the search judges its own.

    Parameters
    ----------
    plan : Plan
    op : Operation
    axis : (3,) array_like
        From tip to spindle, in the part's frame.
    feed : "u" or "v", optional
        The better one unless given.
    progress : Progress

    Returns
    -------
    Operation
        With passes and frame where the axis may be used, and with the map and lobes of the search; without them, and
        with the reason, where it may not.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    with activate_progress(progress):
        job = search_task(plan, op, progress)
        found, path = evaluate_given_axis(job, axis, feed)
    found = replace(found, map=op.orientation.map, lobes=op.orientation.lobes)
    if path is None:
        return Operation(op.number, op.face, op.tool, found)
    return Operation(op.number, op.face, op.tool, found, path, frame_of(op.face, found, plan.datum), found.zones)


def evaluate_given_axis(task: FaceProblem, axis: ArrayLike, feed: str | None = None) -> tuple[Orientation,
                                                                                              ToolPath | None]:
    """What a given axis comes to, and the passes that were proven; none where the axis may not be used.

    Parameters
    ----------
    task : FaceProblem
    axis : (3,) array_like
    feed : "u" or "v", optional
        The better one unless given.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    t = nearest_held_axis(task.feasibility.limits, unit(as_rows(axis, 3, "axis")[0]))
    witness = task.feasibility.witness(t)
    found, path = Orientation(None, outcome="infeasible"), None
    if witness is None:
        ledger = AxisTable(task.feasibility, task.worth, task.progress)
        ledger.look(t[None])
        done = _prove_feeds(task, ledger, feed)
        found, path, witness = done.orientation, done.path, done.proof.witness
    task.progress.check()
    if witness is not None:
        reasons = (f"infeasible: {sentence(witness, task.feasibility)}",)
        return Orientation(None, found.feed, outcome="infeasible", reasons=reasons), None
    return found, path


def _prove_feeds(task: FaceProblem, ledger: AxisTable, feed: str | None) -> CheckedCandidate:
    """The passes of the only axis of a ledger with the feed that is given, or that turns out to be the better one."""
    if feed is not None:
        return check_candidate(task, count_row(ledger, 0, FEEDS.index(feed)))
    done = check_candidate(task, count_row(ledger, 0))
    if done.proof.witness is None:
        return check_other_feed(task, ledger, done) or done
    other = check_candidate(task, count_row(ledger, 0, 1 - done.one.feed))
    return other if other.proof.witness is None else done


def with_operations(plan: Plan, chosen: Mapping[int, Operation]) -> Plan:
    """The plan with some of its operations replaced.

    Parameters
    ----------
    plan : Plan
    chosen : mapping of int to Operation
        By number.

    Raises
    ------
    InvalidInput
        When the plan has no operation of a number.
    """
    known = {op.number for op in plan.operations}
    unknown = sorted(set(chosen) - known)
    if unknown:
        raise InvalidInput(f"operation {unknown[0]} is not in the plan: it has {len(known)}, numbered from 1")
    operations = tuple(chosen.get(op.number, op) for op in plan.operations)
    outcome = plan.outcome
    if outcome != "cancelled":
        outcome = outcome_of(operations, plan.blades)
    blades = plan.blades
    if blades is not None:
        kept = {copy: source for copy, source in blades.copies.items() if not {copy, source} & set(chosen)}
        blades = replace(blades, copies=kept)
    return add_times(replace(plan, operations=operations, outcome=outcome, blades=blades))
