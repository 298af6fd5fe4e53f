"""Every axis that a search looked at, with its verdict and its price."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.refined_check import RefinedCheck
from toolaxis.feasibility.violations import BACK, FREE, GOUGE, LIMITS, ScreeningResult, Violation
from toolaxis.machine.limits import AxisLimits
from toolaxis.numeric.rounding import round_costs, round_significant
from toolaxis.numeric.vectors import angle_between
from toolaxis.path.pass_count import Count
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.orientation import AxisMap
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.cost import MachiningCost
from toolaxis.work import spend

Array = NDArray[np.float64]

_BATCH = 64
#: As many bounds of distances as take as long as the price of an axis when it is screened.
_AXIS = 2000


@dataclass
class AxisTable:
    """Axes in the order in which they were looked at; grows with every call of `look`.

    Attributes
    ----------
    feasibility : Feasibility
    worth : MachiningCost
    progress : Progress
    starts : (k, 3) array
        Axes that are worth a look before others.
    axes : (n, 3) array
    reason : (n,) array of int8
    amount : (n,) array
    unreached : (n,) array
    passes, length : (n, 2) array
        For feed "u" and "v", what is left as rest material charged; as if the axis were free.
    values : (n, 2) array
        What is to be least, for both feeds, charged, whether the axes are free or not; rounded.
    counts : int
        Exact counts made.
    closer : int
        Axes looked at once more, closer.
    excluded : int
        Axes that limits or normals excluded beforehand: entered for the map, never priced.
    closed : list of (axis, angle, Witness)
        Discs of axes, with their radius in rad, that are left alone since the proof of passes refused their middle.
    proven : bool
        Whether limits and normals are proven to leave no axis.
    """

    feasibility: Feasibility
    worth: MachiningCost
    progress: Progress = NO_PROGRESS
    starts: Array = field(default_factory=lambda: np.empty((0, 3)))
    axes: Array = field(default_factory=lambda: np.empty((0, 3)))
    reason: NDArray[np.int8] = field(default_factory=lambda: np.empty(0, dtype=np.int8))
    amount: Array = field(default_factory=lambda: np.empty(0))
    unreached: Array = field(default_factory=lambda: np.empty(0))
    passes: Array = field(default_factory=lambda: np.empty((0, 2)))
    length: Array = field(default_factory=lambda: np.empty((0, 2)))
    values: Array = field(default_factory=lambda: np.empty((0, 2)))
    counts: int = 0
    closer: int = 0
    excluded: int = 0
    proven: bool = False
    closed: list[tuple[Array, float, Violation]] = field(default_factory=list)

    @property
    def evaluations(self) -> int:
        """Axes looked at, closer looks and exact counts, but not the axes that were excluded beforehand."""
        return len(self.axes) - self.excluded + self.closer + self.counts

    def lay(self, axes: Array) -> None:
        """Look at those axes that limits and normals allow, and enter the others as excluded beforehand.

        The sectors of the paper end where normals end them, and so does what is laid out here.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.

        Raises
        ------
        Cancelled
            When the user asked to stop.
        """
        reason, amount = self.feasibility.quick(axes)
        out = np.isin(reason, (LIMITS, BACK))
        self.excluded += int(out.sum())
        priceless = np.full((int(out.sum()), 2), np.inf)
        self._enter(axes[out], ScreeningResult(reason[out], amount[out], np.zeros(len(priceless))), (priceless,) * 3)
        self.look(axes[~out])

    def look(self, axes: Array) -> slice:
        """Screen axes and enter them.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.

        Returns
        -------
        slice of the rows they got

        Raises
        ------
        Cancelled
            When the user asked to stop.
        """
        first = len(self.axes)
        for start in range(0, len(axes), _BATCH):
            self.progress.report("axes", 0, 0)  # how many it takes is known when they are found
            rows = axes[start:start + _BATCH]
            spend(_AXIS * len(rows))
            verdict, price = self.feasibility.screen(rows), self.worth.screen(rows)
            charge = np.array([self.worth.charge(float(length), float(u)) if u > 0 else 1.0
                               for length, u in zip(price.length.min(axis=1), verdict.unreached, strict=True)])[:, None]
            values = self.worth.values(rows, price)
            self._enter(rows, verdict, (price.passes * charge, price.length * charge, values * charge))
        for axis, angle, found in self.closed:
            self._shut(first, axis, angle, found)
        self.progress.offer(lambda: (self.worth.face, self.map()))
        return slice(first, len(self.axes))

    def close(self, axis: Array, angle: float, found: Violation) -> None:
        """Forbid all axes near one, those still to come too.

        Parameters
        ----------
        axis : (3,) array
        angle : float
            rad
        found : Violation
            Why.
        """
        self.closed.append((axis, angle, found))
        self._shut(0, axis, angle, found)

    def _shut(self, first: int, axis: Array, angle: float, found: Violation) -> None:
        near = (angle_between(self.axes[first:], axis) <= angle) & (self.reason[first:] == FREE)
        for row in np.flatnonzero(near):
            self.forbid(first + int(row), found.reason, found.amount)

    def _enter(self, axes: Array, verdict: ScreeningResult, prices: tuple[Array, Array, Array]) -> None:
        passes, length, values = prices
        self.axes = np.concatenate([self.axes, axes])
        self.reason = np.concatenate([self.reason, verdict.reason])
        self.amount = np.concatenate([self.amount, round_significant(verdict.amount)])
        self.unreached = np.concatenate([self.unreached, verdict.unreached])
        self.passes = np.concatenate([self.passes, passes])
        self.length = np.concatenate([self.length, length])
        self.values = np.concatenate([self.values, round_costs(values)])

    @property
    def price(self) -> Array:
        """What is to be least, in the better feed, (n,); inf where the axis is forbidden."""
        return np.where(self.reason == FREE, self.values.min(axis=1), np.inf)

    def forbid(self, row: int, reason: int, amount: float) -> None:
        """Correct the verdict on one axis after a closer look.

        Parameters
        ----------
        row : int
        reason : int
        amount : float
        """
        self.reason[row], self.amount[row] = reason, amount

    def learn(self, points: Array) -> None:
        """Hold points of the skin against all free axes, and against those still to come.

        Parameters
        ----------
        points : (m, 3) array
            mm
        """
        self.feasibility = self.feasibility.learning(points)
        limit = self.feasibility.tolerance.gouge
        for row in np.flatnonzero(self.reason == FREE):
            depth = self.feasibility.depth(self.axes[row], points)
            if depth > limit:
                self.forbid(int(row), GOUGE, depth - limit)

    def heed(self, found: RefinedCheck) -> None:
        """Learn from a closer look: its contacts are watched, and what it found is held against all free axes.

        Parameters
        ----------
        found : RefinedCheck
        """
        if len(found.points):
            self.learn(found.points)
        if len(found.uv):
            self.feasibility = self.feasibility.watching(found.uv)
            self._quick_again()

    def tighten(self, limits: AxisLimits) -> None:
        """Hold narrower limits against all free axes, and against those still to come.

        Parameters
        ----------
        limits : AxisLimits
        """
        self.feasibility = replace(self.feasibility, limits=limits)
        self._quick_again()

    def _quick_again(self) -> None:
        free = np.flatnonzero(self.reason == FREE)
        self.reason[free], self.amount[free] = self.feasibility.quick(self.axes[free])

    def count(self, axis: Array, feed: int, unreached: float) -> tuple[float, float, float]:
        """Exact value, passes and length of an axis for one feed; the value is charged for what stays, and rounded.

        Parameters
        ----------
        axis : (3,) array
        feed : int
            Index in `FEEDS`.
        unreached : float
        """
        passes, length = self.worth.counted(axis, FEEDS[feed])
        return self.charged(axis, feed, unreached, Count(passes, length)), passes, length

    def charged(self, axis: Array, feed: int, unreached: float, found: Count) -> float:
        """Value of a count, charged for what stays, and rounded.

        Parameters
        ----------
        axis : (3,) array
        feed : int
        unreached : float
        found : Count
        """
        self.progress.check()
        self.counts += 1
        value = self.worth.value(axis, feed, found.passes, found.length)
        return float(round_costs(value * self.worth.charge(found.length, unreached)))

    def map(self) -> AxisMap:
        """The axes as the result carries them."""
        rows, feed = np.arange(len(self.axes)), self.values.argmin(axis=1)
        free = self.reason == FREE
        return AxisMap(self.axes, np.where(free, self.passes[rows, feed], np.inf),
                       np.where(free, self.length[rows, feed], np.inf), self.reason.copy(),
                       np.where(free, 0.0, self.amount))
