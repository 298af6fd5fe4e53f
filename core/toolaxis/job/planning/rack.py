"""A part planned with a rack of tools: which tool begins where, and which finishes what others leave."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import Cancelled, Fault, fault
from toolaxis.job.planning.face_by_face import area_machined, compare_areas, is_better
from toolaxis.job.planning.face_copies import refuse_copy
from toolaxis.job.planning.failures import fail_face
from toolaxis.job.planning.held_side import cut_face
from toolaxis.job.planning.other_tools import ReckonedTimes, may_take_less_time, takes_less_time, tools_of
from toolaxis.job.planning.parallel import abreast
from toolaxis.job.planning.planner import PlanningJob, with_fault
from toolaxis.job.planning.rack_screening import RackScreening, ScreenedFace
from toolaxis.job.planning.sub_surfaces import Target, smooth_pieces
from toolaxis.job.planning.unreachable import prove_unreachable, scene_of
from toolaxis.job.planning.waiting import (
    WaitingSurface,
    find_origin,
    is_in_pieces,
    merge_waiting,
    wait_alone,
)
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS, LEFT_OPEN, Plan
from toolaxis.plan.unplanned_area import REST, UnplannedArea
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.regions.axis_choice import choose_axes
from toolaxis.regions.tool_choice import ToolChain, choose_tools
from toolaxis.shape.face import Face
from toolaxis.skin.alike import AlikeFace, find_alike_faces
from toolaxis.skin.join import take_apart
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Area below which what a tool leaves is not worth another one, mm^2.
LEAST_AREA = 0.01
#: Share of a skin's area below which what is machined of it makes its faces be planned one by one.
APART_BELOW = 0.5
#: Share of a skin that tools have to reach beyond what is machined of it for its faces to be planned one by one.
_MORE = 0.1
#: Share of a face that is out of reach where no tool is asked for it.
PROVEN = 0.99
#: Axes of earlier operations that are tried at once for what these left, at most.
_KNOWN = 5
#: Cutting time above which it is told before it is planned, s.
_VERY_LONG = 8 * 3600.0


@dataclass(eq=False)
class RackPlanner:
    """Plans faces with several tools, the large ones first.

    Attributes
    ----------
    jobs : list of PlanningJob
        The same job with each tool, in the order in which tools are used.
    most : int or None
        Greatest number of tools.
    """

    jobs: list[PlanningJob]
    most: int | None = None
    _done: list[Operation] = field(default_factory=list)
    _left_by: dict[int, frozenset[int]] = field(default_factory=dict)
    #: By the place of an operation, and the label of a face that is alike, the place of the copy there.
    _copied: dict[tuple[int, str], int] = field(default_factory=dict)
    _waiting: list[WaitingSurface] = field(default_factory=list)
    _rests: list[UnplannedArea] = field(default_factory=list)
    _used: set[int] = field(default_factory=set)
    #: What failed that is of no single sub-surface.
    _faults: list[Fault] = field(default_factory=list)
    _steps: Counter[str] = field(default_factory=Counter)
    #: What the choice of tools said that faces take.
    _reckoned: ReckonedTimes = field(default_factory=ReckonedTimes)
    #: Numbers of faces that no further tool was asked for, though something of them was left.
    _given_up: set[int] = field(default_factory=set)

    def plan(self, faces: Sequence[Face], progress: Progress) -> Plan:
        """The plan for faces.

        Parameters
        ----------
        faces : sequence of Face
            Of the jobs' part, skins as one face each.
        progress : Progress

        Returns
        -------
        Plan
            Tool by tool; "complete" where next to nothing of the faces stays open.
        """
        try:
            if self._with_all_tools(faces, progress):
                trying = replace(progress, on_piece=None)  # what is only tried is not shown as found
                self._try_other_tools(faces, trying.within("other tools"))
                self._take_skins_apart(faces, trying.within("faces one by one"))
                return self._put_together("")
        except Cancelled:
            pass
        with activate_progress(NO_PROGRESS):  # what is finished is kept
            for one in self._waiting:
                if one.left_by:
                    self._rests += _rests_not_begun(one, one.area)
            return self._put_together("cancelled")

    def _with_all_tools(self, faces: Sequence[Face], progress: Progress,
                        goes_on: Callable[[Face, int], bool] | None = None) -> bool:
        """Plan faces with the tools that are chosen for them; False where the user stopped it.

        goes_on : takes a face and the number of a tool that is done with it, and tells whether others follow.  Where
        it says no and something of a face still waits, the face is given up: its operations do not cover it
        """
        self._begin(faces, progress)
        for tool, job in enumerate(self.jobs):
            if not self._with_tool_to_the_end(tool, progress.within(job.tool.shop_name)):
                return False
            if goes_on is not None:
                for one in self._waiting:
                    if not goes_on(one.root, tool):
                        self._given_up |= {one.root.number, *(alike.face.number for alike in one.copies)}
                self._waiting = [one for one in self._waiting if one.root.number not in self._given_up]
        return True

    def _begin(self, faces: Sequence[Face], progress: Progress) -> None:
        """Choose the tools for whole faces."""
        smallest = self.jobs[-1].tool
        pieces = smooth_pieces(faces, smallest)
        whole = [target.face for target in pieces if target.ended is None]
        self._done += [target.ended for target in pieces if target.ended is not None]
        self._screen = RackScreening(self.jobs, whole)
        progress.report("looking for faces that are alike", 0, 0)
        alike = self._find_alike(whole)
        originals = [face for k, face in enumerate(whole) if k not in alike]
        copies = {face: tuple(one for one in alike.values() if one.original is face) for face in originals}
        found = self._screen_faces(originals, copies, progress)
        screened, chains = list(found), [one.chains for one in found.values()]
        self._screen.keep(found)
        counts = [1 + len(copies[face]) for face in screened]
        every = [one for one, count in zip(chains, counts, strict=True) for _ in range(count)]
        choice = choose_tools(every, CHANGE_SECONDS, self.most)
        chosen = [choice.chains[k] for k in np.cumsum([0, *counts[:-1]])] if counts else []
        area = sum(face.area * count for face, count in zip(screened, counts, strict=True))
        self._tell_time(area, sum(one.seconds for one in choice.chains), progress)
        self._used = set(choice.tools)
        if self.most is not None and not self._used:
            self._used = {len(self.jobs) - 1}
        for face, chain, others in zip(screened, chosen, chains, strict=True):
            self._reckoned.add((face, *(one.face for one in copies[face])), chain, others)
        self._wait_or_refuse(screened, chosen, copies, progress)

    def _screen_faces(self, faces: Sequence[Face], copies: Mapping[Face, tuple[AlikeFace, ...]],
                      progress: Progress) -> dict[Face, ScreenedFace]:
        """What the screening says of whole faces; one on which the program fails is done, with its copies."""
        order = sorted(range(len(faces)), key=lambda k: -faces[k].area)  # who waits wants to see the largest first

        def _screen_one(place: int, inner: Progress) -> ScreenedFace:
            inner.report("choice of tools", place, len(faces))
            face = faces[order[place]]
            screened = self._screen.look_at(face, 0)
            self._hand_over(face, screened, copies[face], inner)
            return screened

        found = abreast(_screen_one, len(faces), self.jobs[0].workers, progress)
        if found.cancelled:
            raise Cancelled("cancelled by the user")
        for place, why in found.faults.items():
            failed = faces[order[place]]
            self._done += [fail_face(1, face, self.jobs[-1].tool, why)
                           for face in (failed, *(one.face for one in copies[failed]))]
        results = {order[place]: one for place, one in found.results.items()}
        return {faces[k]: results[k] for k in sorted(results)}

    def _hand_over(self, face: Face, screened: ScreenedFace, copies: Sequence[AlikeFace], progress: Progress) -> None:
        """Let whoever listens see which tools reach what of a face, and of those that are alike."""
        if progress.on_piece is None or not screened.reach.shape[2]:
            return
        with suppress(Exception):  # a picture that fails costs no face
            found = self._screen.largest_tools(face, screened.reach)
            for one in (found, *(found.carry_to(alike) for alike in copies)):
                progress.hand_over(one)

    def _wait_or_refuse(self, faces: Sequence[Face], chains: Sequence[ToolChain],
                        copies: Mapping[Face, tuple[AlikeFace, ...]], progress: Progress) -> None:
        """Let whole faces wait for the first tools of their chains; refuse those that no tool reaches, where proven."""
        without: list[Face] = []
        for face, chain in zip(faces, chains, strict=True):
            if chain.tools:
                self._waiting.append(WaitingSurface(face, (), chain.tools[0], in_pieces=is_in_pieces(chain),
                                                    axes=chain.axes, copies=copies[face]))
            else:  # each of those that are alike stands among other surroundings
                without += [face, *(alike.face for alike in copies[face])]
        scene, asked = scene_of(self.jobs[0]), self.jobs[0].asked_area

        def _prove(k: int, inner: Progress) -> float:
            inner.report("proof of what is out of reach", k, len(without))
            face = without[k]
            return prove_unreachable(face, self.jobs, scene, face.area / (asked or face.area)).area

        found = abreast(_prove, len(without), self.jobs[0].workers, progress)
        if found.cancelled:
            raise Cancelled("cancelled by the user")
        for k, face in enumerate(without):
            proven = found.results.get(k, 0.0)
            if proven >= PROVEN * face.area:
                self._done.append(_refuse(face, self.jobs[-1].tool, proven))
            else:  # the screening sees no way, and the smallest tool tells why
                self._waiting.append(WaitingSurface(face, (), max(self._allowed)))

    def _find_alike(self, faces: Sequence[Face]) -> dict[int, AlikeFace]:
        """Those of the faces that are alike others with the same allowance, by their places.

        None where the program fails on them.  A mirror would make climb milling of conventional milling.
        """
        job = self.jobs[0]
        left_on = job.inputs.allowance_of
        try:
            reach = max(one.tool.radius for one in self.jobs)
            found = find_alike_faces(job.part, faces, reach, mirrored=job.inputs.direction == "zigzag")
            return {k: one for k, one in found.items() if left_on(one.face) == left_on(one.original)}
        except Cancelled:
            raise
        except Exception as reason:
            words = f"faces that are alike are planned each by itself: {fault(reason).sentence}"
            self.jobs = [replace(one, part=one.part.with_warnings(words)) for one in self.jobs]
            return {}

    def _tell_time(self, area: float, seconds: float, progress: Progress) -> None:
        """Tell before all else where cutting will take very long: of a large part with small tools."""
        if seconds <= _VERY_LONG:
            return
        hours, square = f"{seconds / 3600:.0f}", f"{area / 1e6:.3g}"
        progress.report(f"choice of tools: about {hours} h of cutting", 1, 1)
        height = self.jobs[0].inputs.scallop
        words = (f"cutting takes about {hours} h: {square} m2 at a scallop height of {height:g} mm; larger tools "
                 "(--tool) or a coarser --scallop shorten it")
        part = self.jobs[0].part.with_warnings(words)
        self.jobs = [replace(job, part=part) for job in self.jobs]

    @property
    def _allowed(self) -> set[int]:
        """Numbers of the tools that may be used: all, or those that were chosen where their number is limited."""
        return set(range(len(self.jobs))) if self.most is None or not self._used else set(self._used)

    def _with_tool_to_the_end(self, tool: int, progress: Progress) -> bool:
        """Plan all that waits for a tool, copies that are refused by themselves; False where the user stopped it."""
        while any(one.tool == tool for one in self._waiting):
            if not self._with_tool(tool, progress):
                return False
        return True

    def _with_tool(self, tool: int, progress: Progress) -> bool:
        """Plan what waits for a tool; False where the user stopped it."""
        merged = merge_waiting([one for one in self._waiting if one.tool == tool])
        now = {self._name(one): one for one in self._choose_axes(merged, tool)}
        self._waiting = [one for one in self._waiting if one.tool != tool]
        targets = [target for label, one in now.items() if (target := self._target_of(one, label)) is not None]
        targets.sort(key=lambda target: -target.face.area)  # somebody may stop it before all is done
        job = replace(self.jobs[tool], known_axes=self._axes_under(tool))
        made = job.plan_pieces(targets, self._screen.scene, progress)
        self._faults += made.faults
        origins = [find_origin(op.face, now) for op in made.operations]
        rests = [self._rest_of(op, origin) for op, origin in zip(made.operations, origins, strict=True)]
        following = None if made.outcome == "cancelled" else self._chains_for(rests, tool, progress)
        copied = None if following is None else self._copy(made.operations, origins, tool, progress)
        if following is not None and copied is not None:
            rows = zip(made.operations, origins, rests, following, copied, strict=True)
            for op, origin, rest, chains, copies in rows:
                self._take_over(op, origin, self._best_of(chains), rest, copies)
                for one in (op, *copies.values()):
                    if one.done:
                        progress.hand_over(one)
            return True
        for op, origin in zip(made.operations, origins, strict=True):
            self._keep_last(op, origin, tool)
        with activate_progress(NO_PROGRESS):  # areas are evaluated for it, whoever wants to stop
            self._count_unfinished(now, made.operations)
        return False

    def _choose_axes(self, some: Sequence[WaitingSurface], tool: int) -> list[WaitingSurface]:
        """Surfaces that wait for a tool, each with the axis that lets all of them take least time together."""
        used = self._screen.numbers_of(self._axes_under(tool))
        reckoned = [one for one in some if one.axes]
        options = [[time._replace(seconds=time.seconds + INDEX_SECONDS * self._further_axes(one, time.axis))
                    for time in one.axes] for one in reckoned]
        chosen = dict(zip(reckoned, choose_axes(options, used, INDEX_SECONDS), strict=True))
        times = Counter((*chosen.values(), *used))
        return [replace(one, axis=self._screen.axis(chosen[one]), shared=times[chosen[one]] > 1)
                if one in chosen else one for one in some]

    def _further_axes(self, one: WaitingSurface, number: int) -> int:
        """How many more axes there are where an axis is turned with the copies of a surface."""
        axis = self._screen.axis(number)
        turned = [axis, *(alike.matrix[:3, :3] @ axis for alike in one.copies)]
        return len(np.unique(np.round(turned, 6) + 0.0, axis=0)) - 1

    def _axes_under(self, tool: int) -> tuple[Array, ...]:
        """The axes under which a tool machines something already."""
        axes = (op.orientation.axis for op in self._done if op.done and op.tool == self.jobs[tool].tool)
        return tuple(axis for axis in axes if axis is not None)

    def _target_of(self, one: WaitingSurface, label: str) -> Target | None:
        """The sub-surface of what waits; None where the program fails to make it, and the plan tells that it did.

        What other operations left stays open then, as is told of these.
        """
        try:
            face = one.root.trimmed(one.loops, label) if one.loops else one.root
            first = one.axis if one.shared else None  # before all others: it saves an index move
            return Target(face, first, others=self._axes_of(one), in_pieces=one.in_pieces)
        except Cancelled:
            raise
        except Exception as reason:
            self._faults.append(fault(reason))
            return None

    def _keep_last(self, op: Operation, origin: WaitingSurface, tool: int) -> None:
        """Keep an operation when the user has stopped the plan: no smaller tool is asked for what it leaves."""
        self._keep(op, origin.left_by)
        area = sum(zone.area for zone in op.zones if zone.at_wall)
        if op.done and area >= LEAST_AREA and tool < max(self._allowed):
            self._rests.append(_rest_not_begun(origin.root, area))

    def _count_unfinished(self, now: Mapping[str, WaitingSurface], finished: Sequence[Operation]) -> None:
        """Tell how much of rests a tool was not done with when the user stopped it."""
        for one in now.values():
            if not one.left_by:  # that is seen from the faces themselves
                continue
            done = sum(op.face.area for op in finished if find_origin(op.face, now) is one)
            left = one.area - done
            if left >= LEAST_AREA:
                self._rests.append(_rest_not_begun(one.root, left))
            self._rests += [_rest_not_begun(alike.face, one.area) for alike in one.copies]

    def _axes_of(self, one: WaitingSurface) -> tuple[Array, ...]:
        """Axes of earlier operations on the same face, those first that left what waits, and not too many; then that of
        the choice of tools."""
        left_it = [self._done[place] for place in sorted(one.left_by)]
        axes = [op.orientation.axis for op in (*left_it, *self._done) if op.face.number == one.root.number]
        found: list[Array] = []
        for axis in axes:
            if axis is not None and not any(np.array_equal(axis, other) for other in found):
                found.append(axis)
        found = found[:_KNOWN]
        if one.axis is not None and not one.shared:
            found.append(one.axis)
        return tuple(found)

    def _name(self, one: WaitingSurface) -> str:
        """What a sub-surface is called in reports: 7, and what is left of it 7.2, then 7.3."""
        self._steps[one.root.label] += 1
        step = self._steps[one.root.label]
        return f"{one.root.label}.{step}" if one.loops else one.root.label

    def _chains_for(self, rests: Sequence[Face | None], tool: int,
                    progress: Progress) -> list[tuple[ToolChain, ...]] | None:
        """What smaller tools may do of what one left, for each rest; None where the user stopped it."""
        if tool + 1 >= len(self.jobs):
            return [()] * len(rests)

        def _look_at(k: int, inner: Progress) -> ScreenedFace | None:
            inner.report("choice of tools", k, len(rests))
            rest = rests[k]
            if rest is None or rest.area < LEAST_AREA:
                return None
            return self._screen.look_at(rest, tool + 1)

        found = abreast(_look_at, len(rests), self.jobs[0].workers, progress)
        if found.cancelled:
            return None
        # Where it fails, what was left stays open, as it is told of the operation that left it.
        seen = [(rest, found.results.get(k)) for k, rest in enumerate(rests)]
        self._screen.keep({rest: one for rest, one in seen if rest is not None and one is not None})
        return [() if one is None else one.chains for _, one in seen]

    def _copy(self, operations: Sequence[Operation], origins: Sequence[WaitingSurface], tool: int,
              progress: Progress) -> list[dict[str, Operation]] | None:
        """What became of each operation on the faces that are alike, by their labels; None where the user stopped it.

        A face on which the operation is refused is missing.
        """
        job = self.jobs[tool]
        asked = [(k, alike) for k, op in enumerate(operations) if op.done for alike in origins[k].copies]
        made = job.copy_operations([(operations[k], alike) for k, alike in asked], progress)
        if made is None:
            return None
        found: list[dict[str, Operation]] = [{} for _ in operations]
        for (k, alike), other in zip(asked, made, strict=True):
            if other is not None and other.done:
                found[k][alike.face.label] = other
        for op, origin, one in zip(operations, origins, found, strict=True):
            if not op.done and not op.failed and job.axis_limits is None and not job.bodies:
                there = [(alike, alike.carry_piece(op.face)) for alike in origin.copies if alike.everywhere]
                one.update({alike.face.label: refuse_copy(op, piece) for alike, piece in there if piece is not None})
        return found

    def _rest_of(self, op: Operation, origin: WaitingSurface) -> Face | None:
        """What an operation leaves for smaller tools; None where that is nothing, or the program fails to make it."""
        if op.failed:
            return None
        loops = tuple(loop for zone in op.zones if zone.at_wall for loop in zone.loops) if op.done else op.face.outline
        try:
            return origin.root.trimmed(loops) if loops else None
        except Exception as reason:
            self._faults.append(fault(reason))
            return None

    def _take_over(self, op: Operation, origin: WaitingSurface, following: ToolChain | None, rest: Face | None,
                   copies: Mapping[str, Operation]) -> None:
        """Keep an operation and its copies, and send what it leaves to the next tool."""
        kept = op.done or following is None
        place = self._keep(op, origin.left_by) if kept else -1
        still = tuple(alike for alike in origin.copies if not kept or alike.face.label in copies)
        for alike in origin.copies:
            left_by = frozenset(self._copied[one, alike.face.label] for one in origin.left_by)
            if alike not in still:
                self._waiting += wait_alone(op, origin, alike, left_by)
            elif kept:
                self._copied[place, alike.face.label] = self._keep(copies[alike.face.label], left_by)
            self._steps[alike.face.label] = max(self._steps[alike.face.label], self._steps[origin.root.label])
        if rest is not None and following is not None:
            left_by = origin.left_by | {place} if op.done else origin.left_by
            self._waiting.append(WaitingSurface(origin.root, rest.outline, following.tools[0], left_by,
                                                is_in_pieces(following), following.axes, copies=still))

    def _keep(self, op: Operation, left_by: frozenset[int]) -> int:
        """Keep an operation; its place."""
        self._left_by[len(self._done)] = left_by
        self._done.append(op)
        return len(self._done) - 1

    def _best_of(self, chains: Sequence[ToolChain]) -> ToolChain | None:
        """The tools that finish what another one left; None where no smaller one reaches anything of it."""
        chains = [one for one in chains if one.tools and set(one.tools) <= self._allowed]
        if not chains:
            return None
        best = min(chains, key=lambda one: one.cost + CHANGE_SECONDS * len(set(one.tools) - self._used))
        self._used |= set(best.tools)
        return best

    def _try_other_tools(self, faces: Sequence[Face], progress: Progress) -> None:
        """Plan faces once more that other tools may take much less time for, and keep what is better."""
        inputs = self.jobs[0].inputs
        for first, numbers in self._reckoned.find_slow_faces(self._done, inputs, self._allowed).items():
            other = RackPlanner([self.jobs[k] for k in sorted(self._allowed) if k >= first])
            again = [face for face in faces if face.number in numbers]

            def _goes_on(face: Face, tool: int, other: RackPlanner = other) -> bool:
                """Whether what other tools made of a face so far promises to take less time."""
                own, rows = ([op for op in some if op.face.number == face.number] for some in (self._done, other._done))
                return may_take_less_time(rows, own, [job.tool for job in other.jobs[tool + 1:]], inputs)

            if not other._with_all_tools(again, progress, _goes_on):
                raise Cancelled("cancelled by the user")
            self._faults += other._faults
            for face in again:
                if face.number in other._given_up:
                    continue
                own, rows = ([op for op in some if op.face.number == face.number] for some in (self._done, other._done))
                elsewhere = tools_of(op for op in self._done if op.face.number != face.number)
                if not any(op.failed for op in rows) and takes_less_time(rows, own, elsewhere, inputs):
                    self._exchange(face, other, rows)

    def _take_skins_apart(self, faces: Sequence[Face], progress: Progress) -> None:
        """Plan the faces of skins of which little is machined one by one, and keep that where it is better."""
        part = self.jobs[0].part
        own = {skin.number: [op for op in self._done if op.face.number == skin.number] for skin in faces
               if skin.members}
        lost = [skin for skin in faces if skin.number in own and not any(op.failed for op in own[skin.number])
                and area_machined(own[skin.number]) < APART_BELOW * skin.area]
        lost = self._with_more_in_reach(lost, own, progress)
        if not lost:
            return
        apart = take_apart(part, [skin.number for skin in lost])
        other = RackPlanner([replace(self.jobs[k], part=apart) for k in sorted(self._allowed)])
        cut = (cut_face(apart.face(number), apart.held) for skin in lost for number in skin.numbers)
        made = other.plan([face for face in cut if face is not None], progress)
        if made.outcome == "cancelled":
            raise Cancelled("cancelled by the user")
        for skin in lost:
            rows = [op for op in other._done if op.face.number in skin.numbers]
            if is_better(rows, own[skin.number], skin.area):
                part = take_apart(part, [skin.number]).with_warnings(compare_areas(skin, own[skin.number], rows))
                self._exchange(skin, other, rows)
        self.jobs = [replace(job, part=part) for job in self.jobs]

    def _with_more_in_reach(self, skins: Sequence[Face], own: Mapping[int, Sequence[Operation]],
                            progress: Progress) -> list[Face]:
        """Those of some skins of which tools reach more than was machined: of the others faces hold no more either."""
        found = abreast(lambda k, _: self._screen.reachable(skins[k]), len(skins), self.jobs[0].workers, progress)
        if found.cancelled:
            raise Cancelled("cancelled by the user")
        return [skin for k, skin in enumerate(skins)
                if found.results.get(k, skin.area) - area_machined(own[skin.number]) > _MORE * skin.area]

    def _exchange(self, skin: Face, other: "RackPlanner", rows: Sequence[Operation]) -> None:
        """Put operations of another planner, on the faces of a skin, in the place of those of the skin."""
        kept = [(op, self._parents(k)) for k, op in enumerate(self._done) if op.face.number != skin.number]
        new = [(op, other._parents(k)) for k, op in enumerate(other._done) if op in rows]
        places = {id(op): k for k, (op, _) in enumerate([*kept, *new])}
        self._done = [op for op, _ in [*kept, *new]]
        self._left_by = {k: frozenset(places[id(one)] for one in parents)
                         for k, (_, parents) in enumerate([*kept, *new])}

    def _parents(self, place: int) -> list[Operation]:
        """The operations that left what the one at a place machines."""
        return [self._done[k] for k in self._left_by.get(place, ())]

    def _put_together(self, outcome: str) -> Plan:
        """The plan of all that was done."""
        machined = self._machined_of_rest()
        rows = [self._with_elsewhere(k, op, machined) for k, op in enumerate(self._done)]
        numbered = tuple(replace(op, number=k + 1, rest_of=tuple(sorted(one + 1 for one in self._left_by.get(k, ()))))
                         for k, op in enumerate(rows))
        if not outcome:
            outcome = outcome_of_rack(numbered)
        made = replace(self.jobs[0].empty(), tools=tuple(job.tool for job in self.jobs), operations=numbered,
                       outcome=outcome, unplanned=tuple(self._rests))
        for why in self._faults:
            made = with_fault(made, why)
        return made

    def _machined_of_rest(self) -> dict[int, float]:
        """By operation the area that others machine of what it left, mm^2."""
        found: dict[int, float] = {}
        for place, left_by in self._left_by.items():
            op = self._done[place]
            if op.done:
                for parent in left_by:
                    found[parent] = found.get(parent, 0.0) + op.face.area * (1 - op.orientation.unreached)
        return found

    def _with_elsewhere(self, place: int, op: Operation, machined: dict[int, float]) -> Operation:
        """An operation whose zones tell how much of them others machine."""
        area = sum(zone.area for zone in op.zones if zone.at_wall)
        if not op.done or not area or place not in machined:
            return op
        share = min(machined[place] / area, 1.0)
        return replace(op, zones=tuple(replace(zone, elsewhere=share * zone.area) if zone.at_wall else zone
                                       for zone in op.zones))


def outcome_of_rack(operations: Sequence[Operation]) -> str:
    """What a plan with several tools came to that nobody stopped: complete where next to nothing stays open.

    Parameters
    ----------
    operations : sequence of Operation
    """
    account = PartAccount.of(operations)
    lost = any(op.failed for op in operations) or not account.machined
    return "incomplete" if lost or account.open > LEFT_OPEN * account.area else "complete"


def _rest_not_begun(face: Face, area: float) -> UnplannedArea:
    """Area that larger tools leave of a face, mm^2, and for which no smaller one was asked before the stop."""
    return UnplannedArea(face.number, face.label, area, False, REST)


def _rests_not_begun(one: WaitingSurface, area: float) -> list[UnplannedArea]:
    """The same of a sub-surface and those of the faces that are alike."""
    return [_rest_not_begun(face, area) for face in (one.root, *(alike.face for alike in one.copies))]


def _refuse(face: Face, tool: Tool, proven: float) -> Operation:
    """The operation of a face of which so much, mm^2, is proven to be out of reach of all tools."""
    share = 100 * proven / face.area
    why = f"infeasible: no tool of the rack reaches it with any axis, proven for {share:.1f} % of its area"
    none = Orientation(None, outcome="infeasible", reasons=(why,))
    return Operation(1, face, tool, none, unreachable=proven)
