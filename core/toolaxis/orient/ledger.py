"""Every axis that a search looked at, with its verdict and its price."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.orient.feasible import Feasibility
from toolaxis.orient.verdicts import FREE, GOUGE
from toolaxis.orient.worth import FEEDS, Worth
from toolaxis.plan.orientation import AxisMap
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]

_BATCH = 64


@dataclass
class Ledger:
    """Axes in the order in which they were looked at; grows with every call of `look`.

    Attributes
    ----------
    feasibility : Feasibility
    worth : Worth
    progress : Progress
    axes : (n, 3) array
    reason : (n,) array of int8
    amount : (n,) array
    unreached : (n,) array
    passes, length : (n, 2) array
        For feed "u" and "v", what is left to a clean-up tool charged; as if the axis were free.
    counts : int
        Exact counts made.
    closer : int
        Axes looked at once more, closer.
    proven : bool
        Whether limits and normals are proven to leave no axis.
    """

    feasibility: Feasibility
    worth: Worth
    progress: Progress = NO_PROGRESS
    axes: Array = field(default_factory=lambda: np.empty((0, 3)))
    reason: NDArray[np.int8] = field(default_factory=lambda: np.empty(0, dtype=np.int8))
    amount: Array = field(default_factory=lambda: np.empty(0))
    unreached: Array = field(default_factory=lambda: np.empty(0))
    passes: Array = field(default_factory=lambda: np.empty((0, 2)))
    length: Array = field(default_factory=lambda: np.empty((0, 2)))
    counts: int = 0
    closer: int = 0
    proven: bool = False

    @property
    def evaluations(self) -> int:
        """Axes looked at, closer looks and exact counts."""
        return len(self.axes) + self.closer + self.counts

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
            self.progress.report("axes", len(self.axes), len(self.axes) + len(axes) - start)
            rows = axes[start:start + _BATCH]
            verdict, price = self.feasibility.screen(rows), self.worth.screen(rows)
            charge = np.array([self.worth.charge(float(length), float(u)) if u > 0 else 1.0
                               for length, u in zip(price.length.min(axis=1), verdict.unreached, strict=True)])[:, None]
            self.axes = np.concatenate([self.axes, rows])
            self.reason = np.concatenate([self.reason, verdict.reason])
            self.amount = np.concatenate([self.amount, verdict.amount])
            self.unreached = np.concatenate([self.unreached, verdict.unreached])
            self.passes = np.concatenate([self.passes, price.passes * charge])
            self.length = np.concatenate([self.length, price.length * charge])
        self.progress.offer(lambda: (self.worth.face, self.map()))
        return slice(first, len(self.axes))

    @property
    def values(self) -> Array:
        """What is to be least, for both feeds, (n, 2), whether the axes are free or not."""
        return self.length if self.worth.objective == "length" else self.passes

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

    def count(self, axis: Array, feed: int, unreached: float) -> tuple[float, float, float]:
        """Exact value, passes and length of an axis for one feed; the value is charged for what stays.

        Parameters
        ----------
        axis : (3,) array
        feed : int
            Index in `FEEDS`.
        unreached : float
        """
        self.progress.check()
        self.counts += 1
        passes, length = self.worth.counted(axis, FEEDS[feed])
        value = length if self.worth.objective == "length" else passes
        return value * self.worth.charge(length, unreached), passes, length

    def map(self) -> AxisMap:
        """The axes as the result carries them."""
        rows, feed = np.arange(len(self.axes)), self.values.argmin(axis=1)
        free = self.reason == FREE
        return AxisMap(self.axes, np.where(free, self.passes[rows, feed], np.inf),
                       np.where(free, self.length[rows, feed], np.inf), self.reason.copy(),
                       np.where(free, 0.0, self.amount))
