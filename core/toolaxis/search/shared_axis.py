"""One fixed axis for several sub-surfaces at once: a search over the hemisphere by the sum of their prices."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from math import pi, radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import about
from toolaxis.feasibility.violations import FREE
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.direction_grid import own_frame, ring, spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.local_search import count_row

Array = NDArray[np.float64]

#: Spacing of the first axes, and the rings around the best of them, rad.
SPACING, RINGS = radians(5.0), tuple(radians(angle) for angle in (3.0, 1.5, 0.75))
#: Axes around which rings are laid, and axes that are counted exactly; the latter are so far apart at least, rad.
_BEAM, _COUNTED, _APART = 6, 4, radians(2.0)
#: Walks by exact values, their steps, rad, how often one is repeated, axes of a ring that are counted, and what counts
#: as better, as a share.
_WALKED, STEPS, _MOST_STEPS = 2, tuple(radians(angle) for angle in (1.2, 0.6, 0.3)), 8
_TRIED, _WORTHWHILE = 2, 1e-4


class SharedAxisSearch:
    """Axes that were looked at for several sub-surfaces, and what all of these cost with each.

    Parameters
    ----------
    tasks : sequence of FaceProblem
        At least one.
    progress : Progress

    Attributes
    ----------
    axes : (n, 3) array
    price : (n,) array
        Sum of the sub-surfaces' screening values in their better feeds; inf where one of them forbids the axis.
    """

    def __init__(self, tasks: Sequence[FaceProblem], progress: Progress = NO_PROGRESS) -> None:
        self.tasks, self.progress = tuple(tasks), progress
        self.axes, self.price = np.empty((0, 3)), np.empty(0)
        self._known: set[int] = set()

    def look(self, axes: Array) -> None:
        """Price axes; those that one sub-surface forbids are not looked at for the others.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.
        """
        total = np.zeros(len(axes))
        for task in self.tasks:
            free = np.flatnonzero(np.isfinite(total))
            if len(free):
                with _of(task):
                    reason, _ = task.feasibility.quick(axes[free])
                total[free[reason != FREE]] = np.inf
        for task in self.tasks:
            free = np.flatnonzero(np.isfinite(total))
            if len(free):
                ledger = AxisTable(task.feasibility, task.worth, self.progress)
                with _of(task):
                    ledger.look(axes[free])
                total[free] += ledger.price
        self.axes = np.concatenate([self.axes, axes])
        self.price = np.concatenate([self.price, total])

    def best(self, most: int, apart: float) -> Array:
        """The cheapest axes that lie apart and that every sub-surface, looked at closely, allows; best first, (m, 3).

        Parameters
        ----------
        most : int
        apart : float
            rad
        """
        found: list[Array] = []
        for row in np.argsort(self.price, kind="stable"):
            if len(found) == most or not np.isfinite(self.price[row]):
                break
            axis = self.axes[row]
            if all(angle_between(axis, other) > apart for other in found) and self.stands(int(row)):
                found.append(axis)
        return np.array(found).reshape(-1, 3)

    def stands(self, row: int) -> bool:
        """Whether an axis stands a closer look by every sub-surface; where it does not, it is forbidden from now on.

        Parameters
        ----------
        row : int
        """
        if row not in self._known:
            self._known.add(row)
            self.progress.check()
            if any(_refuses(task, self.axes[row]) for task in self.tasks):
                self.price[row] = np.inf
        return bool(np.isfinite(self.price[row]))

    def exact(self, axis: Array) -> float:
        """Sum of the exact values in the better feeds; inf where the axis leaves no strip somewhere.

        Parameters
        ----------
        axis : (3,) array
        """
        total = 0.0
        for task in self.tasks:
            self.progress.check()
            ledger = AxisTable(task.feasibility, task.worth, self.progress)
            with _of(task):
                ledger.look(axis[None])
                total += count_row(ledger, 0).value
        return total


def _of(task: FaceProblem) -> AbstractContextManager[None]:
    """Exceptions that leave the block tell which face they are about."""
    return about(task.worth.face.label)


def _refuses(task: FaceProblem, axis: Array) -> bool:
    """Whether a closer look of one sub-surface forbids an axis."""
    with _of(task):
        return task.feasibility.witness(axis) is not None


def together(tasks: Sequence[FaceProblem], progress: Progress = NO_PROGRESS) -> Array:
    """Axes that serve all sub-surfaces, the cheapest first, before the passes are proven.

    Parameters
    ----------
    tasks : sequence of FaceProblem
        One a sub-surface, at least one.
    progress : Progress

    Returns
    -------
    (m, 3) array
        At most two; none where no axis was found that every sub-surface allows.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    A spiral over the hemisphere around the mean of all normals, or over the whole sphere where they have none, finer
    and finer rings around the cheapest axes by screening, and walks by exact counts from the best of these.

    **Source**: [zhu2016] Sec. 6.3 compares with one fixed axis for the whole surface, Table 4.
    """
    normals = np.concatenate([task.feasibility.normals.samples for task in tasks])
    middle = normals.mean(axis=0)
    size = float(np.linalg.norm(middle))
    frame = own_frame(normals, unit(middle) if size > 1e-6 else normals[0])
    pool = SharedAxisSearch(tasks, progress)
    pool.look(np.concatenate([frame[2:], spiral(frame, SPACING, pi / 2 if size > 0.3 else pi)]))
    for angle in RINGS:
        near = pool.best(_BEAM, angle)
        if len(near):
            pool.look(np.concatenate([ring(axis, angle) for axis in near]))
    found = sorted((pool.exact(axis), tuple(axis)) for axis in pool.best(_COUNTED, _APART))[:_WALKED]
    walked = sorted(_walk_to_best(pool, np.array(axis), value) for value, axis in found if np.isfinite(value))
    return np.array([axis for _, axis in walked]).reshape(-1, 3)


def _walk_to_best(pool: SharedAxisSearch, axis: Array, value: float) -> tuple[float, tuple[float, ...]]:
    """The best axis on a walk from one by exact values, and its value: the better one on a ring, or a smaller ring."""
    for angle in STEPS:
        for _ in range(_MOST_STEPS):
            near = ring(axis, angle)
            first = len(pool.axes)
            pool.look(near)
            order = np.argsort(pool.price[first:], kind="stable")[:_TRIED]
            tried = [(pool.exact(near[k]), tuple(near[k])) for k in order if pool.stands(first + int(k))]
            best, better = min(tried, default=(np.inf, ()))
            if not best < value * (1 - _WORTHWHILE):
                break
            axis, value = np.array(better), best
    return value, tuple(axis.tolist())
