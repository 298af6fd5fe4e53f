"""The visibility-safe channel of tool angles around a blade: every rising curve inside it clears the section.

Angles theta are those of the tool in the plane of the section, unwrapped with the tangents.  At a cutter centre the
tool sees out of the section between the tangent and the opposite of it, and beyond a hollow less; a rising curve must
also keep below what comes and above what was.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import degrees, pi

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import LONGER_STICKOUT, SLIMMER_TOOL
from toolaxis.errors import InvalidInput
from toolaxis.strategies.blade.section import Section
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Places of an outline between two of its corners, and distances from the cutter's centre in the table of half angles.
_FINE, _TABLE = 40, 400


@dataclass(frozen=True, eq=False)
class AngleChannel:
    """Least and greatest tool angles along a section.

    Attributes
    ----------
    lengths : (n,) array
        S, mm.
    low, high : (n,) array
        rad; neither falls.
    """

    lengths: Array
    low: Array
    high: Array

    @property
    def width(self) -> float:
        """Least width, rad; negative where it closes."""
        return float((self.high - self.low).min())

    def within(self, low: Array, high: Array) -> "AngleChannel":
        """The rising part of the channel inside further limits.

        Parameters
        ----------
        low, high : (n,) array
            rad
        """
        further_low = np.maximum(self.low, low)
        further_high = np.minimum(self.high, high)
        return _rising(self.lengths, further_low, further_high)

    def narrowed(self, clearance: float, place: str = "the section") -> "AngleChannel":
        """The channel less a clearance on both sides.

        Parameters
        ----------
        clearance : float
            rad
        place : str
            What messages call the layer.

        Raises
        ------
        InvalidInput
            When it closes; with the place and the amount.
        """
        made = AngleChannel(self.lengths, self.low + clearance, self.high - clearance)
        if not made.width > 0:
            k = int(np.argmin(made.high - made.low))
            raise InvalidInput(f"the channel of tool angles closes on {place} at S = {self.lengths[k]:.2f} mm: "
                               f"{degrees(-made.width):.2f} deg are missing for a rotary axis that does not turn back; "
                               f"take {SLIMMER_TOOL} or holder, {LONGER_STICKOUT}, or less clearance")
        return made

    def slack(self, lengths: Array, theta: Array) -> Array:
        """How far angles lie inside the channel at places, rad, negative outside; between points by straight lines.

        Parameters
        ----------
        lengths, theta : (k,) array
        """
        low = np.interp(lengths, self.lengths, self.low)
        high = np.interp(lengths, self.lengths, self.high)
        return np.minimum(theta - low, high - theta)


def _rising(lengths: Array, low: Array, high: Array) -> AngleChannel:
    """What a curve that never falls, and gains a turn in each turn around, can use of limits for one turn around."""
    turn_before = low - 2 * pi
    turn_after = high + 2 * pi
    both_high = np.concatenate([high, turn_after])
    both_low = np.concatenate([turn_before, low])
    least_from_here = np.minimum.accumulate(both_high[::-1])[::-1]
    greatest_up_to_here = np.maximum.accumulate(both_low)
    top = least_from_here[:len(high)]
    bottom = greatest_up_to_here[len(low):]
    return AngleChannel(lengths, bottom, top)


def channel(one: Section, tool: Tool | None = None) -> AngleChannel:
    """The channel of a section, for a tool whose cylinder, taper, shank and holder keep clear of it.

    Parameters
    ----------
    one : Section
        Of the cutter's centres.
    tool : Tool, optional
        With a ball end; a cylinder of the ball's radius unless given.

    Notes
    -----
    theta_max(S) = min over S' >= S of phi(S'), theta_min(S) = max over S' <= S of phi(S') - pi, phi the tangent angle.
    Every rising curve that clears the section lies in it: at the place where phi is least the tool must be below phi,
    and before that below what it is there.  A taper takes its half angle off both sides; shank and holder, where they
    are wider than that cone, are held against the section point by point.

    **Source**: [stheta2023] Eqs. (1), (2), with the backward limit Q_i - Q_(i-1) turned round, and the rule for hollow
    parts replaced: the printed one does not see past the end of a hollow.

    **Properties**: 1. no rising curve inside meets the section; 2. both sides rise.
    """
    made = _rising(one.lengths, one.behind - pi, one.ahead)
    if tool is None:
        return made
    low = made.low + tool.half_angle
    high = made.high - tool.half_angle
    if _wider(tool):
        least, greatest = clear_angle_range(one, tool)
        low = np.maximum(low, least)
        high = np.minimum(high, greatest)
    return _rising(one.lengths, low, high)


def _wider(tool: Tool) -> bool:
    """Whether some of the tool leaves the cone that touches its ball, or the cylinder."""
    rho, z = tool.profile.tangent_point
    line = _side(tool)
    cone = rho + np.tan(tool.half_angle) * (line[:, 1] - z)
    return bool((line[:, 0] > cone + 1e-9).any())


def _side(tool: Tool) -> Array:
    """Corners (radius, z) of the tool's side above the ball, upwards."""
    profile = tool.profile
    ends = [profile.tangent_point, (profile.top_radius, profile.top)]
    return np.concatenate([np.array(ends), *tool.outlines.values()])


def half_angles(tool: Tool, distances: Array) -> Array:
    """The greatest angle, rad, to its axis at which the tool fills circles around its ball's centre.

    Parameters
    ----------
    tool : Tool
    distances : (n,) array
        Radii of the circles, mm; half of a circle counts within the ball's radius.
    """
    corners = _side(tool)
    ball = tool.corner_radius
    share = np.linspace(0.0, 1.0, _FINE)[:, None]
    fine = np.concatenate([a + (b - a) * share for a, b in pairwise(corners)])
    radius = fine[:, 0]
    height = fine[:, 1] - ball
    reach = np.hypot(radius, height)
    angle = np.arctan2(radius, height)
    farthest = reach.max()
    edges = np.linspace(ball, farthest, _TABLE)
    table = np.zeros(_TABLE)
    for a, b, one, other in zip(reach[:-1], reach[1:], angle[:-1], angle[1:], strict=True):
        first, last = np.searchsorted(edges, (min(a, b), max(a, b)))
        span = slice(max(first - 1, 0), last + 1)
        table[span] = np.maximum(table[span], max(one, other))
    found = np.interp(distances, edges, table)
    found = np.where(distances > farthest, 0.0, found)
    return np.where(distances <= ball, pi / 2, found)


def clear_angle_range(one: Section, tool: Tool) -> tuple[Array, Array]:
    """Least and greatest angles at each point of a section at which a whole tool clears the blade inside, (n,) each.

    Parameters
    ----------
    one : Section
    tool : Tool
        With a ball end.

    Notes
    -----
    The blade's points lie the ball's radius inside the section.  Seen from a cutter centre the angles that they bar
    hang together, from the tangent ahead to the one behind.
    """
    inner = one.points[:-1]
    number = len(inner)
    way = (one.ahead[:-1] + one.behind[:-1]) / 2
    inwards = np.column_stack([-np.sin(way), np.cos(way)])
    blade = inner + tool.corner_radius * inwards
    every = np.arange(number)
    order = (every[:, None] + every) % number
    seen = blade[order] - inner[:, None]
    distance = np.hypot(seen[..., 0], seen[..., 1])
    angle = np.arctan2(seen[..., 1], seen[..., 0])
    begin = (way + pi / 2)[:, None]
    # Unwrapped from the tangent ahead on, point by point.
    first_turn = _turn(angle[:, :1] - begin)
    turns = _turn(np.diff(angle, axis=1))
    angle = begin + np.cumsum(np.concatenate([first_turn, turns], axis=1), axis=1)
    half = np.minimum(half_angles(tool, distance), pi / 2)
    high = (angle - half).min(axis=1)
    low = (angle + half).max(axis=1) - 2 * pi
    return _close(low), _close(high)


def _close(angles: Array) -> Array:
    """Angles around a section with the first one, a turn later, at their end."""
    return np.append(angles, angles[0] + 2 * pi)


def _turn(angle: Array) -> Array:
    return np.asarray((angle + pi) % (2 * pi) - pi)
