"""Passes with a moving axis laid over a face, joined, followed by the machine, and proven."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.collision.machine_collision import CollisionPoint, MachineSurroundings, words
from toolaxis.contact.contact_from_cl import contacts_of
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER, SKIN
from toolaxis.feasibility.violations import BACK, LIMITS, WANDERS, Violation
from toolaxis.feed.continuous_ik import AxisTrajectory, following
from toolaxis.machine.limits import ROUNDING
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.path.chord_tolerance import follow, rises
from toolaxis.path.cl_points import order_moves
from toolaxis.path.links import LeadArcs, Linking
from toolaxis.path.moving_axis import MovingChart, MovingCut
from toolaxis.path.parametrization import tip_points
from toolaxis.path.pass_layout import Layout, lay_out
from toolaxis.plan.orientation import Orientation
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.link_heights import OVER, height_over
from toolaxis.search.machine_limits import body_clearance, mounting_of, while_moving
from toolaxis.search.path_check import PathCheck
from toolaxis.strategies.common.links import LinkMotion, MovingCuttingMove, MovingLinks, join_moves
from toolaxis.strategies.common.machine_collision import meeting_in_motion, motions
from toolaxis.strategies.common.path_check import MovingLinkClearance, prove_moving

Array = NDArray[np.float64]

CHECKED = ("the cutter on the machined skin is checked at points of the path, 0.5 mm and 0.5 deg apart at most; all "
           "other distances are proven along it")


@dataclass(frozen=True, eq=False)
class MovingAxisResult:
    """Passes that were laid, or why they may not be used.

    Attributes
    ----------
    placed : Layout or None
    path : ToolPath or None
    witness : Violation or None
        What speaks against them.
    proof : PathCheck or None
    """

    placed: Layout | None = None
    path: ToolPath | None = None
    witness: Violation | None = None
    proof: PathCheck | None = None

    def orientation(self, job: FaceProblem, cut: MovingCut[Any], words: tuple[str, ...], tried: int,
                    lead: float) -> Orientation:
        """What passes without a witness come to.

        Parameters
        ----------
        job : FaceProblem
        cut : MovingCut
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


def plan_passes(job: FaceProblem, chart: MovingChart, cut: MovingCut[Any],
                finish: Callable[[ToolPath], ToolPath] = lambda path: path) -> MovingAxisResult:
    """Passes of a cut with a moving axis, made and judged.

    Parameters
    ----------
    job : FaceProblem
    chart : MovingChart
    cut : MovingCut
    finish : callable
        What is done to the path before it is judged.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    try:
        placed, path = make_passes(job, chart, cut)
    except InvalidInput as reason:  # a place between the screened ones leaves no strip
        return MovingAxisResult(witness=Violation(BACK, 0.0, words=str(reason)))
    path, limits = finish(path), while_moving(job.feasibility.limits)
    if limits is not None and not limits.allowed(path.axis).all():
        return MovingAxisResult(witness=Violation(LIMITS, ROUNDING,
                                                  words="the axis leaves its limits on the passes, where they run "
                                                            "out"))
    witness = beyond(job, path)
    if witness is not None:
        return MovingAxisResult(witness=witness)
    upright = _leans_too_little(job, cut, path)
    if upright is not None:
        return MovingAxisResult(witness=upright)
    proof = prove_moving(path, cut.tool, job.groups, job.worth.allowance, progress=job.progress)
    return MovingAxisResult(placed, path, proof.witness, proof)


def _leans_too_little(job: FaceProblem, cut: MovingCut[Any], path: ToolPath) -> Violation | None:
    """Where a ball end leans less from the normal at its contact than is asked for, at the points of the path and in
    the middle between them."""
    least = job.feasibility.least_angle
    if cut.tool.flat_radius > 0 or least == 0:
        return None
    after = np.flatnonzero(path.kind == Motion.CUT)
    middle = (path.cl[after - 1] + path.cl[after]) / 2, path.axis[after - 1] + path.axis[after]
    tips = np.concatenate([path.cl[after - 1], middle[0], path.cl[after]])
    axes = np.asarray(unit(np.concatenate([path.axis[after - 1], middle[1], path.axis[after]])))
    face = job.worth.face
    uv = contacts_of(face, cut.tool, tips, axes, cut.allowance).uv
    lean = angle_between(axes, face.normal(uv))
    i = int(np.argmin(lean))
    if lean[i] >= least:
        return None
    return Violation(WANDERS, float(least - lean[i]), point=face.evaluate(uv[i][None]).point[0], uv=uv[i])


def make_passes(job: FaceProblem, chart: MovingChart, cut: MovingCut[Any]) -> tuple[Layout, ToolPath]:
    """Passes with their links.

    Parameters
    ----------
    job : FaceProblem
    chart : MovingChart
    cut : MovingCut

    Raises
    ------
    InvalidInput
        When the axis leaves no strip somewhere, or a retract along it leads nowhere.
    """
    placed = lay_out(chart, cut, progress=job.progress)
    piece, along = follow(chart, cut, placed.pieces, job.chord)
    steps = placed.pieces[piece, 2]
    contact, tip, normal = tip_points(chart, cut, along, steps)
    deeper = rises(chart, cut, steps, (piece, along), tip)[:, None] * normal
    rows = contact, tip - deeper, normal, cut.axes(chart.face, chart.uv(along, steps))
    strokes = [MovingCuttingMove(*(each[piece == k] for each in rows)) for k in range(len(placed.pieces))]
    return placed, join_moves(order_moves(strokes, placed, job.direction), _links(job, cut))


def _links(job: FaceProblem, cut: MovingCut[Any]) -> MovingLinks:
    own = job.worth.face.own_faces
    walls = any(group.role == OTHER or (group.role == SKIN and any(one not in own for one in group.faces))
                for group in job.groups)
    over = height_over(job.worth.scallop)
    crossing = MovingLinkClearance(cut.tool, job.groups, cut.allowance, over)
    lead = None if job.lead == 0 else LeadArcs(
        job.lead, job.chord, lambda start, end, axes: crossing.clear(start, end, axes, axes, LinkMotion.AT_FEED))
    linking = Linking(job.top(cut.axis), run_in=0.0 if walls else 1.0, approach=over + OVER,
                      rise=crossing.rise, lead=lead)
    return MovingLinks(linking, cut.axis, cut.tool, crossing.clear)


def beyond(job: FaceProblem, path: ToolPath) -> Violation | None:
    """Why the task's machine cannot follow a path with one solution, without jumps, inside its travel, and with its
    bodies clear of each other, of part and tool.

    Parameters
    ----------
    job : FaceProblem
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
        return Violation(LIMITS, ROUNDING, words=str(reason))
    if not mounting.judges_bodies:
        return None
    around = MachineSurroundings(job.feasibility.tool, tuple(group.cells for group in job.groups),
                                 body_clearance(job.feasibility, job.groups))
    found = machine_violation(mounting, along, around, job.progress)
    return None if found is None else Violation(LIMITS, ROUNDING, distance=found[0].distance,
                                                words=words(mounting, found[1], found[0], around.required))


def machine_violation(mounting: Mounting, along: AxisTrajectory, around: MachineSurroundings,
                      progress: Progress = NO_PROGRESS) -> tuple[CollisionPoint, Array] | None:
    """Where anything of a machine comes too near to anything else while it follows a path; see `meeting_in_motion`.

    Parameters
    ----------
    mounting : Mounting
    along : AxisTrajectory
    around : MachineSurroundings
    progress : Progress
    """
    way = motions(along.tips, along.axes, along.rotary, along.linear, along.arrival)
    return meeting_in_motion(mounting, way, around, progress)
