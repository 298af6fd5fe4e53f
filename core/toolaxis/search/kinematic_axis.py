"""The fixed axis at whose rotary angles the linear axes of a machine together do most along the passes of a face.

Of the two feeds each gets its own set-up: the passes aligned with a corner of the jerk polytope where one of these axes
is free of gouge and collision and within the machine's limits, else the best axis that is.  Equal set-ups are decided
by what the search makes least, then by how little the rotary axes turn.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.contact.placement import tips
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.violations import FREE, Violation
from toolaxis.machine.feed_polytopes import Level, box, check_jerk_stated
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between, as_rows
from toolaxis.path.sampling import sample_passes
from toolaxis.plan.choices import FEEDS
from toolaxis.search.cost import MachiningCost
from toolaxis.search.direction_grid import spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.hemisphere import REPELLED, SPACING, TIE, frame_of, search
from toolaxis.search.kinematic_setup import (
    PassSegment,
    are_angles_allowed,
    common_feed,
    find_best_angles,
    pass_segments,
    reach_along_feed,
)
from toolaxis.search.local_search import CountedAxis, proven, sound
from toolaxis.search.machine_limits import mounting_of

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: How often the equal set-ups of a feed may all be refused by closer looks before its search ends without one.
_HUNTS = 8
#: Equal axes that are counted at most, those that screening finds cheapest.
_COUNTED = 8
#: How often a set-up is found again for the way that tips go with the one before.
_FOLLOWED = 2
#: Components of axes that are the same but for rounding.
_SAME = 1e-9
#: Steps along a pass that count as none, mm; ends of a pass that meet, as a share of its length.
_STILL, _CLOSED = 1e-9, 1e-6


@dataclass(frozen=True, eq=False)
class FreeAxes:
    """The domain of axes that limits, visibility, gouge and collision leave, as far as screening knows.

    Attributes
    ----------
    ledger : AxisTable
        Receives every axis that is looked at.
    """

    ledger: AxisTable

    def holds(self, axes: ArrayLike, passes: Sequence[PassSegment]) -> Bools:
        """Whether axes are free at all contacts that screening looks at, (k,)."""
        rows = as_rows(axes, 3, "axis")
        good = self.ledger.feasibility.quick(rows)[0] == FREE
        entered = self.ledger.look(rows[good])
        good[good] = self.ledger.reason[entered] == FREE
        return np.asarray(good)


def by_jerk(ledger: AxisTable) -> list[CountedAxis]:
    """The axis of the best set-up for each feed, the one that is cheaper first.

    Parameters
    ----------
    ledger : AxisTable
        Its limits hold the machine; receives everything that is looked at.

    Returns
    -------
    list of CountedAxis; empty when no free axis was found.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    InvalidInput
        When there is no machine, it does not state the jerk of its linear axes, or no pass has a direction.

    Notes
    -----
    **Source**: [grandguillaume2021] Sec. 4.4; the domain of lead and tilt, given there, is that of the free axes here,
    and of equal set-ups, of which the paper takes the one that turns least, the cheapest is taken.
    """
    _mounting(ledger)
    ledger.lay(spiral(frame_of(ledger.feasibility.normals), SPACING))  # for the map, and where little is free
    found = _best_of_feeds(ledger)
    if not found and search(ledger):  # the grids of rotary angles and the spiral stepped over what is free
        found = _best_of_feeds(ledger)
    return sorted(found, key=lambda one: one.value)


def next_by_jerk(ledger: AxisTable, refused: CountedAxis, found: Violation, attempt: int = 0) -> CountedAxis | None:
    """The best set-up that is left for a feed after the proof of the passes refused one.

    Parameters
    ----------
    ledger : AxisTable
    refused : CountedAxis
    found : Violation
    attempt : int
        How often this was done before: the neighbourhood that is left alone grows fourfold each time.
    """
    ledger.close(refused.axis, REPELLED * 4**attempt, found)
    return _best_axis(ledger, refused.feed)


def describe_jerk(ledger: AxisTable, axis: Array, path: ToolPath) -> str:
    """What the linear axes do along passes that were made, in words.

    Parameters
    ----------
    ledger : AxisTable
    axis : (3,) array
        Of the passes.
    path : ToolPath
    """
    mounting = _mounting(ledger)
    feed = common_feed(pass_segments(path))
    rotary = mounting.solutions(axis)[:1]
    most = float(np.linalg.norm(box(mounting.machine, Level.JERK)))
    here = float(reach_along_feed(mounting, Level.JERK, feed, rotary)[0])
    return (f"jerk along the passes: {here / 1000:.2f} m/s3 of the {most / 1000:.2f} m/s3 that the linear axes of "
            f"{mounting.machine.name} do together{mounting.at(rotary[0])}")


def _mounting(ledger: AxisTable) -> Mounting:
    mounting = mounting_of(ledger.feasibility.limits)
    check_jerk_stated(None if mounting is None else mounting.machine, "name a machine")
    assert mounting is not None
    return mounting


def _best_of_feeds(ledger: AxisTable) -> list[CountedAxis]:
    feeds = [k for k, name in enumerate(FEEDS) if ledger.worth.feed in (None, name)]
    directed = [k for k in feeds if _passes_with_direction(ledger.worth, k)]
    if not directed:
        raise InvalidInput(f"the passes of face {ledger.worth.face.label} end where they began and have no mean feed "
                           "direction: choose another method")
    found = (_best_axis(ledger, k) for k in directed)
    return [one for one in found if one is not None]


def _best_axis(ledger: AxisTable, feed: int) -> CountedAxis | None:
    """The cheapest axis of the best set-ups for a feed that stands closer looks; None when none is left."""
    starts = [_mounting(ledger).solutions(axis) for axis in ledger.axes[ledger.reason == FREE]]
    for _ in range(_HUNTS):
        ledger.progress.check()
        found = _find_angles(ledger, feed, None, np.concatenate(starts) if starts else None)
        if not len(found):
            return None
        best = _cheapest(ledger, found, feed)
        if best is not None:
            return _follow_tips(ledger, best)
    return None


def _find_angles(ledger: AxisTable, feed: int, axis: Array | None, starts: Array | None = None) -> Array:
    """Equally good rotary angles for a feed whose tips are those with an axis, if one is given, (k, m) rad."""
    mounting, domain = _mounting(ledger), FreeAxes(ledger)
    passes = _passes_with_direction(ledger.worth, feed, axis)
    return find_best_angles(mounting, Level.JERK, common_feed(passes),
                            lambda rows: are_angles_allowed(mounting, rows, passes, domain), starts).rows


def _follow_tips(ledger: AxisTable, one: CountedAxis) -> CountedAxis:
    """The set-up next to one for the way of the tips with its own axis; the same where that is refused, or of a ball.

    On a cutter with a flat bottom the contact wanders, and how it does depends on the axis.
    """
    if ledger.worth.tool.flat_radius == 0:
        return one
    for _ in range(_FOLLOWED):
        rotary = _find_angles(ledger, one.feed, one.axis)
        if not len(rotary):
            break
        axes = np.array([_mounting(ledger).axis_at(angles) for angles in rotary])
        near = _row_of(ledger, axes[int(np.argmin(angle_between(axes, one.axis)))])
        again = _count_proven(ledger, near, one.feed)
        if again is None:
            break
        one = again
    return one


def _cheapest(ledger: AxisTable, rotary: Array, feed: int) -> CountedAxis | None:
    """The cheapest of equal set-ups by exact count, of ties the one that turns least; None when all are refused."""
    rotary = rotary[np.argsort(np.round(np.abs(rotary).sum(axis=1), 9), kind="stable")]
    axes = np.array([_mounting(ledger).axis_at(angles) for angles in rotary])
    _, first = np.unique(np.round(axes, 9) + 0.0, axis=0, return_index=True)
    first = np.sort(first)  # two pairs of rotary angles give one axis: the one that turns less stands for it
    rows = [_row_of(ledger, axis) for axis in axes[first]]
    order = np.argsort(ledger.values[rows, feed], kind="stable")[:_COUNTED]
    every = (_count_proven(ledger, rows[k], feed) for k in np.sort(order))
    counted = [one for one in every if one is not None]
    least = min((one.value for one in counted), default=np.inf)
    return next((one for one in counted if one.value <= least * (1 + TIE)), None)


def _count_proven(ledger: AxisTable, row: int, feed: int) -> CountedAxis | None:
    """An axis with its exact value; None, and its neighbourhood closed, where a closer look refuses it."""
    axis = ledger.axes[row]
    if ledger.reason[row] == FREE and sound(ledger, row) and proven(ledger, row):
        unreached = float(ledger.unreached[row])
        return CountedAxis(axis, feed, *ledger.count(axis, feed, unreached), unreached)
    ledger.close(axis, REPELLED, Violation(int(ledger.reason[row]), float(ledger.amount[row])))
    return None


def _row_of(ledger: AxisTable, axis: Array) -> int:
    """The row of an axis that was looked at, the last one where it was more than once."""
    away = np.abs(ledger.axes - axis).max(axis=1)
    return int(np.flatnonzero(away <= away.min() + _SAME)[-1])


def _passes_with_direction(worth: MachiningCost, feed: int, axis: Array | None = None) -> list[PassSegment]:
    """A few passes of a face that do not end where they began: the tips with an axis, else the rounding's middles."""
    found = []
    for uv in sample_passes(worth.face, feed):
        contacts, normals = worth.face.evaluate(uv).point, worth.face.normal(uv)
        length = np.linalg.norm(np.diff(contacts, axis=0), axis=1).sum()
        if np.linalg.norm(contacts[-1] - contacts[0]) <= _CLOSED * length:
            continue
        way = contacts + (worth.tool.corner_radius + worth.allowance) * normals
        if axis is not None:
            way = tips(contacts, normals, axis, worth.tool, worth.allowance)
        moving = np.concatenate([[True], np.linalg.norm(np.diff(way, axis=0), axis=1) > _STILL])
        found.append(PassSegment(way[moving], normals[moving]))
    return found
