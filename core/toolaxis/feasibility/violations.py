"""What can be wrong with an axis, and the plain records in which it is told."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Codes of the reasons, in the order of `toolaxis.plan.orientation.REASONS`.
FREE, LIMITS, BACK, WANDERS, GOUGE, CUTTER, SHANK, HOLDER = range(8)


class ScreeningResult(NamedTuple):
    """Verdicts on k axes: reason (k,), index into `REASONS`; amount (k,) rad or mm; unreached (k,) share of area."""

    reason: NDArray[np.int8]
    amount: Array
    unreached: Array


class Violations(NamedTuple):
    """What is worst at n positions: reason (n,), amount (n,) mm, whether a clean-up tool can do it (n,), face index
    within its group (n,), group index (n,), and a point near it (n, 3)."""

    reason: NDArray[np.int8]
    amount: Array
    wall: Bools
    face: NDArray[np.int64]
    group: NDArray[np.int64]
    point: Array


class Violation(NamedTuple):
    """The one place that decides against an axis.

    reason : index into `REASONS`;  amount : by how much the limit is missed, mm or rad;  label : of the face in the
    way;  point : (3,) where it happens, nan where that is not known;  uv : (2,) of the contact;  distance : its
    component's signed distance, mm, nan where that is not known;  words : what a limit itself says.
    """

    reason: int
    amount: float
    label: str = ""
    point: Array = np.full(3, np.nan)
    uv: Array = np.zeros(2)
    distance: float = np.nan
    words: str = ""
