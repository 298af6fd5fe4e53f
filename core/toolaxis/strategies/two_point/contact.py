"""Two-point contact: a flat bottom that bridges the contact at the tolerance and touches the surface on both sides.

The cutter is a ring: the circle of its corner's centres, as far above the surface as corner and allowance want it.
Between its two contacts it stays within the tolerance of the surface, so that its strip is about as wide as three
tolerances in depth make it, and not one.
"""

from dataclasses import replace
from math import radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import SMALLER_CUTTER
from toolaxis.errors import InvalidInput
from toolaxis.strategies.two_point.rings import CONTACT, ContactSet, CornerCircles, Posture, check_tolerance, rings

Array = NDArray[np.float64]

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
    first, height = (np.zeros(len(setting.uv)) + np.asarray(rows, dtype=float) for rows in (start, lift))
    stand = Posture(_first_lean(setting, height), first, height)
    ring = rings(setting, stand)
    for _ in range(6):
        sides = ring.sides
        leant = rings(setting, replace(stand, lean=stand.lean + _LEAN_STEP), ring.uv).sides
        turned = rings(setting, replace(stand, direction=stand.direction + _TURN_STEP), ring.uv).sides
        by_lean, by_turn = (leant - sides) / _LEAN_STEP, (turned - sides) / _TURN_STEP
        size = by_lean[:, 0] * by_turn[:, 1] - by_lean[:, 1] * by_turn[:, 0]
        size = np.where(np.abs(size) > 1e-6, size, np.inf)
        lean = (sides[:, 1] * by_turn[:, 0] - sides[:, 0] * by_turn[:, 1]) / size
        turn = (sides[:, 0] * by_lean[:, 1] - sides[:, 1] * by_lean[:, 0]) / size
        stand = Posture(np.clip(stand.lean + np.clip(lean, -0.05, 0.05), setting.least_lean, STEEPEST),
                        np.clip(stand.direction + np.clip(turn, -0.1, 0.1), first - ASIDE, first + ASIDE),
                        stand.lift)
        ring = rings(setting, stand, ring.uv)
    found = (np.abs(ring.sides).max(axis=1) <= TOUCH) & (np.abs(stand.direction - first) < ASIDE)
    return np.where(found, stand.direction, np.nan)


def _first_lean(setting: ContactSet, lift: Array) -> Array:
    """The formula's lean for small lifts, within limits, (n,) rad."""
    across = np.maximum(setting.curvatures()[1], 0.0)
    sine = np.clip(setting.tool.flat_radius * across, 0.0, np.sin(STEEPEST))
    return np.asarray(np.clip(np.arcsin(sine) - np.sqrt(2 * lift * across), setting.least_lean, STEEPEST))


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
    aside, height = (np.zeros(len(setting.uv)) + np.asarray(rows, dtype=float) for rows in (direction, lift))
    stand = Posture(_first_lean(setting, height), aside, height)
    ring, least = rings(setting, stand), np.full(len(height), setting.least_lean)
    for _ in range(5):
        stand, ring = _lean(setting, stand, ring, least)
        spare = np.maximum(ring.sides.min(axis=1), 0.0)
        height = np.where(ring.least < -FREE, stand.lift - ring.least, np.maximum(stand.lift - spare, 0.0))
        if np.abs(height - stand.lift).max(initial=0.0) <= FREE:
            break
        stand = replace(stand, lift=height)
        ring = rings(setting, stand, ring.uv)
    else:
        stand, ring = _lean(setting, stand, ring, least)
    return _raise_rings(setting, stand, ring)


def gouge_free_lean(setting: ContactSet, stand: Posture) -> tuple[Posture, CornerCircles]:
    """The least lean at or above a given one at which a ring gouges nowhere, at the same height over the contact.

    Parameters
    ----------
    setting : ContactSet
    stand : Posture
        Where nothing gouges at the steepest lean either, the ring rises.
    """
    return _raise_rings(setting, *_lean(setting, stand, rings(setting, stand), stand.lean))


def _raise_rings(setting: ContactSet, stand: Posture, ring: CornerCircles) -> tuple[Posture, CornerCircles]:
    """Rings that gouge, higher by what they gouge until they do not."""
    for _ in range(40):
        low = ring.least
        if (low >= -FREE).all():
            break
        stand = replace(stand, lift=np.where(low < -FREE, stand.lift - 1.2 * low, stand.lift))
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
        stand = replace(stand, lift=np.maximum(stand.lift - np.maximum(ring.least, 0.0), np.minimum(stand.lift, 0.0)))
        ring = rings(setting, stand, ring.uv)
    return stand, ring


def _lean(setting: ContactSet, stand: Posture, ring: CornerCircles, least: Array) -> tuple[Posture, CornerCircles]:
    """The least lean within limits at which nothing gouges, or the steepest; by a bracket, secants and halves."""
    count = len(stand.lean)
    low, high = least.copy(), np.full(count, STEEPEST)
    below, above = np.full(count, -np.inf), np.full(count, np.inf)
    lean, rows = stand.lean.copy(), np.arange(count)
    best, found, trial = np.full(count, np.nan), ring, ring
    for step in range(40):
        depth = trial.least
        free = depth >= -FREE
        high[rows], above[rows] = np.where(free, lean[rows], high[rows]), np.where(free, depth, above[rows])
        low[rows], below[rows] = np.where(free, low[rows], lean[rows]), np.where(free, below[rows], depth)
        keep = free | (lean[rows] >= STEEPEST)
        best[rows[keep]] = lean[rows[keep]]
        found = found.put(rows[keep], CornerCircles(trial.axis[keep], trial.tip[keep], trial.uv[keep],
                                                    trial.height[keep]))
        # Where the contact itself touches, the depth does not tell how far the lean is from the least one.
        flat = trial.height[:, CONTACT] <= 3 * FREE
        done = (free & (((depth <= FREE) & ~flat) | (lean[rows] <= least[rows]))) | (lean[rows] >= STEEPEST)
        done |= high[rows] - low[rows] <= np.where(flat, NARROW, 1e-9)
        rows, near, depth, flat = rows[~done], trial.uv[~done], depth[~done], flat[~done]
        if not len(rows):
            break
        known = np.isfinite(below[rows]) & np.isfinite(above[rows])
        with np.errstate(invalid="ignore"):
            secant = low[rows] - below[rows] * (high[rows] - low[rows]) / (above[rows] - below[rows])
        stride = lean[rows] + np.clip(-(depth - FREE / 2) / (0.1 * setting.tool.flat_radius), -0.05, 0.1)
        stride = np.where(depth < -FREE, np.maximum(stride, lean[rows] + 0.002), stride - 0.03 * flat)
        inside = np.where(flat | (step % 3 == 2), (low[rows] + high[rows]) / 2, secant)
        lean[rows] = np.clip(np.where(known, inside, stride), least[rows], STEEPEST)
        trial = rings(setting.rows(rows), replace(stand, lean=lean).rows(rows), near)
    late = np.isnan(best)
    return replace(stand, lean=np.where(late, high, best)), found
