"""How faces meet: smoothly, over a convex edge, or in a concave corner."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import angle_between, dot
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

SMOOTH = radians(1.0)
KNIFE = 1e-3


@dataclass(frozen=True, eq=False)
class Border:
    """A curve along which two faces meet.

    Attributes
    ----------
    faces : (int, int)
        Numbers; twice the same at a seam.
    points : (m, 3) array
        Along the curve, mm.
    first, second : (m, 2) array
        The same places in the parameters of either face.
    left, second_left : bool
        The first (second) face lies left of the direction of the points, seen from the side to which its own Su x Sv
        points.
    """

    faces: tuple[int, int]
    points: Array
    first: Array
    second: Array
    left: bool
    second_left: bool


@dataclass(frozen=True, eq=False)
class Edge:
    """Where two faces of a part meet.

    Attributes
    ----------
    faces : (int, int)
        Numbers; twice the same where a closed face meets itself with a kink.
    kind : str
        "tangent", "convex" (the material's angle is below 180 degrees) or "concave".
    polyline : (m, 3) array
        Points along the edge, mm.
    angle : float
        Greatest angle between the two normals along the edge, rad.
    gap : (m,) array
        How far the two faces' own borders lie beside each other at the polyline's points, mm; empty where that is not
        known.
    step : (m, 2) array
        How far there the border of the first face stands out over the second one, along that one's normal, and the
        second over the first, mm; negative where it lies below.
    """

    faces: tuple[int, int]
    kind: str
    polyline: Array
    angle: float = 0.0
    gap: Array = field(default_factory=lambda: np.empty(0))
    step: Array = field(default_factory=lambda: np.empty((0, 2)))


def edges_from_borders(faces: Sequence[Face], borders: Sequence[Border], smooth: float = SMOOTH) -> tuple[Edge, ...]:
    """Tell tangent, convex and concave edges apart by the normals along them.

    Where the material of the second face is on the wrong side (an open shell with mixed senses), the first one decides.

    Parameters
    ----------
    faces : sequence of Face
    borders : sequence of Border
    smooth : float
        Greatest angle between the normals of a tangent edge, rad.

    Returns
    -------
    tuple of Edge
        One for each border, smooth seams left out.

    **Properties**: 1. exchanging the two faces changes nothing; 2. nor does turning the part round.
    """
    by_number = {face.number: face for face in faces}
    normals = _on_both_sides(by_number, borders, Face.normal)
    points = _on_both_sides(by_number, borders, _points_at)
    edges = []
    for k, border in enumerate(borders):
        one, other = border.faces
        first = by_number[one]
        second = by_number[other]
        in_second = k + len(borders)
        sense = 1.0 if consistent(border, first, second) else -1.0
        both = (normals[k], normals[in_second] * sense)
        kind, angle = _kind(border, border.left ^ first.flip, both, smooth)
        if one == other and kind == "tangent":
            continue
        gap, step = _mismatch(border.points, points[k] - points[in_second], both)
        edges.append(Edge(border.faces, kind, border.points, angle, gap, step))
    return tuple(edges)


def _points_at(face: Face, uv: Array) -> Array:
    return face.evaluate(uv).point


def _mismatch(curve: Array, apart: Array, normals: tuple[Array, Array]) -> tuple[Array, Array]:
    """Distance of two borders beside each other, and how far either stands out over the other's face, mm.

    Parameters
    ----------
    curve : (m, 3) array
        The edge, mm.
    apart : (m, 3) array
        From the second border to the first one, mm.
    normals : tuple of (m, 3) arrays
        Of the first face and of the second one.
    """
    first_normal, second_normal = normals
    across = _across(apart, curve)
    first_over_second = dot(across, second_normal)
    second_over_first = -dot(across, first_normal)
    step = np.stack([first_over_second, second_over_first], axis=1)
    return np.linalg.norm(across, axis=1), step


def consistent(border: Border, first: Face, second: Face) -> bool:
    """Whether two faces that meet have their material on the same side.

    Parameters
    ----------
    border : Border
    first, second : Face
        The border's faces, in its order.
    """
    return (border.left ^ first.flip) != (border.second_left ^ second.flip)


def gaps(faces: Sequence[Face], borders: Sequence[Border]) -> Array:
    """How far the curves lie beside the same places on their faces at worst, mm, (n,) for n borders.

    Parameters
    ----------
    faces : sequence of Face
    borders : sequence of Border
    """
    by_number = {face.number: face for face in faces}
    points = _on_both_sides(by_number, borders, _points_at)
    worst = []
    for side, border in zip(points, [*borders, *borders], strict=True):
        across = _across(side - border.points, border.points)
        worst.append(np.linalg.norm(across, axis=1).max())
    of_both_sides = np.array(worst).reshape(2, -1)
    return np.asarray(of_both_sides.max(axis=0))


def _across(away: Array, curve: Array) -> Array:
    """Vectors at the points of a curve without their share along it."""
    along = np.gradient(curve, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True).clip(1e-300)
    share = dot(away, along)
    return np.asarray(away - share[:, None] * along)


def _on_both_sides(faces: dict[int, Face], borders: Sequence[Border],
                   what: Callable[[Face, Array], Array]) -> list[Array]:
    """Something (k, 3) along all borders in their first faces, then in their second, with one evaluation a face."""
    sides = [(border.faces[0], border.first) for border in borders]
    sides += [(border.faces[1], border.second) for border in borders]
    result: list[Array] = [np.empty((0, 3))] * len(sides)
    members: dict[int, list[int]] = {}
    for k, (number, _) in enumerate(sides):
        members.setdefault(number, []).append(k)
    for number, rows in members.items():
        places = [sides[k][1] for k in rows]
        values = what(faces[number], np.concatenate(places))
        cuts = np.cumsum([len(one) for one in places])[:-1]
        for k, part in zip(rows, np.split(values, cuts), strict=True):
            result[k] = part
    return result


def _kind(border: Border, left: bool, normals: tuple[Array, Array], smooth: float) -> tuple[str, float]:
    one, other = normals
    along = np.gradient(border.points, axis=0)
    has_normals = (np.linalg.norm(one, axis=1) > 0.5) & (np.linalg.norm(other, axis=1) > 0.5)
    sound = has_normals & (np.linalg.norm(along, axis=1) > 0)
    if not sound.any():
        return "tangent", 0.0
    one = one[sound]
    other = other[sound]
    along = along[sound]
    angle = float(angle_between(one, other).max())
    if angle <= smooth:
        return "tangent", angle
    sense = 1.0 if left else -1.0
    inward = sense * np.cross(one, along)
    inward /= np.linalg.norm(inward, axis=1, keepdims=True).clip(1e-300)
    rise = float(dot(inward, other).mean())
    return ("concave" if rise > KNIFE else "convex"), angle
