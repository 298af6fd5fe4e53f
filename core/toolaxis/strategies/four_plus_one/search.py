"""4+1 axes: one rotary axis of the machine clamped at the best angle, the other turning along the passes.

Either axis may be the clamped one.  All clamped angles are screened, each with the widest strips that turning the free
axis smoothly leaves; the best ones are examined with everything around by exact counts of passes, and so are all
angles near the best of these, half a degree apart.  The few with the least counts are laid over the face, and the
shortest are taken.  The best fixed axis stands beside them, so that no result is longer than that.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, inf

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.kinematics import rotary_angles
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between
from toolaxis.path.moving_axis import MovingCut
from toolaxis.path.pass_count import Count
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.fixed_axis import find_axis
from toolaxis.search.machine_limits import mounting_of
from toolaxis.search.messages import sentence
from toolaxis.strategies.common.passes import CHECKED, MovingAxisResult, plan_passes
from toolaxis.strategies.four_plus_one.clamp_angle import ClampCandidate, ClampSearch
from toolaxis.strategies.four_plus_one.links import on_the_circle
from toolaxis.strategies.four_plus_one.passes import Clamp, ClampedAxis

Array = NDArray[np.float64]

#: Clamped angles are screened so far apart, deg; how many of the best places are examined, and around how many of
#: these, within that factor of the best, nearer ones are.
STEP_DEG, _EXAMINED, _SEARCHED, _HOPEFUL = 3.0, 10, 2, 1.1
#: How many of the best are counted with a moving axis, and how many are laid over the face, the best of which is taken.
_RANKED, _LAID = 8, 2
#: Angles around a place that are examined lie so far apart, deg, so many of them on either side; a side on which the
#: last two hold the best is followed further, up to so many.
FINE_DEG, _SIDE, _FARTHEST = 0.5, 5, 30
#: Angles of the clamped axis are the same within this, rad.
_SAME = 1e-3
#: How passes are tried: the share of the narrowest strip that is given up for smoothness, and by how many angles the
#: free one stays away from those that must not be used.
_TRIES = ((0.98, 0), (0.9, 1), (0.8, 2))
#: Turning that makes passes longer by no more than this factor needs no smoother angles.
_STEADY = 1.01
#: How often angles are chosen without those that turned out to be in the way between the nodes.
_LESSONS = 6


@dataclass(frozen=True, eq=False)
class ClampedPasses:
    """A clamped angle with what its passes come to.

    Attributes
    ----------
    candidate : ClampCandidate
    cut : MovingCut of ClampedAxis
    count : Count
        With exact widths, the axis standing at each place as it does there, or moving.
    tried : int
        Which of the ways to try passes it is.
    """

    candidate: ClampCandidate
    cut: MovingCut[ClampedAxis]
    count: Count
    tried: int

    def value(self, objective: str) -> float:
        """What is to be least.

        Parameters
        ----------
        objective : str
            "length" or "passes".
        """
        return self.count.passes if objective == "passes" else self.count.length


def machine_of(job: FaceProblem) -> Mounting:
    """The machine whose axes are clamped and turned.

    Parameters
    ----------
    job : FaceProblem

    Raises
    ------
    InvalidInput
        When there is none with two driven rotary axes.
    """
    mounting = mounting_of(job.feasibility.limits)
    driven = 0
    if mounting is not None:
        driven = sum(not axis.by_hand for axis in mounting.machine.rotary)
    if mounting is None or driven != 2:
        raise InvalidInput("strategy 'four-plus-one' clamps one of two driven rotary axes and turns the other: name a "
                           "machine that has them")
    return mounting


def clampable_angles(axis: RotaryAxis, step: float) -> Array:
    """Angles at which an axis may be clamped, one turn of an endless one, (n,) rad.

    Parameters
    ----------
    axis : RotaryAxis
    step : float
        About how far apart, rad.
    """
    low = max(axis.low, -np.pi)
    high = min(axis.high, np.pi)
    gaps = max(round((high - low) / step), 1)
    angles = np.linspace(low, high, gaps + 1)
    is_whole_turn = high - low > 2 * np.pi - 1e-9
    return np.asarray(angles[:-1] if is_whole_turn else angles)


def screen_angles(search: ClampSearch, step: float = np.radians(STEP_DEG)) -> list[ClampCandidate]:
    """The best clamped angles by screening: those with wider strips than both neighbours, best first.

    Parameters
    ----------
    search : ClampSearch
    step : float
        Between clamped angles, rad.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.4.3 turns the plane XOZ about B, the clamped axis, in the range that Eq. (17) allows;
    here the range is that of the machine, and angles that some normal forbids have no strip.
    """
    found: list[ClampCandidate] = []
    objective = search.job.worth.objective
    for which, axis in enumerate(search.mounting.machine.rotary):
        angles = clampable_angles(axis, step)
        for feed in FEEDS:
            search.job.progress.report("clamped angles", 2 * which + FEEDS.index(feed), 4)
            search.job.progress.check()
            rows = [search.reckoned(search.clamp(which, float(angle)), feed) for angle in angles]
            value = np.array([inf if one is None else one.value(objective) for one in rows])
            before = np.append(inf, value[:-1])
            behind = np.append(value[1:], inf)
            least = value <= np.minimum(behind, before)
            found += [one for one, best in zip(rows, least, strict=True) if one is not None and best]
    found.sort(key=lambda one: (round(one.value(objective), 6), abs(one.clamp.angle)))
    kept: list[ClampCandidate] = []
    for one in found:  # the same axes by the other solution of the machine are no other candidate
        if not any(_has_same_axes(one, other) for other in kept):
            kept.append(one)
    return kept


def _has_same_axes(one: ClampCandidate, other: ClampCandidate) -> bool:
    """Whether two candidates are one, by both solutions of the machine."""
    is_like = one.feed == other.feed and one.clamp.which == other.clamp.which
    return is_like and abs(one.length - other.length) <= 1e-9 * one.length


class FourPlusOneSearch:
    """The search for the best clamped angle of one face.

    Parameters
    ----------
    search : ClampSearch
    """

    def __init__(self, search: ClampSearch) -> None:
        self.search = search
        self.known: dict[tuple[int, str, float], ClampedPasses | None] = {}

    def choice(self, clamp: Clamp, feed: str) -> ClampedPasses | None:
        """What a clamped angle comes to; None where it machines not all of the face.

        Parameters
        ----------
        clamp : Clamp
        feed : str
        """
        key = clamp.which, feed, round(clamp.angle, 9)
        if key not in self.known:
            one = self.search.standing(clamp, feed)
            self.known[key] = None if one is None else self.smooth(one)
        return self.known[key]

    def smooth(self, one: ClampCandidate) -> ClampedPasses | None:
        """A candidate with smooth angles that keep all distances between the nodes too, and its passes counted; None
        where there are none.

        Parameters
        ----------
        one : ClampCandidate
        """
        now = one
        for _ in range(_LESSONS):
            bad = np.zeros(0, dtype=np.intp)
            for number, (share, inset) in enumerate(_TRIES):
                cut, found = self.search.cut(now, share, inset)
                if cut is not None:
                    passes = self.search.counted(cut)
                    if not np.isfinite(passes.length):
                        return None
                    return ClampedPasses(now, cut, passes, number)
                if not len(bad):
                    bad = found
            after = self.search.barred(now, bad)
            if after is None:
                return None
            now = after
        return None

    def around(self, start: ClampedPasses) -> ClampedPasses:
        """The best clamped angle near one.

        Parameters
        ----------
        start : ClampedPasses
        """
        objective = self.search.job.worth.objective
        middle = start.candidate.clamp
        feed = start.candidate.feed
        best = start
        for sense in (1.0, -1.0):
            k = 0
            last = 0
            while (k - last < 2 and k < _FARTHEST) or k < _SIDE:
                k += 1
                angle = middle.angle + sense * k * np.radians(FINE_DEG)
                near = self.search.clamp(middle.which, angle)
                other = self.choice(near, feed)
                if other is not None and other.value(objective) < best.value(objective):
                    best = other
                    last = k
        return best

    def moving(self, one: ClampedPasses) -> ClampedPasses:
        """The same counted with a moving axis, by the way to try passes that makes the least of it.

        Parameters
        ----------
        one : ClampedPasses
        """
        objective = self.search.job.worth.objective
        found: list[ClampedPasses] = []
        for number in range(one.tried, min(one.tried + 2, len(_TRIES))):
            cut: MovingCut[ClampedAxis] | None = one.cut
            if number != one.tried:
                share, inset = _TRIES[number]
                cut, _ = self.search.cut(one.candidate, share, inset)
            if cut is not None:
                passes = self.search.counted(cut, False)
                found.append(ClampedPasses(one.candidate, cut, passes, number))
            if found and found[0].value(objective) <= _STEADY * one.value(objective):
                break
        return min(found, key=lambda choice: choice.value(objective))

    def found(self, fixed: Orientation) -> list[ClampedPasses]:
        """The best clamped angles, best first, those at which the best fixed axis stands among them.

        Parameters
        ----------
        fixed : Orientation
        """
        objective = self.search.job.worth.objective

        def value(one: ClampedPasses) -> float:
            return one.value(objective)

        starts = [(one.clamp, one.feed) for one in screen_angles(self.search)[:_EXAMINED]]
        if fixed.axis is not None:
            rows = self.search.mounting.solutions(fixed.axis)[:1]
            starts += [(self.search.clamp(which, float(row[which])), fixed.feed) for row in rows for which in (0, 1)]
        examined = []
        for k, (clamp, feed) in enumerate(starts):
            self.search.job.progress.report("clamped angles examined", k, len(starts))
            examined.append(self.choice(clamp, feed))
        best = sorted((one for one in examined if one is not None), key=value)
        self._search_around(best, value)
        every = sorted((one for one in self.known.values() if one is not None), key=value)
        moving = [self.moving(one) for one in every[:_RANKED]]
        return sorted(moving, key=value)

    def _search_around(self, best: list[ClampedPasses], value: Callable[[ClampedPasses], float]) -> None:
        """Examine angles around the few best ones, the best first, that lie apart from each other."""
        searched: list[ClampedPasses] = []
        for one in best:
            if len(searched) == _SEARCHED or value(one) > _HOPEFUL * value(best[0]):
                continue
            if any(_near(one, other) for other in searched):
                continue
            searched.append(one)
            self.around(one)


def _near(one: ClampedPasses, other: ClampedPasses) -> bool:
    """Whether two clamped angles are so near that one is looked at around the other."""
    a = one.candidate
    b = other.candidate
    is_like = (a.clamp.which, a.feed) == (b.clamp.which, b.feed)
    apart = abs(a.clamp.angle - b.clamp.angle)
    return is_like and apart < _SIDE * np.radians(FINE_DEG) + _SAME


def four_plus_one(job: FaceProblem) -> tuple[Orientation, ToolPath | None]:
    """The clamped angle that machines a face in the shortest passes, or the fewest, and those passes.

    Parameters
    ----------
    job : FaceProblem

    Returns
    -------
    Orientation
        With the mean axis and the mean angle to the normals; the best fixed axis where turning is not shorter, and
        without an axis where there is neither.
    ToolPath or None

    Raises
    ------
    InvalidInput
        When the machine does not drive two rotary axes.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.4, for any machine and with either axis clamped; the paper chooses the free angle at
    each place by itself.

    **Properties**: 1. never longer than the best fixed axis, nor with more passes where these are the objective; 2. the
    free angle has no jump along a pass or from one to the next; 3. the clamped one stands still on cuts and links.
    """
    search = ClampSearch(job, machine_of(job))
    refused: list[str] = []
    fixed, _ = find_axis(job)
    best: list[tuple[Orientation, ToolPath | None]] = []
    for one in FourPlusOneSearch(search).found(fixed):
        laid = _try_clamp(search, one, fixed, refused)
        if laid is not None:
            best.append(laid)
        if len(best) == _LAID:
            break
    if best:
        found, path = min(best, key=lambda row: _price(job, row[0]))
        if fixed.axis is None or _price(job, found) <= _price(job, fixed):
            return replace(found, reasons=(*found.reasons, *refused)), path
    if fixed.axis is None:
        return replace(fixed, reasons=(*fixed.reasons, *refused)), None
    words = "turning one axis makes no shorter passes than this fixed one"
    path = job.made(fixed.axis, fixed.feed)
    return replace(fixed, reasons=(words, *fixed.reasons, *refused)), path


def _price(job: FaceProblem, found: Orientation) -> float:
    return found.passes if job.worth.objective == "passes" else found.length


def _try_clamp(search: ClampSearch, one: ClampedPasses, fixed: Orientation,
               refused: list[str]) -> tuple[Orientation, ToolPath | None] | None:
    """A clamped angle with its passes laid and proven, by the first way that the proof accepts; None without any."""
    for share, inset in _TRIES[one.tried:]:
        cut, _ = search.cut(one.candidate, share, inset)
        if cut is None:
            continue
        done = plan_passes(search.job, search.nodes[cut.feed].chart, cut, partial(on_the_circle, clamp=cut.field.clamp))
        if done.witness is None:
            return _orientation_of(search, done, cut, fixed), done.path
        refused.append(f"refused {_name_of(cut)}: {sentence(done.witness, search.job.feasibility)}")
    return None


def _name_of(cut: MovingCut[ClampedAxis]) -> str:
    clamp = cut.field.clamp
    name = clamp.machine.rotary[clamp.which].name
    return f"{name} clamped at {degrees(clamp.angle):.3f} deg, feed along {cut.feed}"


def _ways(mounting: Mounting, which: int, path: ToolPath) -> list[tuple[str, str]]:
    """Where the clamped axis stands and how the other turns, that which the machine takes first and the mirrored one
    where its axes can take it, in words."""
    machine = mounting.machine
    along = following(machine, path, mounting.table_from_part, float(mounting.tool_length or 0.0))
    cut = path.kind[along.arrival] == Motion.CUT
    taken = along.rotary[cut]
    both = rotary_angles(machine, along.axes[cut], along.rotary[0], mounting.table_from_part)
    rows, away = [taken], np.abs((both.joints - taken[:, None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
    some, at = both.determinant > _SAME, np.arange(len(taken))  # where both meet, neither is another
    other, inside = (each[at, away.argmax(axis=1)][some] for each in (both.joints, both.within))
    if len(other) and inside.all():
        other = np.unwrap(other, axis=0)
        endless = np.array([not np.isfinite(axis.high) for axis in machine.rotary])
        other -= endless * 2 * np.pi * np.round(np.median(other, axis=0) / (2 * np.pi))
        if np.ptp(other[:, which]) < _SAME < abs(other[0, which] - taken[0, which]):
            rows.append(other)
    name, free = machine.rotary[which].name, machine.rotary[1 - which].name
    return [(f"{name} clamped at {degrees(float(np.median(row[:, which]))):.3f} deg",
             f"{free} turns from {degrees(row[:, 1 - which].min()):.2f} to {degrees(row[:, 1 - which].max()):.2f} deg")
            for row in rows]


def _orientation_of(search: ClampSearch, done: MovingAxisResult, cut: MovingCut[ClampedAxis],
                    fixed: Orientation) -> Orientation:
    """What passes come to, in numbers and words."""
    assert done.path is not None
    on = done.path.kind == Motion.CUT
    lean = float(angle_between(done.path.axis[on], done.path.normal[on]).mean())
    first, *mirrored = _ways(search.mounting, cut.field.clamp.which, done.path)
    words = [f"{first[0]}, feed along {cut.feed}", f"{first[1]} along the passes"]
    words += [f"the same axes by the other solution: {where}, {turning}" for where, turning in mirrored]
    if fixed.axis is not None:
        words.append(f"the best fixed axis takes {fixed.passes} passes of {fixed.length:.0f} mm in all")
    return done.orientation(search.job, cut, (*words, CHECKED), search.looked + fixed.evaluations, lean)
