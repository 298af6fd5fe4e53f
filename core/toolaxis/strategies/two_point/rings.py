"""Rings: the circle of a cutter's corner as it stands at contacts, and its heights above the face.

A cutter with a flat bottom gouges nowhere where the circle of its corner's centres stays as high above the face as
the corner's radius and the allowance want it, and nothing reaches up into the bottom within.
"""

from dataclasses import dataclass, field, replace
from math import pi, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.frame import Frame, axis_from_lean, contact_frame
from toolaxis.contact.placement import tips
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, dot
from toolaxis.shape.differential import curvature_form
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]

#: Angles on the ring at which its height is taken, from the contact towards left, rad; the contact is in the middle.
ANGLES = np.linspace(-pi, pi, 121)[:-1]
#: As many bounds of distances as take as long as the feet of no points, and a step of Newton's for one.
_QUESTION, _FOOT = 8000, 2
CONTACT = 60
#: Points of the front half of the ring, that of the contact among them, and both ways outwards from it.
FRONT = np.flatnonzero(np.abs(ANGLES) <= pi / 2 + 1e-9)
MIDDLE = int(np.flatnonzero(FRONT == CONTACT)[0])
SIDES = (range(MIDDLE, -1, -1), range(MIDDLE, len(FRONT)))


def check_bottom(tool: Tool) -> None:
    """Check that a cutter can touch at two points.

    Parameters
    ----------
    tool : Tool

    Raises
    ------
    InvalidInput
        When it has no flat bottom, or a slanting side.
    """
    if tool.flat_radius <= 0 or tool.half_angle != 0:
        raise InvalidInput(f"tool {tool.name} has no flat bottom with an upright side: two-point contact needs a flat "
                           "end (flat:20) or a torus (torus:12x1)")


def check_tolerance(radius: float, tolerance: float) -> None:
    """Check that a tolerance is one of two-point contact.

    Parameters
    ----------
    radius, tolerance : float
        mm

    Raises
    ------
    InvalidInput
        When it is not above zero and below the cutter's radius.
    """
    if not 0 < tolerance < radius:
        raise InvalidInput(f"tolerance of two-point contact is {tolerance} mm: it must be above zero and below the "
                           f"cutter's radius {radius} mm")


@dataclass(frozen=True, eq=False)
class ContactSet:
    """Contacts of a face with what decides how the cutter stands there.

    Attributes
    ----------
    face : Face
    tool : Tool
        With a flat bottom and an upright side.
    uv : (n, 2) array
    feed : (n, 3) array
        Direction of travel, towards which the axis leans.
    tolerance : float
        Height that may stay, mm.
    allowance : float
        Stock left on the face, mm.
    limits : Tolerance

    Raises
    ------
    InvalidInput
        When the cutter has no flat bottom, or a slanting side.
    """

    face: Face
    tool: Tool
    uv: Array
    feed: Array
    tolerance: float
    allowance: float = 0.0
    limits: Tolerance = field(default_factory=Tolerance)

    def __post_init__(self) -> None:
        check_bottom(self.tool)
        check_tolerance(self.tool.radius, self.tolerance)
        uv = as_rows(self.uv, 2, "uv")
        feed = as_rows(self.feed, 3, "feed")
        object.__setattr__(self, "uv", uv)
        object.__setattr__(self, "feed", np.broadcast_to(feed, (len(uv), 3)))

    @property
    def offset(self) -> float:
        """Height of the ring above the face where the cutter touches, mm."""
        return self.tool.corner_radius + self.allowance

    @property
    def frame(self) -> Frame:
        """Contact frames with the direction of travel."""
        return contact_frame(self.face, self.uv, self.feed)

    @property
    def least_lean(self) -> float:
        """Least angle of the axis to the normal, rad."""
        return max(self.limits.min_lead, radians(0.05))

    def rows(self, which: NDArray[Any]) -> "ContactSet":
        """Some of the contacts.

        Parameters
        ----------
        which : (n,) array of bool or int
        """
        return replace(self, uv=self.uv[which], feed=self.feed[which])

    def curvatures(self) -> tuple[Array, Array]:
        """Normal curvature along and across the travel, (n,) 1/mm, of the surface in which the ring moves."""
        d = self.face.evaluate(self.uv)
        frame = self.frame
        form = curvature_form(d, frame.normal, frame.feed)
        along = form[:, 0, 0]
        across = form[:, 1, 1]
        return self._at_ring(along), self._at_ring(across)

    def _at_ring(self, curvature: Array) -> Array:
        """Curvature of the surface in which the ring moves, from that of the face."""
        return np.asarray(curvature / np.maximum(1 - self.offset * curvature, 1e-9))


@dataclass(frozen=True, eq=False)
class Posture:
    """How the cutter stands at n contacts.

    Attributes
    ----------
    lean, direction : (n,) array
        Angle of the axis to the normal, and of that lean in the tangent plane from the travel towards left, rad.
    lift : (n,) array
        Height of the ring over the contact beyond its offset, mm.
    """

    lean: Array
    direction: Array
    lift: Array

    def rows(self, which: NDArray[Any]) -> "Posture":
        """Some of them.

        Parameters
        ----------
        which : (n,) array of bool or int
        """
        return Posture(self.lean[which], self.direction[which], self.lift[which])


@dataclass(frozen=True, eq=False)
class CornerCircles:
    """Rings at n contacts: where they stand, and how high above the face.

    Attributes
    ----------
    axis, tip : (n, 3) array
    uv : (n, 120, 2) array
        Feet of the ring's points at `ANGLES` on the face, beyond its border on the tangential extension.
    height : (n, 120) array
        Height there beyond the offset, mm; below zero the cutter gouges.
    """

    axis: Array
    tip: Array
    uv: Array
    height: Array

    def rows(self, which: NDArray[Any]) -> "CornerCircles":
        """Some of them.

        Parameters
        ----------
        which : (n,) array of bool or int
        """
        return CornerCircles(self.axis[which], self.tip[which], self.uv[which], self.height[which])

    def put(self, which: NDArray[Any], new: "CornerCircles") -> "CornerCircles":
        """With some of them replaced.

        Parameters
        ----------
        which : (n,) array of bool or int
        new : CornerCircles
        """
        old = (self.axis, self.tip, self.uv, self.height)
        whole = tuple(rows.copy() for rows in old)
        for rows, some in zip(whole, (new.axis, new.tip, new.uv, new.height), strict=True):
            rows[which] = some
        return CornerCircles(*whole)

    @property
    def sides(self) -> Array:
        """Least height of the front half, right and left of the contact, (n, 2) mm."""
        front = self.height[:, FRONT]
        right = _least(front[:, :MIDDLE + 1], MIDDLE)
        left = _least(front[:, MIDDLE:], 0)
        return np.stack([right, left], axis=1)

    @property
    def least(self) -> Array:
        """Least height of the whole ring, (n,) mm."""
        closed = np.concatenate([self.height, self.height[:, :1]], axis=1)
        return _least(closed, CONTACT)


def _least(rows: Array, contact: int) -> Array:
    """Least value of heights given at even places, (n,): that of the quartic around the least one.

    At the contact a height is at rest, so that nothing lower is beside it, even where the face bends suddenly.
    """
    k = np.clip(np.argmin(rows, axis=1), 1, rows.shape[1] - 2)
    i = np.arange(len(rows))
    low = rows[i, k - 1]
    middle = rows[i, k]
    high = rows[i, k + 1]
    slope = (high - low) / 2
    bend = high - 2 * middle + low
    inside = (bend > 0) & (np.abs(slope) < bend) & (k != contact)
    first = np.clip(k - 2, 0, rows.shape[1] - 5)
    vertex = np.where(inside, slope / np.where(inside, bend, 1.0), 0.0)
    place = k - first - vertex
    value = np.zeros(len(rows))
    for j in range(5):
        others = [m for m in range(5) if m != j]
        weight = np.prod([(place - m) / (j - m) for m in others], axis=0)
        value += rows[i, first + j] * weight
    return np.asarray(np.minimum(value, rows.min(axis=1)))


def stand_of(setting: ContactSet, tip: Array, axis: Array) -> Posture:
    """How cutters stand whose tips and axes are known; undoes what `rings` does first.

    Parameters
    ----------
    setting : ContactSet
    tip, axis : (n, 3) array
        mm, unit vectors.
    """
    frame = setting.frame
    along = dot(axis, frame.feed)
    beside = dot(axis, frame.left)
    up = dot(axis, frame.normal)
    point = setting.face.evaluate(setting.uv).point
    low = tips(point, frame.normal, axis, setting.tool, setting.allowance)
    lean = np.arccos(np.clip(up, -1.0, 1.0))
    direction = np.arctan2(beside, along)
    return Posture(lean, direction, dot(tip - low, frame.normal))


def rings(setting: ContactSet, stand: Posture, start: Array | None = None) -> CornerCircles:
    """Rings of cutters, and their heights above the face.

    Parameters
    ----------
    setting : ContactSet
    stand : Posture
    start : (n, 120, 2) array, optional
        Feet of rings that stand nearly so.
    """
    face = setting.face
    tool = setting.tool
    frame = setting.frame
    d = face.evaluate(setting.uv)
    axis = axis_from_lean(frame, stand.lean, stand.direction)
    lifted = d.point + stand.lift[:, None] * frame.normal
    tip = tips(lifted, frame.normal, axis, tool, setting.allowance)
    # The way in which the axis leans, at right angles to it: there the ring is lowest.
    level = np.cos(stand.direction)[:, None] * frame.feed + np.sin(stand.direction)[:, None] * frame.left
    ahead = np.cos(stand.lean)[:, None] * level - np.sin(stand.lean)[:, None] * frame.normal
    left = np.cross(axis, ahead)
    centre = tip + tool.corner_radius * axis
    along = np.cos(ANGLES)[:, None] * ahead[:, None]
    beside = np.sin(ANGLES)[:, None] * left[:, None]
    points = centre[:, None] + tool.flat_radius * (along + beside)
    rounds = 1
    if start is None:
        rounds = 6
        metric = np.linalg.pinv(np.stack([d.su, d.sv], axis=-1))
        from_contact = points - d.point[:, None]
        start = setting.uv[:, None] + np.einsum("nij,nkj->nki", metric, from_contact)
    uv, height = _feet(face, points.reshape(-1, 3), start.reshape(-1, 2), rounds)
    shape = points.shape[:2]
    return CornerCircles(axis, tip, uv.reshape(*shape, 2), height.reshape(shape) - setting.offset)


def _feet(face: Face, points: Array, uv: Array, rounds: int) -> tuple[Array, Array]:
    """Feet of perpendiculars to a face and its extension, by Newton's method, and the heights above them, mm."""
    spend(_QUESTION + _FOOT * rounds * len(points))
    (u0, u1), (v0, v1) = face.surface.domain
    most = 0.1 * np.array([u1 - u0, v1 - v0])
    for _ in range(rounds):
        d = face.evaluate(uv)
        gap = d.point - points
        fu = dot(gap, d.su)
        fv = dot(gap, d.sv)
        e = dot(d.su, d.su)
        f = dot(d.su, d.sv)
        g = dot(d.sv, d.sv)
        a = e + dot(gap, d.suu)
        b = f + dot(gap, d.suv)
        c = g + dot(gap, d.svv)
        # Where the second derivatives do not make a valley, the first ones alone do.
        full = (a > 0.1 * e) & (a * c - b * b > 0.01 * (e * g - f * f))
        a = np.where(full, a, e)
        b = np.where(full, b, f)
        c = np.where(full, c, g)
        turn = np.maximum(a * c - b * b, 1e-300)
        step = np.stack([b * fv - c * fu, b * fu - a * fv], axis=1) / turn[:, None]
        uv = uv + np.clip(step, -most, most)
    d = face.evaluate(uv)
    return uv, dot(points - d.point, face.normal(uv, d))
