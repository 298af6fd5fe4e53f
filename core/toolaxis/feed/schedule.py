"""Machining time of tool paths with a fixed tool axis, links and index moves included."""

from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite, isnan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feed.constraints import linear_bounds
from toolaxis.feed.curve import schedule_curve
from toolaxis.feed.polyline import PolylineSchedule, schedule_polyline
from toolaxis.feed.profile import travel_time
from toolaxis.machine.configurations import Machine
from toolaxis.machine.kinematics import linear_coordinates, rotary_angles
from toolaxis.numeric.vectors import angle_between, unit

Array = NDArray[np.float64]

#: How far the axes of a path may differ and still count as one, rad.
FIXED = 1e-6

#: Change of direction between neighbouring segments at which a smooth cut ends, rad.
CORNER = 0.25

#: Steps shorter than this are no motion, mm.
NO_STEP = 1e-9

#: Points from which on a smooth cut is planned as a curve.
_CURVE = 6


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
    smooth : bool
        Whether the controller follows cuts as smooth curves through their points, as one with splines or a compressor
        does; they then start and end at rest, and so does every piece between corners of more than `CORNER`.

    Raises
    ------
    InvalidInput
        When one is not above zero, or the tolerance below it.
    """

    cut: float
    approach: float | None = None
    rapid: float = inf
    tolerance: float = 0.01
    smooth: bool = False

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
    joints, tips, kinds = _moves(machine, path, rotary, table_from_part)
    return schedule_polyline(joints, tips, feeds.of(kinds), linear_bounds(machine), feeds.tolerance), kinds


def _moves(machine: Machine, path: ToolPath, rotary: ArrayLike | None,
           table_from_part: ArrayLike | None) -> tuple[Array, Array, NDArray[np.int8]]:
    """Linear coordinates and tips where the path bends, and the kind of each motion between them."""
    steps = np.linalg.norm(np.diff(path.cl, axis=0), axis=1)
    moving = np.concatenate([[True], steps > NO_STEP])
    tips, kinds = path.cl[moving], path.kind[moving][1:]
    if len(tips) < 2:
        raise InvalidInput(f"the path has {len(path.cl)} points and no motion between them: nothing can be timed")
    if angle_between(path.axis, path.axis[0]).max() > FIXED:
        raise UnsupportedGeometry("the tool axis varies along the path: only paths with a fixed axis are timed")
    angles = _angles(machine, path.axis[0], table_from_part) if rotary is None else np.asarray(rotary, dtype=float)
    return linear_coordinates(machine, tips, angles, table_from_part=table_from_part), tips, kinds


def machining_time(machine: Machine, path: ToolPath, feeds: Feeds, rotary: ArrayLike | None = None,
                   table_from_part: ArrayLike | None = None) -> MachiningTime:
    """Time of a path with a fixed tool axis from rest to rest, by kind of motion.

    Parameters
    ----------
    machine, path, feeds, rotary, table_from_part
        As for `path_schedule`.
    """
    joints, tips, kinds = _moves(machine, path, rotary, table_from_part)
    bounds, wanted = linear_bounds(machine), feeds.of(kinds)
    by_kind = dict.fromkeys(Motion, 0.0)
    for begin, end in _pieces(tips, kinds) if feeds.smooth else [(0, len(kinds))]:
        here, there = joints[begin:end + 1], tips[begin:end + 1]
        if feeds.smooth and kinds[begin] == Motion.CUT and len(there) >= _CURVE:
            by_kind[Motion.CUT] += schedule_curve(here, there, feeds.cut, bounds).duration
            continue
        times = schedule_polyline(here, there, wanted[begin:end], bounds, feeds.tolerance).segment_times
        for kind in Motion:
            by_kind[kind] += float(times[kinds[begin:end] == kind].sum())
    return MachiningTime(by_kind[Motion.CUT], by_kind[Motion.ENTRY], by_kind[Motion.EXIT], by_kind[Motion.LINK])


def _pieces(tips: Array, kinds: NDArray[np.int8]) -> list[tuple[int, int]]:
    """Ranges of motions: cuts between corners, and what lies between cuts."""
    ways = unit(np.diff(tips, axis=0))
    corner = angle_between(ways[1:], ways[:-1]) > CORNER
    cut = kinds == Motion.CUT
    ends = np.flatnonzero((cut[1:] != cut[:-1]) | (cut[1:] & cut[:-1] & corner)) + 1
    edges = [0, *ends.tolist(), len(kinds)]
    return list(pairwise(edges))


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
