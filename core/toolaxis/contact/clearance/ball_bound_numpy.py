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
        s1, t1 = s[:, None], t[:, None]
        a, b = self.span[:, 0], self.span[:, 1]
        point = self.w + s1 * (a + s1 / 2 * suu) + t1 * (b + s1 * suv + t1 / 2 * svv)
        ya, yb = a + s1 * suu + t1 * suv, b + s1 * suv + t1 * svv
        n = np.cross(ya, yb)
        size = np.linalg.norm(n, axis=1)
        n = n / np.where(size > 1e-100, size, 1.0)[:, None]
        n = n * np.where(dot(n, self.axis) > 0, -1.0, 1.0)[:, None]
        climb = dot(n, self.axis)
        rise = np.sqrt(np.maximum(1 - climb**2, 0))
        good = (size > 1e-100) & (rise >= SLIGHTEST) & (self.piece[:, 2] * climb + self.piece[:, 3] * rise < 0)
        rise = np.where(good, rise, 0.0)
        out = (n - climb[:, None] * self.axis) / np.where(good, rise, 1.0)[:, None]
        flat, r, low = self.piece[:, 0], self.piece[:, 1], self.piece[:, 4]
        f = point - flat[:, None] * out - (low + r)[:, None] * self.axis - r[:, None] * n
        return _FormPoints(s, t, point, f, ya, yb, n, rise, climb, out)

    def step(self, at: _FormPoints) -> tuple[Array, Array]:
        """Newton's step to where the cell and the piece have one normal across their gap."""
        suu, suv, svv = self.second
        naa, nab, nbb = (dot(at.n, part) for part in (suu, suv, svv))
        ga, gm, gb = dot(at.ya, at.ya), dot(at.ya, at.yb), dot(at.yb, at.yb)
        around = np.cross(self.axis, at.out)
        oa, ob, r = dot(around, at.ya), dot(around, at.yb), self.piece[:, 1]
        det = ga * gb - gm * gm
        k = np.where(det > 0, self.piece[:, 0] / np.where(at.rise > 0, at.rise, 1.0), 0.0) / np.where(det > 0, det, 1.0)
        o1, o2 = k * (gb * oa - gm * ob), k * (ga * ob - gm * oa)
        na, nb = o1 * naa + o2 * nab, o1 * nab + o2 * nbb
        jaa, jab = ga + r * naa + oa * na + dot(suu, at.f), gm + r * nab + oa * nb + dot(suv, at.f)
        jba, jbb = gm + r * nab + ob * na + dot(suv, at.f), gb + r * nbb + ob * nb + dot(svv, at.f)
        fa, fb, det = dot(at.ya, at.f), dot(at.yb, at.f), jaa * jbb - jab * jba
        good = (ga * gb - gm * gm > 0) & (det > 1e-12 * ga * gb) & (at.rise > 0)
        det = np.where(good, det, 1.0)
        ds, dt = np.where(good, (jab * fb - jbb * fa) / det, 0.0), np.where(good, (jba * fa - jaa * fb) / det, 0.0)
        return np.clip(at.s + ds, -1, 1) - at.s, np.clip(at.t + dt, -1, 1) - at.t

    def parallel(self) -> _FormPoints:
        """Where cells and pieces have one normal across their gap, or nearly so."""
        at = self.place(np.zeros(len(self.w)), np.zeros(len(self.w)))
        active = np.ones(len(self.w), dtype=bool)
        for _ in range(STEPS):
            ds, dt = self.step(at)
            active &= (at.rise > 0) & ((np.abs(ds) >= NEAR) | (np.abs(dt) >= NEAR))
            at = self.place(at.s + np.where(active, ds, 0.0), at.t + np.where(active, dt, 0.0))
        return at

    def ball(self, at: _FormPoints) -> tuple[Array, Array]:
        """Radius of the enclosing balls, and how far the rest of the pieces keeps behind."""
        flat, r, cb, sb, low, top, rim = self.piece[:, :7].T
        height = np.minimum(top - low, SLENDER * (flat + r))
        wide = flat + r * cb + np.maximum(height - r * (1 - sb), 0) * (sb / cb)
        out, up = flat + r * at.rise, height - r - r * at.climb
        near = at.rise * (out - wide) - at.climb * up
        far = at.rise * (out + wide) - at.climb * up
        above = np.minimum(near, at.rise * (out - rim) - at.climb * (top - low - r - r * at.climb))
        good = (near > 0) & (far > 0) & (at.rise > 0)
        one = np.where(good, 1.0, np.inf)
        radius = np.maximum(r + flat / np.where(good, at.rise, 1.0),
                            np.maximum(((wide - out)**2 + up**2) / np.where(good, 2 * near, 1.0),
                                       ((wide + out)**2 + up**2) / np.where(good, 2 * far, 1.0)))
        return radius * one, np.where(height < top - low, above, np.inf)


def _least_form(form: Array, slopes: Array, along: Array, at: tuple[Array, Array]) -> Array:
    """Twin of `toolaxis.contact.clearance.ball_bound.least_form`, with rows (3, n)."""
    (p, q, r), (x, y, m), (px, py, pm) = form, slopes, along
    det = p * r - q * q
    good = (p > 0) & (r > 0) & (det > 1e-9 * p * r)
    det = np.where(good, det, 1.0)
    x = np.where(((at[0] >= 1) & (x <= 0)) | ((at[0] <= -1) & (x >= 0)), 0.0, x)
    y = np.where(((at[1] >= 1) & (y <= 0)) | ((at[1] <= -1) & (y >= 0)), 0.0, y)
    least = -(r * x * x - 2 * q * x * y + p * y * y) / det
    slope = m - (r * x * px - q * (x * py + y * px) + p * y * py) / det
    bend = pm - (r * px * px - 2 * q * px * py + p * py * py) / det
    inner = bend > np.abs(slope)
    least = np.where(inner, least - slope * slope / np.where(inner, bend, 1.0), least - 2 * np.abs(slope) + bend)
    return np.where(good, least, -np.inf)


def enclosing_gap_numpy(cell: CurvedCells) -> tuple[Array, Array]:
    """Twin of `toolaxis.contact.clearance.ball_bound.enclosing_gap`: lower and upper bounds, (n,) each.

    Parameters
    ----------
    cell : CurvedCells
    """
    at, c, rest = cell.parallel(), cell.span[:, 2], cell.bend[:, 9]
    rho = np.linalg.norm(at.point - dot(at.point, cell.axis)[:, None] * cell.axis, axis=1)
    upper = piece_distance_numpy(cell.piece, rho, dot(at.point, cell.axis))[0] + rest
    radius, behind = cell.ball(at)
    ds, dt = 1 + np.abs(at.s), 1 + np.abs(at.t)
    suu, suv, svv = cell.second
    nuu, nuv, nvv = (np.abs(dot(at.n, part)) for part in cell.second)
    lift = dot(at.n, at.f) - np.abs(dot(at.n, c)) - rest - (nuu * ds * ds + 2 * nuv * ds * dt + nvv * dt * dt) / 2
    good = (radius < np.inf) & (lift + behind > 0) & (lift > -radius)
    radius = np.where(good, radius, 0.0)
    z = at.f + radius[:, None] * at.n
    longest = np.linalg.norm(at.ya, axis=1) * ds + np.linalg.norm(at.yb, axis=1) * dt
    luu, luv, lvv = (longest * np.linalg.norm(part, axis=1) + np.abs(dot(c, part)) for part in cell.second)
    form = np.stack([dot(at.ya, at.ya) + dot(z, suu) - luu - luv, dot(at.ya, at.yb) + dot(z, suv),
                     dot(at.yb, at.yb) + dot(z, svv) - luv - lvv])
    least = dot(z, z) + _least_form(form, np.stack([dot(z, at.ya), dot(z, at.yb), dot(z, c)]),
                                    np.stack([dot(c, at.ya), dot(c, at.yb), dot(c, c)]), (at.s, at.t))
    lower = np.minimum(np.sqrt(np.maximum(least, 0)) - radius - rest, lift + behind)
    good &= least > 0
    return np.where(good, lower, -np.inf), np.where(at.rise > 0, upper, np.inf)
