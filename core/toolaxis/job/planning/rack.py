"""A part planned with a rack of tools: which tool begins where, and which finishes what others leave."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from string import ascii_lowercase

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import Cancelled
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
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: Area below which what a tool leaves is not worth another one, mm^2.
LEAST_AREA = 0.01
#: Share of the faces that may stay open in a plan that is complete.
LEFT_OPEN = 1e-3


@dataclass(frozen=True, eq=False)
class _Waiting:
    """A sub-surface for which a tool is chosen that has not been used yet.

    face : Face
    tool : number of the tool
    left_by : places in the list of operations of those that left it, the first one first; empty for what none began
    """

    face: Face
    tool: int
    left_by: tuple[int, ...] = ()


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
    _left_by: dict[int, tuple[int, ...]] = field(default_factory=dict)
    _waiting: list[_Waiting] = field(default_factory=list)
    _used: set[int] = field(default_factory=set)

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
        pieces = smooth_pieces(faces, self.jobs[-1].tool)
        self._done += [target.ended for target in pieces if target.ended is not None]
        whole = [target.face for target in pieces if target.ended is None]
        self._screen = _Screen(self.jobs, whole)
        chains: list[tuple[ToolChain, ...]] = []
        for k, face in enumerate(whole):
            progress.report("choice of tools", k, len(whole))
            chains.append(self._screen.chains(face, 0))
        choice = choose_tools(chains, CHANGE_SECONDS)
        self._used = set(choice.tools)
        for face, chain in zip(whole, choice.chains, strict=True):
            # Where the screening sees no way, the smallest tool is asked: it tells why.
            self._waiting.append(_Waiting(face, chain.tools[0] if chain.tools else len(self.jobs) - 1))

    def _with_tool(self, tool: int, progress: Progress) -> bool:
        """Plan all that waits for a tool; False where the user stopped it."""
        job = self.jobs[tool]
        now = [one for one in self._waiting if one.tool == tool]
        self._waiting = [one for one in self._waiting if one.tool != tool]
        if not now:
            return True
        begun = frozenset(op.face.number for op in self._done)
        made = replace(job, kept=begun).plan_pieces([Target(one.face) for one in now], progress)
        if made.part is not job.part:  # a skin was taken apart
            self._take_part(made.part)
        for op in made.operations:
            self._take_over(op, _origin(op.face, now), tool)
        return made.outcome != "cancelled"

    def _take_part(self, part: Part) -> None:
        self.jobs = [replace(job, part=part) for job in self.jobs]
        self._screen = _Screen(self.jobs, [one.face for one in self._waiting] or list(part.faces))

    def _take_over(self, op: Operation, origin: _Waiting, tool: int) -> None:
        """Keep an operation, and send what it leaves to the next tool."""
        if op.done or op.failed:
            place = len(self._done)
            self._done.append(op)
            self._left_by[place] = origin.left_by
            loops = [loop for zone in op.zones if zone.at_wall for loop in zone.loops]
            if not loops or op.failed:
                return
            rest, left_by = op.face.trimmed(tuple(loops), _name_rest(op.face.label)), (*origin.left_by, place)
        else:
            rest, left_by = op.face, origin.left_by
        following = self._next_tool(rest, tool)
        if following is not None:
            self._waiting.append(_Waiting(rest, following, left_by))
        elif not op.done:
            self._left_by[len(self._done)] = left_by
            self._done.append(op)

    def _next_tool(self, rest: Face, tool: int) -> int | None:
        """The tool that finishes what another one left; None where no smaller one reaches anything of it."""
        if rest.area < LEAST_AREA or tool + 1 >= len(self.jobs):
            return None
        chains = self._screen.chains(rest, tool + 1)
        best = min(chains, key=lambda one: one.cost + CHANGE_SECONDS * len(set(one.tools) - self._used))
        if not best.tools:
            return None
        self._used |= set(best.tools)
        return best.tools[0]

    def _put_together(self, outcome: str) -> Plan:
        """The plan of all that was done."""
        machined = self._machined_of_rest()
        rows = [self._with_elsewhere(k, op, machined) for k, op in enumerate(self._done)]
        rows = [replace(op, rest=bool(self._left_by.get(k, ()))) for k, op in enumerate(rows)]
        numbered = tuple(replace(op, number=number) for number, op in enumerate(rows, 1))
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


def _origin(face: Face, some: Sequence[_Waiting]) -> _Waiting:
    """Of which sub-surface that waited a face is one, or a piece."""
    own = [one for one in some if set(face.numbers) <= set(one.face.numbers)]
    named = [one for one in own if not face.label.removeprefix(one.face.label).strip(ascii_lowercase)]
    return max(named or own, key=lambda one: len(one.face.label))


def _name_rest(label: str) -> str:
    """What the rest of a sub-surface is called: 7, then 7.2, then 7.3."""
    head, dot, tail = label.partition(".")
    number = tail.rstrip(ascii_lowercase)
    return f"{head}.{int(number) + 1 if dot and number.isdigit() else 2}{tail[len(number):]}"


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
        self._axes = screening_axes([FaceCells.of(face, jobs[-1].tool.radius) for face in faces], first.axis_limits)

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
        cells = FaceCells.of(face, tools[-1].radius)
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
