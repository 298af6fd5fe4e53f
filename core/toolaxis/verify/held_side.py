"""How near a tool comes to the side that is held in a clamping: exact for every motion, whatever stands there."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.verify.linear_motions import Tiles
from toolaxis.verify.revolved_solids import reach_of

Array = NDArray[np.float64]


class HeldSide(NamedTuple):
    """A half-space: point : (3,) array, mm, of its plane;  normal : (3,) array, unit vector into it."""

    point: Array
    normal: Array


class HeldSideDistance(NamedTuple):
    """The least distance of a component: distance : float, mm, negative inside;  motion : int, index of the cutter
    location at which the motion arrives."""

    distance: float
    motion: int


def distance_to_held_side(cl: tuple[Array, Array, NDArray[np.int8]], solids: Array, held: HeldSide) -> HeldSideDistance:
    """Least distance of one component of the tool from the held side along cutter location data, links included.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        As for `removal`.
    solids : (k, 7) array
        Of the component, as `revolved_solids.cutter_solid` and `revolved_solids.frustum_solids` give them.
    held : HeldSide

    Raises
    ------
    InvalidInput
        When there is no cutter location, or a number is not finite.

    Notes
    -----
    With a fixed axis the distance is linear in the tip, so that its least value stands at an end of a motion; turning
    motions are looked at in pieces, see `linear_motions.BOW`.

    **Properties**: 1. moving tool and plane together changes nothing; 2. a component that is all inside is so deep.
    """
    found = HeldSideDistance(np.inf, -1)
    tiles = Tiles(cl, reach_of(solids))
    for tile in tiles:
        motions = tile.motions
        for tip, axis in ((motions.start, motions.axis), (motions.start + motions.step, motions.axis + motions.turn)):
            height = _lowest(solids, axis / np.linalg.norm(axis, axis=1)[:, None], held) - (
                tip - held.point) @ held.normal
            i = int(np.argmin(height))
            if height[i] < found.distance:
                found = HeldSideDistance(float(height[i]), int(motions.arrival[i]))
    return found._replace(distance=found.distance - tiles.uncertainty)


def _lowest(solids: Array, axes: Array, held: HeldSide) -> Array:
    """How high the lowest point of solids lies over the tip, away from the held side, (n,) mm."""
    rise = -(axes @ held.normal)[:, None]
    across = np.sqrt(np.maximum(1.0 - rise**2, 0.0))
    flat, radius, _, sine, low, top, rim = solids.T
    # The lower arc has the lowest place only while it has the plane's direction among its normals; a tool that leans
    # farther has it on the rim at its top.
    arc = (low + radius) * rise - flat * across - radius
    end = top * rise - rim * across
    return np.asarray(np.where(rise >= sine, np.minimum(arc, end), end).min(axis=1))
