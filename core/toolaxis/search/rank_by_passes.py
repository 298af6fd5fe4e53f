"""Between axes that counts, or an estimate of time, cannot tell apart, the passes really made decide."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feed.fixed_axis_time import machining_time
from toolaxis.plan.choices import FEEDS, FIELD
from toolaxis.search.cost import MachiningCost
from toolaxis.search.local_search import CountedAxis

Array = NDArray[np.float64]

#: How far an estimate of time is doubted.
_DOUBTED = 0.2
#: Passes up to which a count is doubted: whole passes and how far they run out make up much of them.
_FEW = 12.0
#: Axes whose passes are made at most, for their time and for their length or number.
_TIMED, _MADE = 4, 6
#: Values made that are closer than this are ties.
_TIE = 0.001


def least_made(worth: MachiningCost, found: list[CountedAxis],
               made: Callable[[Array, str], ToolPath]) -> list[CountedAxis]:
    """Candidates with those first that may be the best one, in the order of what their passes take when made.

    For the objective "time" these are the ones of nearly the least estimate.  For others, where the best of few passes
    is sought, those that count less than the best one so far takes and leave no more to clean-up than the first; ties
    stay in their order.  A face of many passes keeps the order of the counts, unless they lie in a field: there counts
    are those of a coarse one.

    Parameters
    ----------
    worth : MachiningCost
    found : list of CountedAxis
        Best first.
    made : callable
        Lays the passes of an axis and a feed.
    """
    timed = worth.pace is not None
    told = found and found[0].passes > _FEW and worth.passes != FIELD
    if len(found) < 2 or (not timed and told):
        return found
    few: list[CountedAxis] = []
    values: list[float] = []
    fair = [one for one in found if timed or one.unreached <= found[0].unreached]
    for one in fair[:_TIMED if timed else _MADE]:
        if one.value > ((1 + _DOUBTED) * found[0].value if timed else min(values, default=np.inf)):
            break
        few.append(one)
        values.append(_cost_of_passes(worth, one, made) + _left(worth, one))
    tied = [k for k, value in enumerate(values) if not timed and value <= (1 + _TIE) * min(values)]
    order = [*tied, *(int(k) for k in np.argsort(values, kind="stable") if k not in tied)]
    return [few[k] for k in order] + [one for one in found if all(one is not other for other in few)]


def _left(worth: MachiningCost, one: CountedAxis) -> float:
    """What is charged for what stays; passes made leave it out already."""
    charge = worth.charge(one.length, one.unreached)
    return one.value / charge * (charge - (1 - one.unreached))


def _cost_of_passes(worth: MachiningCost, one: CountedAxis, made: Callable[[Array, str], ToolPath]) -> float:
    """Time, cutting length or number of the passes made; inf for what cannot be made, refused with its reason later."""
    try:
        path, pace = made(one.axis, FEEDS[one.feed]), worth.pace
        if pace is not None:
            return machining_time(pace.mounting.machine, path, pace.feeds,
                                  table_from_part=pace.mounting.table_from_part).path
    except (InvalidInput, UnsupportedGeometry):  # no strip, outside the ranges, or no planes there
        return np.inf
    return path.length(Motion.CUT) if worth.objective == "length" else float(path.passes)
