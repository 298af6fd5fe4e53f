"""The plain twin of `toolaxis.contact.clearance.ball_bound`, on whole arrays of cells."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.ball_bound import NEAR, SLENDER, SLIGHTEST, STEPS
from toolaxis.numeric.vectors import dot
from toolaxis.tools.solid import piece_distance_numpy

Array = NDArray[np.float64]


class _FormPoints(NamedTuple):
    """Points of second-order forms: shares, point less the piece's own, tangents, normal, its parts, outwards."""

    s: Array
    t: Array
    point: Array
    f: Array
    ya: Array
    yb: Array
    n: Array
    rise: Array
    climb: Array
    out: Array


class CurvedCells(NamedTuple):
    """Cells and pieces, n of each: q from the tip, axis, (a, b, c) as (n, 3, 3), A, B, C and rest, piece."""

    w: Array
    axis: Array
    span: Array
    bend: Array
    piece: Array

    @property
    def second(self) -> tuple[Array, Array, Array]:
        """A, B and C."""
        return self.bend[:, 0:3], self.bend[:, 3:6], self.bend[:, 6:9]

    def place(self, s: Array, t: Array) -> _FormPoints:
        """Points at shares; rise is zero where no arc has their normal."""
        suu, suv, svv = self.second
        s1 = s[:, None]
        t1 = t[:, None]
        a = self.span[:, 0]
        b = self.span[:, 1]
        point = self.w + s1 * (a + s1 / 2 * suu) + t1 * (b + s1 * suv + t1 / 2 * svv)
        ya = a + s1 * suu + t1 * suv
        yb = b + s1 * suv + t1 * svv
        n = np.cross(ya, yb)
        size = np.linalg.norm(n, axis=1)
        n = n / np.where(size > 1e-100, size, 1.0)[:, None]
        # Of both normals the one that points against the axis.
        n = n * np.where(dot(n, self.axis) > 0, -1.0, 1.0)[:, None]
        climb = dot(n, self.axis)
        rise = np.sqrt(np.maximum(1 - climb**2, 0))
        cosine = self.piece[:, 2]
        sine = self.piece[:, 3]
        on_arc = cosine * climb + sine * rise < 0
        good = (size > 1e-100) & (rise >= SLIGHTEST) & on_arc
        rise = np.where(good, rise, 0.0)
        out = (n - climb[:, None] * self.axis) / np.where(good, rise, 1.0)[:, None]
        flat = self.piece[:, 0]
        r = self.piece[:, 1]
        low = self.piece[:, 4]
        f = point - flat[:, None] * out - (low + r)[:, None] * self.axis - r[:, None] * n
        return _FormPoints(s, t, point, f, ya, yb, n, rise, climb, out)

    def step(self, at: _FormPoints) -> tuple[Array, Array]:
        """Newton's step to where the cell and the piece have one normal across their gap."""
        suu, suv, svv = self.second
        naa, nab, nbb = (dot(at.n, part) for part in (suu, suv, svv))
        # First form of the tangents, and what of them goes around the tool's axis.
        ga = dot(at.ya, at.ya)
        gm = dot(at.ya, at.yb)
        gb = dot(at.yb, at.yb)
        area = ga * gb - gm * gm
        around = np.cross(self.axis, at.out)
        oa = dot(around, at.ya)
        ob = dot(around, at.yb)
        # The foot of the arc turns around the axis with the normal, at the flat's radius.
        flat = self.piece[:, 0]
        r = self.piece[:, 1]
        turning = np.where(area > 0, flat / np.where(at.rise > 0, at.rise, 1.0), 0.0)
        k = turning / np.where(area > 0, area, 1.0)
        o1 = k * (gb * oa - gm * ob)
        o2 = k * (ga * ob - gm * oa)
        na = o1 * naa + o2 * nab
        nb = o1 * nab + o2 * nbb
        jaa = ga + r * naa + oa * na + dot(suu, at.f)
        jab = gm + r * nab + oa * nb + dot(suv, at.f)
        jba = gm + r * nab + ob * na + dot(suv, at.f)
        jbb = gb + r * nbb + ob * nb + dot(svv, at.f)
        fa = dot(at.ya, at.f)
        fb = dot(at.yb, at.f)
        det = jaa * jbb - jab * jba
        good = (area > 0) & (det > 1e-12 * ga * gb) & (at.rise > 0)
        det = np.where(good, det, 1.0)
        ds = np.where(good, (jab * fb - jbb * fa) / det, 0.0)
        dt = np.where(good, (jba * fa - jaa * fb) / det, 0.0)
        return np.clip(at.s + ds, -1, 1) - at.s, np.clip(at.t + dt, -1, 1) - at.t

    def parallel(self) -> _FormPoints:
        """Where cells and pieces have one normal across their gap, or nearly so."""
        at = self.place(np.zeros(len(self.w)), np.zeros(len(self.w)))
        active = np.ones(len(self.w), dtype=bool)
        for _ in range(STEPS):
            ds, dt = self.step(at)
            far = (np.abs(ds) >= NEAR) | (np.abs(dt) >= NEAR)
            active &= (at.rise > 0) & far
            s = at.s + np.where(active, ds, 0.0)
            t = at.t + np.where(active, dt, 0.0)
            at = self.place(s, t)
        return at

    def ball(self, at: _FormPoints) -> tuple[Array, Array]:
        """Radius of the enclosing balls, and how far the rest of the pieces keeps behind."""
        flat, r, cb, sb, low, top, rim = self.piece[:, :7].T
        whole = top - low
        height = np.minimum(whole, SLENDER * (flat + r))
        wide = flat + r * cb + np.maximum(height - r * (1 - sb), 0) * (sb / cb)
        # From the point of the arc to both corners at that height, near and far, along the normal.
        out = flat + r * at.rise
        up = height - r - r * at.climb
        near = at.rise * (out - wide) - at.climb * up
        far = at.rise * (out + wide) - at.climb * up
        at_top = at.rise * (out - rim) - at.climb * (whole - r - r * at.climb)
        above = np.minimum(near, at_top)
        good = (near > 0) & (far > 0) & (at.rise > 0)
        around_arc = r + flat / np.where(good, at.rise, 1.0)
        to_near = ((wide - out)**2 + up**2) / np.where(good, 2 * near, 1.0)
        to_far = ((wide + out)**2 + up**2) / np.where(good, 2 * far, 1.0)
        radius = np.maximum(around_arc, np.maximum(to_near, to_far))
        return radius * np.where(good, 1.0, np.inf), np.where(height < whole, above, np.inf)


def _least_form(form: Array, slopes: Array, along: Array, at: tuple[Array, Array]) -> Array:
    """Twin of `toolaxis.contact.clearance.ball_bound.least_form`, with rows (3, n)."""
    p, q, r = form
    x, y, m = slopes
    px, py, pm = along
    det = p * r - q * q
    good = (p > 0) & (r > 0) & (det > 1e-9 * p * r)
    det = np.where(good, det, 1.0)
    x = _inner_slope(x, at[0])
    y = _inner_slope(y, at[1])
    least = -(r * x * x - 2 * q * x * y + p * y * y) / det
    slope = m - (r * x * px - q * (x * py + y * px) + p * y * py) / det
    bend = pm - (r * px * px - 2 * q * px * py + p * py * py) / det
    inner = bend > np.abs(slope)
    at_vertex = least - slope * slope / np.where(inner, bend, 1.0)
    at_end = least - 2 * np.abs(slope) + bend
    return np.where(good, np.where(inner, at_vertex, at_end), -np.inf)


def _inner_slope(slope: Array, share: Array) -> Array:
    """A slope, or zero on a border of the cell beyond which it falls: nothing lower lies inside."""
    falls_beyond = ((share >= 1) & (slope <= 0)) | ((share <= -1) & (slope >= 0))
    return np.where(falls_beyond, 0.0, slope)


def enclosing_gap_numpy(cell: CurvedCells) -> tuple[Array, Array]:
    """Twin of `toolaxis.contact.clearance.ball_bound.enclosing_gap`: lower and upper bounds, (n,) each.

    Parameters
    ----------
    cell : CurvedCells
    """
    at = cell.parallel()
    c = cell.span[:, 2]
    rest = cell.bend[:, 9]
    height = dot(at.point, cell.axis)
    rho = np.linalg.norm(at.point - height[:, None] * cell.axis, axis=1)
    upper = piece_distance_numpy(cell.piece, rho, height)[0] + rest
    radius, behind = cell.ball(at)
    # How far shares may be from those of the point, and the gap along the normal less what the cell bends within.
    ds = 1 + np.abs(at.s)
    dt = 1 + np.abs(at.t)
    suu, suv, svv = cell.second
    nuu, nuv, nvv = (np.abs(dot(at.n, part)) for part in cell.second)
    bent = (nuu * ds * ds + 2 * nuv * ds * dt + nvv * dt * dt) / 2
    lift = dot(at.n, at.f) - np.abs(dot(at.n, c)) - rest - bent
    good = (radius < np.inf) & (lift + behind > 0) & (lift > -radius)
    radius = np.where(good, radius, 0.0)
    z = at.f + radius[:, None] * at.n
    # The square of the distance from the ball's middle as a form of the shares; what is beyond it, taken off.
    longest = np.linalg.norm(at.ya, axis=1) * ds + np.linalg.norm(at.yb, axis=1) * dt
    luu, luv, lvv = (longest * np.linalg.norm(part, axis=1) + np.abs(dot(c, part)) for part in cell.second)
    along_u = dot(at.ya, at.ya) + dot(z, suu) - luu - luv
    across = dot(at.ya, at.yb) + dot(z, suv)
    along_v = dot(at.yb, at.yb) + dot(z, svv) - luv - lvv
    form = np.stack([along_u, across, along_v])
    slopes = np.stack([dot(z, at.ya), dot(z, at.yb), dot(z, c)])
    motion = np.stack([dot(c, at.ya), dot(c, at.yb), dot(c, c)])
    least = dot(z, z) + _least_form(form, slopes, motion, (at.s, at.t))
    lower = np.minimum(np.sqrt(np.maximum(least, 0)) - radius - rest, lift + behind)
    good &= least > 0
    return np.where(good, lower, -np.inf), np.where(at.rise > 0, upper, np.inf)
