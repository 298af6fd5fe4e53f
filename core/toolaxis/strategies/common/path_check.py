"""The last word on passes with a moving axis.

While the axis turns by up to an angle from that in the middle of a motion, no point of a component leaves the place
that it would have with the middle axis by more than the angle times its distance from the tip.  So distances that are
proven for a straight motion with the middle axis, larger by that, hold along the whole motion; motions are split until
they do.  The cutter on the skin touches it: there no distance is left for that, and it is judged where it stands, at
points of the path close to each other.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import Violation
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.path.links import least_rise
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.link_heights import OVER
from toolaxis.search.path_check import COMPONENTS, PathCheck, greatest_depth, link_into_stock, worst_motion
from toolaxis.strategies.common.links import LinkMotion
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angles from the middle axis to which motions are split in turn, rad.
_TURNS = (0.01, 0.0025, 0.0005)
#: Greatest distance and angle between points of the path at which the cutter is held against the skin.
NEAR_MM, NEAR = 0.5, radians(0.5)


class PathMotions(NamedTuple):
    """Motions on which tips run straight, (n, 3) mm, and axes turn from one to the other, (n, 3)."""

    start: Array
    end: Array
    before: Array
    after: Array

    def rows(self, which: NDArray[np.intp]) -> "PathMotions":
        """Some of them."""
        return PathMotions(*(each[which] for each in self))

    def split(self, parts: NDArray[np.int64]) -> tuple["PathMotions", NDArray[np.intp]]:
        """Each cut into so many parts, with the number of the one that each part belongs to; axes are interpolated as
        cutter location data are, linearly."""
        owner, number = number_parts(parts)
        whole = parts[owner][:, None]
        low = number[:, None] / whole
        high = (number + 1)[:, None] / whole
        one = self.rows(owner)
        tip = one.end - one.start
        turn = one.after - one.before
        return PathMotions(one.start + low * tip, one.start + high * tip, _unit(one.before + low * turn),
                           _unit(one.before + high * turn)), owner


def _unit(rows: Array) -> Array:
    return np.asarray(unit(rows)) if len(rows) else rows


def spans_of(path: ToolPath) -> PathMotions:
    """The motions of a path.

    Parameters
    ----------
    path : ToolPath
    """
    axes = _unit(path.axis)
    return PathMotions(path.cl[:-1], path.cl[1:], axes[:-1], axes[1:])


def keeps_distance(tool: Tool, group: CheckSurfaces, spans: PathMotions, required: Array) -> Bools:
    """Whether every component is proven to keep its distance from a group along motions, (n,).

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
    spans : PathMotions
    required : (3,) array
        Least signed distances of cutter, shank and holder, mm; -inf where one does not count.
    """
    reach = _reaches(tool)
    left = np.arange(len(spans.start))
    for most in _TURNS:
        turn = angle_between(spans.before[left], spans.after[left])
        parts, owner = spans.rows(left).split(np.maximum(np.ceil(0.5 * turn / most), 1).astype(np.int64))
        middle = _unit(parts.before + parts.after)
        moves = np.stack([(parts.start + parts.end) / 2, (parts.end - parts.start) / 2, middle], axis=1)
        free = np.ones(len(left), dtype=bool)
        off = np.maximum(angle_between(parts.before, middle), angle_between(parts.after, middle))
        for some in (np.flatnonzero(turn[owner] == 0), np.flatnonzero(turn[owner] > 0)):
            table = np.tile(required + off[some].max(initial=0.0) * reach, (len(group.faces), 1))
            free[owner[some[keeps_limits(group.cells, tool, moves[some], table).blocked >= 0]]] = False
        left = left[~free]
        if not len(left) or not (turn[~free] > 0).any():
            break
    answer = np.ones(len(spans.start), dtype=bool)
    answer[left] = False
    return answer


def _reaches(tool: Tool) -> Array:
    """How far from the tip a point of each component may be, (3,) mm."""
    reach = np.zeros(3)
    reach[0] = np.hypot(max(tool.radius, tool.profile.top_radius), tool.profile.top)
    for name, line in tool.outlines.items():
        reach[COMPONENTS.index(name)] = np.hypot(*line.T).max()
    return reach


@dataclass(frozen=True, eq=False)
class MovingLinkClearance:
    """The surroundings of links between strokes with moving axes.

    Attributes
    ----------
    tool : Tool
    groups : tuple of CheckSurfaces
        With the distances to keep.
    allowance : float
        Stock left on the skin, mm.
    over : float
        What they keep from the skin where they cross, mm, see `toolaxis.search.link_heights.height_over`.
    """

    tool: Tool
    groups: tuple[CheckSurfaces, ...]
    allowance: float = 0.0
    over: float = OVER

    @property
    def rise(self) -> Callable[[Array, Array, Array], Array] | None:
        """How far the ends of links have to be lifted for stock, see `toolaxis.path.links.Linking`; None without stock.
        """
        if not any(group.stock > 0 for group in self.groups):
            return None
        return lambda tips, axes, most: least_rise(
            tips, axes, most, lambda start, end, up: self.clear(start, end, up, up, LinkMotion.LIFT))

    def clear(self, start: Array, end: Array, before: Array, after: Array, motion: LinkMotion) -> Bools:
        """Whether links are free, (k,): they keep their distances, and where they cross `over` from the skin too.

        Parameters
        ----------
        start, end : (k, 3) array
            Tips, mm.
        before, after : (k, 3) array
            Axes there.
        motion : LinkMotion
        """
        free = np.ones(len(start), dtype=bool)
        for group in self.groups:
            required = group.required.copy() if motion is LinkMotion.AT_FEED else group.required_on_links
            if motion is LinkMotion.CROSSING and group.role != OTHER:
                required[0] = max(self.allowance + self.over, group.rapid)
            some = np.flatnonzero(free)
            free[some] = keeps_distance(self.tool, group, PathMotions(start, end, before, after).rows(some), required)
        return free


def prove_moving(path: ToolPath, tool: Tool, groups: tuple[CheckSurfaces, ...], allowance: float = 0.0, *,
                 progress: Progress = NO_PROGRESS) -> PathCheck:
    """Judge a path with a moving axis: every motion by bounds, the cutter on the skin at points.

    Parameters
    ----------
    path : ToolPath
    tool : Tool
    groups : tuple of CheckSurfaces
        From `toolaxis.feasibility.surroundings.group_surroundings`, with the distances to keep.
    allowance : float
        Stock left on the skin, mm.
    progress : Progress

    Returns
    -------
    PathCheck
        Its gouge is the greatest depth at the points looked at, as an upper bound there; clearances are those that were
        asked for.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    spans, cutting = spans_of(path), path.kind[1:] == Motion.CUT
    gouge = 0.0
    for number, group in enumerate(groups):
        progress.report("proof", number, len(groups))
        on = np.flatnonzero(cutting & (group.role != OTHER))
        off = np.flatnonzero(~cutting | (group.role == OTHER))
        without = np.concatenate([[-inf], group.required[1:]])
        for rows, required in ((on, without), (off, group.required)):
            free = keeps_distance(tool, group, spans.rows(rows), required)
            if not _alone(tool, group, spans.rows(rows[~free]), required):
                return PathCheck(_witness(tool, group, spans.rows(rows[~free]), required))
        into = _links_into_stock(tool, group, spans.rows(np.flatnonzero(path.kind[1:] == Motion.LINK)))
        if len(into.start):
            return PathCheck(link_into_stock(tool, group, standing(into)))
        if len(on):
            depth = _touching(tool, group, spans.rows(on), allowance)
            if depth.witness is not None:
                return depth
            gouge = max(gouge, depth.gouge)
    known = [name for name in COMPONENTS if name == "cutter" or name in tool.outlines]
    least = {name: min(float(group.required[COMPONENTS.index(name)]) for group in groups
                       if name != "cutter" or group.role == OTHER) for name in known
             if name != "cutter" or any(group.role == OTHER for group in groups)}
    return PathCheck(None, gouge, least)


def _links_into_stock(tool: Tool, group: CheckSurfaces, links: PathMotions) -> PathMotions:
    """The links of which the cutter is not proven to stay clear of a group's stock, each looked at alone."""
    required = np.array([group.required_on_links[0], -inf, -inf])
    if group.stock == 0 or not len(links.start):
        return links.rows(np.empty(0, dtype=np.intp))
    bad = [k for k in np.flatnonzero(~keeps_distance(tool, group, links, required))
           if not keeps_distance(tool, group, links.rows(np.array([k])), required)[0]]
    return links.rows(np.array(bad, dtype=np.intp))


def _alone(tool: Tool, group: CheckSurfaces, spans: PathMotions, required: Array) -> bool:
    """Whether motions that are not proven together are each proven alone: bounds are those of the widest turn among
    them, and links were laid by their own."""
    return all(keeps_distance(tool, group, spans.rows(np.array([k])), required)[0] for k in range(len(spans.start)))


def standing(spans: PathMotions) -> Array:
    """Positions on motions, ends included, no farther apart than `NEAR_MM` and `NEAR`, (n, 3, 3) as `motions` gives.

    Parameters
    ----------
    spans : PathMotions
    """
    way = np.linalg.norm(spans.end - spans.start, axis=1) / NEAR_MM
    turn = angle_between(spans.before, spans.after) / NEAR
    count = np.maximum(np.ceil(np.maximum(way, turn)), 2)
    parts, _ = spans.split(count.astype(np.int64))
    # The end of a part is the start of the next one, but for the last part of motions that hang together.
    interrupted = (parts.end[:-1] != parts.start[1:]).any(axis=1)
    last = np.append(interrupted, len(parts.end) > 0)
    tips = np.concatenate([parts.start, parts.end[last]])
    axes = np.concatenate([parts.before, parts.after[last]])
    return motions(tips, axes)


def _touching(tool: Tool, group: CheckSurfaces, spans: PathMotions, allowance: float) -> PathCheck:
    """The cutter where it stands on the skin, or at faces that meet it harmlessly."""
    moves = standing(spans)
    required = np.array([group.required[0], -inf, -inf])
    table = np.tile(required, (len(group.faces), 1))
    bad = np.flatnonzero(keeps_limits(group.cells, tool, moves, table).blocked >= 0)
    if len(bad):
        return PathCheck(_worst(tool, group, moves[bad], required))
    return PathCheck(None, greatest_depth(tool, group, moves, allowance if group.role == SKIN else 0.0))


def _witness(tool: Tool, group: CheckSurfaces, spans: PathMotions, required: Array) -> Violation:
    """The worst position on motions that were not proven to keep their distances."""
    return _worst(tool, group, standing(spans), required)


def _worst(tool: Tool, group: CheckSurfaces, moves: Array, required: Array) -> Violation:
    return worst_motion(tool, group, moves, required, np.maximum(required, 0.0))
