"""Machining time of tool paths with a fixed tool axis, links and index moves included."""

from dataclasses import dataclass
from math import inf, isfinite, isnan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feed.constraints import linear_bounds
from toolaxis.feed.polyline import PolylineSchedule, schedule_polyline
from toolaxis.feed.profile import travel_time
from toolaxis.machine.configurations import Machine
from toolaxis.machine.kinematics import linear_coordinates, rotary_angles
from toolaxis.numeric.vectors import angle_between

Array = NDArray[np.float64]

#: How far the axes of a path may differ and still count as one, rad.
FIXED = 1e-6

#: Steps shorter than this are no motion, mm.
NO_STEP = 1e-9


@dataclass(frozen=True)
class Feeds:
    """What is programmed.

    Attributes
    ----------
    cut : float
        Feed of the tool's tip while cutting, mm/s.
    approach : float or None
        Feed of entries and exits, mm/s; that of cutting unless given.
    rapid : float
        Greatest velocity of links, mm/s; as fast as the axes go unless given.
    tolerance : float
        How far the controller may cut a corner, mm; 0 for exact stops.

    Raises
    ------
    InvalidInput
        When one is not above zero, or the tolerance below it.
    """

    cut: float
    approach: float | None = None
    rapid: float = inf
    tolerance: float = 0.01

    def __post_init__(self) -> None:
        for name, value in (("cut", self.cut), ("approach", self.approach), ("rapid", self.rapid)):
            if value is not None and (isnan(value) or value <= 0 or (name != "rapid" and not isfinite(value))):
                raise InvalidInput(f"feed {name} is {value} mm/s: it must be a number above zero")
        if not (isfinite(self.tolerance) and self.tolerance >= 0):
            raise InvalidInput(f"corner tolerance is {self.tolerance} mm: it must be a number, not below zero")

    def of(self, kinds: ArrayLike) -> Array:
        """Feed of each motion, (n,) mm/s.

        Parameters
        ----------
        kinds : (n,) array_like of Motion
        """
        approach = self.cut if self.approach is None else self.approach
        table = np.array([self.cut, approach, approach, self.rapid])
        return np.asarray(table[np.asarray(kinds, dtype=int)])


@dataclass(frozen=True)
class MachiningTime:
    """Where the time goes, s."""

    cut: float = 0.0
    entry: float = 0.0
    exit: float = 0.0
    link: float = 0.0
    index: float = 0.0

    @property
    def total(self) -> float:
        """All of it, s."""
        return self.cut + self.entry + self.exit + self.link + self.index

    def __add__(self, other: "MachiningTime") -> "MachiningTime":
        return MachiningTime(self.cut + other.cut, self.entry + other.entry, self.exit + other.exit,
                             self.link + other.link, self.index + other.index)


def path_schedule(machine: Machine, path: ToolPath, feeds: Feeds, rotary: ArrayLike | None = None,
                  table_from_part: ArrayLike | None = None) -> tuple[PolylineSchedule, NDArray[np.int8]]:
    """The schedule of a path with a fixed tool axis, and the kind of motion of each of its segments.

    Parameters
    ----------
    machine : Machine
        With velocity, acceleration and jerk of its linear axes.
    path : ToolPath
        With one axis.
    feeds : Feeds
    rotary : (m,) array_like, optional
        Rotary angles, rad; unless given, those of the solution within limits that are smallest in sum.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.

    Raises
    ------
    InvalidInput
        When the path has no motion, or the machine cannot take its axis.
    UnsupportedGeometry
        When the axis varies.
    """
    steps = np.linalg.norm(np.diff(path.cl, axis=0), axis=1)
    moving = np.concatenate([[True], steps > NO_STEP])
    tips, kinds = path.cl[moving], path.kind[moving][1:]
    if len(tips) < 2:
        raise InvalidInput(f"the path has {len(path.cl)} points and no motion between them: nothing can be timed")
    if angle_between(path.axis, path.axis[0]).max() > FIXED:
        raise UnsupportedGeometry("the tool axis varies along the path: only paths with a fixed axis are timed")
    angles = _angles(machine, path.axis[0], table_from_part) if rotary is None else np.asarray(rotary, dtype=float)
    joints = linear_coordinates(machine, tips, angles, table_from_part=table_from_part)
    return schedule_polyline(joints, tips, feeds.of(kinds), linear_bounds(machine), feeds.tolerance), kinds


def machining_time(machine: Machine, path: ToolPath, feeds: Feeds, rotary: ArrayLike | None = None,
                   table_from_part: ArrayLike | None = None) -> MachiningTime:
    """Time of a path with a fixed tool axis from rest to rest, by kind of motion.

    Parameters
    ----------
    machine, path, feeds, rotary, table_from_part
        As for `path_schedule`.
    """
    schedule, kinds = path_schedule(machine, path, feeds, rotary, table_from_part)
    times = schedule.segment_times
    by_kind = {kind: float(times[kinds == kind].sum()) for kind in Motion}
    return MachiningTime(by_kind[Motion.CUT], by_kind[Motion.ENTRY], by_kind[Motion.EXIT], by_kind[Motion.LINK])


def index_time(machine: Machine, start: ArrayLike, end: ArrayLike, by_hand: float | None = None) -> float:
    """Time to turn the rotary axes from rest to rest, all at once, s.

    Parameters
    ----------
    machine : Machine
    start, end : (m,) array_like
        Rotary angles, rad; turned the way the numbers say, not the shorter one.
    by_hand : float, optional
        What it takes to set axes by hand, s; needed where one of them turns.

    Raises
    ------
    InvalidInput
        When shapes do not fit, an axis has no acceleration or jerk, or the time by hand is missing.
    """
    begin, stop = (np.asarray(value, dtype=float) for value in (start, end))
    if begin.shape != (len(machine.rotary),) or stop.shape != begin.shape:
        raise InvalidInput(f"rotary angles are {begin.tolist()} and {stop.tolist()}: {len(machine.rotary)} each are "
                           "needed")
    slowest = 0.0
    for axis, turn in zip(machine.rotary, np.abs(stop - begin), strict=True):
        if turn == 0:
            continue
        if axis.drive is None:
            if by_hand is None or not (isfinite(by_hand) and by_hand >= 0):
                raise InvalidInput(f"axis {axis.name} is set by hand and the time for it is {by_hand}: state it in s")
            slowest = max(slowest, by_hand)
        else:
            slowest = max(slowest, float(travel_time(turn, *axis.drive.levels(axis.name))))
    return slowest


def _angles(machine: Machine, axis: Array, table_from_part: ArrayLike | None) -> Array:
    found = rotary_angles(machine, axis, table_from_part=table_from_part)
    if not found.within.any():
        limits = "its rotary limits" if found.reached.any() else "what its rotary axes can turn to"
        raise InvalidInput(f"tool axis {np.round(axis, 6).tolist()} is outside {limits} on machine {machine.name!r}: "
                           "choose another axis, work offset or machine")
    sizes = np.where(found.within[0], np.abs(found.joints[0]).sum(axis=-1), np.inf)
    return np.asarray(found.joints[0, int(np.argmin(sizes))])
