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
from toolaxis.shape.nearest import NearestPoints, nearest
from toolaxis.verify.borders import STEP, BorderLoop, in_parameters, line_of, on_border
from toolaxis.verify.spatial_blocks import blocks_of

Array = NDArray[np.float64]

#: How near the end of the part must be to count, mm, at least and as a multiple of the depth that is allowed: at edges
#: up to 170 degrees sharp a ray farther inside that is laid bare deeper than allowed tells of a cut that is.
NEAR, TIMES = 0.05, 12.0
#: Rays are laid from the end of the part inwards in these steps: the first, mm, and the ratio of the others.
FIRST, RATIO = 0.0002, 1.05
#: Shares of a ray's depth at which the end beside it is looked for; least depth to which a ray is followed, mm.
_STATIONS, _LEAST = (0.0, 0.25, 0.5, 0.75, 1.0), 1e-6
#: Turn of a face's normal down a ray up to which it is plane there.
_PLANE = 1e-7
#: Ways down an edge within which it is told to be convex, mm; how many rays are looked at at once.
_DOWN, _AT_ONCE = (NEAR, NEAR / 5, NEAR / 25), 512


class End(NamedTuple):
    """Where the part ends beside rays.

    there : (k,) whether it does;
    point, outwards : (stations, k, 3) points on the end, mm, and normals out of the part there: the nearest to places
    down the ray.
    """

    there: NDArray[np.bool_]
    point: Array
    outwards: Array


def depth_at_edges(face: Face, rays: tuple[Array, Array, Array], around: tuple[tuple[Face, ...], tuple[Face, ...]],
                   cut: Callable[[Array, Array, Array], Array], allowed: float,
                   others: Callable[[Array, Array, Array], Array]) -> tuple[Array, NDArray[np.bool_]]:
    """How deep the cut lies below the part's surface, for rays of a face; the rays' own depth far from edges.

    Parameters
    ----------
    face : Face
        On which the rays stand.
    rays : (m, 3), (m, 3) and (m,) array
        Feet, mm, normals out of the material, and depths to which the rays are laid bare, mm.
    around : tuple of Face, tuple of Face
        The faces of the part that may lie behind a convex edge; all other faces that may continue the part beyond a
        border.
    cut : callable
        Depths laid bare, mm, of rays with given feet and normals that are followed to given depths.
    allowed : float
        Depth that a gouge may have, mm.
    others : callable
        How far rays with given feet, normals and depths may be followed until another place of the part is nearer, mm.

    Returns
    -------
    (m,) array, mm: the greatest that any ray tells from the foot inwards, as far as counts as near, in steps of 5 %;
    (m,) array: whether the ray is near an edge.

    Notes
    -----
    **Properties**: 1. never above the greatest depth of these rays; 2. a cut deeper and wider than a limit is never
    told to be below it; 3. a ray farther than `NEAR`, and `TIMES` the allowed depth, from every edge keeps its depth.

    Where another place of the part is nearer than a ray's foot, a depth belongs to that place, and is told there.
    """
    foot, normal, depth = rays
    reach = max(NEAR, TIMES * allowed)
    told = depth.copy()
    near = np.zeros(len(foot), dtype=bool)
    behind, going_on = around
    beside = [(other, _may_lie_within(reach, other, foot)) for other in behind]
    for first in range(0, len(foot), _AT_ONCE):
        rows = np.arange(first, min(first + _AT_ONCE, len(foot)))
        some_rays = (foot[rows], normal[rows], depth[rows])
        ends = [_behind(other, some_rays, close[rows], reach) for other, close in beside]
        ends.append(_open(face, (foot[rows], normal[rows]), (*behind, *going_on), reach))
        here = np.any([end.there for end in ends], axis=0)
        near[rows] = here
        rows = rows[here]
        if len(rows):
            some = [End(end.there[here], end.point[:, here], end.outwards[:, here]) for end in ends if end.there.any()]
            feet, directions = _inwards(face, (foot[rows], normal[rows]), some, reach)
            middle = _middle((feet, directions), some)
            # What lies beyond the middle is nearer to the other face, and may be air on its side.
            asked = np.maximum(middle, _LEAST)
            found = cut(feet.reshape(-1, 3), directions.reshape(-1, 3), asked.reshape(-1)).reshape(asked.shape)
            found = np.where(middle > 0.0, np.minimum(found, middle), 0.0)
            over = (found > allowed).any(axis=1)
            if over.any():
                deep = feet[over].reshape(-1, 3), directions[over].reshape(-1, 3)
                placed = _place_on_part(deep, (face, *behind))
                limit = np.maximum(middle[over], _LEAST).reshape(-1)
                found[over] = _follow_to_other_places(placed, limit, cut, others).reshape(over.sum(), -1)
            told[rows] = found.max(axis=1)
    return told, near


def _place_on_part(rays: tuple[Array, Array], faces: tuple[Face, ...]) -> tuple[Array, Array, Array]:
    """Rays whose feet lie exactly on the part, by the nearest of its faces: feet and normals, (m, 3), and how far the
    feet were moved, (m,) mm.

    The way inwards is told by the face's bend at its beginning: where it bends more on, or goes over into another face,
    feet would stand in the air or within the part.
    """
    given, directions = rays
    foot = given.copy()
    normal = directions.copy()
    away = np.full(len(foot), np.inf)
    for face in faces:
        low, high = face.box
        beyond = np.maximum(np.maximum(low - given, given - high), 0.0)
        rows = np.flatnonzero(np.linalg.norm(beyond, axis=1) < away)
        if not len(rows):
            continue
        found = nearest(face, given[rows])
        closer = found.distance < away[rows]
        rows = rows[closer]
        away[rows] = found.distance[closer]
        foot[rows] = found.point[closer]
        normal[rows] = face.normal(found.uv[closer])
    return foot, normal, away


def _follow_to_other_places(rays: tuple[Array, Array, Array], limit: Array, cut: Callable[[Array, Array, Array], Array],
                            others: Callable[[Array, Array, Array], Array]) -> Array:
    """Depths of rays beside an edge, followed to a limit each, (m,) mm, until another place of the part is nearer."""
    feet, directions, moved = rays
    depth = cut(feet, directions, limit + moved)
    end = np.maximum(others(feet, directions, depth), _LEAST)
    short = end < depth
    if short.any():
        depth[short] = cut(feet[short], directions[short], end[short])
    return depth


def _may_lie_within(reach: float, other: Face, foot: Array) -> NDArray[np.bool_]:
    """Which of some places may lie nearer to a face than a reach, (k,) bool; the others surely do not.

    A place is no nearer to the face than the middle of a ball around it and its neighbours, less the ball's radius:
    asking for the middles leaves a few of the places to ask for.
    """
    near = ((foot > other.box[0] - reach) & (foot < other.box[1] + reach)).all(axis=1)
    rows = np.flatnonzero(near)
    if len(rows):
        blocks = blocks_of(foot[rows])
        least = nearest(other, blocks.ball[:, :3]).distance - blocks.ball[:, 3]
        near[rows[blocks.order]] = np.repeat(least < reach, np.diff(blocks.first))
    return near


def _behind(other: Face, rays: tuple[Array, Array, Array], close: NDArray[np.bool_], reach: float) -> End:
    """The face behind a convex edge, where rays that may be close to it stand near it: how it lies beside them all the
    way down."""
    foot, normal, depth = rays
    end = _nowhere(foot, normal)
    rows = np.flatnonzero(close)
    if not len(rows):
        return end
    found = nearest(other, foot[rows])
    outwards = other.normal(found.uv)
    away = normal[rows] - dot(normal[rows], outwards)[:, None] * outwards
    steep = (np.linalg.norm(away, axis=1) > 1e-3) & (found.distance < reach)
    rows = rows[steep]
    point = found.point[steep]
    down = -unit(away[steep])
    if not len(rows):
        return end
    convex = _goes_down(other, point, down)
    rows = rows[convex]
    if len(rows):
        end.there[rows] = True
        at = NearestPoints(*(values[steep][convex] for values in found))
        points, ways = _stations(other, at, (foot[rows], normal[rows], depth[rows]), reach)
        end.point[:, rows] = points
        end.outwards[:, rows] = ways
    return end


def _goes_down(other: Face, point: Array, down: Array) -> NDArray[np.bool_]:
    """Whether a face goes on from points of its border down an edge; a small fillet does so for a short way only."""
    found = np.zeros(len(point), dtype=bool)
    for step in _DOWN:
        rows = np.flatnonzero(~found)
        if len(rows):
            found[rows] = nearest(other, point[rows] + step * down[rows]).distance < 0.3 * step
    return found


def _stations(other: Face, at: NearestPoints, rays: tuple[Array, Array, Array], reach: float) -> tuple[Array, Array]:
    """Points on a face and its normals there, nearest to places down rays: their feet first, (stations, k, 3) each."""
    foot, normal, depth = rays
    outwards = other.normal(at.uv)
    every = (len(_STATIONS), 1, 1)
    points = np.tile(at.point, every)
    ways = np.tile(outwards, every)
    # Rays from as far inwards as is looked at come nearer to the other face at this depth, were it plane.
    flat = dot(normal, outwards)
    lowest = 2.0 * reach * np.sqrt((1.0 + flat) / np.maximum(1.0 - flat, 1e-12))
    down = np.minimum(depth, lowest)[:, None] * normal
    last = nearest(other, foot - down)
    points[-1] = last.point
    ways[-1] = other.normal(last.uv)
    bent = np.flatnonzero(np.linalg.norm(ways[-1] - outwards, axis=1) > _PLANE)
    for k, share in enumerate(_STATIONS[1:-1] if len(bent) else (), start=1):
        found = nearest(other, foot[bent] - share * down[bent])
        points[k, bent] = found.point
        ways[k, bent] = other.normal(found.uv)
    return points, ways


def _nowhere(foot: Array, normal: Array) -> End:
    """No end of the part beside any ray."""
    shape = (len(_STATIONS), 1, 1)
    return End(np.zeros(len(foot), dtype=bool), np.tile(foot, shape), np.tile(normal, shape))


def _open(face: Face, rays: tuple[Array, Array], others: tuple[Face, ...], reach: float) -> End:
    """The face's own border, where rays stand near it and the part does not go on."""
    foot, normal = rays
    end = _nowhere(foot, normal)
    lines = [line_of(face, loop) for loop in face.outline]
    uv, along = on_border(face, foot, lines, reach)
    point = face.evaluate(uv).point
    across = np.cross(along, face.normal(uv))
    close = np.linalg.norm(point - foot, axis=1) < reach
    known = np.linalg.norm(across, axis=1) > 0.0
    rows = np.flatnonzero(close & known)
    if not len(rows):
        return end
    outwards = unit(across[rows])
    step = in_parameters(face, uv[rows], 0.1 * NEAR * outwards)
    # 1 where the face lies ahead of the border, -1 where behind it, 0 where on both sides or on none.
    sides = face.contains(uv[rows] + step).astype(int) - face.contains(uv[rows] - step).astype(int)
    alone = (sides != 0) & ~_goes_on_beyond(point[rows], lines, others)
    end.there[rows[alone]] = True
    end.point[:, rows] = point[rows]
    end.outwards[:, rows] = -sides[:, None] * outwards
    return end


def _goes_on_beyond(point: Array, lines: list[BorderLoop], others: tuple[Face, ...]) -> NDArray[np.bool_]:
    """Whether the part goes on beyond points of a border: on another face, or on the same beyond a seam."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(point), dtype=bool)
    for other in others:
        low, high = other.box
        in_box = ((point > low - NEAR) & (point < high + NEAR)).all(axis=1)
        rows = np.flatnonzero(in_box & ~found)
        if len(rows):
            found[rows] = nearest(other, point[rows]).distance < NEAR
    for line in lines:
        rows = np.flatnonzero(~found)
        tree = cKDTree(line.point)
        whole = line.way[-1]
        for i, near in zip(rows, tree.query_ball_point(point[rows], NEAR + STEP), strict=True):
            if near:
                # Points of the same loop that are near in space and far along it: both sides of a seam.
                _, own = tree.query(point[i])
                between = np.abs(line.way[near] - line.way[own])
                along = np.minimum(between, whole - between)
                straight = np.linalg.norm(line.point[near] - point[i], axis=1) + STEP
                found[i] |= bool((along > 4.0 * straight).any())
    return found


def _inwards(face: Face, rays: tuple[Array, Array], ends: list[End], reach: float) -> tuple[Array, Array]:
    """Feet and normals of rays from each foot on, away from the ends beside it, (k, steps, 3) each."""
    foot, normal = rays
    room = np.array([np.where(end.there, dot(end.point[0] - foot, end.outwards[0]), np.inf) for end in ends])
    # The nearest end counts most; in a corner all of them do, so that the way leads to where the part is thickest.
    weight = np.where(np.isfinite(room), np.maximum(reach - np.maximum(room, 0.0), 1e-3 * reach), 0.0)
    all_outwards = np.array([end.outwards[0] for end in ends])
    outwards = np.einsum("ek,ekc->kc", weight, all_outwards)
    flat = outwards - dot(outwards, normal)[:, None] * normal
    sound = np.linalg.norm(flat, axis=1) > 1e-9 * weight.sum(axis=0)
    nearest_one = all_outwards[room.argmin(axis=0), np.arange(len(foot))]
    flat = np.where(sound[:, None], flat, nearest_one - dot(nearest_one, normal)[:, None] * normal)
    inwards = -unit(flat)
    # Feet follow the face inwards by its bend at their beginning, and normals turn with them.
    uv = nearest(face, foot).uv
    d = face.evaluate(uv)
    du, dv = in_parameters(face, uv, inwards).T[..., None]
    bend = dot(d.suu * du**2 + 2 * d.suv * du * dv + d.svv * dv**2, normal)[:, None, None]
    count = int(np.ceil(np.log(reach / FIRST) / np.log(RATIO)))
    from_end = FIRST * RATIO ** np.arange(count + 1)
    own = np.clip(room.min(axis=0), 0.0, reach)
    way = np.maximum(from_end - own[:, None], 0.0)[..., None]
    feet = foot[:, None] + way * inwards[:, None] + 0.5 * (bend * way**2) * normal[:, None]
    return feet, unit(normal[:, None] - bend * way * inwards[:, None])


def _middle(rays: tuple[Array, Array], ends: list[End]) -> Array:
    """How far rays run before they come nearer to an end than to their own face, (k, steps) mm; infinite where never.

    Parameters
    ----------
    rays : (k, steps, 3) arrays
        Feet and normals.
    ends : list of End

    Notes
    -----
    A plane through p with the normal m out of the part is as far from foot - t normal as the foot is where
    t (1 - m normal) = m (p - foot).  An end that bulges outwards lies within all its planes, and the nearest one tells;
    a hollow one lies beyond them, and the farthest does.
    """
    foot, normal = rays
    middle = np.full(foot.shape[:2], np.inf)
    for end in ends:
        apart = end.point[:, :, None] - foot
        out = end.outwards[:, :, None]
        ways = dot(out, apart) / np.maximum(1.0 - dot(out, normal[None]), 1e-12)
        bulges = np.all(dot(end.point[:-1] - end.point[1:], end.outwards[:-1]) >= 0.0, axis=0)
        way = np.where(bulges[:, None], ways.min(axis=0), ways.max(axis=0))
        middle = np.where(end.there[:, None], np.minimum(middle, way), middle)
    return middle
