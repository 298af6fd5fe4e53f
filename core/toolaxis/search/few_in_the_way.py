"""Faces that every axis is refused for few places of them: these are left to a smaller tool, in place of all of it."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.feasibility.check_points import CheckPoints
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.left_places import NOTHING_LEFT, LeftPlaces
from toolaxis.feasibility.violations import BACK, FREE, LIMITS, WANDERS
from toolaxis.numeric.vectors import angle_between
from toolaxis.search.direction_grid import ring
from toolaxis.search.evaluated_axes import AxisTable

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Share of a face in whose places something may be in the way for the rest of it to be machined.
FEW = 0.005
#: Squares of the cutter's radius that a face must hold.
_LARGE = 100.0
#: Axes that are looked at, and the angle between them, rad.
_AXES, _APART = 6, np.radians(8)
#: Angles of axes to the mean normal that are looked at where the search has looked at none, rad.
_LEANS = tuple(np.radians([10.0, 20.0]))
#: Contacts along a side of the grids that tell where: first, and at most; these lie a radius of the corner apart, and
#: so many of them beside each other.
_COARSE, _FINE, _BESIDE = 24, 256, 4
#: How far around such a contact there may be others, in distances between contacts.
_AROUND = 1.5
#: Share of a face that may lie so near to them: the other contacts decide about the axis.
_MOST_AROUND = 0.25


def find_few_in_the_way(feasibility: Feasibility, axes: Array) -> LeftPlaces:
    """The places of a face at which something is in the way of an axis, of the first for which they are few.

    Parameters
    ----------
    feasibility : Feasibility
    axes : (k, 3) array
        Unit vectors, from which the normals of the face keep the angles they must.

    Returns
    -------
    LeftPlaces
        None where they are more than `FEW` of it, or lie near more than `_MOST_AROUND` of it, or there is nothing in
        the way, or the face is small: its division leaves what is tight as well.
    """
    if feasibility.face.area < _LARGE * feasibility.tool.radius**2:
        return NOTHING_LEFT
    every = feasibility.face.grid(_COARSE, _COARSE)
    coarse = feasibility.contacts(every, len(every))
    if not len(coarse.uv):
        return NOTHING_LEFT
    shares = (float(coarse.share[_in_the_way(feasibility, axis, coarse)].sum()) for axis in axes)
    best = next((k for k, share in enumerate(shares) if share <= FEW), None)
    if best is None:
        return NOTHING_LEFT
    pitch = feasibility.tool.corner_radius or feasibility.tool.radius
    count = int(np.clip(np.ceil(np.sqrt(feasibility.face.area) / pitch), _COARSE, _FINE))
    uv = feasibility.face.grid(count, count)
    fine = feasibility.contacts(uv, len(uv))
    if fine.share[_in_the_way(feasibility, axes[best], fine)].sum() > FEW:
        return NOTHING_LEFT
    rows = [some.point[_in_the_way(feasibility, axes[best], some)]
            for some in (fine, feasibility.dense, feasibility.sparse)]
    points = np.unique(np.concatenate(rows), axis=0)
    if not len(points):
        return NOTHING_LEFT
    apart = cKDTree(fine.point).query(fine.point, k=_BESIDE + 1)[0][:, _BESIDE]
    found = LeftPlaces(points, _AROUND * float(max(np.median(apart), feasibility.tool.radius)))
    around = feasibility.left.and_more(found).near(feasibility.face.evaluate(every).point)
    return found if around.mean() <= _MOST_AROUND else NOTHING_LEFT


def list_axes_to_try(ledger: AxisTable, starts: Iterable[Array]) -> Array:
    """Axes that angles allow and something is in the way of, those first that were named, then those where it is least.

    Parameters
    ----------
    ledger : AxisTable
        Of a search that found none.
    starts : iterable of (3,) arrays
    """
    found = [np.asarray(axis) for axis in starts]
    some = np.flatnonzero(~np.isin(ledger.reason, (FREE, LIMITS, BACK, WANDERS)))
    for row in some[np.argsort(ledger.amount[some], kind="stable")]:
        if len(found) >= _AXES:
            break
        axis = ledger.axes[row]
        if all(angle_between(axis, other) >= _APART for other in found):
            found.append(axis)
    middle = ledger.feasibility.normals.mean
    around = [ring(middle, angle) for angle in _LEANS] if middle.any() else []
    rows = np.concatenate([np.array(found).reshape(-1, 3), *around])
    allowed = rows[~np.isin(ledger.feasibility.quick(rows)[0], (LIMITS, BACK, WANDERS))] if len(rows) else rows
    return allowed[:_AXES]


def _in_the_way(feasibility: Feasibility, axis: Array, contacts: CheckPoints) -> Bools:
    """At which contacts something is in the way that no clean-up tool does anyway, (n,)."""
    if not len(contacts.uv):
        return np.zeros(0, dtype=bool)
    trouble = feasibility.trouble(axis, contacts)
    return np.asarray((trouble.reason != FREE) & ~trouble.wall)
