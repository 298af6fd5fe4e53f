"""Few places of a face that are left to a smaller tool: creases, ripples and corners tighter than the cutter."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]


class LeftPlaces(NamedTuple):
    """Places at which the cutter may not stand, and how far around each contacts are looked at for that one by one.

    points : (k, 3) array, mm
    reach : float, mm
    """

    points: Array
    reach: float

    def near(self, points: Array) -> Bools:
        """Which points (n, 3) lie near such a place, (n,).

        Parameters
        ----------
        points : (n, 3) array
        """
        if not len(self.points) or not len(points):
            return np.zeros(len(points), dtype=bool)
        return np.asarray(cKDTree(self.points).query(points)[0] <= self.reach)

    def and_more(self, other: "LeftPlaces") -> "LeftPlaces":
        """These and others.

        Parameters
        ----------
        other : LeftPlaces
        """
        return LeftPlaces(np.concatenate([self.points, other.points]), max(self.reach, other.reach))


NOTHING_LEFT = LeftPlaces(np.empty((0, 3)), 0.0)
