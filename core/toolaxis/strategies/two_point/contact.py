"""Two-point contact: a flat bottom that bridges the contact at the tolerance and touches the surface on both sides.

The cutter is a ring: the circle of its corner's centres, as far above the surface as corner and allowance want it.
Between its two contacts it stays within the tolerance of the surface, so that its strip is about as wide as three
tolerances in depth make it, and not one.
"""

from dataclasses import dataclass, replace
from math import radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import SMALLER_CUTTER
from toolaxis.errors import InvalidInput
from toolaxis.strategies.two_point.rings import CONTACT, ContactSet, CornerCircles, Posture, check_tolerance, rings

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.int64]

#: Share of the tolerance at which the ring bridges the contact: the rest is for what lies between samples.
BRIDGE = 0.98
#: Limits of the lean, and how far its direction turns to balance both sides, rad.
STEEPEST, ASIDE = radians(80.0), radians(10.0)
#: Heights that differ by no more are one, mm: of contacts, and of what a gouge is.
TOUCH, FREE = 5e-4, 1e-5
#: How closely the least lean is found where there is one contact, rad.
NARROW = 2e-4
_TURN_STEP, _LEAN_STEP = 2e-3, 2e-4


def match_lead(radius: float, rho: ArrayLike) -> Array:
    """The lean at which the ring's projection along the feed is curved like the surface across it, rad.

    Parameters
    ----------
    radius : float
        R of a flat end, mm; that of the ring where the corner is rounded.
    rho : array_like
        Radius of curvature of the surface across the feed, mm, above the radius.

    Raises
    ------
    InvalidInput
        When the surface is not hollow, or tighter than the cutter.

    Notes
    -----
    **Source**: [jang2021] Eq. (3), sin phi = R / rho.
    """
    return np.asarray(np.arcsin(radius / _hollow(radius, rho)))


def two_point_lead(radius: float, rho: ArrayLike, tolerance: float, feed_curvature: ArrayLike | None = None) -> Array:
    """The lean at which the ring, lifted by the tolerance, touches a circle across the feed at two points, rad.

    Parameters
    ----------
    radius : float
        R of a flat end, mm; that of the ring where the corner is rounded.
    rho : array_like
        Radius of curvature of the surface across the feed, mm, above the radius.
    tolerance : float
        d, mm, above zero and below the radius.
    feed_curvature : array_like, optional
        Curvature of the surface along the feed, 1/mm: the lean is then no less than the one at which the back of the
        bottom stays out of such a circle too, which the paper leaves out.

    Raises
    ------
    InvalidInput
        When the surface is not hollow, or tighter than the cutter, or the tolerance is out of range.

    Notes
    -----
    **Source**: [jang2021] Eq. (7): sin phi = [R (rho - d) - sqrt((rho^2 - R^2) d (2 rho - d))] / rho^2, the smaller of
    its two solutions, which is phi = asin(R / rho) - acos(1 - d / rho).  Not in the paper: sin phi >= R kappa along the
    feed.

    Examples
    --------
    >>> float(np.degrees(two_point_lead(30.0, 60.0, 0.03)).round(4))
    28.1881
    """
    hollow = _hollow(radius, rho)
    check_tolerance(radius, tolerance)
    lead = np.arcsin(radius / hollow) - np.arccos(1 - tolerance / hollow)
    if feed_curvature is None:
        return np.asarray(lead)
    bend = radius * np.asarray(feed_curvature, dtype=float)
    least = np.arcsin(np.clip(bend, 0.0, 1.0))
    return np.asarray(np.maximum(lead, least))


def circle_strip_width(radius: float, rho: ArrayLike, tolerance: float, lead: ArrayLike, lift: float) -> Array:
    """Width of the strip in which the ring's projection lies within the tolerance of a circle across the feed, mm.

    Parameters
    ----------
    radius : float
    rho : array_like
        mm
    tolerance : float
        d, mm
    lead : array_like
        Lean along the feed, rad.
    lift : float
        Height of the ring over the contact, mm: 0 for one contact, d for two.

    Returns
    -------
    array, mm, at most 2 R

    Notes
    -----
    With X = sin lead, the ellipse (x - lift - R X)^2 / X^2 + y^2 = R^2, lowered by d, meets x^2 + y^2 = 2 rho x.

    **Source**: [jang2021] Eqs. (8) and (9); for lift = d, x = 2 X (R - rho X) / (1 - X^2).
    """
    hollow = _hollow(radius, rho)
    sine = np.sin(np.asarray(lead, dtype=float))
    low = tolerance - lift
    # Both curves without y: (1 - X^2) x^2 - 2 half x + low (low - 2 R X) = 0, of which the greater solution counts.
    square = 1 - sine**2
    half = sine * (radius - hollow * sine) - low
    root = np.sqrt(np.maximum(half**2 - square * low * (low - 2 * radius * sine), 0.0))
    x = (half + root) / square
    y = np.sqrt(np.maximum(2 * hollow * x - x**2, 0.0))
    return np.asarray(np.minimum(2 * y, 2 * radius))


def _hollow(radius: float, rho: ArrayLike) -> Array:
    found = np.asarray(rho, dtype=float)
    if not (found > radius).all():
        worst = float(np.min(found))
        raise InvalidInput(f"radius of curvature across the feed is {worst} mm: two-point contact needs a concave "
                           f"surface less tight than the cutter's {radius} mm; take {SMALLER_CUTTER}, or one contact "
                           "where the surface is convex")
    return found


def balance(setting: ContactSet, lift: ArrayLike, start: ArrayLike = 0.0) -> Array:
    """Directions of the lean in which both sides of a lifted ring touch at once, rad, (n,).

    By Newton's method in lean and direction; NaN where no direction within `ASIDE` of the start does it.

    Parameters
    ----------
    setting : ContactSet
    lift : float or (n,) array_like
        Height of the ring over the contact, mm, above zero.
    start : float or (n,) array_like
        Direction to begin with, rad.
    """
    first = _one_each(setting, start)
    height = _one_each(setting, lift)
    stand = Posture(_first_lean(setting, height), first, height)
    ring = rings(setting, stand)
    for _ in range(6):
        lean_step, turn_step = _newton_step(setting, stand, ring)
        lean = stand.lean + np.clip(lean_step, -0.05, 0.05)
        direction = stand.direction + np.clip(turn_step, -0.1, 0.1)
        stand = Posture(np.clip(lean, setting.least_lean, STEEPEST),
                        np.clip(direction, first - ASIDE, first + ASIDE), stand.lift)
        ring = rings(setting, stand, ring.uv)
    both_touch = np.abs(ring.sides).max(axis=1) <= TOUCH
    is_balanced = both_touch & (np.abs(stand.direction - first) < ASIDE)
    return np.where(is_balanced, stand.direction, np.nan)


def _one_each(setting: ContactSet, values: ArrayLike) -> Array:
    """A value, or one for each contact, as one for each, (n,)."""
    return np.asarray(np.zeros(len(setting.uv)) + np.asarray(values, dtype=float))


def _newton_step(setting: ContactSet, stand: Posture, ring: CornerCircles) -> tuple[Array, Array]:
    """Changes of lean and of direction, (n,) rad each, by which the heights of both sides become zero, by differences.

    Both are zero where the two sides do not tell lean and direction apart.
    """
    leant = rings(setting, replace(stand, lean=stand.lean + _LEAN_STEP), ring.uv)
    turned = rings(setting, replace(stand, direction=stand.direction + _TURN_STEP), ring.uv)
    sides = ring.sides
    right_by_lean, left_by_lean = ((leant.sides - sides) / _LEAN_STEP).T
    right_by_turn, left_by_turn = ((turned.sides - sides) / _TURN_STEP).T
    right, left = sides.T
    determinant = right_by_lean * left_by_turn - left_by_lean * right_by_turn
    determinant = np.where(np.abs(determinant) > 1e-6, determinant, np.inf)
    lean = (left * right_by_turn - right * left_by_turn) / determinant
    turn = (right * left_by_lean - left * right_by_lean) / determinant
    return lean, turn


def _first_lean(setting: ContactSet, lift: Array) -> Array:
    """The formula's lean for small lifts, within limits, (n,) rad."""
    across = np.maximum(setting.curvatures()[1], 0.0)
    sine = np.clip(setting.tool.flat_radius * across, 0.0, np.sin(STEEPEST))
    lean = np.arcsin(sine) - np.sqrt(2 * lift * across)
    return np.asarray(np.clip(lean, setting.least_lean, STEEPEST))


def settle(setting: ContactSet, lift: ArrayLike, direction: ArrayLike = 0.0) -> tuple[Posture, CornerCircles]:
    """The least lean at which a ring gouges nowhere, in front or behind, and touches in front.

    It starts at a height over the contact, leans until nothing gouges, and sinks until its front half touches, in turn.
    Where it gouges at the steepest lean too it rises instead.

    Parameters
    ----------
    setting : ContactSet
    lift : float or (n,) array_like
        Height over the contact to start with, mm: `BRIDGE` of the tolerance for two contacts, 0 for one.
    direction : float or (n,) array_like
        Of the lean from the travel towards left, rad.

    Returns
    -------
    Posture, Rings
        Heights at `ANGLES` and between them above zero within `FREE`.
    """
    height = _one_each(setting, lift)
    stand = Posture(_first_lean(setting, height), _one_each(setting, direction), height)
    ring = rings(setting, stand)
    least = np.full(len(height), setting.least_lean)
    for _ in range(5):
        stand, ring = _lean_until_free(setting, stand, ring, least)
        depth = ring.least
        spare = np.maximum(ring.sides.min(axis=1), 0.0)
        height = np.where(depth < -FREE, stand.lift - depth, np.maximum(stand.lift - spare, 0.0))
        if np.abs(height - stand.lift).max(initial=0.0) <= FREE:
            break
        stand = replace(stand, lift=height)
        ring = rings(setting, stand, ring.uv)
    else:
        stand, ring = _lean_until_free(setting, stand, ring, least)
    return _raise_rings(setting, stand, ring)


def gouge_free_lean(setting: ContactSet, stand: Posture) -> tuple[Posture, CornerCircles]:
    """The least lean at or above a given one at which a ring gouges nowhere, at the same height over the contact.

    Parameters
    ----------
    setting : ContactSet
    stand : Posture
        Where nothing gouges at the steepest lean either, the ring rises.
    """
    leant, ring = _lean_until_free(setting, stand, rings(setting, stand), stand.lean)
    return _raise_rings(setting, leant, ring)


def _raise_rings(setting: ContactSet, stand: Posture, ring: CornerCircles) -> tuple[Posture, CornerCircles]:
    """Rings that gouge, higher by what they gouge until they do not."""
    for _ in range(40):
        depth = ring.least
        if (depth >= -FREE).all():
            break
        lift = np.where(depth < -FREE, stand.lift - 1.2 * depth, stand.lift)
        stand = replace(stand, lift=lift)
        ring = rings(setting, stand, ring.uv)
    return stand, ring


def lower_to_contact(setting: ContactSet, stand: Posture) -> tuple[Posture, CornerCircles]:
    """Rings let down until something touches, or the contact itself does.

    Parameters
    ----------
    setting : ContactSet
    stand : Posture
        Gouging nowhere.
    """
    ring = rings(setting, stand)
    for _ in range(3):
        spare = np.maximum(ring.least, 0.0)
        lift = np.maximum(stand.lift - spare, np.minimum(stand.lift, 0.0))
        stand = replace(stand, lift=lift)
        ring = rings(setting, stand, ring.uv)
    return stand, ring


@dataclass(eq=False)
class _LeanBracket:
    """Between which leans the least one lies at which a ring is free, rad, and its depth at both, mm, (n,) each.

    Depths are infinite where no ring has been looked at yet.
    """

    low: Array
    high: Array
    depth_low: Array
    depth_high: Array

    @staticmethod
    def above(least: Array) -> "_LeanBracket":
        """From the least leans to the steepest."""
        unknown = np.full(len(least), np.inf)
        return _LeanBracket(least.copy(), np.full(len(least), STEEPEST), -unknown, unknown)

    def narrow(self, rows: Index, lean: Array, depth: Array) -> None:
        """Take in how deep some of the rings are at other leans."""
        is_free = depth >= -FREE
        self.high[rows] = np.where(is_free, lean, self.high[rows])
        self.depth_high[rows] = np.where(is_free, depth, self.depth_high[rows])
        self.low[rows] = np.where(is_free, self.low[rows], lean)
        self.depth_low[rows] = np.where(is_free, self.depth_low[rows], depth)

    def within(self, rows: Index, halve: Bools) -> Array:
        """A lean inside each bracket: its middle, or where the secant has no depth; of no use outside `is_known`."""
        low, high = self.low[rows], self.high[rows]
        depth_low, depth_high = self.depth_low[rows], self.depth_high[rows]
        with np.errstate(invalid="ignore"):
            secant = low - depth_low * (high - low) / (depth_high - depth_low)
        return np.where(halve, (low + high) / 2, secant)

    def is_known(self, rows: Index) -> Bools:
        """Whether rings have been looked at on both sides."""
        return np.asarray(np.isfinite(self.depth_low[rows]) & np.isfinite(self.depth_high[rows]))


def _lean_until_free(setting: ContactSet, stand: Posture, ring: CornerCircles,
                     least: Array) -> tuple[Posture, CornerCircles]:
    """The least lean within limits at which nothing gouges, or the steepest; by a bracket, secants and halves."""
    count = len(stand.lean)
    bracket = _LeanBracket.above(least)
    leans = stand.lean.copy()
    rows = np.arange(count)  # of the rings that are still looked for
    best = np.full(count, np.nan)
    found = trial = ring
    for step in range(40):
        lean, depth = leans[rows], trial.least
        bracket.narrow(rows, lean, depth)
        is_free = depth >= -FREE
        is_steepest = lean >= STEEPEST
        is_kept = is_free | is_steepest
        best[rows[is_kept]] = lean[is_kept]
        found = found.put(rows[is_kept], trial.rows(is_kept))
        # Where the contact itself touches, the depth does not tell how far the lean is from the least one.
        is_flat = trial.height[:, CONTACT] <= 3 * FREE
        touches = (depth <= FREE) & ~is_flat
        is_done = (is_free & (touches | (lean <= least[rows]))) | is_steepest
        is_done |= bracket.high[rows] - bracket.low[rows] <= np.where(is_flat, NARROW, 1e-9)
        left = ~is_done
        rows, lean, depth, is_flat = rows[left], lean[left], depth[left], is_flat[left]
        if not len(rows):
            break
        inside = bracket.within(rows, is_flat | (step % 3 == 2))
        onwards = _stride(setting, lean, depth, is_flat)
        next_lean = np.where(bracket.is_known(rows), inside, onwards)
        leans[rows] = np.clip(next_lean, least[rows], STEEPEST)
        trial = rings(setting.rows(rows), replace(stand, lean=leans).rows(rows), trial.uv[left])
    was_not_found = np.isnan(best)
    return replace(stand, lean=np.where(was_not_found, bracket.high, best)), found


def _stride(setting: ContactSet, lean: Array, depth: Array, is_flat: Bools) -> Array:
    """The next lean where one side of the bracket is not known yet: about as far as the ring's edge has to rise."""
    change = -(depth - FREE / 2) / (0.1 * setting.tool.flat_radius)
    onwards = lean + np.clip(change, -0.05, 0.1)
    return np.where(depth < -FREE, np.maximum(onwards, lean + 0.002), onwards - 0.03 * is_flat)
