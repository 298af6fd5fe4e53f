"""The exit on one side of a contact from tables of its two iso-curves, made exact by a last step on the surface."""

from math import inf, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curve_tables import SIDE, blend, interval, iso_state, road_tip
from toolaxis.contact.strip.newton import Second, disc_step, exit_step, side_step
from toolaxis.contact.strip.swept_cutter import Pair, gap_rates, signed_distance, tip_from
from toolaxis.numeric.bspline import SurfaceData
from toolaxis.numeric.jit import jit, jit_fma_inline

Array = NDArray[np.float64]
ARC, FLANK, DISC = 0, 1, 2

Tables: TypeAlias = tuple[Array, Array, Array, Array, Array]
"""Cutter, road, bank, and room for derivatives (6, 3) and basis (6, 26)."""
Rows: TypeAlias = tuple[int, int, int, int]
"""First and last row of road and bank."""
Contact: TypeAlias = tuple[float, int, float, float, float]
"""Sign of the normal, parameter along the pass (0 or 1), u, v, radius of the tool."""
Axis: TypeAlias = tuple[float, float, float]
Place: TypeAlias = tuple[float, float]


@jit_fma_inline
def _node_tip(cutter: Array, axis: Axis, road: Array, k: int) -> Pair:
    return tip_from(cutter, axis,
                    (road[k, 1], road[k, 2], road[k, 3], road[k, 4], road[k, 5], road[k, 6]),
                    (road[k, 7], road[k, 8], road[k, 9], road[k, 10], road[k, 11], road[k, 12]))


@jit_fma_inline
def _bend(cutter: Array, axis: Axis, road: Array, rows: Rows) -> Second:
    """Second derivative of the tip at the contact, from its rates at the neighbouring nodes."""
    low, high = max(SIDE - 1, rows[0]), min(SIDE + 1, rows[1])
    a, b = _node_tip(cutter, axis, road, low), _node_tip(cutter, axis, road, high)
    share = 1.0 / (road[high, 0] - road[low, 0])
    return (b[3] - a[3]) * share, (b[4] - a[4]) * share, (b[5] - a[5]) * share


@jit_fma_inline
def _length(pair: Pair) -> float:
    return sqrt(pair[3] * pair[3] + pair[4] * pair[4] + pair[5] * pair[5])


@jit_fma_inline
def _secant(second: Second, new: Pair, old: Pair, dw: float) -> Second:
    share = 1.0 / dw
    return (new[3] - old[3]) * share, (new[4] - old[4]) * share, (new[5] - old[5]) * share


@jit_fma_inline
def _gap(cutter: Array, axis: Axis, point: Pair, tip: Pair) -> float:
    return signed_distance(cutter, axis, point[0] - tip[0], point[1] - tip[1], point[2] - tip[2])


@jit
def rapid_exit(surface: SurfaceData, tables: Tables, axis: Axis, contact: Contact,
               guess: tuple[Place, Rows]) -> tuple[bool, float]:
    """The first exit, or False where it must be looked for with more care.

    Parameters
    ----------
    surface, tables, axis, contact
    guess : ((ds, dw), rows)
        The second-order exit relative to the contact, and the rows there are.

    Returns
    -------
    found : bool
    s : float
    """
    _, road, bank, _, _ = tables
    _, along, u, v, _ = contact
    rows = guess[1]
    s0, w0 = (v, u) if along == 0 else (u, v)
    found, s, w, point = _solve_on_tables(surface, tables, axis, contact, (guess[0], rows, ARC))
    if not found:
        found, s, w, point = _solve_on_tables(surface, tables, axis, contact, (guess[0], rows, FLANK))
    if not found and tables[0][0] > 0.0:
        found, s, w, point = _solve_on_tables(surface, tables, axis, contact, (guess[0], rows, DISC))
    if not (found and road[rows[0], 0] < w < road[rows[1], 0] and bank[rows[2], 0] <= s <= bank[rows[3], 0]):
        return False, s
    return _confirm_exit(tables, axis, point, (s0, w0, s, w), rows), s


@jit
def _solve_on_tables(surface: SurfaceData, tables: Tables, axis: Axis, contact: Contact,
                     guess: tuple[Place, Rows, int]) -> tuple[bool, float, float, Pair]:
    """Newton's method on the tables and then on the surface: whether it ended at an exit, s, w and the point there."""
    cutter, road, bank, d, basis = tables
    sign, along, u, v, radius = contact
    (s_step, w_step), rows, part = guess
    s0, w0 = (v, u) if along == 0 else (u, v)
    s, w = s0 + s_step, w0 + w_step
    second = _bend(cutter, axis, road, rows)
    k = m = SIDE
    w_old = w0
    old = point = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    exact = 0
    for step in range(14):
        if exact == 0:
            m, k = interval(bank, (rows[2], rows[3]), m, s), interval(road, (rows[0], rows[1]), k, w)
            point, tip = blend(bank, m, 1, s), road_tip(cutter, axis, road, k, w)
            if step > 0 and abs(w - w_old) * _length(tip) > 1e-3 * radius:
                second = _secant(second, tip, old, w - w_old)
            old, w_old = tip, w
        else:
            point = _lifted(iso_state(surface, (sign, 1 - along, w0, s), d, basis), bank[SIDE, 7])
            tip = _placed(iso_state(surface, (sign, along, s0, w), d, basis), cutter, axis)
        if part == ARC:
            ds, dw, leaving, valid = exit_step(cutter, axis, point, tip, second)
        elif part == FLANK:
            ds, dw, leaving, valid = side_step(cutter, axis, point, tip, second)
        else:
            ds, dw, leaving, valid = disc_step(cutter, axis, point, tip, second)
        far_s, far_w = abs(ds) * _length(point), abs(dw) * _length(tip)
        if not far_s + far_w < inf:
            return False, s, w, point
        if exact > 0 and far_s <= 1e-7 * radius and far_w <= 1e-6 * radius:
            return valid and leaving * s_step > 0.0, s + ds, w + dw, point
        if exact > 0 and (exact > 3 or far_s > 1e-2 * radius):
            return False, s, w, point
        share = max(abs(ds) / (0.6 * abs(s - s0)), 2.0 * far_w / radius, 1.0)
        s, w = s + ds / share, w + dw / share
        if exact > 0 or (far_s <= 1e-6 * radius and far_w <= 1e-5 * radius):
            exact += 1
    return False, s, w, point


@jit_fma_inline
def _lifted(state: tuple[float, float, float, float, float, float, float, float, float, float, float, float],
            lift: float) -> Pair:
    return (state[0] + lift * state[6], state[1] + lift * state[7], state[2] + lift * state[8],
            state[3] + lift * state[9], state[4] + lift * state[10], state[5] + lift * state[11])


@jit_fma_inline
def _placed(state: tuple[float, float, float, float, float, float, float, float, float, float, float, float],
            cutter: Array, axis: Axis) -> Pair:
    return tip_from(cutter, axis, _lifted(state, cutter[5]),
                    (state[6], state[7], state[8], state[9], state[10], state[11]))


@jit_fma_inline
def _confirm_exit(tables: Tables, axis: Axis, point: Pair, found: tuple[float, float, float, float],
                  rows: Rows) -> bool:
    """Whether points a third and two thirds of the way are covered, and the exit is not covered by another contact.

    From the exit's own contact outwards the cutter must come no nearer again, but where it is far off anyway.
    """
    cutter, road, bank, _, _ = tables
    s0, w0, s, w = found
    for part in range(1, 3):
        share = part / 3.0
        x, y = s0 + share * (s - s0), w0 + share * (w - w0)
        m, k = interval(bank, (rows[2], rows[3]), SIDE, x), interval(road, (rows[0], rows[1]), SIDE, y)
        if _gap(cutter, axis, blend(bank, m, 1, x), road_tip(cutter, axis, road, k, y)) >= 0.0:
            return False
    own = interval(road, (rows[0], rows[1]), SIDE, w)
    return (_recedes(tables, axis, point, (own, rows[0], -1)) and _recedes(tables, axis, point, (own + 1, rows[1], 1)))


@jit_fma_inline
def _recedes(tables: Tables, axis: Axis, point: Pair, walk: tuple[int, int, int]) -> bool:
    """Whether the cutter goes away from a point from node to node, unless it is far off.

    Where the normal passes by the axis the tip swings about the contact: there the walk goes in shorter steps.
    """
    cutter, road = tables[0], tables[1]
    radius = cutter[0] + cutter[1]
    start, end, side = walk
    last = 0.0
    before = _node_tip(cutter, axis, road, start)
    for k in range(start, end + side, side):
        after = _node_tip(cutter, axis, road, k)
        swing = 0.0
        if k != start:
            for c in range(3):
                swing += (after[c] - before[c] - road[k, 1 + c] + road[k - side, 1 + c]) ** 2
        parts = 1 if swing < 0.09 * radius * radius else 8
        for part in range(1, parts + 1):
            tip = after
            if part < parts:
                w = road[k - side, 0] + (road[k, 0] - road[k - side, 0]) * part / parts
                tip = road_tip(cutter, axis, road, min(k, k - side), w)
            gap, _, slope, _, _, _, _, _ = gap_rates(cutter, axis, point, tip)
            if gap < 0.5 * radius and (gap < last or side * slope < 0.0):
                return False
            last = gap
        before = after
    return True
