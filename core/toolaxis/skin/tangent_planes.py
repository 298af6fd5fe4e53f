"""Heights beyond an outline from the tangent planes along it: the kernel and its plain twin."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.progress import breathe

Array = NDArray[np.float64]

#: Places taken at once.
_AT_ONCE = 4000


class TangentPlanes(NamedTuple):
    """Tangent planes of a height over a plane, along a border.

    places : (n, 2) array, mm;  height : (n,) array, mm;  slope : (n, 2) array
    near : places nearer than this weigh no more, mm;  rise : what planes rise or fall at most, mm; they level off
    """

    places: Array
    height: Array
    slope: Array
    near: float
    rise: float


def heights_beyond(planes: TangentPlanes, places: Array) -> Array:
    """The mean of the planes at places, (m,) mm, each weighed by one over the fourth power of its distance.

    Parameters
    ----------
    planes : TangentPlanes
    places : (m, 2) array
    """
    found = np.empty(len(places))
    weigh = _mean_heights if _compiled.available else mean_heights_numpy
    for first in range(0, len(places), _AT_ONCE):
        breathe()
        some = slice(first, first + _AT_ONCE)
        weigh(planes, np.ascontiguousarray(places[some], dtype=float), found[some])
    return found


@jit
def _mean_heights(planes: TangentPlanes, places: Array, out: Array) -> None:
    border, height, slope, near, rise = planes
    least = near * near
    for i in range(places.shape[0]):
        total = weights = 0.0
        for k in range(border.shape[0]):
            x, y = places[i, 0] - border[k, 0], places[i, 1] - border[k, 1]
            square = max(x * x + y * y, least)
            weight = 1.0 / (square * square)
            up = x * slope[k, 0] + y * slope[k, 1]
            total += (height[k] + up / (1.0 + abs(up) / rise)) * weight
            weights += weight
        out[i] = total / weights


def mean_heights_numpy(planes: TangentPlanes, places: Array, out: Array) -> None:
    """The plain twin of the kernel.

    Parameters
    ----------
    planes : TangentPlanes
    places : (m, 2) array
    out : (m,) array
        Receives the heights.
    """
    way = places[:, None] - planes.places
    weight = 1.0 / np.maximum((way**2).sum(axis=2), planes.near**2) ** 2
    up = (way * planes.slope).sum(axis=2)
    plane = planes.height + up / (1 + np.abs(up) / planes.rise)
    out[:] = (plane * weight).sum(axis=1) / weight.sum(axis=1)
