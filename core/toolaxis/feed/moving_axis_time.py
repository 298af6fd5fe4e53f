"""Machining time of tool paths whose axis moves: all axes of the machine within their limits.

A control smooths the tip's path and the turning of the rotary axes within the tolerance, and moves the linear axes so
that the tip is where it should be: cuts are followed as curves of all axes made so.  Other motions on which the axis
turns go from rest to rest, and those on which it stands still are planned as for a fixed axis between stops.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following, levers
from toolaxis.feed.feed_drop import FeedDrop, crawl
from toolaxis.feed.fixed_axis_time import CORNER, NO_STEP, Feeds
from toolaxis.feed.limits import AxisBounds, linear_bounds
from toolaxis.feed.polyline import schedule_polyline
from toolaxis.feed.smooth_curve import fit_smooth_curve
from toolaxis.feed.time_optimal import CurveSchedule, schedule_curve
from toolaxis.machine.kinematics import linear_coordinates, tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.plan.timing import MachiningTime

Array = NDArray[np.float64]

#: Turn of the tool axis below which it stands still, rad.
_STILL = 1e-9
#: Points of a curve at least, and of the axes' curves in each gap between the knots of the smoothed one.
_POINTS, _FINE = 24, 5
#: Points that a gap between the knots of a smoothed curve must keep: where the axis jumps, fewer would follow the jump.
_LEFT = 4
#: Places at which speeds are sought for each point of a cut, and at least and at most: with ten times as many, passes
#: over a waved face take some percent less.
_STATIONS = 8, 600, 4000
#: Least part of a turn that counts for rotary axes near which the tool axis lies.
_SLIGHT = 0.02
#: Turn that shows how far the tool axis leans with a rotary axis, rad.
_PROBE = 1e-5
#: What a turn by a rad counts as, mm, on the way of links.
_ARM = 10.0
#: Least lever of a rotary axis, mm.
_LEVER = 10.0
#: Points that follow closer than this, mm, are left out in turn where speeds come out that had to be slowed down by
#: more than a factor: curves through points much closer at one place than elsewhere swing between them.
_THINNED, _SLOWED = (0.0, 0.05, 0.2), 1.5
#: Distance from the tip within which smoothed rotary axes keep the tool to the tolerance, mm.
REACH = 20.0


@dataclass(frozen=True, eq=False)
class PathSegment:
    """Part of a path that is planned from rest to rest.

    Attributes
    ----------
    kind : Motion
    begin, end : int
        Points of the `AxisTrajectory` between which it runs.
    turning : bool
        Whether the tool axis turns.
    rapid : bool
        Whether it is rapid.
    """

    kind: Motion
    begin: int
    end: int
    turning: bool
    rapid: bool


class FiveAxisSchedule:
    """A path with a moving axis and its feeds on a machine.

    Parameters
    ----------
    machine : Machine
        With velocity, acceleration and jerk of all its axes, none set by hand.
    path : ToolPath
    feeds : Feeds
        The tip's.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    tool_length : float
        From the gauge point to the tip, mm.
    near : (m,) array_like
        Where the rotary axes stand before, rad.

    Raises
    ------
    InvalidInput
        When the path has no motion, the machine cannot follow it, or does not state its limits.
    """

    def __init__(self, machine: Machine, path: ToolPath, feeds: Feeds, table_from_part: ArrayLike | None = None,
                 tool_length: float = 0.0, near: ArrayLike = ()) -> None:
        self.machine, self.feeds, self.path = machine, feeds, path
        self.place, self.tool_length = table_from_part, tool_length
        self.linear, self.bounds = linear_bounds(machine), axis_bounds(machine)
        self.along = following(machine, path, table_from_part, tool_length, near=near)
        if not (np.linalg.norm(np.diff(path.cl, axis=0), axis=1) > NO_STEP).any():
            raise InvalidInput(f"the path has {len(path.cl)} points and no motion between them: nothing can be timed")
        self.levers = np.maximum(levers(machine, self.along, tool_length, table_from_part), _LEVER)

    def stretches(self) -> list[PathSegment]:
        """The parts of the path between stops, in their order."""
        along, path = self.along, self.path
        kinds, rapid = path.kind[along.arrival[1:]], path.rapid[along.arrival[1:]]
        turning = angle_between(along.axes[1:], along.axes[:-1]) > _STILL
        cut = kinds == Motion.CUT
        ways = np.diff(along.tips, axis=0)
        size = np.linalg.norm(ways, axis=1, keepdims=True)
        ways = np.where(size > NO_STEP, ways / np.where(size > NO_STEP, size, 1.0), 0.0)
        corner = (np.linalg.norm(np.diff(ways, axis=0), axis=1) > CORNER) & cut[1:] & cut[:-1]
        turns = turning & ~cut
        ends = (cut[1:] != cut[:-1]) | corner | (turns[1:] != turns[:-1])
        ends |= turns[1:] & (along.arrival[2:] != along.arrival[1:-1])
        edges = [0, *(np.flatnonzero(ends) + 1).tolist(), len(kinds)]
        return [PathSegment(Motion(int(kinds[a])), a, b, bool(cut[a] or turns[a]), bool(rapid[a])) for a, b in
                pairwise(edges)]

    def curve(self, one: PathSegment) -> CurveSchedule | None:
        """What the axes do on a stretch that turns or cuts; None where nothing moves.

        Rotary axes count by their levers, mm: those of `curve_bounds`.

        Parameters
        ----------
        one : PathSegment
        """
        rows = slice(one.begin, one.end + 1)
        tips, axes = self.along.tips[rows], self.along.axes[rows]
        way = np.linalg.norm(np.diff(tips, axis=0), axis=1)
        if one.kind != Motion.CUT:
            way = np.hypot(way, _ARM * angle_between(axes[1:], axes[:-1]))
        kept = np.concatenate([[True], way > NO_STEP])
        places = np.concatenate([[0.0], np.cumsum(way[kept[1:]])])
        if len(places) < 2:
            return None
        poses = np.hstack([tips[kept], self.along.rotary[rows][kept]])
        best: CurveSchedule | None = None
        for gap in _THINNED:
            some = _apart(places, gap)
            found = self._schedule_poses(one, places[some], poses[some])
            if best is None or not best.duration <= found.duration:
                best = found
            if best.stretch <= _SLOWED and np.isfinite(best.duration):
                break
        return best

    def _schedule_poses(self, one: PathSegment, places: Array, poses: Array) -> CurveSchedule:
        """What the axes do along poses at places."""
        if len(places) < _POINTS:
            fine = np.linspace(0.0, places[-1], _POINTS)
            poses = np.column_stack([np.interp(fine, places, column) for column in poses.T])
            places = fine
        curve = fit_smooth_curve(places, poses, self._room(poses[:, 3:]), _LEFT)
        knots = np.unique(curve.t)
        shares = np.arange(_FINE) / _FINE
        fine = np.append((knots[:-1, None] + np.diff(knots)[:, None] * shares).ravel(), knots[-1])
        poses = curve(fine)
        linear = linear_coordinates(self.machine, poses[:, :3], poses[:, 3:], self.tool_length, self.place)
        stations = int(np.clip(_STATIONS[0] * len(places), *_STATIONS[1:])) if one.kind == Motion.CUT else None
        return schedule_curve(np.hstack([linear, poses[:, 3:] * self.levers]), _line(fine), self._feed(one),
                              self.curve_bounds, stations)

    def _room(self, rotary: Array) -> Array:
        """By how much tips, mm, and rotary axes, rad, may be smoothed at poses, (n, 3 + m)."""
        room = np.full((len(rotary), 3 + rotary.shape[1]), self.feeds.tolerance / 2)
        for i in range(rotary.shape[1]):
            turned = rotary.copy()
            turned[:, i] += _PROBE
            lean = angle_between(tool_axes(self.machine, turned), tool_axes(self.machine, rotary)) / _PROBE
            room[:, 3 + i] /= REACH * np.maximum(lean, _SLIGHT)
        return room

    @property
    def curve_bounds(self) -> AxisBounds:
        """Bounds of all axes, rotary ones as their levers move, mm."""
        scale = np.concatenate([np.ones(3), self.levers])
        return AxisBounds(self.bounds.velocity * scale, self.bounds.acceleration * scale, self.bounds.jerk * scale)

    def _feed(self, one: PathSegment) -> float:
        return float(self.feeds.of([one.kind], [one.rapid])[0])

    def straight(self, one: PathSegment) -> Iterator[tuple[Motion, float]]:
        """Kinds and times of a stretch on which the axis stands still, s.

        Parameters
        ----------
        one : PathSegment
        """
        rows = slice(one.begin, one.end + 1)
        tips, joints = self.along.tips[rows], self.along.linear[rows]
        kept = np.concatenate([[True], np.linalg.norm(np.diff(tips, axis=0), axis=1) > NO_STEP])
        if kept.sum() < 2:
            return
        arrival = self.along.arrival[one.begin + 1:one.end + 1][kept[1:]]
        kinds = self.path.kind[arrival]
        wanted = self.feeds.of(kinds, self.path.rapid[arrival])
        taken = schedule_polyline(joints[kept], tips[kept], wanted, self.linear, self.feeds.tolerance).segment_times
        for kind in Motion:
            yield kind, float(taken[kinds == kind].sum())


def _apart(places: Array, gap: float) -> NDArray[np.intp]:
    """Which places are a gap apart at least, the first and the last among them."""
    kept = [0]
    for k in range(1, len(places) - 1) if gap else ():
        if places[k] - places[kept[-1]] >= gap and places[-1] - places[k] >= gap:
            kept.append(k)
    return np.array([*kept, len(places) - 1]) if gap else np.arange(len(places))


def _line(places: Array) -> Array:
    """Points whose ways are those of the path, (n, 3)."""
    return np.column_stack([places, np.zeros((len(places), 2))])


def axis_bounds(machine: Machine) -> AxisBounds:
    """Bounds of the three linear axes and of the rotary ones, mm or rad.

    Parameters
    ----------
    machine : Machine

    Raises
    ------
    InvalidInput
        When the machine does not know its accelerations or jerks, or an axis is set by hand.
    """
    hands = [axis.name for axis in machine.rotary if axis.drive is None]
    if hands:
        raise InvalidInput(f"axis {hands[0]} of {machine.name} is set by hand: it cannot move while cutting")
    linear = linear_bounds(machine)
    rotary = np.array([axis.drive.levels(axis.name) for axis in machine.rotary if axis.drive is not None])
    levels = np.concatenate([np.stack([linear.velocity, linear.acceleration, linear.jerk], axis=1),
                             rotary.reshape(-1, 3)])
    return AxisBounds(levels[:, 0], levels[:, 1], levels[:, 2])


@dataclass(frozen=True, eq=False)
class FiveAxisMotion:
    """What a path with a moving axis comes to on a machine.

    Attributes
    ----------
    time : MachiningTime
    begin, end : (m,) array
        Rotary angles there, rad.
    crawl : FeedDrop or None
        Where the tip all but stands still while it cuts, for longest; None where it does so nowhere.
    """

    time: MachiningTime
    begin: Array
    end: Array
    crawl: FeedDrop | None


def five_axis_motion(machine: Machine, path: ToolPath, feeds: Feeds, table_from_part: ArrayLike | None = None,
                     tool_length: float = 0.0, near: ArrayLike = ()) -> FiveAxisMotion:
    """Time of a path with a moving axis from rest to rest, by kind of motion, and where it crawls.

    Parameters
    ----------
    machine, path, feeds, table_from_part, tool_length, near
        As for `FiveAxisSchedule`.

    Notes
    -----
    **Property**: no axis exceeds its velocity, acceleration or jerk.
    """
    plan = FiveAxisSchedule(machine, path, feeds, table_from_part, tool_length, near)
    seconds, slow = dict.fromkeys(Motion, 0.0), list[FeedDrop]()
    for one in plan.stretches():
        if not one.turning:
            for kind, taken in plan.straight(one):
                seconds[kind] += taken
            continue
        found = plan.curve(one)
        if found is None:
            continue
        seconds[one.kind] += found.duration
        crawled = crawl(found, feeds.cut, plan.along.tips[one.begin:one.end + 1]) if one.kind == Motion.CUT else None
        slow += [] if crawled is None else [crawled]
    rotary = plan.along.rotary
    time = MachiningTime(seconds[Motion.CUT], seconds[Motion.ENTRY], seconds[Motion.EXIT], seconds[Motion.LINK])
    return FiveAxisMotion(time, rotary[0], rotary[-1], max(slow, key=lambda one: one.seconds, default=None))


def five_axis_time(machine: Machine, path: ToolPath, feeds: Feeds, table_from_part: ArrayLike | None = None,
                   tool_length: float = 0.0, near: ArrayLike = ()) -> tuple[MachiningTime, Array, Array]:
    """Time of a path with a moving axis, and the rotary angles at its ends, rad, as `five_axis_motion` finds them.

    Parameters
    ----------
    machine, path, feeds, table_from_part, tool_length, near
        As for `FiveAxisSchedule`.
    """
    made = five_axis_motion(machine, path, feeds, table_from_part, tool_length, near)
    return made.time, made.begin, made.end


def turns(path: ToolPath) -> bool:
    """Whether the axis of a path moves.

    Parameters
    ----------
    path : ToolPath
    """
    axes = np.asarray(unit(path.axis)) if len(path.axis) else path.axis
    return bool(len(axes)) and bool((angle_between(axes, axes[:1]) > _STILL).any())
