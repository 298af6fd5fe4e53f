"""The whole hemisphere, coarse to fine: a spiral of axes, rings around the promising ones, exact counts for the best.

Optima lie on the border of the free region, and there are often several.  So rings are laid around the best free axes
and around forbidden ones next to free ones that would be better; all lobes are followed; and what decides is the exact
count, because the screening value is least true just where it is best.
"""

from math import radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.normal_cone import NormalField
from toolaxis.feasibility.violations import BACK, FREE, Violation
from toolaxis.numeric.rounding import round_significant
from toolaxis.numeric.vectors import angle_between
from toolaxis.plan.choices import FIELD
from toolaxis.search.branch_and_bound import hunt
from toolaxis.search.direction_grid import COVER, own_frame, ring, spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.flank_axes import flank_axes
from toolaxis.search.local_search import FINEST, CountedAxis, count_row, polish, proven, sound

Array = NDArray[np.float64]
Index = NDArray[np.intp]

#: Spacing of the first axes, rad.
SPACING = radians(10)
#: Axes around which rings are laid, level by level.
_BEAM = (14, 10, 8)
#: Fewer where normals and limits leave little: one for so many first axes, but not below the second number.
_SHARE, _NARROWEST = 9, 6
#: Free axes of equal price that are asked for their clearance, those nearest to the mean normal; and how many are left.
_NEAR_MEAN, _TIED = 48, 12
#: How often all free axes may be refused by closer looks before the search ends without one.
_HUNTS = 3
#: Lobes are at least so far apart, rad.
APART = radians(12)
_LOBES = 5
#: Lobes that cost so many times the best one's price are left out, but for the second best.
_POOR = 1.5
_POLISHED = 4
#: Lobes whose first exact value is this much worse than the best are not polished.
_HOPELESS = 0.02
#: The same where values are those of coarse fields of passes, and the last radius of the rings then, rad.
_DOUBTED, _COARSE = 0.2, radians(0.3)
#: Values closer than this are ties.
TIE = 0.001
#: Free axes so near a refused one are not tried, rad.
REPELLED = radians(0.15)
#: Clearances closer than this are the same, mm.
_SHARES = 0.25


def search(ledger: AxisTable) -> list[CountedAxis]:
    """Search the hemisphere of axes that see the face.

    Parameters
    ----------
    ledger : AxisTable
        Empty; holds everything that was looked at afterwards.

    Returns
    -------
    list of CountedAxis, the best axis of each lobe, best first; empty when no free axis was found.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    field = ledger.feasibility.normals
    frame = frame_of(field)
    ledger.look(np.concatenate([np.stack([field.mean, frame[2]]), ledger.starts]))
    ledger.lay(flank_axes(ledger.feasibility))
    first = len(ledger.axes)
    ledger.lay(spiral(frame, SPACING))
    for _ in range(_HUNTS):
        if not np.isfinite(ledger.price).any():
            ledger.proven = hunt(ledger, first, COVER * SPACING)
        if not np.isfinite(ledger.price).any():
            return []
        found = ties(ledger) if indifferent(ledger) else _refine_lobes(ledger)
        if found:
            return found
    return []


def _refine_lobes(ledger: AxisTable) -> list[CountedAxis]:
    """The best of each lobe from rings around the promising axes; none where a closer look refuses all of them."""
    spacing, most = SPACING, max(_NARROWEST, (len(ledger.axes) - ledger.excluded) // _SHARE)
    for width in np.minimum(_BEAM, most):
        probe(ledger, width // 2)
        refine(ledger, spacing, width)
        spacing /= 2
    return local_optima(ledger, spacing)


def frame_of(field: NormalField) -> Array:
    """The frame that the spiral lies in, (3, 3): it moves with the face, with z in the middle of its normals.

    Parameters
    ----------
    field : NormalField
    """
    return own_frame(field.samples, field.cap.centre if field.cap.centre.any() else field.mean)


def indifferent(ledger: AxisTable) -> bool:
    """Whether all free axes cost the same: those of a ball end, where none of them leaves anything at walls.

    In time they differ.

    Parameters
    ----------
    ledger : AxisTable
    """
    if ledger.worth.objective == "time":
        return False
    return ledger.feasibility.tool.flat_radius == 0 and not ledger.unreached[ledger.reason == FREE].any()


def ties(ledger: AxisTable) -> list[CountedAxis]:
    """Free axes of equal price, by clearance and then by the angle to the mean normal; a dozen at most.

    Parameters
    ----------
    ledger : AxisTable
    """
    free = np.flatnonzero(np.isfinite(ledger.price))
    away = round_significant(angle_between(ledger.axes[free], ledger.feasibility.normals.mean))
    nearest = free[np.argsort(away, kind="stable")][:_NEAR_MEAN]
    room = np.array([ledger.feasibility.room(ledger.axes[i]) for i in nearest])
    most_room_first = -np.round(room / _SHARES)
    rank = np.arange(len(nearest))
    order = nearest[np.lexsort((rank, most_room_first))][:_TIED]
    # They all cost the same: one count is that of all.
    first = order[0]
    feed = int(ledger.values[first].argmin())
    value, passes, length = ledger.count(ledger.axes[first], feed, float(ledger.unreached[first]))
    return [CountedAxis(ledger.axes[i], feed, value, passes, length, float(ledger.unreached[i])) for i in order]


def probe(ledger: AxisTable, most: int) -> None:
    """Look closer at the best axes, so that screening learns where the skin is gouged between its points.

    Parameters
    ----------
    ledger : AxisTable
    most : int
        Number of axes to be found sound.
    """
    looked: set[int] = set()
    for _ in range(3 * most):
        price = ledger.price
        price[list(looked)] = np.inf
        row = int(np.argmin(price))
        if not np.isfinite(price[row]) or most == 0:
            return
        near = np.flatnonzero(angle_between(ledger.axes, ledger.axes[row]) <= APART / 2)
        if sound(ledger, row):
            looked.update(near.tolist())
            most -= 1


def refine(ledger: AxisTable, spacing: float, width: int) -> None:
    """Lay rings of half the spacing around the most promising axes.

    Parameters
    ----------
    ledger : AxisTable
    spacing : float
        Of the axes so far, rad.
    width : int
        Number of axes to lay rings around: best free ones, and forbidden ones next to free ones, half and half.
    """
    price, all_values = ledger.price, ledger.values.min(axis=1)
    free = np.flatnonzero(np.isfinite(price))
    if not len(free):  # a closer look has refused the last one
        return
    best = _spread(ledger.axes, free[np.argsort(price[free], kind="stable")], 0.6 * spacing, width - width // 2)
    border = np.flatnonzero((ledger.reason > BACK) & np.isfinite(all_values) & (all_values < 1.02 * price.min()))
    if len(border):
        near = angle_between(ledger.axes[border][:, None], ledger.axes[free][None]).min(axis=1) <= 1.4 * spacing
        border = border[near]
        border = border[np.argsort(_next_to(ledger, border, free, spacing), kind="stable")]
    chosen = [*best, *_spread(ledger.axes, border, 0.6 * spacing, width // 2)]
    turn = spacing
    for i in chosen:
        around = ring(ledger.axes[i], spacing / 2, turn)
        new = angle_between(around[:, None], ledger.axes[None]).min(axis=1) > 0.35 * spacing / 2
        ledger.look(around[new])


def _next_to(ledger: AxisTable, border: Index, free: Index, spacing: float) -> Array:
    """Price of the best free axis near each forbidden one, (k,)."""
    near = angle_between(ledger.axes[border][:, None], ledger.axes[free][None]) <= 1.4 * spacing
    return np.asarray(np.where(near, ledger.price[free], np.inf).min(axis=1))


def _spread(axes: Array, order: Index, apart: float, most: int) -> list[int]:
    """The first rows of an order that keep apart from those before them."""
    chosen: list[int] = []
    for i in order:
        if len(chosen) == most:
            break
        if not chosen or angle_between(axes[i], axes[chosen]).min() > apart:
            chosen.append(int(i))
    return chosen


def local_optima(ledger: AxisTable, spacing: float) -> list[CountedAxis]:
    """The best axis of each lobe by exact count, best first.

    Parameters
    ----------
    ledger : AxisTable
    spacing : float
        First step, rad.
    """
    starts = []
    price = ledger.price
    order = np.argsort(price, kind="stable")[: int(np.isfinite(price).sum())]
    tops = lobes(ledger.axes, price, order)[:_LOBES]
    for i in [i for k, i in enumerate(tops) if k < 2 or price[i] <= _POOR * price.min()]:
        start = _first_proven(ledger, ledger.axes[i], order)
        if start is not None:
            starts.append(start)
    starts.sort(key=lambda c: c.value)
    done: list[CountedAxis] = []
    doubt, finest = (_DOUBTED, _COARSE) if ledger.worth.passes == FIELD else (_HOPELESS, FINEST)
    for k, start in enumerate(starts):
        hopeless = start.value > starts[0].value * (1 + doubt) or k >= _POLISHED
        done.append(start if hopeless else polish(ledger, start, spacing, finest))
    return rank_candidates(ledger, distinct(sorted(done, key=lambda c: c.value)))


def so_far(ledger: AxisTable) -> list[CountedAxis]:
    """The best axis of each lobe among those that were looked at, best first, by their screened prices.

    Parameters
    ----------
    ledger : AxisTable
        Of a search that was ended.
    """
    price, feed = ledger.price, ledger.values.argmin(axis=1)
    order = np.argsort(price, kind="stable")[: int(np.isfinite(price).sum())]
    rows = lobes(ledger.axes, price, order)[:_LOBES]
    if not rows:
        return []
    whole = ledger.worth.screen(ledger.axes[rows])  # nothing charged for what stays
    return [CountedAxis(ledger.axes[i], int(feed[i]), float(price[i]), float(whole.passes[k, feed[i]]),
                        float(whole.length[k, feed[i]]), float(ledger.unreached[i])) for k, i in enumerate(rows)]


def rank_candidates(ledger: AxisTable, found: list[CountedAxis]) -> list[CountedAxis]:
    """Candidates with ties at the top decided: the larger clearance first, then the smaller angle to the mean normal.

    Parameters
    ----------
    ledger : AxisTable
    found : list of CountedAxis
        By value.
    """
    tied = [one for one in found if one.value <= found[0].value * (1 + TIE)]
    if len(tied) < 2:
        return found
    mean, judged = ledger.feasibility.normals.mean, ledger.feasibility
    tied.sort(key=lambda c: (-round(judged.room(c.axis) / _SHARES),
                             float(round_significant(angle_between(c.axis, mean)))))
    return tied + found[len(tied):]


def distinct(found: list[CountedAxis]) -> list[CountedAxis]:
    """Candidates of different lobes: those that ended within half the lobes' distance of a better one are dropped."""
    kept: list[CountedAxis] = []
    for one in found:
        if all(float(angle_between(one.axis, other.axis)) > APART / 2 for other in kept):
            kept.append(one)
    return kept


def lobes(axes: Array, price: Array, order: Index) -> list[int]:
    """Rows that are the best within the lobes' distance of themselves, best first.

    Parameters
    ----------
    axes : (n, 3) array
    price : (n,) array
    order : (k,) array of int
        Free rows by price.
    """
    chosen: list[int] = []
    for i in order:
        near = order[angle_between(axes[i], axes[order]) <= APART]
        if price[i] <= price[near].min() and (not chosen or angle_between(axes[i], axes[chosen]).min() > APART):
            chosen.append(int(i))
    return chosen


def _first_proven(ledger: AxisTable, top: Array, order: Index) -> CountedAxis | None:
    """The best axis of a lobe that the proof form accepts, counted; None when a dozen are refused."""
    near = [i for i in order if float(angle_between(ledger.axes[i], top)) <= APART][:12]
    for i in near:
        if ledger.reason[i] == FREE and sound(ledger, int(i)) and proven(ledger, int(i)):
            return count_row(ledger, int(i))
    return None


def next_in_lobe(ledger: AxisTable, refused: CountedAxis, found: Violation, attempt: int = 0) -> CountedAxis | None:
    """Another axis of the same lobe after the proof of the passes refused one.

    Parameters
    ----------
    ledger : AxisTable
    refused : CountedAxis
    found : Violation
    attempt : int
        How often this lobe was repaired before: its neighbourhood that is left alone grows fourfold each time.

    Returns
    -------
    CountedAxis, or None when the lobe holds no other free axis.
    """
    ledger.close(refused.axis, REPELLED * 4**attempt, found)
    price = ledger.price
    order = np.argsort(price, kind="stable")[: int(np.isfinite(price).sum())]
    start = _first_proven(ledger, refused.axis, order)
    return None if start is None else polish(ledger, start, 4 * REPELLED, 2 * REPELLED)
