"""Bound of the distance between a convex piece of a tool and a curved cell, by a ball that encloses the piece.

Near the place where a tool touches, its plane tells too little: the cell bends towards the tool, and only the tool's
own bend keeps them apart.  Where the cell's normal n supports the piece on its corner arc, at p, every piece with a
flat bottom of radius f, an arc of radius r and n inclined against the axis by phi lies in the ball of radius
r + f / sin(phi) that touches it at p; the side above needs a greater one, or lies far enough above the plane.  The
squared distance of the cell's second-order form from the centre of that ball is, up to a small share, a quadratic form
of the two parameters; where it is convex its least value bounds it from below.
"""

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.local_frame import Bend, Frame, Piece, look
from toolaxis.numeric.jit import jit_fma_inline
from toolaxis.numeric.triples import Triple, cross, dot, plus
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]

#: Newton's steps at most, and shares below which a step is not worth going.
STEPS = 2
NEAR = 0.25
#: Sine of the least inclination between axis and normal: below it the ball is near to a plane.
SLIGHTEST = 0.02
#: Height of the part that lies in the ball, in radii of the tool.
SLENDER = 2.0


@jit_fma_inline
def ball_around(piece: Piece, rise: float, climb: float) -> tuple[float, float]:
    """Radius of a ball that touches a piece on its arc and holds its lower part; how far the rest keeps behind.

    Parameters
    ----------
    piece : tuple
    rise, climb : float
        The common normal's parts outwards and along the axis, climb below zero.

    Returns
    -------
    radius : float
        mm; infinite where there is no such ball.
    behind : float
        Distance of what is above the lower part from the common tangent plane, mm.
    """
    f, r, cb, sb, low, top, rim = piece
    height = min(top - low, SLENDER * (f + r))
    side = sb / cb
    wide = f + r * cb + max(height - r * (1.0 - sb), 0.0) * side
    at, up = f + r * rise, height - r - r * climb
    near = rise * (at - wide) - climb * up
    far = rise * (at + wide) - climb * up
    behind = np.inf
    if height < top - low:
        behind = min(near, rise * (at - rim) - climb * (top - low - r - r * climb))
    if near <= 0.0 or far <= 0.0:
        return np.inf, behind
    radius = r + f / rise
    radius = max(radius, ((wide - at)**2 + up * up) / (2.0 * near))
    return max(radius, ((wide + at)**2 + up * up) / (2.0 * far)), behind


@jit_fma_inline
def least_form(form: Triple, slopes: Triple, along: Triple, at: tuple[float, float]) -> float:
    """Least value of a quadratic form over a cell and a motion, or less; -inf where it is not convex in the cell.

    Parameters
    ----------
    form : (float, float, float)
        Its coefficients of x^2, 2 x y and y^2.
    slopes : (float, float, float)
        Half of its slopes along x, y and the motion at the origin.
    along : (float, float, float)
        Its coefficients of 2 x m, 2 y m and m^2, with the part of the motion m in [-1, 1].
    at : (float, float)
        Where in the cell the origin is: shares in [-1, 1].
    """
    (p, q, r), (x, y, m), (px, py, pm) = form, slopes, along
    det = p * r - q * q
    if p <= 0.0 or r <= 0.0 or det <= 1e-9 * p * r:
        return -np.inf
    if (at[0] >= 1.0 and x <= 0.0) or (at[0] <= -1.0 and x >= 0.0):
        x = 0.0
    if (at[1] >= 1.0 and y <= 0.0) or (at[1] <= -1.0 and y >= 0.0):
        y = 0.0
    least = -(r * x * x - 2.0 * q * x * y + p * y * y) / det
    if pm == 0.0:
        return least
    slope = m - (r * x * px - q * (x * py + y * px) + p * y * py) / det
    bend = pm - (r * px * px - 2.0 * q * px * py + p * py * py) / det
    if bend > abs(slope):
        return least - slope * slope / bend
    return least - 2.0 * abs(slope) + bend


@jit_fma_inline
def tangents(frame: Frame, bend: Bend, s: float, t: float) -> tuple[Triple, Triple, Triple]:
    """A point of the cell's second-order form seen from the tip, and its two tangents there.

    Parameters
    ----------
    frame, bend : tuples
    s, t : float
    """
    (w, _, a, b, _), (suu, suv, svv, _) = frame, bend
    point = plus(plus(w, plus(a, suu, s / 2.0), s), plus(plus(b, suv, s), svv, t / 2.0), t)
    return point, plus(plus(a, suu, s), suv, t), plus(plus(b, suv, s), svv, t)


@jit_fma_inline
def normal_of(ya: Triple, yb: Triple, axis: Triple) -> tuple[Triple, Triple, float, float]:
    """Unit normal away from the spindle, the unit vector outwards below it, and its parts outwards and along the axis.

    Parameters
    ----------
    ya, yb : (float, float, float)
        Tangents.
    axis : (float, float, float)

    Returns
    -------
    normal, outwards, rise, climb
        rise is 0 where the tangents are parallel or the normal is along the axis.
    """
    n = cross(ya, yb)
    size = np.sqrt(dot(n, n))
    if size < 1e-100:
        return n, n, 0.0, -1.0
    scale = -1.0 / size if dot(n, axis) > 0.0 else 1.0 / size
    n = (n[0] * scale, n[1] * scale, n[2] * scale)
    climb = dot(n, axis)
    rise = np.sqrt(max(1.0 - climb * climb, 0.0))
    if rise < SLIGHTEST:
        return n, n, 0.0, climb
    out = plus(n, axis, -climb)
    return n, (out[0] / rise, out[1] / rise, out[2] / rise), rise, climb


@jit_fma_inline
def towards_parallel(bend: Bend, piece: Piece, at: tuple[Triple, Triple, Triple],
                     view: tuple[Triple, Triple, float]) -> tuple[float, float]:
    """Newton's step to where the cell and the piece have one normal across their gap.

    Parameters
    ----------
    bend, piece : tuples
    at : tuple of (float, float, float)
        The point less the one that the piece has with its normal, and its tangents.
    view : tuple
        The normal, the unit vector around the axis, and the normal's part outwards.

    Returns
    -------
    (float, float) : of the shares s and t; zero where the step is not defined
    """
    (suu, suv, svv, _), (f, ya, yb), (n, around, rise) = bend, at, view
    naa, nab, nbb = dot(n, suu), dot(n, suv), dot(n, svv)
    ga, gm, gb = dot(ya, ya), dot(ya, yb), dot(yb, yb)
    oa, ob, det, r = dot(around, ya), dot(around, yb), ga * gb - gm * gm, piece[1]
    if det <= 0.0:
        return 0.0, 0.0
    o1, o2 = (gb * oa - gm * ob) / det * piece[0] / rise, (ga * ob - gm * oa) / det * piece[0] / rise
    na, nb = o1 * naa + o2 * nab, o1 * nab + o2 * nbb
    jaa, jab = ga + r * naa + oa * na + dot(suu, f), gm + r * nab + oa * nb + dot(suv, f)
    jba, jbb = gm + r * nab + ob * na + dot(suv, f), gb + r * nbb + ob * nb + dot(svv, f)
    fa, fb, det = dot(ya, f), dot(yb, f), jaa * jbb - jab * jba
    if det <= 1e-12 * ga * gb:
        return 0.0, 0.0
    return (jab * fb - jbb * fa) / det, (jba * fa - jaa * fb) / det


@jit_fma_inline
def enclosing_gap(frame: Frame, piece: Piece, bend: Bend) -> tuple[float, float]:
    """Least phi of one piece over a cell: a lower bound, -inf where the ball tells nothing, and one that is exceeded.

    Parameters
    ----------
    frame, piece, bend : tuples

    Returns
    -------
    lower, upper : float
        mm; some place of the motion comes as near as ``upper`` to some point of the cell.

    Notes
    -----
    Newton's steps look for the shares at which the cell is parallel to the piece across their gap; the bound holds
    wherever they end.  There the second-order form's squared distance from the ball's centre is taken apart.  Where
    only the lower part of the piece lies in the ball, what is above must keep clear of the whole cell.
    """
    axis, c, (suu, suv, svv, rest) = frame[1], frame[4], bend
    s, t = 0.0, 0.0
    for step in range(STEPS + 1):
        y, ya, yb = tangents(frame, bend, s, t)
        n, out, rise, climb = normal_of(ya, yb, axis)
        if rise == 0.0 or piece[2] * climb + piece[3] * rise >= 0.0:
            return -np.inf, np.inf
        f = plus(plus(plus(y, out, -piece[0]), axis, -piece[4] - piece[1]), n, -piece[1])
        if step < STEPS:
            ds, dt = towards_parallel(bend, piece, (f, ya, yb), (n, cross(axis, out), rise))
            ds, dt = min(max(s + ds, -1.0), 1.0) - s, min(max(t + dt, -1.0), 1.0) - t
            if abs(ds) < NEAR and abs(dt) < NEAR:
                break
            s, t = s + ds, t + dt
    view = look(y, axis)
    upper = piece_distance(piece, view[0], view[1])[0] + rest
    radius, behind = ball_around(piece, rise, climb)
    ds, dt = 1.0 + abs(s), 1.0 + abs(t)
    lift = dot(n, f) - abs(dot(n, c)) - rest - (abs(dot(n, suu)) * ds * ds + 2.0 * abs(dot(n, suv)) * ds * dt
                                                + abs(dot(n, svv)) * dt * dt) / 2.0
    if radius == np.inf or lift + behind <= 0.0 or lift <= -radius:
        return -np.inf, upper
    z = plus(f, n, radius)
    longest = np.sqrt(dot(ya, ya)) * ds + np.sqrt(dot(yb, yb)) * dt
    luu = longest * np.sqrt(dot(suu, suu)) + abs(dot(c, suu))
    luv = longest * np.sqrt(dot(suv, suv)) + abs(dot(c, suv))
    lvv = longest * np.sqrt(dot(svv, svv)) + abs(dot(c, svv))
    form = (dot(ya, ya) + dot(z, suu) - luu - luv, dot(ya, yb) + dot(z, suv), dot(yb, yb) + dot(z, svv) - luv - lvv)
    least = dot(z, z) + least_form(form, (dot(z, ya), dot(z, yb), dot(z, c)), (dot(c, ya), dot(c, yb), dot(c, c)),
                                   (s, t))
    if least <= 0.0:
        return -np.inf, upper
    return min(np.sqrt(least) - radius - rest, lift + behind), upper
