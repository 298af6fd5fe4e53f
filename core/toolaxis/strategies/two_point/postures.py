"""Postures of a flat end along passes: two-point contact, and what it is measured against."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.strategies.two_point.contact import (
    BRIDGE,
    FREE,
    STEEPEST,
    TOUCH,
    balance,
    gouge_free_lean,
    lower_to_contact,
    match_lead,
    settle,
    two_point_lead,
)
from toolaxis.strategies.two_point.inputs import FREE_POSTURES, TwoPointInputs
from toolaxis.strategies.two_point.lean_field import directions
from toolaxis.strategies.two_point.rings import ContactSet, CornerCircles, Posture, rings

Array = NDArray[np.float64]

TWO, CONVEX, BEHIND, UNEVEN, TIGHT = range(5)
#: Why a point has one contact, or none; the order of the codes.
REASONS = ("two contacts", "one contact: the surface is not concave across the feed",
           "one contact: the back of the bottom needs more lean than two contacts have",
           "one contact: the surface is uneven across the feed",
           "no contact within the tolerance: the surface is tighter than the cutter")
#: Greatest change of the lean on a way as long as the tool's radius, rad, and of its height in shares of that way.
TURN = 1.0


@dataclass(frozen=True, eq=False)
class Postures:
    """How the cutter stands along a pass.

    Attributes
    ----------
    uv : (n, 2) array
        Contacts that the posture is named by; the cutter is `stand.lift` above them.
    stand : Posture
    ring : CornerCircles
    normal : (n, 3) array
    reason : (n,) array of int8
        Index into `REASONS`; that of the gouge-free postures.
    """

    uv: Array
    stand: Posture
    ring: CornerCircles
    normal: Array
    reason: NDArray[np.int8]

    @property
    def contacts(self) -> NDArray[np.int8]:
        """Number of contacts, (n,)."""
        return np.where(self.reason == TWO, 2, np.where(self.reason == TIGHT, 0, 1)).astype(np.int8)


def postures(work: TwoPointInputs, along: Array, step: float, sense: int,
             near: tuple[Array, Posture] | None = None) -> Postures:
    """Postures along a pass.

    Parameters
    ----------
    work : TwoPointInputs
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
    if work.posture not in FREE_POSTURES:
        stand = _by_formula(work, setting)
        ring = rings(setting, stand)
    elif near is not None:
        stand, ring = _between(setting, along, near)
    else:
        stand, ring = _settle_postures(work, setting, along, step)
    return Postures(setting.uv, stand, ring, setting.frame.normal, _reasons(work, setting, stand, ring))


def _between(setting: ContactSet, along: Array, near: tuple[Array, Posture]) -> tuple[Posture, CornerCircles]:
    """Postures between others, leaning more where these gouge."""
    rows = (np.interp(along, near[0], rows) for rows in (near[1].lean, near[1].direction, near[1].lift))
    return gouge_free_lean(setting, Posture(*rows))


def _settle_postures(work: TwoPointInputs, setting: ContactSet, along: Array,
                     step: float) -> tuple[Posture, CornerCircles]:
    """Gouge-free postures that follow each other without jumps; beyond the ends of the face as at them."""
    if work.posture == "two-point":
        sense = 1 if (setting.feed * work.setting(setting.uv[:1], 1).feed).sum() > 0 else -1
        direction, lift = directions(work, sense).at(along, step)
        direction = direction + _even(along, balance(setting, lift, direction) - direction)
        stand, _ = settle(setting, lift, direction)
    elif work.posture == "one-point":
        stand, _ = settle(setting, 0.0)
    else:
        stand, _ = gouge_free_lean(setting, _by_formula(work, setting))
    a0, a1 = work.span[:2]
    inside = (along >= a0 - 1e-9) & (along <= a1 + 1e-9)
    if inside.any():
        stand = Posture(*(np.interp(along, along[inside], rows[inside])
                          for rows in (stand.lean, stand.direction, stand.lift)))
    stand, ring = lower_to_contact(setting, _follow_neighbours(work, setting, stand))
    return (stand, ring) if (ring.least >= -FREE).all() else gouge_free_lean(setting, stand)


def _follow_neighbours(work: TwoPointInputs, setting: ContactSet, stand: Posture) -> Posture:
    """Postures that lean and rise as much as their neighbours ask for."""
    points = work.face.evaluate(setting.uv).point
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    place = np.concatenate([[0.0], np.cumsum(gaps)])
    apart = np.abs(np.subtract.outer(place, place)) / work.tool.radius
    lean = (stand.lean - TURN * apart).max(axis=1)
    rise = (stand.lift - TURN * work.tool.radius * apart).max(axis=1)
    lift = np.where(rise > work.scallop, rise, stand.lift)
    return Posture(np.minimum(lean, STEEPEST), stand.direction, lift)


def _by_formula(work: TwoPointInputs, setting: ContactSet) -> Posture:
    """One lean, or the paper's where the surface is hollow and wider than the cutter; the least and the steepest
    elsewhere."""
    across = setting.curvatures()[1]
    zero, radius = np.zeros(len(across)), work.tool.flat_radius
    if work.posture == "sturz":
        return Posture(zero + work.lead, zero, zero)
    fits = (across > 1e-9) & (radius * across < np.sin(STEEPEST))
    rho = np.where(fits, 1 / np.where(fits, across, 1.0), 1e9)
    bridged = work.share * work.scallop if work.posture.startswith("formula") else 0.0
    lean = two_point_lead(radius, rho, bridged) if bridged else match_lead(radius, rho)
    lean = np.clip(np.where(fits, lean, np.where(across > 0, STEEPEST, 0.0)), setting.least_lean, STEEPEST)
    return Posture(lean, zero, zero + BRIDGE * bridged)


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


def _reasons(work: TwoPointInputs, setting: ContactSet, stand: Posture, ring: CornerCircles) -> NDArray[np.int8]:
    across = setting.curvatures()[1]
    both = (np.abs(ring.sides) <= 5 * TOUCH).all(axis=1) & (stand.lift > TOUCH)
    return np.select(
        [stand.lift > work.scallop * (1 + 1e-6), both, across <= 1e-9, np.abs(ring.sides).max(axis=1) > 5 * TOUCH],
        [TIGHT, TWO, CONVEX, UNEVEN], BEHIND).astype(np.int8)
