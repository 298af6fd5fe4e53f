"""Where a tip all but stands still while it cuts, because the axes of its machine have to turn too fast to follow."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.feed.time_optimal import CurveSchedule

Array = NDArray[np.float64]

#: Share of the programmed feed below which a tip crawls, and how long it may, s: between stops it is that slow for some
#: hundredths.
SLOW, LONG = 0.05, 0.2


@dataclass(frozen=True)
class FeedDrop:
    """A place at which the tip crawls.

    Attributes
    ----------
    seconds : float
        How long.
    way : float
        How far it gets in that time, mm.
    place : tuple of float
        Where, mm.
    """

    seconds: float
    way: float
    place: tuple[float, float, float]


def crawl(found: CurveSchedule, feed: float, tips: Array) -> FeedDrop | None:
    """Where a cut is slower than `SLOW` times its feed for longest; None where that takes no longer than `LONG`.

    Parameters
    ----------
    found : CurveSchedule
        With the way of the tip, mm, as its path parameter.
    feed : float
        Programmed, mm/s.
    tips : (n, 3) array
        Points of the cut, mm.
    """
    pace = np.abs(found.states[:, 1])
    slow = np.concatenate([[False], np.maximum(pace[1:], pace[:-1]) < SLOW * feed, [False]])
    edges = np.flatnonzero(np.diff(slow.astype(np.int8))).reshape(-1, 2)
    spans = found.times[edges[:, 1]] - found.times[edges[:, 0]]
    if not len(spans) or not spans.max() > LONG:
        return None
    k = int(np.argmax(spans))
    a, b = found.states[edges[k], 0]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))])
    x, y, z = (float(np.interp((a + b) / 2, way, column)) for column in tips.T)
    return FeedDrop(float(spans[k]), float(abs(b - a)), (x, y, z))
