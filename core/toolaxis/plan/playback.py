"""A program as time goes by: at each moment the motion of which operation the tool is on, or which index move."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS, Plan
from toolaxis.plan.timing import MachiningTime

Array = NDArray[np.float64]

#: Share of all cutting time that an index move takes at least of a playback, so that it can be watched.
WATCHED = 1 / 30
#: Turn of the tool axis that counts as an index move.
_TURN = 1e-9
#: A playback of nothing but points still has a length, s.
_NO_TIME = 1e-6


@dataclass(frozen=True, eq=False)
class TimedPath:
    """A path and when the tool is where on it.

    Attributes
    ----------
    path : ToolPath
    arrival : (n,) array
        Time at each point, s, zero at the first.
    """

    path: ToolPath
    arrival: Array

    @classmethod
    def at_rates(cls, path: ToolPath, feedrate: float, rapid: float, time: MachiningTime | None = None) -> "TimedPath":
        """A path at its rates: links at the rapid rate, everything else at the feed rate.

        Parameters
        ----------
        path : ToolPath
        feedrate, rapid : float
            mm/min
        time : MachiningTime, optional
            What the machine takes for each kind of motion: motions of a kind are slowed down alike to take that.

        Raises
        ------
        InvalidInput
            When a rate is not above zero, or the path has no point.
        """
        if not feedrate > 0:
            raise InvalidInput(f"feed rate is {feedrate:g} mm/min: it must be above zero")
        if not rapid > 0:
            raise InvalidInput(f"rapid rate is {rapid:g} mm/min: it must be above zero")
        if not len(path.cl):
            raise InvalidInput("the path has no points: plan the operation again")
        kind = path.kind[1:]
        took = np.linalg.norm(np.diff(path.cl, axis=0), axis=1) * np.where(kind == Motion.LINK, 60 / rapid,
                                                                           60 / feedrate)
        if time is not None:
            for one, seconds in ((Motion.CUT, time.cut), (Motion.ENTRY, time.entry), (Motion.EXIT, time.exit),
                                 (Motion.LINK, time.link)):
                some = kind == one
                whole = float(took[some].sum())
                took[some] = took[some] * (seconds / whole) if whole > 0 else seconds / max(int(some.sum()), 1)
        return cls(path, np.concatenate([[0.0], np.cumsum(took)]))

    @property
    def seconds(self) -> float:
        """Time of the whole path, s."""
        return float(self.arrival[-1])

    @property
    def cutting(self) -> float:
        """Time of the cuts alone, s."""
        return float(np.diff(self.arrival)[self.path.kind[1:] == Motion.CUT].sum())

    def motion(self, seconds: float) -> tuple[int, float]:
        """The motion at a time, and the share of it that is done; motion k ends at point k.

        Parameters
        ----------
        seconds : float
            Since the first point; held inside the path.
        """
        last = len(self.arrival) - 1
        if last < 1:
            return 0, 1.0
        seconds = min(max(seconds, 0.0), self.seconds)
        k = min(max(int(np.searchsorted(self.arrival, seconds, side="right")), 1), last)
        took = float(self.arrival[k] - self.arrival[k - 1])
        return k, 1.0 if took <= 0 else min((seconds - float(self.arrival[k - 1])) / took, 1.0)


@dataclass(frozen=True)
class Moment:
    """Where a playback stands.

    Attributes
    ----------
    operation : int
        Number of the path, from 0; on an index move the one that it comes from.
    between : bool
        Whether it is the index move to the next path.
    motion : int
        Of the path; its last one on an index move.
    share : float
        Of the motion, or of the index move, that is done, 0 to 1.
    seconds : float
        Time since the first motion, s.
    """

    operation: int
    between: bool
    motion: int
    share: float
    seconds: float


@dataclass(frozen=True, eq=False)
class Playback:
    """Paths one after the other with index moves between them.

    A place in a playback is a share of its length, 0 to 1.  Index moves are `WATCHED` long at least, however little
    time they take.

    Attributes
    ----------
    paths : tuple of TimedPath
    between : tuple of float
        Time of each index move, s; one less than there are paths.

    Raises
    ------
    InvalidInput
        When there is no path, or the index moves do not go between them.
    """

    paths: tuple[TimedPath, ...]
    between: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.paths or len(self.between) != len(self.paths) - 1:
            raise InvalidInput(f"{len(self.paths)} paths have {len(self.between)} index moves between them: "
                               f"{max(len(self.paths) - 1, 0)} are needed, and one path at least")

    @property
    def seconds(self) -> float:
        """Time of everything, s."""
        return self.cutting + self.moving

    @property
    def cutting(self) -> float:
        """Time of the cuts, s."""
        return sum(one.cutting for one in self.paths)

    @property
    def moving(self) -> float:
        """Time of everything else, s: lead-in and lead-out, links, index moves, and changes of tool."""
        return sum(one.seconds - one.cutting for one in self.paths) + sum(self.between)

    @cached_property
    def _ends(self) -> tuple[Array, Array]:
        """Where each stretch ends, paths and index moves in turn: on the playback, and in time, s."""
        least = max(WATCHED * sum(one.seconds for one in self.paths), _NO_TIME)
        rows = [(max(self.paths[0].seconds, _NO_TIME), self.paths[0].seconds)]
        for seconds, path in zip(self.between, self.paths[1:], strict=True):
            rows += [(max(seconds, least), seconds), (max(path.seconds, _NO_TIME), path.seconds)]
        spans = np.cumsum(np.array(rows), axis=0)
        return spans[:, 0], spans[:, 1]

    @property
    def length(self) -> float:
        """What a playback takes in real time, s: no less than `seconds`."""
        return float(self._ends[0][-1])

    def at(self, place: float) -> Moment:
        """What goes on at a place.

        Parameters
        ----------
        place : float
            0 to 1.
        """
        ends, times = self._ends
        way = min(max(place, 0.0), 1.0) * float(ends[-1])
        stretch = min(int(np.searchsorted(ends, way, side="right")), len(ends) - 1)
        begin, clock = (float(rows[stretch - 1]) if stretch else 0.0 for rows in (ends, times))
        share = min(max((way - begin) / (float(ends[stretch]) - begin), 0.0), 1.0)
        seconds = clock + share * (float(times[stretch]) - clock)
        k = stretch // 2
        if stretch % 2:
            return Moment(k, True, len(self.paths[k].arrival) - 1, share, seconds)
        return Moment(k, False, *self.paths[k].motion(share * self.paths[k].seconds), seconds)

    def place_of(self, operation: int, motion: int, share: float = 0.5) -> float:
        """The place of a motion of a path, 0 to 1.

        Parameters
        ----------
        operation, motion : int
        share : float
            Of the motion, 0 to 1.
        """
        ends, path = self._ends[0], self.paths[operation]
        begin, end = (float(ends[2 * operation - 1]) if operation else 0.0), float(ends[2 * operation])
        k = min(max(motion, 0), len(path.arrival) - 1)
        before = float(path.arrival[max(k - 1, 0)])
        done = before + share * (float(path.arrival[k]) - before)
        part = done / path.seconds if path.seconds > 0 else k / max(len(path.arrival) - 1, 1)
        return (begin + part * (end - begin)) / float(ends[-1])

    def place_between(self, operation: int, share: float = 0.5) -> float:
        """The place of the index move after a path, 0 to 1.

        Parameters
        ----------
        operation : int
        share : float
            Of the index move, 0 to 1.
        """
        begin, end = (float(row) for row in self._ends[0][2 * operation:2 * operation + 2])
        return (begin + share * (end - begin)) / self.length


def seconds_between(axes: Sequence[Array], other_tool: bool, index: float | None = None) -> float:
    """Time from one operation to the next, s.

    Parameters
    ----------
    axes : two (3,) arrays
        Tool axes of both.
    other_tool : bool
        Whether the tool is changed.
    index : float, optional
        Time of the index move on the machine, s; `INDEX_SECONDS` for another axis unless given.
    """
    if index is None:
        turns = bool(np.abs(np.subtract(*axes)).max() > _TURN)
        index = INDEX_SECONDS if turns else 0.0
    return index + (CHANGE_SECONDS if other_tool else 0.0)


def playback_of(plan: Plan) -> Playback:
    """All operations of a plan that have a path, in their order; its time is that of the plan.

    Parameters
    ----------
    plan : Plan

    Raises
    ------
    InvalidInput
        When no operation has a path.
    """
    done = [op for op in plan.operations if op.path is not None]
    paths, between = [], []
    for k, op in enumerate(done):
        assert op.path is not None
        paths.append(TimedPath.at_rates(op.path, op.tool.feedrate or plan.inputs.feedrate, plan.inputs.rapid, op.time))
        if k:
            axes = [one.path.axis[0] if one.orientation.axis is None else one.orientation.axis
                    for one in done[k - 1:k + 1] if one.path is not None]
            index = op.time.index if plan.timed and op.time is not None else None
            between.append(seconds_between(axes, op.tool != done[k - 1].tool, index))
    return Playback(tuple(paths), tuple(between))
