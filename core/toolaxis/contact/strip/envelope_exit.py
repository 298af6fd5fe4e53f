"""Where the lifted surface first leaves the swept cutter: the exact half width at one contact.

F(s, w) is the signed distance from the lifted point q(s) of the cross curve to the cutter at w of the pass, and
m(s) = min over w of F its distance to the swept cutter.  The exit solves F = 0 and dF/dw = 0 by Newton's method from
the second-order solution; it is then checked to be the first one and not covered from elsewhere, and where Newton or
a check fails, a march along the cross curve with the global minimum over w finds it instead.
"""

from math import inf, isnan, nan, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curves import ALONG_U, SECTION, Curve, Scratch
from toolaxis.contact.strip.newton import exit_step
from toolaxis.contact.strip.swept_cutter import (
    Setting,
    gap_rates,
    lift_point,
    pair_of,
    pass_tip,
    scan_pass,
    signed_distance,
)
from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
Job: TypeAlias = tuple[Setting, Curve, Curve]
"""Setting, pass, cross curve."""
Memory: TypeAlias = tuple[Array, Array, Array, Scratch]
Road: TypeAlias = tuple[Array, Array, int, int]
"""Nodes of the pass, room for their distances and slopes, first and last row."""
Lengths: TypeAlias = tuple[float, float, float, float]
"""Lift h + A, radius R, cap of a half width, spacing of the nodes; mm."""

#: Where it is looked whether all up to a pole is covered, as a share of the last step: at the pole itself there is no
#: normal.
_BEFORE = 1e-6


@jit
def newton_exit(job: Job, lengths: Lengths, start: tuple[float, float, float, float], room: Array,
                memory: Memory) -> tuple[bool, float, float]:
    """Solve F = 0, dF/dw = 0.

    Parameters
    ----------
    job, lengths, memory
    start : (s0, w0, s, w)
        Contact and first guess.
    room : (3, 3) array
        Its first row holds an estimate of the second derivative of the tip along the pass, improved on the way.

    Returns
    -------
    solved, s, w
    """
    setting, road, cross = job
    lift, radius, _, _ = lengths
    s0, w0, s, w = start
    tip, point, second, old = memory[1], memory[2], room[0], room[2]
    w_old = w0
    for step in range(12):
        lift_point(setting, cross, s, lift, memory)
        pass_tip(setting, road, w, memory)
        travel = sqrt(tip[1, 0] ** 2 + tip[1, 1] ** 2 + tip[1, 2] ** 2)
        pace = sqrt(point[1, 0] ** 2 + point[1, 1] ** 2 + point[1, 2] ** 2)
        for c in range(3):
            if step > 0 and abs(w - w_old) * travel > 1e-6 * radius:
                second[c] = (tip[1, c] - old[c]) / (w - w_old)
            old[c] = tip[1, c]
        w_old = w
        ds, dw, leaving, valid = exit_step(setting[2], setting[3], pair_of(point), pair_of(tip),
                                           (second[0], second[1], second[2]))
        if not abs(ds) + abs(dw) < inf:
            return False, s, w
        if abs(ds) * pace <= 1e-8 * radius and abs(dw) * travel <= 1e-7 * radius:
            return valid and leaving * (s - s0) > 0.0, s + ds, w + dw
        share = max(abs(ds) / (0.6 * abs(s - s0)), abs(dw) * travel / (0.5 * radius), 1.0)
        s += ds / share
        w += dw / share
    return False, s, w


@jit
def least_between(job: Job, point: Array, ends: tuple[int, int], road: Road,
                  memory: Memory) -> tuple[float, float, float]:
    """The least distance of a point to the cutter between two nodes of the pass.

    The distance to a cutter is convex; moving it along the pass bends a tangent by half the second derivative of the
    tip at most.  The search, by secants of the slope and by intersections of the two tangents in turn, ends when the
    bound from the tangents is met, or at a smooth minimum.

    Returns
    -------
    F, w, F_s
    """
    setting, way, _ = job
    table, tip = road[0], memory[1]
    left, right = ends
    lo, hi = table[left, 0], table[right, 0]
    bend = 0.0
    for k in range(left, right):
        for c in range(4, 7):
            bend += abs(table[k + 1, c] - table[k, c]) / (table[k + 1, 0] - table[k, 0])
    tip[0], tip[1] = table[left, 1:4], table[left, 4:7]
    f_lo, s_lo, d_lo, _, _, _, _, _ = gap_rates(setting[2], setting[3], pair_of(point), pair_of(tip))
    tip[0], tip[1] = table[right, 1:4], table[right, 4:7]
    f_hi, s_hi, d_hi, _, _, _, _, _ = gap_rates(setting[2], setting[3], pair_of(point), pair_of(tip))
    best, place, slope = (f_lo, lo, s_lo) if f_lo <= f_hi else (f_hi, hi, s_hi)
    weak_lo, weak_hi = d_lo, d_hi
    enough = 1e-12 * setting[2][4]
    for step in range(100):
        if not (d_lo < 0.0 < d_hi):
            break
        meet = (f_hi - f_lo + d_lo * lo - d_hi * hi) / (d_lo - d_hi)
        size = hi - lo
        if best - (f_lo + d_lo * (meet - lo)) + 0.5 * bend * size * size <= enough:
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
        pass_tip(setting, way, w, memory)
        f, f_s, d, curved, _, _, _, _ = gap_rates(setting[2], setting[3], pair_of(point), pair_of(tip))
        if f < best:
            best, place, slope = f, w, f_s
        if d * d <= enough * (curved - bend):
            break
        if d < 0.0:
            lo, f_lo, d_lo, weak_lo, weak_hi = w, f, d, d, 0.5 * weak_hi
        else:
            hi, f_hi, d_hi, weak_hi, weak_lo = w, f, d, d, 0.5 * weak_lo
    return best, place, slope


@jit_fma_inline
def _valley(gaps: Array, k: int) -> bool:
    """Whether the distance has a minimum between nodes k and k + 1."""
    return bool(gaps[k, 1] < 0.0 <= gaps[k + 1, 1])


@jit
def _deepest(job: Job, lengths: Lengths, road: Road, memory: Memory) -> tuple[float, float, float]:
    """The least distance of memory[2] to the swept cutter, from the distances of the nodes; F, w, F_s.

    Each valley between nodes that could hold the least value is looked into.
    """
    table, gaps, first, last = road
    best, place, slope = inf, table[first, 0], 0.0
    for k in range(first, last + 1):
        if gaps[k, 0] < best:
            best, place = gaps[k, 0], table[k, 0]
    for k in range(first, last):
        if not _valley(gaps, k) or min(gaps[k, 0], gaps[k + 1, 0]) - lengths[3] > best:
            continue
        f, w, f_s = least_between(job, memory[2], (k, k + 1), road, memory)
        if f <= best:
            best, place, slope = f, w, f_s
    return best, place, slope


@jit
def swept_distance(job: Job, lengths: Lengths, s: float, road: Road, memory: Memory) -> tuple[float, float, float]:
    """m(s), the w at which it is taken, and dm/ds."""
    lift_point(job[0], job[2], s, lengths[0], memory)
    scan_pass(job[0], road[0], (road[2], road[3]), memory[2], road[1])
    return _deepest(job, lengths, road, memory)


@jit_fma_inline
def _tip_between(table: Array, rows: tuple[int, int], w: float, tip: Array) -> None:
    """The tip at w by cubic interpolation between the nodes, into tip[0]."""
    k = rows[0]
    high = rows[1]
    while high - k > 1:
        middle = (k + high) // 2
        if table[middle, 0] <= w:
            k = middle
        else:
            high = middle
    size = table[k + 1, 0] - table[k, 0]
    t = (w - table[k, 0]) / size
    p, q = t * t * (3.0 - 2.0 * t), t * (1.0 - t) * size
    for c in range(3):
        tip[0, c] = (table[k, 1 + c] * (1.0 - p) + table[k + 1, 1 + c] * p
                     + q * ((1.0 - t) * table[k, 4 + c] - t * table[k + 1, 4 + c]))


@jit
def is_first_exit(job: Job, lengths: Lengths, found: tuple[float, float, float, float], road: Road,
                  memory: Memory) -> bool:
    """Whether an exit is the first one, and not covered from elsewhere on the pass; found = (s0, w0, s, w).

    Points a third and two thirds of the way must be covered, and the exit must be free of the cutter everywhere else.
    """
    s0, w0, s, w = found
    setting, _, cross = job
    tip, point = memory[1], memory[2]
    table, gaps, first, last = road
    if not table[first, 0] < w < table[last, 0]:
        return False
    for k in range(1, 3):
        share = k / 3.0
        lift_point(setting, cross, s0 + share * (s - s0), lengths[0], memory)
        _tip_between(table, (first, last), w0 + share * (w - w0), tip)
        if signed_distance(setting[2], setting[3], point[0, 0] - tip[0, 0], point[0, 1] - tip[0, 1],
                           point[0, 2] - tip[0, 2]) >= 0.0:
            return False
    lift_point(setting, cross, s, lengths[0], memory)
    scan_pass(setting, table, (first, last), point, gaps)
    for k in range(first, last):
        if gaps[k, 0] < -1e-9 * lengths[1]:
            return False
        if not _valley(gaps, k) or min(gaps[k, 0], gaps[k + 1, 0]) > lengths[3] or table[k, 0] <= w <= table[k + 1, 0]:
            continue
        if least_between(job, point, (k, k + 1), road, memory)[0] < -1e-9 * lengths[1]:
            return False
    return True


@jit
def _root(job: Job, lengths: Lengths, inside: float, outside: float,
          bench: tuple[Road, Memory]) -> float:
    """The zero of m between a covered and an uncovered s.

    Newton's method while it gains, with steps that close the bracket; where m has kinks the Illinois method goes on,
    with bisections.
    """
    road, memory = bench
    low, _, _ = swept_distance(job, lengths, inside, road, memory)
    high, _, slope = swept_distance(job, lengths, outside, road, memory)
    point = memory[2]
    pace = sqrt(point[1, 0] ** 2 + point[1, 1] ** 2 + point[1, 2] ** 2)
    near = 5e-11 * lengths[1] / pace
    s, m = outside, high
    newton = True
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
        m, _, slope = swept_distance(job, lengths, s, road, memory)
        if m < 0.0:
            inside, low, high = s, m, 0.5 * high
        else:
            outside, high, low = s, m, 0.5 * low
        if abs(m) <= 1e-13 * lengths[1] or abs(outside - inside) <= 2.0 * near:
            return s
        newton = newton and abs(m) <= 0.25 * abs(before)
    return outside


@jit_fma_inline
def _pole_between(job: Job, s: float, ahead: float) -> float:
    """The end of the surface on an iso-curve between two parameters; NaN where there is none."""
    surface, cross = job[0][0], job[2]
    if cross[0] == SECTION:
        return nan
    knots, degree = (surface[0], surface[3]) if cross[0] == ALONG_U else (surface[1], surface[4])
    end = knots[degree] if ahead < s else knots[knots.shape[0] - degree - 1]
    return float(end) if min(s, ahead) < end < max(s, ahead) else nan


@jit
def march_exit(job: Job, lengths: Lengths, move: tuple[float, float], road: Road,
               memory: Memory) -> tuple[float, int]:
    """The first exit by steps along the cross curve.

    Parameters
    ----------
    job, lengths, road, memory
    move : (s0, stride)
        Parameter of the contact, and length of a step, mm, signed by the side.

    Returns
    -------
    s : float
        Of the exit, or where the polyline of the steps reaches the cap, or the pole at which an iso-curve ends and the
        normal turns over.
    steps : int
        How many it took.
    """
    setting, _, cross = job
    s0, stride = move
    state, point = memory[0], memory[2]
    lift_point(setting, cross, s0, lengths[0], memory)
    x, y, z = state[0, 0], state[0, 1], state[0, 2]
    a, b, c = state[2, 0], state[2, 1], state[2, 2]
    pace = sqrt(state[1, 0] ** 2 + state[1, 1] ** 2 + state[1, 2] ** 2)
    s = s0
    walked = 0.0
    steps = 0
    while pace > 1e-300:
        steps += 1
        ahead = s + stride / pace
        lift_point(setting, cross, ahead, lengths[0], memory)
        if a * state[2, 0] + b * state[2, 1] + c * state[2, 2] < 0.0:
            pole = _pole_between(job, s, ahead)
            if not isnan(pole):
                before = pole + _BEFORE * (s - pole)
                if swept_distance(job, lengths, before, road, memory)[0] < 0.0:
                    return pole, steps
                return _root(job, lengths, s, before, (road, memory)), steps
        a, b, c = state[2, 0], state[2, 1], state[2, 2]
        piece = sqrt((state[0, 0] - x) ** 2 + (state[0, 1] - y) ** 2 + (state[0, 2] - z) ** 2)
        pace = max(sqrt(state[1, 0] ** 2 + state[1, 1] ** 2 + state[1, 2] ** 2), 0.25 * pace)
        x, y, z = state[0, 0], state[0, 1], state[0, 2]
        least = scan_pass(setting, road[0], (road[2], road[3]), point, road[1])
        if least >= 0.0 and _deepest(job, lengths, road, memory)[0] >= 0.0:
            return _root(job, lengths, s, ahead, (road, memory)), steps
        walked += piece
        if piece <= 1e-3 * abs(stride):
            return ahead, steps
        if walked >= lengths[2]:
            return ahead - (ahead - s) * min(1.0, (walked - lengths[2]) / piece), steps
        s = ahead
    return s, steps
