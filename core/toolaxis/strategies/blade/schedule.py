"""Tool angles of a path around a blade, layer by layer: one rotary axis that never turns back within a layer.

Every layer stands in its own plane of arc length S and tool angle theta.  Layers are independent of each other: each
begins and ends level, at the base vectors that it shares with its neighbours.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import asin, pi, radians
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import placement
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import as_rows, perpendicular, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.strategies.blade.angle_channel import AngleChannel, channel
from toolaxis.strategies.blade.key_points import KeyCurve, KeyRule, best_rule, key_curve
from toolaxis.strategies.blade.minimum_acceleration import LeastCurve, LeastProgramme, least_peak
from toolaxis.strategies.blade.section import HOLLOW, Section, section
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: "keys": key points, lines and rounded corners; "least": least peak acceleration.
CURVES = ("keys", "least")
#: Clearance of tool angles from their limits, rad.
CLEARANCE = radians(2.0)
#: By how much of the channel's width base vectors stay below its upper side: where a hollow ends there, and elsewhere.
_LIMIT, _MIDDLE = 0.1, 0.5
#: Ends of a turn may lie so far apart, as a share of its length, and still be those of a helix around a blade.
_HELIX = 0.02
#: A layer on which the common rule of key points does so much worse than elsewhere gets one of its own.
_WORSE = 1.3


class Curve(Protocol):
    """Tool angles theta(S) of a layer."""

    def at(self, lengths: Array) -> Array:
        """Angle, slope and second derivative at places, (3, n)."""


@dataclass(frozen=True, eq=False)
class SwivelAxis:
    """How a tool swings about one rotary axis.

    Attributes
    ----------
    direction : (3,) array
        Unit vector along that axis, in the part's frame.
    lean : float
        Angle of the tool axis from the plane across it, rad, positive towards it.
    """

    direction: Array
    lean: float = 0.0

    @property
    def plane(self) -> tuple[Array, Array]:
        """Two unit vectors across the axis; angles are counted from the first to the second."""
        return perpendicular(self.direction)

    def axes(self, theta: ArrayLike) -> Array:
        """Unit tool axes, (n, 3).

        Parameters
        ----------
        theta : (n,) array_like
            rad
        """
        x, y = self.plane
        angle = np.asarray(theta, dtype=float)[:, None]
        across = np.cos(angle) * x + np.sin(angle) * y
        return np.asarray(np.cos(self.lean) * across + np.sin(self.lean) * self.direction)

    def flat(self, points: Array) -> Array:
        """Points seen along the axis, (n, 2) mm.

        Parameters
        ----------
        points : (n, 3) array
        """
        return np.asarray(points @ np.stack(self.plane, axis=1))

    def angles(self, axes: Array) -> Array:
        """Tool angles of axes, (n,) rad, unwrapped.

        Parameters
        ----------
        axes : (n, 3) array
        """
        x, y = self.plane
        return np.unwrap(np.arctan2(axes @ y, axes @ x))


def swing_of(machine: Machine | None, blade: ArrayLike, table_from_part: ArrayLike | None = None) -> SwivelAxis:
    """The swing of a machine's only driven rotary axis; of another machine, about the blade's own direction.

    Parameters
    ----------
    machine : Machine or None
    blade : (3,) array_like
        Direction of the blade from its root to its tip.
    table_from_part : (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero.
    """
    own = np.asarray(unit(as_rows(blade, 3, "direction of the blade")[0]))
    rotary = () if machine is None else machine.rotary
    if machine is None or len(rotary) != 1:
        return SwivelAxis(own)
    along = np.asarray(rotary[0].direction, dtype=float)
    spindle = np.asarray(machine.spindle, dtype=float)
    here = along @ placement(table_from_part)[:3, :3]
    sense = 1.0 if here @ own >= 0 else -1.0
    return SwivelAxis(sense * here, asin(float(np.clip(sense * (along @ spindle), -1.0, 1.0))))


@dataclass(frozen=True, eq=False)
class Layer:
    """One turn of a path around a blade.

    Attributes
    ----------
    centres : (n, 3) array
        Cutter centres in their order, mm; the last one is where the next layer begins, or the first one again.
    """

    centres: Array


@dataclass(frozen=True, eq=False)
class ScheduledLayer:
    """A layer with its tool angles.

    Attributes
    ----------
    section : Section
        Anticlockwise, whatever the sense of the path.
    onward : bool
        Whether the path runs anticlockwise.
    wide, free : AngleChannel
        Of tool angles; the second less the clearance.
    curve : Curve
        theta(S), of the section.
    start, end : float
        Angles at its ends, rad.
    theta : (n,) array
        At the path's points, in the path's order, rad.
    axes : (n, 3) array
        Unit tool axes there.
    """

    section: Section
    onward: bool
    wide: AngleChannel
    free: AngleChannel
    curve: Curve
    start: float
    end: float
    theta: Array
    axes: Array

    @property
    def keys(self) -> Array:
        """S and theta of its key points, (k, 2)."""
        return self.curve.keys if isinstance(self.curve, KeyCurve) else np.empty((0, 2))

    @property
    def bound(self) -> float:
        """The least peak of theta'' that any rising curve between the same ends has, rad/mm^2."""
        return least_peak(self.free, self.start, self.end)

    @property
    def peak(self) -> float:
        """Greatest theta'' of its curve, rad/mm^2."""
        if isinstance(self.curve, LeastCurve):
            return float(np.abs(self.curve.bend).max())
        fine = np.linspace(0.0, self.section.length, 4001)
        return float(np.abs(self.curve.at(fine)[2]).max())


@dataclass(frozen=True, eq=False)
class SThetaLayer:
    """A layer in its S-theta plane, before its tool angles are known.

    Attributes
    ----------
    section : Section
    onward : bool
    wide : AngleChannel
    """

    section: Section
    onward: bool
    wide: AngleChannel

    @property
    def hollow(self) -> bool:
        """Whether the section has a hollow."""
        return bool((np.maximum.accumulate(self.section.ahead) - self.section.ahead).max() > HOLLOW)

    def within(self, low: Array, high: Array) -> "SThetaLayer":
        """The same with further limits of the angles at its points.

        Parameters
        ----------
        low, high : (n,) array
            rad, in the section's order.
        """
        return SThetaLayer(self.section, self.onward, self.wide.within(low, high))


def plane_of(layer: Layer, swing: SwivelAxis, tool: Tool | None, number: int = 1) -> SThetaLayer:
    """The section of a layer and its channel.

    Parameters
    ----------
    layer : Layer
    swing : SwivelAxis
    tool : Tool or None
        With a ball end; None for a cylinder.
    number : int
        What messages call the layer.

    Raises
    ------
    InvalidInput
        When the section is open or crosses itself, or points are repeated.
    """
    flat = swing.flat(layer.centres)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(flat, axis=0).T))])
    gap = flat[-1] - flat[0]
    if np.hypot(*gap) <= _HELIX * way[-1]:  # a turn of a helix on a blade that tapers: its section closes on the way
        flat = flat - np.outer(way / way[-1], gap)
    x, y = flat.T
    onward = bool((x[:-1] * y[1:] - x[1:] * y[:-1]).sum() > 0)
    rows = flat[:-1] if onward else flat[:0:-1]
    if (np.diff(rows, axis=0) == 0).all(axis=1).any():
        raise InvalidInput(f"layer {number} has the same cutter centre twice running: drop one of them")
    one = section(rows, f"the section of layer {number}")
    return SThetaLayer(one, onward, channel(one, tool))


def reschedule(layers: Sequence[Layer], swing: SwivelAxis, tool: Tool | None = None, *, curve: str = "keys",
               clearance: float = CLEARANCE, progress: Progress = NO_PROGRESS) -> tuple[ScheduledLayer, ...]:
    """Tool angles for the layers of a path around a blade.

    Parameters
    ----------
    layers : sequence of Layer
        In their order, each from the base point around to it; helical, or to and fro.
    swing : SwivelAxis
    tool : Tool, optional
        With a ball end; taper, shank and holder keep clear of each layer's own section.  A cylinder unless given.
    curve : str
        One of `CURVES`.
    clearance : float
        Of tool angles from their limits, rad.
    progress : Progress

    Returns
    -------
    tuple of ScheduledLayer

    Raises
    ------
    InvalidInput
        When a section is open or crosses itself, a channel closes, or no curve leads through it.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [stheta2023] Secs. 2 and 3.

    **Properties**: 1. theta rises along every layer that runs anticlockwise and falls along the others; 2. angle, slope
    and bend are continuous from layer to layer; 3. the work grows with the number of layers.
    """
    planes = [plane_of(layer, swing, tool, k + 1) for k, layer in enumerate(layers)]
    return schedule_layers(planes, swing, curve=curve, clearance=clearance, progress=progress)


def schedule_layers(planes: Sequence[SThetaLayer], swing: SwivelAxis, *, curve: str = "keys",
                    clearance: float = CLEARANCE, progress: Progress = NO_PROGRESS) -> tuple[ScheduledLayer, ...]:
    """Tool angles for layers in their S-theta planes.

    Parameters
    ----------
    planes, swing, curve, clearance, progress
        As for `reschedule`.
    """
    if curve not in CURVES:
        raise InvalidInput(f"curve of tool angles is {curve!r}: use keys or least")
    if not 0 <= clearance < pi / 2:
        raise InvalidInput(f"clearance of tool angles is {clearance} rad: it must lie between 0 and pi/2")
    if not planes:
        raise InvalidInput("there is no layer to schedule: give one turn around the blade at least")
    free = [one.wide.narrowed(clearance, f"layer {k + 1}") for k, one in enumerate(planes)]
    free, wide = _alongside(free, [one.wide for one in planes])
    ends = _ends(planes, free)
    shape = _Shapes(curve, free, ends)
    found = []
    for k, one in enumerate(planes):
        progress.report("tool angles", k, len(planes))
        made = shape.curve(free[k], *ends[k])
        theta = made.at(one.section.lengths)[0]
        theta = theta if one.onward else theta[::-1]
        found.append(ScheduledLayer(one.section, one.onward, wide[k], free[k], made, *ends[k], theta,
                                    swing.axes(theta)))
    return tuple(found)


class _Shapes:
    """What makes the curves of layers that are alike: found out once."""

    def __init__(self, kind: str, free: Sequence[AngleChannel], ends: Sequence[tuple[float, float]]) -> None:
        self.programme: LeastProgramme | None = None
        self.rule: KeyRule | None = None
        if kind == "least":
            self.programme = LeastProgramme(free[0])
            return
        some = sorted({0, len(free) // 2, len(free) - 1})
        tried: list[tuple[float, KeyRule]] = []
        for k in some:
            rule = best_rule(free[k], *ends[k])
            try:
                tried.append((max(key_curve(free[j], *ends[j], rule).peak for j in some), rule))
            except InvalidInput:  # does not fit all of them
                continue
        self.usual, self.rule = min(tried, key=lambda row: row[0]) if tried else (np.inf, None)

    def curve(self, free: AngleChannel, start: float, end: float) -> Curve:
        """That of one layer."""
        if self.programme is not None:
            return self.programme.solve(free, start, end)
        if self.rule is not None:
            try:
                made = key_curve(free, start, end, self.rule)
                if made.peak <= _WORSE * self.usual:
                    return made
            except InvalidInput:  # this layer needs a rule of its own
                pass
        return key_curve(free, start, end, best_rule(free, start, end))


def _alongside(free: list[AngleChannel], wide: list[AngleChannel]) -> tuple[list[AngleChannel], list[AngleChannel]]:
    """Channels moved by whole turns, each beside the one before it."""
    moved_free, moved_wide = [free[0]], [wide[0]]
    for one, other in zip(free[1:], wide[1:], strict=True):
        apart = float(moved_free[-1].high[0] - one.high[0])
        turn = 2 * pi * round(apart / (2 * pi))
        moved_free.append(_shift_channel(one, turn))
        moved_wide.append(_shift_channel(other, turn))
    return moved_free, moved_wide


def _shift_channel(one: AngleChannel, turn: float) -> AngleChannel:
    return AngleChannel(one.lengths, one.low + turn, one.high + turn)


def _ends(planes: Sequence[SThetaLayer], free: list[AngleChannel]) -> list[tuple[float, float]]:
    """Angles at S = 0 and at the end of each layer: base vectors that both layers at a base point allow.

    Raises
    ------
    InvalidInput
        When neighbours allow none in common.
    """
    base = []
    for k in range(len(planes) + 1):
        beside = [free[j] for j in (k - 1, k) if 0 <= j < len(planes)]
        low, high = max(float(one.low[0]) for one in beside), min(float(one.high[0]) for one in beside)
        if not low < high:
            raise InvalidInput(f"layers {k} and {k + 1} allow no tool angle in common at their base point: make the "
                               "layers thinner, or begin where the blade is less twisted")
        hollow = planes[min(k, len(planes) - 1)].hollow
        base.append(high - (_LIMIT if hollow else _MIDDLE) * (high - low))
    return [(base[k], base[k + 1] + 2 * pi) if one.onward else (base[k + 1], base[k] + 2 * pi)
            for k, one in enumerate(planes)]
