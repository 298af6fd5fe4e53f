"""Table, trunnion and head of a machine against each other, part and tool while its rotary axes turn along a path.

Motions whose rotary axes stand within a small range are held apart as one, at the middle of the range, and what turning
to its ends may carry anything towards anything else is asked of the distance besides.  Where that is too much the range
is split, and in the end the motions themselves.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.indexing import arms
from toolaxis.contact.machinery import Meeting, Surroundings, meeting_on
from toolaxis.machine.mounting import Mounting
from toolaxis.numeric.convex import Convex, segments
from toolaxis.progress import NO_PROGRESS, Progress

Array = NDArray[np.float64]

#: Play that turning may have before distances are looked at, and below which ranges are not split any more, mm.
COARSE, FINE = 30.0, 0.05


@dataclass(frozen=True, eq=False)
class Motions:
    """Straight motions of all machine axes.

    Attributes
    ----------
    linear : (n, 2, 3) array
        Linear coordinates at both ends, mm.
    rotary : (n, 2, m) array
        rad
    arrival : (n,) array of int
        Point of the path at which each arrives.
    """

    linear: Array
    rotary: Array
    arrival: NDArray[np.int64]

    def rows(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> "Motions":
        """Some of them."""
        return Motions(self.linear[chosen], self.rotary[chosen], self.arrival[chosen])

    def halves(self) -> "Motions":
        """Each as two."""
        parts = [np.stack([ends[:, 0], ends.mean(axis=1), ends.mean(axis=1), ends[:, 1]], axis=1)
                 for ends in (self.linear, self.rotary)]
        linear, rotary = (rows.reshape(-1, 2, rows.shape[-1]) for rows in parts)
        return Motions(linear, rotary, np.repeat(self.arrival, 2))


def motions(linear: Array, rotary: Array, arrival: NDArray[np.int64]) -> Motions:
    """The motions between points.

    Parameters
    ----------
    linear : (n, 3) array
        mm
    rotary : (n, m) array
        rad
    arrival : (n,) array of int
        Point of the path at which the motion arrives that ends at each point.
    """
    start, end = (slice(-1), slice(1, None)) if len(linear) > 1 else (slice(None), slice(None))
    return Motions(np.stack([linear[start], linear[end]], axis=1), np.stack([rotary[start], rotary[end]], axis=1),
                   arrival[end])


def meeting_in_motion(mounting: Mounting, way: Motions, around: Surroundings,
                      progress: Progress = NO_PROGRESS) -> tuple[Meeting, Array] | None:
    """Where anything on the spindle's side comes too near to anything on the table's while all axes move.

    Parameters
    ----------
    mounting : Mounting
        With bodies, a place of the part and a tool length.
    way : Motions
    around : Surroundings
        The tool is not held against the part: passes have been.
    progress : Progress

    Returns
    -------
    (Meeting, (m,) array) or None
        The meeting, with the point of the path at which its motion arrives and the rotary angles, rad; None where all
        distances are proven to be the required one or more.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    A point that is at most r from an axis moves by r times its turn at most, whatever the other axes do; so no distance
    changes by more than the sum over all axes of their turns times the reach of what they carry.
    """
    reach, left, total = arms(mounting, around), [way], max(len(way.arrival), 1)
    done = 0
    while left:
        some = left.pop()
        low, high = some.rotary.min(axis=(0, 1)), some.rotary.max(axis=(0, 1))
        play = float((high - low) @ reach) / 2
        progress.report("bodies of the machine", done, total)
        if play <= COARSE:
            middle = (low + high) / 2
            found = meeting_on(mounting, middle, _ways(some), around, with_tool=False, most=around.required + play)
            if found is None:
                done = min(done + len(some.arrival), total)
                continue
            if found.distance + play < around.required or play <= FINE:
                at = int(some.arrival[min(found.motion, len(some.arrival) - 1)])
                return Meeting(found.one, found.other, found.distance, at), middle
        left += _split(some, reach)
    return None


def _split(some: Motions, reach: Array) -> list[Motions]:
    """Motions in two sets, by the axis along which their middles differ most; as halves where they turn more."""
    middle = some.rotary.mean(axis=1)
    apart, turn = np.ptp(middle, axis=0) * reach, np.abs(some.rotary[:, 1] - some.rotary[:, 0]) @ reach
    if apart.max(initial=0.0) < turn.max(initial=0.0):
        return [some.halves()] if len(some.arrival) > 1 else [some.halves().rows(np.array([k])) for k in (0, 1)]
    axis = int(np.argmax(apart))
    near = middle[:, axis] <= (middle[:, axis].min() + middle[:, axis].max()) / 2
    return [some.rows(~near), some.rows(near)]


def _ways(some: Motions) -> Convex:
    """Motions as bodies in linear coordinates."""
    lines = segments(np.zeros((len(some.arrival) + 1, 3)))
    spread = np.zeros((len(some.arrival), 3, 3))
    spread[:, 0] = (some.linear[:, 1] - some.linear[:, 0]) / 2
    return lines._replace(centre=some.linear.mean(axis=1)[:, None], spread=spread)
