"""Where no axis was free at first: discs of axes are divided, and those that are forbidden for certain dropped."""

from math import radians

import numpy as np

from toolaxis.feasibility.violations import BACK, LIMITS, WANDERS
from toolaxis.search.direction_grid import ring
from toolaxis.search.evaluated_axes import AxisTable

_MOST_EVALUATIONS = 1400
#: Seven discs of this share of a disc's radius, one in the middle, cover it on the sphere too (tested).
_SHRINK = 0.52


def hunt(ledger: AxisTable, first: int, radius: float) -> bool:
    """Divide the hemisphere where no axis was free, dropping what limits and normals forbid for certain.

    Limits and angles to normals change no faster than the axis turns: a disc of axes is dropped when its middle misses
    one of them by more than the disc's radius.

    Parameters
    ----------
    ledger : AxisTable
        Holds axes that were looked at.
    first : int
        Row from which on its axes cover the hemisphere.
    radius : float
        Radius of discs around them that do so, rad.

    Returns
    -------
    bool
        Whether it is proven that limits and normals leave no axis at all.
    """
    rows, complete = np.arange(first, len(ledger.axes)), True
    while len(ledger.axes) < _MOST_EVALUATIONS and radius > radians(0.05):
        certain = np.isin(ledger.reason[rows], (LIMITS, BACK, WANDERS)) & (ledger.amount[rows] > radius)
        rows = rows[~certain]
        if not len(rows):
            return complete
        order = np.lexsort((np.arange(len(rows)), ledger.amount[rows], ledger.reason[rows] <= BACK))
        room = (_MOST_EVALUATIONS - len(ledger.axes)) // 12 + 1
        complete &= len(rows) <= room
        rows = rows[order[:room]]
        found = ledger.look(np.concatenate([ring(axis, radius * 3**0.5 / 2) for axis in ledger.axes[rows]]))
        rows = np.concatenate([rows, np.arange(found.start, found.stop)])
        radius *= _SHRINK
        if np.isfinite(ledger.price).any():
            return False
    return False
