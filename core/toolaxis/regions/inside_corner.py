"""Inside corners: places of a face beside another one where no ball end of a rack is small enough to touch them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.surroundings import OTHER, CheckSurfaces
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

#: Halvings of the range in which the radius of the largest ball lies.
_HALVINGS = 16


class InsideCorner(NamedTuple):
    """A corner between a piece of a face and another face.

    beside : str, label of the other face;  radius : float, mm, of the ball end that touches half of the piece, 0 where
    none does;  clearance : float, mm, that the cutter keeps from the other face.
    """

    beside: str
    radius: float
    clearance: float


class _Contacts(NamedTuple):
    """Contacts on a face, (n, 3) mm with what is left on it, and its normals there, (n, 3)."""

    point: Array
    normal: Array

    def centres_of_balls(self, radius: Array) -> Array:
        """Centres of balls of the radii (n,) that touch it there."""
        return self.point + radius[:, None] * self.normal

    def are_near(self, box: Array, away: float) -> bool:
        """Whether any contact lies no farther than that from a box, (2, 3) mm."""
        return bool(((self.point >= box[0] - away) & (self.point <= box[1] + away)).all(axis=1).any())


def find_inside_corner(piece: Face, uv: Array, groups: Sequence[CheckSurfaces], smallest: float,
                       allowance: float = 0.0) -> InsideCorner | None:
    """The face in whose corner a piece lies; None where the smallest ball end touches half of the piece.

    Parameters
    ----------
    piece : Face
        Of a face, or a face.
    uv : (n, 2) array
        Places on it.
    groups : sequence of CheckSurfaces
        What stands around the face.
    smallest : float
        Radius of the smallest ball end, or corner, mm.
    allowance : float
        What is left on the face, mm.

    Notes
    -----
    A cutter touches a place from outside of the ball of its corner radius there, whatever its axis, so that what the
    ball meets the cutter meets too.
    """
    derivatives = piece.evaluate(uv)
    normal = piece.normal(uv, derivatives)
    contacts = _Contacts(derivatives.point + allowance * normal, normal)
    largest = np.full(len(uv), smallest)
    walls = _walls_near(contacts, groups, smallest)
    beside = np.full(len(uv), -1)
    for number, (face, required) in enumerate(walls):
        radius = _largest_balls(contacts, face, required, smallest)
        beside[radius < largest] = number
        largest = np.minimum(largest, radius)
    half = float(np.median(largest))
    if half >= smallest:
        return None
    nearest_wall = int(np.bincount(beside[beside >= 0]).argmax())
    face, clearance = walls[nearest_wall]
    return InsideCorner(face.label, half, clearance)


def _walls_near(contacts: _Contacts, groups: Sequence[CheckSurfaces], smallest: float) -> list[tuple[Face, float]]:
    """Faces from which the cutter keeps away that balls may meet, and how far it keeps away, mm."""
    found = []
    for group in groups:
        required = float(group.required[0])
        reach = 2 * smallest + required
        if group.role == OTHER:
            found += [(face, required) for face in group.faces if contacts.are_near(face.box, reach)]
    return found


def _largest_balls(contacts: _Contacts, face: Face, required: float, smallest: float) -> Array:
    """Radii of the largest balls, no larger than the smallest of the rack, that keep away from a face, (n,) mm."""
    low = np.zeros(len(contacts.point))
    high = np.full(len(low), smallest)
    kept = _keep_away(contacts, face, required, high)
    low[kept] = smallest
    for _ in range(_HALVINGS):
        if kept.all():
            break
        middle = (low + high) / 2
        free = _keep_away(contacts, face, required, middle)
        low = np.where(free, middle, low)
        high = np.where(free, high, middle)
    return low


def _keep_away(contacts: _Contacts, face: Face, required: float, radius: Array) -> NDArray[np.bool_]:
    """Whether balls of some radii keep away from a face."""
    centres = contacts.centres_of_balls(radius)
    return np.asarray(nearest(face, centres).distance >= radius + required)
