"""The swept cutter: its tip for a contact, and the signed distance of a moving point to it while it moves."""

from math import sqrt
from typing import NamedTuple

from toolaxis.contact.strip.curves import Moving
from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.numeric.jit import jit_uncounted_inline
from toolaxis.numeric.triples import Triple, dot, plus

#: Sine of the angle between axis and normal up to which the cutter stands upright.
_UPRIGHT = 1e-12
#: What the sine of the angle between axis and tangent plane may be short of the side line's.
_TOUCHES = 1e-9
#: Distances from the axis that count as zero, mm.
_ON_AXIS = 1e-300


class RelativeMotion(NamedTuple):
    """A moving point q(s) seen from a cutter whose tip moves in w, in cylinder coordinates about the tool axis."""

    rho: float
    z: float
    outwards: Triple
    """Unit vector from the axis to the point, zero on the axis."""
    inverse: float
    """1 / rho, zero on the axis."""
    tip_out: float
    """Rate of the tip outwards."""
    tip_up: float
    """Rate of the tip along the axis."""
    point_out: float
    point_up: float
    tip_around: float
    """Square of the tip's rate around the axis."""
    both_around: float
    """Product of the rates of tip and point around the axis."""


class GapRates(NamedTuple):
    """F(s, w), the distance of the point q(s) to the cutter at w of the pass, negative inside, with derivatives."""

    gap: float
    by_s: float
    by_w: float
    by_ww: float
    """Second derivative, less what the second derivative of the tip adds: its product with -`gradient`."""
    by_sw: float
    gradient: Triple


@jit_uncounted_inline
def meridian_distance(cutter: CutterParameters, rho: float, z: float) -> tuple[float, float, float, float]:
    """Signed distance from a point of the meridian half plane to the cutter, its gradient, and its bend.

    The distance to a convex body is the greatest of its distances to supporting planes.  Above the cutting edge's end
    it is that to the end's plane, a lower bound.

    Parameters
    ----------
    cutter : CutterParameters
    rho, z : float
        Distance from the axis and height above the tip, mm.

    Returns
    -------
    distance, d/drho, d/dz, curvature of the level line : float
    """
    x, y = rho - cutter.flat, z - cutter.corner
    if x >= 0.0 and y * cutter.cos + x * cutter.sin <= 0.0:
        size = sqrt(x * x + y * y)
        if size > _ON_AXIS:
            return size - cutter.corner, x / size, y / size, 1.0 / size
        return -cutter.corner, cutter.cos, -cutter.sin, 0.0
    side = x * cutter.cos - y * cutter.sin - cutter.corner
    if side >= -z and side >= z - cutter.top:
        return side, cutter.cos, -cutter.sin, 0.0
    if -z >= z - cutter.top:
        return -z, 0.0, -1.0, 0.0
    return z - cutter.top, 0.0, 1.0, 0.0


@jit_uncounted_inline
def signed_distance(cutter: CutterParameters, axis: Triple, apart: Triple) -> float:
    """Signed distance from a point, relative to the tip, to the cutter, mm, negative inside."""
    height = dot(apart, axis)
    across = plus(apart, axis, -height)
    return meridian_distance(cutter, sqrt(dot(across, across)), height)[0]


@jit_uncounted_inline
def touches(cutter: CutterParameters, axis: Triple, normal: Triple) -> bool:
    """Whether the cutter's bottom or arc touches a surface that has a normal."""
    return dot(axis, normal) >= cutter.sin - _TOUCHES


@jit_uncounted_inline
def place_tip(cutter: CutterParameters, axis: Triple, centre: Moving, normal: Moving) -> Moving:
    """The tip from the point `cutter.offset` above the contact and the normal, with their rates.

    Upright (T = n) it stands under that point, as in `toolaxis.contact.placement.tips`, whose formula this is.
    """
    height, rate = dot(normal.point, axis), dot(normal.rate, axis)
    across, change = plus(normal.point, axis, -height), plus(normal.rate, axis, -rate)
    square = dot(across, across)
    reach = along = 0.0
    if square > _UPRIGHT**2:
        reach, along = cutter.flat / sqrt(square), dot(across, change) / square
    return Moving(plus(plus(centre.point, across, reach), axis, -cutter.corner),
                  plus(centre.rate, plus(change, across, -along), reach))


@jit_uncounted_inline
def relative_motion(axis: Triple, point: Moving, tip: Moving) -> RelativeMotion:
    """The motion of a point relative to the cutter."""
    apart = plus(point.point, tip.point, -1.0)
    z = dot(apart, axis)
    across = plus(apart, axis, -z)
    rho = sqrt(dot(across, across))
    inverse = 1.0 / rho if rho > _ON_AXIS else 0.0
    outwards = (across[0] * inverse, across[1] * inverse, across[2] * inverse)
    tip_out, tip_up = dot(outwards, tip.rate), dot(axis, tip.rate)
    point_out, point_up = dot(outwards, point.rate), dot(axis, point.rate)
    return RelativeMotion(rho, z, outwards, inverse, tip_out, tip_up, point_out, point_up,
                          dot(tip.rate, tip.rate) - tip_out * tip_out - tip_up * tip_up,
                          dot(tip.rate, point.rate) - tip_out * point_out - tip_up * point_up)


@jit_uncounted_inline
def gap_rates(cutter: CutterParameters, axis: Triple, point: Moving, tip: Moving) -> GapRates:
    """Distance of a moving point to the cutter, with derivatives."""
    r = relative_motion(axis, point, tip)
    gap, out, up, bend = meridian_distance(cutter, r.rho, r.z)
    ring = out * r.inverse if r.rho > _ON_AXIS else bend
    tip_along, point_along = out * r.tip_up - up * r.tip_out, out * r.point_up - up * r.point_out
    x, t = r.outwards, axis
    return GapRates(gap, out * r.point_out + up * r.point_up, -(out * r.tip_out + up * r.tip_up),
                    bend * tip_along * tip_along + ring * r.tip_around,
                    -bend * tip_along * point_along - ring * r.both_around,
                    (out * x[0] + up * t[0], out * x[1] + up * t[1], out * x[2] + up * t[2]))
