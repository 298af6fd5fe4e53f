"""Which faces a cutter may come to at all along its motions, told by boxes."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import perpendicular
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.revolved_solids import cutter_solid

Array = NDArray[np.float64]

#: What is added for rounding, mm.
_ROUNDING = 1e-6
#: Motions in a row that share a box.
_TOGETHER = 16


class SweptBoxes:
    """Boxes around the places of a cutter along cutter location data, one for some motions in a row.

    They stand along the tool axis at the first of the points, where a cutter with a fixed axis fills them best.

    Parameters
    ----------
    tips, axes : (n, 3) arrays
        mm, and unit vectors.  Between two points the tip moves straight and the axis is interpolated linearly and
        normalised.
    profile : Profile
        Generatrix of the cutter.

    Attributes
    ----------
    frame : (3, 3) array
        Its columns are the ways along the sides of the boxes.
    low, high : (k, 3) array
        Corners in that frame, mm; of the motions from 16 k on.
    """

    def __init__(self, tips: Array, axes: Array, profile: Profile) -> None:
        solid = cutter_solid(profile)[0]
        top = float(solid[5])
        wide = max(float(solid[0] + solid[1]), float(solid[6]))
        self.frame = np.column_stack([*perpendicular(axes[0]), axes[0]])
        tip, upper = tips @ self.frame, (tips + top * axes) @ self.frame
        first = np.arange(0, max(len(tips) - 1, 1), _TOGETHER)
        last = np.minimum(first + _TOGETHER, len(tips) - 1)  # where the next group begins
        # Within a motion the axis leaves the chord between its ends by no more than this.
        half_chord = np.linalg.norm(np.diff(axes, axis=0), axis=1).max(initial=0.0) / 2
        bulge = top * (1.0 - np.sqrt(max(1.0 - half_chord**2, 0.0)))
        # The sine of the angle to the first axis, at most: so much of its radius a disc across the axis rises by.
        leans = min(np.linalg.norm(axes - axes[0], axis=1).max() + 2 * half_chord, 1.0)
        room = np.array([wide, wide, wide * leans]) + bulge + _ROUNDING
        low = np.minimum(tip, upper)
        high = np.maximum(tip, upper)
        self.low = np.minimum(np.minimum.reduceat(low, first), low[last]) - room
        self.high = np.maximum(np.maximum.reduceat(high, first), high[last]) + room

    def may_come_to(self, face: Face, room: float) -> bool:
        """Whether the cutter may come nearer to a face than some room.

        Parameters
        ----------
        face : Face
        room : float
            mm
        """
        net = _net(face)
        if net is None:
            return True
        seen = net @ self.frame
        low = seen.min(axis=0) - room
        high = seen.max(axis=0) + room
        return bool(((low <= self.high) & (high >= self.low)).all(axis=1).any())


def _net(face: Face) -> Array | None:
    """Control points that the range of parameters of a face depends on, (k, 3) mm: the face lies between them.

    None where the face goes on beyond its surface, or a weight is not above zero.
    """
    rows = []
    low, high = np.array(face.bounds[::2]), np.array(face.bounds[1::2])
    surface = face.surface
    for k, knots in enumerate((surface.knots_u, surface.knots_v)):
        degree = surface.degree[k]
        count = len(knots) - degree - 1
        if low[k] < knots[degree] or high[k] > knots[count]:
            return None
        first = int(np.searchsorted(knots[:count], low[k], side="right")) - 1 - degree
        last = int(np.searchsorted(knots[:count], high[k], side="right"))
        rows.append(slice(max(first, 0), max(last, first + degree + 1)))
    net = surface.control[rows[0], rows[1]].reshape(-1, 4)
    return net[:, :3] / net[:, 3:] if (net[:, 3] > 0).all() else None
