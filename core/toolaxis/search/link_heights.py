"""How a tool gets from stroke to stroke: straight over to one beside, or with the least lift that nothing stands in."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import keeps_limits
from toolaxis.feasibility.surroundings import OTHER, CheckSurfaces
from toolaxis.path.links import BESIDE, LIFTS, ROOFS, least_rise
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: What the cutter keeps from the skin while it crosses, mm and in scallop heights, whichever is more: stock that is
#: still to be cut may stand there, and where no pass reaches it stays; the judge takes it to be as high.
OVER, SCALLOPS = 1.0, 20.0


def height_over(scallop: float) -> float:
    """What the cutter keeps from the skin while it crosses, mm.

    Parameters
    ----------
    scallop : float
        mm
    """
    return max(OVER, SCALLOPS * scallop)


@dataclass(frozen=True, eq=False)
class LinkClearance:
    """The surroundings of links with one axis.

    Attributes
    ----------
    tool : Tool
    groups : tuple of CheckSurfaces
        With the distances to keep.
    axis : (3,) array
    top : float
        Height along the axis, mm, at which the tip crosses above everything.
    allowance : float
        Stock left on the skin, mm.
    over : float
        What it keeps from the skin while it crosses, mm, see `height_over`.
    """

    tool: Tool
    groups: tuple[CheckSurfaces, ...]
    axis: Array
    top: float
    allowance: float = 0.0
    over: float = OVER

    def heights(self, ends: Array, begins: Array) -> Array:
        """The least heights along the axis at which the tip may cross, (k,) mm.

        Lifting, crossing and coming down keep the distances to walls and obstacles, and clear of stock; crossing keeps
        `over` from the skin too; bounds hold along the motions.

        Parameters
        ----------
        ends, begins : (k, 3) array
            Tips from which it is lifted, and down to which it comes, mm.
        """
        found = np.full(len(ends), self.top)
        base = np.maximum(ends @ self.axis, begins @ self.axis)
        left = np.arange(len(ends))
        for lift in LIFTS:
            left = left[base[left] + lift < self.top]
            if not len(left):
                break
            height = base[left] + lift
            high = [tips[left] + (height - tips[left] @ self.axis)[:, None] * self.axis for tips in (ends, begins)]
            over, up, down = (high[0], high[1]), (ends[left], high[0]), (high[1], begins[left])
            free = self._clear(*over, across=True) & self._clear(*up, rapid=True) & self._clear(*down, rapid=True)
            found[left[free]] = height[free]
            left = left[~free]
        return found

    def beside(self, ends: Array, begins: Array) -> Array:
        """Tips over which it may go straight from stroke to stroke at feed rate, (k, 3) mm; nan where it must lift.

        Both straights keep what the strokes themselves keep: the gouge limit from the skin, distances to all else.

        Parameters
        ----------
        ends, begins : (k, 3) array
            Tips at the end of a stroke and at the begin of the next, mm.
        """
        found = np.full(ends.shape, np.nan)
        far = np.linalg.norm(begins - ends, axis=1)
        left = np.flatnonzero(far <= BESIDE)
        for share in ROOFS:
            over = (ends[left] + begins[left]) / 2 + (share * far[left])[:, None] * self.axis
            free = self._clear(ends[left], over) & self._clear(over, begins[left])
            found[left[free]] = over[free]
            left = left[~free]
        return found

    @property
    def rise(self) -> Callable[[Array, Array, Array], Array] | None:
        """How far the ends of links have to be lifted for stock, see `toolaxis.path.links.Linking`; None without stock.
        """
        if not any(group.stock > 0 for group in self.groups):
            return None
        return lambda tips, axes, most: least_rise(tips, axes, most,
                                                   lambda start, end, _: self._clear(start, end, rapid=True))

    def free(self, start: Array, end: Array, axes: Array) -> Bools:
        """Whether straight motions keep all distances that strokes keep, (k,).

        Parameters
        ----------
        start, end : (k, 3) array
            Tips, mm.
        axes : (k, 3) array
            All the same.
        """
        return self._clear(start, end)

    def _clear(self, start: Array, end: Array, across: bool = False, rapid: bool = False) -> Bools:
        """Whether straight motions keep their distances, (k,): across, and at rapid traverse, those of links too."""
        axes = np.broadcast_to(self.axis, start.shape)
        moves = np.stack([(start + end) / 2, (end - start) / 2, axes], axis=1)
        free = np.ones(len(moves), dtype=bool)
        for group in self.groups:
            required = group.required_on_links if rapid or across else group.required.copy()
            if across and group.role != OTHER:
                required[0] = max(self.allowance + self.over, group.rapid)
            table = np.tile(required, (len(group.faces), 1))
            some = np.flatnonzero(free)
            free[some] = keeps_limits(group.cells, self.tool, moves[some], table).blocked < 0
        return free
