"""Sub-surfaces, axes and operations of one plan: what `toolaxis.plan` sets going."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import Cancelled, Fault, ToolAxisError, about, fault
from toolaxis.job.planning.asked_division import AskedDivision, end_failed
from toolaxis.job.planning.blade_clearances import with_rooms
from toolaxis.job.planning.blade_copies import append_operations, spread_out, with_refused
from toolaxis.job.planning.blade_pattern import Pattern, group_blade_faces
from toolaxis.job.planning.clean_up_zones import add_clean_up_zones
from toolaxis.job.planning.comparison import compare_methods
from toolaxis.job.planning.edit_axis import evaluate_given_axis, frame_of
from toolaxis.job.planning.face_by_face import area_machined, compare_areas, is_better, loses_area, name_faces
from toolaxis.job.planning.face_copies import carry_piece, copy_operation
from toolaxis.job.planning.failures import fail_face, fail_operation, refuse_face
from toolaxis.job.planning.held_side import cut_face
from toolaxis.job.planning.parallel import abreast
from toolaxis.job.planning.share_axes import share_axes
from toolaxis.job.planning.sub_surfaces import (
    Target,
    by_reach,
    made_of,
    plan_locked,
    shrink_refused,
    smooth_pieces,
    targets_of_given,
    with_given,
)
from toolaxis.job.planning.timing import add_times, feeds_of
from toolaxis.machine.limits import AxisLimits
from toolaxis.machine.setup import Mounting
from toolaxis.partition.face_division import Regions
from toolaxis.plan.choices import DIVIDED, FEEDS, ISO
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import INDEX_SECONDS, Option, Plan, PlanInputs
from toolaxis.plan.sub_surface import SubSurface
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.regions.axis_choice import reckon_axes
from toolaxis.regions.divide_by_reach import ReachDivision, divide_by_reach
from toolaxis.regions.divide_for_time import WholeCut, divide_for_time, estimate_seconds
from toolaxis.regions.machined_beside import take_machined_beside
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.tool_choice import AxisTime
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.face_problem import task as search_task
from toolaxis.search.infeasibility import tight_fillet
from toolaxis.search.machine_limits import intersect_limits, limit_axes
from toolaxis.search.shared_axis import together
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.alike import AlikeFace
from toolaxis.skin.join import take_apart
from toolaxis.strategies.registry import strategy_of
from toolaxis.strategies.strategy import Strategy
from toolaxis.tools.tool import Tool
from toolaxis.work import MOVING, Budget, OutOfWork, limit_work

Array = NDArray[np.float64]

#: How a reason begins that tells why a shared axis does not serve.
REFUSED = "shared axis refused: "
#: How many times the limit of work a sub-surface is allowed by its share of the area of a plan with several tools, at
#: least and at most; and how many times besides for the passes of an axis that was found.
_WORK_OF_SHARE, _LEAST_WORK, _MOST_WORK, _FOR_PASSES = 6.0, 0.25, 4.0, 1.5
#: Share of a face that its pieces may machine less of it than one axis does.
_SAME_AREA = 1e-3
#: Time from which on a sub-surface is divided before it is planned whole, s, and what is told of it until then.
_LONG, _HOURS = 1200.0, "it is divided before its axis is searched"
#: Why a sub-surface is divided before an axis for all of it is looked for.
_IN_PIECES = "no axis reaches all of it, as the screening of its cells sees it"


def went_on(plan: Plan, stage: Callable[[Plan], Plan]) -> Plan:
    """A plan after a further stage; what it was before is kept where the user stops that, or the program fails in it.

    Parameters
    ----------
    plan : Plan
        A stopped one stays as it is.
    stage : callable
        Takes and returns a plan.
    """
    if plan.outcome == "cancelled":
        return plan
    try:
        return stage(plan)
    except Cancelled:
        return replace(plan, outcome="cancelled")
    except Exception as reason:
        return with_fault(plan, fault(reason))


def with_fault(plan: Plan, why: Fault) -> Plan:
    """A plan in which something failed that is of no single sub-surface.

    Parameters
    ----------
    plan : Plan
    why : Fault
    """
    outcome = "incomplete" if plan.outcome == "complete" else plan.outcome
    return replace(plan, outcome=outcome, faults=(*plan.faults, why))


def quicker(divided: Plan, whole: Plan) -> Plan:
    """Of a plan with faces divided and one with the same faces whole the one that takes less time.

    What a division comes to is reckoned to some percent, which may be more than it gains.

    Parameters
    ----------
    divided, whole : Plan
        The first one's options are kept; that with as many axes is marked where faces stay whole.
    """
    if whole.outcome == "cancelled" or _seconds_of(divided) <= _seconds_of(whole):
        return divided
    marked = tuple(replace(one, chosen=one.orientations == whole.orientations) for one in divided.options)
    return replace(whole, options=marked)


def _seconds_of(plan: Plan) -> float:
    """Time of a plan in its quickest order, s; infinite where it is not complete."""
    if plan.outcome != "complete":
        return float("inf")
    return add_times(plan, reorder=True).seconds


@dataclass(frozen=True, eq=False)
class PlanningJob:
    """One plan in the making.

    Attributes
    ----------
    part : Part
    tool : Tool
    inputs : PlanInputs
    limits : AxisLimits or None
        Of the axis, besides the machine's.
    bodies : tuple of Part
        Further bodies to keep clear of.
    datum : (3,) array
    regions, orientations : int, "auto" or None
        As `toolaxis.plan` takes them.
    workers : int
        Processes to work with.
    whole : tuple of Face
        Faces that are machined undivided after the others.
    machine : Mounting or None
    division : tuple of SubSurface
        Sub-surfaces given by hand; faces that have some are not divided otherwise.
    one_by_one : bool
        Whether the faces of a skin of which a part has no axis are planned one by one where they do better.
    asked_area : float
        Area of all that is asked for in a plan with several tools, mm^2: by its share of that a sub-surface is allowed
        work, as there is another tool to be tried.  0 with one tool.
    for_time : bool
        Whether a plan with several tools divides what one axis machines where several axes take less time.
    known_axes : tuple of (3,) arrays
        Axes under which the tool machines something else: these cost no index move.
    """

    part: Part
    tool: Tool
    inputs: PlanInputs
    limits: AxisLimits | None
    bodies: tuple[Part, ...]
    datum: Array
    regions: int | str | None = None
    orientations: int | str | None = None
    workers: int = 1
    whole: tuple[Face, ...] = ()
    machine: Mounting | None = None
    division: tuple[SubSurface, ...] = ()
    one_by_one: bool = True
    asked_area: float = 0.0
    for_time: bool = True
    known_axes: tuple[Array, ...] = ()

    def by(self, method: str) -> "PlanningJob":
        """The same job by another method; with a ball end in the tool's place where that is what the method takes.

        Or by the same method, with iso-parametric passes.
        """
        if method == ISO:
            return replace(self, inputs=replace(self.inputs, passes=ISO))
        tool = self.tool.with_ball_end() if method == "ball" else self.tool
        return replace(self, inputs=replace(self.inputs, method=method), tool=tool)

    def bladed(self, pattern: Pattern, compare: bool, progress: Progress) -> Plan:
        """The plan of a part with blades: one is planned, what is done there is turned to the others.

        Where other methods are asked for too, they plan the same blade between its neighbours.
        """
        share = group_blade_faces(pattern, self.tool, self.inputs.tolerance.cutter_clearance)
        apart = pattern.blades.apart(self.part, pattern.first[0].number)
        regions = self.regions
        if regions is None:
            regions = "auto"
        elif regions == 1:
            regions = None
        one = replace(self, part=apart, regions=regions, whole=share.whole)
        first = with_refused(one.zoned_out(share.divided, progress), pattern, share)
        of_part = replace(first, part=pattern.part)
        planner = PlannerOfFaces((self,))
        found = went_on(of_part, lambda plan: spread_out(pattern, plan, planner, progress))
        if found.outcome != "cancelled" and pattern.rest:
            found = append_operations(found, self.zoned_out(pattern.rest, progress))
        if compare:
            plain = replace(one, regions=None, orientations=None, whole=(), division=())
            done = tuple(op for op in first.operations if op.done)
            planned = {op.face.number for op in done}
            own = [face for face in (*share.divided, *share.whole) if face.number in planned]

            def by_method(name: str, some: Sequence[Face]) -> Plan:
                return plain.by(name).carried_out(some, progress.within(name))

            def with_baselines(plan: Plan) -> Plan:
                compared = compare_methods(replace(first, operations=done), own, by_method)
                return replace(plan, baselines=compared.baselines)

            found = went_on(found, with_baselines)
        return went_on(found, lambda plan: plan if plan.blades is None else with_rooms(plan, progress))

    def zoned_out(self, faces: Sequence[Face], progress: Progress) -> Plan:
        """The plan for faces with the clean-up zones of its operations."""
        return self._with_zones(self.carried_out(faces, progress), progress)

    def plan_pieces(self, targets: list[Target], scene: ReachScene, progress: Progress) -> Plan:
        """The plan for sub-surfaces, with the clean-up zones of its operations.

        Parameters
        ----------
        targets : list of Target
        scene : ReachScene
            Of the part.
        progress : Progress
        """
        made = self._plan_targets(targets, (), progress, scene)
        if self.for_time:
            made = went_on(made, lambda plan: self._in_less_time(plan, scene, progress.within("division for time")))
        if made.outcome == "cancelled":
            made = replace(made, operations=tuple(op for op in made.operations if not _waits(op)))
        return self._with_zones(made, progress)

    def _in_less_time(self, plan: Plan, scene: ReachScene, progress: Progress) -> Plan:
        """A plan in which operations give way to several with axes of their own, where these take less time together
        and machine as much."""
        rows = plan.operations
        rate = self._feedrate

        def _division(k: int, inner: Progress) -> Regions | None:
            op = rows[k]
            axis = op.orientation.axis
            if axis is None:
                return None
            named = inner.within(f"face {op.face.label}")
            job = self.task(op.face, named)
            seconds = self._seconds([op]) if op.done else estimate_seconds(job, axis, rate)
            return divide_for_time(job, scene, WholeCut(axis, seconds, rate, INDEX_SECONDS), named)

        found = abreast(_division, len(rows), self.workers, progress)
        targets: dict[int, list[Target]] = {}
        for k, one in found.results.items():
            if one is not None and not found.cancelled:
                pieces = zip(one.faces, one.axes, strict=True)
                targets[k] = [Target(piece, axis, however_long=True) for piece, axis in pieces]
        every = [target for some in targets.values() for target in some]
        made, cancelled = self._operations_of(every, progress)
        divided: dict[int, list[Operation]] = {}
        for k, some in targets.items():
            operations = self._made_of_all(some, made)
            if self._serves_better(operations, rows[k]):
                divided[k] = operations
        kept: list[Operation] = []
        late = []
        for k, op in enumerate(rows):
            if k in divided:
                kept += divided[k]
            elif _waits(op):
                late.append(Target(op.face, op.orientation.axis, however_long=True))
            else:
                kept.append(op)
        stopped = found.cancelled or cancelled
        if late and not stopped:  # as without a division for time: whole, or by reach
            undivided = self._plan_targets(late, (), progress, scene)
            kept += undivided.operations
            stopped = undivided.outcome == "cancelled"
        plan = replace(plan, operations=_renumber(kept))
        for why in found.faults.values():
            plan = with_fault(plan, why)
        return replace(plan, outcome="cancelled") if stopped else plan

    @property
    def _feedrate(self) -> float:
        """mm/s, of the tool."""
        return self.inputs.at_rates_of(self.tool).feedrate / 60

    @staticmethod
    def _made_of_all(targets: Sequence[Target], operations: Sequence[Operation]) -> list[Operation]:
        """What was made of some targets, as far as it was."""
        made = [made_of(target, operations) for target in targets]
        return [one for one in made if one is not None]

    def _serves_better(self, pieces: Sequence[Operation], whole: Operation) -> bool:
        """Whether the operations of a face's pieces machine as much as that of the whole, in less time."""
        if not pieces or not all(op.done for op in pieces):
            return False
        if not whole.done:
            return True
        lost = area_machined([whole]) - area_machined(pieces)
        saved = self._seconds([whole]) - self._seconds(pieces)
        return lost <= _SAME_AREA * whole.face.area and saved >= INDEX_SECONDS

    def _seconds(self, operations: Sequence[Operation]) -> float:
        """Time of some operations in their quickest order, index moves between them included."""
        plan = self._plan(tuple(operations), "complete", ())
        return add_times(plan, reorder=True).seconds

    def copy_operations(self, asked: Sequence[tuple[Operation, AlikeFace]],
                        progress: Progress) -> list[Operation | None] | None:
        """Operations moved to faces that are alike, with their clean-up zones: None for each that is refused there.

        Parameters
        ----------
        asked : sequence of (Operation, AlikeFace)
            Operations with a path, on the original or a piece of it.
        progress : Progress

        Returns
        -------
        list of Operation or None
            In that order; None where the user stopped it.
        """
        pieces = [carry_piece(op, alike) for op, alike in asked]

        def _copy(k: int, inner: Progress) -> Operation | None:
            op, alike = asked[k]
            piece = pieces[k]
            if piece is None:
                return None
            inner.report(f"copy of face {op.face.label} on face {piece.label}", k, len(asked))
            with limit_work(self._budget(piece)), suppress(OutOfWork):
                return copy_operation(op, alike, piece, self.task(piece, inner), self.datum)
            return None

        done = abreast(_copy, len(asked), self.workers, progress)
        if done.cancelled:
            return None
        rows = []
        for k, piece in enumerate(pieces):
            op = done.results.get(k)
            if piece is not None and op is not None:
                rows.append(replace(op, face=piece, number=k + 1))
        plan = self._with_zones(self._plan(tuple(rows), "complete", ()), progress)
        if plan.outcome == "cancelled":
            return None
        made = {op.number: op for op in plan.operations}
        return [made.get(k + 1) for k in range(len(asked))]

    def _with_zones(self, plan: Plan, progress: Progress) -> Plan:
        """A plan with the clean-up zones of its operations; a stopped one with those of what was finished."""
        if plan.outcome != "cancelled":
            return went_on(plan, lambda one: add_clean_up_zones(one, self.workers, progress))
        with activate_progress(NO_PROGRESS):
            found = went_on(replace(plan, outcome="incomplete"), add_clean_up_zones)
        return replace(found, outcome="cancelled")

    def carried_out(self, faces: Sequence[Face], progress: Progress) -> Plan:
        """The plan for faces, divided where asked for; whole where the division is free and takes more time."""
        made = self._as_asked(faces, progress)
        free = "auto" in (self.regions, self.orientations) or (self.regions is None and self.orientations is not None)
        if self.inputs.objective != "time" or not free or made.outcome == "cancelled":
            return made
        undivided = smooth_pieces((*faces, *self.whole), self.tool)
        if len(made.operations) == len(undivided):
            return made
        job = replace(self, regions=None, orientations=None)
        whole = job._as_asked(faces, progress.within("undivided"))
        most = self.orientations if isinstance(self.orientations, int) else np.inf
        if whole.orientations > most:
            return made
        return went_on(made, lambda plan: quicker(plan, whole))

    def _as_asked(self, faces: Sequence[Face], progress: Progress) -> Plan:
        """The plan for faces, divided where asked for, one sub-surface after the other."""
        options: tuple[Option, ...] = ()
        order = [face.number for face in (*faces, *self.whole)]
        given = targets_of_given(self.part, self.division, order, self.tool)
        pieces = smooth_pieces((face for face in faces if face.number not in given), self.tool)
        faces = [target.face for target in pieces if target.ended is None]
        try:
            targets, options = self._division.divide(faces, progress)
            targets += [target for target in pieces if target.ended is not None]
            targets += smooth_pieces((face for face in self.whole if face.number not in given), self.tool)
            targets = with_given(targets, given, [] if self.orientations else order)
            if self.inputs.method == "one":
                return self._alike(targets, progress)
        except Cancelled:
            return self._plan((), "cancelled", options)
        return self._plan_targets(targets, options, progress)

    def _plan_targets(self, targets: list[Target], options: tuple[Option, ...], progress: Progress,
                      scene: ReachScene | None = None) -> Plan:
        """The plan for sub-surfaces as they are."""
        made, cancelled = self._operations_of(targets, progress)
        if not cancelled and self._may_divide:
            made, cancelled = self._divided_by_reach(targets, made, scene, progress)
        if cancelled:  # a sub-surface that waits for its division has not been tried
            made = tuple(op for op in made if _IN_PIECES not in op.orientation.reasons and not _waits(op))
            return self._plan(made, "cancelled", options)
        plan = self._plan(made, _outcome(made), options)
        return self._face_by_face(plan, progress) if self._may_divide else plan

    def _operations_of(self, targets: list[Target], progress: Progress) -> tuple[tuple[Operation, ...], bool]:
        """The operations of sub-surfaces as far as they were made, and whether the user stopped that."""
        number = len(targets)

        def _make(k: int, inner: Progress) -> Operation:
            return self._operation(targets[k], (k, number), inner)

        done = abreast(_make, number, self.workers, progress)
        made = dict(done.results)
        for k, why in done.faults.items():
            made[k] = fail_face(k + 1, targets[k].face, self.tool, why)
        operations = tuple(replace(made[k], face=targets[k].face) for k in sorted(made))
        return operations, done.cancelled

    @property
    def _may_divide(self) -> bool:
        """Whether faces that no axis reaches whole are divided: where nobody said how, and the search is free."""
        return self.inputs.method in DIVIDED and self.regions is None and self.orientations is None

    def _divided_by_reach(self, targets: list[Target], made: tuple[Operation, ...], scene: ReachScene | None,
                          progress: Progress) -> tuple[tuple[Operation, ...], bool]:
        """The operations with those of sub-surfaces in the place of faces that no axis reaches whole."""
        lost = [k for k, op in enumerate(made) if _is_lost(targets[k], op)]
        stage = progress.within("division by reach")
        if not lost:
            return made, False
        known = ReachScene.of(self.part, self.obstacles) if scene is None else scene

        def _divide(k: int, inner: Progress) -> ReachDivision | None:
            return self._reached(targets[lost[k]].face, known, inner)

        found = abreast(_divide, len(lost), self.workers, stage)
        if found.cancelled:
            return made, True
        divisions = {lost[k]: one for k, one in found.results.items() if one is not None and one.pieces}
        pieces = {k: by_reach(targets[k].face, made[k], one, targets[k].others) for k, one in divisions.items()}
        if self.asked_area > 0:
            pieces, stopped = self._share_axes(pieces, [op for op in made if op.done], known, stage)
            if stopped:
                return made, True
        every = [piece for some in pieces.values() for piece in some]
        done, cancelled = self._operations_of(every, stage)
        if not cancelled:  # what the proof refuses is tried once more, a little smaller
            tried = [op for op in done if not _waits(op)]
            pieces = {k: shrink_refused(some, tried, made[k], divisions[k]) for k, some in pieces.items()}
            again = [piece for some in pieces.values() for piece in some if made_of(piece, done) is None]
            more, cancelled = self._operations_of(again, stage)
            done = (*done, *more)
        failed = {lost[k]: fail_operation(made[lost[k]], why) for k, why in found.faults.items()}
        rows: list[Operation] = []
        with activate_progress(NO_PROGRESS) if cancelled else nullcontext():  # what is finished is kept
            for k, op in enumerate(made):
                own = self._made_of_all(pieces.get(k, ()), done)
                rows += self._with_machined_beside(own) or [failed.get(k, op)]
        return _renumber(rows), cancelled

    def _share_axes(self, pieces: dict[int, list[Target]], done: Sequence[Operation], scene: ReachScene,
                    progress: Progress) -> tuple[dict[int, list[Target]], bool]:
        """Sub-surfaces of divided faces, with axes that serve several of them; and whether the user stopped that."""
        of_done = [op.orientation.axis for op in done]
        used = [*self.known_axes, *(axis for axis in of_done if axis is not None)]
        rate = self._feedrate
        open_ = [target for some in pieces.values() for target in some if target.ended is None]

        def _reckon(face: Face, axes: Array, own: int, inner: Progress) -> tuple[AxisTime, ...]:
            return reckon_axes(self.task(face, inner), scene, axes, own, rate, INDEX_SECONDS)

        shared, cancelled = share_axes(open_, used, _reckon, self.workers, progress)
        given = {id(old): new for old, new in zip(open_, shared, strict=True)}
        replaced = {}
        for number, some in pieces.items():
            replaced[number] = [given.get(id(target), target) for target in some]
        return replaced, cancelled

    def _with_machined_beside(self, pieces: Sequence[Operation]) -> list[Operation]:
        """Operations of the pieces of one face, larger by what their passes machine of those without an axis."""
        inputs = self.inputs
        unknown = inputs.greatest_step_over > 0 or inputs.tolerance.least_lean > 0  # beyond the last pass
        if unknown or not pieces:
            return list(pieces)
        return take_machined_beside(pieces, inputs.scallop, inputs.allowance_of(pieces[0].face))

    def _face_by_face(self, plan: Plan, progress: Progress) -> Plan:
        """A plan with the faces of skins in their place where a part of these has no axis and the faces do better."""
        if not self.one_by_one:
            return plan
        given = {one.face for one in self.division}
        skins = self._free_parts(face for face in self.part.faces if face.members and face.number not in given)
        own = {skin.number: [op for op in plan.operations if op.face.number == skin.number] for skin in skins}
        lost = [skin for skin in skins if loses_area(own[skin.number], skin.area)]
        if not lost:
            return plan
        taken_apart = take_apart(self.part, [skin.number for skin in lost])
        apart = replace(self, part=taken_apart, whole=(), division=())
        faces = self._free_parts(taken_apart.face(number) for skin in lost for number in skin.numbers)
        other = apart._as_asked(faces, progress.within("faces one by one"))
        if other.outcome == "cancelled":  # what is finished is kept
            return replace(plan, outcome="cancelled")
        part = self.part
        taken: dict[int, list[Operation]] = {}
        for skin in lost:
            rows = [op for op in other.operations if op.face.number in skin.numbers]
            before = own[skin.number]
            if is_better(rows, before, skin.area):
                part = take_apart(part, [skin.number])
                part = part.with_warnings(compare_areas(skin, before, rows))
                taken[skin.number] = name_faces(skin, rows)
        kept: list[Operation] = []
        for op in plan.operations:  # they stand where the first sub-surface of their skin stood
            number = op.face.number
            if number not in taken:
                kept.append(op)
            elif op is own[number][0]:
                kept += taken[number]
        made = _renumber(kept)
        return replace(plan, part=part, operations=made, outcome=_outcome(made))

    def _free_parts(self, faces: Iterable[Face]) -> list[Face]:
        """What of faces is not held in the clamping."""
        cut = (cut_face(face, self.part.held) for face in faces)
        return [face for face in cut if face is not None]

    def _reached(self, face: Face, scene: ReachScene, progress: Progress) -> ReachDivision | None:
        """How a face is divided by what axes reach; None where that is no use."""
        if tight_fillet(face, self.tool):
            return None
        return divide_by_reach(self.task(face, progress), scene, progress.within(f"face {face.label}"))

    @property
    def _division(self) -> AskedDivision:
        """How faces are divided where no axis was looked for yet."""
        return AskedDivision(self.part, self.obstacles, self.tool, self.task, self.regions, self.orientations,
                            self.workers)

    def _alike(self, targets: list[Target], progress: Progress) -> Plan:
        """The plan with one axis for all sub-surfaces: the best one that the proof of all their passes accepts."""
        axes, targets = self._for_all(targets, progress)
        made = None
        for axis in axes:
            shared = [target if target.ended else Target(target.face, axis, True) for target in targets]
            made = self._plan_targets(shared, (), progress)
            if made.outcome == "cancelled" or all(op.done or op.failed for op in made.operations):
                break
        return made or self._plan_targets(targets, (), progress)

    def _for_all(self, targets: list[Target], progress: Progress) -> tuple[Array, list[Target]]:
        """Axes that serve all sub-surfaces, those aside on which the program fails; the sub-surfaces with these ended.
        """
        while open_ := [target for target in targets if target.ended is None]:
            try:
                tasks = []
                for target in open_:
                    with about(target.face.label):
                        tasks.append(self.task(target.face, progress))
                return together(tasks, progress.within("one axis")), targets
            except ToolAxisError:  # Cancelled among them
                raise
            except Exception as reason:
                targets = end_failed(targets, self.tool, reason)
        return np.empty((0, 3)), targets

    def empty(self) -> Plan:
        """The plan that was cancelled before anything was done."""
        return self._plan((), "cancelled", ())

    def _plan(self, operations: tuple[Operation, ...], outcome: str, options: tuple[Option, ...]) -> Plan:
        return Plan(self.part, (self.tool,), self.inputs, operations, self.bodies, self.datum, outcome, options,
                    machine=self.machine, at_points=self._strategy.at_points)

    def _operation(self, target: Target, place: tuple[int, int], progress: Progress) -> Operation:
        """The operation of a sub-surface, with no more work than is allowed."""
        with limit_work(self._budget(target.face)):
            return self._with_axis(target, place, progress)

    def _budget(self, face: Face) -> Budget:
        """The work that a sub-surface is allowed."""
        for_passes = _FOR_PASSES if self.asked_area > 0 else 0.0
        return Budget(self.inputs.limit, self._times_of_work(face), for_passes)

    def _times_of_work(self, face: Face) -> float:
        """How many times the limit of work a sub-surface is allowed."""
        if self.asked_area > 0:
            by_share = _WORK_OF_SHARE * face.area / self.asked_area
            return float(np.clip(by_share, _LEAST_WORK, _MOST_WORK))
        each = MOVING if self._strategy.moves else 1.0
        return each * len(face.numbers)

    def _with_axis(self, target: Target, place: tuple[int, int], progress: Progress) -> Operation:
        """The operation of a sub-surface, with a shared axis where that may be used."""
        face, axis, number = target.face, target.axis, place[0] + 1
        if target.ended is not None:
            return replace(target.ended, number=number)
        if target.in_pieces:
            return Operation(number, face, self.tool, Orientation(None, outcome="not_found", reasons=(_IN_PIECES,)))
        inner = progress.within(f"face {face.label} ({number} of {place[1]})")
        inner.report("search for the axis", 0, 1)
        try:
            if (long := self._axis_of_hours(target, inner)) is not None:
                return Operation(number, face, self.tool, Orientation(long, outcome="not_found", reasons=(_HOURS,)))
            found, path = Orientation(None), None
            given = target.given if target.given is not None and target.given.held else None
            if given is not None and not self._strategy.moves and self.inputs.method != "one":
                found, path = plan_locked(self.task(face, inner), given,
                                          lambda task: self._strategy.plan(task, self.inputs))
            elif axis is not None and target.shared:
                found, path = self._plan_with_shared_axis(target, inner)
            if found.axis is None and self.inputs.method == "one":
                why = found.reasons or ("no axis found that all sub-surfaces allow",)
                return Operation(number, face, self.tool, replace(found, reasons=why))
            if found.axis is None and (given is None or self._strategy.moves):
                refused = found.reasons
                found, path = self._search_axis(target, inner)
                found = replace(found, reasons=(*(f"{REFUSED}{why}" for why in refused), *found.reasons))
        except Cancelled:
            raise
        except OutOfWork as reason:
            none = Orientation(None, outcome="not_found", reasons=(str(reason),))
            return Operation(number, face, self.tool, none)
        except ToolAxisError as reason:  # this face cannot be done; the others can
            return refuse_face(number, face, self.tool, reason)
        if found.outcome == "cancelled":
            raise Cancelled("cancelled by the user")
        frame = None if path is None else frame_of(face, found, self.datum)
        return Operation(number, face, self.tool, found, path, frame, found.zones)

    def _axis_of_hours(self, target: Target, progress: Progress) -> Array | None:
        """The axis that is known of a sub-surface, where it would take so long under that one that it is divided first;
        None elsewhere."""
        if not self.for_time or not self.asked_area or target.however_long:
            return None
        axis = target.axis
        if axis is None:
            if not len(target.others):
                return None
            axis = target.others[-1]
        seconds = estimate_seconds(self.task(target.face, progress), axis, self._feedrate)
        return axis if seconds > _LONG else None

    def _plan_with_shared_axis(self, target: Target, progress: Progress) -> tuple[Orientation, ToolPath | None]:
        """What the shared axis comes to; where it is refused, the cheapest of the others' that is not."""
        assert target.axis is not None
        job = self.task(target.face, progress)
        found, path = evaluate_given_axis(job, target.axis)
        if found.axis is not None:
            return found, path
        tried = [evaluate_given_axis(job, other) for other in target.others]
        rest = [one for one in tried if one[0].axis is not None]
        if not rest:
            return found, path
        other, path = min(rest, key=lambda one: _price(job, one[0]))
        refused = tuple(f"{REFUSED}{why}; another shared axis serves" for why in found.reasons)
        return replace(other, reasons=(*other.reasons, *refused)), path

    def _search_axis(self, target: Target, progress: Progress) -> tuple[Orientation, ToolPath | None]:
        """The axis that the method finds, and the very passes, links and ramps included, that were proven."""
        if self._strategy.moves:  # in a comparison with a plan for least time, or along planes
            objective = "length" if self.inputs.objective == "time" else self.inputs.objective
            job = replace(self, inputs=replace(self.inputs, objective=objective, passes=ISO))
            return self._strategy.plan(job.task(target.face, progress), self.inputs, target.axis)
        known = [] if target.axis is None else [target.axis]
        if not target.shared:  # the axes that others share were tried before
            known += target.others
        axes = np.array(known) if known else None
        return self._strategy.plan(self.task(target.face, progress), self.inputs, axes)

    @property
    def _index_length(self) -> float:
        """Length of a cut that takes as long as an index move, mm; 0 in a plan with one tool."""
        return INDEX_SECONDS * self._feedrate if self.asked_area > 0 else 0.0

    @property
    def _strategy(self) -> Strategy:
        return strategy_of(self.inputs.method)

    @property
    def axis_limits(self) -> AxisLimits | None:
        """All limits of the axis, the machine's and those of the held side among them."""
        return limit_axes(intersect_limits(self.machine, self.limits), self.part.held)

    @property
    def obstacles(self) -> tuple[Face, ...]:
        """The faces of the further bodies."""
        return tuple(face for body in self.bodies for face in body.faces)

    def task(self, face: Face, progress: Progress) -> FaceProblem:
        """What decides about an axis for a face, or a piece of one.

        Parameters
        ----------
        face : Face
        progress : Progress
        """
        inputs = self.inputs
        feeds = feeds_of(inputs.at_rates_of(self.tool))
        allowance = inputs.allowance_of(face)
        return search_task(face, self.tool, inputs.scallop, self.axis_limits, self.obstacles,
                           objective=inputs.objective, feeds=feeds, part=self.part, allowance=allowance,
                           tolerance=inputs.tolerance, direction=inputs.direction, passes=inputs.passes,
                           greatest_step_over=inputs.step_over, lead=inputs.lead, index_length=self._index_length,
                           progress=progress)


def _waits(op: Operation) -> bool:
    """Whether a sub-surface is yet to be divided for its time, or planned whole."""
    return _HOURS in op.orientation.reasons


def _is_lost(target: Target, op: Operation) -> bool:
    """Whether no axis was found for a sub-surface of which nobody said how it is machined."""
    is_open = not op.done and not op.failed and not _waits(op)
    return is_open and target.ended is None and target.given is None


def _renumber(operations: Sequence[Operation]) -> tuple[Operation, ...]:
    """Operations numbered from 1, in their order."""
    return tuple(replace(op, number=k) for k, op in enumerate(operations, 1))


def _outcome(operations: Sequence[Operation]) -> str:
    """What a plan of some operations came to that nobody stopped."""
    return "complete" if all(op.done for op in operations) else "incomplete"


def _price(job: FaceProblem, found: Orientation) -> float:
    """What an axis that serves costs by the objective, what it leaves charged."""
    assert found.axis is not None
    value = job.worth.value(found.axis, FEEDS.index(found.feed), found.passes, found.length)
    return value * job.worth.charge(found.length, found.unreached)


@dataclass(frozen=True, eq=False)
class PlannerOfFaces:
    """What plans a face of a part whose blades are told apart.

    Attributes
    ----------
    jobs : sequence of PlanningJob
        The same job with each tool.
    """

    jobs: Sequence[PlanningJob]

    @property
    def workers(self) -> int:
        """Processes to work with."""
        return self.jobs[0].workers

    def task(self, part: Part, face: Face, tool: Tool, progress: Progress) -> FaceProblem:
        """What decides about an axis."""
        return replace(self._job(tool), part=part).task(face, progress)

    def search(self, part: Part, op: Operation, progress: Progress) -> Operation:
        """The operation, its axis searched."""
        job = replace(self._job(op.tool), part=part)
        return replace(job._operation(Target(op.face), (op.number - 1, op.number), progress), face=op.face)

    def _job(self, tool: Tool) -> PlanningJob:
        return next(job for job in self.jobs if job.tool == tool)
