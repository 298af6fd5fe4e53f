"""Time along straight segments, with corners that are stops or blends.

The model of the controller: along each segment the axes move in proportion, by a seven-segment profile, so that each
stays inside its limits.  A corner is rounded in a time T, from T/2 before it to T/2 after it on the programmed
segments, at one speed on both sides: the velocity of every axis goes from one segment's to the other's by constant jerk
up and down.  The tip then cuts the corner by |change of velocity| T / 12.  The speed is the greatest that keeps this
within the tolerance, every axis within acceleration and jerk, and a blend off the middle of its segments; look-ahead
lowers it where the axes could not slow down in time.  Without tolerance every corner is a stop; with it a corner is one
too where, by the halves of its segments, a blend takes longer.  From stop to stop the fastest of several tries counts:
corners as fast as they can be, at lower speeds, which leave more room to change speed between blends, or all stops.
Neighbours in one line with one feed are one segment.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import ramp_length, reachable, segment_durations, travel_time
from toolaxis.feed.joint_motion import JointMotion
from toolaxis.feed.limits import AxisBounds
from toolaxis.numeric.jit import jit
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Change of direction below which a corner is the rounding of its coordinates, and how far it may be cut then, mm.
STRAIGHT = 1e-6

#: Change of direction below which two segments are one.
ALIGNED = 1e-9

#: What corners are slowed down by from one try to the next, and how many tries there are at most.
_LEVEL, _LEVELS = 0.7, 12

_SIGNS = np.array([1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class PolylineSchedule:
    """Speeds and times along straight segments.

    Attributes
    ----------
    start : (m,) array
        Where the axes stand at first.
    directions : (k, m) array
        Axis motion per mm of each segment.
    limits : three (k,) arrays
        Velocity, acceleration and jerk along each segment.
    runs : (k,) array
        Length of each segment between its blends, mm.
    corners : (k + 1,) array
        Speed at each corner, mm/s; 0 at both ends.
    blends : (k + 1,) array
        Time of each corner's blend, s.
    shares : (n,) array
        What share of its segment's length each programmed one is.
    parts : (n,) array of int
        Which segment it belongs to.
    """

    start: Array
    directions: Array
    limits: tuple[Array, Array, Array]
    runs: Array
    corners: Array
    blends: Array
    shares: Array
    parts: NDArray[np.int64]

    @cached_property
    def times(self) -> Array:
        """Time of each segment, (k,) s, half of the blends at either end included."""
        ends = (self.corners[:-1], self.corners[1:])
        between_blends = travel_time(self.runs, *self.limits, ends)
        half_blends = (self.blends[:-1] + self.blends[1:]) / 2
        return np.asarray(between_blends + half_blends)

    @property
    def segment_times(self) -> Array:
        """Time of each programmed segment, (n,) s: that of segments in one line shared by length."""
        of_whole_segment = self.times[self.parts]
        return np.asarray(of_whole_segment * self.shares)

    @property
    def duration(self) -> float:
        """s."""
        return float(self.times.sum())

    def motion(self) -> JointMotion:
        """What every axis does."""
        number, axes = self.directions.shape
        # Of each run seven segments, and two of the blend after it.
        durations = np.zeros((number, 9))
        jerks = np.zeros((number, 9, axes))
        speeds_at_ends = (self.corners[:-1], self.corners[1:])
        durations[:, :7] = segment_durations(self.runs, *self.limits, speeds_at_ends)
        _, _, jerk = self.limits
        greatest_jerk = jerk[:, None] * self.directions
        jerks[:, :7] = _SIGNS[:, None] * greatest_jerk[:, None, :]
        durations[:-1, 7:] = self.blends[1:-1, None] / 2
        change = self.corners[1:-1, None] * np.diff(self.directions, axis=0)
        time = np.where(self.blends > 0, self.blends, 1.0)
        squared = time[1:-1, None] ** 2
        jerks[:-1, 7] = 4 * change / squared
        jerks[:-1, 8] = -4 * change / squared
        return JointMotion(durations.reshape(-1), jerks.reshape(-1, axes), self.start)


def schedule_polyline(joints: ArrayLike, tips: ArrayLike, feeds: ArrayLike, bounds: AxisBounds,
                      tolerance: float = 0.0, stops: ArrayLike | None = None) -> PolylineSchedule:
    """Speeds and times along straight segments from rest to rest.

    Parameters
    ----------
    joints : (n, m) array_like
        Axis positions at the corners, mm or rad.
    tips : (n, 3) array_like
        Tool tips there, mm; no two neighbours may coincide.
    feeds : (n - 1,) array_like
        Programmed velocity of the tip on each segment, mm/s; infinite for rapid motion.
    bounds : AxisBounds
    tolerance : float
        How far the tip may cut a corner, mm; 0 for an exact stop.
    stops : (n,) array_like of bool, optional
        Points at which the axes must come to rest.

    Raises
    ------
    InvalidInput
        When shapes do not fit, a feed is not above zero, or a segment has no length.

    Notes
    -----
    Properties: (1) no axis exceeds its velocity, acceleration or jerk; (2) the tip stays within the tolerance; (3) a
    tolerance never makes the path slower than stops do.
    """
    points = as_rows(tips, 3, "tips")
    corners = as_rows(joints, len(bounds.velocity), "joint coordinates")
    if len(points) != len(corners) or len(points) < 2:
        raise InvalidInput(f"{len(corners)} joint positions for {len(points)} tips: two or more of each are needed")
    if not (np.isfinite(tolerance) and tolerance >= 0):
        raise InvalidInput(f"corner tolerance is {tolerance} mm: it must be a finite number, not below zero")
    programmed = _segments(points, corners)
    limits = bounds.along(programmed.directions, feeds)
    wanted = np.broadcast_to(np.asarray(feeds, dtype=float), programmed.lengths.shape)
    rest = np.zeros(len(points), dtype=bool)
    if stops is not None:
        rest = np.asarray(stops, dtype=bool)
    kept = rest | _is_corner(programmed, wanted)
    merged = _segments(points[kept], corners[kept])
    if not kept.all():
        limits = bounds.along(merged.directions, wanted[kept[:-1]])
    caps = _corner_caps(merged, limits[0], bounds, tolerance)
    caps[rest[kept]] = 0.0
    parts = np.cumsum(kept[:-1]) - 1
    whole = np.bincount(parts, programmed.lengths)
    shares = programmed.lengths / whole[parts]
    path = _ProgrammedPath(corners[0], merged, limits, bounds, caps, shares, parts)
    return _fastest(list(_schedules_to_try(path)))


class _Segments(NamedTuple):
    """Straight segments: their lengths, axis motion per mm, and changes of the tip's direction between them."""

    lengths: Array
    directions: Array
    turns: Array

    @property
    def jumps(self) -> Array:
        """Changes of axis motion per mm at the inner corners."""
        return np.diff(self.directions, axis=0)


class _ProgrammedPath(NamedTuple):
    """What all schedules of a path have in common; caps are the greatest speeds of its corners."""

    start: Array
    segments: _Segments
    limits: tuple[Array, Array, Array]
    bounds: AxisBounds
    caps: Array
    shares: Array
    parts: NDArray[np.int64]

    def schedule(self, stopping: Bools, fastest: float) -> PolylineSchedule:
        """The schedule with stops at some inner corners, and no corner faster than a speed."""
        lengths, directions, turns = self.segments
        jumps = self.segments.jumps
        _, acceleration, jerk = self.limits
        stops_inside = stopping & (turns > STRAIGHT)
        held = np.concatenate([[True], stops_inside, [True]])
        most = np.where(held, 0.0, np.minimum(self.caps, fastest))
        shortest_runs = _runs(lengths, most, jumps, self.bounds)
        speed = look_ahead(shortest_runs, acceleration, jerk, most)
        runs = _runs(lengths, speed, jumps, self.bounds)
        blends = _blend_times(speed, jumps, self.bounds)
        return PolylineSchedule(self.start, directions, self.limits, runs, speed, blends, self.shares, self.parts)


def _is_corner(segments: _Segments, feeds: Array) -> Bools:
    """Which points are ends, or corners at which direction or feed changes, (n,)."""
    change = np.abs(segments.jumps).max(axis=1)
    aligned = (segments.turns <= ALIGNED) & (change <= ALIGNED)
    goes_on = aligned & (feeds[:-1] == feeds[1:])
    return np.concatenate([[True], ~goes_on, [True]])


def _corner_caps(segments: _Segments, velocity: Array, bounds: AxisBounds, tolerance: float) -> Array:
    """Greatest speeds of all corners, 0 at both ends, with velocity limits of the segments."""
    by_blend = _corner_speeds(segments, bounds, tolerance)
    by_velocity = np.minimum(velocity[:-1], velocity[1:])
    caps = np.zeros(len(segments.lengths) + 1)
    caps[1:-1] = np.minimum(by_blend, by_velocity)
    return caps


def _schedules_to_try(path: _ProgrammedPath) -> Iterator[PolylineSchedule]:
    """Schedules of which some are faster in places than others: blends where they pay, stops, and slower blends."""
    times = _blend_times(path.caps, path.segments.jumps, path.bounds)
    better = _better_stop(path.segments.lengths, path.limits, path.caps, times)
    first = path.schedule(better, np.inf)
    yield first
    yield path.schedule(np.ones_like(better), 0.0)
    if not better.all():
        yield path.schedule(np.zeros_like(better), np.inf)
        yield from _slower(lambda fastest: path.schedule(better, fastest), first)


def _slower(choice: Callable[[float], PolylineSchedule], first: PolylineSchedule) -> Iterator[PolylineSchedule]:
    """The same corners at lower speeds, as long as some piece between stops gains by it.

    Blends at their fastest leave no way to change speed between them, and the slowest holds back its neighbours.
    """
    level = float(first.corners.max(initial=0.0))
    pieces, best = _pieces([first])
    for _ in range(_LEVELS):
        level *= _LEVEL
        found = choice(level)
        times = np.bincount(pieces, found.times)
        if not (times < best).any():
            return
        best = np.minimum(best, times)
        yield found


def _pieces(choices: Sequence[PolylineSchedule]) -> tuple[NDArray[np.int64], Array]:
    """Which piece between common stops each segment belongs to, and what the first choice takes for each piece."""
    stands = np.all([choice.corners == 0 for choice in choices], axis=0)
    pieces = np.asarray(np.cumsum(stands[:-1]), dtype=np.int64) - 1
    times = np.bincount(pieces, choices[0].times)
    return pieces, np.asarray(times, dtype=float)


def _fastest(choices: Sequence[PolylineSchedule]) -> PolylineSchedule:
    """The fastest choice of each piece between stops that all choices make, put together."""
    pieces, _ = _pieces(choices)
    times = [np.bincount(pieces, choice.times) for choice in choices]
    best_of_piece = np.argmin(times, axis=0)
    best = best_of_piece[pieces]
    segments = np.arange(len(best))
    runs = np.array([choice.runs for choice in choices])
    corners = np.array([choice.corners[:-1] for choice in choices])
    blends = np.array([choice.blends[:-1] for choice in choices])
    chosen_corners = np.append(corners[best, segments], 0.0)
    chosen_blends = np.append(blends[best, segments], 0.0)
    return replace(choices[0], runs=runs[best, segments], corners=chosen_corners, blends=chosen_blends)


def _segments(points: Array, corners: Array) -> _Segments:
    """Segments between tips, with the axis positions there."""
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    if not (lengths > 0).all():
        empty = np.flatnonzero(~(lengths > 0))
        raise InvalidInput(f"segment {int(empty[0])} has no length: leave it out")
    ways = steps / lengths[:, None]
    turns = np.linalg.norm(np.diff(ways, axis=0), axis=1)
    motion = np.diff(corners, axis=0)
    return _Segments(lengths, motion / lengths[:, None], turns)


def _better_stop(lengths: Array, limits: tuple[Array, Array, Array], speeds: Array, times: Array) -> NDArray[np.bool_]:
    """Which inner corners take longer as blends than as stops, by the halves of their segments."""
    speed = speeds[1:-1]
    time = times[1:-1]
    stop = np.zeros(len(speed))
    blend = time.copy()
    feasible = np.ones(len(speed), dtype=bool)
    for side in (slice(None, -1), slice(1, None)):
        half = lengths[side] / 2
        top, a, j = (limit[side] for limit in limits)
        fast = np.minimum(top, reachable(0.0, half, a, j))
        left = half - speed * time / 2
        feasible &= ramp_length(speed, fast, a, j) <= left
        from_rest = np.zeros(len(half))
        stop += travel_time(half, top, a, j, (from_rest, fast))
        blend += travel_time(np.maximum(left, 0.0), top, a, j, (speed, fast))
    return np.asarray(feasible & (blend > stop))


def _shares(jumps: Array, bounds: AxisBounds) -> tuple[Array, Array]:
    """Factors of a blend's least time: jerk asks for the first times the root of speed, acceleration for the second."""
    sizes = np.abs(jumps)
    jerk = (sizes / bounds.jerk).max(axis=1)
    acceleration = (sizes / bounds.acceleration).max(axis=1)
    return 2 * np.sqrt(jerk), 2 * acceleration


def _corner_speeds(segments: _Segments, bounds: AxisBounds, tolerance: float) -> Array:
    """Greatest speed of each inner corner that keeps its blend within tolerance and half the neighbours."""
    lengths, _, turns = segments
    by_jerk, by_acceleration = _shares(segments.jumps, bounds)
    room = np.minimum(lengths[:-1], lengths[1:])
    cut = np.where(turns <= STRAIGHT, max(tolerance, STRAIGHT), tolerance)
    speeds = np.full(len(turns), np.inf)
    for size, most in ((turns / 12, cut), (np.ones(len(turns)), room)):
        for factor, power in ((by_jerk, 2 / 3), (by_acceleration, 1 / 2)):
            weight = size * factor
            counts = weight > 0
            with np.errstate(divide="ignore"):
                fastest = (most / np.where(counts, weight, 1.0)) ** power
            speeds = np.minimum(speeds, np.where(counts, fastest, np.inf))
    return np.asarray(speeds)


def _blend_times(speeds: Array, jumps: Array, bounds: AxisBounds) -> Array:
    inner = speeds[1:-1]
    by_jerk, by_acceleration = _shares(jumps, bounds)
    times = np.zeros(len(speeds))
    times[1:-1] = np.maximum(by_jerk * np.sqrt(inner), by_acceleration * inner)
    return times


def _runs(lengths: Array, speeds: Array, jumps: Array, bounds: AxisBounds) -> Array:
    """What blends leave of each segment."""
    cut = speeds * _blend_times(speeds, jumps, bounds) / 2
    return np.asarray(np.maximum(lengths - cut[:-1] - cut[1:], 0.0))


@jit
def look_ahead(runs: Array, acceleration: Array, jerk: Array, caps: Array) -> Array:
    """Greatest speeds at corners below caps such that each can be reached from both neighbours, (k + 1,) mm/s.

    Parameters
    ----------
    runs, acceleration, jerk : (k,) array
        Length of each segment, mm, and its limits.
    caps : (k + 1,) array
    """
    speeds = caps.copy()
    for i in range(len(runs) - 1, -1, -1):
        speeds[i] = min(speeds[i], _reach(speeds[i + 1], runs[i], acceleration[i], jerk[i]))
    for i in range(len(runs)):
        speeds[i + 1] = min(speeds[i + 1], _reach(speeds[i], runs[i], acceleration[i], jerk[i]))
    return speeds


@jit
def _reach(start: float, way: float, a: float, j: float) -> float:
    """One of `profile.reachable`, the cubic solved by Newton from above, where it is convex."""
    if way <= 0.0:
        return start
    shift = a * a / j
    if (2 * start + shift) * a / j >= way:
        p, q = 2 * start / j, way / j
        x = q ** (1.0 / 3.0)
        if p > 0.0:
            x = min(x, q / p)
        for _ in range(40):
            step = (x * x * x + p * x - q) / (3 * x * x + p)
            x -= step
            if abs(step) <= 1e-15 * x:
                break
        return float(start + j * x * x * (1 - 1e-12))
    return float((-shift / 2 + sqrt((start - shift / 2) ** 2 + 2 * a * way)) * (1 - 1e-12))
