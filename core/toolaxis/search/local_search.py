"""Exact values of axes, and the walk from a good axis to the best one near it."""

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.check_points import CheckPoints
from toolaxis.feasibility.refined_check import closer
from toolaxis.feasibility.violations import FREE
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.path.pass_count import Count
from toolaxis.plan.choices import FEEDS
from toolaxis.search.direction_grid import ring
from toolaxis.search.evaluated_axes import AxisTable

Array = NDArray[np.float64]

#: Last radius of the rings in front of a border that keeps better axes away, rad.
FINEST = radians(0.02)
#: Axes of a ring.
_RING = 6
#: Axes of a ring that are counted at most.
_TRIED = 2
#: How far above the best value screening may see an axis that is counted all the same, as a share of it, per rad of
#: step: within 1 degree the ratio of exact to screened length varies by 0.0006 at most on the examples; and where
#: screening sees no strip.
_DOUBT, _UNSEEN = 0.05, 0.2
#: Counted axes so near, in steps, tell the slope of exact over screening value; how much they resist a slope.
_NEAR, _STIFF = 2.5, 1.0


@dataclass(frozen=True, eq=False)
class CountedAxis:
    """An axis with its exact value.

    Attributes
    ----------
    axis : (3,) array
    feed : int
        0 for "u", 1 for "v".
    value : float
        What is to be least, charged for what stays.
    passes, length : float
        Exact count and cutting length, mm, over the whole face.
    unreached : float
        Share of the area left as rest material, from screening.
    """

    axis: Array
    feed: int
    value: float
    passes: float
    length: float
    unreached: float


def sound(ledger: AxisTable, row: int) -> bool:
    """Whether an axis stands the closer look at the screening contacts; where it does not, the ledger learns.

    Parameters
    ----------
    ledger : AxisTable
    row : int
    """
    return _stands(ledger, row, ledger.feasibility.sparse)


def proven(ledger: AxisTable, row: int) -> bool:
    """Whether the proof form accepts an axis; where it does not, the ledger learns and its contacts are watched.

    Parameters
    ----------
    ledger : AxisTable
    row : int
    """
    return _stands(ledger, row, ledger.feasibility.dense)


def _stands(ledger: AxisTable, row: int, contacts: CheckPoints) -> bool:
    ledger.closer += 1
    found = closer(ledger.feasibility, ledger.axes[row], contacts)
    stands = found.reason == FREE
    if not stands:
        ledger.forbid(row, found.reason, found.amount)
        ledger.heed(found)
    return stands


def count_row(ledger: AxisTable, row: int, feed: int | None = None) -> CountedAxis:
    """Exact value of a row, in the better feed; both are counted when screening cannot tell.

    Parameters
    ----------
    ledger : AxisTable
    row : int
    feed : int, optional
        The one that is known to be better.
    """
    axis = ledger.axes[row]
    unreached = float(ledger.unreached[row])
    values = ledger.values[row]
    if feed is not None:
        feeds = [feed]
    elif values.max() < 1.04 * values.min():
        feeds = [0, 1]
    else:
        feeds = [int(values.argmin())]
    counted = [CountedAxis(axis, k, *ledger.count(axis, k, unreached), unreached) for k in feeds]
    return min(counted, key=lambda one: one.value)


@dataclass
class _LocalSearch:
    """A walk from axis to axis.

    best : the best axis so far;  known : axes that were counted, with exact over screening value;  worthwhile : share
    of the value that is worth a step;  scale : exact passes and length of the start over those told from fewer places;
    None where these tell nothing.
    """

    ledger: AxisTable
    best: CountedAxis
    known: list[tuple[Array, float]]
    worthwhile: float
    scale: Count | None

    @staticmethod
    def of(ledger: AxisTable, start: CountedAxis) -> "_LocalSearch":
        """A walk that begins at an axis that is counted exactly."""
        rough = ledger.worth.weighed(start.axis, FEEDS[start.feed])
        scale = None
        if np.isfinite(rough.length) and np.isfinite(start.length):
            scale = Count(start.passes / rough.passes, start.length / rough.length)
        known = [(start.axis, _ratio(ledger, start))]
        return _LocalSearch(ledger, start, known, ledger.worth.worthwhile(start.value), scale)

    def count(self, row: int) -> CountedAxis:
        """The count of a row, told from fewer places where that is possible."""
        ledger = self.ledger
        feed = self.best.feed
        axis = ledger.axes[row]
        unreached = float(ledger.unreached[row])
        if self.scale is not None:
            rough = ledger.worth.weighed(axis, FEEDS[feed])
            if np.isfinite(rough.length):
                found = Count(rough.passes * self.scale.passes, rough.length * self.scale.length)
                value = ledger.charged(axis, feed, unreached, found)
                return CountedAxis(axis, feed, value, found.passes, found.length, unreached)
        return count_row(ledger, row, feed)

    def counted_exactly(self, start: CountedAxis) -> CountedAxis:
        """The end of the walk with its exact count, or its start where that is no worse."""
        best = self.best
        if self.scale is None or best is start:
            return best
        counted = self.ledger.count(best.axis, best.feed, best.unreached)
        exact = CountedAxis(best.axis, best.feed, *counted, best.unreached)
        return exact if exact.value < start.value else start

    def hopes(self, rows: slice, step: float) -> Array:
        """What screening promises of rows, as shares of the best value, corrected by what was counted near.

        Screening knows no width beyond the second-order limit of curvature, though the exact cutter may reach some way
        further: in a ring, what stands opposite is mirrored there.
        """
        values = self.ledger.values[rows, self.best.feed]
        axes = self.ledger.axes[rows]
        told = np.asarray(values * self._ratios(axes, step))
        known = np.isfinite(told)
        hope = np.full(len(told), np.inf)
        hope[known] = told[known] / self.best.value  # that value is inf where no strip can be laid at the best axis
        opposite = np.roll(hope, len(hope) // 2)
        mirrored = np.where(np.isfinite(opposite), 2 - opposite, 1.0)
        is_unseen = np.isinf(hope) & (self.ledger.reason[rows] == FREE)
        return np.where(is_unseen, mirrored, hope)

    def _ratios(self, axes: Array, step: float) -> Array:
        """Exact over screening value at axes near the best one: its own, and a slope through those of others near."""
        middle = self.best.axis
        _, own = self.known[-1]
        x, y = perpendicular(middle)
        across = np.stack([x, y], axis=1) / np.sin(step)
        places = np.array([axis for axis, _ in self.known]) @ across
        off = np.array([ratio for _, ratio in self.known]) / own - 1
        near = np.linalg.norm(places, axis=1) <= _NEAR
        normal = places[near].T @ places[near] + _STIFF * np.eye(2)
        slope = np.linalg.solve(normal, places[near].T @ off[near])
        return np.asarray(own * (1 + axes @ across @ slope))

    def better(self, rows: slice, hope: Array, step: float) -> bool:
        """Whether a row, in the order of what is hoped for, counts better than the best and is proven: then it is it.
        """
        ledger = self.ledger
        best = self.best
        is_free = ledger.reason[rows] == FREE
        seen = np.isfinite(ledger.values[rows, best.feed])
        doubt = np.where(seen, _DOUBT, _UNSEEN)
        promised = hope - doubt * step
        best_first = np.argsort(np.where(is_free, hope, np.inf), kind="stable")
        order = best_first[:_TRIED]
        least_worthwhile = 1 - self.worthwhile
        for row, promise in zip(rows.start + order, promised[order], strict=True):
            if ledger.reason[row] != FREE or not promise < least_worthwhile:
                return False
            found = self.count(int(row))
            screened = float(ledger.values[row, best.feed])
            _, ratio = self.known[-1]
            if np.isfinite(screened):
                ratio = found.value / screened
            if found.value < best.value * least_worthwhile and proven(ledger, int(row)):
                self.best = found
                self.known.append((found.axis, ratio))
                return True
            if np.isfinite(found.value):
                self.known.insert(0, (found.axis, ratio))
        return False


def polish(ledger: AxisTable, start: CountedAxis, step: float, finest: float = FINEST) -> CountedAxis:
    """Walk to a local optimum by counts, exact ones at both ends.

    Rings, turned from one to the next, go around the best axis; where no axis of a ring counts better, the lowest
    place of the parabola through the ring is tried, and then the ring is halved.  The walk ends early where a ring
    shows that nothing worthwhile is left.

    Parameters
    ----------
    ledger : AxisTable
    start : CountedAxis
        An axis that the proof form accepts.
    step : float
        First radius of the rings, rad.
    finest : float
        Last one, rad.
    """
    walk = _LocalSearch.of(ledger, start)
    turn = 0.0
    while step >= finest:
        turn += 2.399963
        rows = ledger.look(ring(walk.best.axis, step, turn, _RING))
        hope = walk.hopes(rows, step)
        if walk.better(rows, hope, step):
            continue
        renewed = walk.hopes(rows, step)
        lowest = _lowest(walk.best.axis, ledger.axes[rows], renewed, step, walk.worthwhile)
        if lowest is not None:
            rows = ledger.look(lowest[None])
            if walk.better(rows, walk.hopes(rows, step), step):
                step /= 2
                continue
        step /= 2
        no_better = hope.min() > 1 - walk.worthwhile
        if no_better and _DOUBT * step < walk.worthwhile:
            break
    return walk.counted_exactly(start)


def _lowest(middle: Array, axes: Array, hope: Array, step: float, worthwhile: float) -> Array | None:
    """The axis where the parabola through a ring and its middle is least, within two steps; None where it has none."""
    if not np.isfinite(hope).all():
        return None
    x, y = perpendicular(middle)
    p = np.stack([axes @ x, axes @ y], axis=1) / np.sin(step)
    px, py = p.T
    table = np.column_stack([p, px**2 / 2, px * py, py**2 / 2])
    gx, gy, xx, xy, yy = np.linalg.lstsq(table, hope - 1, rcond=None)[0]
    slope = [gx, gy]
    values, vectors = np.linalg.eigh(np.array([[xx, xy], [xy, yy]]))
    if values[0] <= 0:
        return None
    move = -vectors @ ((vectors.T @ slope) / values)
    size = float(np.linalg.norm(move))
    move *= min(1.0, 2.0 / max(size, 1e-12))
    bend = [xx * move[0] + xy * move[1], xy * move[0] + yy * move[1]]
    gain = -(move @ slope + 0.5 * move @ bend)
    if gain < worthwhile:
        return None
    aside = move[0] * x + move[1] * y
    return unit(middle + np.tan(step) * aside)


def _ratio(ledger: AxisTable, one: CountedAxis) -> float:
    """Exact value of a candidate over its screening value; 1 where either is unknown, as no strip can be laid there."""
    found = ledger.worth.screen(one.axis[None])
    charge = ledger.worth.charge(float(found.length[0].min()), one.unreached)
    plain = float(ledger.worth.values(one.axis[None], found)[0, one.feed])
    screened = plain * charge
    if np.isfinite(screened) and np.isfinite(one.value):
        return one.value / screened
    return 1.0
