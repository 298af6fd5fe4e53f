"""The exit by Newton's method: F(s, w) = 0 and dF/dw = 0 for a point moving in s and a cutter moving in w.

The steps run on the tables of the two curves until they stand still, and the last ones on the curves themselves.  An
exit is taken only where it is the first one and not covered from elsewhere on the pass.
"""

from math import inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curve_tables import (
    MIDDLE,
    TabulatedCurve,
    find_interval,
    interpolate,
    tip_at_node,
    tip_between_nodes,
)
from toolaxis.contact.strip.curves import (
    Moving,
    OrientedSurface,
    Scratch,
    curve_point,
    offset_point,
    read_moving,
    store_moving,
)
from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.swept_cutter import (
    RelativeMotion,
    gap_rates,
    place_tip,
    relative_motion,
    signed_distance,
    touches,
)
from toolaxis.numeric.jit import jit_uncounted_inline
from toolaxis.numeric.triples import Triple, dot, plus

Array = NDArray[np.float64]

#: Parts of the cutter through which the exit may lie.
ARC, SIDE, BOTTOM = 0, 1, 2
#: Steps at most, and those of them on the curves themselves.
_STEPS, _EXACT = 14, 3
#: Where Newton's method goes over to the curves, and where it ends; in radii of the tool, for w ten times as much.
_TABLE_END, _END = 1e-6, 1e-7
#: The longest step on the curves, in radii of the tool: tables that are farther off are not trusted.
_FAR = 1e-2


class CutterSweep(NamedTuple):
    """What the exits at one contact depend on, the tool axis apart."""

    surface: OrientedSurface
    cutter: CutterParameters
    lift: float
    """Height of the cross curve's points above the surface: scallop height + allowance, mm."""
    feed: TabulatedCurve
    """The pass."""
    cross: TabulatedCurve


class NodeTips(NamedTuple):
    """Tips of one axis for the contacts at the nodes of the pass."""

    tip: Array
    """Rows of the tip and its rate."""
    swings: NDArray[np.bool_]
    """Whether the tip goes another way than the contact between a node and the next one."""


class ExitStep(NamedTuple):
    """Newton's step."""

    ds: float
    dw: float
    leaving: float
    """dF/ds."""
    valid: bool
    """Whether F has a minimum in w there, on the part of the cutter that was meant."""


class Exit(NamedTuple):
    """An exit, at s of the cross curve and w of the pass."""

    found: bool
    s: float
    w: float
    point: Moving


def new_node_tips() -> NodeTips:
    """Memory for the tips of one axis."""
    rows = 2 * MIDDLE + 1
    return NodeTips(np.empty((rows, 6)), np.empty(rows, dtype=np.bool_))


@jit_uncounted_inline
def place_node_tips(sweep: CutterSweep, axis: Triple, tips: NodeTips) -> None:
    """Place the tips of an axis, which serve the exits on both sides."""
    cutter, nodes = sweep.cutter, sweep.feed.nodes
    radius, before = cutter.flat + cutter.corner, (0.0, 0.0, 0.0)
    for k in range(sweep.feed.first, sweep.feed.last + 1):
        after = tip_at_node(cutter, axis, nodes, k)
        store_moving(tips.tip, k, after)
        if k > sweep.feed.first:
            centre = plus(read_moving(nodes.offset, k).point, read_moving(nodes.offset, k - 1).point, -1.0)
            swing = plus(plus(after.point, before, -1.0), centre, -1.0)
            tips.swings[k - 1] = not dot(swing, swing) < 0.09 * radius * radius
        before = after.point


@jit_uncounted_inline
def _ball_step(cutter: CutterParameters, axis: Triple, point: Moving, tip: Moving, second: Triple) -> ExitStep:
    """The step from the distance and its derivatives, which have no singular place on a ball."""
    f = gap_rates(cutter, axis, point, tip)
    bend = f.by_ww - dot(f.gradient, second)
    det = f.by_s * bend - f.by_w * f.by_sw
    return ExitStep((f.by_w * f.by_w - f.gap * bend) / det, (f.gap * f.by_sw - f.by_s * f.by_w) / det, f.by_s,
                    bend > 0.0)


@jit_uncounted_inline
def _arc_step(cutter: CutterParameters, r: RelativeMotion, second_out: float, second_up: float) -> ExitStep:
    """The step for a point of the corner arc whose normal is perpendicular to the tip's path.

    With N = (sin theta, -cos theta) its normal in the meridian, tan theta = (T . tip') / (e_rho . tip'), both
    rho - a - r sin theta and z - r + r cos theta vanish.  This holds for a sharp corner too, r = 0, where the distance
    itself has no derivative.
    """
    corner, over = cutter.corner, r.inverse
    square = r.tip_out * r.tip_out + r.tip_up * r.tip_up
    share = 1.0 / square
    turn = sqrt(share) if r.tip_out >= 0.0 else -sqrt(share)
    n_rho, n_z = r.tip_up * turn, -r.tip_out * turn
    theta_s = -r.tip_up * r.both_around * over * share
    theta_w = (r.tip_out * second_up - r.tip_up * (second_out - r.tip_around * over)) * share
    e1, e2 = r.rho - cutter.flat - corner * n_rho, r.z - corner - corner * n_z
    e1s, e1w = r.point_out + corner * n_z * theta_s, -r.tip_out + corner * n_z * theta_w
    e2s, e2w = r.point_up - corner * n_rho * theta_s, -r.tip_up - corner * n_rho * theta_w
    det = 1.0 / (e1s * e2w - e1w * e2s)
    minimum = square + corner * (n_rho * over * r.tip_around - n_rho * second_out - n_z * second_up) > 0.0
    on_arc = n_rho >= 0.0 and n_z * cutter.cos + n_rho * cutter.sin <= 0.0
    return ExitStep((e1w * e2 - e2w * e1) * det, (e2s * e1 - e1s * e2) * det,
                    n_rho * r.point_out + n_z * r.point_up, minimum and on_arc)


@jit_uncounted_inline
def _side_step(cutter: CutterParameters, r: RelativeMotion, second_out: float, second_up: float) -> ExitStep:
    """The step for an exit through the side line above the arc, as on the near side of a sideways lean."""
    x, y = r.rho - cutter.flat, r.z - cutter.corner
    ring = cutter.cos * r.inverse
    f = x * cutter.cos - y * cutter.sin - cutter.corner
    f_s, f_w = cutter.cos * r.point_out - cutter.sin * r.point_up, cutter.sin * r.tip_up - cutter.cos * r.tip_out
    f_ww = ring * r.tip_around - cutter.cos * second_out + cutter.sin * second_up
    f_ws = -ring * r.both_around
    det = 1.0 / (f_s * f_ww - f_w * f_ws)
    on_side = y * cutter.cos + x * cutter.sin >= 0.0 and r.z <= cutter.top
    return ExitStep((f_w * f_w - f * f_ww) * det, (f * f_ws - f_s * f_w) * det, f_s, f_ww > 0.0 and on_side)


@jit_uncounted_inline
def _bottom_step(cutter: CutterParameters, r: RelativeMotion, second_up: float) -> ExitStep:
    """The step for an exit through the flat bottom, where the tip moves square to the axis.

    So it is on the far side of a sideways lean: both z and T . tip' vanish.
    """
    dw = -r.tip_up / second_up
    return ExitStep((r.tip_up * dw - r.z) / r.point_up, dw, -r.point_up, second_up > 0.0 and r.rho <= cutter.flat)


@jit_uncounted_inline
def _exit_step(cutter: CutterParameters, axis: Triple, motion: tuple[Moving, Moving], second: Triple,
               part: int) -> ExitStep:
    """Newton's step for point and tip; `second` is the second derivative of the tip along the pass."""
    point, tip = motion
    if part == ARC and cutter.flat <= 0.0:
        return _ball_step(cutter, axis, point, tip, second)
    relative = relative_motion(axis, point, tip)
    out, up = dot(relative.outwards, second), dot(axis, second)
    if part == ARC:
        return _arc_step(cutter, relative, out, up)
    if part == SIDE:
        return _side_step(cutter, relative, out, up)
    return _bottom_step(cutter, relative, up)


@jit_uncounted_inline
def _secant(new: Triple, old: Triple, dw: float) -> Triple:
    share = 1.0 / dw
    return (new[0] - old[0]) * share, (new[1] - old[1]) * share, (new[2] - old[2]) * share


@jit_uncounted_inline
def solve_exit(sweep: CutterSweep, axis: Triple, guess: tuple[float, float], part: int, tips: NodeTips,
               scratch: Scratch) -> Exit:
    """Newton's method from (s, w) for an exit through one part of the cutter.

    Not found where it does not converge, leaves the tables, or finds a place where the surface enters the cutter.
    """
    cutter, feed, cross = sweep.cutter, sweep.feed, sweep.cross
    nodes, radius = feed.nodes, cutter.flat + cutter.corner
    low, high = max(MIDDLE - 1, feed.first), min(MIDDLE + 1, feed.last)
    second = _secant(read_moving(tips.tip, high).rate, read_moving(tips.tip, low).rate, nodes.w[high] - nodes.w[low])
    (s, w), w_old, k, m, exact = guess, 0.0, MIDDLE, MIDDLE, 0
    point = tip = Moving((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    for step in range(_STEPS):
        if exact == 0:
            old = tip
            m, k = find_interval(cross, m, s), find_interval(feed, k, w)
            point = interpolate(cross.nodes.w, cross.nodes.offset, m, s)
            tip = tip_between_nodes(cutter, axis, nodes, k, w)
            if step > 0 and abs(w - w_old) * sqrt(dot(tip.rate, tip.rate)) > 1e-3 * radius:
                second = _secant(tip.rate, old.rate, w - w_old)
            w_old = w
        else:
            point = offset_point(curve_point(sweep.surface, cross.curve, s, scratch), sweep.lift)
            at = curve_point(sweep.surface, feed.curve, w, scratch)
            tip = place_tip(cutter, axis, offset_point(at, cutter.offset), Moving(at.normal, at.turn))
        move = _exit_step(cutter, axis, (point, tip), second, part)
        far_s = abs(move.ds) * sqrt(dot(point.rate, point.rate))
        far_w = abs(move.dw) * sqrt(dot(tip.rate, tip.rate))
        if not far_s + far_w < inf:
            break
        if exact > 0 and far_s <= _END * radius and far_w <= 10.0 * _END * radius:
            s, w = s + move.ds, w + move.dw
            inside = nodes.w[feed.first] < w < nodes.w[feed.last]
            inside = inside and cross.nodes.w[cross.first] <= s <= cross.nodes.w[cross.last]
            inside = inside and touches(cutter, axis, at.normal)
            return Exit(move.valid and move.leaving * guess[0] > 0.0 and inside, s, w, point)
        if exact > 0 and (exact > _EXACT or far_s > _FAR * radius):
            break
        share = max(abs(move.ds) / (0.6 * abs(s)), 2.0 * far_w / radius, 1.0)
        s, w = s + move.ds / share, w + move.dw / share
        if exact > 0 or (far_s <= _TABLE_END * radius and far_w <= 10.0 * _TABLE_END * radius):
            exact += 1
    return Exit(False, s, w, point)


@jit_uncounted_inline
def is_first_exit(sweep: CutterSweep, axis: Triple, exit: Exit, tips: NodeTips) -> bool:
    """Whether points a third and two thirds of the way are covered, and the exit is not covered by another contact.

    From the exit's own contact outwards the cutter must come no nearer again, but where it is far off anyway.
    """
    cutter, feed, cross = sweep.cutter, sweep.feed, sweep.cross
    for third in range(1, 3):
        s, w = exit.s * third / 3.0, exit.w * third / 3.0
        point = interpolate(cross.nodes.w, cross.nodes.offset, find_interval(cross, MIDDLE, s), s).point
        tip = tip_between_nodes(cutter, axis, feed.nodes, find_interval(feed, MIDDLE, w), w).point
        if signed_distance(cutter, axis, plus(point, tip, -1.0)) >= 0.0:
            return False
    k = find_interval(feed, MIDDLE, exit.w)
    for side in range(2):
        start, end, step = (k, feed.first, -1) if side == 0 else (k + 1, feed.last, 1)
        if not _recedes(sweep, axis, exit.point, tips, (start, end, step)):
            return False
    return True


@jit_uncounted_inline
def _recedes(sweep: CutterSweep, axis: Triple, point: Moving, tips: NodeTips, walk: tuple[int, int, int]) -> bool:
    """Whether the cutter goes away from a point from node to node, unless it is far off.

    The walk ends where the cutter touches the surface no more.
    Where the normal passes by the axis the tip swings about the contact: there the walk goes in shorter steps.
    """
    cutter, nodes = sweep.cutter, sweep.feed.nodes
    radius = cutter.flat + cutter.corner
    start, end, side = walk
    last = 0.0
    for k in range(start, end + side, side):
        if not touches(cutter, axis, read_moving(nodes.normal, k).point):
            return True
        near = min(k, k - side)
        parts = 8 if k != start and tips.swings[near] else 1
        for part in range(1, parts + 1):
            tip = read_moving(tips.tip, k)
            if part < parts:
                w = nodes.w[k - side] + (nodes.w[k] - nodes.w[k - side]) * part / parts
                tip = tip_between_nodes(cutter, axis, nodes, near, w)
            gap = signed_distance(cutter, axis, plus(point.point, tip.point, -1.0))
            if gap < 0.5 * radius and (gap < last or side * gap_rates(cutter, axis, point, tip).by_w < 0.0):
                return False
            last = gap
    return True
