"""One Newton step towards the exit: F(s, w) = 0 and dF/dw = 0 for a point moving in s and a cutter moving in w."""

from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.swept_cutter import Pair, Vector, gap_rates
from toolaxis.numeric.jit import jit_fma_inline

Array = NDArray[np.float64]
Second: TypeAlias = tuple[float, float, float]
Step: TypeAlias = tuple[float, float, float, bool]
"""ds, dw, dF/ds, and whether F has a minimum in w there, on the part of the cutter that was meant."""


@jit_fma_inline
def exit_step(cutter: Array, axis: Vector, point: Pair, tip: Pair, second: Second) -> Step:
    """Newton's step; second is the second derivative of the tip along the pass."""
    if cutter[0] > 0.0:
        return _ring_step(cutter, axis, point, tip, second)
    return _ball_step(cutter, axis, point, tip, second)


@jit_fma_inline
def side_step(cutter: Array, axis: Vector, point: Pair, tip: Pair, second: Second) -> Step:
    """Newton's step for an exit through the side line above the arc, as on the near side of a sideways lean."""
    a, r, cos_side, sin_side = cutter[0], cutter[1], cutter[2], cutter[3]
    t0, t1, t2 = axis[0], axis[1], axis[2]
    _, _, _, m0, m1, m2 = tip
    _, _, _, p0, p1, p2 = point
    x0, x1, x2 = point[0] - tip[0], point[1] - tip[1], point[2] - tip[2]
    z = x0 * t0 + x1 * t1 + x2 * t2
    x0, x1, x2 = x0 - z * t0, x1 - z * t1, x2 - z * t2
    rho = sqrt(x0 * x0 + x1 * x1 + x2 * x2)
    over = 1.0 / rho
    x0, x1, x2 = x0 * over, x1 * over, x2 * over
    tr, tz = x0 * m0 + x1 * m1 + x2 * m2, t0 * m0 + t1 * m1 + t2 * m2
    pr, pz = x0 * p0 + x1 * p1 + x2 * p2, t0 * p0 + t1 * p1 + t2 * p2
    beside = m0 * m0 + m1 * m1 + m2 * m2 - tr * tr - tz * tz
    across = m0 * p0 + m1 * p1 + m2 * p2 - tr * pr - tz * pz
    sr = x0 * second[0] + x1 * second[1] + x2 * second[2]
    sz = t0 * second[0] + t1 * second[1] + t2 * second[2]
    x, y, ring = rho - a, z - r, cos_side * over
    f, f_s, f_w = x * cos_side - y * sin_side - r, cos_side * pr - sin_side * pz, sin_side * tz - cos_side * tr
    f_ww, f_ws = ring * beside - cos_side * sr + sin_side * sz, -ring * across
    det = 1.0 / (f_s * f_ww - f_w * f_ws)
    on_side = y * cos_side + x * sin_side >= 0.0 and z <= cutter[4]
    return (f_w * f_w - f * f_ww) * det, (f * f_ws - f_s * f_w) * det, f_s, f_ww > 0.0 and on_side


@jit_fma_inline
def disc_step(cutter: Array, axis: Vector, point: Pair, tip: Pair, second: Second) -> Step:
    """Newton's step for an exit through the flat bottom, where the tip moves square to the axis.

    So it is on the far side of a sideways lean: both z and T . tip' vanish.
    """
    t0, t1, t2 = axis[0], axis[1], axis[2]
    x0, x1, x2 = point[0] - tip[0], point[1] - tip[1], point[2] - tip[2]
    z = x0 * t0 + x1 * t1 + x2 * t2
    rho = x0 * x0 + x1 * x1 + x2 * x2 - z * z
    pz = point[3] * t0 + point[4] * t1 + point[5] * t2
    tz = tip[3] * t0 + tip[4] * t1 + tip[5] * t2
    sz = second[0] * t0 + second[1] * t1 + second[2] * t2
    dw = -tz / sz
    return (tz * dw - z) / pz, dw, -pz, sz > 0.0 and rho <= cutter[0] * cutter[0]


@jit_fma_inline
def _ball_step(cutter: Array, axis: Vector, point: Pair, tip: Pair, second: Second) -> Step:
    """The step from the distance and its derivatives, which have no singular place on a ball."""
    f, f_s, f_w, f_ww, f_ws, g0, g1, g2 = gap_rates(cutter, axis, point, tip)
    f_ww -= g0 * second[0] + g1 * second[1] + g2 * second[2]
    det = f_s * f_ww - f_w * f_ws
    return (f_w * f_w - f * f_ww) / det, (f * f_ws - f_s * f_w) / det, f_s, f_ww > 0.0


@jit_fma_inline
def _ring_step(cutter: Array, axis: Vector, point: Pair, tip: Pair, second: Second) -> Step:
    """The step for a point of the corner arc whose normal is perpendicular to the tip's path.

    With rho and z the cylinder coordinates of the point and N = (sin theta, -cos theta) its normal in the meridian,
    tan theta = (T . tip') / (e_rho . tip'), both rho - a - r sin theta and z - r + r cos theta vanish.  This holds for
    a sharp corner too, r = 0, where the distance itself has no derivative.
    """
    a, r, cos_side, sin_side = cutter[0], cutter[1], cutter[2], cutter[3]
    t0, t1, t2 = axis[0], axis[1], axis[2]
    _, _, _, m0, m1, m2 = tip
    _, _, _, p0, p1, p2 = point
    x0, x1, x2 = point[0] - tip[0], point[1] - tip[1], point[2] - tip[2]
    z = x0 * t0 + x1 * t1 + x2 * t2
    x0, x1, x2 = x0 - z * t0, x1 - z * t1, x2 - z * t2
    rho = sqrt(x0 * x0 + x1 * x1 + x2 * x2)
    over = 1.0 / rho
    x0, x1, x2 = x0 * over, x1 * over, x2 * over
    tr, tz = x0 * m0 + x1 * m1 + x2 * m2, t0 * m0 + t1 * m1 + t2 * m2
    pr, pz = x0 * p0 + x1 * p1 + x2 * p2, t0 * p0 + t1 * p1 + t2 * p2
    size = tr * tr + tz * tz
    beside = m0 * m0 + m1 * m1 + m2 * m2 - size
    across = m0 * p0 + m1 * p1 + m2 * p2 - tr * pr - tz * pz
    sr = x0 * second[0] + x1 * second[1] + x2 * second[2]
    sz = t0 * second[0] + t1 * second[1] + t2 * second[2]
    share = 1.0 / size
    turn = sqrt(share) if tr >= 0.0 else -sqrt(share)
    n_rho, n_z = tz * turn, -tr * turn
    t_s = -tz * across * over * share
    t_w = (tr * sz - tz * (sr - beside * over)) * share
    e1, e2 = rho - a - r * n_rho, z - r - r * n_z
    e1s, e1w = pr + r * n_z * t_s, -tr + r * n_z * t_w
    e2s, e2w = pz - r * n_rho * t_s, -tz - r * n_rho * t_w
    det = 1.0 / (e1s * e2w - e1w * e2s)
    valley = size + r * (n_rho * over * beside - n_rho * sr - n_z * sz) > 0.0
    on_arc = n_rho >= 0.0 and n_z * cos_side + n_rho * sin_side <= 0.0
    return (e1w * e2 - e2w * e1) * det, (e2s * e1 - e1s * e2) * det, n_rho * pr + n_z * pz, valley and on_arc
