"""Work coordinate systems: the frame that a fixed tool axis gives an operation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.vectors import as_rows, dot, perpendicular, unit

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WorkCoordinates:
    """A right-handed frame on the part; +z is the tool axis.

    Attributes
    ----------
    origin : (3,) array
        The plan's datum, in the part's frame, mm; one for all operations.
    x, y, z : (3,) array
        Unit vectors in the part's frame.
    shown_at : (3,) array
        A point of the sub-surface at which the frame is drawn, mm; no coordinate refers to it.
    """

    origin: Array
    x: Array
    y: Array
    z: Array
    shown_at: Array

    @property
    def part_from_work(self) -> Array:
        """The (4, 4) matrix that takes work coordinates to the part's frame."""
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = self.x, self.y, self.z, self.origin
        return matrix

    def from_part(self, points: ArrayLike) -> Array:
        """Coordinates in this frame of (n, 3) points given in the part's frame, mm."""
        rows = as_rows(points, 3, "points")
        return np.asarray((rows - self.origin) @ np.stack([self.x, self.y, self.z], axis=1))


def mean_feed_across(axis: ArrayLike, feed: ArrayLike) -> Array:
    """The mean feed direction, projected on the plane normal to the axis, (3,) unit vector.

    Parameters
    ----------
    axis : (3,) array_like
        Tool axis, tip to spindle.
    feed : (n, 3) array_like
        Feed directions over the face; their sign does not matter for the line, their sum gives its sense.
    """
    z = unit(axis)
    rows = as_rows(feed, 3, "feed directions")
    flat = rows - dot(rows, z)[:, None] * z
    size = np.linalg.norm(flat, axis=1, keepdims=True)
    along = flat / np.where(size > 1e-9, size, np.inf)
    values, vectors = np.linalg.eigh(along.T @ along)
    x = vectors[:, 2] - (vectors[:, 2] @ z) * z
    if values[2] <= 0 or not np.linalg.norm(x) > 1e-6:
        x = perpendicular(z)[0]
    return np.asarray(unit(x) * (-1.0 if along.sum(axis=0) @ x < 0 else 1.0))


def work_coordinates(axis: ArrayLike, feed: ArrayLike, datum: ArrayLike, shown_at: ArrayLike) -> WorkCoordinates:
    """The work coordinate system of an operation: +z along the axis, +x along the mean feed direction.

    Parameters
    ----------
    axis : (3,) array_like
        Tool axis, tip to spindle.
    feed : (n, 3) array_like
        Feed directions over the face; their sign does not matter for the line of +x, their sum gives its sense.
    datum : (3,) array_like
        Origin, mm.
    shown_at : (3,) array_like
        Where the frame is drawn, mm.

    Returns
    -------
    WorkCoordinates

    Raises
    ------
    InvalidInput
        When the axis has no direction or a number is not finite.
    """
    z, x = unit(axis), mean_feed_across(axis, feed)
    return WorkCoordinates(as_rows(datum, 3, "datum")[0], x, np.cross(z, x), z, as_rows(shown_at, 3, "point")[0])
