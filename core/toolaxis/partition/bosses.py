"""Bosses of a face: closed inner loops with walls that rise from them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.surroundings import Obstacles, faces_of
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: An obstacle stands on a face where it comes nearer than this share of the cutter's radius.
STANDS = 0.5
#: Distance of points on feet and obstacles from which distances are taken, as a share of the cutter's radius.
_SPACING = 0.05
_MOST = 200


@dataclass(frozen=True, eq=False)
class Boss:
    """What rises from an inner loop of a face.

    Attributes
    ----------
    face : int
        Number of the face that it stands on.
    loop : int
        Which of the face's trims is its foot, from 1.
    walls : tuple of int
        Faces that leave the face at the foot, fillets among them.
    faces : tuple of int
        All its faces, the walls first.
    foot : (n, 3) array
        Points of the loop, mm.
    height : float
        Greatest height of a border point above the foot along the mean normal there, mm.
    """

    face: int
    loop: int
    walls: tuple[int, ...]
    faces: tuple[int, ...]
    foot: Array
    height: float


def bosses_of(part: Part, number: int) -> tuple[Boss, ...]:
    """The bosses that stand on a face, in the order of its loops.

    Parameters
    ----------
    part : Part
    number : int

    Returns
    -------
    tuple of Boss
        Holes and pockets, whose walls fall from the loop, are none.

    Raises
    ------
    InvalidInput
        When the part has no such face.

    Notes
    -----
    **Source**: [zhu2016] Sec. 6.5 divides a face by the distance to its boss and takes the boss as given.

    **Properties**: 1. moving or mirroring the part changes nothing but positions.
    """
    face = part.face(number)
    if len(face.trims) < 2:
        return ()
    loops = [face.evaluate(loop).point for loop in face.trims]
    near = _loop_of_neighbours(part, number, loops)
    outer = {other for other, at in near.items() if at == 0}
    found = []
    for k in range(1, len(loops)):
        walls = tuple(sorted(other for other, at in near.items() if at == k))
        reached = _faces_beyond_walls(part, number, walls)
        if walls and not outer.intersection(reached):
            boss = _boss(part, face, k, walls, reached)
            if boss.height > 0:
                found.append(boss)
    return tuple(found)


def _loop_of_neighbours(part: Part, number: int, loops: list[Array]) -> dict[int, int]:
    """Which loop each neighbour borders."""
    result = {}
    for edge in part.edges:
        if number in edge.faces and edge.faces[0] != edge.faces[1]:
            other = edge.faces[1] if edge.faces[0] == number else edge.faces[0]
            middle = edge.polyline[len(edge.polyline) // 2]
            result[other] = int(np.argmin([np.linalg.norm(_segments_nearest(loop, middle)) for loop in loops]))
    return result


def _segments_nearest(loop: Array, point: Array) -> Array:
    """From a point to the nearest point of a closed polygon."""
    start, along = loop, np.roll(loop, -1, axis=0) - loop
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((point - start) * along).sum(axis=1) / square, 0, 1)
    away = start + share[:, None] * along - point
    return np.asarray(away[np.linalg.norm(away, axis=1).argmin()])


def _faces_beyond_walls(part: Part, number: int, walls: tuple[int, ...]) -> tuple[int, ...]:
    """Faces that hang together with the walls without the face itself, the walls first."""
    reached = list(walls)
    for other in reached:
        reached += [n for n in part.neighbours(other) if n != number and n not in reached]
    return tuple(reached)


def _boss(part: Part, face: Face, loop: int, walls: tuple[int, ...], reached: tuple[int, ...]) -> Boss:
    foot = face.evaluate(face.trims[loop]).point
    normal = face.normal(face.trims[loop]).mean(axis=0)
    normal /= np.linalg.norm(normal)
    members = [part.face(n) for n in reached]
    points = np.concatenate([member.evaluate(loop).point for member in members for loop in member.outline])
    heights = (points - foot.mean(axis=0)) @ normal
    above, below = float(heights.max()), float(((foot - foot.mean(axis=0)) @ normal).max())
    return Boss(face.number, loop, walls, reached, foot, above - below if above > below + 1e-6 else 0.0)


def distances(face: Face, tool: Tool, part: Part | None = None,
              obstacles: Obstacles = None) -> tuple[Callable[[Array], Array], ...]:
    """Distances on a face to each boss and each obstacle that stands on it.

    Parameters
    ----------
    face : Face
        The face, or a piece of one.
    tool : Tool
        Its size decides what stands on the face.
    part : Part, optional
        The part that the face belongs to, by its number.
    obstacles : Part, Face or sequence of Face, optional
        Faces that touch each other are one obstacle.

    Returns
    -------
    tuple of callable
        Each takes (n, 2) parameters and returns the distance of these points to the foot of the boss, or to the
        obstacle, (n,) mm: straight through space.
    """
    feet = [] if part is None else [boss.foot for boss in bosses_of(part, face.number)]
    clouds = [_along(foot, _SPACING * tool.radius) for foot in feet]
    points = face.evaluate(np.concatenate([face.grid(60, 60), *face.outline])).point
    for group in _touching(faces_of(obstacles), 1e-3 * tool.radius):
        cloud = np.concatenate([_spread(one, _SPACING * tool.radius) for one in group])
        if _from_cloud(cloud, points).min() < STANDS * tool.radius:
            clouds.append(cloud)
    return tuple(_distance(face, cloud) for cloud in clouds)


def _distance(face: Face, cloud: Array) -> Callable[[Array], Array]:
    from scipy.spatial import cKDTree

    tree = cKDTree(cloud)
    return lambda uv: np.asarray(tree.query(face.evaluate(uv).point)[0])


def _from_cloud(cloud: Array, points: Array) -> Array:
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(cloud).query(points)[0])


def _along(foot: Array, spacing: float) -> Array:
    """Points along a closed polygon."""
    ends = np.roll(foot, -1, axis=0)
    parts = np.maximum(np.ceil(np.linalg.norm(ends - foot, axis=1) / spacing), 1).astype(int)
    share = np.concatenate([np.arange(n) / n for n in parts])[:, None]
    return np.repeat(foot, parts, axis=0) * (1 - share) + np.repeat(ends, parts, axis=0) * share


def _spread(face: Face, spacing: float) -> Array:
    """Points over a face and along its border."""
    count = int(np.clip(face.diagonal / spacing, 8, _MOST))
    rows = [face.evaluate(face.grid(count, count)).point]
    rows += [_along(face.evaluate(loop).point, spacing) for loop in face.outline]
    return np.concatenate(rows)


def _touching(faces: Sequence[Face], reach: float) -> list[list[Face]]:
    """Faces in groups whose borders touch."""
    groups: list[tuple[list[Face], Array]] = []
    for face in faces:
        border = np.concatenate([_along(face.evaluate(loop).point, face.diagonal / 100) for loop in face.outline])
        slack = reach + face.diagonal / 100
        own, members = border, [face]
        for group in [one for one in groups if _from_cloud(one[1], border).min() < slack]:
            groups.remove(group)
            members, own = group[0] + members, np.concatenate([group[1], own])
        groups.append((members, own))
    return [members for members, _ in groups]
