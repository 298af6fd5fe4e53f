"""One axis put to the proof: its passes made, completed and proven, and laid closer where too much would stay high."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.queries import keeps_limits
from toolaxis.contact.placement import tips
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feasibility.violations import BACK, CUTTER, Violation
from toolaxis.path.leaving_out import leave_out
from toolaxis.path.mending import FurtherPasses
from toolaxis.path.pass_layout import Layout
from toolaxis.path.pass_pattern import pattern_name
from toolaxis.path.rest_material import FACTOR, OVERLOOKED, Excess, may_stay
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.zone import Zone
from toolaxis.search.face_problem import CROSSING, FaceProblem
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.machine_limits import machine_violation
from toolaxis.search.messages import STAYS_BETWEEN, left_reasons, nothing_to_cut, stays_high
from toolaxis.search.path_check import PathCheck, ProvenMotions, prove, worst_motion
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: How often motions that the proof refuses are left out of passes before their axis is refused.
_LEFT_OUT = 3
#: Share of a face up to which places that no further pass cuts go to the clean-up tool that has to come anyway.
_MAY_LEAVE = 0.01
#: Places on a face that tell how much stays high between passes, and the first of them, which do where none of these is
#: too high: of what may stay too high they would hold four, of what the judge refuses eight.
_SAMPLES, _FIRST = 40_000, 8_000
#: Of how many places of its range they are taken at most, and how many of these at once.
_MOST_SCATTERED, _AT_ONCE = 3_000_000, 60_000
#: Steps of the sequence of these: 1 / p and 1 / p^2, where p^3 = p + 1, leave the least gaps.
_SCATTERED = np.array([0.7548776662466927, 0.5698402909980532])
#: How much higher than the limit is told there, as a share of the scallop height.
_TOLD = 1.0
#: Where that is too much, passes are laid for a little less than the share of the scallop height that brings down what
#: was seen, for less by a step where that did not do, and never for less than the last share.
_CLOSER, _STEP, _CLOSEST = 0.97, 0.93, 0.6
#: Cuts up to so many times the length that takes as long as an index move are laid closer by a greater step at once:
#: a few millimetres more cost less than to lay and prove all passes twice more.
_SHORT, _GREAT_STEP = 3.0, 0.9


class CheckedCandidate(NamedTuple):
    """What became of a candidate.

    one : CountedAxis
    orientation : Orientation
    proof : PathCheck, refused too where passes leave more on which the cutter may stand than may stay
    path : ToolPath or None, the very passes that were proven; None where none can be laid
    longer : float, cutting length over that without further passes
    laid_for : float, share of the scallop height for which passes were laid in the end; 1 where none were proven
    """

    one: CountedAxis
    orientation: Orientation
    proof: PathCheck
    path: ToolPath | None
    longer: float = 1.0
    laid_for: float = 1.0

    @property
    def value(self) -> float:
        """What is to be least, with the further passes."""
        return self.one.value * self.longer


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
    if proof.witness is None:
        closer = _find_closer_share(job, made, made.zones)
        if closer is not None and job.laid_for > _CLOSEST:
            return check_candidate(replace(job, laid_for=max(closer, _CLOSEST)), one)
        if closer is not None:
            proof = PathCheck(Violation(CUTTER, 0.0, words=STAYS_BETWEEN))
    path, area = made.path, job.worth.face.area
    if made.undercut > may_stay(made.zones, area):
        made = _leave_corners(made, area, anywhere=job.worth.index_length > 0)
    if proof.witness is None and made.undercut > may_stay(made.zones, area):
        # Closer passes help where a strip is narrower than it was measured, and not in a hollow: they are tried once.
        closer = _find_closer_share(job, made, [zone for zone in made.zones if zone.at_wall])
        if job.laid_for == 1 and closer is not None and closer > _CLOSEST:
            return check_candidate(replace(job, laid_for=closer), one)
        proof = PathCheck(Violation(CUTTER, 0.0, words=stays_high(made.zones, job.worth.face)))
    unreached = min((made.left - made.undercut) / area, 1.0)
    ideal = job.worth.ideal_length(one.axis) if proof.witness is None else 0.0
    length = path.length(Motion.CUT)
    width = area * (1 - unreached) / length if length > 0 else 0.0
    words = left_reasons(made.zones, job.worth.face)
    found = Orientation(one.axis, feed, path.passes, one.passes, length, width, proof.gouge, proof.clearance,
                        "feasible", words, unreached=unreached, pattern=pattern_name(made.placed.chart),
                        ideal=ideal, zones=made.zones)
    return CheckedCandidate(one, found, proof, path, made.longer, job.laid_for)


def _leave_corners(made: FurtherPasses, area: float, *, anywhere: bool) -> FurtherPasses:
    """The same with small places that no pass cuts left to another tool, where one has to come to walls anyway.

    anywhere : whether other tools follow, so that these places may be anywhere
    """
    if made.undercut > _MAY_LEAVE * area or not (anywhere or any(zone.at_wall for zone in made.zones)):
        return made
    return made._replace(zones=tuple(replace(zone, at_wall=True) for zone in made.zones))


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


def _find_closer_share(job: FaceProblem, made: FurtherPasses, left: Sequence[Zone]) -> float | None:
    """Share of the scallop height for which passes have to be laid so that no more stays high than may, outside of the
    zones that are left.

    None where those that were made do.  That is told from samples, as ridges between passes are thinner than any cell.
    Too much can stay where strips are measured on what stands for a skin, and where a strip is narrower between the
    places at which it was measured.  A ridge is as high as the square of the width of its strip, and so in proportion
    to the height for which that strip was laid.
    """
    worth = job.worth
    places = _scatter_places(worth.face, _SAMPLES)
    zones = [worth.face.trimmed(zone.loops) for zone in left]
    uv = _outside_of(zones, places[:_FIRST])
    limit = FACTOR * worth.scallop
    excess = Excess(worth.face, worth.tool, made.path, worth.allowance + limit)
    above = excess(uv, _TOLD * worth.scallop)
    if not (above > 0).any():
        return None
    further = _outside_of(zones, places[_FIRST:])
    uv = np.concatenate([uv, further])
    above = np.concatenate([above, excess(further, _TOLD * worth.scallop)])
    d = worth.face.evaluate(uv)
    area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    order = np.argsort(-above, kind="stable")
    may = int(np.searchsorted(np.cumsum(area[order]), OVERLOOKED * area.sum(), side="right"))
    highest = float(above[order[may]]) if may < len(order) else 0.0
    if highest <= 0:
        return None
    if made.path.length(Motion.CUT) <= _SHORT * worth.index_length:
        step = _GREAT_STEP
    else:
        step = 1.0 if job.laid_for == 1 else _STEP
    return job.laid_for * min(step, _CLOSER * limit / (limit + highest))


def _outside_of(zones: Sequence[Face], uv: Array) -> Array:
    """Those of some places that lie in none of the zones, (k, 2)."""
    for zone in zones:
        uv = uv[~zone.contains(uv)]
    return uv


@lru_cache(maxsize=2)  # each candidate asks for those of the same face
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
