"""Where a cutter that comes down along +z first touches triangles: the kernel that visits a tree of them, best first.

The underside of the cutter is a convex function h of the distance from its axis, so z - h is concave over a triangle:
it is greatest where the whole plane touches the cutter, or else on an edge that this place is seen from.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit

Array = NDArray[np.float64]
Counts = NDArray[np.int64]
Cutter: TypeAlias = tuple[float, float, float, float, float]
"""Radius of the flat bottom, corner radius, sine and cosine of the side's inclination, greatest radius."""
Tree: TypeAlias = tuple[Array, Array, Counts]
"""Rows of triangles, boxes of nodes (x, x, y, y, highest z), and where the levels of nodes begin, leaves first."""

FAN = 4
"""Triangles of a leaf, and children of a node."""
EDGES_ONLY, PLAIN, NARROW = 0.0, 1.0, 2.0
"""What a row says of its facet: no area from above, a sure plane, or one that rounding turns; negative if clockwise."""
STEEP, THIN = 1e4, 1e-6
"""Slope above which a facet counts as steep, and area over its longest side's square below which it counts as thin."""
MISS = 1e-9
"""Rounding has turned a plane that misses its own corners by more, mm; if it is thin as well, rounding made it."""
_TURNS = 60
_CLOSE = 1e-14
_SHIFT, _LEVEL = 6, 63


@jit
def underside(cutter: Cutter, rho: float) -> float:
    """Height of the cutter's underside above its tip at a distance from its axis, mm."""
    flat, corner, sine, cosine, _ = cutter
    t = rho - flat
    if t <= 0.0:
        return 0.0
    if t < corner * cosine:
        return float(t * t / (corner + np.sqrt(corner * corner - t * t)))
    if sine == 0.0:
        return corner
    return corner * (1.0 - sine) + (t - corner * cosine) * cosine / sine


@jit
def _arc_rest(cutter: Cutter, line: tuple[float, float], low: float, high: float) -> float:
    """As `edge_rest` on the corner arc, beyond the flat bottom and for a line that rises.

    With s the sine of the normal's angle from the axis, rho = flat + corner s, and s = k / sqrt(1 + k^2 - (m / rho)^2):
    the right side falls as rho grows, so s minus it has a slope of at least one.
    """
    flat, corner, _, cosine, _ = cutter
    m, k = line
    if flat == 0.0:
        return float(min(max(low, k * np.sqrt((corner * corner - m * m) / (1.0 + k * k))), high))
    last = min((np.sqrt(m * m + high * high) - flat) / corner, cosine)
    first = min(max((np.sqrt(m * m + low * low) - flat) / corner, 0.0), last)
    s = first
    near = m / (flat + corner * last)
    rate = 1.0 + k * k - near * near
    if rate > 0.0:
        s = min(max(s, k / np.sqrt(rate)), last)
    for _ in range(_TURNS):
        rho = flat + corner * s
        near = m / rho
        rate = 1.0 + k * k - near * near
        wanted = k / np.sqrt(rate)
        if s < wanted:
            first = s
        else:
            last = s
        step = (wanted - s) / (1.0 + corner * wanted * near * near / (rho * rate))
        trial = s + step
        if not first <= trial <= last:
            trial = 0.5 * (first + last)
        step, s = trial - s, trial
        if abs(step) < _CLOSE:
            break
    rho = flat + corner * s
    return float(min(max(low, np.sqrt(max(rho * rho - m * m, 0.0))), high))


@jit
def edge_rest(cutter: Cutter, line: tuple[float, float], low: float, high: float) -> float:
    """Where on a straight line the cutter rests: u in [low, high] at which k u - h(sqrt(m^2 + u^2)) is greatest.

    line = (m, k): distance of the line from the axis, seen from above, and its slope, not negative.
    """
    flat, corner, sine, cosine, _ = cutter
    m, k = line
    if k == 0.0 or high <= 0.0:
        return min(max(0.0, low), high)
    level = np.sqrt(flat * flat - m * m) if m < flat else 0.0
    if high <= level:
        return high
    low = max(low, level)
    end = flat + corner * cosine
    if m < end and k * sine * end <= cosine * np.sqrt(end * end - m * m):
        return low if corner == 0.0 else _arc_rest(cutter, line, low, high)
    if k * sine >= cosine:
        return high
    return float(min(max(low, k * sine * m / np.sqrt(cosine * cosine - k * k * sine * sine)), high))


@jit
def _edge(cutter: Cutter, a: tuple[float, float, float], b: tuple[float, float, float], best: float) -> float:
    """Height of the tip resting on the edge between two points relative to the axis, or best where that is higher."""
    if a[2] > b[2]:
        a, b = b, a
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    length = np.sqrt(dx * dx + dy * dy)
    if length <= 1e-14 * dz or length == 0.0:
        rho = min(np.sqrt(a[0] * a[0] + a[1] * a[1]), np.sqrt(b[0] * b[0] + b[1] * b[1]))
        return max(best, b[2] - underside(cutter, rho)) if rho <= cutter[4] else best
    m = abs(a[0] * dy - a[1] * dx) / length
    if m > cutter[4]:
        return best
    start, reach = (a[0] * dx + a[1] * dy) / length, np.sqrt(cutter[4] * cutter[4] - m * m)
    low, high = max(start, -reach), min(start + length, reach)
    if low > high:
        return best
    nearest = min(max(0.0, low), high)
    if b[2] - underside(cutter, np.sqrt(m * m + nearest * nearest)) <= best:
        return best
    u = edge_rest(cutter, (m, dz / length), low, high)
    z = min(a[2] + dz * ((u - start) / length), b[2])
    return max(best, float(z - underside(cutter, np.sqrt(m * m + u * u))))


@jit
def _triangle(cutter: Cutter, row: Array, x: float, y: float, best: float) -> float:
    """Height of the tip at (x, y) resting on one triangle, or best where that is higher."""
    kind = row[14]
    qx, qy = x + row[11], y + row[12]
    tip = row[2] + row[9] * (qx - row[0]) + row[10] * (qy - row[1]) - row[13]
    plain = abs(kind) == PLAIN
    if row[15] <= best or (plain and tip <= best):
        return best
    turn, inside = np.sign(kind), kind != EDGES_ONLY
    for i in range(3):
        j = 3 * i
        k = 3 * ((i + 1) % 3)
        across = (row[k] - row[j]) * (qy - row[j + 1]) - (row[k + 1] - row[j + 1]) * (qx - row[j])
        seen = across * turn < 0.0
        inside = inside and not seen
        if seen or not plain:
            best = _edge(cutter, (row[j] - x, row[j + 1] - y, row[j + 2]), (row[k] - x, row[k + 1] - y, row[k + 2]),
                         best)
    return float(max(best, min(tip, row[15] - row[13]))) if inside else best


@jit
def _bound(cutter: Cutter, box: Array, x: float, y: float) -> float:
    """No tip at (x, y) that rests on what is in the box is higher than this."""
    dx, dy = max(box[0] - x, x - box[1], 0.0), max(box[2] - y, y - box[3], 0.0)
    square = dx * dx + dy * dy
    if square > cutter[4] * cutter[4]:
        return -np.inf
    return float(box[4] - underside(cutter, np.sqrt(square)))


@jit
def _one(cutter: Cutter, tree: Tree, x: float, y: float, stack: tuple[Array, Counts]) -> float:
    """Height of the tip at (x, y); the stack holds bounds and numbers of nodes to visit, the highest last."""
    rows, boxes, levels = tree
    bounds, nodes = stack
    best: float = -np.inf
    depth = 1
    bounds[0], nodes[0] = np.inf, len(levels) - 2
    while depth > 0:
        depth -= 1
        if bounds[depth] <= best:
            continue
        level, first = nodes[depth] & _LEVEL, FAN * (nodes[depth] >> _SHIFT)
        if level == 0:
            for i in range(first, min(first + FAN, len(rows))):
                best = _triangle(cutter, rows[i], x, y, best)
            continue
        base, ground = levels[level - 1], depth
        for child in range(first, min(first + FAN, levels[level] - base)):
            bound = _bound(cutter, boxes[base + child], x, y)
            if bound <= best:
                continue
            place = depth
            while place > ground and bounds[place - 1] > bound:
                bounds[place], nodes[place] = bounds[place - 1], nodes[place - 1]
                place -= 1
            bounds[place], nodes[place] = bound, child << _SHIFT | level - 1
            depth += 1
    return best


@jit
def drop_many(cutter: Cutter, tree: Tree, xy: Array, out: Array) -> None:
    """Heights of the tip at points (k, 2) into out (k,), -inf where nothing is below or above the cutter."""
    room = FAN * len(tree[2])
    stack = (np.empty(room), np.empty(room, dtype=np.int64))
    for i in range(len(xy)):
        out[i] = _one(cutter, tree, xy[i, 0], xy[i, 1], stack)
