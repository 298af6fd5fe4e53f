"""Places on a face at which axes are judged."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.numeric.rounding import round_significant
from toolaxis.shape.bounding.bounding_tree import cells
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]



class CheckPoints(NamedTuple):
    """Places on a face.

    uv : (n, 2);  point, normal : (n, 3);  share : (n,) of the area that each stands for;  near : (n, k) bool, whether
    wall k is so near that a clean-up tool has to do what this one cannot.
    """

    uv: Array
    point: Array
    normal: Array
    share: Array
    near: Bools


def contacts_at(face: Face, uv: Array, weighed: int, walls: tuple[Face, ...], reach: float) -> CheckPoints:
    """Contacts at parameters; degenerate places are left out.

    Parameters
    ----------
    face : Face
    uv : (n, 2) array
    weighed : int
        How many of the first ones are an even grid, for which the area counts.
    walls : tuple of Face
    reach : float
        Distance to a wall within which a clean-up tool takes over, mm.
    """
    d = face.evaluate(uv)
    normal = face.normal(uv, d)
    share = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    share[weighed:] = 0.0
    good = np.linalg.norm(normal, axis=1) > 0.5
    total = float(share[good].sum())
    return CheckPoints(uv[good], d.point[good], normal[good], share[good] / (total if total > 0 else 1.0),
                       _near(d.point[good], walls, reach))


def _near(points: Array, walls: tuple[Face, ...], reach: float) -> Bools:
    """Which walls are within reach of each point, (n, walls): which meet the upper or the lower half of a ball."""
    found = np.zeros((len(points), len(walls)), dtype=bool)
    half, up = Tool.ball(2 * reach, flute_length=(1 + 1e-9) * reach), np.array([0.0, 0.0, 1.0])
    for k, wall in enumerate(walls):
        gap = np.maximum(np.maximum(wall.box[0] - points, points - wall.box[1]), 0.0)
        close = np.flatnonzero(np.linalg.norm(gap, axis=1) <= reach)
        for axis in (up, -up):
            rest = close[~found[close, k]]
            if len(rest):
                moves = motions(points[rest] - reach * axis, axis)
                found[rest, k] = keeps_limits(cells(wall), half, moves, np.zeros((1, 3))).blocked >= 0
    return found


def around(face: Face, count: int) -> Array:
    """Points along the loops of a face, evenly by length, with the corners of plain loops, (n, 2) parameters.

    Parameters
    ----------
    face : Face
    count : int
        About how many in all.
    """
    rows = []
    total = sum(float(np.linalg.norm(np.diff(face.evaluate(np.vstack([loop, loop[:1]])).point, axis=0), axis=1).sum())
                for loop in face.outline)
    for loop in face.outline:
        closed = np.vstack([loop, loop[:1]])
        share = np.linspace(0.0, 1.0, 33)[:-1]
        fine = (closed[:-1, None] * (1 - share[:, None]) + closed[1:, None] * share[:, None]).reshape(-1, 2)
        fine = np.vstack([fine, closed[-1:]])
        length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(face.evaluate(fine).point, axis=0), axis=1))])
        wanted = max(8, round(count * length[-1] / total)) if total > 0 else 8
        at = np.searchsorted(round_significant(length), round_significant(np.linspace(0, length[-1], wanted,
                                                                                      endpoint=False)))
        rows += [fine[at], loop] if len(loop) <= wanted // 2 else [fine[at]]
    return np.concatenate(rows)
