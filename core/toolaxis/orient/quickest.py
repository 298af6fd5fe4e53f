"""Between axes that an estimate of time cannot tell apart the planner of feeds decides, on the very passes."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.schedule import machining_time
from toolaxis.orient.polish import Candidate
from toolaxis.orient.worth import FEEDS, Worth

Array = NDArray[np.float64]

#: How far the estimate is doubted, and how many axes are planned for at most.
_DOUBTED, _PLANNED = 0.2, 4


def quickest(worth: Worth, found: list[Candidate], made: Callable[[Array, str], ToolPath]) -> list[Candidate]:
    """Candidates of nearly the least time in the order of their planned times; as they are for other objectives.

    Parameters
    ----------
    worth : Worth
    found : list of Candidate
        Best first.
    made : callable
        Lays the passes of an axis and a feed.
    """
    pace = worth.pace
    if pace is None or len(found) < 2:
        return found
    few = [one for one in found if one.value <= (1 + _DOUBTED) * found[0].value][:_PLANNED]
    times = []
    for one in few:
        try:
            seconds = machining_time(pace.mounting.machine, made(one.axis, FEEDS[one.feed]), pace.feeds,
                                     table_from_part=pace.mounting.table_from_part).path
        except InvalidInput:  # what leaves no strip, or stands outside the ranges, is refused with its reason later
            seconds = np.inf
        times.append(seconds * worth.charge(one.length, one.unreached))
    return [few[k] for k in np.argsort(times, kind="stable")] + found[len(few):]
