"""Where the lifted surface first leaves the swept cutter: the exact half width at one contact.

F(s, w) is the signed distance from the lifted point q(s) of the cross curve to the cutter at w of the pass, and
m(s) = min over w of F its distance to the swept cutter.  The exit solves F = 0 and dF/dw = 0 by Newton's method from
the second-order solution; it is then checked to be the first one and not covered from elsewhere, and where Newton or
a check fails, a march along the cross curve with the global minimum over w finds it instead.
"""

from math import inf, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.curves import Curve, Scratch
from toolaxis.contact.swept import Setting, gap_rates, lifted_point, pass_tip, scan_pass, signed_distance
from toolaxis.numeric.compiled import compiled

Array = NDArray[np.float64]
Job: TypeAlias = tuple[Setting, Curve, Curve]
"""Setting, pass, cross curve."""
Memory: TypeAlias = tuple[Array, Array, Array, Scratch]
Road: TypeAlias = tuple[Array, Array, int, int]
"""Nodes of the pass, room for their distances, first and last row."""
Lengths: TypeAlias = tuple[float, float, float, float]
"""Lift h + A, radius R, cap of a half width, spacing of the nodes; mm."""


@compiled
def newton_exit(job: Job, lengths: Lengths, start: tuple[float, float, float, float], second: Array,
                memory: Memory) -> tuple[bool, float, float]:
    """Solve F = 0, dF/dw = 0.

    Parameters
    ----------
    job, lengths, memory
    start : (s0, w0, s, w)
        Contact and first guess.
    second : (3,) array
        Estimate of the second derivative of the tip along the pass; improved on the way.

    Returns
    -------
    solved, s, w
    """
    setting, road, cross = job
    lift, radius, _, _ = lengths
    s0, w0, s, w = start
    tip, point = memory[1], memory[2]
    w_old = w0
    o0 = o1 = o2 = 0.0
    for step in range(14):
        lifted_point(setting, cross, s, lift, memory)
        pass_tip(setting, road, w, memory)
        travel = sqrt(tip[1, 0] ** 2 + tip[1, 1] ** 2 + tip[1, 2] ** 2)
        if step > 0 and abs(w - w_old) * travel > 1e-6 * radius:
            second[0] = (tip[1, 0] - o0) / (w - w_old)
            second[1] = (tip[1, 1] - o1) / (w - w_old)
            second[2] = (tip[1, 2] - o2) / (w - w_old)
        w_old, o0, o1, o2 = w, tip[1, 0], tip[1, 1], tip[1, 2]
        f, f_s, f_w, f_ww, f_ws, g0, g1, g2 = gap_rates(setting[2], setting[3], point, tip)
        f_ww -= g0 * second[0] + g1 * second[1] + g2 * second[2]
        det = f_s * f_ww - f_w * f_ws
        if not (f_ww > 0.0 and f_s * (s - s0) > 0.0 and det * (s - s0) > 0.0):
            return False, s, w
        ds = (f_w * f_w - f * f_ww) / det
        dw = (f * f_ws - f_s * f_w) / det
        pace = sqrt(point[1, 0] ** 2 + point[1, 1] ** 2 + point[1, 2] ** 2)
        if abs(ds) * pace <= 1e-9 * radius and abs(dw) * travel <= 1e-6 * radius:
            return True, s + ds, w + dw
        share = max(abs(ds) / (0.5 * abs(s - s0)), abs(dw) * travel / (0.5 * radius), 1.0)
        s += ds / share
        w += dw / share
    return False, s, w


@compiled
def least_between(job: Job, point: Array, ends: tuple[int, int], road: Road,
                  memory: Memory) -> tuple[float, float, float]:
    """The least distance of a point to the cutter between two nodes of the pass.

    The distance is (all but) convex in w there: two tangents bound it from below, and the search, by secants of the
    slope and by intersections of the tangents in turn, ends when the bound is met.

    Returns
    -------
    F, w, F_s
    """
    setting, way, _ = job
    table = road[0]
    tip = memory[1]
    lo, hi = table[ends[0], 0], table[ends[1], 0]
    tip[0], tip[1] = table[ends[0], 1:4], table[ends[0], 4:7]
    f_lo, s_lo, d_lo, _, _, _, _, _ = gap_rates(setting[2], setting[3], point, tip)
    tip[0], tip[1] = table[ends[1], 1:4], table[ends[1], 4:7]
    f_hi, s_hi, d_hi, _, _, _, _, _ = gap_rates(setting[2], setting[3], point, tip)
    best, place, slope = (f_lo, lo, s_lo) if f_lo <= f_hi else (f_hi, hi, s_hi)
    weak_lo, weak_hi = d_lo, d_hi
    for step in range(80):
        if not (d_lo < 0.0 < d_hi):
            break
        meet = (f_hi - f_lo + d_lo * lo - d_hi * hi) / (d_lo - d_hi)
        if best - (f_lo + d_lo * (meet - lo)) <= 1e-12 * setting[2][4]:
            break
        w = meet
        if step % 2 == 0:
            w = lo - weak_lo * (hi - lo) / (weak_hi - weak_lo)
        if step % 5 == 4 or not lo < w < hi:
            w = 0.5 * (lo + hi)
        if not lo < w < hi:
            break
        pass_tip(setting, way, w, memory)
        f, f_s, d, _, _, _, _, _ = gap_rates(setting[2], setting[3], point, tip)
        if f < best:
            best, place, slope = f, w, f_s
        if d < 0.0:
            lo, f_lo, d_lo, weak_lo, weak_hi = w, f, d, d, 0.5 * weak_hi
        else:
            hi, f_hi, d_hi, weak_hi, weak_lo = w, f, d, d, 0.5 * weak_lo
    return best, place, slope


@compiled
def _deepest(job: Job, lengths: Lengths, road: Road, memory: Memory) -> tuple[float, float, float]:
    """The least distance of memory[2] to the swept cutter, from the distances of the nodes; F, w, F_s.

    Each valley of the nodes that could hold the least value is looked into.
    """
    table, gaps, first, last = road
    best, place, slope = inf, table[first, 0], 0.0
    bound = inf
    for k in range(first, last + 1):
        bound = min(bound, gaps[k])
    for k in range(first, last + 1):
        left, right = max(k - 1, first), min(k + 1, last)
        if gaps[k] > gaps[left] or gaps[k] > gaps[right] or gaps[k] - lengths[3] > min(best, bound):
            continue
        f, w, f_s = least_between(job, memory[2], (left, right), road, memory)
        if f < best:
            best, place, slope = f, w, f_s
    return best, place, slope


@compiled
def swept_distance(job: Job, lengths: Lengths, s: float, road: Road, memory: Memory) -> tuple[float, float, float]:
    """m(s), the w at which it is taken, and dm/ds."""
    lifted_point(job[0], job[2], s, lengths[0], memory)
    scan_pass(job[0], road[0], (road[2], road[3]), memory[2], road[1])
    return _deepest(job, lengths, road, memory)


@compiled
def confirmed(job: Job, lengths: Lengths, found: tuple[float, float, float, float], road: Road,
               memory: Memory) -> bool:
    """Whether an exit is the first one, and not covered from elsewhere on the pass; found = (s0, w0, s, w)."""
    s0, w0, s, w = found
    setting, way, cross = job
    tip, point = memory[1], memory[2]
    for k in range(1, 4):
        share = 0.25 * k
        lifted_point(setting, cross, s0 + share * (s - s0), lengths[0], memory)
        pass_tip(setting, way, w0 + share * (w - w0), memory)
        if signed_distance(setting[2], setting[3], point[0, 0] - tip[0, 0], point[0, 1] - tip[0, 1],
                           point[0, 2] - tip[0, 2]) >= 0.0:
            return False
    lifted_point(setting, cross, s, lengths[0], memory)
    scan_pass(setting, road[0], (road[2], road[3]), point, road[1])
    table, gaps, first, last = road
    for k in range(first, last + 1):
        left, right = max(k - 1, first), min(k + 1, last)
        if gaps[k] > lengths[3] or gaps[k] > gaps[left] or gaps[k] > gaps[right]:
            continue
        if table[left, 0] <= w <= table[right, 0]:
            continue
        if least_between(job, point, (left, right), road, memory)[0] < -1e-9 * lengths[1]:
            return False
    return bool(table[first, 0] <= w <= table[last, 0])


@compiled
def _root(job: Job, lengths: Lengths, inside: float, outside: float,
          bench: tuple[Road, Memory]) -> float:
    """The zero of m between a covered and an uncovered s."""
    road, memory = bench
    s = outside
    width = abs(outside - inside)
    for _ in range(80):
        m, _, slope = swept_distance(job, lengths, s, road, memory)
        point = memory[2]
        pace = sqrt(point[1, 0] ** 2 + point[1, 1] ** 2 + point[1, 2] ** 2)
        if m < 0.0:
            inside = s
        else:
            outside = s
        if abs(m) <= 1e-13 * lengths[1] or abs(outside - inside) * pace <= 1e-11 * lengths[1]:
            return s
        step = -m / slope if slope != 0.0 else inf
        ahead = s + step
        now = abs(outside - inside)
        if not min(inside, outside) < ahead < max(inside, outside) or (now > 0.7 * width and abs(step) > 0.5 * now):
            ahead = 0.5 * (inside + outside)
        width = now
        if abs(step) * pace <= 1e-11 * lengths[1]:
            return ahead
        s = ahead
    return s


@compiled
def march_exit(job: Job, lengths: Lengths, move: tuple[float, float], road: Road, memory: Memory) -> float:
    """The first exit by steps along the cross curve.

    Parameters
    ----------
    job, lengths, road, memory
    move : (s0, stride)
        Parameter of the contact, and length of a step, mm, signed by the side.

    Returns
    -------
    float
        s of the exit, or where the polyline of the steps reaches the cap.
    """
    setting, _, cross = job
    s0, stride = move
    state, point = memory[0], memory[2]
    lifted_point(setting, cross, s0, lengths[0], memory)
    x, y, z = state[0, 0], state[0, 1], state[0, 2]
    pace = sqrt(state[1, 0] ** 2 + state[1, 1] ** 2 + state[1, 2] ** 2)
    s = s0
    walked = 0.0
    while pace > 1e-300:
        ahead = s + stride / pace
        lifted_point(setting, cross, ahead, lengths[0], memory)
        piece = sqrt((state[0, 0] - x) ** 2 + (state[0, 1] - y) ** 2 + (state[0, 2] - z) ** 2)
        pace = max(sqrt(state[1, 0] ** 2 + state[1, 1] ** 2 + state[1, 2] ** 2), 0.25 * pace)
        x, y, z = state[0, 0], state[0, 1], state[0, 2]
        nearest = scan_pass(setting, road[0], (road[2], road[3]), point, road[1])
        if road[1][nearest] >= 0.0 and _deepest(job, lengths, road, memory)[0] >= 0.0:
            return _root(job, lengths, s, ahead, (road, memory))
        walked += piece
        if piece <= 1e-3 * abs(stride):
            return ahead
        if walked >= lengths[2]:
            return ahead - (ahead - s) * min(1.0, (walked - lengths[2]) / piece)
        s = ahead
    return s
