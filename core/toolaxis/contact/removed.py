"""What a cutter removes along a path: signed distance of points to everything that it sweeps."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.sizes import cutter_numbers
from toolaxis.contact.swept import signed_distance
from toolaxis.numeric import compiled as _compiled
from toolaxis.numeric.compiled import compiled
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.tools.assembly import Tool
from toolaxis.tools.solid import piece_distance_numpy, solid_pieces

Array = NDArray[np.float64]

#: The least distance along a straight motion is found to this, mm.
RESOLUTION = 1e-6
_HALVINGS = 60
_ROWS = 64


@compiled
def _least(cutter: Array, widest: float, moves: Array, points: Array, most: float, out: Array) -> None:
    """Points and moves (middle, half way, half length) in the frame whose z is the axis."""
    up = (0.0, 0.0, 1.0)
    for i in range(points.shape[0]):
        best = most
        for k in range(moves.shape[0]):
            half = moves[k, 6]
            x, y, near = points[i, 0] - moves[k, 0], points[i, 1] - moves[k, 1], widest + half + best
            if x * x + y * y >= near * near:
                continue
            z = points[i, 2] - moves[k, 2]
            value = signed_distance(cutter, up, x, y, z)
            if value - half >= best:
                continue
            best = min(best, value)
            low, high = -1.0, 1.0
            for _ in range(_HALVINGS):
                if (high - low) * half < RESOLUTION:
                    break
                s, t = low + (high - low) / 3.0, high - (high - low) / 3.0
                one = signed_distance(cutter, up, x - s * moves[k, 3], y - s * moves[k, 4], z - s * moves[k, 5])
                other = signed_distance(cutter, up, x - t * moves[k, 3], y - t * moves[k, 4], z - t * moves[k, 5])
                best = min(best, one, other)
                if min(one, other) - (high - low) * half >= best:
                    break
                if one < other:
                    high = t
                else:
                    low = s
        out[i] = best


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
                        most: float = np.inf) -> Array:
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
    most : float
        Distances greater than this are told as this, mm: they take less time.

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
    found by thirds.

    **Properties**: 1. it never rises with more motions; 2. it turns with tool and points.
    """
    a, b, p = (as_rows(rows, 3, name) for rows, name in ((starts, "starts"), (ends, "ends"), (points, "points")))
    t = unit(as_rows(axis, 3, "axis")[0])
    if not _compiled.available:
        return distance_to_removed_numpy(tool, t, a, b, p, most)
    sideways = unit(np.cross(t, np.eye(3)[int(np.argmin(np.abs(t)))]))
    frame = np.array([sideways, np.cross(t, sideways), t]).T
    half = (b - a) / 2
    moves = np.ascontiguousarray(np.column_stack([(a + b) / 2 @ frame, half @ frame, np.linalg.norm(half, axis=1)]))
    out = np.empty(len(p))
    _least(cutter_numbers(tool, tool.radius / 2, 0.0), max(tool.radius, tool.profile.top_radius), moves,
           np.ascontiguousarray(p @ frame), float(most), out)
    return out
