"""The best fixed axis for a face (3+2-axis machining): search, proof on the passes really made, and the reasons."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.feasibility.surroundings import Obstacles
from toolaxis.feasibility.violations import Violation
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.machine.limits import AxisLimits
from toolaxis.machine.setup import MachineLike
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.pass_pattern import pattern_names
from toolaxis.plan.choices import FEEDS, ISO
from toolaxis.plan.orientation import Orientation
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.few_in_the_way import find_few_in_the_way, list_axes_to_try
from toolaxis.search.hemisphere import next_in_lobe, search, so_far
from toolaxis.search.infeasibility import corner_too_large, spread_too_wide
from toolaxis.search.kinematic_axis import by_jerk, describe_jerk, next_by_jerk
from toolaxis.search.known_axes import find_known_axis
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.machine_limits import (
    REFUSED,
    better_of,
    intersect_limits,
    make_room,
    snap_to_increments,
)
from toolaxis.search.messages import (
    Refusal,
    direction,
    main_first,
    sentence,
    tally,
    why_none,
)
from toolaxis.search.other_feed import check_other_feed
from toolaxis.search.rank_by_passes import least_made
from toolaxis.search.sectors import by_mean_normal, by_roman, sectors
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import ToleranceLike
from toolaxis.tools.tool import Tool
from toolaxis.work import OutOfWork, allow_proof, better_may_exist, is_out_of_work, up_to

Array = NDArray[np.float64]
#: An orientation, and its passes, which were proven; None where there is no axis.
FoundAxis: TypeAlias = tuple[Orientation, ToolPath | None]


class Method(NamedTuple):
    """A way to find a fixed axis.

    find : takes an empty `AxisTable` and returns the best axes, best first
    next_axis : another axis in the place of one that the proof of the passes refused; None where none is tried
    by_cost : whether it looks for the least cost, and so is worth a second run where the machine turned out to need
        more room
    any_feed : whether its axes go with either feed
    describe : what it found, in words; None where there is nothing to say
    """

    find: Callable[[AxisTable], list[CountedAxis]]
    next_axis: Callable[[AxisTable, CountedAxis, Violation, int], CountedAxis | None] | None = next_in_lobe
    by_cost: bool = True
    any_feed: bool = True
    describe: Callable[[AxisTable, Array, ToolPath], str] | None = None


METHODS = {"sphere": Method(search), "sectors": Method(sectors),
           "jerk": Method(by_jerk, next_by_jerk, by_cost=False, any_feed=False, describe=describe_jerk),
           "roman": Method(by_roman, None, by_cost=False), "normal": Method(by_mean_normal, None, by_cost=False)}

_ATTEMPTS = 4
#: Shares of the work that is left, where it is limited: for the search, and for the order of what it found.
_SEARCHED, _ORDERED = 0.5, 0.4
#: How often a face for which there is no axis is tried again without few places that are in the way.
_LEAVINGS = 2


def best_axis(face: Face, tool: Tool, scallop: float, machine: MachineLike | None = None, obstacles: Obstacles = None,
              method: str = "sphere", objective: str = "length", *, part: Part | None = None,
              skin: Sequence[Face] = (), surroundings: Sequence[Face] = (), tolerance: ToleranceLike = None,
              allowance: float = 0.0, limits: AxisLimits | str | None = None, direction: str = "zigzag",
              passes: str = ISO, starts: ArrayLike | None = None, feeds: Feeds | None = None,
              greatest_step_over: float = np.inf, lead: float = 0.0,
              progress: Progress = NO_PROGRESS) -> Orientation:
    """The fixed tool axis that machines a face with the least cutting length, in the fewest passes, or in least time.

    Parameters
    ----------
    face : Face
    tool : Tool
    scallop : float
        Scallop height, mm.
    machine : Machine, Mounting, AxisLimits or str, optional
        A machine, its name or file, one with the part on its table, or limits of the axis, also in their short form.
    obstacles : Part, Face or sequence of Face, optional
        What the tool must keep away from besides the part.
    method : str
        "sphere": the whole hemisphere; "sectors": projection planes and quasi-feasible sectors; "jerk": the axis at
        whose rotary angles the linear axes of the machine together do most along the passes; for comparison "roman":
        the axis of Roman's rule, and "normal": the mean normal, each with the same proof and nothing beside it.
    objective : str
        "length", "passes" or "time": what is to be least. Time goes by an estimate (`toolaxis.search.time_estimate`),
        and by the planner of feeds between the best axes of different lobes.
    part : Part, optional
        The part that the face belongs to, by its number: its skin and its other faces are looked after.
    skin, surroundings : sequence of Face
        Faces that continue this one smoothly, and others, where there is no part.
    tolerance : float or Tolerance, optional
        The machining tolerance, mm, or all tolerances: 0.01 mm unless given.
    allowance : float
        Stock left on the face, mm.
    limits : AxisLimits or str, optional
        Further limits.
    direction : str
        "zigzag", "climb" or "conventional": the passes that are proven.
    passes : str
        "iso": along a parameter; "planes": along parallel planes that contain the tool axis; "scallop": along levels of
        a field that keeps them as far apart as their strips are wide; "auto": the shorter of "iso" and "scallop".
    starts : (k, 3) array_like, optional
        Axes that are worth a look before others, such as a division's; for the method "sphere".
    feeds : Feeds, optional
        What is programmed; for the objective "time", which also needs a machine that states its limits.
    greatest_step_over : float
        Greatest distance of neighbouring passes on the face, mm, whatever the scallop height allows.
    lead : float
        Radius of the arcs at the ends of passes, where these are proven free, mm; 0 for none.
    progress : Progress

    Returns
    -------
    Orientation
        "feasible" with axis, passes made and what was proven; "infeasible" where it is proven that there is none;
        "not_found" where none was found; "cancelled" with what is known so far.

    Raises
    ------
    InvalidInput
        When an argument is out of range.

    Notes
    -----
    **Source**: [zhu2016] Eq. (8): greatest strip width under gouge and interference constraints, here with bounds.

    **Properties**: 1. the result does not depend on the number of threads or on earlier calls; 2. moving face and
    surroundings together moves the axis; 3. no motion of the passes breaks a limit.
    """
    if method not in METHODS:
        raise InvalidInput(f"method is {method!r}: it must be one of {', '.join(METHODS)}")
    job = task(face, tool, scallop, intersect_limits(machine, limits), obstacles, objective=objective, part=part,
               skin=skin, surroundings=surroundings, tolerance=tolerance, allowance=allowance, direction=direction,
               passes=passes, feeds=feeds, greatest_step_over=greatest_step_over, lead=lead, progress=progress)
    return find_axis(job, method, starts)[0]


def find_axis(job: FaceProblem, method: str = "sphere", starts: ArrayLike | None = None) -> FoundAxis:
    """The axis that `best_axis` finds for a task, and its passes, which were proven; None where there is no axis.

    Where the shorter of several patterns of passes is to be taken, each has its own axis.

    Parameters
    ----------
    job : FaceProblem
    method : str
        One of `METHODS`.
    starts : (k, 3) array_like, optional
        Axes that are worth a look before others.
    """
    names = pattern_names(job.worth.passes)
    if len(names) == 1:
        return _find_axis(job, method, starts)
    found = _find_axis(replace(job, worth=replace(job.worth, passes=names[0])), method, starts)
    for name in names[1:]:
        if found[0].outcome == "cancelled":
            break
        with suppress(OutOfWork):
            found = better_of(found, _find_axis(replace(job, worth=replace(job.worth, passes=name)), method, starts))
    return found


def _find_axis(job: FaceProblem, method: str, starts: ArrayLike | None) -> FoundAxis:
    """The axis and its passes for passes of one pattern; where few places refuse every axis, these are left."""
    first = np.empty((0, 3)) if starts is None else unit(as_rows(starts, 3, "starts"))
    result, ledger = _search_once(job, method, first)
    for _ in range(_LEAVINGS):
        if not _may_leave_places(result[0], method):
            break
        try:
            few = find_few_in_the_way(ledger.feasibility, list_axes_to_try(ledger, first))
        except OutOfWork:
            break
        if not len(few.points):
            break
        own = job.feasibility
        job = replace(job, feasibility=replace(own, left=own.left.and_more(few)))
        result, ledger = _search_once(job, method, first)
    return result


def _may_leave_places(found: Orientation, method: str) -> bool:
    """Whether few places may be why no axis was found."""
    lost = found.outcome in ("infeasible", "not_found") and not is_out_of_work(found.reasons)
    return lost and METHODS[method].next_axis is next_in_lobe


def _search_once(job: FaceProblem, method: str, first: Array) -> tuple[FoundAxis, AxisTable]:
    """The axis and its passes as they are found at once, and all axes that were looked at."""
    ledger = AxisTable(job.feasibility, job.worth, job.progress, first)
    result: FoundAxis | None = None
    try:
        impossible = spread_too_wide(job.feasibility) or corner_too_large(job.feasibility)
        if impossible:
            none = Orientation(None, outcome="infeasible", reasons=(f"infeasible: {impossible}",))
            return (none, None), ledger
        result = _first_proven(job, ledger, method)
        if ledger.feasibility.limits is job.feasibility.limits or not METHODS[method].by_cost:
            return result, ledger
        ledger = AxisTable(ledger.feasibility, job.worth, job.progress, first)
        return better_of(result, _first_proven(job, ledger, method)), ledger
    except Cancelled:
        return (Orientation(None, outcome="cancelled", reasons=("cancelled by the user",),
                            evaluations=ledger.evaluations, map=ledger.map()), None), ledger
    except OutOfWork as reason:
        if result is not None and result[0].axis is not None:
            return _note_end(result), ledger
        return (Orientation(None, outcome="not_found", reasons=(str(reason), tally(ledger)),
                            evaluations=ledger.evaluations, map=ledger.map()), None), ledger


def _first_proven(job: FaceProblem, ledger: AxisTable, method: str) -> FoundAxis:
    """The best axis that a method finds and the proof accepts, of those that it found when the work for it was done."""
    how = METHODS[method]
    known = find_known_axis(job, ledger) if how.by_cost and how.any_feed else None
    if known is not None:
        done, words = known
        reasons = (*done.orientation.reasons, words, tally(ledger))
        return replace(done.orientation, reasons=reasons, map=ledger.map(), evaluations=ledger.evaluations), done.path
    if how.next_axis is None:
        return first_proven(job, ledger, how.find(ledger), how)
    try:
        with up_to(_SEARCHED):
            found = how.find(ledger)
    except OutOfWork as reason:
        found = snap_to_increments(ledger, so_far(ledger))
        if found:
            allow_proof()
        result, path = _first_accepted(job, ledger, found, how)
        if result.axis is not None:
            return _note_end((result, path))
        return replace(result, outcome="not_found", reasons=(str(reason), *result.reasons)), None
    return first_proven(job, ledger, found, how)


def _note_end(found: FoundAxis) -> FoundAxis:
    """An axis that is proven, with the word that the limit of work ended the search for a better one."""
    words, (result, path) = better_may_exist(), found
    known = words in result.reasons
    return (result if known else replace(result, reasons=(*result.reasons, words))), path


def first_proven(job: FaceProblem, ledger: AxisTable, found: list[CountedAxis],
                 method: Method = METHODS["sphere"]) -> FoundAxis:
    """The best candidate that the proof accepts, with its passes, or why there is none.

    Parameters
    ----------
    job : FaceProblem
    ledger : AxisTable
    found : list of CountedAxis
        The best of each lobe, best first.
    method : Method
        How they were found.

    Raises
    ------
    OutOfWork
        When the work that was allowed is done, and none was accepted.
    """
    found = snap_to_increments(ledger, found)
    if found:
        allow_proof()
    if found and found[0].length > job.worth.index_length:  # shorter cuts differ by less than matters
        with suppress(OutOfWork), up_to(_ORDERED):
            found = least_made(job.worth, found, job.made)
    return _first_accepted(job, ledger, found, method)


def _first_accepted(job: FaceProblem, ledger: AxisTable, found: list[CountedAxis],
                    method: Method) -> FoundAxis:
    """The first candidate that the proof accepts, with its passes, or why there is none."""
    refused: list[Refusal] = []
    for k, one in enumerate(found):
        best = _accept_candidate(job, ledger, one, refused, method)
        if best is None:
            continue
        others: tuple[Orientation, ...] = ()
        with suppress(OutOfWork):  # only other feeds and lobes are left to be looked at
            if method.any_feed:
                best = check_other_feed(job, ledger, best) or best
            others = tuple(_other(job, other) for other in found[k + 1:] if _sound(job, other))
        own: tuple[str, ...] = ()
        if method.describe is not None and best.path is not None:
            own = (method.describe(ledger, best.one.axis, best.path),)
        reasons = (*own, *best.orientation.reasons, *(why.words for why in refused), tally(ledger))
        return replace(best.orientation, reasons=reasons, map=ledger.map(), evaluations=ledger.evaluations,
                       lobes=others), best.path
    if ledger.proven:
        outcome, lead = "infeasible", "infeasible: limits and normals leave no axis"
    else:
        outcome, lead = "not_found", "no axis found"
    words = main_first(refused) if found else [f"{lead}: {why_none(ledger)}"]
    return Orientation(None, outcome=outcome, reasons=(*words, tally(ledger)), map=ledger.map(),
                       evaluations=ledger.evaluations), None


def _sound(job: FaceProblem, one: CountedAxis) -> bool:
    return job.feasibility.witness(one.axis) is None


def _accept_candidate(job: FaceProblem, ledger: AxisTable, one: CountedAxis, refused: list[Refusal],
                      method: Method) -> CheckedCandidate | None:
    """What became of a candidate, repaired a few times where the proof refuses it; None when it stays refused."""
    candidate: CountedAxis | None = one
    for attempt in range(_ATTEMPTS):
        if candidate is None:
            return None
        witness = ledger.feasibility.witness(candidate.axis)
        if witness is None:
            done = check_candidate(job, candidate)
            if done.proof.witness is None:
                return done
            witness, job = done.proof.witness, replace(job, laid_for=min(job.laid_for, done.laid_for))
        words = f"{REFUSED}{direction(candidate.axis)}: {sentence(witness, ledger.feasibility)}"
        refused.append(Refusal(witness.reason, witness.amount, words))
        make_room(ledger, candidate.axis, witness)
        if method.next_axis is None or attempt + 1 == _ATTEMPTS:
            return None
        candidate = method.next_axis(ledger, candidate, witness, attempt)
    return None


def _other(job: FaceProblem, one: CountedAxis) -> Orientation:
    """The best axis of another lobe; its passes were not made."""
    return Orientation(one.axis, FEEDS[one.feed], 0, one.passes, one.length,
                       job.worth.face.area / one.length, outcome="feasible", unreached=one.unreached)


def evaluate_axis(face: Face, tool: Tool, axis: ArrayLike, scallop: float, machine: MachineLike | None = None,
                  obstacles: Obstacles = None, feed: str | None = None, objective: str = "length", *,
                  part: Part | None = None, skin: Sequence[Face] = (), surroundings: Sequence[Face] = (),
                  tolerance: ToleranceLike = None, allowance: float = 0.0, limits: AxisLimits | str | None = None,
                  progress: Progress = NO_PROGRESS) -> Orientation:
    """What one given axis comes to, judged as `best_axis` judges its own.

    Parameters
    ----------
    face, tool, scallop, machine, obstacles, objective, part, skin, surroundings, tolerance, allowance, limits, progress
        As for `best_axis`.
    axis : (3,) array_like
        From tip to spindle.
    feed : "u" or "v", optional
        The better one unless given.

    Returns
    -------
    Orientation
        "infeasible" with the reason where the axis breaks a limit.

    Raises
    ------
    InvalidInput
        When an argument is out of range.
    """
    if feed not in (None, *FEEDS):
        raise InvalidInput(f"feed is {feed!r}: it must be 'u' or 'v'")
    job = task(face, tool, scallop, intersect_limits(machine, limits), obstacles, objective=objective, part=part,
               skin=skin, surroundings=surroundings, tolerance=tolerance, allowance=allowance, progress=progress)
    t = unit(as_rows(axis, 3, "axis")[0])
    ledger = AxisTable(job.feasibility, job.worth, progress)
    feeds = [k for k, name in enumerate(FEEDS) if feed in (None, name)]
    try:
        witness = job.feasibility.witness(t)
        if witness is None:
            best = min((CountedAxis(t, k, *ledger.count(t, k, 0.0), 0.0) for k in feeds), key=lambda c: c.value)
            done = check_candidate(job, best)
            if done.proof.witness is None:
                return replace(done.orientation, evaluations=1 + len(feeds))
            witness = done.proof.witness
    except Cancelled:
        return Orientation(None, outcome="cancelled", reasons=("cancelled by the user",))
    return Orientation(None, FEEDS[feeds[0]], outcome="infeasible", evaluations=ledger.evaluations + 1,
                       reasons=(f"infeasible: {sentence(witness, job.feasibility)}",))
