"""Binary space partition of scattered points into patches whose members resemble their centroid."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import lengths

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_ROUNDS = 25


@dataclass(frozen=True, eq=False)
class FeatureCell:
    """One cell of the partition.

    Attributes
    ----------
    rectangle : (4,) array
        x0, x1, y0, y1 of the cell; the cells tile the rectangle that was partitioned.
    members : (m,) array of int
        Rows of the points inside, at least one.
    """

    rectangle: Array
    members: Index


def distances(groups: tuple[Array, ...], members: Index, centre: tuple[Array, ...]) -> Array:
    """Sum over the feature groups of the Euclidean distance of members to a centre.

    Parameters
    ----------
    groups : tuple of (n, d) arrays
        Features, each group already multiplied by its weight.
    members : (m,) array of int
    centre : tuple of (d,) arrays

    Returns
    -------
    (m,) array

    Notes
    -----
    **Source**: [zhu2016] Eq. (2).
    """
    return np.asarray(sum(lengths(g[members] - c) for g, c in zip(groups, centre, strict=True)))


def centroid(groups: tuple[Array, ...], members: Index) -> tuple[Array, ...]:
    """Mean of each feature group over the members."""
    return tuple(g[members].mean(axis=0) for g in groups)


def two_means(groups: tuple[Array, ...], members: Index) -> NDArray[np.bool_]:
    """Cluster members in two; True marks the second cluster.

    The start is the cut through the mean across the direction of greatest variance, so nothing is left to chance.

    Parameters
    ----------
    groups : tuple of (n, d) arrays
    members : (m,) array of int

    Returns
    -------
    (m,) array of bool; all False where the members do not differ.
    """
    table = np.hstack([g[members] for g in groups])
    table = table - table.mean(axis=0)
    direction = np.linalg.eigh(table.T @ table)[1][:, -1]
    second: NDArray[np.bool_] = table @ direction > 0
    for _ in range(_ROUNDS):
        if second.all() or not second.any():
            return np.zeros(len(members), dtype=bool)
        one, two = centroid(groups, members[~second]), centroid(groups, members[second])
        moved = distances(groups, members, two) < distances(groups, members, one)
        if (moved == second).all():
            break
        second = moved
    return second if second.any() and not second.all() else np.zeros(len(members), dtype=bool)


def _cut(points: Array, members: Index, second: NDArray[np.bool_], rectangle: Array) -> tuple[int, float]:
    """Coordinate and place of the cut: half-way between the centroids, in the coordinate that separates them more."""
    size = np.array([rectangle[1] - rectangle[0], rectangle[3] - rectangle[2]])
    if second.any():
        one, two = points[members[~second]].mean(axis=0), points[members[second]].mean(axis=0)
        apart = np.abs(two - one) / size
        order = (0, 1) if apart[0] >= apart[1] else (1, 0)
        for axis in order:
            place = float(one[axis] + two[axis]) / 2
            below = points[members, axis] < place
            if below.any() and not below.all():
                return axis, place
    spread = np.ptp(points[members], axis=0) / size
    axis = 0 if spread[0] >= spread[1] else 1
    values = np.unique(points[members, axis])
    middle = len(values) // 2
    return axis, float(values[middle - 1] + values[middle]) / 2


def partition(points: Array, groups: tuple[Array, ...], tolerance: float, rectangle: Array) -> list[FeatureCell]:
    """Split a rectangle until every point is within the tolerance of the centroid of its cell.

    Parameters
    ----------
    points : (n, 2) array
        Places of the points in the rectangle.
    groups : tuple of (n, d) arrays
        Features, each group already multiplied by its weight.
    tolerance : float
        Greatest distance, as `distances` measures it, of a member to its centroid.
    rectangle : (4,) array
        x0, x1, y0, y1.

    Returns
    -------
    list of FeatureCell, in depth-first order, lower side first; cells without points are left out.
    """
    done: list[FeatureCell] = []
    open_ = [FeatureCell(np.asarray(rectangle, dtype=float), np.arange(len(points)))] if len(points) else []
    while open_:
        patch = open_.pop()
        members = patch.members
        alike = distances(groups, members, centroid(groups, members)).max() <= tolerance
        if alike or len(members) < 2 or not np.ptp(points[members], axis=0).any():
            done.append(patch)
            continue
        axis, place = _cut(points, members, two_means(groups, members), patch.rectangle)
        below = points[members, axis] < place
        lower, upper = patch.rectangle.copy(), patch.rectangle.copy()
        lower[2 * axis + 1] = upper[2 * axis] = place
        open_ += [FeatureCell(upper, members[~below]), FeatureCell(lower, members[below])]
    return done
