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
        j = int(np.searchsorted(self.step, step)) - 1
        j = int(np.clip(j, 0, len(self.step) - 2))
        before, behind = self.step[j:j + 2]
        share = (step - before) / (behind - before)
        share = float(np.clip(share, 0.0, 1.0))

        def interpolate(table: Array) -> Array:
            row = (1 - share) * table[:, j] + share * table[:, j + 1]
            return np.asarray(np.interp(along, self.along, row))

        return interpolate(self.direction), interpolate(self.lift)


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
    places_along, lines = GRID
    along = np.linspace(a0, a1, places_along)
    step = np.linspace(s0, s1, lines + 2)[1:-1]
    lifts = BRIDGE * work.scallop * np.array(LIFTS)
    uv = np.stack([work.uv(along, place) for place in step], axis=1)
    wide = _strip_widths(work, sense, uv, lifts)
    usual = work.tool.radius
    widest = np.maximum(wide.max(axis=3), 1e-3 * usual)
    cost = (usual / widest) ** 2
    chosen = _cheapest_field(cost)
    in_direction = np.take_along_axis(wide, chosen[..., None, None], axis=2)[..., 0, :]
    best_lift = in_direction.argmax(axis=2)
    return LeanField(along, step, DIRECTIONS[chosen], lifts[best_lift])


def _cheapest_field(cost: Array) -> NDArray[np.intp]:
    """The directions (k, m) that cost (k, m, d) and turns make cheapest, line by line from the middle outwards."""
    places_along, lines, _ = cost.shape
    turn = TURNING * np.subtract.outer(DIRECTIONS, DIRECTIONS) ** 2
    chosen = np.empty((places_along, lines), dtype=int)
    middle = lines // 2
    for j in sorted(range(lines), key=lambda k: abs(k - middle)):
        here = cost[:, j]
        if j != middle:
            before = j + 1 if j < middle else j - 1
            here = here + turn[:, chosen[:, before]].T
        chosen[:, j] = _cheapest(here, turn)
    return chosen


def _strip_widths(work: TwoPointInputs, sense: int, uv: Array, lifts: Array) -> Array:
    """Widths of strips at places (k, m, 2) in all directions and from all lifts, (k, m, d, l) mm.

    Where straight ahead is good enough nothing else is tried, and other widths stay zero.
    """
    places = uv.shape[:2]
    rows = uv.reshape(-1, 2)
    wide = np.zeros((*places, len(DIRECTIONS), len(lifts)))
    straight = _settled_width(work, sense, rows, lifts[0], 0.0).reshape(places)
    wide[:, :, STRAIGHT, 0] = straight
    usual = _formula_width(work, sense, rows).reshape(places)
    poor = straight < ENOUGH * usual
    tried = np.broadcast_to(poor[..., None, None], wide.shape)
    i, j, direction, lift = np.nonzero(tried)
    wide[i, j, direction, lift] = _settled_width(work, sense, uv[i, j], lifts[lift], DIRECTIONS[direction])
    return wide


def _settled_width(work: TwoPointInputs, sense: int, uv: Array, lift: ArrayLike, direction: ArrayLike) -> Array:
    """Widths of the strips of rings that settle from heights in directions, (n,) mm; 0 where they stay too high."""
    setting = work.setting(uv, sense)
    stand, ring = settle(setting, lift, direction)
    width = _width(work, setting, ring)
    return np.where(stand.lift <= work.scallop, width, 0.0)


def _formula_width(work: TwoPointInputs, sense: int, uv: Array) -> Array:
    """Width of the formula's strip, (n,) mm; 0 where nothing is to be bridged, infinite where the cutter is too large:
    other directions are tried there."""
    _, across = work.setting(uv, sense).curvatures()
    radius = work.tool.flat_radius
    hollow = across > 1e-6
    fits = hollow & (radius * across < np.sin(STEEPEST))
    rho = 1 / np.where(fits, across, 1.0)
    rho = np.where(fits, rho, 1e6)
    lead = two_point_lead(radius, rho, work.scallop)
    width = circle_strip_width(radius, rho, work.scallop, lead, work.scallop)
    otherwise = np.where(hollow, np.inf, 0.0)
    return np.where(fits, width, otherwise)


def _cheapest(cost: Array, turn: Array) -> NDArray[np.intp]:
    """The cheapest choice in each row, (k,), with a price on each turn to the next."""
    total = cost[0]
    back = []  # for each choice but in the first row, the best one before it
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
    across = d.sv if work.feed == "u" else d.su
    pace = np.linalg.norm(across, axis=1)
    step = ring.uv[:, FRONT, 1 - work.column]
    lines = (step, ring.height[:, FRONT])
    right_side, left_side = SIDES
    right, _ = strip_end(work.scallop, lines, right_side)
    left, _ = strip_end(work.scallop, lines, left_side)
    return np.asarray(np.abs(right - left) * pace)


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
    of_side = list(columns)
    across, height = (rows[:, of_side] for rows in lines)
    bad = ~(height <= limit * (1 + 1e-6))
    last = across.shape[1] - 1
    first_bad = np.argmax(bad, axis=1)
    k = np.where(bad.any(axis=1), first_bad, last)
    i = np.arange(len(k))
    before = np.maximum(k - 1, 0)
    last_good = across[i, before]
    below = limit - height[i, before]
    rise = height[i, k] - height[i, before]
    rises = rise > 0
    share = below / np.where(rises, rise, 1.0)
    share = np.where(bad[i, k] & rises, share, 1.0)
    share = np.clip(share, 0.0, 1.0)
    end = last_good + share * (across[i, k] - last_good)
    return np.where(np.isfinite(end), end, last_good), k
