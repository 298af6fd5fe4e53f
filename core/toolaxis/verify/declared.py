"""What a plan declares as left to a clean-up tool: the judge asks for nothing there, and says how much it is."""

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


def declared(zones: Sequence[Face], face: Face, places: tuple[Array, Array], strip: float) -> Bools:
    """Which places of a face lie in declared zones, or in the strip around them, (m,) bool.

    Parameters
    ----------
    zones : sequence of Face
        Pieces of this face and of others that are machined with it.
    face : Face
    places : uv (m, 2), points (m, 3)
        Parameters, and the places themselves, mm.
    strip : float
        Width of the strip, mm.

    Properties
    ----------
    1. A zone that is the whole face holds all of its places.
    """
    from scipy.spatial import cKDTree

    uv, point = places
    found = np.zeros(len(uv), dtype=bool)
    for zone in zones:
        if zone.surface is face.surface:
            found |= zone.contains(uv)
        edge = zone.evaluate(border_points(zone, strip)).point
        low, high = edge.min(axis=0) - strip, edge.max(axis=0) + strip
        near = np.flatnonzero(~found & ((point >= low) & (point <= high)).all(axis=1))
        if len(near):
            # Points of the border are no farther apart than the strip is wide: what lies within it is nearer than this.
            found[near] = cKDTree(edge).query(point[near])[0] <= strip
    return found
