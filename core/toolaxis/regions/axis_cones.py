"""All axes as cones: cells of a cube's sides seen from its middle, which are halved each way."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.vectors import angle_between, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

#: Cones along each side of the cube at first.
_FIRST = 6
#: Middles of the quarters of a cone, in halves of it.
_QUARTERS = np.array([[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]])


@dataclass(frozen=True, eq=False)
class AxisCones:
    """Sets of axes; make them with `first_cones` and `halve`.

    Attributes
    ----------
    side : (n,) array of int
        Side of the cube, 0 to 5: +x, +y, +z, -x, -y, -z.
    place : (n, 2) array
        Angles of the middle across the side, rad, from -pi / 4 to pi / 4.
    half : (n,) array
        Half the range of these angles, rad.
    """

    side: Indices
    place: Array
    half: Array

    @property
    def middle(self) -> Array:
        """Unit vectors, (n, 3)."""
        return _directions(self.side, self.place)

    @property
    def radius(self) -> Array:
        """No axis is farther than this from the middle of its cone, (n,) rad."""
        corner = self.place[:, None] + 2 * _QUARTERS * self.half[:, None, None]
        ends = _directions(np.repeat(self.side, 4), corner.reshape(-1, 2)).reshape(-1, 4, 3)
        # The sides of a cone are parts of great circles: the farthest axis lies in a corner.
        return np.asarray(np.asarray(angle_between(ends, self.middle[:, None])).max(axis=1, initial=0.0))

    def pick(self, rows: Bools | Indices) -> "AxisCones":
        """Some of the cones.

        Parameters
        ----------
        rows : array of bool or int
        """
        return AxisCones(self.side[rows], self.place[rows], self.half[rows])

    def halve(self) -> "AxisCones":
        """Four cones in place of each, those of one together."""
        place = (self.place[:, None] + _QUARTERS * self.half[:, None, None]).reshape(-1, 2)
        return AxisCones(np.repeat(self.side, 4), place, np.repeat(self.half / 2, 4))

    @staticmethod
    def join(parts: Sequence["AxisCones"]) -> "AxisCones":
        """The cones of all of some lists, of which there is one at least.

        Parameters
        ----------
        parts : sequence of AxisCones
        """
        return AxisCones(*(np.concatenate([getattr(one, name) for one in parts]) for name in ("side", "place", "half")))

    def __len__(self) -> int:
        return len(self.side)


class CellCones(NamedTuple):
    """Pairs of a cell, by its number, and a cone."""

    cell: Indices
    cones: AxisCones

    def pick(self, rows: Bools | Indices) -> "CellCones":
        """Some of the pairs."""
        return CellCones(self.cell[rows], self.cones.pick(rows))

    def blocks(self, most: int) -> "list[CellCones]":
        """These pairs, in their order, in lists of `most` pairs at most, none of them empty."""
        return [self.pick(np.arange(first, min(first + most, len(self.cell))))
                for first in range(0, len(self.cell), most)]

    def halve(self) -> "CellCones":
        """Four pairs in place of each, with its cone halved each way."""
        return CellCones(np.repeat(self.cell, 4), self.cones.halve())

    @staticmethod
    def join_all(parts: Sequence["CellCones"]) -> "CellCones":
        """The pairs of all of some lists, of which there is one at least."""
        return CellCones(np.concatenate([one.cell for one in parts]), AxisCones.join([one.cones for one in parts]))

    def hand_down(self, left: Indices, parent: Indices) -> "CellCones":
        """The pairs of cells for their quarters.

        Parameters
        ----------
        left : (m,) array of int
            Numbers of the cells that were halved.
        parent : (k,) array of int
            Of which of these each quarter is one.
        """
        pairs = self.pick(np.argsort(self.cell, kind="stable"))
        first, last = (np.searchsorted(pairs.cell, left[parent], side=side) for side in ("left", "right"))
        count = last - first
        start = np.repeat(first - np.cumsum(count) + count, count)
        rows = start + np.arange(count.sum())
        return CellCones(np.repeat(np.arange(len(parent)), count), pairs.cones.pick(rows))


def first_cones() -> AxisCones:
    """Cones over the whole sphere, each some 15 degrees wide."""
    half = np.pi / 4 / _FIRST
    line = half * (2 * np.arange(_FIRST) + 1) - np.pi / 4
    place = grid_rows(line, line)
    return AxisCones(np.repeat(np.arange(6), len(place)), np.tile(place, (6, 1)), np.full(6 * len(place), half))


def shift_of_axis(flat: float, angle: Array, slack: Array, turn: Array) -> Array:
    """By how much the way from a cutter's corner to its axis may end elsewhere, (n,) mm.

    Parameters
    ----------
    flat : float
        Length of that way, mm.
    angle, slack, turn : (n,) arrays
        Angles of axes and normals, by how much they may differ, and by how much the axes alone may, rad.

    Notes
    -----
    At an angle t of axis and normal, their turns turn the way by as much over sin t.
    """
    least = np.sin(np.clip(np.minimum(angle - slack, np.pi - angle - slack), 0.0, np.pi / 2))
    turned = np.where(least > 0, slack / np.where(least > 0, least, 1.0), np.pi) + turn
    return np.asarray(2 * flat * np.sin(np.minimum(turned, np.pi) / 2))


def _directions(side: Indices, place: Array) -> Array:
    """Unit vectors (n, 3) at places of the sides of the cube."""
    found = np.empty((len(side), 3))
    row, axis = np.arange(len(side)), side % 3
    found[row, axis] = 1.0
    found[row, (axis + 1) % 3] = np.tan(place[:, 0])
    found[row, (axis + 2) % 3] = np.tan(place[:, 1])
    return np.asarray(unit(found)) * np.where(side < 3, 1.0, -1.0)[:, None]
