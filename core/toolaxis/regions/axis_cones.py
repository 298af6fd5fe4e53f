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
        axes = _directions(np.repeat(self.side, 4), corner.reshape(-1, 2)).reshape(-1, 4, 3)
        angles = np.asarray(angle_between(axes, self.middle[:, None]))
        # The sides of a cone are parts of great circles: the farthest axis lies in a corner.
        return np.asarray(angles.max(axis=1, initial=0.0))

    def pick(self, rows: Bools | Indices) -> "AxisCones":
        """Some of the cones.

        Parameters
        ----------
        rows : array of bool or int
        """
        return AxisCones(self.side[rows], self.place[rows], self.half[rows])

    def halve(self) -> "AxisCones":
        """Four cones in place of each, those of one together."""
        side = np.repeat(self.side, 4)
        middle = self.place[:, None] + _QUARTERS * self.half[:, None, None]
        half = np.repeat(self.half / 2, 4)
        return AxisCones(side, middle.reshape(-1, 2), half)

    @staticmethod
    def join(parts: Sequence["AxisCones"]) -> "AxisCones":
        """The cones of all of some lists, of which there is one at least.

        Parameters
        ----------
        parts : sequence of AxisCones
        """
        side = np.concatenate([cones.side for cones in parts])
        place = np.concatenate([cones.place for cones in parts])
        half = np.concatenate([cones.half for cones in parts])
        return AxisCones(side, place, half)

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
        rows = np.arange(len(self.cell))
        return [self.pick(rows[first:first + most]) for first in range(0, len(rows), most)]

    def halve(self) -> "CellCones":
        """Four pairs in place of each, with its cone halved each way."""
        return CellCones(np.repeat(self.cell, 4), self.cones.halve())

    @staticmethod
    def join_all(parts: Sequence["CellCones"]) -> "CellCones":
        """The pairs of all of some lists, of which there is one at least."""
        cell = np.concatenate([pairs.cell for pairs in parts])
        cones = AxisCones.join([pairs.cones for pairs in parts])
        return CellCones(cell, cones)

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
        first = np.searchsorted(pairs.cell, left[parent], side="left")
        last = np.searchsorted(pairs.cell, left[parent], side="right")
        count = last - first
        quarter = np.repeat(np.arange(len(parent)), count)
        # The k-th pair of a quarter is the k-th of its parent: places among all, less those before the quarter.
        before = np.cumsum(count) - count
        within = np.arange(count.sum()) - np.repeat(before, count)
        rows = np.repeat(first, count) + within
        return CellCones(quarter, pairs.cones.pick(rows))


def first_cones() -> AxisCones:
    """Cones over the whole sphere, each some 15 degrees wide."""
    half = np.pi / 4 / _FIRST
    middles = half * (2 * np.arange(_FIRST) + 1) - np.pi / 4
    of_one_side = grid_rows(middles, middles)
    side = np.repeat(np.arange(6), len(of_one_side))
    place = np.tile(of_one_side, (6, 1))
    return AxisCones(side, place, np.full(len(place), half))


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
    nearest_to_pole = np.minimum(angle - slack, np.pi - angle - slack)
    least_sine = np.sin(np.clip(nearest_to_pole, 0.0, np.pi / 2))
    is_apart = least_sine > 0
    of_slack = np.where(is_apart, slack / np.where(is_apart, least_sine, 1.0), np.pi)
    turned = np.minimum(of_slack + turn, np.pi)
    return np.asarray(2 * flat * np.sin(turned / 2))


def _directions(side: Indices, place: Array) -> Array:
    """Unit vectors (n, 3) at places of the sides of the cube."""
    row = np.arange(len(side))
    normal = side % 3
    on_side = np.empty((len(side), 3))
    on_side[row, normal] = 1.0
    on_side[row, (normal + 1) % 3] = np.tan(place[:, 0])
    on_side[row, (normal + 2) % 3] = np.tan(place[:, 1])
    sign = np.where(side < 3, 1.0, -1.0)
    return np.asarray(unit(on_side)) * sign[:, None]
