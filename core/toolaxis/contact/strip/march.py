"""The exit by a march along the cross curve, where Newton's method finds none that is confirmed.

m(s) = min over w of F is the distance of a point of the cross curve to the swept cutter.  The march steps along the
curve until m is not negative, and a bracketed search finds the zero.  Every value of m is a global minimum over the
pass, from exact tips close to each other and a search of the gaps between them that could hold it.
"""

from math import inf, isnan, nan, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curves import (
    ALONG_U,
    SECTION,
    CurvePoint,
    Moving,
    OrientedSurface,
    Scratch,
    SurfaceCurve,
    curve_point,
    offset_point,
    read_moving,
    store_moving,
)
from toolaxis.contact.strip.cutter_parameters import CAP
from toolaxis.contact.strip.newton import CutterSweep
from toolaxis.contact.strip.swept_cutter import gap_rates, place_tip, touches
from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.triples import Triple, dot, plus

Array = NDArray[np.float64]

WINDOW = 2.5
"""Length of the pass on either side of the contact that counts, in radii of the tool."""
#: Distance of the tips along the pass, in radii of the tool.
_SPACING = 1 / 6
#: How far, as a share of that, tips may be off a smooth path, as at a crease of the surface, before they come closer
#: together, and the closest that they come.
_JUMP, _LEAST = 0.02, 1e-4
#: How near tips come to where the cutter touches the surface no more, as a share of their distance.
_RIM = 0.02
#: Row of the contact among the tips.
_MIDDLE = 96
#: Where it is looked whether all up to a pole is covered, as a share of the last step: at the pole itself there is no
#: normal.
_BEFORE = 1e-6


class PassTips(NamedTuple):
    """Tips along the pass in the order of w: rows of the tip and its rate, and memory for what a point is off them."""

    w: Array
    tip: Array
    gap: Array
    """Distance of a point to the cutter there."""
    slope: Array
    """Its derivative in w."""
    first: int
    last: int
    """The rows in use."""


class SweptDistance(NamedTuple):
    """Distance of a point to the swept cutter, where on the pass it is taken, and its derivative in s."""

    gap: float
    w: float
    by_s: float


class Bracket(NamedTuple):
    """A covered and an uncovered s, m there and its derivative at the latter, and the least step in s."""

    inside: float
    low: float
    outside: float
    high: float
    slope: float
    near: float


def new_pass_tips() -> PassTips:
    """Memory for the tips along a pass."""
    rows = 2 * _MIDDLE + 1
    return PassTips(np.empty(rows), np.empty((rows, 6)), np.empty(rows), np.empty(rows), _MIDDLE, _MIDDLE)


@jit_uncounted_inline
def _length(x: Triple, y: Triple) -> float:
    apart = plus(x, y, -1.0)
    return sqrt(dot(apart, apart))


@jit_uncounted
def sample_pass(sweep: CutterSweep, axis: Triple, tips: PassTips, scratch: Scratch) -> PassTips:
    """Tips along the pass close to each other, both on the surface and along their own path, as far as the cutter
    touches the surface: beyond its rim it would stand on the back."""
    curve, radius = sweep.feed.curve, sweep.cutter.flat + sweep.cutter.corner
    spacing = _SPACING * radius
    low = high = _MIDDLE
    for side in (-1, 1):
        w, row, step, last_w = 0.0, _MIDDLE, 0.0, 0.0
        while True:
            at = curve_point(sweep.surface, curve, w, scratch)
            if row != _MIDDLE and not touches(sweep.cutter, axis, at.normal):
                if abs(w - last_w) * sqrt(dot(at.tangent, at.tangent)) > _RIM * spacing:
                    step *= 0.5
                    w = last_w + step
                    continue
                row -= side
                break
            tip = _tip_at(sweep, axis, at)
            speed, travel = sqrt(dot(at.tangent, at.tangent)), sqrt(dot(tip.rate, tip.rate))
            far = 0.0
            if row != _MIDDLE:
                last = read_moving(tips.tip, row - side)
                far = _length(tip.point, read_moving(tips.tip, _MIDDLE).point)
                moved = plus(tip.point, last.point, -1.0)
                jump = plus(moved, plus(tip.rate, last.rate, 1.0), -0.5 * step)
                apart = max(sqrt(dot(moved, moved)) / 1.5, sqrt(dot(jump, jump)) / _JUMP)
                if apart > spacing and abs(step) > _LEAST * spacing / speed:
                    step *= 0.5
                    w = last_w + step
                    continue
            tips.w[row] = w
            store_moving(tips.tip, row, tip)
            pace = max(speed, travel)
            if far > WINDOW * radius or row == 0 or row == 2 * _MIDDLE or not pace > 1e-300:
                break
            row += side
            step = side * spacing / pace
            last_w = w
            w += step
        low, high = min(low, row), max(high, row)
    return PassTips(tips.w, tips.tip, tips.gap, tips.slope, low, high)


@jit_uncounted
def swept_distance(sweep: CutterSweep, axis: Triple, point: Moving, enough: float, tips: PassTips,
                   scratch: Scratch) -> SweptDistance:
    """The least distance of a moving point to the cutter along the pass.

    Each gap between tips is searched in which the distance has a minimum that could be the least, unless a tip is
    nearer than `enough`.
    """
    spacing = _SPACING * (sweep.cutter.flat + sweep.cutter.corner)
    best = SweptDistance(inf, 0.0, 0.0)
    for k in range(tips.first, tips.last + 1):
        f = gap_rates(sweep.cutter, axis, point, read_moving(tips.tip, k))
        tips.gap[k], tips.slope[k] = f.gap, f.by_w
        if f.gap < best.gap:
            best = SweptDistance(f.gap, tips.w[k], f.by_s)
    if best.gap < enough:
        return best
    for k in range(tips.first, tips.last):
        valley = tips.slope[k] < 0.0 <= tips.slope[k + 1]
        if valley and min(tips.gap[k], tips.gap[k + 1]) - spacing <= best.gap:
            found = _least_between(sweep, axis, point, tips, k, scratch)
            if found.gap <= best.gap:
                best = found
    return best


@jit_uncounted_inline
def _tip_at(sweep: CutterSweep, axis: Triple, at: CurvePoint) -> Moving:
    """The tip for a contact on the pass."""
    return place_tip(sweep.cutter, axis, offset_point(at, sweep.cutter.offset), Moving(at.normal, at.turn))


@jit_uncounted
def _least_between(sweep: CutterSweep, axis: Triple, point: Moving, tips: PassTips, k: int,
                   scratch: Scratch) -> SweptDistance:
    """The least distance of a point to the cutter between the tips k and k + 1.

    The distance to a cutter is convex; moving it along the pass bends a tangent by half the second derivative of the
    tip at most.  The search, by secants of the slope and by intersections of the two tangents in turn, ends when the
    bound from the tangents is met, or at a smooth minimum.
    """
    cutter = sweep.cutter
    lo, hi, left, right = tips.w[k], tips.w[k + 1], read_moving(tips.tip, k), read_moving(tips.tip, k + 1)
    change = plus(right.rate, left.rate, -1.0)
    bend = (abs(change[0]) + abs(change[1]) + abs(change[2])) / (hi - lo)
    low, high = gap_rates(cutter, axis, point, left), gap_rates(cutter, axis, point, right)
    f_lo, f_hi, d_lo, d_hi = low.gap, high.gap, low.by_w, high.by_w
    best = SweptDistance(f_lo, lo, low.by_s) if f_lo <= f_hi else SweptDistance(f_hi, hi, high.by_s)
    weak_lo, weak_hi = d_lo, d_hi
    enough = 1e-12 * cutter.top
    for step in range(100):
        if not d_lo < 0.0 < d_hi:
            break
        meet, size = (f_hi - f_lo + d_lo * lo - d_hi * hi) / (d_lo - d_hi), hi - lo
        if best.gap - (f_lo + d_lo * (meet - lo)) + 0.5 * bend * size * size <= enough:
            break
        if step % 2 == 0:
            w = lo - weak_lo * size / (weak_hi - weak_lo)
        else:
            shift = bend * size * size / (d_hi - d_lo)
            w = meet + shift if meet - lo < hi - meet else meet - shift
        if step % 5 == 4 or not lo < w < hi:
            w = 0.5 * (lo + hi)
        if not lo < w < hi:
            break
        at = curve_point(sweep.surface, sweep.feed.curve, w, scratch)
        f = gap_rates(cutter, axis, point, _tip_at(sweep, axis, at))
        if f.gap < best.gap:
            best = SweptDistance(f.gap, w, f.by_s)
        if f.by_w * f.by_w <= enough * (f.by_ww - bend):
            break
        if f.by_w < 0.0:
            lo, f_lo, d_lo, weak_lo, weak_hi = w, f.gap, f.by_w, f.by_w, 0.5 * weak_hi
        else:
            hi, f_hi, d_hi, weak_hi, weak_lo = w, f.gap, f.by_w, f.by_w, 0.5 * weak_lo
    return best


@jit_uncounted
def _find_zero(sweep: CutterSweep, axis: Triple, bracket: Bracket, tips: PassTips, scratch: Scratch) -> float:
    """The zero of m between a covered and an uncovered s.

    Newton's method while it gains, with steps that close the bracket; where m has kinks the Illinois method goes on,
    with bisections.
    """
    inside, low, outside, high, slope, near = bracket
    radius = sweep.cutter.flat + sweep.cutter.corner
    s, m, newton = outside, high, True
    for step in range(100):
        before = m
        if newton:
            ahead = s - m / slope if slope * (outside - inside) > 0.0 else s
            if abs(ahead - s) <= near:
                ahead += near if (outside > inside) == (m < 0.0) else -near
        else:
            ahead = inside - low * (outside - inside) / (high - low)
        if (step % 4 == 3 and not newton) or not min(inside, outside) < ahead < max(inside, outside):
            ahead = 0.5 * (inside + outside)
        s = ahead
        point = offset_point(curve_point(sweep.surface, sweep.cross.curve, s, scratch), sweep.lift)
        found = swept_distance(sweep, axis, point, -inf, tips, scratch)
        m, slope = found.gap, found.by_s
        if m < 0.0:
            inside, low, high = s, m, 0.5 * high
        else:
            outside, high, low = s, m, 0.5 * low
        if abs(m) <= 1e-13 * radius or abs(outside - inside) <= 2.0 * near:
            return s
        newton = newton and abs(m) <= 0.25 * abs(before)
    return outside


@jit_uncounted_inline
def _pole_between(surface: OrientedSurface, curve: SurfaceCurve, s: float, ahead: float) -> float:
    """The end of the surface on an iso-curve between two parameters; NaN where there is none."""
    if curve.kind == SECTION:
        return nan
    data = surface.data
    knots, degree, start = (data[0], data[3], curve.u) if curve.kind == ALONG_U else (data[1], data[4], curve.v)
    end = (knots[degree] if ahead < s else knots[knots.shape[0] - degree - 1]) - start
    return float(end) if min(s, ahead) < end < max(s, ahead) else nan


@jit_uncounted
def exit_by_marching(sweep: CutterSweep, axis: Triple, stride: float, tips: PassTips,
                     scratch: Scratch) -> tuple[float, int]:
    """The first exit by steps along the cross curve.

    Parameters
    ----------
    sweep, axis, tips, scratch
    stride : float
        Length of a step, mm, signed by the side.

    Returns
    -------
    s : float
        Of the exit, or where the polyline of the steps reaches the cap, or the pole at which an iso-curve ends and the
        normal turns over.
    steps : int
        How many it took.
    """
    surface, cross = sweep.surface, sweep.cross.curve
    radius = sweep.cutter.flat + sweep.cutter.corner
    tips = sample_pass(sweep, axis, tips, scratch)
    here = curve_point(surface, cross, 0.0, scratch)
    pace = sqrt(dot(here.tangent, here.tangent))
    low = swept_distance(sweep, axis, offset_point(here, sweep.lift), 0.0, tips, scratch).gap
    s = walked = 0.0
    steps = 0
    while pace > 1e-300:
        steps += 1
        ahead = s + stride / pace
        there = curve_point(surface, cross, ahead, scratch)
        pole = nan
        if dot(here.normal, there.normal) < 0.0:
            pole = _pole_between(surface, cross, s, ahead)
        if not isnan(pole):
            ahead = pole + _BEFORE * (s - pole)
            there = curve_point(surface, cross, ahead, scratch)
        speed = sqrt(dot(there.tangent, there.tangent))
        found = swept_distance(sweep, axis, offset_point(there, sweep.lift), 0.0, tips, scratch)
        if found.gap >= 0.0:
            bracket = Bracket(s, low, ahead, found.gap, found.by_s, 5e-11 * radius / speed)
            return _find_zero(sweep, axis, bracket, tips, scratch), steps
        if not isnan(pole):
            return pole, steps
        piece = _length(here.point, there.point)
        pace = max(speed, 0.25 * pace)
        here, low = there, found.gap
        walked += piece
        if piece <= 1e-3 * abs(stride):
            return ahead, steps
        if walked >= CAP * radius:
            return ahead - (ahead - s) * min(1.0, (walked - CAP * radius) / piece), steps
        s = ahead
    return s, steps
