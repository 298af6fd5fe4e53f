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
    if not total > 0:
        total = 1.0
    point = d.point[good]
    near = _near(point, walls, reach)
    return CheckPoints(uv[good], point, normal[good], share[good] / total, near)


def _near(points: Array, walls: tuple[Face, ...], reach: float) -> Bools:
    """Which walls are within reach of each point, (n, walls): which meet the upper or the lower half of a ball."""
    found = np.zeros((len(points), len(walls)), dtype=bool)
    half = Tool.ball(2 * reach, flute_length=(1 + 1e-9) * reach)
    up = np.array([0.0, 0.0, 1.0])
    touching = np.zeros((1, 3))
    for k, wall in enumerate(walls):
        low, high = wall.box
        gap = np.maximum(low - points, points - high)
        distance = np.linalg.norm(np.maximum(gap, 0.0), axis=1)
        close = np.flatnonzero(distance <= reach)
        for axis in (up, -up):
            rest = close[~found[close, k]]
            if len(rest):
                moves = motions(points[rest] - reach * axis, axis)
                met = keeps_limits(cells(wall), half, moves, touching)
                found[rest, k] = met.blocked >= 0
    return found


def around(face: Face, count: int) -> Array:
    """Points along the loops of a face, evenly by length, with the corners of plain loops, (n, 2) parameters.

    Parameters
    ----------
    face : Face
    count : int
        About how many in all.
    """
    total = sum(float(_chords(face, _closed(loop)).sum()) for loop in face.outline)
    share = np.linspace(0.0, 1.0, 33)[:-1, None]
    rows = []
    for loop in face.outline:
        closed = _closed(loop)
        fine = closed[:-1, None] * (1 - share) + closed[1:, None] * share
        fine = np.vstack([fine.reshape(-1, 2), closed[-1:]])
        length = np.concatenate([[0.0], np.cumsum(_chords(face, fine))])
        wanted = 8
        if total > 0:
            wanted = max(8, round(count * length[-1] / total))
        even = np.linspace(0, length[-1], wanted, endpoint=False)
        at = np.searchsorted(round_significant(length), round_significant(even))
        rows.append(fine[at])
        if len(loop) <= wanted // 2:
            rows.append(loop)
    return np.concatenate(rows)


def _closed(loop: Array) -> Array:
    """A loop with its first point at its end too."""
    return np.vstack([loop, loop[:1]])


def _chords(face: Face, uv: Array) -> Array:
    """Distances of neighbouring places on a face, (n - 1,) mm."""
    points = face.evaluate(uv).point
    return np.asarray(np.linalg.norm(np.diff(points, axis=0), axis=1))
