"""What an entry is worth, by the judge alone: material is removed along tips and axes, and what is left is measured.

The judge is `toolaxis.verify`, which shares no algorithm with any planner.  On a whole part each ray of a face counts
with the least height that any of the tools leaves.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, degrees, inf, isfinite, nan

import numpy as np
from axisbench.entry import SAME_AXIS, CutterEntry
from axisbench.problem import MOVING, BenchmarkProblem
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import ToolAxisError
from toolaxis.feed.continuous_ik import following
from toolaxis.feed.fixed_axis_time import Feeds, machining_time
from toolaxis.feed.moving_axis_time import five_axis_time
from toolaxis.machine.library import load_machine
from toolaxis.numeric.vectors import angle_between
from toolaxis.plan.choices import FEEDRATE
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.solid import nearest_piece, solid_pieces
from toolaxis.tools.tool import Tool
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.maps import SurfaceMap
from toolaxis.verify.rays import face_rays
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.turned_copies import OperationMeasurement
from toolaxis.verify.verdict import FACTOR, OperationVerdict, measure, verdict_on

Array = NDArray[np.float64]

#: Feed in cuts and rate of rapid traverse that all times are reckoned with, mm/min.
FEED, RAPID = FEEDRATE, 10000.0
#: The machine on which paths over faces are timed where the problem names none.
TIMED_ON = "mikron-ucp-710"
#: Distance of the places on a face at which it is seen whether a motion cuts there, as a share of the widest strip of a
#: ball of the tool's radius on a plane.
_SHARE_OF_STRIP = 1 / 4
#: Poses that are looked at together.
_TOGETHER = 400
#: By how much a clamped rotary axis may move, rad.
_CLAMPED = 1e-5


@dataclass(frozen=True)
class JudgedEntry:
    """What was measured of an entry; nothing here was claimed by it.

    Attributes
    ----------
    passed : bool
    reason : str
        The first sentence on why it failed; empty where it passed.
    finished : float
        Share of the area left no higher than 1.02 times the scallop height, 0 to 1.
    gouge : float
        Deepest gouge, mm.
    clearance : float
        Least distance of shank and holder from everything, and of the cutter from obstacles, mm; inf where nothing is
        near.
    length : float
        Way of the tip, mm, on which the cutter is no farther from a face than the scallop height: run-outs apart.  A
        pass counts no less than the cutter's diameter, so that dabs are no way to cut.  On whole parts the whole length
        of all passes.
    passes, orientations : int
        Orientations are 0 where the axis moves within a pass.
    tools : int
        That cut.
    seconds : float
        On a face by the jerk-limited planner of feeds on a machine; of a whole part at full rates, with index moves and
        changes of tools.  nan where the machine cannot follow.
    """

    passed: bool
    reason: str
    finished: float
    gouge: float
    clearance: float
    length: float
    passes: int
    orientations: int
    tools: int
    seconds: float

    def value(self, measured: str) -> float:
        """What a task measures.

        Parameters
        ----------
        measured : str
            "length", "orientations" or "time".
        """
        return float({"length": self.length, "orientations": self.orientations, "time": self.seconds}[measured])


def judge_entry(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> JudgedEntry:
    """Judge an entry.

    Parameters
    ----------
    problem : BenchmarkProblem
    entries : sequence of CutterEntry
        What each tool does, in that order.
    """
    tasks = [verification_task(problem, one) for one in entries]
    # Moves between passes are held against the finished faces: how much stock stands there is not followed.
    measured = _merge_tools([measure(task)._replace(link_cut=None) for task in tasks])
    verdicts = [verdict_on(task, one) for task, one in zip(tasks, measured, strict=True)]
    reasons = [*_rule_reasons(problem, entries), *_verdict_reasons(problem, verdicts)]
    finished = _finished_share(problem, measured[0])
    return JudgedEntry(not reasons, reasons[0] if reasons else "", finished,
                       max(one.gouge_max for one in verdicts), _least_clearance(verdicts),
                       _length(problem, entries), sum(one.passes for one in entries),
                       len(_orientations(problem, entries)), len({one.tool for one in entries}),
                       _seconds(problem, entries))


def verification_task(problem: BenchmarkProblem, entry: CutterEntry) -> VerificationTask:
    """What the judge is asked of one tool.

    Parameters
    ----------
    problem : BenchmarkProblem
    entry : CutterEntry
    """
    tool = problem.tools[entry.tool]
    asked = problem.asked
    others = tuple(face for face in problem.part.faces if face not in asked)
    return VerificationTask(problem.name, entry.tips, entry.axes, entry.kind, tool.profile, asked, problem.scallop,
                            touching=others, surroundings=problem.obstacles, outlines=tool.outlines,
                            tolerance=Tolerance(problem.tolerance).for_cutter(tool.radius),
                            machine=problem.machine_model)


def _merge_tools(measured: Sequence[OperationMeasurement]) -> list[OperationMeasurement]:
    """Measurements with the least height that any tool leaves on each ray; all else stays each tool's own."""
    if len(measured) == 1:
        return list(measured)
    left = [np.min([one.targets[k].remaining for one in measured], axis=0) for k in range(len(measured[0].targets))]
    return [one._replace(targets=tuple(_with_heights(each, heights) for each, heights
                                                      in zip(one.targets, left, strict=True))) for one in measured]


def _with_heights(one: SurfaceMap, heights: Array) -> SurfaceMap:
    return replace(one, remaining=heights, worst_scallop=None)


def _verdict_reasons(problem: BenchmarkProblem, verdicts: Sequence[OperationVerdict]) -> list[str]:
    """Why the judge refuses it: a whole part may stay open in places, which costs points and is no fault."""
    reasons = [why for one in verdicts if not one.passed for why in one.reasons if " not checked: " not in why]
    if problem.is_part:
        reasons = [why for why in reasons if "scallop limit" not in why]
    return sorted(reasons, key=_gravity)


def _gravity(reason: str) -> int:
    """What is told first: collisions, then gouges, then what stays."""
    if reason.split()[0] in ("cutter", "shank", "holder"):
        return 0
    return 2 if "scallop limit" in reason else 1


def _rule_reasons(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> list[str]:
    """Rules of the tasks that tips and axes break."""
    axes = np.concatenate([one.cutting_axes for one in entries])
    reasons = []
    if problem.axis is not None:
        off = float(angle_between(axes, problem.axis).max())
        if off > SAME_AXIS:
            reasons.append(f"the axis is {degrees(off):.4f} deg from {_axis_text(problem.axis)}, which the problem "
                           "gives: keep that axis in every pass")
    if problem.task == "fixed-axis" and len(_orientations(problem, entries)) > 1:
        reasons.append(f"the passes have {len(_orientations(problem, entries))} axes: one is allowed")
    if problem.axis_limits is not None:
        off = float(problem.axis_limits.excess(axes).max())
        if off > SAME_AXIS:
            reasons.append(f"the axis is {degrees(off):.3f} deg outside the limits {problem.limits}")
    if problem.task == "four-plus-one":
        reasons += _clamping_reasons(problem, entries)
    return reasons


def _clamping_reasons(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> list[str]:
    """Whether one of the machine's rotary axes stands still on all passes."""
    machine = problem.machine_model
    assert machine is not None
    try:
        found = following(machine, entries[0].path)
    except ToolAxisError as reason:
        return [str(reason)]
    cuts = entries[0].kind[found.arrival] == Motion.CUT
    moved = np.ptp(found.rotary[cuts], axis=0)
    if moved.min() <= _CLAMPED:
        return []
    told = " and ".join(f"{axis.name} by {degrees(value):.3f} deg" for axis, value in zip(machine.rotary, moved,
                                                                                      strict=True))
    return [f"on the passes {told} turn on {problem.machine}: one of both must stand still"]


def _axis_text(axis: Array) -> str:
    return "(" + ", ".join(f"{float(value):.6f}" for value in axis) + ")"


def _finished_share(problem: BenchmarkProblem, measured: OperationMeasurement) -> float:
    area = sum(one.area for one in measured.targets)
    return float(sum(one.area_within(FACTOR * problem.scallop) for one in measured.targets) / area)


def _least_clearance(verdicts: Sequence[OperationVerdict]) -> float:
    found = [room.distance for one in verdicts for room in one.clearance.values() if isinstance(room, Clearance)]
    return float(min(found, default=inf))


def _orientations(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> list[Array]:
    """Different axes of the passes in the order in which they come; none where the axis may move."""
    if problem.task in MOVING:
        return []
    found: list[Array] = []
    for one in entries:
        for axis in one.cutting_axes:
            if not any(np.linalg.norm(axis - known) <= SAME_AXIS for known in found[::-1]):
                found.append(axis)
    return found


def _length(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> float:
    if problem.is_part:
        return float(sum(one.path.length(Motion.CUT) for one in entries))
    return working_length(problem.asked[0], problem.tools[0], problem.scallop, entries[0])


def working_length(face: Face, tool: Tool, scallop: float, entry: CutterEntry) -> float:
    """Way of the tip in passes on which the cutter is no farther from the face than 1.02 times the scallop height, mm.

    What is farther away finishes nothing, so that run-outs do not count; whatever finishes something does, and a pass
    no less than the cutter's diameter.

    Parameters
    ----------
    face : Face
    tool : Tool
    scallop : float
        mm
    entry : CutterEntry
    """
    gap = _SHARE_OF_STRIP * 2 * np.sqrt(2 * tool.radius * scallop)
    places, profile, most = face_rays(face, gap).point, tool.profile, FACTOR * scallop
    search = _NearPlaces(cKDTree(places), places, tool, most)
    middle, axes, steps, number = _cut_pieces(entry, gap)
    corner = float(profile.corner_radius)
    # Most poses touch below the corner's centre; the others are looked at over the whole height of the cutter.
    near = search.near(middle, axes, (corner, tool.radius + most))
    rest = np.flatnonzero(~near)
    half = profile.top / 2
    near[rest] = search.near(middle[rest], axes[rest], (half, float(np.hypot(half, profile.top_radius)) + most))
    ways = np.bincount(number[near], steps[near])
    return float(np.maximum(ways[np.unique(number[near])], 2 * tool.radius).sum()) if near.any() else 0.0


class _NearPlaces:
    """Whether the cutter at poses is near to places on a face."""

    def __init__(self, tree: cKDTree, places: Array, tool: Tool, most: float) -> None:
        self._tree, self._places, self._most = tree, places, most
        self._pieces = solid_pieces(tool.profile, {})

    def near(self, tips: Array, axes: Array, ball: tuple[float, float]) -> NDArray[np.bool_]:
        """For each pose whether one of the places in a ball, by its height above the tip and radius, is near, (n,)."""
        found = np.zeros(len(tips), dtype=bool)
        height, radius = ball
        for low in range(0, len(tips), _TOGETHER):
            tip, axis = tips[low:low + _TOGETHER], axes[low:low + _TOGETHER]
            rows = self._tree.query_ball_point(tip + height * axis, radius, return_sorted=False)
            count = np.array([len(one) for one in rows])
            pose = np.repeat(np.arange(len(rows)), count)
            if not len(pose):
                continue
            offset = self._places[np.concatenate([np.array(one, dtype=np.intp) for one in rows])] - tip[pose]
            along = np.einsum("nk,nk->n", offset, axis[pose])
            across = np.sqrt(np.maximum(np.einsum("nk,nk->n", offset, offset) - along**2, 0.0))
            distance = nearest_piece(self._pieces, across, along)[:, 0]
            found[low + pose[distance <= self._most]] = True
        return found


def _cut_pieces(entry: CutterEntry, gap: float) -> tuple[Array, Array, Array, NDArray[np.int64]]:
    """Middles of the cuts in pieces no longer than a gap, the axes there, the length of each, mm, and its pass."""
    cut = entry.kind == Motion.CUT
    rows = np.flatnonzero(cut)
    passes = np.cumsum(cut & ~np.append(False, cut[:-1]))
    middles, axes, lengths, numbers = [], [], [], []
    for k in rows:
        step = entry.tips[k] - entry.tips[k - 1]
        length = float(np.linalg.norm(step))
        count = max(ceil(length / gap), 1)
        share = ((np.arange(count) + 0.5) / count)[:, None]
        middles.append(entry.tips[k - 1] + share * step)
        axis = entry.axes[k - 1] + share * (entry.axes[k] - entry.axes[k - 1])
        axes.append(axis / np.linalg.norm(axis, axis=1, keepdims=True))
        lengths.append(np.full(count, length / count))
        numbers.append(np.full(count, passes[k]))
    return np.concatenate(middles), np.concatenate(axes), np.concatenate(lengths), np.concatenate(numbers)


def _seconds(problem: BenchmarkProblem, entries: Sequence[CutterEntry]) -> float:
    """Time of all motions, s."""
    if problem.is_part:
        ways = [one.path for one in entries]
        moves = sum(60 * (way.length(Motion.CUT) / FEED + way.length(Motion.LINK) / RAPID) for way in ways)
        changes = len(_orientations(problem, entries)) - 1
        return float(moves + INDEX_SECONDS * changes + CHANGE_SECONDS * (len(entries) - 1))
    machine = problem.machine_model or load_machine(TIMED_ON)
    feeds = Feeds(FEED / 60, rapid=RAPID / 60, crossing=FEED / 60)
    try:
        if len(_orientations(problem, entries)) == 1:
            return machining_time(machine, entries[0].path, feeds).total
        return five_axis_time(machine, entries[0].path, feeds)[0].total
    except ToolAxisError:
        return nan


def score_of(problem: BenchmarkProblem, judged: JudgedEntry, record: float | None) -> float:
    """Points of an entry: 100 where it reaches the bound or, without one, the best on record; 0 where it failed.

    On a whole part the share that is finished counts first, and then the area that is finished in a second.

    Parameters
    ----------
    problem : BenchmarkProblem
    judged : JudgedEntry
    record : float or None
        The best on record: a length, mm, a number of orientations, or on whole parts seconds for the whole area.
    """
    found = judged.value(problem.measured)
    if not judged.passed or not isfinite(found) or found <= 0 or judged.finished <= 0:
        return 0.0
    reference = problem.bound or record
    if problem.is_part:
        pace = 1.0 if reference is None else min(reference / seconds_for_all(judged), 1.0)
        return float(100 * judged.finished * pace)
    return 100.0 if reference is None else float(100 * reference / found)


def seconds_for_all(judged: JudgedEntry) -> float:
    """Seconds that the whole area would take at the entry's pace.

    Parameters
    ----------
    judged : JudgedEntry
    """
    return judged.seconds / judged.finished


