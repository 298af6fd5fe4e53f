"""A part planned with a rack of tools: which tool begins where, and which finishes what others leave."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import Cancelled, fault
from toolaxis.job.planning.failures import fail_face
from toolaxis.job.planning.planner import PlanningJob
from toolaxis.job.planning.sub_surfaces import Target, smooth_pieces
from toolaxis.plan.operation import Operation
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS, Plan
from toolaxis.progress import Progress
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.prices import widths
from toolaxis.regions.reach_screen import screen_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.tool_choice import FacePrices, ToolChain, chains_of, choose_tools
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Area below which what a tool leaves is not worth another one, mm^2.
LEAST_AREA = 0.01
#: Angle between the axes that are screened, rad, and cells of a face for it, about.
APART, _CELLS = np.radians(20), 200
#: Share of the faces that may stay open in a plan that is complete.
LEFT_OPEN = 1e-3


@dataclass(frozen=True, eq=False)
class _Waiting:
    """What waits for a tool.

    root : Face
        The sub-surface that was asked for.
    loops : tuple of (m, 2) arrays
        In (u, v) of it, what earlier tools left; empty for the whole of it.
    tool : int
        Number of the tool.
    left_by : frozenset of int
        Places in the list of operations of those that left it.
    """

    root: Face
    loops: tuple[Array, ...]
    tool: int
    left_by: frozenset[int] = frozenset()


@dataclass(eq=False)
class RackPlanner:
    """Plans faces with several tools, the large ones first.

    Attributes
    ----------
    jobs : list of PlanningJob
        The same job with each tool, in the order in which tools are used.
    """

    jobs: list[PlanningJob]
    _done: list[Operation] = field(default_factory=list)
    _left_by: dict[int, frozenset[int]] = field(default_factory=dict)
    _waiting: list[_Waiting] = field(default_factory=list)
    _used: set[int] = field(default_factory=set)
    _steps: Counter[str] = field(default_factory=Counter)

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
            self._begin(faces, progress)
            for tool, job in enumerate(self.jobs):
                if not self._with_tool(tool, progress.within(job.tool.shop_name)):
                    return self._put_together("cancelled")
        except Cancelled:
            return self._put_together("cancelled")
        return self._put_together("")

    def _begin(self, faces: Sequence[Face], progress: Progress) -> None:
        """Choose the tools for whole faces."""
        smallest = self.jobs[-1].tool
        pieces = smooth_pieces(faces, smallest)
        whole = [target.face for target in pieces if target.ended is None]
        self._done += [target.ended for target in pieces if target.ended is not None]
        self._screen = _Screen(self.jobs, whole)
        screened: list[Face] = []
        chains: list[tuple[ToolChain, ...]] = []
        for k, face in enumerate(whole):
            progress.report("choice of tools", k, len(whole))
            try:
                chains.append(self._screen.chains(face, 0))
                screened.append(face)
            except Cancelled:
                raise
            except Exception as reason:
                self._done.append(fail_face(1, face, smallest, fault(reason)))
        choice = choose_tools(chains, CHANGE_SECONDS)
        self._used = set(choice.tools)
        for face, chain in zip(screened, choice.chains, strict=True):
            # Where the screening sees no way, the smallest tool is asked: it tells why.
            self._waiting.append(_Waiting(face, (), chain.tools[0] if chain.tools else len(self.jobs) - 1))

    def _with_tool(self, tool: int, progress: Progress) -> bool:
        """Plan all that waits for a tool; False where the user stopped it."""
        now = {self._name(one): one for one in _merge([one for one in self._waiting if one.tool == tool])}
        self._waiting = [one for one in self._waiting if one.tool != tool]
        if not now:
            return True
        targets = [Target(one.root.trimmed(one.loops, label) if one.loops else one.root) for label, one in now.items()]
        job = replace(self.jobs[tool], kept=frozenset(op.face.number for op in self._done))
        made = job.plan_pieces(targets, progress)
        if made.outcome == "cancelled":  # what is finished is kept; nothing goes to another tool any more
            for op in made.operations:
                self._left_by[len(self._done)] = _origin(op.face, now).left_by
                self._done.append(op)
            return False
        if made.part is not job.part:  # a skin was taken apart
            self.jobs = [replace(one, part=made.part) for one in self.jobs]
            self._screen = _Screen(self.jobs, [op.face for op in made.operations])
        for op in made.operations:
            self._take_over(op, _origin(op.face, now), tool)
        return True

    def _name(self, one: _Waiting) -> str:
        """What a sub-surface is called in reports: 7, and what is left of it 7.2, then 7.3."""
        self._steps[one.root.label] += 1
        step = self._steps[one.root.label]
        return f"{one.root.label}.{step}" if one.loops else one.root.label

    def _take_over(self, op: Operation, origin: _Waiting, tool: int) -> None:
        """Keep an operation, and send what it leaves to the next tool."""
        # A piece of a skin that was taken apart is a root of its own.
        root = origin.root if op.face.numbers == origin.root.numbers else op.face
        loops, left_by = op.face.outline, origin.left_by
        if op.done:
            left_by = origin.left_by | {len(self._done)}
            loops = tuple(loop for zone in op.zones if zone.at_wall for loop in zone.loops)
        following = None if op.failed or not loops else self._next_tool(root.trimmed(loops), tool)
        if op.done or following is None:
            self._left_by[len(self._done)] = origin.left_by
            self._done.append(op)
        if following is not None:
            self._waiting.append(_Waiting(root, loops, following, left_by))

    def _next_tool(self, rest: Face, tool: int) -> int | None:
        """The tool that finishes what another one left; None where no smaller one reaches anything of it."""
        if rest.area < LEAST_AREA or tool + 1 >= len(self.jobs):
            return None
        try:
            chains = self._screen.chains(rest, tool + 1)
        except Cancelled:
            raise
        except Exception:  # what was left stays open, as it is told of the operation that left it
            return None
        best = min(chains, key=lambda one: one.cost + CHANGE_SECONDS * len(set(one.tools) - self._used))
        if not best.tools:
            return None
        self._used |= set(best.tools)
        return best.tools[0]

    def _put_together(self, outcome: str) -> Plan:
        """The plan of all that was done."""
        machined = self._machined_of_rest()
        rows = [self._with_elsewhere(k, op, machined) for k, op in enumerate(self._done)]
        numbered = tuple(replace(op, number=k + 1, rest_of=tuple(sorted(one + 1 for one in self._left_by.get(k, ()))))
                         for k, op in enumerate(rows))
        account = PartAccount.of(numbered)
        if not outcome:
            lost = any(op.failed for op in numbered) or not account.machined
            outcome = "incomplete" if lost or account.open > LEFT_OPEN * account.area else "complete"
        return replace(self.jobs[0].empty(), tools=tuple(job.tool for job in self.jobs), operations=numbered,
                       outcome=outcome)

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


def _merge(some: Sequence[_Waiting]) -> list[_Waiting]:
    """What waits for a tool, that of one sub-surface together."""
    found: dict[int, _Waiting] = {}
    for one in some:
        before = found.get(id(one.root))
        found[id(one.root)] = one if before is None else replace(
            one, loops=(*before.loops, *one.loops), left_by=before.left_by | one.left_by)
    return list(found.values())


def _origin(face: Face, named: Mapping[str, _Waiting]) -> _Waiting:
    """Of which sub-surface that waited a face is one, or a piece: pieces have letters behind its name."""
    label = face.label
    while label not in named and label[-1:].isalpha():
        label = label[:-1]
    return named[label] if label in named else next(
        one for one in named.values() if set(face.numbers) <= set(one.root.numbers))


class _Screen:
    """What tools reach of faces, and what it takes, as the screening sees it.

    Parameters
    ----------
    jobs : sequence of PlanningJob
    faces : sequence of Face
        From whose normals the axes are taken.
    """

    def __init__(self, jobs: Sequence[PlanningJob], faces: Sequence[Face]) -> None:
        first = jobs[0]
        self._jobs = jobs
        self._scene = ReachScene.of(first.part, first.obstacles, first.inputs.tolerance, first.axis_limits,
                                    first.inputs.allowance)
        self._axes = screening_axes([self._cells(face) for face in faces], first.axis_limits, APART)

    def _cells(self, face: Face) -> FaceCells:
        return FaceCells.of(face, max(self._jobs[-1].tool.radius, float(np.sqrt(face.area / _CELLS))))

    def chains(self, face: Face, begin: int) -> tuple[ToolChain, ...]:
        """Chains of tools for a face, from a tool on.

        Parameters
        ----------
        face : Face
        begin : int
        """
        jobs = self._jobs[begin:]
        inputs = jobs[0].inputs
        tools = [job.tool for job in jobs]
        cells = self._cells(face)
        axes = self._axes[(cells.normal @ self._axes.T > 0).any(axis=0)]
        if not len(axes) or not len(cells):
            return (ToolChain((), 0.0, 0.0),)
        reached = screen_reach(cells, tools, axes, self._scene)
        wide = widths(cells, tools, axes, inputs.scallop, inputs.allowance)
        pace = np.array([job.inputs.at_rates_of(job.tool).feedrate / 60 for job in jobs])[:, None, None]
        held = reached & (wide > 0)
        seconds = np.where(held, cells.area / (np.where(held, wide, 1.0) * pace), np.inf)
        found = chains_of(FacePrices(seconds, cells.area), INDEX_SECONDS)
        return tuple(one._replace(tools=tuple(tool + begin for tool in one.tools)) for one in found)
