"""What a plan declares as left as rest material: the judge asks for nothing there, and says how much it is."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.verify.rays import border_points

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Around declared zones nothing is asked for in a strip of this share of the cutter's radius: their outlines are
#: straight between vertices that are up to a fourteenth of it apart.
STRIP = 0.01


class DeclaredZones:
    """Declared zones, and the strip around them.

    Parameters
    ----------
    zones : sequence of Face
        Pieces of the faces that are machined.
    strip : float
        Width of the strip, mm.

    Notes
    -----
    **Properties**: 1. a zone that is the whole face holds all of its places.
    """

    def __init__(self, zones: Sequence[Face], strip: float) -> None:
        from scipy.spatial import cKDTree

        self.zones, self.strip = tuple(zones), strip
        # Points of a border are no farther apart than the strip is wide.
        self._borders = [cKDTree(zone.evaluate(border_points(zone, strip)).point) for zone in self.zones]

    def holds(self, face: Face, uv: Array, point: Array) -> Bools:
        """Which places of a face lie in declared zones, or in the strip around them, (m,) bool.

        Parameters
        ----------
        face : Face
        uv : (m, 2) array
        point : (m, 3) array
            mm
        """
        found = np.zeros(len(uv), dtype=bool)
        for zone, border in zip(self.zones, self._borders, strict=True):
            if zone.surface is face.surface:
                found |= zone.contains(uv)
            low, high = border.mins - self.strip, border.maxes + self.strip
            near = np.flatnonzero(~found & ((point >= low) & (point <= high)).all(axis=1))
            found[near] = border.query(point[near], distance_upper_bound=self.strip)[0] <= self.strip
        return found
