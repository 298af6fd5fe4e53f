"""Which faces a cutter may come to at all along its motions, told by boxes."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.revolved_solids import cutter_solid

Array = NDArray[np.float64]

#: What is added for rounding, mm.
_ROUNDING = 1e-6


class SweptBox:
    """The box around all places of a cutter along cutter location data.

    Parameters
    ----------
    tips, axes : (n, 3) arrays
        mm, and unit vectors.  Between two points the tip moves straight and the axis is interpolated linearly and
        normalised.
    profile : Profile
        Generatrix of the cutter.
    """

    def __init__(self, tips: Array, axes: Array, profile: Profile) -> None:
        solid = cutter_solid(profile)[0]
        top = float(solid[5])
        wide = max(float(solid[0] + solid[1]), float(solid[6]))
        ends = np.concatenate([tips, tips + top * axes])
        # Within a motion the axis leaves the chord between its ends by no more than this.
        half_chord = np.linalg.norm(np.diff(axes, axis=0), axis=1).max(initial=0.0) / 2
        bulge = top * (1.0 - np.sqrt(max(1.0 - half_chord**2, 0.0)))
        room = wide + bulge + _ROUNDING
        self.low, self.high = ends.min(axis=0) - room, ends.max(axis=0) + room

    def may_come_to(self, face: Face, room: float) -> bool:
        """Whether the cutter may come nearer to a face than some room.

        Parameters
        ----------
        face : Face
        room : float
            mm
        """
        low, high = _hull(face)
        return bool((low - room <= self.high).all() and (high + room >= self.low).all())


def _hull(face: Face) -> tuple[Array, Array]:
    """Corners of a box around a face: around the control points that its range of parameters depends on.

    Endless where the face goes on beyond its surface, or a weight is not above zero.
    """
    rows = []
    low, high = np.array(face.bounds[::2]), np.array(face.bounds[1::2])
    surface = face.surface
    for k, knots in enumerate((surface.knots_u, surface.knots_v)):
        degree = surface.degree[k]
        count = len(knots) - degree - 1
        if low[k] < knots[degree] or high[k] > knots[count]:
            return np.full(3, -np.inf), np.full(3, np.inf)
        first = int(np.searchsorted(knots[:count], low[k], side="right")) - 1 - degree
        last = int(np.searchsorted(knots[:count], high[k], side="right"))
        rows.append(slice(max(first, 0), max(last, first + degree + 1)))
    net = surface.control[rows[0], rows[1]].reshape(-1, 4)
    if not (net[:, 3] > 0).all():
        return np.full(3, -np.inf), np.full(3, np.inf)
    points = net[:, :3] / net[:, 3:]
    return points.min(axis=0), points.max(axis=0)
