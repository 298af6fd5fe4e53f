"""Five axes for a strip width and a roughness: passes along either parameter, judged, and what they come to."""

from dataclasses import replace
from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.path.moving_axis import ConstantLeadField, MovingCut
from toolaxis.path.pass_layout import Layout
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.messages import sentence
from toolaxis.strategies.common.passes import CHECKED, plan_passes
from toolaxis.strategies.roughness.passes import evaluation_length, roughness_at, spots
from toolaxis.strategies.roughness.rotary_velocity import PARTS, fastest, turning
from toolaxis.strategies.roughness.search import RoughnessSearch, SmoothPasses
from toolaxis.strategies.roughness.strategy import ROUGHNESS

Array = NDArray[np.float64]


def multiscale(job: FaceProblem, roughness: float = ROUGHNESS,
               feedrate: float = 800.0) -> tuple[Orientation, ToolPath | None]:
    """Passes that keep a roughness across the feed with strips of an expected width, the rotary axes turning least.

    Parameters
    ----------
    job : FaceProblem
        Its scallop height is that at which strip widths are taken, and the greatest that may be left.
    roughness : float
        Greatest Ra, mm.
    feedrate : float
        mm/min

    Returns
    -------
    Orientation
        With the mean axis and the mean lean; without an axis where no passes keep all limits, with the reasons.
    ToolPath or None

    Raises
    ------
    InvalidInput
        When the cutter is no torus, no machine is given, or the roughness is out of range.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [dong2023] Sec. 5.2, with the conditions themselves in the place of fixed orientations, see
    `toolaxis.strategies.roughness.smoothing.smooth_axes`, and passes laid for the roughness.
    """
    search, refused = RoughnessSearch(job, roughness, feedrate), list[str]()
    best: tuple[Orientation, ToolPath | None] | None = None
    for feed in FEEDS:
        try:
            one = search.found(feed)
        except InvalidInput as reason:
            refused.append(f"refused feed along {feed}: {reason}")
            continue
        made, path, why = _judge_passes(search, one)
        if made is None:
            refused.append(f"refused feed along {feed}: {why}")
        elif best is None or _price(job, made) < _price(job, best[0]):
            best = made, path
    if best is None:
        return Orientation(None, outcome="not_found", reasons=tuple(refused), evaluations=search.tried), None
    return replace(best[0], reasons=(*best[0].reasons, *refused)), best[1]


def _price(job: FaceProblem, found: Orientation) -> float:
    return float(found.passes) if job.worth.objective == "passes" else found.length


def _judge_passes(search: RoughnessSearch, one: SmoothPasses) -> tuple[Orientation | None, ToolPath | None, str]:
    """What passes come to, or why they may not be used."""
    job, limit = search.job, search.roughness
    if (one.roughness > limit).any():
        return None, None, (f"Ra {1000 * limit:.3g} um is missed at {int((one.roughness > limit).sum())} of "
                            f"{len(one.uv)} places, {1000 * one.roughness.max():.3g} um at the worst")
    made = plan_passes(job, one.placed.chart, one.cut)  # type: ignore[arg-type]
    if made.witness is not None:
        return None, None, sentence(made.witness, job.feasibility)
    return made.orientation(job, one.cut, words(search, one), search.tried, one.cut.field.lean), made.path, ""


def words(search: RoughnessSearch, one: SmoothPasses) -> tuple[str, ...]:
    """Sentences on what was reached.

    Parameters
    ----------
    search : RoughnessSearch
    one : SmoothPasses
    """
    wide, (low, high) = one.widths, search.wish.widths
    lean = np.concatenate([lane.lane.leans(lane.axes) for lane in one.lanes])
    rates = np.abs(np.concatenate([turning(lane.lane) @ lane.spline.control for lane in one.lanes]))
    points = np.concatenate([np.repeat(search.face.evaluate(lane.lane.uv[1:]).point, PARTS, axis=0)
                             for lane in one.lanes])
    paced = sum(lane.lane.paced for lane in one.lanes)
    bound = (f"the velocity of the rotary axes binds on {paced} of {len(one.lanes)} passes, which keep it",)
    return (f"Ra {1000 * one.roughness.mean():.3f} um in the mean and {1000 * one.roughness.max():.3f} um at most of "
            f"{len(one.uv)} places, {1000 * search.roughness:g} um allowed",
            f"section strip width {wide.min():.3f} to {wide.max():.3f} mm at a height of {search.wish.scallop:g} mm, "
            f"{low:.4f} to {high:.4f} mm expected",
            f"lean {degrees(lean.min()):.2f} to {degrees(lean.max()):.2f} deg; rotary axes turn by "
            f"{degrees(float(rates.max())):.2f} deg/s at most at {60 * search.speed:g} mm/min, their squares "
            f"sum to {one.cost:.4g} (rad/s)^2", *(bound if paced else ()),
            *racing(rates, fastest(search.mounting.machine), search.speed, points), CHECKED)


def racing(rates: Array, most: Array, speed: float, points: Array) -> tuple[str, ...]:
    """A sentence on where rotary axes would pass their velocity, and what the feed comes down to; none where nowhere.

    Parameters
    ----------
    rates : (n, m) array
        Of the rotary axes at the programmed feed, rad/s, not below zero.
    most : (m,) array
        What they can do, rad/s.
    speed : float
        The programmed feed, mm/s.
    points : (n, 3) array
        Where that is, mm.
    """
    share = (rates / most).max(axis=1)
    if not (share > 1).any():
        return ()
    place = np.round(points[int(share.argmax())], 1).tolist()
    return (f"rotary axes would pass their velocity on {100 * float((share > 1).mean()):.1f} % of the passes: the "
            f"control feeds slower there, down to {60 * speed / float(share.max()):.0f} mm/min at {place}; "
            "no way was found that keeps it there at the programmed feed",)


def constant_lead(search: RoughnessSearch, placed: Layout,
                  lead: float) -> tuple[MovingCut[ConstantLeadField], Array, Array]:
    """Sturz milling on the same passes: the cut, its section strip widths, and its Ra at the same places, mm.

    Parameters
    ----------
    search : RoughnessSearch
    placed : Layout
    lead : float
        rad
    """
    feed = placed.chart.feed  # type: ignore[attr-defined]
    cut = MovingCut(search.tool, placed.cut.axis, placed.cut.scallop, search.job.worth.allowance,
                    field=ConstantLeadField(lead, feed))
    length = evaluation_length(search.roughness)
    uv = spots(search.face, feed, length)
    a0, a1, _, _ = placed.chart.bounds
    lanes = [search.lane(piece, feed, (placed.steps, a0, a1)) for piece in placed.pieces]
    wide = np.concatenate([one.widths(cut.axes(search.face, one.uv))[one.inside] for one in lanes])
    return cut, wide, roughness_at(search.face, cut, placed.steps, uv, length)
