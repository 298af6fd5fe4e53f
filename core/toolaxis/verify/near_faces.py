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
        tip = tips @ self.frame
        upper = (tips + top * axes) @ self.frame
        number = len(tips) - 1
        first = np.arange(0, max(number, 1), _TOGETHER)
        last = np.minimum(first + _TOGETHER, number)  # where the next group begins
        # Within a motion the axis leaves the chord between its ends by no more than this.
        turns = np.linalg.norm(np.diff(axes, axis=0), axis=1)
        half_chord = turns.max(initial=0.0) / 2
        height = np.sqrt(max(1.0 - half_chord**2, 0.0))
        bulge = top * (1.0 - height)
        # The sine of the angle to the first axis, at most: so much of its radius a disc across the axis rises by.
        off_first = np.linalg.norm(axes - axes[0], axis=1).max()
        leans = min(off_first + 2 * half_chord, 1.0)
        room = np.array([wide, wide, wide * leans]) + bulge + _ROUNDING
        low = np.minimum(tip, upper)
        high = np.maximum(tip, upper)
        lowest = np.minimum.reduceat(low, first)
        highest = np.maximum.reduceat(high, first)
        self.low = np.minimum(lowest, low[last]) - room
        self.high = np.maximum(highest, high[last]) + room

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
        meets = (low <= self.high) & (high >= self.low)
        return bool(meets.all(axis=1).any())


def _net(face: Face) -> Array | None:
    """Control points that the range of parameters of a face depends on, (k, 3) mm: the face lies between them.

    None where the face goes on beyond its surface, or a weight is not above zero.
    """
    u0, u1, v0, v1 = face.bounds
    surface = face.surface
    degree_u, degree_v = surface.degree
    some_u = _active(surface.knots_u, degree_u, u0, u1)
    some_v = _active(surface.knots_v, degree_v, v0, v1)
    if some_u is None or some_v is None:
        return None
    net = surface.control[some_u, some_v].reshape(-1, 4)
    weight = net[:, 3:]
    if not (weight > 0).all():
        return None
    return net[:, :3] / weight


def _active(knots: Array, degree: int, low: float, high: float) -> slice | None:
    """Control points that a range of the parameter depends on; None where it goes on beyond the knots."""
    number = len(knots) - degree - 1
    if low < knots[degree] or high > knots[number]:
        return None
    spans = knots[:number]
    first = int(np.searchsorted(spans, low, side="right")) - 1 - degree
    last = int(np.searchsorted(spans, high, side="right"))
    return slice(max(first, 0), max(last, first + degree + 1))
