"""How fast a machine goes along a face's passes with an axis: the estimate by which a search for least time goes.

The time of an axis is its cutting length over a mean speed and, for each pass, what the ends of a pass take.
The mean speed is that of the tip on a few passes across the face, from rest to rest, with the rotary axes turned to the
axis, by the planner of feeds.  The ends are those of a pass on a plane: ramps, and up, over and down.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.feed.fixed_axis_time import Feeds, index_time
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import linear_bounds
from toolaxis.feed.polyline import schedule_polyline
from toolaxis.feed.velocity_ramps import bends_of, greatest_speeds
from toolaxis.machine.kinematics import part_from_machine, rotary_angles
from toolaxis.machine.setup import Mounting
from toolaxis.path.links import Linking
from toolaxis.path.sampling import sample_passes
from toolaxis.plan.plan import INDEX_SECONDS
from toolaxis.search.direction_grid import ring
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Points that a piece of a pass has at least.
_LEAST = 8
#: Points of the run beyond each end of a pass.
_RUN = 6
#: Steps that count as none, mm, and the least sine of an angle between axis and normal.
_STILL, _UPRIGHT = 1e-6, 1e-3
#: Length of a pass on which starting and stopping are told apart from the rest, mm.
_LONG = 1e4
#: How far a typical turn from one tool axis to the next goes, rad.
_ASIDE = np.radians(30.0)
#: How far the next pass begins from the end of one in the estimate, mm.
_STEP = 1.0


class _Line(NamedTuple):
    """A pass: middles of the cutter's rounding and normals, (n, 3), way along them, (n,) mm, and length of the cut."""

    middles: Array
    normals: Array
    along: Array
    length: float


@dataclass(frozen=True, eq=False)
class TimeEstimate:
    """A machine's speed on a face.

    Attributes
    ----------
    face : Face
    tool : Tool
    mounting : Mounting
        The machine with the part on its table; it states the limits of its axes.
    feeds : Feeds
    """

    face: Face
    tool: Tool
    mounting: Mounting
    feeds: Feeds

    @cached_property
    def lines(self) -> tuple[tuple[_Line, ...], tuple[_Line, ...]]:
        """Passes with feed u and v that stand for all."""
        return self._lines(0), self._lines(1)

    def _lines(self, along: int) -> tuple[_Line, ...]:
        found = []
        for uv in sample_passes(self.face, along):
            run = self._run_out(uv, along)
            points, normals = self.face.evaluate(run).point, self.face.normal(run)
            moving = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > _STILL])
            middles = points + self.tool.corner_radius * normals
            moving[1:] &= np.linalg.norm(np.diff(middles, axis=0), axis=1) > _STILL
            if moving.sum() >= _LEAST:
                steps = np.linalg.norm(np.diff(middles[moving], axis=0), axis=1)
                length = float(np.linalg.norm(np.diff(points[moving], axis=0), axis=1).sum())
                found.append(_Line(middles[moving], normals[moving], np.concatenate([[0.0], np.cumsum(steps)]),
                                   length))
        return tuple(found)

    def _run_out(self, uv: Array, along: int) -> Array:
        """Parameters of a pass with its run beyond both ends, where the surface goes on straight."""
        d = self.face.evaluate(uv[[0, -1]])
        speeds = np.linalg.norm(d.su if along == 0 else d.sv, axis=1)
        reach = self.tool.corner_radius / np.maximum(speeds, _STILL)
        more = np.arange(1, _RUN + 1) / _RUN
        before, after = np.repeat(uv[:1], _RUN, axis=0), np.repeat(uv[-1:], _RUN, axis=0)
        before[:, along] -= reach[0] * more[::-1]
        after[:, along] += reach[1] * more
        return np.concatenate([before, uv, after])

    def _tips(self, line: _Line, axes: Array) -> Array:
        """Tool tips along a line with axes, (k, n, 3) mm; constant parts left out."""
        upright = (axes @ line.normals.T)[..., None]
        outward = line.normals - upright * axes[:, None]
        size = np.maximum(np.linalg.norm(outward, axis=2, keepdims=True), _UPRIGHT)
        return np.asarray(line.middles + self.tool.flat_radius * outward / size)

    @cached_property
    def ends(self) -> float:
        """What the ends of a pass take: off its end, over to the next and onto that, s."""
        ramp = Linking(0.0).run_in / np.sqrt(2)
        steps = np.array([(0, 0, 0), (ramp, 0, ramp), (0, _STEP, 0), (-ramp, 0, -ramp)], dtype=float)
        slow = self.feeds.cut if self.feeds.approach is None else self.feeds.approach
        wanted = [slow] * (len(steps) - 1)
        tips = np.cumsum(steps, axis=0)
        bounds = linear_bounds(self.mounting.machine)
        return schedule_polyline(tips, tips, wanted, bounds, self.feeds.tolerance).duration

    def speeds(self, axes: Array) -> Array:
        """Mean speed along passes with feed u and v, (k, 2) mm/s.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.
        """
        joint_from_part = self._joint_from_part(axes)
        found = np.full((len(axes), 2), self.feeds.cut)
        for feed, lines in enumerate(self.lines):
            times = [self._seconds_along(line, axes, joint_from_part) for line in lines]
            if times:
                found[:, feed] = sum(line.length for line in lines) / np.sum(times, axis=0)
        return found

    def _seconds_along(self, line: _Line, axes: Array, joint_from_part: Array) -> Array:
        """Time of a pass with axes, (k,) s: that of a straight one as long, and what its bends add where they slow it.
        """
        bounds = linear_bounds(self.mounting.machine)
        bend = bends_of(self._tips(line, axes), line.along)
        speeds = greatest_speeds(bend, joint_from_part, self.feeds.cut, bounds)
        assert bend.stretch is not None
        way = bend.stretch * (bend.length / speeds.shape[1])
        straight = travel_time(way.sum(axis=1), self.feeds.cut, bounds.acceleration.min(), bounds.jerk.min())
        return np.asarray(straight + (way / speeds - way / self.feeds.cut).sum(axis=1))

    def _rotary_angles_of(self, axes: Array) -> Array:
        """Rotary angles that give axes, (k, m) rad."""
        turned = rotary_angles(self.mounting.machine, axes, table_from_part=self.mounting.table_from_part)
        return np.asarray(turned.joints[np.arange(len(axes)), np.argmax(turned.within, axis=1)])

    def _joint_from_part(self, axes: Array) -> Array:
        """What the linear axes move for a motion on the part, with the rotary axes turned to axes, (k, 3, 3)."""
        return np.asarray(np.linalg.inv(part_from_machine(self.mounting.machine, self._rotary_angles_of(axes),
                                                          self.mounting.table_from_part)))

    def line_seconds(self, uv: Array, axes: Array) -> Array:
        """Time along a line of the face between points at the speed that its bends allow, (k, n - 1) s.

        Parameters
        ----------
        uv : (n, 2) array
            Parameters on one iso-curve, ascending, n of at least 64 for the sake of the third derivative.
        axes : (k, 3) array
            Unit vectors.
        """
        points, normals = self.face.evaluate(uv).point, self.face.normal(uv)
        middles = points + self.tool.corner_radius * normals
        steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
        way = np.linalg.norm(np.diff(points, axis=0), axis=1)
        moving = np.concatenate([[True], steps > _STILL])
        if moving.sum() < _LEAST:  # a pole: what is no way takes no time
            return np.broadcast_to(way / self.feeds.cut, (len(axes), len(way)))
        along_middles = np.concatenate([[0.0], np.cumsum(steps)])
        line = _Line(middles[moving], normals[moving], along_middles[moving], float(way.sum()))
        bend = bends_of(self._tips(line, axes), line.along)
        bounds = linear_bounds(self.mounting.machine)
        speeds = greatest_speeds(bend, self._joint_from_part(axes), self.feeds.cut, bounds)
        count = speeds.shape[1]
        assert bend.stretch is not None
        slowness = bend.stretch / speeds
        total = np.concatenate([np.zeros((len(axes), 1)), np.cumsum(slowness, axis=1)], axis=1) * (bend.length / count)
        places = np.linspace(0.0, bend.length, count + 1)
        return np.diff(np.array([np.interp(along_middles, places, row) for row in total]), axis=1)

    @cached_property
    def start_and_stop(self) -> float:
        """What a straight pass takes longer for starting and ending at rest, s."""
        bounds = linear_bounds(self.mounting.machine)
        speed = min(self.feeds.cut, float(bounds.velocity.min()))
        return float(travel_time(_LONG, speed, bounds.acceleration.min(), bounds.jerk.min())) - _LONG / speed

    def turning(self, axis: Array) -> float:
        """Time to turn to another tool axis, s: the mean over axes `_ASIDE` away that the machine holds.

        Parameters
        ----------
        axis : (3,) array
        """
        machine, place = self.mounting.machine, self.mounting.table_from_part
        start = self._rotary_angles_of(axis[None])[0]
        turned = rotary_angles(machine, ring(axis, _ASIDE), start, place)
        times = [min(index_time(machine, start, end, INDEX_SECONDS) for end in ends[within])
                 for ends, within in zip(turned.joints, turned.within, strict=True) if within.any()]
        return float(np.mean(times)) if times else INDEX_SECONDS

    def seconds(self, axes: Array, passes: Array, length: Array) -> Array:
        """Time that passes take, (k, 2) s.

        Parameters
        ----------
        axes : (k, 3) array
            Unit vectors.
        passes, length : (k, 2) array
            Number and cutting length, mm, for feed u and v.
        """
        return np.asarray(length / self.speeds(axes) + passes * self.ends)


def pace_of(face: Face, tool: Tool, mounting: Mounting | None, feeds: Feeds | None) -> TimeEstimate:
    """The pace of a machine on a face.

    Parameters
    ----------
    face : Face
    tool : Tool
    mounting : Mounting or None
    feeds : Feeds or None

    Raises
    ------
    InvalidInput
        When there is no machine, it does not state all limits, or no feed is given.
    """
    known = require_machine_limits(mounting)
    if feeds is None:
        raise InvalidInput("objective 'time' needs feeds: give toolaxis.feed.fixed_axis_time.Feeds with the programmed "
                           "feed")
    return TimeEstimate(face, tool, known, feeds)


def require_machine_limits(mounting: Mounting | None) -> Mounting:
    """A machine that states all that times need.

    Parameters
    ----------
    mounting : Mounting or None

    Raises
    ------
    InvalidInput
        When it is none, or a limit of an axis is not stated.
    """
    if mounting is None:
        raise InvalidInput("objective 'time' needs a machine: name one that states velocity, acceleration and jerk of "
                           "its axes")
    if mounting.machine.unstated:
        raise InvalidInput(f"objective 'time' needs all limits of the machine, and {mounting.machine.name} does not "
                           f"state {mounting.machine.unstated}: complete its file, or choose another objective")
    return mounting
