"""Lower bounds of the signed distance between convex pieces of a tool and cells of faces.

The signed distance phi to a convex piece is a convex function of the point, so with its slope g at any point y,
phi(x) >= phi(y) + g (x - y) for all x.  Over a cell {q + s a + t b + d, with s and t in [-1, 1] and d no longer than e}
the right side is least at a corner: a bound that holds between all points.  A straight motion of the tip adds a third
direction c, since only places relative to the tip count.  The bound is taken at the centre, from the plane of the cell
itself, and at the point that looks nearest; near a minimum its error falls as the square of the cell's size, and that
of `enclosing_gap` as its cube.
"""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.ball_bound import enclosing_gap
from toolaxis.contact.clearance.local_frame import Bend, Frame, Piece, Steps, View, look, slopes_along, spread
from toolaxis.numeric.jit import jit_fma_inline
from toolaxis.numeric.triples import Triple, cross, dot
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]

#: Shares of the distance at the centre and of e below which what a second-order form leaves makes it worth a look.
SLIGHT, BETTER = 0.05, 0.5


@jit_fma_inline
def settle(step: Triple, along: tuple[float, float, float, float], at: Triple) -> Triple:
    """Best share of one direction in phi's second-order form, the others held.

    Parameters
    ----------
    step : (float, float, float)
        Parts outwards, along the axis, around it.
    along : (float, float, float, float)
        Slopes of phi along rho and z, its curvatures across the gradient in the meridian plane and around the axis.
    at : (float, float, float)
        Share so far, and how far all shares together lead across the gradient and around the axis.

    Returns
    -------
    (float, float, float) : the same three, renewed
    """
    (rise, climb, bend, ring), (share, over, around) = along, at
    across = rise * step[1] - climb * step[0]
    over -= share * across
    around -= share * step[2]
    stiff = bend * across * across + ring * step[2] * step[2]
    slope = rise * step[0] + climb * step[1] + bend * over * across + ring * around * step[2]
    share = 0.0
    if stiff > abs(slope):
        share = -slope / stiff
    elif slope != 0.0:
        share = -1.0 if slope > 0.0 else 1.0
    return share, over + share * across, around + share * step[2]


@jit_fma_inline
def nearest_share(steps: Steps, along: tuple[float, float, float, float]) -> Triple:
    """Shares in [-1, 1] where phi's second-order form about the centre is about least, by two sweeps."""
    s, over, around = settle(steps[0], along, (0.0, 0.0, 0.0))
    t, over, around = settle(steps[1], along, (0.0, over, around))
    tau, over, around = settle(steps[2], along, (0.0, over, around))
    s, over, around = settle(steps[0], along, (s, over, around))
    t, over, around = settle(steps[1], along, (t, over, around))
    tau, over, around = settle(steps[2], along, (tau, over, around))
    return s, t, tau


@jit_fma_inline
def fall_over_cell(slopes: Triple, at: Triple) -> float:
    """Least value of a linear function over a whole cell, less its value at some shares."""
    return (-abs(slopes[0]) - slopes[0] * at[0] - abs(slopes[1]) - slopes[1] * at[1]
            - abs(slopes[2]) - slopes[2] * at[2])


@jit_fma_inline
def fall_over_region(slopes: Triple, at: Triple, region: Array, count: int) -> tuple[float, int]:
    """Least value of a linear function over what trims leave of a cell, less its value at some shares; its corner."""
    corner, least = 0, np.inf
    for k in range(count):
        value = slopes[0] * (region[k, 0] - at[0]) + slopes[1] * (region[k, 1] - at[1])
        if value < least:
            corner, least = k, value
    return least - abs(slopes[2]) - slopes[2] * at[2], corner


@jit_fma_inline
def plane_gap(frame: Frame, piece: Piece, along: tuple[float, float], outwards: Triple) -> float:
    """Distance by which the plane of a cell lies beyond the piece's supporting plane; -inf where a cell has none.

    Parameters
    ----------
    frame : tuple
    piece : tuple
    along : (float, float)
        Slopes of phi along rho and z at the centre; they tell the far side of the plane.
    outwards : (float, float, float)
    """
    w, axis, a, b, c = frame
    n = cross(a, b)
    size = np.sqrt(dot(n, n))
    if size < 1e-100:
        return -np.inf
    scale = 1.0 / size if along[0] * dot(n, outwards) + along[1] * dot(n, axis) > 0.0 else -1.0 / size
    climb = scale * dot(n, axis)
    rise = np.sqrt(max(1.0 - climb * climb, 0.0))
    if piece[2] * climb + piece[3] * rise <= 0.0:
        support = piece[0] * rise + (piece[4] + piece[1]) * climb + piece[1]
    else:
        support = piece[6] * rise + piece[5] * climb
    return float(scale * dot(n, w) - abs(scale * dot(n, c)) - support)


@jit_fma_inline
def evaluate_shares(frame: Frame, piece: Piece, at: Triple) -> tuple[float, Triple]:
    """phi at some shares of a, b and c, and its slopes along them there."""
    w, axis, a, b, c = frame
    s, t, tau = at
    rho, z, _, outwards = look((w[0] + s * a[0] + t * b[0] + tau * c[0], w[1] + s * a[1] + t * b[1] + tau * c[1],
                                w[2] + s * a[2] + t * b[2] + tau * c[2]), axis)
    value, rise, climb, _ = piece_distance(piece, rho, z)
    return value, slopes_along(spread(frame, outwards), rise, climb)


@jit_fma_inline
def bound_inside(piece: Piece, steps: Steps, rho: float, z: float) -> float:
    """Bound from the bottom's and the side's supporting planes together, and from the axis; for cells inside a piece.

    Both planes lie below phi, so does every mean of them; the best mean is one in which the slope along a, b or c
    vanishes.  phi does not fall outwards, so its values on the axis bound it too.

    Parameters
    ----------
    piece, steps : tuples
    rho, z : float
        Place of the centre.
    """
    a, b, c = steps
    low, side = piece[4] - z, piece[2] * (rho - piece[0]) - piece[3] * (z - piece[4] - piece[1]) - piece[1]
    s0, s1, s2 = slopes_along(steps, piece[2], -piece[3])
    least = low - abs(a[1]) - abs(b[1]) - abs(c[1])
    for down, slant in ((-a[1], s0), (-b[1], s1), (-c[1], s2)):
        if down * slant < 0.0:
            t = slant / (slant - down)
            fall = (abs(t * -a[1] + (1.0 - t) * s0) + abs(t * -b[1] + (1.0 - t) * s1)
                    + abs(t * -c[1] + (1.0 - t) * s2))
            least = max(least, t * low + (1.0 - t) * side - fall)
    value, _, climb, _ = piece_distance(piece, 0.0, z)
    return max(least, value - abs(climb) * (abs(a[1]) + abs(b[1]) + abs(c[1])))


@jit_fma_inline
def bound_over_cell(frame: Frame, piece: Piece, view: View, bend: Bend, reach: Triple) -> tuple[float, float]:
    """Least phi of one piece over a whole cell: a lower bound, and one that some point of a whole cell stays under.

    Parameters
    ----------
    frame : tuple
    piece : tuple
    view : tuple
        From `look` at the centre.
    bend : tuple
    reach : (float, float, float)
        e; radius around q, half the motion included; the value from which more effort is not wanted.
    """
    (rho, z, over_rho, outwards), (e, radius, wanted) = view, reach
    value, rise, climb, curved = piece_distance(piece, rho, z)
    lower, upper = value - radius, value
    if lower >= wanted or e >= radius:
        return lower, upper
    steps = spread(frame, outwards)
    slopes = slopes_along(steps, rise, climb)
    lower = max(lower, value - abs(slopes[0]) - abs(slopes[1]) - abs(slopes[2]) - e)
    if lower < wanted and bend[3] < min(SLIGHT * (value - wanted), BETTER * e):
        ball, seen = enclosing_gap(frame, piece, bend)
        lower, upper = max(lower, ball), min(upper, seen)
    if lower >= wanted or value - e < wanted:
        return lower, upper
    ring = rise * over_rho
    if value < 0.0:
        lower = max(lower, bound_inside(piece, steps, rho, z) - e)
    if lower >= wanted or (curved == 0.0 and ring == 0.0):
        return lower, upper
    lower = max(lower, plane_gap(frame, piece, (rise, climb), outwards) - e)
    if lower >= wanted:
        return lower, upper
    at = nearest_share(steps, (rise, climb, curved, ring))
    seen, slopes = evaluate_shares(frame, piece, at)
    return max(lower, seen + fall_over_cell(slopes, at) - e), upper


@jit_fma_inline
def bound_over_region(frame: Frame, piece: Piece, reach: Triple, region: Array, count: int) -> tuple[float, float]:
    """Least phi of one piece over what trims leave of a cell: a lower bound, and one that some point stays under.

    Parameters
    ----------
    frame : tuple
    piece : tuple
    reach : (float, float, float)
        e; radius around q; the value from which more effort is not wanted.
    region : (k, 2) array
        Corners of what is left, as shares of a and b.
    count : int
        How many of them count.
    """
    e, radius, wanted = reach
    centre = (0.0, 0.0, 0.0)
    value, slopes = evaluate_shares(frame, piece, centre)
    fall, corner = fall_over_region(slopes, centre, region, count)
    lower = max(value - radius, value + fall - e)
    if lower >= wanted:
        return lower, np.inf
    tau = 0.0
    if slopes[2] != 0.0:
        tau = -1.0 if slopes[2] > 0.0 else 1.0
    at = (region[corner, 0], region[corner, 1], tau)
    value, slopes = evaluate_shares(frame, piece, at)
    fall, corner = fall_over_region(slopes, at, region, count)
    return max(lower, value + fall - e), value + e
