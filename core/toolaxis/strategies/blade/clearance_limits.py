"""Tool angles at which the whole tool keeps its distances from the real blade, its platform and all else."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.feasibility.surroundings import CheckSurfaces
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.blade.schedule import SThetaLayer, SwivelAxis
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Places of a layer at which angles are looked at, angles across the channel there, and how often the gap to the first
#: forbidden one is halved.
_PLACES, _ANGLES, _HALVED = 56, 9, 4
#: Share of the channel's width that is kept from its sides where it is looked at first.
_INSIDE = 1e-3


@dataclass(frozen=True, eq=False)
class BladeSurroundings:
    """What surrounds a blade.

    Attributes
    ----------
    tool : Tool
        With a ball end.
    groups : tuple of CheckSurfaces
        With the distances to keep.
    swing : SwivelAxis
    """

    tool: Tool
    groups: tuple[CheckSurfaces, ...]
    swing: SwivelAxis

    def free(self, centres: Array, theta: Array) -> Bools:
        """Whether the tool keeps all distances at cutter centres with tool angles, (n,).

        Parameters
        ----------
        centres : (n, 3) array
            mm
        theta : (n,) array
            rad
        """
        axes = self.swing.axes(theta)
        moves = motions(centres - self.tool.corner_radius * axes, axes)
        good = np.ones(len(moves), dtype=bool)
        for group in self.groups:
            some = np.flatnonzero(good)
            table = np.tile(group.required, (len(group.faces), 1))
            good[some] = keeps_limits(group.cells, self.tool, moves[some], table).blocked < 0
        return good

    def limits(self, centres: Array, low: Array, high: Array) -> tuple[Array, Array]:
        """The widest free part of channels at cutter centres, (n,) each, rad; its sides change places where none is
        free.

        Parameters
        ----------
        centres : (n, 3) array
            mm
        low, high : (n,) array
            Sides of the channel that is looked at, rad.
        """
        share = np.linspace(_INSIDE, 1 - _INSIDE, _ANGLES)
        theta = low[:, None] + (high - low)[:, None] * share
        good = self.free(np.repeat(centres, _ANGLES, axis=0), theta.ravel()).reshape(theta.shape)
        first, last = _longest(good)
        at = np.arange(len(low))
        none = ~good.any(axis=1)
        sides = []
        for inner, outer, edge in ((first, first - 1, low), (last, last + 1, high)):
            ok = theta[at, inner]
            off = np.where((outer >= 0) & (outer < _ANGLES), theta[at, np.clip(outer, 0, _ANGLES - 1)], ok)
            for _ in range(_HALVED):
                middle = (ok + off) / 2
                some = np.flatnonzero((off != ok) & ~none)
                holds = np.zeros(len(ok), dtype=bool)
                holds[some] = self.free(centres[some], middle[some])
                ok, off = np.where(holds, middle, ok), np.where(holds | (off == ok), off, middle)
            sides.append(np.where((outer >= 0) & (outer < _ANGLES), ok, edge))
        middle = (low + high) / 2
        return np.where(none, middle + 1e-3, sides[0]), np.where(none, middle - 1e-3, sides[1])


def _longest(good: Bools) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """First and last column of the longest run of trues in each row."""
    run = np.zeros(good.shape, dtype=int)
    run[:, 0] = good[:, 0]
    for k in range(1, good.shape[1]):
        run[:, k] = np.where(good[:, k], run[:, k - 1] + 1, 0)
    last = run.argmax(axis=1)
    return last - np.maximum(run[np.arange(len(run)), last], 1) + 1, last


def with_room(planes: Sequence[SThetaLayer], centres: Sequence[Array], room: BladeSurroundings,
              progress: Progress = NO_PROGRESS) -> list[SThetaLayer]:
    """Layers with channels in which the whole tool keeps its distances, as seen at places along them.

    Parameters
    ----------
    planes : sequence of SThetaLayer
    centres : sequence of (n, 3) array
        Cutter centres of each, in the path's order.
    room : BladeSurroundings
    progress : Progress

    Notes
    -----
    Between the places the larger of what their neighbours lose is taken off each side; the proof of the path has the
    last word.
    """
    found = []
    for number, (plane, rows) in enumerate(zip(planes, centres, strict=True)):
        progress.report("room around the blade", number, len(planes))
        wide = plane.wide
        points = rows if plane.onward else rows[::-1]
        measure = wide.lengths / wide.lengths[-1] + (wide.low - wide.low[0]) / (2 * np.pi)
        some = np.unique(np.searchsorted(measure, np.linspace(0, measure[-1], _PLACES)))
        low, high = room.limits(points[some], wide.low[some], wide.high[some])
        lost = [_spread(some, change, len(points)) for change in (low - wide.low[some], wide.high[some] - high)]
        found.append(plane.within(wide.low + lost[0], wide.high - lost[1]))
    return found


def _spread(places: NDArray[np.intp], values: Array, count: int) -> Array:
    """Values at all points: the larger of those of both neighbours."""
    at = np.arange(count)
    k = np.clip(np.searchsorted(places, at), 0, len(places) - 1)
    before = np.maximum(k - (places[k] > at), 0)
    return np.asarray(np.maximum(values[k], values[before]))
