"""Faces that one axis machines, divided where several axes take less time, index moves included."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.partition.face_division import PIECE_COST, Regions
from toolaxis.partition.partition import regions
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.prices import widths
from toolaxis.regions.reach_screen import ReachScreen
from toolaxis.regions.scene import ReachScene
from toolaxis.search.face_problem import FaceProblem

Array = NDArray[np.float64]

#: Cells of a face by which it is told what a division could save, about.
_CELLS = 200
#: By how much strips under another axis have to be wider for that to be screened.
_WIDER = 1.1
#: Share of the widest strip of a cell that counts as no strip, and from which on an axis is tried.
_NARROWEST, _NEARLY = 1e-3, 0.8
#: What a division has to save: of the time of the whole, and s; and what each further sub-surface has to.
WORTH_SHARE, WORTH_SECONDS, _FURTHER = 0.1, 60.0, 0.01


class WholeCut(NamedTuple):
    """What one axis takes for a face.

    axis : (3,) unit vector
    seconds : time of the operation
    feed : feed rate, mm/s
    move : time of an index move, s
    """

    axis: Array
    seconds: float
    feed: float
    move: float

    def saves(self, seconds: float) -> bool:
        """Whether it is worth a division to save some time.

        Parameters
        ----------
        seconds : float
        """
        return seconds >= max(WORTH_SECONDS, WORTH_SHARE * self.seconds)


def divide_for_time(job: FaceProblem, scene: ReachScene, whole: WholeCut,
                    progress: Progress = NO_PROGRESS) -> Regions | None:
    """Sub-surfaces of a face that take less time together than the face with one axis.

    Parameters
    ----------
    job : FaceProblem
        Of the face.
    scene : ReachScene
        Of the part that the face belongs to.
    whole : WholeCut
    progress : Progress

    Returns
    -------
    Regions or None
        Two sub-surfaces or more, as reckoned from strip widths on a lattice; None where it saves too little.

    Raises
    ------
    Cancelled

    Notes
    -----
    Where the widest strips of all axes that reach each cell save too little, nothing more is reckoned.  Borders leave
    marks: a further sub-surface has to save an index move, and a hundredth of the time of the whole.
    """
    if not whole.saves(whole.seconds):
        return None
    strips = _StripTable.of(job, scene, whole.axis)
    if not whole.saves(whole.seconds * strips.share_saved):
        return None
    price = max(whole.move, _FURTHER * whole.seconds)
    try:
        found = regions(job, None, price if job.worth.timed else PIECE_COST + price * whole.feed, progress,
                        begin=strips.promising)
    except InvalidInput:  # no division is known, not even into one
        return None
    if len(found) < 2:
        return None
    undivided = dict(found.curve.tolist()).get(1.0, np.inf)
    if np.isfinite(undivided) and not whole.saves(whole.seconds * (1.0 - sum(found.costs) / undivided)):
        return None
    return found


def estimate_seconds(job: FaceProblem, axis: Array, feed: float) -> float:
    """About how long it takes to machine a face under an axis, s, as strips of the best feed on a few cells tell.

    Parameters
    ----------
    job : FaceProblem
    axis : (3,) array
    feed : float
        mm/s
    """
    cells = _cells_of(job)
    wide = _widths_on(job, cells, axis[None])[0]
    held = wide > 0
    return float(np.sum(cells.area[held] / wide[held])) / feed


def _cells_of(job: FaceProblem) -> FaceCells:
    face = job.worth.face
    return FaceCells.few(face, max(job.worth.tool.radius, float(np.sqrt(face.area / _CELLS))))


def _widths_on(job: FaceProblem, cells: FaceCells, axes: Array) -> Array:
    """Strip widths on cells under axes, (k, n) mm."""
    worth = job.worth
    return np.asarray(widths(cells, [worth.tool], axes, worth.scallop, worth.allowance, worth.greatest_step_over)[0])


class _StripTable(NamedTuple):
    """How wide strips are on cells of a face under axes some degrees apart, those of the best feed.

    axes : (k, 3), the first one machines the whole face
    widths : (k, n) mm; 0 where the axis does not reach the cell, or the strip is hardly wider than under the first
    area : (n,) mm^2
    """

    axes: Array
    widths: Array
    area: Array

    @staticmethod
    def of(job: FaceProblem, scene: ReachScene, axis: Array) -> "_StripTable":
        """Strips on a face that an axis machines."""
        cells = _cells_of(job)
        axes = np.concatenate([axis[None], screening_axes([cells], job.feasibility.limits)])
        wide = _widths_on(job, cells, axes)
        free = ReachScreen(cells, scene).screen([job.worth.tool], axes, (wide > _WIDER * wide[0])[None])[0]
        free[0] = True
        return _StripTable(axes, np.where(free, wide, 0.0), cells.area)

    @property
    def share_saved(self) -> float:
        """Share of the time under the first axis that is saved where each cell has the axis with the widest strip.

        As axes lie some degrees apart it tells what is hopeless, no more.
        """
        best = self.widths.max(axis=0)
        held = best > 0
        if not held.any():
            return 0.0
        before = np.sum(self.area[held] / np.maximum(self.widths[0, held], _NARROWEST * best[held]))
        return float(1.0 - np.sum(self.area[held] / best[held]) / before)

    @property
    def promising(self) -> Array:
        """The first axis, and those with strips nearly as wide as the widest somewhere, (m, 3)."""
        good = (self.widths >= _NEARLY * self.widths.max(axis=0)) & (self.widths > 0)
        chosen = good.any(axis=1)
        chosen[0] = True
        return np.asarray(self.axes[chosen])
