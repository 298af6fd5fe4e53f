"""Convex edges and open borders: near them the part ends beside a ray, and less than the ray's whole depth is lost.

A ray on the very rim runs down along the neighbouring face, and is laid bare to any depth by a cut that takes a
thousandth of a millimetre off the rim.  How deep a cut lies below the part's surface is the distance of its points from
that surface, the faces behind convex edges included; an open border counts as an edge at right angles.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot, unit
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.rays import loop_points

Array = NDArray[np.float64]

#: How near the end of the part must be to count, mm: a cut wider than that is told by rays farther inside.
NEAR = 0.05
#: Rays are laid from the end of the part inwards in these steps: the first, mm, and the ratio of the others.
FIRST, RATIO = 0.0002, 1.05
#: Distance of a border's points, mm, pieces between them, and shares of a ray's depth that are looked at.
_STEP, _PIECES, _SHARES = 0.25, 64, (0.25, 0.5, 0.75, 1.0)


class End(NamedTuple):
    """Where the part ends beside rays: whether it does (k,), points on the end, and normals out of the part (k, 3)."""

    there: NDArray[np.bool_]
    point: Array
    outwards: Array


def depth_at_edges(face: Face, rays: tuple[Array, Array, Array], around: tuple[tuple[Face, ...], tuple[Face, ...]],
                   cut: Callable[[Array, Array], Array]) -> Array:
    """How deep the cut lies below the part's surface, for rays of a face; the rays' own depth far from edges.

    Parameters
    ----------
    face : Face
        On which the rays stand.
    rays : (m, 3), (m, 3) and (m,) array
        Feet, mm, normals out of the material, and depths to which the rays are laid bare, mm.
    around : tuple of Face, tuple of Face
        The faces behind convex edges; all other faces that may continue the part beyond a border.
    cut : callable
        Depths laid bare, mm, of rays with given feet and normals.

    Returns
    -------
    (m,) array, mm: the greatest that any ray tells from the foot up to `NEAR` inwards, in steps of 5 %.

    Notes
    -----
    **Properties**: 1. never above the greatest depth of these rays; 2. a cut deeper and wider than a limit is never
    told to be below it; 3. a ray farther than `NEAR` from every edge keeps its depth.
    """
    foot, normal, depth = rays
    ends = [*(_behind(other, foot, normal) for other in around[0]),
            _open(face, foot, normal, (*around[0], *around[1]))]
    rows = np.flatnonzero(np.any([end.there for end in ends], axis=0))
    told = depth.copy()
    if len(rows):
        some = [End(end.there[rows], end.point[rows], end.outwards[rows]) for end in ends]
        feet, directions = _inwards(face, foot[rows], normal[rows], some)
        laid_bare = cut(feet.reshape(-1, 3), directions.reshape(-1, 3)).reshape(feet.shape[:2])
        told[rows] = np.minimum(depth[rows], _told(feet, directions, laid_bare, some))
    return told


def _behind(other: Face, foot: Array, normal: Array) -> End:
    """The face behind a convex edge, where rays stand near it."""
    end = End(np.zeros(len(foot), dtype=bool), foot.copy(), normal.copy())
    rows = np.flatnonzero(((foot > other.box[0] - NEAR) & (foot < other.box[1] + NEAR)).all(axis=1))
    if not len(rows):
        return end
    found = nearest(other, foot[rows])
    outwards = other.normal(found.uv)
    away = normal[rows] - dot(normal[rows], outwards)[:, None] * outwards
    steep = np.linalg.norm(away, axis=1) > 1e-3
    below = nearest(other, found.point - NEAR * unit(np.where(steep[:, None], away, normal[rows]))).distance
    convex = steep & (found.distance < NEAR) & (below < 0.3 * NEAR)
    end.there[rows[convex]], end.point[rows], end.outwards[rows] = True, found.point, outwards
    return end


def _open(face: Face, foot: Array, normal: Array, others: tuple[Face, ...]) -> End:
    """The face's own border, where rays stand near it and the part does not go on."""
    end = End(np.zeros(len(foot), dtype=bool), foot.copy(), normal.copy())
    lines = [_line(face, loop) for loop in face.outline]
    uv, along = _on_border(face, foot, lines)
    point = face.evaluate(uv).point
    across = np.cross(along, face.normal(uv))
    rows = np.flatnonzero((np.linalg.norm(point - foot, axis=1) < NEAR) & (np.linalg.norm(across, axis=1) > 0.0))
    if not len(rows):
        return end
    outwards = unit(across[rows])
    step = _in_parameters(face, uv[rows], 0.1 * NEAR * outwards)
    sides = face.contains(uv[rows] + step).astype(int) - face.contains(uv[rows] - step).astype(int)
    alone = (sides != 0) & ~_continued(point[rows], lines, others)
    end.there[rows[alone]], end.point[rows], end.outwards[rows] = True, point[rows], -sides[:, None] * outwards
    return end


class _Line(NamedTuple):
    """A loop as points no farther apart than `_STEP`: parameters, places, and way to the next along the loop, mm."""

    uv: Array
    point: Array
    way: Array


def _line(face: Face, loop: Array) -> _Line:
    uv = loop_points(face, loop, _STEP)
    point = face.evaluate(uv).point
    return _Line(uv, point, np.cumsum(np.linalg.norm(np.roll(point, -1, axis=0) - point, axis=1)))


def _on_border(face: Face, foot: Array, lines: list[_Line]) -> tuple[Array, Array]:
    """Parameters of the nearest point of the border to each foot, and the border's direction there."""
    from scipy.spatial import cKDTree

    uv, along, least = np.zeros((len(foot), 2)), np.zeros((len(foot), 3)), np.full(len(foot), np.inf)
    share = np.linspace(-1.0, 1.0, 2 * _PIECES + 1)
    for line in lines:
        distance, k = cKDTree(line.point).query(foot)
        rows = np.flatnonzero(distance < np.minimum(least, _STEP) + NEAR)
        if not len(rows):
            continue
        k, count = k[rows], len(line.uv)
        back, ahead = line.uv[(k - 1) % count] - line.uv[k], line.uv[(k + 1) % count] - line.uv[k]
        way = np.maximum(-share, 0.0)[:, None] * back[:, None] + np.maximum(share, 0.0)[:, None] * ahead[:, None]
        place = line.uv[k][:, None] + way
        point = face.evaluate(place.reshape(-1, 2)).point.reshape(len(rows), -1, 3)
        step = np.diff(point, axis=1)
        size = np.maximum(dot(step, step), 1e-300)
        at = np.clip(dot(foot[rows][:, None] - point[:, :-1], step) / size, 0.0, 1.0)
        gap = np.linalg.norm(point[:, :-1] + at[..., None] * step - foot[rows][:, None], axis=2)
        j, i = gap.argmin(axis=1), np.arange(len(rows))
        better = gap[i, j] < least[rows]
        found = place[i, j] + at[i, j][:, None] * (place[i, j + 1] - place[i, j])
        uv[rows[better]], along[rows[better]] = found[better], step[i, j][better]
        least[rows[better]] = gap[i, j][better]
    return uv, along


def _continued(point: Array, lines: list[_Line], others: tuple[Face, ...]) -> NDArray[np.bool_]:
    """Whether the part goes on beyond points of a border: on another face, or on the same beyond a seam."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(point), dtype=bool)
    for other in others:
        rows = np.flatnonzero(((point > other.box[0] - NEAR) & (point < other.box[1] + NEAR)).all(axis=1) & ~found)
        if len(rows):
            found[rows] = nearest(other, point[rows]).distance < NEAR
    for line in lines:
        tree = cKDTree(line.point)
        for i, near in enumerate(tree.query_ball_point(point, NEAR + _STEP)):
            if near:
                at, whole = line.way[near], line.way[-1]
                between = np.abs(at - line.way[tree.query(point[i])[1]])
                straight = np.linalg.norm(line.point[near] - point[i], axis=1) + _STEP
                found[i] |= bool((np.minimum(between, whole - between) > 4.0 * straight).any())
    return found


def _in_parameters(face: Face, uv: Array, way: Array) -> Array:
    """The steps in (u, v) that lead along tangent vectors, (k, 2)."""
    d = face.evaluate(uv)
    e, f, g = dot(d.su, d.su), dot(d.su, d.sv), dot(d.sv, d.sv)
    a, b, size = dot(way, d.su), dot(way, d.sv), np.maximum(e * g - f * f, 1e-300)
    return np.stack([(g * a - f * b) / size, (e * b - f * a) / size], axis=1)


def _inwards(face: Face, foot: Array, normal: Array, ends: list[End]) -> tuple[Array, Array]:
    """Feet and normals of rays from each foot on, away from the nearest end, (k, steps, 3) each."""
    room = np.array([np.where(end.there, dot(end.point - foot, end.outwards), np.inf) for end in ends])
    outwards = np.array([end.outwards for end in ends])[room.argmin(axis=0), np.arange(len(foot))]
    first = np.clip(room.min(axis=0), 0.0, NEAR)
    inwards = -unit(outwards - dot(outwards, normal)[:, None] * normal)
    uv = nearest(face, foot).uv
    d, (du, dv) = face.evaluate(uv), _in_parameters(face, uv, inwards).T[..., None]
    bend = dot(d.suu * du**2 + 2 * d.suv * du * dv + d.svv * dv**2, normal)
    count = int(np.ceil(np.log(NEAR / FIRST) / np.log(RATIO)))
    way = np.maximum(FIRST * RATIO ** np.arange(count + 1) - first[:, None], 0.0)[..., None]
    feet = foot[:, None] + way * inwards[:, None] + 0.5 * (bend[:, None, None] * way**2) * normal[:, None]
    return feet, unit(normal[:, None] - bend[:, None, None] * way * inwards[:, None])


def _told(foot: Array, normal: Array, depth: Array, ends: list[End]) -> Array:
    """The greatest distance of what is cut on the rays of each foot from the part's surface."""
    told = np.zeros(len(foot))
    for share in _SHARES:
        way = share * depth
        place = foot - way[..., None] * normal
        for end in ends:
            beside = dot(end.point[:, None] - place, end.outwards[:, None])
            way = np.where(end.there[:, None], np.minimum(way, beside), way)
        told = np.maximum(told, way.max(axis=1))
    return told
