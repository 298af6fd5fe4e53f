"""Passes with a moving axis laid over a face, joined, followed by the machine, and proven."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.collision.machine_collision import Meeting, Surroundings, words
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER, SKIN
from toolaxis.feasibility.violations import BACK, LIMITS, Witness
from toolaxis.feed.continuous_ik import Following, following
from toolaxis.machine.limits import ROUNDING
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.path.chord_tolerance import follow, rises
from toolaxis.path.cl_points import climbing
from toolaxis.path.constant_lead import LeadChart, LeadCut
from toolaxis.path.links import Linking
from toolaxis.path.parametrization import tip_points
from toolaxis.path.pass_layout import Layout, lay_out
from toolaxis.plan.orientation import Orientation
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.fixed_axis import Task
from toolaxis.search.link_heights import OVER, height_over
from toolaxis.search.machine_limits import mounting_of, while_moving
from toolaxis.search.path_check import Proof
from toolaxis.strategies.common.links import MovingStroke, Swivelling, joined
from toolaxis.strategies.common.machine_collision import meeting_in_motion, motions
from toolaxis.strategies.common.path_check import MovingCrossing, prove_moving

Array = NDArray[np.float64]

CHECKED = ("the cutter on the machined skin is checked at points of the path, 0.5 mm and 0.5 deg apart at most; all "
           "other distances are proven along it")


@dataclass(frozen=True, eq=False)
class Laid:
    """Passes that were laid, or why they may not be used.

    Attributes
    ----------
    placed : Layout or None
    path : ToolPath or None
    witness : Witness or None
        What speaks against them.
    proof : Proof or None
    """

    placed: Layout | None = None
    path: ToolPath | None = None
    witness: Witness | None = None
    proof: Proof | None = None

    def orientation(self, job: Task, cut: LeadCut, words: tuple[str, ...], tried: int, lead: float) -> Orientation:
        """What passes without a witness come to.

        Parameters
        ----------
        job : Task
        cut : LeadCut
        words : tuple of str
            The reasons.
        tried : int
            Axes looked at.
        lead : float
            rad
        """
        assert self.placed is not None and self.path is not None and self.proof is not None
        length = self.path.length(Motion.CUT)
        return Orientation(np.asarray(unit(self.path.axis.mean(axis=0))), cut.feed, self.path.passes, self.placed.used,
                           length, job.worth.face.area / length, self.proof.gouge, self.proof.clearance, "feasible",
                           words, evaluations=tried, lead=lead)


def laid(job: Task, chart: LeadChart, cut: LeadCut,
         finish: Callable[[ToolPath], ToolPath] = lambda path: path) -> Laid:
    """Passes of a cut with a moving axis, made and judged.

    Parameters
    ----------
    job : Task
    chart : LeadChart
    cut : LeadCut
    finish : callable
        What is done to the path before it is judged.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    try:
        placed, path = made(job, chart, cut)
    except InvalidInput as reason:  # a place between the screened ones leaves no strip
        return Laid(witness=Witness(BACK, 0.0, words=str(reason)))
    path, limits = finish(path), while_moving(job.feasibility.limits)
    if limits is not None and not limits.allowed(path.axis).all():
        return Laid(witness=Witness(LIMITS, ROUNDING, words="the axis leaves its limits on the passes, where they run "
                                                            "out"))
    witness = beyond(job, path)
    if witness is not None:
        return Laid(witness=witness)
    proof = prove_moving(path, cut.tool, job.groups, job.worth.allowance, progress=job.progress)
    return Laid(placed, path, proof.witness, proof)


def made(job: Task, chart: LeadChart, cut: LeadCut) -> tuple[Layout, ToolPath]:
    """Passes with their links.

    Parameters
    ----------
    job : Task
    chart : LeadChart
    cut : LeadCut

    Raises
    ------
    InvalidInput
        When the axis leaves no strip somewhere, or a retract along it leads nowhere.
    """
    placed = lay_out(chart, cut, progress=job.progress)
    piece, along = follow(chart, cut, placed.pieces, job.chord)
    steps = placed.pieces[piece, 2]
    contact, tip, normal = tip_points(chart, cut, along, steps)
    deeper = rises(chart, cut, steps, piece, along)[:, None] * normal
    rows = contact, tip - deeper, normal, cut.axes(chart.face, chart.uv(along, steps))
    strokes = [MovingStroke(*(each[piece == k] for each in rows)) for k in range(len(placed.pieces))]
    return placed, joined(_ordered(strokes, placed, job.direction), _links(job, cut))


def _links(job: Task, cut: LeadCut) -> Swivelling:
    face = job.worth.face
    walls = any(group.role == OTHER or (group.role == SKIN and any(one is not face for one in group.faces))
                for group in job.groups)
    over = height_over(job.worth.scallop)
    crossing = MovingCrossing(cut.tool, job.groups, cut.allowance, over)
    linking = Linking(job.top(cut.axis), run_in=0.0 if walls else 1.0, approach=over + OVER)
    return Swivelling(linking, cut.axis, cut.tool, crossing.clear)


def _ordered(strokes: list[MovingStroke], placed: Layout, direction: str) -> list[list[MovingStroke]]:
    """Strokes of each pass in the order and sense in which they are cut."""
    climb = climbing(placed.chart, placed.cut)
    passes: list[list[MovingStroke]] = []
    for i in np.unique(placed.owner):
        members = [strokes[j] for j in np.flatnonzero(placed.owner == i)]
        sense = (-1) ** len(passes) if direction == "zigzag" else climb if direction == "climb" else -climb
        passes.append(members if sense > 0 else [_back(one) for one in reversed(members)])
    return passes


def _back(one: MovingStroke) -> MovingStroke:
    return MovingStroke(one.contact[::-1], one.tip[::-1], one.normal[::-1], one.axis[::-1])


def beyond(job: Task, path: ToolPath) -> Witness | None:
    """Why the task's machine cannot follow a path with one solution, without jumps, inside its travel, and with its
    bodies clear of each other, of part and tool.

    Parameters
    ----------
    job : Task
    path : ToolPath

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    mounting = mounting_of(job.feasibility.limits)
    if mounting is None:
        return None
    try:
        along = following(mounting.machine, path, mounting.table_from_part, float(mounting.tool_length or 0.0),
                          travel=mounting.judges_travel)
    except InvalidInput as reason:
        return Witness(LIMITS, ROUNDING, words=str(reason))
    if not mounting.judges_bodies:
        return None
    around = Surroundings(job.feasibility.tool, tuple(group.cells for group in job.groups),
                          job.feasibility.tolerance.holder_clearance)
    found = met(mounting, along, around, job.progress)
    return None if found is None else Witness(LIMITS, ROUNDING, distance=found[0].distance,
                                              words=words(mounting, found[1], found[0], around.required))


def met(mounting: Mounting, along: Following, around: Surroundings,
        progress: Progress = NO_PROGRESS) -> tuple[Meeting, Array] | None:
    """Where anything of a machine comes too near to anything else while it follows a path; see `meeting_in_motion`.

    Parameters
    ----------
    mounting : Mounting
    along : Following
    around : Surroundings
    progress : Progress
    """
    way = motions(along.tips, along.axes, along.rotary, along.linear, along.arrival)
    return meeting_in_motion(mounting, way, around, progress)
