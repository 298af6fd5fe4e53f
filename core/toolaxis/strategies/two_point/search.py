"""Passes of a flat end or torus with two-point contact over a face, placed, linked and proven.

Feeds along both parameters and the ways to lean along a pass are compared on a few passes; the one with the fewest, or
the shortest, is laid over the face.  Every motion is proven, the cutter on the machined skin between points too.
"""

from dataclasses import dataclass, replace
from math import radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import SMALLER_CUTTER
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER, SKIN
from toolaxis.feasibility.violations import GOUGE, LIMITS, Violation
from toolaxis.machine.limits import ROUNDING
from toolaxis.numeric.vectors import unit
from toolaxis.path.links import Linking
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.link_heights import OVER, height_over
from toolaxis.search.machine_limits import while_moving
from toolaxis.search.messages import sentence
from toolaxis.strategies.common.links import MovingLinks, join_moves
from toolaxis.strategies.common.passes import beyond
from toolaxis.strategies.common.path_check import MovingLinkClearance, prove_moving
from toolaxis.strategies.two_point.gouge_check import turning_gouges
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.path import strokes
from toolaxis.strategies.two_point.postures import REASONS, TIGHT, TWO
from toolaxis.strategies.two_point.strips import PassPostures, Strip, lay_strips, left_out, places, strip

Array = NDArray[np.float64]

#: Ways to lean that are tried, steps at which they are compared, and how many of the best are laid over the face.
TRIED, PROBES, LAID = ("ahead", "back", "inward"), (0.2, 0.5, 0.8), 3
#: A feed whose passes with one contact are so many times longer is not looked at.
WORSE = 2.0
#: What passes cost more that lean two ways, for they are cut in two strokes.
SPLIT = 1.03
PROVEN = "every motion is proven by bounds, the cutter on the machined skin between the points of the path too"


@dataclass(frozen=True)
class FeedAndLean:
    """A feed and a way to lean, with the passes and the cutting length they are reckoned to take."""

    work: TwoPointInputs
    leaning: str
    passes: float
    length: float


def two_point(job: FaceProblem, posture: str = "two-point",
              lead: float = radians(20.0)) -> tuple[Orientation, ToolPath | None]:
    """Passes with two-point contact, or with another posture of a flat bottom, over a face.

    Parameters
    ----------
    job : FaceProblem
    posture : str
        One of `toolaxis.strategies.two_point.inputs.POSTURES`.
    lead : float
        Of the posture "sturz", rad.

    Returns
    -------
    Orientation
        With the mean axis and the mean lean; without an axis where no passes keep all limits, with the reasons.
    ToolPath or None

    Raises
    ------
    InvalidInput
        When the cutter has no flat bottom.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [jang2021], with postures that gouge nowhere in place of the formula's.
    """
    refused: list[str] = []
    for choice in choices(job, posture, lead)[:LAID]:
        name = f"feed along {choice.work.feed}, leaning {choice.leaning}"
        try:
            strips = lay_strips(choice.work, choice.leaning, job.progress)
            path = add_links(job, choice.work, strips)
        except InvalidInput as reason:
            refused.append(f"refused {name}: {reason}")
            continue
        found, witness = _judge_path(job, choice, strips, path)
        if witness is None:
            return replace(found, reasons=(*found.reasons, *refused)), path
        refused.append(f"refused {name}: {sentence(witness, job.feasibility)}")
    words = tuple(refused) or ("no passes found: the cutter comes within the tolerance nowhere along some passes",)
    return Orientation(None, outcome="not_found", reasons=words), None


def choices(job: FaceProblem, posture: str, lead: float = radians(20.0)) -> list[FeedAndLean]:
    """Feeds and ways to lean, the one with the fewest or the shortest passes first.

    Parameters
    ----------
    job : FaceProblem
    posture : str
    lead : float
    """
    worth, limits = job.worth, replace(job.feasibility.tolerance, chord=job.chord)
    works = [TwoPointInputs(worth.face, worth.tool, worth.scallop, feed, posture, lead, worth.allowance, limits)
             for feed in FEEDS]
    plain = [min(_estimate_choice(replace(work, posture="one-point"), leaning).length for leaning in TRIED[:2])
             for work in works]
    works = [work for work, length in zip(works, plain, strict=True) if length <= WORSE * min(plain)]
    found = []
    for k, work in enumerate(works):
        for i, leaning in enumerate(TRIED):
            job.progress.report("ways to lean", len(TRIED) * k + i, len(TRIED) * len(works))
            found.append(_estimate_choice(work, leaning))
    by_passes = job.worth.objective == "passes"

    def _cost(one: FeedAndLean) -> float:
        return (one.passes if by_passes else one.length) * (1.0 if one.leaning in TRIED[:2] else SPLIT)

    return sorted((one for one in found if np.isfinite(one.passes)), key=_cost)


def _estimate_choice(work: TwoPointInputs, leaning: str) -> FeedAndLean:
    """A choice with what a few passes tell of it."""
    *_, s0, s1 = work.span
    narrow, length = [], []
    for share in PROBES:
        one = strip(work, s0 + share * (s1 - s0), leaning)
        on = ~left_out(one)
        narrow.append(one.halves.sum(axis=1)[on].min() if on.any() else 0.0)
        point = work.face.evaluate(work.uv(places(work), one.step)).point
        length.append(float(np.linalg.norm(np.diff(point, axis=0), axis=1).sum()))
    if min(narrow) <= 0:
        return FeedAndLean(work, leaning, np.inf, np.inf)
    passes = float((s1 - s0) * np.mean(1 / np.array(narrow)))
    return FeedAndLean(work, leaning, passes, passes * float(np.mean(length)))


def add_links(job: FaceProblem, work: TwoPointInputs, strips: tuple[Strip, ...]) -> ToolPath:
    """Passes with their entries, exits and links.

    Parameters
    ----------
    job : FaceProblem
    work : TwoPointInputs
    strips : tuple of Strip

    Raises
    ------
    InvalidInput
        When no pass is left, or an axis at an end of one lies so low that no retract leads up.
    """
    passes = strokes(work, strips, job.direction, job.progress)
    if not passes:
        raise InvalidInput(f"no pass holds any of the face: take {SMALLER_CUTTER}, or another feed")
    up = np.asarray(unit(np.concatenate([one.axis for some in passes for one in some]).mean(axis=0)))
    walls = any(group.role == OTHER or (group.role == SKIN and any(face is not work.face for face in group.faces))
                for group in job.groups)
    over = height_over(work.scallop)
    crossing = MovingLinkClearance(work.tool, job.groups, work.allowance, over)
    linking = Linking(job.top(up), run_in=0.0 if walls else 1.0, approach=over + OVER,
                      rise=crossing.rise)
    return join_moves(passes, MovingLinks(linking, up, work.tool, crossing.clear))


def gouging(job: FaceProblem, path: ToolPath) -> NDArray[np.intp]:
    """Cutting motions that are not proven to stay within the gouge limit of the skin, by the point they arrive at.

    Parameters
    ----------
    job : FaceProblem
    path : ToolPath
    """
    skin = next(group for group in job.groups if group.role == SKIN)
    found = []
    arrives = np.flatnonzero(path.kind == Motion.CUT)
    for run in np.split(arrives, np.flatnonzero(np.diff(arrives) > 1) + 1):
        job.progress.check()
        if not len(run):
            continue
        rows = np.concatenate([[run[0] - 1], run])
        limit = job.feasibility.tolerance.gouge
        bad = turning_gouges(job.worth.tool, path.cl[rows], path.axis[rows], skin.cells, limit,
                             allowance=job.worth.allowance)
        found.append(run[bad])
    return np.concatenate(found) if found else np.empty(0, dtype=np.intp)


def _judge_path(job: FaceProblem, choice: FeedAndLean, strips: tuple[Strip, ...],
                path: ToolPath) -> tuple[Orientation, Violation | None]:
    """What a path comes to, and why it may not be used."""
    work, limits = choice.work, while_moving(job.feasibility.limits)
    if limits is not None and not limits.allowed(path.axis).all():
        return Orientation(None), Violation(LIMITS, ROUNDING, words="the axis leaves its limits on the passes")
    stopped = beyond(job, path)
    if stopped is not None:
        return Orientation(None), stopped
    proof = prove_moving(path, work.tool, job.groups, work.allowance, progress=job.progress)
    if proof.witness is not None:
        return Orientation(None), proof.witness
    bad = gouging(job, path)
    if len(bad):
        return Orientation(None), Violation(GOUGE, 0.0, work.face.label, path.cc[bad[0]])
    length = path.length(Motion.CUT)
    lean = float(np.mean([lane.postures.stand.lean.mean() for one in strips for lane in one.lanes]))
    missed = float(np.mean([left_out(one).mean() for one in strips]))
    words = [f"feed along {work.feed}, leaning {choice.leaning}", *describe_contacts(work, strips), PROVEN]
    return Orientation(np.asarray(unit(path.axis.mean(axis=0))), work.feed, path.passes, float(path.passes), length,
                       work.face.area / length, proof.gouge, proof.clearance, "feasible", tuple(words), lead=lean,
                       unreached=missed), None


def describe_contacts(work: TwoPointInputs, strips: tuple[Strip, ...]) -> tuple[str, ...]:
    """Sentences on how many contacts the cutter has along the passes, and why not two.

    Parameters
    ----------
    work : TwoPointInputs
    strips : tuple of Strip
    """
    rows = np.concatenate([_reasons(work, lane, where) for one in strips for lane, where in one.shares])
    count = np.bincount(rows, minlength=len(REASONS))
    words = [f"{REASONS[code]} on {100 * count[code] / len(rows):.1f} % of the passes" for code in range(len(REASONS))
             if count[code] and (code != TWO or work.posture == "two-point")]
    if count[TIGHT]:
        words.append(f"material higher than the tolerance stays there for {SMALLER_CUTTER}")
    return tuple(words)


def _reasons(work: TwoPointInputs, lane: PassPostures, where: slice) -> NDArray[np.int8]:
    """Codes at the places on which a lane works."""
    own = places(work)[where]
    nearest = np.abs(lane.along[:, None] - own).argmin(axis=0)
    return np.asarray(lane.postures.reason[nearest])
