"""Faces that touch without sharing an edge in their file: borders found by position."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import signed_area
from toolaxis.shape.adjacency import Border
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

SAMPLES = 33
NEAR = 1e-4


@dataclass(frozen=True, eq=False)
class OpenEdge:
    """A piece of a face's border that no other face is known to share.

    Attributes
    ----------
    face : int
        Number.
    points : (m, 3) array
        Along the border, mm.
    uv : (m, 2) array
        The same places in the face's parameters.
    left : bool
        The face lies left of the direction of the points, seen from the side to which its Su x Sv points.
    """

    face: int
    points: Array
    uv: Array
    left: bool


def sides_of(face: Face) -> list[OpenEdge]:
    """The whole border of a face, one side for each straight line in its parameters and one for each other loop.

    Parameters
    ----------
    face : Face
    """
    sides = []
    for index, loop in enumerate(face.outline):
        is_outer = index == 0
        left = (signed_area(loop) > 0) == is_outer
        closed = np.concatenate([loop, loop[:1]])
        pieces = [closed]
        if len(loop) <= 8:
            pieces = [closed[k:k + 2] for k in range(len(loop))]
        for piece in pieces:
            uv = _refine_line(piece)
            points = face.evaluate(uv).point
            sides.append(OpenEdge(face.number, points, uv, left))
    return sides


def _refine_line(line: Array) -> Array:
    parts = -(-SAMPLES // (len(line) - 1))
    parts = max(1, parts)
    share = (np.arange(parts) / parts)[:, None]
    inner = [a + share * (b - a) for a, b in pairwise(line)]
    return np.concatenate([*inner, line[-1:]])


def match_edges(sides: Sequence[OpenEdge], size: float) -> list[Border]:
    """Stretches along which two sides of different faces run together.

    Parameters
    ----------
    sides : sequence of OpenEdge
    size : float
        Diagonal of the part, mm; sides nearer than 1e-4 of it, and of their own length, count as touching.

    **Properties**: 1. faces that touch in a point only share no border.
    """
    low = np.array([side.points.min(axis=0) for side in sides]).reshape(-1, 3)
    high = np.array([side.points.max(axis=0) for side in sides]).reshape(-1, 3)
    borders = []
    for k, side in enumerate(sides):
        near = NEAR * max(size, _length(side.points))
        begins_before = low[k] <= high[k + 1:] + near
        ends_behind = low[k + 1:] <= high[k] + near
        close = (begins_before & ends_behind).all(axis=1)
        for j in np.flatnonzero(close):
            other = sides[k + 1 + int(j)]
            if other.face != side.face:
                borders += _together(side, other, near)
    return borders


def _length(points: Array) -> float:
    steps = np.diff(points, axis=0)
    return float(np.linalg.norm(steps, axis=1).sum())


def _together(one: OpenEdge, other: OpenEdge, near: float) -> list[Border]:
    """Runs of a side's points that lie on the other side; the finer of the two is walked along."""
    if len(other.points) > len(one.points):
        one, other = other, one
    distance, uv, place = _nearest(one.points, other)
    on = np.concatenate([[False], distance <= near, [False]])
    starts = np.flatnonzero(~on[:-1] & on[1:])
    ends = np.flatnonzero(on[:-1] & ~on[1:])
    borders = []
    for begin, end in zip(starts, ends, strict=True):
        run = slice(begin, end)
        points = one.points[run]
        if len(points) < 2 or _length(points) <= 10 * near:
            continue
        runs_back = bool(np.median(np.diff(place[run])) < 0)
        borders.append(Border((one.face, other.face), points, one.uv[run], uv[run], one.left, other.left ^ runs_back))
    return borders


def _nearest(points: Array, side: OpenEdge) -> tuple[Array, Array, Array]:
    """Distance of points from a side's polyline, the side's parameters there, and how far along it, in segments."""
    start = side.points[:-1]
    course = np.diff(side.points, axis=0)
    offset = points[:, None] - start
    square = np.maximum((course**2).sum(axis=1), 1e-300)
    share = np.einsum("nkc,kc->nk", offset, course) / square
    share = np.clip(share, 0.0, 1.0)
    away = np.linalg.norm(offset - share[..., None] * course, axis=2)
    best = away.argmin(axis=1)
    rows = np.arange(len(points))
    t = share[rows, best]
    begin = side.uv[best]
    step = side.uv[best + 1] - begin
    uv = begin + t[:, None] * step
    return away[rows, best], uv, best + t
