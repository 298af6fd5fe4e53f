"""Set-ups by the machine's kinematics: rotary angles at which the linear axes together do most along the passes.

A feed direction is aligned with a corner of what the axes can do, of 16 ways the one that ranges and the domain of
admissible lead and tilt allow and that turns least; where none of them is allowed, the best angles are searched.
One set-up may serve a pass, a sub-surface or the whole part: then the mean of the passes' directions is aligned.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi, radians
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.frame import frame_from_normal
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.machine.feed_polytopes import Level, along, best_angles
from toolaxis.machine.kinematics import nearest_turn, placement, tool_axes
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.rounding import round_significant
from toolaxis.numeric.vectors import as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angles that rings of the search are apart, rad: over the whole ranges, and then around the best so far.
_STEPS = tuple(map(radians, (3.0, 0.75, 0.15, 0.03)))
#: Points of a pass whose normals the domain is held against at most.
_LOOKED = 64
#: First angles that are tried where the first rotary axis is free.
_FREE = np.radians(np.arange(-180, 180, 5.0))
#: Rotary angles that are checked in one go, those that do most first: most searches end in the first few batches.
_BATCH = 128
#: What the axes do is the same within this share.
_SAME = 1e-9


class PassSegment(NamedTuple):
    """One pass.

    Attributes
    ----------
    tips, normals : (n, 3) array
        Tool tips, mm, and unit normals of the surface, in the order of the feed.
    """

    tips: Array
    normals: Array

    @property
    def length(self) -> float:
        """mm"""
        return float(np.linalg.norm(np.diff(self.tips, axis=0), axis=1).sum())

    @property
    def feeds(self) -> Array:
        """Unit feed direction at each point, (n, 3)."""
        ways = unit(np.diff(self.tips, axis=0))
        return np.concatenate([ways, ways[-1:]])


def pass_segments(path: ToolPath) -> tuple[PassSegment, ...]:
    """The cuts of a tool path, pass by pass.

    Parameters
    ----------
    path : ToolPath

    Raises
    ------
    InvalidInput
        When nothing is cut.
    """
    found = []
    for begin, end in pairwise(path.breaks):
        cuts = np.flatnonzero(path.kind[begin + 1:end] == Motion.CUT) + begin + 1
        rows = np.union1d(cuts - 1, cuts)
        moving = np.concatenate([[True], np.linalg.norm(np.diff(path.cl[rows], axis=0), axis=1) > 0])[:len(rows)]
        if moving.sum() > 1:
            found.append(PassSegment(path.cl[rows[moving]], path.normal[rows[moving]]))
    if not found:
        raise InvalidInput("the path cuts nothing: there is no feed direction to set a machine up for")
    return tuple(found)


class AxisDomain(Protocol):
    """Which tool axes are admissible along passes."""

    def holds(self, axes: ArrayLike, passes: Sequence[PassSegment]) -> Bools:
        """Whether tool axes stay admissible along all passes, (k,)."""


@dataclass(frozen=True)
class Domain:
    """Admissible tool axes as a pyramid about the surface normal.

    Attributes
    ----------
    lead, tilt : (float, float)
        Least and greatest angle towards the feed and towards left of it, rad, inside -pi/2 to pi/2; as far as the
        surface is seen unless given, as for a ball end in mid air.

    Raises
    ------
    InvalidInput
        When a range is reversed or leaves the half sphere.

    Notes
    -----
    **Source** [grandguillaume2021] Fig. 13.
    """

    lead: tuple[float, float] = (radians(-89.0), radians(89.0))
    tilt: tuple[float, float] = (radians(-89.0), radians(89.0))

    def __post_init__(self) -> None:
        for name in ("lead", "tilt"):
            low, high = getattr(self, name)
            if not -pi / 2 < low <= high < pi / 2:
                raise InvalidInput(f"{name} range is {low} to {high} rad: it must lie inside -pi/2 to pi/2, and not be "
                                   "reversed")

    def holds(self, axes: ArrayLike, passes: Sequence[PassSegment]) -> Bools:
        """Whether tool axes stay admissible along all passes, (k,).

        Parameters
        ----------
        axes : (k, 3) array_like
            Unit vectors in the part's frame.
        passes : sequence of PassSegment
        """
        rows = as_rows(axes, 3, "axis")
        good = np.ones(len(rows), dtype=bool)
        for one in passes:
            some = np.unique(np.linspace(0, len(one.tips) - 1, _LOOKED).astype(int))
            frame = frame_from_normal(one.normals[some], one.feeds[some])
            f, left, n = (rows @ vectors.T for vectors in frame)
            lead, tilt = np.arctan2(f, n), np.arctan2(left, n)
            good &= ((n > 0) & (lead >= self.lead[0]) & (lead <= self.lead[1])
                     & (tilt >= self.tilt[0]) & (tilt <= self.tilt[1])).all(axis=1)
        return good


@dataclass(frozen=True, eq=False)
class Setup:
    """Rotary angles for some passes.

    Attributes
    ----------
    feed : (3,) array
        Mean feed direction of the passes, part's frame.
    rotary : (m,) array
        rad, in the order of `Machine.rotary`; empty where no angles are allowed.
    reach : float
        What the axes do along the mean feed direction there, mm and s; 0 without angles.
    outcome : str
        "aligned" with a corner (near a pole: as near as can be), "allowed": the best inside ranges and domain, or
        "infeasible".
    """

    feed: Array
    rotary: Array
    reach: float
    outcome: str


def mean_feed(tips: ArrayLike) -> Array:
    """The mean feed direction of a pass over its length, (3,).

    Parameters
    ----------
    tips : (n, 3) array_like

    Raises
    ------
    InvalidInput
        When it ends where it began.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (24), made a unit vector.
    """
    rows = as_rows(tips, 3, "tips")
    whole = rows[-1] - rows[0]
    if not np.linalg.norm(whole) > 0:
        raise InvalidInput("the pass ends where it began: it has no mean feed direction")
    return np.asarray(unit(whole))


def common_feed(passes: Sequence[PassSegment]) -> Array:
    """The mean feed direction of several passes, weighted by length, (3,); there and back count as one direction.

    Parameters
    ----------
    passes : sequence of PassSegment
        The first one tells the sense.

    Notes
    -----
    **Source** [grandguillaume2021] Eqs. (23) and (25), made a unit vector.
    """
    feeds = np.array([mean_feed(one.tips) for one in passes])
    senses = np.where(feeds @ feeds[0] < 0, -1.0, 1.0)
    return np.asarray(unit((senses * np.array([one.length for one in passes])) @ feeds))


def find_setup(mounting: Mounting, passes: Sequence[PassSegment], domain: AxisDomain | None = None,
               level: Level = Level.JERK, stand: ArrayLike | None = None) -> Setup:
    """The set-up in which the axes do most along the mean feed direction of passes.

    Parameters
    ----------
    mounting : Mounting
        The machine with the part on its table.
    passes : sequence of PassSegment
        One pass, those of a sub-surface, or all.
    domain : AxisDomain, optional
        Which tool axes are admissible; free as for a ball end in mid air unless given.
    level : Level
        Which derivative is to be greatest.
    stand : (m,) array_like, optional
        Where the rotary axes stand, rad: of equal set-ups the nearest to it is taken, else the least sum of angles.

    Raises
    ------
    InvalidInput
        When the machine does not state its limits, or the passes have no direction.

    Notes
    -----
    **Source** [grandguillaume2021] Sec. 4.4.
    Properties: (1) no allowed angles give more than an aligned set-up; (2) moving part and table together changes
    nothing.
    """
    feed, allowed = common_feed(passes), Domain() if domain is None else domain
    found = find_best_angles(mounting, level, feed, lambda rows: are_angles_allowed(mounting, rows, passes, allowed))
    if not len(found.rows):
        return Setup(feed, np.empty(0), 0.0, found.outcome)
    chosen = least_turned(found.rows)
    if stand is not None:
        chosen = nearest_turn(mounting.machine, found.rows, stand)
    return Setup(feed, chosen, float(reach_along_feed(mounting, level, feed, chosen[None])[0]), found.outcome)


class EqualAngles(NamedTuple):
    """Allowed rotary angles at which the axes do the same, and no others more.

    rows : (k, m) array, rad; none where nothing is allowed.
    outcome : str, as of `Setup`.
    """

    rows: Array
    outcome: str


def find_best_angles(mounting: Mounting, level: Level, feed: Array, allowed: Callable[[Array], Bools],
                     starts: Array | None = None) -> EqualAngles:
    """The allowed rotary angles at which the axes do most along a feed direction.

    Parameters
    ----------
    mounting : Mounting
    level : Level
    feed : (3,) array
        Part's frame.
    allowed : callable
        Takes (k, m) rotary angles, rad, and tells which of them may be used, (k,) bool.
    starts : (k, m) array, optional
        Angles to look at besides the first grid, where little is allowed.

    Notes
    -----
    **Source** [grandguillaume2021] Eqs. (13), (14) and (18).
    """
    rows = _alignments(mounting, level, feed)
    rows = rows[allowed(rows)]
    if len(rows):
        return EqualAngles(rows, "aligned")
    rows = _search_grids(mounting, level, feed, allowed, starts)
    return EqualAngles(rows, "allowed" if len(rows) else "infeasible")


def least_turned(rows: Array) -> Array:
    """The rotary angles that turn least from zero, (m,) rad.

    Parameters
    ----------
    rows : (k, m) array
        rad
    """
    return np.asarray(rows[np.argmin(np.round(np.abs(rows).sum(axis=1), 9))])


def find_setups_by_pass(mounting: Mounting, passes: Sequence[PassSegment], domain: AxisDomain | None = None,
                        level: Level = Level.JERK) -> tuple[Setup, ...]:
    """The best set-up of each pass, the nearest to that of the pass before.

    Parameters
    ----------
    mounting, passes, domain, level
        As for `find_setup`.
    """
    found: list[Setup] = []
    stand = None
    for one in passes:
        found.append(find_setup(mounting, (one,), domain, level, stand))
        stand = found[-1].rotary if len(found[-1].rotary) else stand
    return tuple(found)


def _alignments(mounting: Mounting, level: Level, feed: Array) -> Array:
    """Angles that align a feed with corners, (k, m) rad, inside ranges where whole turns lead there."""
    machine = mounting.machine
    try:
        rows = best_angles(machine, level, placement(mounting.table_from_part)[:3, :3] @ feed)
    except UnsupportedGeometry:  # there is no closed form
        return np.empty((0, len(machine.rotary)))
    if (rows[:, 0] == 0).all():  # the first axis is free
        rows = np.column_stack([np.tile(_FREE, len(rows)), np.repeat(rows[:, 1], len(_FREE))])
    return _turned_inside(mounting, rows)


def _turned_inside(mounting: Mounting, rows: Array) -> Array:
    return np.column_stack([axis.within(rows[:, i])[0] for i, axis in enumerate(mounting.machine.rotary)])


def are_angles_allowed(mounting: Mounting, rows: Array, passes: Sequence[PassSegment], domain: AxisDomain) -> Bools:
    """Which rotary angles are inside ranges and domain, (k,).

    Parameters
    ----------
    mounting : Mounting
    rows : (k, m) array
        rad
    passes : sequence of PassSegment
    domain : AxisDomain
    """
    if not len(rows):
        return np.zeros(0, dtype=bool)
    good = np.ones(len(rows), dtype=bool)
    for i, axis in enumerate(mounting.machine.rotary):
        good &= axis.within(rows[:, i])[1]
    axes = tool_axes(mounting.machine, rows) @ placement(mounting.table_from_part)[:3, :3]
    good[good] = domain.holds(axes[good], passes)
    return good


def reach_along_feed(mounting: Mounting, level: Level, feed: Array, rows: Array) -> Array:
    """What the axes do along a feed direction at rotary angles, (k,) mm and s.

    Parameters
    ----------
    mounting : Mounting
    level : Level
    feed : (3,) array
        Part's frame.
    rows : (k, m) array
        rad
    """
    here = placement(mounting.table_from_part)[:3, :3] @ feed
    return along(mounting.machine, level, np.tile(here, (len(rows), 1)), rows)


def rotary_grid(mounting: Mounting, step: float, middle: Array | None = None) -> Array:
    """Rotary angles inside the ranges, a step apart, (k, m) rad.

    Parameters
    ----------
    mounting : Mounting
    step : float
        rad
    middle : (m,) array, optional
        Only those within six steps of it; all unless given, those of axes without end within half a turn.
    """
    sides = []
    for i, axis in enumerate(mounting.machine.rotary):
        low, high = max(axis.low, -pi), min(axis.high, pi)
        if middle is not None:
            low, high = max(axis.low, middle[i] - 6 * step), min(axis.high, middle[i] + 6 * step)
        sides.append(np.linspace(low, high, max(1, round((high - low) / step) + 1)))
    return grid_rows(*sides)


def _search_grids(mounting: Mounting, level: Level, feed: Array, allowed: Callable[[Array], Bools],
                  starts: Array | None) -> Array:
    """The best allowed angles from grids that grow finer, (k, m) of equal ones; none where no grid holds any."""
    best = np.empty((0, len(mounting.machine.rotary)))
    most = -np.inf
    first = best if starts is None else starts
    for step in _STEPS:
        rows = rotary_grid(mounting, step, best[0]) if len(best) else (
            np.concatenate([first, rotary_grid(mounting, step)]))
        reach = reach_along_feed(mounting, level, feed, rows)
        found = _first_allowed(rows, reach, allowed, most * (1 + _SAME) if len(best) else most)
        if len(found):
            best = rows[found]
            most = float(reach[found[0]])
        elif not len(best):
            break
    return best


def _first_allowed(rows: Array, reach: Array, allowed: Callable[[Array], Bools], above: float) -> NDArray[np.intp]:
    """Which rows are the best allowed ones above a reach, the one that turns least first.

    Whether an axis is allowed takes much longer to find out than how much it reaches.
    """
    order = np.lexsort((np.abs(rows).sum(axis=1), -round_significant(reach)))
    order = order[reach[order] > above]
    for begin in range(0, len(order), _BATCH):
        some = order[begin:begin + _BATCH]
        some = some[allowed(rows[some])]
        if len(some):
            return np.asarray(some[reach[some] >= reach[some[0]] * (1 - _SAME)])
    return np.empty(0, dtype=np.intp)
