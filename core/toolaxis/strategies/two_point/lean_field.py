"""In which direction a flat bottom leans over a face for two contacts: where strips are widest, turning little."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.strategies.two_point.contact import BRIDGE, STEEPEST, circle_strip_width, settle, two_point_lead
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.rings import FRONT, SIDES, ContactSet, CornerCircles

Array = NDArray[np.float64]

#: Directions and lifts (in shares of the tolerance) that are tried, at so many places along and across, and what a turn
#: costs, per rad^2.
DIRECTIONS, LIFTS, GRID = np.radians(np.arange(-60.0, 61.0, 15.0)), (1.0, 0.5, 0.0), (25, 7)
TURNING = 4.0
STRAIGHT = len(DIRECTIONS) // 2
#: Share of the formula's width from which straight ahead is good enough.
ENOUGH = 0.85


@dataclass(frozen=True, eq=False)
class LeanField:
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


def directions(work: TwoPointInputs, sense: int) -> LeanField:
    """Directions in which two-point contact leans over a face; found once.

    Parameters
    ----------
    work : TwoPointInputs
    sense : int
        1 where the axis leans towards growing parameter, -1 where towards the other end.
    """
    if sense not in work.found:
        work.found[sense] = field_of(work, sense)
    return work.found[sense]


def field_of(work: TwoPointInputs, sense: int) -> LeanField:
    """The directions in which settled rings leave the widest strips, turning little from place to place.

    Parameters
    ----------
    work : TwoPointInputs
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
    return LeanField(along, step, DIRECTIONS[chosen], lifts[best])


def _settled_width(work: TwoPointInputs, sense: int, uv: Array, how: tuple[ArrayLike, ArrayLike]) -> Array:
    """Widths of the strips of rings that settle from heights in directions, (n,) mm; 0 where they stay too high."""
    setting = work.setting(uv, sense)
    stand, ring = settle(setting, *how)
    return np.where(stand.lift <= work.scallop, _width(work, setting, ring), 0.0)


def _formula_width(work: TwoPointInputs, sense: int, uv: Array) -> Array:
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


def _width(work: TwoPointInputs, setting: ContactSet, ring: CornerCircles) -> Array:
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
