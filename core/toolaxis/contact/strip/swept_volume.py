"""What a cutter removes along a path: signed distance of points to everything that it sweeps."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters, parameters_of_tool
from toolaxis.contact.strip.swept_cutter import signed_distance
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.numeric.shares import work_on_rows
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.tools.solid import piece_distance_numpy, solid_pieces
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: The least distance along a straight motion is found to this, mm.
RESOLUTION = 1e-6
_HALVINGS = 60
_ROWS = 64
#: Motions, groups of these, and points that follow each other are looked at together.
_GROUP, _GROUPS, _TOGETHER = 16, 16, 24
#: Points of a share: a multiple of those that are looked at together.
_AT_ONCE = 480
#: What rounding may take off the distance to a group of groups, mm.
_ROUNDING = 1e-9


@jit
def _least_of(cutter: CutterParameters, move: Array, point: Array, best: float) -> float:
    """The least of a bound and the distance of a point to the cutter on one motion.

    Along a motion the distance is convex: beyond the middle it stays above the line from the other end to the middle.
    """
    up, half = (0.0, 0.0, 1.0), move[6]
    x, y, z = point[0] - move[0], point[1] - move[1], point[2] - move[2]
    value = float(signed_distance(cutter, up, (x, y, z)))
    if value - half >= best:
        return best
    before = float(signed_distance(cutter, up, (x + move[3], y + move[4], z + move[5])))
    after = float(signed_distance(cutter, up, (x - move[3], y - move[4], z - move[5])))
    best = min(best, value, before, after)
    if 2.0 * value - max(before, after, value) >= best:
        return best
    low, high = -1.0, 1.0
    for _ in range(_HALVINGS):
        if (high - low) * half < RESOLUTION:
            break
        s, t = low + (high - low) / 3.0, high - (high - low) / 3.0
        one = float(signed_distance(cutter, up, (x - s * move[3], y - s * move[4], z - s * move[5])))
        other = float(signed_distance(cutter, up, (x - t * move[3], y - t * move[4], z - t * move[5])))
        best = min(best, one, other)
        if min(one, other) - (high - low) * half >= best:
            break
        if one < other:
            high = t
        else:
            low = s
    return best


@jit
def _near(cutter: CutterParameters, wide: Array, balls: Array, moves: Array, ball: Array, most: float,
          groups: NDArray[np.int64], near: NDArray[np.int64]) -> int:
    """Motions that may come nearer than a distance to a point of a ball, by group; the number of groups with any.

    Row k of `groups` is a group, and where its motions end in `near`.  Of a long path most is far away: that is told
    from groups of groups.
    """
    up, some, count = (0.0, 0.0, 1.0), 0, 0
    for w in range(wide.shape[0]):
        x, y, z = ball[0] - wide[w, 0], ball[1] - wide[w, 1], ball[2] - wide[w, 2]
        if signed_distance(cutter, up, (x, y, z)) - wide[w, 3] - ball[3] >= most + _ROUNDING:
            continue
        for g in range(_GROUPS * w, min(_GROUPS * (w + 1), balls.shape[0])):
            x, y, z = ball[0] - balls[g, 0], ball[1] - balls[g, 1], ball[2] - balls[g, 2]
            if signed_distance(cutter, up, (x, y, z)) - balls[g, 3] - ball[3] >= most:
                continue
            before = count
            for k in range(_GROUP * g, min(_GROUP * (g + 1), moves.shape[0])):
                x, y, z = ball[0] - moves[k, 0], ball[1] - moves[k, 1], ball[2] - moves[k, 2]
                if signed_distance(cutter, up, (x, y, z)) - moves[k, 6] - ball[3] < most:
                    near[count] = k
                    count += 1
            if count > before:
                groups[some, 0], groups[some, 1] = g, count
                some += 1
    return some


@jit
def _least(cutter: CutterParameters, wide: Array, balls: Array, moves: Array, points: Array,
           told: tuple[float, float], out: Array) -> None:
    """Points and moves (middle, half way, half length) in the frame whose z is the axis.

    Points that follow each other are looked at together, and first at the motion that was the nearest for the last one.
    Distances are told between told[0], from which on nothing less is looked for, and told[1].
    """
    up = (0.0, 0.0, 1.0)
    groups, near = np.empty((balls.shape[0], 2), dtype=np.int64), np.empty(moves.shape[0], dtype=np.int64)
    ball, last = np.empty(4), 0
    for start in range(0, points.shape[0], _TOGETHER):
        end = min(start + _TOGETHER, points.shape[0])
        _around(points, start, end, ball)
        some = _near(cutter, wide, balls, moves, ball, told[1], groups, near)
        for i in range(start, end):
            best = told[1]
            if some > 0:
                best = _least_of(cutter, moves[last], points[i], best)
            for n in range(some):
                if best <= told[0]:
                    break
                g = groups[n, 0]
                x, y, z = points[i, 0] - balls[g, 0], points[i, 1] - balls[g, 1], points[i, 2] - balls[g, 2]
                if signed_distance(cutter, up, (x, y, z)) - balls[g, 3] >= best:
                    continue
                for m in range(groups[n - 1, 1] if n > 0 else 0, groups[n, 1]):
                    value = _least_of(cutter, moves[near[m]], points[i], best)
                    if value < best:
                        best, last = value, near[m]
                        if best <= told[0]:
                            break
            out[i] = best


@jit
def _around(points: Array, start: int, end: int, ball: Array) -> None:
    """A ball around points of some rows: its middle and radius."""
    for c in range(3):
        ball[c] = 0.0
        for i in range(start, end):
            ball[c] += points[i, c] / (end - start)
    ball[3] = 0.0
    for i in range(start, end):
        x, y, z = points[i, 0] - ball[0], points[i, 1] - ball[1], points[i, 2] - ball[2]
        ball[3] = max(ball[3], np.sqrt(x * x + y * y + z * z))


def distance_to_removed_numpy(tool: Tool, axis: Array, starts: Array, ends: Array, points: Array,
                              most: float = np.inf) -> Array:
    """The plain twin of `distance_to_removed`; parameters and result as there."""
    piece = solid_pieces(tool.profile, {})[0]
    middle, half = (starts + ends) / 2, (ends - starts) / 2
    found = np.full(len(points), np.inf)

    def _at(gap: Array) -> Array:
        z = gap @ axis
        rho = np.linalg.norm(gap - z[..., None] * axis, axis=-1)
        return np.asarray(piece_distance_numpy(piece, rho, z)[0])

    for row in range(0, len(points), _ROWS):
        gap = points[row:row + _ROWS, None] - middle
        low, high = np.full(gap.shape[:2], -1.0), np.ones(gap.shape[:2])
        best = _at(gap)
        for _ in range(_HALVINGS):
            s, t = low + (high - low) / 3, high - (high - low) / 3
            one, other = _at(gap - s[..., None] * half), _at(gap - t[..., None] * half)
            best = np.minimum(best, np.minimum(one, other))
            low, high = np.where(one < other, low, s), np.where(one < other, t, high)
        found[row:row + _ROWS] = best.min(axis=1, initial=np.inf)
    return np.asarray(np.minimum(found, most))


def distance_to_removed(tool: Tool, axis: ArrayLike, starts: ArrayLike, ends: ArrayLike, points: ArrayLike,
                        most: float = np.inf, least: float = -np.inf) -> Array:
    """Signed distance of points to the union of a cutter's positions on straight motions.

    Parameters
    ----------
    tool : Tool
        Its cutter alone counts.
    axis : (3,) array_like
        From tip to spindle, the same on all motions.
    starts, ends : (m, 3) array_like
        Tips at both ends of each motion, mm.
    points : (n, 3) array_like
        mm
    most, least : float
        Distances greater than `most` are told as this, mm, and where one is not above `least` no lesser one is looked
        for: both take less time.

    Returns
    -------
    (n,) array
        mm, negative where the cutter comes; inf where there is no motion. To `RESOLUTION`, from above.

    Raises
    ------
    InvalidInput
        When points are not rows of three finite numbers.

    Notes
    -----
    The distance to a convex cutter is a convex function of its place, and changes by no more than the place does: a
    motion whose middle is farther away than the best one by half its length is left out, on others the least is
    found by thirds.  So are groups of motions that follow each other.

    **Properties**: 1. it never rises with more motions; 2. it turns with tool and points.
    """
    return sweep_motions(axis, starts, ends).distance(tool, points, most, least)


class SweptMotions(NamedTuple):
    """Straight motions of a tip with one axis, made ready to be asked for distances many times; from `sweep_motions`.

    axis : (3,) array;  starts, ends : (m, 3) arrays, tips, mm
    frame : (3, 3) array, columns of the frame whose z is the axis
    moves : (m, 7) array, in that frame the middle, half of the way, and half the length, mm
    balls, wide : (g, 4) arrays, around groups of motions, and around groups of these: see `_balls`
    """

    axis: Array
    starts: Array
    ends: Array
    frame: Array
    moves: Array
    balls: Array
    wide: Array

    def distance(self, tool: Tool, points: ArrayLike, most: float = np.inf, least: float = -np.inf) -> Array:
        """Signed distance of points to the union of a cutter's positions, (n,) mm, see `distance_to_removed`.

        Parameters
        ----------
        tool, points, most, least
            As for `distance_to_removed`.
        """
        p = as_rows(points, 3, "points")
        if not _compiled.available:
            return distance_to_removed_numpy(tool, self.axis, self.starts, self.ends, p, most)
        out, cutter, places = np.empty(len(p)), parameters_of_tool(tool), np.ascontiguousarray(p @ self.frame)

        def _measure(some: slice) -> None:
            _least(cutter, self.wide, self.balls, self.moves, places[some], (float(least), float(most)), out[some])

        work_on_rows(_measure, len(p), _AT_ONCE)
        return out


def sweep_motions(axis: ArrayLike, starts: ArrayLike, ends: ArrayLike) -> SweptMotions:
    """Motions made ready to be asked for distances.

    Parameters
    ----------
    axis, starts, ends
        As for `distance_to_removed`.
    """
    a, b = (as_rows(rows, 3, name) for rows, name in ((starts, "starts"), (ends, "ends")))
    t = unit(as_rows(axis, 3, "axis")[0])
    sideways = unit(np.cross(t, np.eye(3)[int(np.argmin(np.abs(t)))]))
    frame = np.array([sideways, np.cross(t, sideways), t]).T
    half = (b - a) / 2
    moves = np.ascontiguousarray(np.column_stack([(a + b) / 2 @ frame, half @ frame, np.linalg.norm(half, axis=1)]))
    balls = _balls(moves[:, :3], moves[:, 6], _GROUP)
    return SweptMotions(t, a, b, frame, moves, balls, _balls(balls[:, :3], balls[:, 3], _GROUPS))


def _balls(centres: Array, reach: Array, size: int) -> Array:
    """Centres of groups of balls that follow each other, and how far any place in these is from there, (g, 4).

    Parameters
    ----------
    centres : (n, 3) array
    reach : (n,) array
        Radii.
    size : int
        Of a group.
    """
    first = np.arange(0, len(centres), size)
    owner = np.arange(len(centres)) // size
    count = np.diff(np.append(first, len(centres)))
    balls = np.empty((len(first), 4))
    balls[:, :3] = np.add.reduceat(centres, first) / count[:, None] if len(first) else 0.0
    far = np.linalg.norm(centres - balls[owner, :3], axis=1) + reach
    balls[:, 3] = np.maximum.reduceat(far, first) if len(first) else 0.0
    return balls
