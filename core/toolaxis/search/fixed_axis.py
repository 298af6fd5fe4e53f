"""The best fixed axis for a face (3+2-axis machining): search, proof on the passes really made, and the reasons."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.gouge import least_distance
from toolaxis.contact.clearance.queries import keeps_limits
from toolaxis.contact.placement import tips
from toolaxis.errors import Cancelled, InvalidInput, UnsupportedGeometry
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import MARGIN, OTHER, SKIN, CheckSurfaces, Obstacles, group_surroundings
from toolaxis.feasibility.violations import BACK, CUTTER, Violation
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.machine.limits import AxisLimits
from toolaxis.machine.setup import MachineLike
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.cl_points import trace
from toolaxis.path.leaving_out import leave_out
from toolaxis.path.links import LeadArcs, Linking
from toolaxis.path.mending import FurtherPasses, complete_passes
from toolaxis.path.pass_layout import Layout, lay_out, pass_length, places_between
from toolaxis.path.pass_pattern import pattern_name, pattern_names
from toolaxis.path.planes import PlaneChart
from toolaxis.path.rest_material import FACTOR, OVERLOOKED, Excess, RestFinder, may_stay
from toolaxis.plan.choices import FEEDS, ISO
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.cost import MachiningCost
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.few_in_the_way import find_few_in_the_way, list_axes_to_try
from toolaxis.search.hemisphere import next_in_lobe, search, so_far
from toolaxis.search.infeasibility import corner_too_large, spread_too_wide
from toolaxis.search.kinematic_axis import by_jerk, describe_jerk, next_by_jerk
from toolaxis.search.link_heights import OVER, LinkClearance, height_over
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.machine_limits import (
    REFUSED,
    at_face,
    better_of,
    intersect_limits,
    machine_violation,
    make_room,
    mounting_of,
    snap_to_increments,
)
from toolaxis.search.messages import (
    Refusal,
    direction,
    left_reasons,
    main_first,
    nothing_to_cut,
    sentence,
    stays_high,
    tally,
    why_none,
)
from toolaxis.search.path_check import PathCheck, ProvenMotions, prove, worst_motion
from toolaxis.search.rank_by_passes import least_made
from toolaxis.search.sectors import by_mean_normal, by_roman, sectors
from toolaxis.search.time_estimate import pace_of
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance, ToleranceLike
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

#: Height above everything at which links cross at least, mm.
CROSSING = 5.0
_ATTEMPTS = 4
#: Shares of the work that is left, where it is limited: for the search, and for the order of what it found.
_SEARCHED, _ORDERED = 0.5, 0.4
#: How often motions that the proof refuses are left out of passes before their axis is refused.
_LEFT_OUT = 3
#: How often a face for which there is no axis is tried again without few places that are in the way.
_LEAVINGS = 2
#: Where further passes make the cut so many times as long, the other feed is tried too.
_LONGER = 1.02
#: Places on a face that tell how much stays high between passes over a skin; of how many places of its range they are
#: taken at most, and how many of these at once.
_SAMPLES, _MOST_SCATTERED, _AT_ONCE = 40_000, 3_000_000, 60_000
#: Steps of the sequence of these: 1 / p and 1 / p^2, where p^3 = p + 1, leave the least gaps.
_SCATTERED = np.array([0.7548776662466927, 0.5698402909980532])
#: Where that is too much, passes are laid for this share of the scallop height, and again, down to the second share.
_CLOSER, _CLOSEST = 0.95, 0.87


@dataclass(frozen=True, eq=False)
class FaceProblem:
    """One face to be machined, and everything that decides about an axis for it.

    Attributes
    ----------
    feasibility : Feasibility
        With the distances that the search keeps: a little more than required.
    worth : MachiningCost
    groups : tuple of CheckSurfaces
        The same surroundings with the required distances, for the proof.
    chord : float
        How far straight motions may leave passes, mm.
    progress : Progress
    direction : str
        "zigzag", "climb" or "conventional".
    left_out : (n, 3) array
        Contacts, mm, that passes keep away from besides all on which the cutter may not stand; what stays there is
        undercut.
    laid_for : float
        Share of the scallop height for which passes are laid.
    lead : float
        Radius of the arcs on which the tool comes to passes and leaves them, mm; 0 for none.
    """

    feasibility: Feasibility
    worth: MachiningCost
    groups: tuple[CheckSurfaces, ...]
    chord: float
    progress: Progress = NO_PROGRESS
    direction: str = "zigzag"
    left_out: Array = field(default_factory=lambda: np.empty((0, 3)))
    laid_for: float = 1.0
    lead: float = 0.0

    @property
    def box(self) -> Array:
        """Corners of the box around everything, (2, 3) mm."""
        boxes = np.array([group.box for group in self.groups])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def top(self, axis: Array) -> float:
        """Height along an axis of a tip that is above everything, and above what may stand there, mm.

        Parameters
        ----------
        axis : (3,) array
        """
        low, high = self.box
        clear = max(CROSSING, height_over(self.worth.scallop) + OVER) + max(group.stock for group in self.groups)
        return float(np.maximum(low * axis, high * axis).sum()) + clear

    def reach(self, uv: Array, axis: Array) -> NDArray[np.bool_]:
        """Whether the cutter may stand at parameters of the face, (n,).

        Parameters
        ----------
        uv : (n, 2) array
        axis : (3,) array
        """
        free = self.feasibility.reach(uv, axis)
        if len(self.left_out):
            away = cKDTree(self.left_out).query(self.worth.face.evaluate(uv).point)[0]
            free = free & (away > self.aside)
        return free

    @property
    def aside(self) -> float:
        """How far passes keep from what is left out, mm: half the narrowest strip on a plane."""
        tool = self.worth.tool
        return float(np.sqrt(2 * self.worth.scallop * (tool.corner_radius or tool.radius)))

    def without(self, ends: Array) -> "FaceProblem":
        """The same with further contacts left out, from one end of a motion to the other, (m, 2, 3) mm.

        Parameters
        ----------
        ends : (m, 2, 3) array
        """
        parts = [np.linspace(first, last, int(np.ceil(np.linalg.norm(last - first) / self.aside)) + 1)
                 for first, last in ends]
        return replace(self, left_out=np.concatenate([self.left_out, *parts]))

    def laid(self, axis: Array, feed: str) -> Layout:
        """The passes with an axis, cut out where the tool must not go, before they are traced.

        Parameters
        ----------
        axis : (3,) array
        feed : str

        Raises
        ------
        InvalidInput, UnsupportedGeometry
            When the axis leaves no strip, or passes of this kind do not go with the face.
        """
        cut, reach = self.worth.cut(axis), lambda uv: self.reach(uv, axis)
        cut = replace(cut, scallop=self.laid_for * cut.scallop)
        found: list[Layout] = []
        refused: list[InvalidInput | UnsupportedGeometry] = []
        for pattern in self.worth.patterns:
            try:
                placed = lay_out(pattern.chart(cut, feed), cut, reach, self.progress)
                if isinstance(placed.chart, PlaneChart):
                    placed.chart.check_pieces(placed.pieces)
                found.append(placed)
            except (InvalidInput, UnsupportedGeometry) as reason:
                refused.append(reason)
        if not found:
            raise refused[0]
        return found[0] if len(found) == 1 else min(found, key=pass_length)

    def traced(self, placed: Layout) -> ToolPath:
        """Passes with their links.

        Next to walls and where the skin goes on beyond the sub-surface they begin and end without ramps: a ramp goes on
        along the feed, into what stands there.

        Parameters
        ----------
        placed : Layout
        """
        axis = placed.cut.axis
        height = self.top(axis)
        own = self.worth.face.own_faces
        walls = any(group.role == OTHER or (group.role == SKIN and any(one not in own for one in group.faces))
                    for group in self.groups)
        over = height_over(self.worth.scallop)
        crossing = LinkClearance(self.worth.tool, self.groups, axis, height, self.worth.allowance, over)
        lead = LeadArcs(self.lead, self.chord, crossing.free) if self.lead > 0 else None
        return trace(placed, self.chord, self.direction,
                     linking=Linking(height, run_in=0.0 if walls else 1.0, approach=over + OVER, lower=crossing.heights,
                                     beside=crossing.beside, rise=crossing.rise, lead=lead))

    def made(self, axis: Array, feed: str) -> ToolPath:
        """The very passes, links and ramps included, that `check_candidate` proves.

        Parameters
        ----------
        axis : (3,) array
        feed : str
        """
        placed = self.laid(axis, feed)
        return self.completed(placed, self.traced(placed)).path

    def completed(self, placed: Layout, path: ToolPath) -> FurtherPasses:
        """Passes with the further ones that it takes to leave little on which the cutter may stand.

        Parameters
        ----------
        placed : Layout
        path : ToolPath
            Of that layout.
        """
        axis = placed.cut.axis
        return complete_passes(placed, path, self.traced, self._rest_finder(axis, placed).find,
                               lambda uv: self.reach(uv, axis))

    def left_by(self, path: ToolPath, placed: Layout | None = None) -> tuple[Zone, ...]:
        """Zones that passes leave higher than the scallop limit, the largest first.

        Parameters
        ----------
        path : ToolPath
            With one fixed axis.
        placed : Layout, optional
            Passes of that path: where strips are not exact it is looked between them too.
        """
        return self._rest_finder(path.axis[0], placed).find(path)

    def _rest_finder(self, axis: Array, placed: Layout | None) -> RestFinder:
        """What finds the zones that passes leave; between those of a layout it looks closer where strips are not exact.
        """
        worth = self.worth
        between = None
        if placed is not None and worth.face.surface.stand_in is not None:
            between = places_between(placed)
        return RestFinder(worth.face, worth.tool, worth.scallop, worth.allowance,
                          lambda uv: ~self.feasibility.reach(uv, axis), self.progress, between)


def task(face: Face, tool: Tool, scallop: float, limits: AxisLimits | None = None, obstacles: Obstacles = None, *,
         objective: str = "length", part: Part | None = None, skin: Sequence[Face] = (),
         surroundings: Sequence[Face] = (), tolerance: ToleranceLike = None, allowance: float = 0.0,
         direction: str = "zigzag", passes: str = ISO, feeds: Feeds | None = None,
         greatest_step_over: float = np.inf, lead: float = 0.0, progress: Progress = NO_PROGRESS) -> FaceProblem:
    """Gather what decides about an axis for a face.

    Parameters
    ----------
    face, tool, scallop, obstacles, objective, part, skin, surroundings, tolerance, allowance, direction, passes, feeds
        As for `best_axis`.
    greatest_step_over, lead : float
        As for `best_axis`.
    limits : AxisLimits, optional
    progress : Progress

    Raises
    ------
    InvalidInput
        When an argument is out of range.
    """
    given = Tolerance.of(tolerance)
    pace = pace_of(face, tool, mounting_of(limits), feeds) if objective == "time" else None
    worth = MachiningCost(face, tool, scallop, allowance, objective, pace, passes=passes,
                          greatest_step_over=greatest_step_over)
    chord = given.chord_for(scallop)
    kept = replace(given, gouge=given.gouge - chord, cutter_clearance=given.cutter_clearance + MARGIN,
                   shank_clearance=given.shank_clearance + MARGIN, holder_clearance=given.holder_clearance + MARGIN)
    strict, groups = (group_surroundings(face, replace(limit,
                                                       gouge=allowance - least_distance(tool, limit.gouge, allowance)),
                                         allowance, part=part, skin=skin, surroundings=surroundings,
                                         obstacles=obstacles) for limit in (kept, given))
    reach = at_face(limits, face, tool)
    return FaceProblem(Feasibility(face, tool, strict, given, reach, allowance), worth, groups, chord, progress,
                       direction, lead=lead)


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
        A machine, its name or file, one with the part on its table (`toolaxis.machine.setup`), or limits of the
        axis and their short form.
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
        "iso": along a parameter of the face; "planes": along parallel planes that contain the tool axis; "scallop":
        along the levels of a field that keeps them as far apart as their strips are wide; "auto": the shorter of "iso"
        and "scallop".
    starts : (k, 3) array_like, optional
        Axes that are worth a look before others, such as a division's; for the method "sphere".
    feeds : Feeds, optional
        What is programmed; for the objective "time", which also needs a machine that states its limits.
    greatest_step_over : float
        Greatest distance of neighbouring passes on the face, mm, whatever the scallop height allows.
    lead : float
        Radius of the arcs on which the tool comes to passes and leaves them where these are proven free, mm; 0 for
        none.
    progress : Progress

    Returns
    -------
    Orientation
        "feasible" with axis, passes made and what was proven of them; "infeasible" only where it is proven that no
        axis exists; "not_found" where none was found; "cancelled" with what is known so far.

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
                best = _other_feed(job, ledger, best) or best
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


class CheckedCandidate(NamedTuple):
    """What became of a candidate.

    one : CountedAxis
    orientation : Orientation
    proof : PathCheck, refused too where passes leave more on which the cutter may stand than may stay
    path : ToolPath or None, the very passes that were proven; None where none can be laid
    longer : float, cutting length over that without further passes
    """

    one: CountedAxis
    orientation: Orientation
    proof: PathCheck
    path: ToolPath | None
    longer: float = 1.0

    @property
    def value(self) -> float:
        """What is to be least, with the further passes."""
        return self.one.value * self.longer


def _other_feed(job: FaceProblem, ledger: AxisTable, done: CheckedCandidate) -> CheckedCandidate | None:
    """The same axis with the other feed, where that takes less after further passes; None where it does not."""
    one, feed = done.one, 1 - done.one.feed
    if done.longer <= _LONGER or job.worth.feed is not None:
        return None
    other = CountedAxis(one.axis, feed, *ledger.count(one.axis, feed, one.unreached), one.unreached)
    if not other.value < done.value:
        return None
    again = check_candidate(job, other)
    return again if again.proof.witness is None and again.value < done.value else None


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
            witness = done.proof.witness
        words = f"{REFUSED}{direction(candidate.axis)}: {sentence(witness, ledger.feasibility)}"
        refused.append(Refusal(witness.reason, witness.amount, words))
        make_room(ledger, candidate.axis, witness)
        if method.next_axis is None or attempt + 1 == _ATTEMPTS:
            return None
        candidate = method.next_axis(ledger, candidate, witness, attempt)
    return None


def check_candidate(job: FaceProblem, one: CountedAxis) -> CheckedCandidate:
    """Passes made and proven for one candidate.

    Parameters
    ----------
    job : FaceProblem
    one : CountedAxis
    """
    feed = FEEDS[one.feed]
    stuck = _find_blocked_way_up(job, one.axis)
    if stuck is not None:
        return CheckedCandidate(one, Orientation(None, feed), PathCheck(stuck), None)
    try:
        placed = job.laid(one.axis, feed)
    except (InvalidInput, UnsupportedGeometry) as reason:  # no strip between the counted places, or no planes here
        return CheckedCandidate(one, Orientation(None, feed), PathCheck(Violation(BACK, 0.0, words=str(reason))), None)
    if not len(placed.pieces):
        why = Violation(CUTTER, 0.0, words=nothing_to_cut(job.worth.face))
        return CheckedCandidate(one, Orientation(None, feed), PathCheck(why), None)
    known = ProvenMotions()
    job, placed, plain, proof = _prove_without_refused(job, placed, known)
    made = FurtherPasses(placed, plain, ()) if proof.witness is not None else job.completed(placed, plain)
    if made.placed is not placed:
        of_all = _prove_path(job, made.path, known)
        if of_all.witness is None:
            proof = of_all
        else:  # further passes are no reason to refuse an axis
            made = FurtherPasses(placed, plain, job.left_by(plain, placed))
    if proof.witness is None and job.laid_for > _CLOSEST and _is_laid_too_wide(job, made):
        return check_candidate(replace(job, laid_for=_CLOSER * job.laid_for), one)
    path, area = made.path, job.worth.face.area
    if proof.witness is None and made.undercut > may_stay(made.zones, area):
        proof = PathCheck(Violation(CUTTER, 0.0, words=stays_high(made.zones, job.worth.face)))
    unreached = min((made.left - made.undercut) / area, 1.0)
    length = path.length(Motion.CUT)
    width = area * (1 - unreached) / length if length > 0 else 0.0
    words = left_reasons(made.zones, job.worth.face)
    found = Orientation(one.axis, feed, path.passes, one.passes, length, width, proof.gouge, proof.clearance,
                        "feasible", words, unreached=unreached, pattern=pattern_name(made.placed.chart),
                        ideal=job.worth.ideal_length(one.axis), zones=made.zones)
    return CheckedCandidate(one, found, proof, path, made.longer)


def _find_blocked_way_up(job: FaceProblem, axis: Array) -> Violation | None:
    """What stands in the way up from every contact, as the opposite side of a duct; None where it is free from some.

    Every path comes down along the axis to its first pass: to lay and prove all of them first would take long.
    """
    some = job.feasibility.sparse
    if not len(some.uv):
        return None
    low = tips(some.point, some.normal, axis, job.worth.tool, job.worth.allowance) + CROSSING * axis
    up = np.maximum(job.top(axis) - low @ axis, 0.0)[:, None] * axis
    moves = np.stack([low + up / 2, up / 2, np.broadcast_to(axis, low.shape)], axis=1)
    free = np.ones(len(moves), dtype=bool)
    stuck = None
    for group in job.groups:
        kept = keeps_limits(group.cells, job.worth.tool, moves, np.tile(group.required, (len(group.faces), 1)))
        blocked = kept.blocked >= 0
        if stuck is None and blocked.any():
            stuck = worst_motion(job.worth.tool, group, moves[blocked], group.required, group.required)
        free &= ~blocked
    return None if free.any() else stuck


def _is_laid_too_wide(job: FaceProblem, made: FurtherPasses) -> bool:
    """Whether more stays high than may, told from samples: ridges between passes are thinner than any cell.

    Only where strips are measured on what stands for a skin can that be.
    """
    worth = job.worth
    if worth.face.surface.stand_in is None:
        return False
    uv = _scatter_places(worth.face, _SAMPLES)
    for zone in made.zones:
        uv = uv[~worth.face.trimmed(zone.loops).contains(uv)]
    if not len(uv):
        return False
    d = worth.face.evaluate(uv)
    area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    high = Excess(worth.face, worth.tool, made.path, worth.allowance + FACTOR * worth.scallop)(uv) > 0
    return bool(area[high].sum() > OVERLOOKED * area.sum())


def _scatter_places(face: Face, count: int) -> Array:
    """Parameters of a face, (n, 2), of so many places on it, or fewer where it fills next to nothing of its range.

    They lie along no line, as ridges of straight passes do, which would lie between the lines of a grid, or on them.
    """
    u0, u1, v0, v1 = face.bounds
    found: list[Array] = []
    for first in range(0, _MOST_SCATTERED, _AT_ONCE):
        share = np.arange(first + 1, first + _AT_ONCE + 1)[:, None] * _SCATTERED % 1.0
        uv = np.array([u0, v0]) + share * np.array([u1 - u0, v1 - v0])
        found.append(uv[face.contains(uv)])
        if sum(map(len, found)) >= count:
            break
    return np.concatenate(found)[:count]


def _prove_without_refused(job: FaceProblem, placed: Layout,
                            known: ProvenMotions) -> tuple[FaceProblem, Layout, ToolPath, PathCheck]:
    """Passes and their proof; few motions that it refuses are left out, as are their contacts from then on."""
    path = job.traced(placed)
    proof = _prove_path(job, path, known)
    for _ in range(_LEFT_OUT):
        if not len(proof.blocked):
            break
        fewer, ends = leave_out(placed, path, proof.blocked, job.chord)
        if not len(ends) or not len(fewer.pieces):
            break
        job, placed = job.without(ends), fewer
        path = job.traced(placed)
        proof = _prove_path(job, path, known)
    return job, placed, path, proof


def _prove_path(job: FaceProblem, path: ToolPath, known: ProvenMotions) -> PathCheck:
    """The proof of a path, after a look at whether its machine reaches all of it."""
    beyond = machine_violation(job.feasibility, path, job.groups)
    if beyond:
        return PathCheck(beyond)
    return prove(path, job.worth.tool, job.groups, job.worth.allowance, known=known, progress=job.progress)


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
