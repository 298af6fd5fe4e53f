"""Postures of a flat end along passes: two-point contact, and what it is measured against."""

from dataclasses import dataclass, field
from math import radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.rings import FRONT, SIDES, Rings, Setting, Stand, rings
from toolaxis.contact.two_point import (
    BRIDGE,
    STEEPEST,
    TOUCH,
    balance,
    circle_strip_width,
    matched_lead,
    raised,
    settle,
    sunk,
    two_point_lead,
)
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: "two-point": gouge-free with two contacts where they can be had; "formula": the paper's lean, lifted; "matched": the
#: curvature-matched lean; "one-point": the least gouge-free lean with one contact; "sturz": one lean everywhere.
POSTURES = ("two-point", "formula", "matched", "one-point", "sturz")

TWO, CONVEX, BEHIND, UNEVEN, TIGHT = range(5)
#: Why a point has one contact, or none; the order of the codes.
REASONS = ("two contacts", "one contact: the surface is not hollow across the feed",
           "one contact: the back of the bottom needs more lean than two contacts have",
           "one contact: the surface is uneven across the feed",
           "no contact within the tolerance: the surface is tighter than the cutter")

#: Directions and lifts (in shares of the tolerance) that are tried, at so many places along and across, and what a turn
#: costs, per rad^2.
DIRECTIONS, LIFTS, GRID = np.radians(np.arange(-60.0, 61.0, 15.0)), (1.0, 0.5), (13, 5)
TURNING = 4.0
STRAIGHT = len(DIRECTIONS) // 2
#: Share of the formula's width from which straight ahead is good enough.
ENOUGH = 0.85
#: Greatest change of the lean on a way as long as the tool's radius, rad, and of its height in shares of that way.
TURN = 1.0


@dataclass(frozen=True, eq=False)
class Work:
    """What is to be machined, with what, and how the cutter shall stand.

    Attributes
    ----------
    face : Face
    tool : Tool
        A flat end or a torus.
    scallop : float
        The tolerance: height that may stay, mm.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    posture : str
        One of `POSTURES`.
    lead : float
        Of "sturz", rad.
    allowance : float
        Stock left on the face, mm.
    limits : Tolerance

    Raises
    ------
    InvalidInput
        When the feed or the posture is unknown, or a size is out of range.
    """

    face: Face
    tool: Tool
    scallop: float
    feed: str = "u"
    posture: str = "two-point"
    lead: float = radians(20.0)
    allowance: float = 0.0
    limits: Tolerance = field(default_factory=Tolerance)
    _fields: "dict[int, Field]" = field(default_factory=dict, repr=False, init=False)

    def __post_init__(self) -> None:
        if self.feed not in ("u", "v"):
            raise InvalidInput(f"feed is {self.feed!r}: it must be 'u' or 'v'")
        if self.posture not in POSTURES:
            raise InvalidInput(f"posture is {self.posture!r}: it must be one of {', '.join(POSTURES)}")
        if not 0 < self.lead <= STEEPEST:
            raise InvalidInput(f"lead is {np.degrees(self.lead):.3f} degrees: it must be above 0 and at most "
                               f"{np.degrees(STEEPEST):.0f}")
        self.setting(np.empty((0, 2)), 1)

    @property
    def column(self) -> int:
        """Column of uv that varies along the passes."""
        return 0 if self.feed == "u" else 1

    @property
    def span(self) -> tuple[float, float, float, float]:
        """along0, along1, step0, step1 of the face."""
        u0, u1, v0, v1 = self.face.bounds
        return (u0, u1, v0, v1) if self.feed == "u" else (v0, v1, u0, u1)

    def uv(self, along: Array, step: float) -> Array:
        """Parameters (n, 2) of places along a pass.

        Parameters
        ----------
        along : (n,) array
        step : float
        """
        pair = np.column_stack([along, np.full(len(along), step)])
        return pair if self.feed == "u" else pair[:, ::-1].copy()

    def field(self, sense: int) -> "Field":
        """Directions in which two-point contact leans.

        Parameters
        ----------
        sense : int
            As for `postures`.
        """
        if sense not in self._fields:
            self._fields[sense] = field_of(self, sense)
        return self._fields[sense]

    def setting(self, uv: Array, sense: int) -> Setting:
        """Contacts with travel in increasing (1) or decreasing (-1) parameter.

        Parameters
        ----------
        uv : (n, 2) array
        sense : int
        """
        d = self.face.evaluate(uv)
        return Setting(self.face, self.tool, uv, sense * (d.su if self.feed == "u" else d.sv), self.scallop,
                       self.allowance, self.limits)


@dataclass(frozen=True, eq=False)
class Field:
    """In which direction the cutter leans over a face, and from what height it settles: even over a grid.

    Attributes
    ----------
    along, step : (k,), (m,) array
        Lines of the grid.
    direction, lift : (k, m) array
        rad, mm
    """

    along: Array
    step: Array
    direction: Array
    lift: Array

    def at(self, along: Array, step: float) -> tuple[Array, Array]:
        """Directions and lifts along a pass, (n,) each; beyond the grid as on its border.

        Parameters
        ----------
        along : (n,) array
        step : float
        """
        j = int(np.clip(np.searchsorted(self.step, step) - 1, 0, len(self.step) - 2))
        share = float(np.clip((step - self.step[j]) / (self.step[j + 1] - self.step[j]), 0.0, 1.0))
        rows = ((1 - share) * table[:, j] + share * table[:, j + 1] for table in (self.direction, self.lift))
        direction, lift = (np.interp(along, self.along, row) for row in rows)
        return direction, lift


def field_of(work: Work, sense: int) -> Field:
    """The directions in which settled rings leave the widest strips, turning little from place to place.

    Parameters
    ----------
    work : Work
    sense : int

    Notes
    -----
    Line by line across the face, the sequence of `DIRECTIONS` along the pass is the best one by dynamic programming:
    it costs the square of the narrowness of the strips and `TURNING` for the square of each turn, also from the line
    before.
    """
    a0, a1, s0, s1 = work.span
    along, step = np.linspace(a0, a1, GRID[0]), np.linspace(s0, s1, GRID[1] + 2)[1:-1]
    lifts = BRIDGE * work.scallop * np.array(LIFTS)
    shape = (len(along), len(step), len(DIRECTIONS), len(lifts))
    uv = np.stack([work.uv(along, place) for place in step], axis=1)
    wide = np.zeros(shape)
    wide[:, :, STRAIGHT, 0] = _settled_width(work, sense, uv.reshape(-1, 2), (lifts[0], 0.0)).reshape(shape[:2])
    poor = wide[:, :, STRAIGHT, 0] < ENOUGH * _formula_width(work, sense, uv.reshape(-1, 2)).reshape(shape[:2])
    index = np.stack([rows[np.repeat(poor[..., None, None], shape[2], 2).repeat(shape[3], 3)]
                      for rows in np.indices(shape)])
    wide[tuple(index)] = _settled_width(work, sense, uv[index[0], index[1]], (lifts[index[3]], DIRECTIONS[index[2]]))
    usual = work.tool.radius
    cost = (usual / np.maximum(wide.max(axis=3), 1e-3 * usual)) ** 2
    turn = TURNING * np.subtract.outer(DIRECTIONS, DIRECTIONS) ** 2
    chosen = np.empty(shape[:2], dtype=int)
    middle = len(step) // 2
    for j in sorted(range(len(step)), key=lambda k: abs(k - middle)):
        beside = [] if j == middle else [chosen[:, j + (1 if j < middle else -1)]]
        here = cost[:, j] + sum(turn[:, rows].T for rows in beside)
        chosen[:, j] = _cheapest(np.asarray(here), turn)
    best = np.take_along_axis(wide, chosen[..., None, None], axis=2)[..., 0, :].argmax(axis=2)
    return Field(along, step, DIRECTIONS[chosen], lifts[best])


def _settled_width(work: Work, sense: int, uv: Array, how: tuple[ArrayLike, ArrayLike]) -> Array:
    """Widths of the strips of rings that settle from heights in directions, (n,) mm; 0 where they stay too high."""
    setting = work.setting(uv, sense)
    stand, ring = settle(setting, *how)
    return np.where(stand.lift <= work.scallop, _width(work, setting, ring), 0.0)


def _formula_width(work: Work, sense: int, uv: Array) -> Array:
    """Width of the formula's strip, (n,) mm; 0 where nothing is to be bridged, infinite where the cutter is too large:
    other directions are tried there."""
    across, radius = work.setting(uv, sense).curvatures()[1], work.tool.flat_radius
    fits = (across > 1e-6) & (radius * across < np.sin(STEEPEST))
    rho = np.where(fits, 1 / np.where(fits, across, 1.0), 1e6)
    lead = two_point_lead(radius, rho, work.scallop)
    width = circle_strip_width(radius, rho, work.scallop, lead, work.scallop)
    return np.where(fits, width, np.where(across > 1e-6, np.inf, 0.0))


def _cheapest(cost: Array, turn: Array) -> NDArray[np.intp]:
    """The cheapest choice in each row, (k,), with a price on each turn to the next."""
    total, back = cost[0], []
    for row in cost[1:]:
        paths = total[:, None] + turn
        back.append(paths.argmin(axis=0))
        total = paths.min(axis=0) + row
    path = [int(total.argmin())]
    for step in reversed(back):
        path.append(int(step[path[-1]]))
    return np.array(path[::-1])


def _width(work: Work, setting: Setting, ring: Rings) -> Array:
    """Width of what standing rings leave within the tolerance across the passes, (n,) mm."""
    d = work.face.evaluate(setting.uv)
    pace = np.linalg.norm(d.sv if work.feed == "u" else d.su, axis=1)
    beside, height = ring.uv[:, FRONT, 1 - work.column], ring.height[:, FRONT]
    ends = [strip_end(work.scallop, (beside, height), columns)[0] for columns in SIDES]
    return np.asarray(np.abs(ends[0] - ends[1]) * pace)


def strip_end(limit: float, lines: tuple[Array, Array], columns: range) -> tuple[Array, NDArray[np.int64]]:
    """Where a side of a strip ends, (t,), and how many lines beyond the middle one it takes to get there, (t,).

    Parameters
    ----------
    limit : float
        Greatest height, mm.
    lines : tuple of (t, k) array
        Step parameter and height of what each point of the front half of the ring leaves.
    columns : range
        One of `SIDES`: from the contact outwards.
    """
    across, height = (rows[:, list(columns)] for rows in lines)
    bad = ~(height <= limit * (1 + 1e-6))
    last = across.shape[1] - 1
    k = np.where(bad.any(axis=1), np.argmax(bad, axis=1), last)
    i, before = np.arange(len(k)), np.maximum(k - 1, 0)
    rise = height[i, k] - height[i, before]
    share = np.where(bad[i, k] & (rise > 0), (limit - height[i, before]) / np.where(rise > 0, rise, 1.0), 1.0)
    end = across[i, before] + np.clip(share, 0.0, 1.0) * (across[i, k] - across[i, before])
    return np.where(np.isfinite(end), end, across[i, before]), k


@dataclass(frozen=True, eq=False)
class Postures:
    """How the cutter stands along a pass.

    Attributes
    ----------
    uv : (n, 2) array
        Contacts that the posture is named by; the cutter is `stand.lift` above them.
    stand : Stand
    ring : Rings
    normal : (n, 3) array
    reason : (n,) array of int8
        Index into `REASONS`; that of the gouge-free postures.
    """

    uv: Array
    stand: Stand
    ring: Rings
    normal: Array
    reason: NDArray[np.int8]

    @property
    def contacts(self) -> NDArray[np.int8]:
        """Number of contacts, (n,)."""
        return np.where(self.reason == TWO, 2, np.where(self.reason == TIGHT, 0, 1)).astype(np.int8)


def postures(work: Work, along: Array, step: float, sense: int,
             near: tuple[Array, Stand] | None = None) -> Postures:
    """Postures along a pass.

    Parameters
    ----------
    work : Work
    along : (n,) array
        Places along the pass, in growing order.
    step : float
    sense : int
        1 where the axis leans towards growing parameter, -1 where towards the other end.
    near : tuple, optional
        Places in growing order and how the cutter stands there: it stands about so between them.

    Notes
    -----
    **Source**: [jang2021] Secs. 2 and 3.1 for "matched" and "formula"; the others are ours.
    """
    setting = work.setting(work.uv(along, step), sense)
    zero = np.zeros(len(along))
    if work.posture in ("two-point", "one-point"):
        stand, ring = _between(setting, along, near) if near is not None else _settled(work, setting, along, step)
    else:
        lean = np.full(len(along), work.lead) if work.posture == "sturz" else _by_formula(work, setting)
        stand = Stand(lean, zero, zero + (BRIDGE * work.scallop if work.posture == "formula" else 0.0))
        ring = rings(setting, stand)
    return Postures(setting.uv, stand, ring, setting.frame.normal, _reasons(work, setting, stand, ring))


def _between(setting: Setting, along: Array, near: tuple[Array, Stand]) -> tuple[Stand, Rings]:
    """Postures between others, leaning more where these gouge."""
    rows = (np.interp(along, near[0], rows) for rows in (near[1].lean, near[1].direction, near[1].lift))
    return raised(setting, Stand(*rows))


def _settled(work: Work, setting: Setting, along: Array, step: float) -> tuple[Stand, Rings]:
    """Settled postures that follow each other without jumps; beyond the ends of the face as at them."""
    lift: Array | float = 0.0
    direction = np.zeros(len(along))
    if work.posture == "two-point":
        sense = 1 if (setting.feed * work.setting(setting.uv[:1], 1).feed).sum() > 0 else -1
        direction, lift = work.field(sense).at(along, step)
        direction = direction + _even(along, balance(setting, lift, direction) - direction)
    stand, _ = settle(setting, lift, direction)
    a0, a1 = work.span[:2]
    inside = (along >= a0 - 1e-9) & (along <= a1 + 1e-9)
    if inside.any():
        stand = Stand(*(np.interp(along, along[inside], rows[inside])
                        for rows in (stand.lean, stand.direction, stand.lift)))
    way = np.linalg.norm(np.diff(work.face.evaluate(setting.uv).point, axis=0), axis=1)
    place = np.concatenate([[0.0], np.cumsum(way)])
    apart = np.abs(np.subtract.outer(place, place)) / work.tool.radius
    lean = np.minimum((stand.lean - TURN * apart).max(axis=1), STEEPEST)
    rise = (stand.lift - TURN * work.tool.radius * apart).max(axis=1)
    return sunk(setting, Stand(lean, stand.direction, np.where(rise > work.scallop, rise, stand.lift)))


def _by_formula(work: Work, setting: Setting) -> Array:
    """The paper's lean where the surface is hollow and wider than the cutter; the least and the steepest elsewhere."""
    across = setting.curvatures()[1]
    radius = work.tool.flat_radius
    fits = (across > 1e-9) & (radius * across < np.sin(STEEPEST))
    rho = np.where(fits, 1 / np.where(fits, across, 1.0), 1e9)
    lean = matched_lead(radius, rho) if work.posture == "matched" else two_point_lead(radius, rho, work.scallop)
    return np.clip(np.where(fits, lean, np.where(across > 0, STEEPEST, 0.0)), setting.least_lean, STEEPEST)


def _even(along: Array, direction: Array) -> Array:
    """Directions without gaps and jumps: those that were found, smoothed; straight on where none was."""
    known = np.isfinite(direction)
    if not known.any():
        return np.zeros(len(along))
    order = np.argsort(along)
    rows = np.where(known, direction, 0.0)[order]
    width = 0.02 * (along.max() - along.min()) or 1.0
    near = np.exp(-0.5 * ((along[order][:, None] - along[order][None]) / width) ** 2)
    even = np.empty(len(along))
    even[order] = near @ rows / near.sum(axis=1)
    return even


def _reasons(work: Work, setting: Setting, stand: Stand, ring: Rings) -> NDArray[np.int8]:
    across = setting.curvatures()[1]
    both = (np.abs(ring.sides) <= 5 * TOUCH).all(axis=1) & (stand.lift > TOUCH)
    return np.select(
        [stand.lift > work.scallop * (1 + 1e-6), both, across <= 1e-9, np.abs(ring.sides).max(axis=1) > 5 * TOUCH],
        [TIGHT, TWO, CONVEX, UNEVEN], BEHIND).astype(np.int8)
