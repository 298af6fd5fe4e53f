"""The rotary angles at which given passes take least time: limits of all levels together, curvature included.

A grid over all allowed angles is timed with a few of the passes, the best places are looked at closer and closer, and
all passes decide between the finalists, among them the alignments of `kinematic_setup`.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import linear_bounds
from toolaxis.feed.velocity_ramps import bend_of, durations
from toolaxis.machine.feed_polytopes import Level
from toolaxis.machine.kinematics import part_from_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.search.kinematic_setup import (
    AxisDomain,
    Domain,
    PassSegment,
    Setup,
    are_angles_allowed,
    common_feed,
    find_setup,
    reach_along_feed,
    rotary_grid,
)

Array = NDArray[np.float64]

#: Angles that are timed lie so far apart, rad: over the whole ranges, and then around the best ones.
_STEPS = tuple(np.radians((5.0, 1.25, 0.3, 0.08)).tolist())
#: Places that are followed, and passes that are timed on the way.
_PLACES, _PASSES = 6, 8
#: Points from which on a pass is a curve.
_CURVE = 6
#: Rotary angles that are timed in one go.
_BATCH = 4096


def cutting_seconds(mounting: Mounting, passes: Sequence[PassSegment], rotary: ArrayLike, feeds: Feeds) -> Array:
    """Time that passes take at rotary angles, from rest to rest each, (k,) s.

    Parameters
    ----------
    mounting : Mounting
        With velocity, acceleration and jerk of the linear axes.
    passes : sequence of PassSegment
        Those of fewer than six points are followed with exact stops, others as smooth curves.
    rotary : (k, m) array_like
        rad
    feeds : Feeds

    Raises
    ------
    InvalidInput
        When the machine does not state its limits.
    """
    rows, bounds = np.atleast_2d(np.asarray(rotary, dtype=float)), linear_bounds(mounting.machine)
    joint_from_part = np.linalg.inv(part_from_machine(mounting.machine, rows, mounting.table_from_part))
    seconds = np.zeros(len(rows))
    straight = [np.diff(one.tips, axis=0) for one in passes if len(one.tips) < _CURVE]
    if straight:
        steps = np.concatenate(straight)
        lengths = np.linalg.norm(steps, axis=1)
        for begin in range(0, len(rows), _BATCH):
            ways = unit(steps) @ joint_from_part[begin:begin + _BATCH].swapaxes(1, 2)
            limits = bounds.along(ways.reshape(-1, 3), feeds.cut)
            times = travel_time(np.tile(lengths, len(ways)), *limits)
            seconds[begin:begin + _BATCH] += times.reshape(len(ways), -1).sum(axis=1)
    for one in passes:
        if len(one.tips) >= _CURVE:
            bend = bend_of(one.tips, one.tips, feeds.cut, 3, feeds.tolerance)
            seconds += durations(bend, joint_from_part, feeds.cut, bounds)
    return seconds


def find_fastest_setup(mounting: Mounting, passes: Sequence[PassSegment], feeds: Feeds,
                       domain: AxisDomain | None = None) -> tuple[Setup, float]:
    """The set-up in which passes take least time, and that time, s; infinite where none is allowed.

    Parameters
    ----------
    mounting : Mounting
    passes : sequence of PassSegment
    feeds : Feeds
    domain : AxisDomain, optional
        Which tool axes are admissible; free as for a ball end in mid air unless given.

    Raises
    ------
    InvalidInput
        When the machine does not state its limits.

    Notes
    -----
    Property: not slower than any allowed set-up on a grid of one degree by more than 1 %, nor than the alignments.
    """
    held = Domain() if domain is None else domain
    few = [passes[k] for k in np.unique(np.linspace(0, len(passes) - 1, _PASSES).astype(int))]
    best = np.empty((0, len(mounting.machine.rotary)))
    for step in _STEPS:
        grids = [rotary_grid(mounting, step, middle) for middle in best] or [rotary_grid(mounting, step)]
        rows = np.concatenate([best, *grids])
        rows = rows[are_angles_allowed(mounting, rows, passes, held)]
        if not len(rows):
            break
        times = cutting_seconds(mounting, few, rows, feeds)
        best = rows[_apart(rows, times, 3 * step)]
    aligned = [find_setup(mounting, passes, held, level) for level in (Level.JERK, Level.ACCELERATION)]
    rows = np.concatenate([best, *(one.rotary[None] for one in aligned if len(one.rotary))])
    feed = common_feed(passes)
    if not len(rows):
        return Setup(feed, np.empty(0), 0.0, "infeasible"), np.inf
    times = cutting_seconds(mounting, passes, rows, feeds)
    chosen = rows[np.lexsort((np.abs(rows).sum(axis=1), np.round(times / times.min(), 6)))[0]]
    reach = float(reach_along_feed(mounting, Level.JERK, feed, chosen[None])[0])
    return Setup(feed, chosen, reach, "allowed"), float(times.min())


def _apart(rows: Array, times: Array, distance: float) -> list[int]:
    """The best rows that keep apart from better ones."""
    chosen: list[int] = []
    for i in np.argsort(times, kind="stable"):
        if len(chosen) == _PLACES:
            break
        if all(np.abs(rows[i] - rows[k]).max() > distance for k in chosen):
            chosen.append(int(i))
    return chosen
