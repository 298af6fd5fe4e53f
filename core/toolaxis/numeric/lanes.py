"""Four numbers side by side inside kernels, on which one instruction works at once.

The numbers are those of the same sums written out one by one, to the last bit: a product that is added is rounded with
the sum where the processor can, as in `toolaxis.numeric.jit.jit_fma`.  Without numba rows of numpy arrays stand for
them.
"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import jit as _compiled

Array = NDArray[np.float64]
#: Four numbers: in compiled code a type of its own.
Lanes: TypeAlias = Any


def _no_lanes() -> Lanes:
    return np.zeros(4)


def _load_lanes(table: Array, i: int, j: int) -> Lanes:
    return table[i, j, :4]


def _add_scaled(total: Lanes, share: float, lanes: Lanes) -> Lanes:
    return total + share * lanes


def _scale(share: float, lanes: Lanes) -> Lanes:
    return share * lanes


def _shrink(share: float, lanes: Lanes) -> Lanes:
    return lanes / share


def _lane(lanes: Lanes, k: int) -> float:
    return float(lanes[k])


no_lanes, load_lanes, add_scaled, scale, shrink, lane = (
    _compiled.lane_parts or (_no_lanes, _load_lanes, _add_scaled, _scale, _shrink, _lane))
