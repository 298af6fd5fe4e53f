"""The paper's search: the best axis of each quasi-feasible sector by steps and golden section, plane after plane.

Our safety checks stand in for the paper's at sample points, and the best planes' axes are ranked again by exact count.
"""

from collections.abc import Callable
from math import radians, sqrt

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.violations import FREE
from toolaxis.numeric.vectors import angle_between
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.hemisphere import distinct
from toolaxis.search.local_search import CountedAxis, count_row, sound
from toolaxis.search.projection_planes import ProjectionPlane, axis_at, initial_plane, sector, turn_plane

Array = NDArray[np.float64]

#: Steps of the roll angle and of the inclination, rad, and the tolerance of the golden section.
ROLL, STEP, TOLERANCE = radians(4.0), radians(1.0), radians(0.05)
_GOLDEN = (sqrt(5.0) - 1) / 2
_RANKED = 10


def plane_of(ledger: AxisTable) -> tuple[ProjectionPlane, Array]:
    """The initial projection plane of a search, and the normals of its sample points, (n, 3).

    Parameters
    ----------
    ledger : AxisTable
    """
    face, uv = ledger.worth.face, ledger.worth.samples.uv
    normals = face.normal(uv)
    return initial_plane(normals, face.curvature(uv).d2), normals


def sectors(ledger: AxisTable, roll: float = ROLL, step: float = STEP) -> list[CountedAxis]:
    """The best axes of the quasi-feasible sectors, best first; those of the best planes that lie apart.

    Parameters
    ----------
    ledger : AxisTable
        Receives everything that is looked at.
    roll, step : float
        Increments of the roll angle (over the full turn, as directions have two signs) and of the inclination, rad.

    Returns
    -------
    list of Candidate; empty when no sector holds a free axis.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.3, Steps 1 to 5; which planes, left to experience there, is the full turn here.
    """
    first, normals = plane_of(ledger)
    rows: list[int] = []
    count = max(1, round(2 * np.pi / roll))
    for k in range(count):
        ledger.progress.report("planes", k, count)
        row = best_in_plane(ledger, turn_plane(first, 2 * np.pi * k / count), normals, step)
        if row is not None:
            rows.append(row)
    rows.sort(key=lambda row: float(ledger.price[row]))
    found: list[CountedAxis] = []
    for row in rows:
        if len(found) == _RANKED:
            break
        if all(angle_between(ledger.axes[row], other.axis) > radians(1) for other in found) and sound(ledger, row):
            found.append(count_row(ledger, row))
    return distinct(sorted(found, key=lambda c: c.value))


def best_in_plane(ledger: AxisTable, plane: ProjectionPlane, normals: Array, step: float = STEP) -> int | None:
    """Row of the best free axis of one plane's sector, or None.

    Parameters
    ----------
    ledger : AxisTable
    plane : ProjectionPlane
    normals : (n, 3) array
    step : float
        Increment of the inclination, rad.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.2; Step 2 goes on to Step 6, the golden section, not to Step 5 as printed.
    """
    low, high = sector(plane, normals)
    gammas = np.arange(high - step, low, -step)
    if not len(gammas):
        return None
    rows = ledger.look(axis_at(plane, gammas))
    price = ledger.price[rows]
    if not np.isfinite(price).any():
        return None
    k = int(np.argmin(price))
    best = [int(rows.start) + k]

    def value(gamma: float) -> float:
        row = ledger.look(axis_at(plane, gamma)[None]).start
        if ledger.price[row] < ledger.price[best[0]]:
            best[0] = row
        return float(ledger.price[row])

    golden_section(value, (gammas[k] - step, gammas[k] + step), TOLERANCE)
    return best[0]


def golden_section(function: Callable[[float], float], interval: tuple[float, float], tolerance: float) -> float:
    """Place of the least value of a function that falls and then rises; where it is infinite it is left.

    Parameters
    ----------
    function : callable
    interval : (float, float)
    tolerance : float
        Length of the interval at which the search ends.
    """
    low, high = interval
    a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    fa, fb = function(a), function(b)
    while high - low > tolerance:
        if fa <= fb:
            high, b, fb = b, a, fa
            a = high - _GOLDEN * (high - low)
            fa = function(a)
        else:
            low, a, fa = a, b, fb
            b = low + _GOLDEN * (high - low)
            fb = function(b)
    return (low + high) / 2


def roman_axis(ledger: AxisTable, margin: float = radians(1.0)) -> Array:
    """Roman's rule: in the one initial plane, just in front of the cone of projected normals.

    Parameters
    ----------
    ledger : AxisTable
    margin : float
        How far in front, rad.

    Returns
    -------
    (3,) array; the axis may be forbidden.

    Notes
    -----
    **Source**: [zhu2016] Sec. 2.2 and ref. 18; the cone is that of normals all over the face; where both signs of x
    lead to a free axis, the cheaper one by screening.
    """
    first, _ = plane_of(ledger)
    normals = ledger.feasibility.normals.samples
    axes = [axis_at(plane, sector(plane, normals)[1] - margin) for plane in (first, turn_plane(first, np.pi))]
    rows = ledger.look(np.stack(axes))
    free = ledger.reason[rows] == FREE
    value = np.where(free | ~free.any(), ledger.values[rows].min(axis=1), np.inf)
    return np.asarray(axes[int(np.argmin(value))])


def mean_normal(ledger: AxisTable) -> Array:
    """The mean normal as an axis, (3,): what a shop does without thinking; it may be forbidden.

    Parameters
    ----------
    ledger : AxisTable
    """
    return ledger.feasibility.normals.mean


def by_roman(ledger: AxisTable) -> list[CountedAxis]:
    """Roman's rule as a search of its own: its axis with its value, or nothing where that axis is forbidden.

    Parameters
    ----------
    ledger : AxisTable
    """
    return _alone(ledger, roman_axis(ledger))


def by_mean_normal(ledger: AxisTable) -> list[CountedAxis]:
    """The mean normal as a search of its own: with its value, or nothing where that axis is forbidden.

    Parameters
    ----------
    ledger : AxisTable
    """
    return _alone(ledger, mean_normal(ledger))


def _alone(ledger: AxisTable, axis: Array) -> list[CountedAxis]:
    row = ledger.look(axis[None]).start
    return [count_row(ledger, row)] if ledger.reason[row] == FREE else []
