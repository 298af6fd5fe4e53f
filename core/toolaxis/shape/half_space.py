"""The side of a part that is held in a clamping: a half-space into which nothing of a tool may go."""

import re
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: What plans call the plane in which the clamped side ends, and what messages call that side.
HELD_SIDE, CLAMPED_SIDE = "held side", "clamped side"
#: How far the plane reaches beside the part, in diagonals of it, and what is added for the length of tools, mm: a tool
#: that touches the part crosses the plane inside of that before any of it is in the held side.
_DIAGONALS, _LENGTH = 2.0, 500.0
_ORDER = re.compile(r"([xyz])([<>])([-+.0-9e]+)")
_FORMS = "write z<12.5 (or x, y and >), or plane:X,Y,Z,NX,NY,NZ with a point of its plane and a direction into it"


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """All that lies to one side of a plane.

    Attributes
    ----------
    point : (3,) array
        Of the plane, mm.
    normal : (3,) array
        Unit vector across the plane, into the half-space.
    """

    point: Array
    normal: Array

    def depth(self, points: ArrayLike) -> Array:
        """How far points (n, 3) lie inside, (n,) mm; below zero outside.

        Parameters
        ----------
        points : (n, 3) array_like
        """
        return np.asarray((np.asarray(points, dtype=float).reshape(-1, 3) - self.point) @ self.normal)

    def plane_beside(self, box: Array) -> Face:
        """Its plane as a face, as large as tools may go around what is in a box.

        Parameters
        ----------
        box : (2, 3) array
            Lower and upper corner, mm.
        """
        middle = box.mean(axis=0)
        centre = middle - self.depth(middle)[0] * self.normal
        size = _DIAGONALS * float(np.linalg.norm(box[1] - box[0])) + _LENGTH
        least_along = np.eye(3)[np.argmin(np.abs(self.normal))]
        along = unit(np.cross(self.normal, least_along))
        across = np.cross(self.normal, along)
        corners = np.empty((2, 2, 3))
        for i, a in enumerate((-1, 1)):
            for k, b in enumerate((-1, 1)):
                corners[i, k] = centre + size * (a * along + b * across)
        return Face.from_bspline(corners, degree=(1, 1)).trimmed((), HELD_SIDE)

    def transformed(self, matrix: ArrayLike) -> "HalfSpace":
        """The half-space moved by an affine map.

        Parameters
        ----------
        matrix : (4, 4) array_like
        """
        m = np.asarray(matrix, dtype=float)
        return HalfSpace(m[:3, :3] @ self.point + m[:3, 3], unit(np.linalg.solve(m[:3, :3].T, self.normal)))


def parse_half_space(text: str) -> HalfSpace:
    """A half-space from its short form, lengths in mm.

    Parameters
    ----------
    text : str
        "z<12.5", "x>-3", or "plane:x,y,z,nx,ny,nz": a point of the plane, and a direction into the half-space.

    Raises
    ------
    InvalidInput
        When the text is not of that form.
    """
    plain = re.sub(r"\s+", "", str(text).lower())
    order = _ORDER.fullmatch(plain)
    try:
        if order:
            way = np.eye(3)["xyz".index(order[1])]
            level = float(order[3])
            if isfinite(level):
                return HalfSpace(level * way, way if order[2] == ">" else -way)
        if plain.startswith("plane:"):
            values = np.array([float(number) for number in plain.removeprefix("plane:").split(",")])
            if len(values) == 6 and np.isfinite(values).all() and np.linalg.norm(values[3:]) > 0:
                return HalfSpace(values[:3], unit(as_rows(values[3:], 3, "direction")[0]))
    except ValueError:
        pass
    raise InvalidInput(f"{CLAMPED_SIDE} {text!r} is not understood: {_FORMS}")
