"""Lower bounds of the signed distance between convex pieces of a tool and cells of faces.

The signed distance phi to a convex piece is a convex function of the point, so with its slope g at any point y,
phi(x) >= phi(y) + g (x - y) for all x.  Over a cell {q + s a + t b + d, with s and t in [-1, 1] and d no longer than e}
the right side is least at a corner: a bound that holds between all points.  A straight motion of the tip adds a third
direction c, since only places relative to the tip count.  The bound is taken at the centre and, where that does not
decide, at the point of the cell that looks nearest; near a minimum its error falls as the square of the cell's size.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.compiled import compiled
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]
Scratch: TypeAlias = tuple[Array, Array]


@compiled
def evaluate_at(frame: Array, piece: Array, at: Array, out: Array) -> None:
    """phi at one point of a cell, its slopes along a, b and c, and what its second order is made of.

    Parameters
    ----------
    frame : (5, 3) array
        q from the tip, the axis, a, b, c.
    piece : (8,) array
    at : (3,) array
        Shares of a, b, c.
    out : (12,) array
        Receives phi; three slopes; three steps in the meridian plane across the gradient; three steps around the
        axis; the curvatures that belong to these steps.
    """
    wx = frame[0, 0] + at[0] * frame[2, 0] + at[1] * frame[3, 0] + at[2] * frame[4, 0]
    wy = frame[0, 1] + at[0] * frame[2, 1] + at[1] * frame[3, 1] + at[2] * frame[4, 1]
    wz = frame[0, 2] + at[0] * frame[2, 2] + at[1] * frame[3, 2] + at[2] * frame[4, 2]
    ax, ay, az = frame[1, 0], frame[1, 1], frame[1, 2]
    z = wx * ax + wy * ay + wz * az
    px, py, pz = wx - z * ax, wy - z * ay, wz - z * az
    rho = np.sqrt(px * px + py * py + pz * pz)
    value, along_rho, along_z, bend = piece_distance(piece, rho, z)
    scale = 1.0 / rho if rho > 1e-12 else 0.0
    px, py, pz = px * scale, py * scale, pz * scale
    cx, cy, cz = ay * pz - az * py, az * px - ax * pz, ax * py - ay * px
    out[0] = value
    for k in range(3):
        vx, vy, vz = frame[2 + k, 0], frame[2 + k, 1], frame[2 + k, 2]
        v_rho = vx * px + vy * py + vz * pz
        v_z = vx * ax + vy * ay + vz * az
        out[1 + k] = along_rho * v_rho + along_z * v_z
        out[4 + k] = along_rho * v_z - along_z * v_rho
        out[7 + k] = vx * cx + vy * cy + vz * cz
    out[10] = bend
    out[11] = along_rho * scale


@compiled
def nearest_share(out: Array, at: Array) -> None:
    """Shares in [-1, 1] where the second-order form of phi about the centre is about least, by two sweeps.

    Parameters
    ----------
    out : (12,) array
        From `evaluate_at` at the centre.
    at : (3,) array
        Receives the shares.
    """
    for k in range(3):
        at[k] = 0.0
    for _ in range(2):
        for k in range(3):
            slope = out[1 + k]
            for j in range(3):
                if j != k:
                    slope += at[j] * (out[10] * out[4 + j] * out[4 + k] + out[11] * out[7 + j] * out[7 + k])
            bend = out[10] * out[4 + k] * out[4 + k] + out[11] * out[7 + k] * out[7 + k]
            if bend > abs(slope):
                at[k] = -slope / bend
            elif slope != 0.0:
                at[k] = -1.0 if slope > 0.0 else 1.0


@compiled
def greatest_fall(out: Array, at: Array, region: Array, count: int) -> tuple[float, int]:
    """Least value of the linear continuation, from ``at``, over a cell or the part of it that trims leave.

    Parameters
    ----------
    out : (12,) array
        From `evaluate_at`.
    at : (3,) array
    region : (k, 2) array
        Shares of a and b of the corners of what trims leave.
    count : int
        How many corners count; 0 for the whole cell.

    Returns
    -------
    fall : float
        Zero or negative where ``at`` is in the cell.
    corner : int
        Which corner of the region is lowest.
    """
    fall = -abs(out[3]) - out[3] * at[2]
    if count == 0:
        return fall - abs(out[1]) - out[1] * at[0] - abs(out[2]) - out[2] * at[1], 0
    corner, least = 0, np.inf
    for k in range(count):
        value = out[1] * (region[k, 0] - at[0]) + out[2] * (region[k, 1] - at[1])
        if value < least:
            corner, least = k, value
    return fall + least, corner


@compiled
def piece_bound(frame: Array, piece: Array, reach: tuple[float, float, float], trims: tuple[Array, int],
                scratch: Scratch) -> tuple[float, float]:
    """Bounds of the least phi of one piece over a cell.

    Parameters
    ----------
    frame : (5, 3) array
        q from the tip, the axis, a, b, c.
    piece : (8,) array
    reach : (float, float, float)
        e; the radius around q, half the motion included; the value from which more effort is not wanted.
    trims : (array, int)
        Corners of what trims leave, and their number.
    scratch : (array (3,), array (12,))

    Returns
    -------
    lower : float
        No point of the cell has a smaller phi.
    upper : float
        phi at the centre of a whole cell; a value that some point does not exceed where trims cut the cell.
    """
    (at, out), (region, count), (e, radius, wanted) = scratch, trims, reach
    at[0] = at[1] = at[2] = 0.0
    evaluate_at(frame, piece, at, out)
    upper = out[0] if count == 0 else np.inf
    lower = out[0] - radius
    if lower >= wanted:
        return lower, upper
    fall, corner = greatest_fall(out, at, region, count)
    lower = max(lower, out[0] + fall - e)
    if lower >= wanted or (count == 0 and out[10] == 0.0 and out[11] == 0.0) or e >= radius:
        return lower, upper
    if count == 0:
        nearest_share(out, at)
    else:
        at[0], at[1] = region[corner, 0], region[corner, 1]
        at[2] = 0.0 if out[3] == 0.0 else -np.sign(out[3])
    evaluate_at(frame, piece, at, out)
    fall, corner = greatest_fall(out, at, region, count)
    if count > 0:
        upper = out[0] + e
    return max(lower, out[0] + fall - e), upper
