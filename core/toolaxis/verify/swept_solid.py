"""A solid of revolution swept along one motion, exactly: the least of a convex function over it, and along a ray.

The solid's function at a point fixed in the part, seen while the tool moves with its axis fixed, is convex in the share
s of the motion and in the place t on a ray; turning motions come cut so short that they are convex to a stated bow.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.verify.revolved_solids import meridian

Array = NDArray[np.float64]
Motion: TypeAlias = tuple[Array, Array, Array, Array]
Ray: TypeAlias = tuple[float, float, float, float, float, float]

#: A root along a ray is where the solid's function is at most this, mm.
ROOT = 1e-9

#: How closely the least over a motion is bracketed, mm.
LEAST = 1e-10

#: A look at the middle of a motion rejects only what lies this far outside, mm: more than a turning motion's bow.
LOOK = 1e-4


@jit_inline
def gradient(solid: Array, motion: Motion, at: tuple[int, float], w: tuple[float, float, float],
             ) -> tuple[float, float, float, float, float]:
    """The solid's function at a point of the part, less the tip at the start, while motion at[0] is at share at[1].

    Returns its value, its slope in the share, and its gradient (x, y, z) over the part.
    """
    _, step, axis, turn = motion
    k, s = at
    w0, w1, w2 = w[0] - s * step[k, 0], w[1] - s * step[k, 1], w[2] - s * step[k, 2]
    t0, t1, t2, m = axis[k, 0], axis[k, 1], axis[k, 2], 1.0
    turning = turn[k, 0] != 0.0 or turn[k, 1] != 0.0 or turn[k, 2] != 0.0
    if turning:  # else the axis is of unit length
        t0, t1, t2 = t0 + s * turn[k, 0], t1 + s * turn[k, 1], t2 + s * turn[k, 2]
        m = 1.0 / np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        t0, t1, t2 = t0 * m, t1 * m, t2 * m
    z = w0 * t0 + w1 * t1 + w2 * t2
    p0, p1, p2 = w0 - z * t0, w1 - z * t1, w2 - z * t2
    rho = np.sqrt(p0 * p0 + p1 * p1 + p2 * p2)
    value, along_rho, along_z = meridian(solid, rho, z)
    share = along_rho / rho if rho > 1e-12 else 0.0
    g0, g1, g2 = share * p0 + along_z * t0, share * p1 + along_z * t1, share * p2 + along_z * t2
    slope = -(g0 * step[k, 0] + g1 * step[k, 1] + g2 * step[k, 2])
    if turning:  # at the rate T' of the axis z changes by w . T' and rho by -z / rho times that
        rate = p0 * turn[k, 0] + p1 * turn[k, 1] + p2 * turn[k, 2]
        slope += m * rate * (along_z - share * z)
    return value, slope, g0, g1, g2


@jit_inline
def moment(solid: Array, motion: Motion, at: tuple[int, float], ray: Ray, t: float) -> tuple[float, float, float]:
    """The solid's function at the point t of a ray while motion at[0] is at share at[1].

    Returns its value, its slope in the share, and its slope in t.
    """
    start, k = motion[0], at[0]
    w = (ray[0] + t * ray[3] - start[k, 0], ray[1] + t * ray[4] - start[k, 1], ray[2] + t * ray[5] - start[k, 2])
    value, slope, g0, g1, g2 = gradient(solid, motion, at, w)
    return value, slope, g0 * ray[3] + g1 * ray[4] + g2 * ray[5]


@jit_inline
def _zero(width: float, slope: tuple[float, float], other: tuple[float, float]) -> float:
    """Where a slope is zero between 0, where it is slope[0] < 0, and a width, where it is slope[1] > 0.

    By inverse quadratic interpolation with a third place, other[0], and the slope there; by the chord where that fails.
    """
    da, db = slope
    c, dc = other
    if dc != da and dc != db:
        part = width * da * dc / ((db - da) * (db - dc)) + c * da * db / ((dc - da) * (dc - db))
        if 0.0 < part < width:
            return part
    return -da / (db - da) * width


@jit
def least_over_motion(solid: Array, motion: Motion, k: int, ray: Ray, t: float) -> tuple[float, float, float, float]:
    """Least of the solid's function over motion k at the point t of a ray.

    Two ends with slopes of opposite sign close in on the least: through the zero of the interpolated slope (quick where
    the function is smooth), and every fourth time where the two tangents meet (quick where it has a kink) or half way.

    Returns
    -------
    value, low, along, share
        The least value met; a lower bound of all over the motion, and its slope in t: low + along * (t' - t) is a lower
        bound at every other t'; the share of the motion where the least was met.
    """
    sa, sb = 0.0, 1.0
    va, da, ta = moment(solid, motion, (k, sa), ray, t)
    if da >= 0.0:
        return va, va, ta, sa
    vb, db, tb = moment(solid, motion, (k, sb), ray, t)
    if db <= 0.0:
        return vb, vb, tb, sb
    low, along = va, ta
    sc, dc = sa, da
    for turn in range(120):
        width = sb - sa
        low = (va * db - vb * da + da * db * width) / (db - da)
        along = (db * ta - da * tb) / (db - da)
        if min(va, vb) - low <= LEAST:
            break
        if turn % 4 < 3:
            part = _zero(width, (da, db), (sc - sa, dc))
        elif turn % 8 == 3:
            part = (low - va) / da
        else:
            part = 0.5 * width
        s = sa + min(max(part, 1e-3 * width), 0.999 * width)
        v, d, a = moment(solid, motion, (k, s), ray, t)
        if d <= 0.0:
            sc, dc = sa, da
            sa, va, da, ta = s, v, d, a
        else:
            sc, dc = sb, db
            sb, vb, db, tb = s, v, d, a
    if va <= vb:
        return va, min(low, va), along, sa
    return vb, min(low, vb), along, sb


@jit
def sway(motion: Motion, k: int) -> float:
    """Angle by which the axis turns on motion k, rad: how much a slope along a ray may change with the share."""
    _, _, axis, turn = motion
    size = near = 0.0
    for c in range(3):
        size += turn[k, c] ** 2
        near += (axis[k, c] + 0.5 * turn[k, c]) ** 2
    return float(np.sqrt(size / near))


@jit
def first_entry(solid: Array, motion: Motion, k: int, ray: Ray, span: tuple[float, float]) -> float:
    """Least t in the span at which the ray is inside the solid swept along motion k; inf where it is not.

    Newton steps from below, which a convex function never lets overshoot; where the axis turns, they are taken with
    the steepest slope on the way.
    """
    t, change = span[0], sway(motion, k)
    for _ in range(200):
        value, low, along, _ = least_over_motion(solid, motion, k, ray, t)
        if value <= ROOT:
            return t
        if along >= change:
            return np.inf
        t += max(low, 0.5 * ROOT) / (change - along)
        if t > span[1]:
            return np.inf
    return t
