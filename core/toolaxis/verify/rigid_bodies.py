"""Rigid things on a machine: points on their skins, and the distance of other points from them."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from toolaxis.machine.bodies import MachineBody
from toolaxis.numeric.vectors import lengths
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]

#: Points on the skin of one thing, about, and their least distance, mm.
_POINTS, _APART = 12_000, 1.5
#: Parts of a turn around a turned body, and of the arc of a cutter.
_AROUND, _ARC = 72, 16
#: Points that are made exact at a time.
_BATCH = 256


@dataclass(frozen=True, eq=False)
class RigidBody:
    """Something rigid on a machine, with all axes at zero.

    Attributes
    ----------
    name : str
    carried : str
        Name of the axis that carries it, or "bed".
    points : (n, 3) array
        On its skin, machine coordinates, mm.
    spacing : float
        Greatest distance of a place on the skin from the next point, mm, about.
    inside : callable, optional
        Distance of (n, 3) points from it, negative inside, mm; None for faces, which enclose nothing by themselves.
    labels : tuple of str
        What each point belongs to, where that is more than the name tells.
    """

    name: str
    carried: str
    points: Array
    spacing: float
    inside: Callable[[Array], Array] | None
    labels: tuple[str, ...] = ()


def body_thing(body: MachineBody) -> RigidBody:
    """A body of a machine with points on its skin.

    Parameters
    ----------
    body : MachineBody
        A box, a cylinder, or the rounded hull of points.
    """
    if body.kind == "cylinder":
        low, high = body.points
        height = float(np.linalg.norm(high - low))
        line = np.array([[body.radius, 0.0], [body.radius, height]])
        return revolve_rigid_body(body.name, body.carried, line, low, (high - low) / height)
    corners = body.points
    if body.kind == "box":
        sides = np.sort(body.points, axis=0).T
        corners = np.array(np.meshgrid(*sides)).reshape(3, -1).T
    hull = ConvexHull(corners)
    planes = hull.equations
    triangles = corners[hull.simplices]
    points, spacing = _on_triangles(triangles)
    points_of_each = len(points) // len(triangles)
    normals = np.repeat(planes[:, :3], points_of_each, axis=0)
    points = points + body.radius * normals  # round edges are met by the distance from the others' points

    def _inside(rows: Array) -> Array:
        return _from_hull(rows, planes, triangles) - body.radius

    return RigidBody(body.name, body.carried, points, spacing, _inside)


def _from_hull(points: Array, planes: Array, triangles: Array) -> Array:
    """Distance of points from a hull with planes (n, 4) of triangles, negative inside: exact where it may be least."""
    found = (points @ planes[:, :3].T + planes[:, 3]).max(axis=1)
    order = np.argsort(found, kind="stable")
    for first in range(0, len(points), _BATCH):  # outside that is too little: made exact, the nearest first
        after = first + _BATCH
        some = order[first:after]
        some = some[found[some] > 0]
        found[some] = _from_triangles(points[some], triangles)
        if after >= len(points):
            break
        if found[order[:after]].min() <= found[order[after]]:
            break
    return np.asarray(found)


def _from_triangles(points: Array, triangles: Array) -> Array:
    """Distance of points (m, 3) from the nearest of triangles (k, 3, 3)."""
    a = triangles[:, 0]
    edges = np.roll(triangles, -1, axis=1) - triangles
    normal = np.cross(edges[:, 0], edges[:, 1])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal /= np.maximum(size, 1e-30)
    above = np.einsum("mkc,kc->mk", points[:, None] - a, normal)
    over = np.ones(above.shape, dtype=bool)
    aside = np.full(above.shape, np.inf)
    for i in range(3):
        edge = edges[:, i]
        away = points[:, None] - triangles[:, i]
        inwards = np.cross(normal, edge)
        over &= np.einsum("mkc,kc->mk", away, inwards) >= 0
        square = np.maximum((edge**2).sum(axis=1), 1e-30)
        along = np.einsum("mkc,kc->mk", away, edge) / square
        along = np.clip(along, 0.0, 1.0)
        from_edge = lengths(away - along[..., None] * edge)
        aside = np.minimum(aside, from_edge)
    distance = np.where(over, np.abs(above), aside)
    return np.asarray(distance.min(axis=1, initial=np.inf))


def _on_triangles(triangles: Array) -> tuple[Array, float]:
    """Points on triangles (k, 3, 3), as many on each, corners and edges among them, and their distance."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    longest = float(sides.max())
    most = int(np.sqrt(2 * _POINTS / len(triangles)))
    wanted = np.ceil(longest / _APART)
    parts = int(np.clip(wanted, 1, max(most, 1)))
    steps = np.arange(parts + 1)
    i, j = np.meshgrid(steps, steps, indexing="ij")
    keep = i + j <= parts
    a = i[keep] / parts
    b = j[keep] / parts
    weights = np.stack([1 - a - b, a, b], axis=1)
    points = np.einsum("nw,kwc->knc", weights, triangles)
    return points.reshape(-1, 3), longest / parts


def revolve_rigid_body(name: str, carried: str, line: Array, foot: Array, axis: Array) -> RigidBody:
    """A solid of revolution with points on its skin.

    Parameters
    ----------
    name, carried : str
    line : (k, 2) array
        Radius and height above the foot, mm, heights not decreasing.
    foot, axis : (3,) array
        A point and the direction of its axis, machine coordinates.
    """
    bottom = [[0.0, line[0, 1]]]
    top = [[0.0, line[-1, 1]]]
    corners = np.concatenate([bottom, line, top])
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    apart = max(_APART, float(lengths.sum()) * _AROUND / _POINTS)
    sides = []
    for (a, b), size in zip(pairwise(corners), lengths, strict=True):
        places = max(2, int(np.ceil(size / apart)) + 1)
        share = np.linspace(0, 1, places)[:, None]
        sides.append(a + share * (b - a))
    rows = np.concatenate(sides)
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    ring = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    outwards = rows[:, :1, None] * ring[None]
    upwards = rows[:, 1:, None] * axis
    points = foot + (outwards + upwards).reshape(-1, 3)

    def _inside(found: Array) -> Array:
        away = found - foot
        height = away @ axis
        radius = np.linalg.norm(away - height[:, None] * axis, axis=1)
        return _from_line(corners, np.stack([radius, height], axis=1))

    between_rings = 2 * np.pi * float(line[:, 0].max()) / _AROUND
    return RigidBody(name, carried, points, max(apart, between_rings), _inside)


def _from_line(corners: Array, places: Array) -> Array:
    """Distance of places (radius, height) from the area between a polyline and the axis, negative inside."""
    radius, height = places.T
    least = np.full(len(places), np.inf)
    crossings = np.zeros(len(places), dtype=int)
    for (r0, z0), (r1, z1) in pairwise(corners):
        way = np.array([r1 - r0, z1 - z0])
        square = (r1 - r0) ** 2 + (z1 - z0) ** 2
        offset = places - [r0, z0]
        along = np.clip((offset @ way) / max(square, 1e-30), 0.0, 1.0)
        away = lengths(offset - along[:, None] * way)
        least = np.minimum(least, away)
        # A place is inside where a ray outwards from it, at its height, crosses the line an odd number of times.
        begins_below = np.minimum(z0, z1) <= height
        ends_above = height < np.maximum(z0, z1)
        rise = z1 - z0 if z1 != z0 else 1.0
        at = r0 + (height - z0) * (r1 - r0) / rise
        crossings += begins_below & ends_above & (at > radius)
    return np.where(crossings % 2 == 1, -least, least)


def cutter_line(profile: Profile) -> Array:
    """The generatrix of a cutter as a polyline (radius, height above the tip), (k, 2) mm.

    Parameters
    ----------
    profile : Profile
    """
    r = profile.corner_radius
    beta = profile.half_angle
    angle = np.linspace(0.0, np.pi / 2 - beta, _ARC + 1)
    radius = profile.flat_radius + r * np.sin(angle)
    height = r * (1 - np.cos(angle))
    arc = np.stack([radius, height], axis=1)
    end_radius, end_height = arc[-1]
    rise = profile.top - end_height
    top = [end_radius + rise * np.tan(beta), profile.top]
    return np.concatenate([arc, [top]])
