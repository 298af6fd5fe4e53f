"""Tool angles at which the whole tool keeps its distances from the real blade, its platform and all else."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.feasibility.surroundings import CheckSurfaces
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.blade.angle_channel import AngleChannel
from toolaxis.strategies.blade.schedule import SThetaLayer, SwivelAxis
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

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
        tips = centres - self.tool.corner_radius * axes
        moves = motions(tips, axes)
        good = np.ones(len(moves), dtype=bool)
        for group in self.groups:
            some = np.flatnonzero(good)
            required = np.tile(group.required, (len(group.faces), 1))
            found = keeps_limits(group.cells, self.tool, moves[some], required)
            good[some] = found.blocked < 0
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
        width = high - low
        theta = low[:, None] + width[:, None] * share
        good = self.free(np.repeat(centres, _ANGLES, axis=0), theta.ravel())
        good = good.reshape(theta.shape)
        none = np.asarray(~good.any(axis=1))
        first, last = _longest(good)
        lower = self._edge_of_free(centres, theta, first, first - 1, none)
        upper = self._edge_of_free(centres, theta, last, last + 1, none)
        lower = np.where(first > 0, lower, low)
        upper = np.where(last < _ANGLES - 1, upper, high)
        middle = (low + high) / 2
        return np.where(none, middle + 1e-3, lower), np.where(none, middle - 1e-3, upper)

    def _edge_of_free(self, centres: Array, theta: Array, inner: Index, outer: Index, none: Bools) -> Array:
        """The last free angle between a free one of each row and the forbidden one beside it, (n,) rad."""
        at = np.arange(len(theta))
        ok = theta[at, inner]
        is_inside = (outer >= 0) & (outer < _ANGLES)
        beside = theta[at, np.clip(outer, 0, _ANGLES - 1)]
        off = np.where(is_inside, beside, ok)
        for _ in range(_HALVED):
            middle = (ok + off) / 2
            some = np.flatnonzero((off != ok) & ~none)
            holds = np.zeros(len(ok), dtype=bool)
            holds[some] = self.free(centres[some], middle[some])
            is_done = holds | (off == ok)
            ok = np.where(holds, middle, ok)
            off = np.where(is_done, off, middle)
        return ok


def _longest(good: Bools) -> tuple[Index, Index]:
    """First and last column of the longest run of trues in each row."""
    run = np.zeros(good.shape, dtype=int)
    run[:, 0] = good[:, 0]
    for k in range(1, good.shape[1]):
        run[:, k] = np.where(good[:, k], run[:, k - 1] + 1, 0)
    last = run.argmax(axis=1)
    length = run[np.arange(len(run)), last]
    first = last - np.maximum(length, 1) + 1
    return first, last


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
        some = _places_to_look_at(wide)
        low, high = room.limits(points[some], wide.low[some], wide.high[some])
        lost_below = _spread(some, low - wide.low[some], len(points))
        lost_above = _spread(some, wide.high[some] - high, len(points))
        found.append(plane.within(wide.low + lost_below, wide.high - lost_above))
    return found


def _places_to_look_at(wide: AngleChannel) -> Index:
    """Places along a channel, evenly by its length and by how far it turns together."""
    by_length = wide.lengths / wide.lengths[-1]
    by_turn = (wide.low - wide.low[0]) / (2 * np.pi)
    measure = by_length + by_turn
    even = np.linspace(0, measure[-1], _PLACES)
    return np.unique(np.searchsorted(measure, even))


def _spread(places: Index, values: Array, number: int) -> Array:
    """Values at all points: the larger of those of both neighbours."""
    at = np.arange(number)
    k = np.searchsorted(places, at)
    k = np.clip(k, 0, len(places) - 1)
    is_beyond = places[k] > at
    before = np.maximum(k - is_beyond, 0)
    return np.asarray(np.maximum(values[k], values[before]))
