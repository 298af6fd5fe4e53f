"""Machining time of tool paths with a fixed tool axis, links and index moves included."""

from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite, isnan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import linear_bounds
from toolaxis.feed.polyline import PolylineSchedule, schedule_polyline
from toolaxis.feed.time_optimal import CurveSchedule, schedule_near
from toolaxis.machine.kinematics import linear_coordinates, rotary_angles
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.plan.timing import MachiningTime

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
        Whether the controller follows cuts as smooth curves within the tolerance of their points, as one with splines
        or a compressor does; they then start and end at rest, and so does every piece between corners of more than
        `CORNER`.
    crossing : float or None
        Feed of links that are not rapid, mm/s; that of rapid ones unless given.

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
    crossing: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("cut", self.cut), ("approach", self.approach), ("rapid", self.rapid),
                            ("crossing", self.crossing)):
            if value is not None and (isnan(value) or value <= 0 or (name in ("cut", "approach") and value == inf)):
                raise InvalidInput(f"feed {name} is {value} mm/s: it must be a number above zero")
        if not (isfinite(self.tolerance) and self.tolerance >= 0):
            raise InvalidInput(f"corner tolerance is {self.tolerance} mm: it must be a number, not below zero")

    def of(self, kinds: ArrayLike, rapid: ArrayLike = True) -> Array:
        """Feed of each motion, (n,) mm/s.

        Parameters
        ----------
        kinds : (n,) array_like of Motion
        rapid : (n,) array_like of bool
            Which links are rapid.
        """
        approach = self.cut if self.approach is None else self.approach
        table = np.array([self.cut, approach, approach, self.rapid if self.crossing is None else self.crossing])
        numbers = np.asarray(kinds, dtype=int)
        return np.where((numbers == Motion.LINK) & np.asarray(rapid, dtype=bool), self.rapid, table[numbers])


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
    moves = _moves(machine, path, rotary, table_from_part)
    feeds_of = feeds.of(moves.kinds, moves.rapid)
    return schedule_polyline(moves.joints, moves.tips, feeds_of, linear_bounds(machine), feeds.tolerance), moves.kinds


class _PathMoves(NamedTuple):
    """Linear coordinates and tips where a path bends, and kind and rapidity of each motion between them."""

    joints: Array
    tips: Array
    kinds: NDArray[np.int8]
    rapid: NDArray[np.bool_]


def _moves(machine: Machine, path: ToolPath, rotary: ArrayLike | None, table_from_part: ArrayLike | None) -> _PathMoves:
    steps = np.linalg.norm(np.diff(path.cl, axis=0), axis=1)
    moving = np.concatenate([[True], steps > NO_STEP])
    tips, kinds, rapid = path.cl[moving], path.kind[moving][1:], path.rapid[moving][1:]
    if len(tips) < 2:
        raise InvalidInput(f"the path has {len(path.cl)} points and no motion between them: nothing can be timed")
    if angle_between(path.axis, path.axis[0]).max() > FIXED:
        raise UnsupportedGeometry("the tool axis varies along the path: only paths with a fixed axis are timed")
    angles = _angles(machine, path.axis[0], table_from_part) if rotary is None else np.asarray(rotary, dtype=float)
    return _PathMoves(linear_coordinates(machine, tips, angles, table_from_part=table_from_part), tips, kinds, rapid)


def machining_time(machine: Machine, path: ToolPath, feeds: Feeds, rotary: ArrayLike | None = None,
                   table_from_part: ArrayLike | None = None) -> MachiningTime:
    """Time of a path with a fixed tool axis from rest to rest, by kind of motion.

    Parameters
    ----------
    machine, path, feeds, rotary, table_from_part
        As for `path_schedule`.
    """
    moves, bounds = _moves(machine, path, rotary, table_from_part), linear_bounds(machine)
    kept, stops = np.ones(len(moves.tips), dtype=bool), np.zeros(len(moves.tips), dtype=bool)
    curved, seconds = np.zeros(len(moves.kinds), dtype=bool), dict.fromkeys(Motion, 0.0)
    for begin, end in _smooth_cuts(moves) if feeds.smooth else ():
        here = slice(begin, end + 1)
        seconds[Motion.CUT] += schedule_near(moves.joints[here], feeds.cut, bounds, feeds.tolerance).duration
        curved[begin:end], stops[[begin, end]] = True, True
        kept[begin + 1:end] = False
        kept[(begin + end) // 2] = True  # both ends may be one point
    motions = kept[1:]
    kinds, wanted = moves.kinds[motions], feeds.of(moves.kinds, moves.rapid)[motions]
    times = schedule_polyline(moves.joints[kept], moves.tips[kept], wanted, bounds, feeds.tolerance,
                              stops[kept]).segment_times
    for kind in Motion:
        seconds[kind] += float(times[(kinds == kind) & ~curved[motions]].sum())
    return MachiningTime(seconds[Motion.CUT], seconds[Motion.ENTRY], seconds[Motion.EXIT], seconds[Motion.LINK])


def longest_cut(machine: Machine, path: ToolPath, feeds: Feeds, rotary: ArrayLike | None = None,
                table_from_part: ArrayLike | None = None) -> CurveSchedule | None:
    """Speeds along the longest smooth cut of a path, as `machining_time` takes it; None where there is none.

    Parameters
    ----------
    machine, path, feeds, rotary, table_from_part
        As for `path_schedule`.
    """
    moves = _moves(machine, path, rotary, table_from_part)
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(moves.tips, axis=0), axis=1))])
    ends = max(_smooth_cuts(moves), key=lambda piece: lengths[piece[1]] - lengths[piece[0]], default=None)
    if ends is None:
        return None
    here = slice(ends[0], ends[1] + 1)
    return schedule_near(moves.joints[here], feeds.cut, linear_bounds(machine), feeds.tolerance)


def _smooth_cuts(moves: _PathMoves) -> list[tuple[int, int]]:
    """Ranges of points of cuts between corners that are worth a curve."""
    ways = unit(np.diff(moves.tips, axis=0))
    corner = angle_between(ways[1:], ways[:-1]) > CORNER
    cut = moves.kinds == Motion.CUT
    ends = np.flatnonzero((cut[1:] != cut[:-1]) | (cut[1:] & cut[:-1] & corner)) + 1
    edges = [0, *ends.tolist(), len(cut)]
    return [(begin, end) for begin, end in pairwise(edges) if cut[begin] and end - begin + 1 >= _CURVE]


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
