"""Simultaneous five-axis milling with the best constant lead and no tilt (Sturz milling): what fixed axes compete with.

Leads in both senses along both parameters are screened at contacts all over the face; the shortest passes that keep
all distances are taken.  Everything is proven along the path but the cutter on the machined skin, which is checked at
points.
"""

from dataclasses import dataclass
from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.contact.frame import axis_from_lead_tilt, contact_frame
from toolaxis.contact.placement import place
from toolaxis.feasibility.check_points import around
from toolaxis.feasibility.violations import Violation
from toolaxis.path.greatest_step_over import limit_half_widths
from toolaxis.path.moving_axis import ConstantLeadField, MovingChart, MovingCut
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.machine_limits import while_moving
from toolaxis.search.messages import sentence
from toolaxis.strategies.common.passes import CHECKED, plan_passes

Array = NDArray[np.float64]

#: Leads that are tried in both senses, degrees.
LEADS = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 14.0, 17.0, 20.0, 25.0, 30.0, 36.0, 45.0)
#: How often the gap between the last forbidden and the first free lead is halved.
_HALVED = 4
#: Contacts along u and v, and on the border, at which leads are screened; places along and across the passes at which
#: their length is estimated.
_GRID, _BORDER, _ALONG, _ACROSS = 28, 120, 13, 9
#: Contacts of the border are looked at this much farther out too, where passes run out.
_BEYOND = 1.04
#: How many of the best leads are tried, and how often the gap to the last one that was refused is halved.
_TRIED, _CLOSER = 8, 2


@dataclass(frozen=True)
class _Lead:
    """A lead in rad, the parameter it is towards, and the estimated passes and length."""

    lead: float
    feed: str
    passes: float
    length: float


class ConstantLeadSearch:
    """The search for the lead of one face.

    Parameters
    ----------
    job : FaceProblem
    """

    def __init__(self, job: FaceProblem) -> None:
        self.job = job
        self.face, self.tool = job.worth.face, job.worth.tool
        border = around(self.face, _BORDER)
        middle = (border.min(axis=0) + border.max(axis=0)) / 2
        self.uv = np.concatenate([self.face.grid(_GRID, _GRID), border, middle + _BEYOND * (border - middle)])
        self.tried = 0

    def cut(self, lead: float, feed: str) -> MovingCut[ConstantLeadField]:
        """What cuts with a lead, its axis the mean one.

        Parameters
        ----------
        lead : float
            rad
        feed : str
        """
        worth = self.job.worth
        mean = self._axes(lead, feed).sum(axis=0)
        return MovingCut(worth.tool, mean, worth.scallop, worth.allowance, worth.greatest_step_over,
                         field=ConstantLeadField(lead, feed))

    def _axes(self, lead: float, feed: str) -> Array:
        return axis_from_lead_tilt(contact_frame(self.face, self.uv, feed), lead, 0.0)

    def free(self, lead: float, feed: str) -> bool:
        """Whether the tool keeps all distances at the screened contacts, and the machine takes its axes there.

        Parameters
        ----------
        lead : float
            rad
        feed : str
        """
        self.job.progress.check()
        self.tried += 1
        axes, limits = self._axes(lead, feed), while_moving(self.job.feasibility.limits)
        if limits is not None and not limits.allowed(axes).all():
            return False
        moves = motions(place(self.face, self.tool, self.uv, axes, self.job.worth.allowance), axes)
        return all((keeps_limits(group.cells, self.tool, moves, np.tile(group.required, (len(group.faces), 1))).blocked
                    < 0).all() for group in self.job.feasibility.groups)

    def candidates(self) -> list[_Lead]:
        """Free leads, those with the shortest passes, or the fewest, first."""
        found = []
        least = degrees(self.job.feasibility.least_angle_in_motion)
        leads = sorted({max(lead, least) for lead in LEADS})
        for number, (feed, sense) in enumerate((feed, sense) for feed in FEEDS for sense in (1.0, -1.0)):
            self.job.progress.report("leads", number, 4)
            blocked = None
            for size in leads:
                lead = sense * np.radians(size)
                if not self.free(lead, feed):
                    blocked = lead
                    continue
                if blocked is not None:
                    found += self._between(blocked, lead, feed)
                    blocked = None
                found.append(self.estimated(lead, feed))
        by_passes = self.job.worth.objective == "passes"
        return sorted(found, key=lambda one: one.passes if by_passes else one.length)

    def _between(self, blocked: float, free: float, feed: str) -> list[_Lead]:
        """Free leads that get closer to a blocked one."""
        rows = []
        for _ in range(_HALVED):
            middle = (blocked + free) / 2
            if self.free(middle, feed):
                free = middle
                rows.append(self.estimated(middle, feed))
            else:
                blocked = middle
        return rows

    def estimated(self, lead: float, feed: str) -> _Lead:
        """Passes and cutting length by the narrowest strips on some lines, infinite where there is none.

        Parameters
        ----------
        lead : float
            rad
        feed : str
        """
        chart = MovingChart(self.face, feed)
        cut = self.cut(lead, feed)
        a0, a1, s0, s1 = chart.bounds
        along = a0 + (a1 - a0) * np.linspace(0, 1, _ALONG)
        step = s0 + (s1 - s0) * (np.arange(_ACROSS) + 0.5) / _ACROSS
        every_step, every_along = (part.ravel() for part in np.meshgrid(step, along, indexing="ij"))
        halves = limit_half_widths(chart, cut, every_along, every_step)
        widths = halves.sum(axis=1).reshape(_ACROSS, _ALONG)
        uv = chart.uv(every_along, every_step)
        points = self.face.evaluate(uv).point.reshape(_ACROSS, _ALONG, 3)
        lengths = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
        if not (widths > 0).all():
            return _Lead(lead, feed, np.inf, np.inf)
        passes = (s1 - s0) / _ACROSS / widths.min(axis=1)
        return _Lead(lead, feed, float(passes.sum()), float((passes * lengths).sum()))


def sturz(job: FaceProblem) -> tuple[Orientation, ToolPath | None]:
    """The constant lead that machines a face in the shortest passes, or the fewest, and those passes.

    Parameters
    ----------
    job : FaceProblem

    Returns
    -------
    Orientation
        With the lead, and the mean axis in the place of the fixed one; without an axis where no lead is free, with the
        reasons.
    ToolPath or None

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: the five-axis row of [zhu2016] Table 4, whose lead the paper does not print; here the best constant one.

    **Properties**: 1. links, entries and exits are proven as for fixed axes, everything that keeps a distance by bounds
    along the motion; 2. the cutter on the skin is checked at points.
    """
    search = ConstantLeadSearch(job)
    refused: list[str] = []
    blocked: dict[tuple[str, bool], float] = {}
    for one in search.candidates()[:_TRIED]:
        if not np.isfinite(one.length):
            continue
        found, path, witness = _try_lead(search, search.cut(one.lead, one.feed))
        if witness is None:
            return _closer(search, (found, path), blocked.get((one.feed, one.lead > 0)))
        blocked[one.feed, one.lead > 0] = one.lead
        refused.append(f"refused lead {degrees(one.lead):.2f} deg along {one.feed}: "
                       f"{sentence(witness, job.feasibility)}")
    words = refused or [f"no axis found: no constant lead up to {LEADS[-1]:g} deg along u or v keeps all distances and "
                        "the limits of the axis all over the face"]
    return Orientation(None, outcome="not_found", reasons=tuple(words), evaluations=search.tried), None


def _closer(search: ConstantLeadSearch, best: tuple[Orientation, ToolPath | None],
            blocked: float | None) -> tuple[Orientation, ToolPath | None]:
    """What leads between an accepted and a refused one come to, where they are better."""
    by_passes = search.job.worth.objective == "passes"
    for _ in range(_CLOSER if blocked is not None else 0):
        assert blocked is not None and best[0].lead is not None
        middle = (blocked + best[0].lead) / 2
        found, path, witness = _try_lead(search, search.cut(middle, best[0].feed))
        shorter = found.passes < best[0].passes if by_passes else found.length < best[0].length
        if witness is None and shorter:
            best = found, path
        else:
            blocked = middle
    return best


def _try_lead(search: ConstantLeadSearch,
              cut: MovingCut[ConstantLeadField]) -> tuple[Orientation, ToolPath | None, Violation | None]:
    """What one lead comes to: its passes made and judged."""
    chart = MovingChart(search.face, cut.feed)
    found = plan_passes(search.job, chart, cut)
    if found.witness is not None:
        return Orientation(None, cut.feed), found.path, found.witness
    words = (f"lead {degrees(cut.field.lead):.2f} deg towards {cut.feed}", CHECKED)
    return found.orientation(search.job, cut, words, search.tried, cut.field.lead), found.path, None
