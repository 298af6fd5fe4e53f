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
        corners = np.array(np.meshgrid(*np.sort(body.points, axis=0).T)).reshape(3, -1).T
    hull = ConvexHull(corners)
    triangles = corners[hull.simplices]
    points, spacing = _on_triangles(triangles)
    normals = np.repeat(hull.equations[:, :3], len(points) // len(triangles), axis=0)
    points = points + body.radius * normals  # round edges are met by the distance from the others' points

    def _inside(rows: Array) -> Array:
        found = (rows @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
        order = np.argsort(found, kind="stable")
        for first in range(0, len(rows), _BATCH):  # outside that is too little: made exact, the nearest first
            some = order[first:first + _BATCH]
            some = some[found[some] > 0]
            found[some] = _from_triangles(rows[some], triangles)
            if first + _BATCH >= len(rows) or found[order[:first + _BATCH]].min() <= found[order[first + _BATCH]]:
                break
        return np.asarray(found - body.radius)

    return RigidBody(body.name, body.carried, points, spacing, _inside)


def _from_triangles(points: Array, triangles: Array) -> Array:
    """Distance of points (m, 3) from the nearest of triangles (k, 3, 3)."""
    a = triangles[:, 0]
    edges = np.roll(triangles, -1, axis=1) - triangles
    normal = np.cross(edges[:, 0], edges[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    above = np.einsum("mkc,kc->mk", points[:, None] - a, normal)
    over = np.ones(above.shape, dtype=bool)
    aside = np.full(above.shape, np.inf)
    for i in range(3):
        away = points[:, None] - triangles[:, i]
        over &= np.einsum("mkc,kc->mk", away, np.cross(normal, edges[:, i])) >= 0
        size = np.maximum((edges[:, i] ** 2).sum(axis=1), 1e-30)
        along = np.clip(np.einsum("mkc,kc->mk", away, edges[:, i]) / size, 0.0, 1.0)
        aside = np.minimum(aside, lengths(away - along[..., None] * edges[:, i]))
    return np.asarray(np.where(over, np.abs(above), aside).min(axis=1, initial=np.inf))


def _on_triangles(triangles: Array) -> tuple[Array, float]:
    """Points on triangles (k, 3, 3), as many on each, corners and edges among them, and their distance."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    longest = float(sides.max())
    most = int(np.sqrt(2 * _POINTS / len(triangles)))
    count = int(np.clip(np.ceil(longest / _APART), 1, max(most, 1)))
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    keep = i + j <= count
    a, b = i[keep] / count, j[keep] / count
    weights = np.stack([1 - a - b, a, b], axis=1)
    return np.einsum("nw,kwc->knc", weights, triangles).reshape(-1, 3), longest / count


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
    corners = np.concatenate([[[0.0, line[0, 1]]], line, [[0.0, line[-1, 1]]]])
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    apart = max(_APART, float(lengths.sum()) * _AROUND / _POINTS)
    rows = np.concatenate([a + np.linspace(0, 1, max(2, int(np.ceil(size / apart)) + 1))[:, None] * (b - a)
                           for (a, b), size in zip(pairwise(corners), lengths, strict=True)])
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    ring = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    points = foot + (rows[:, :1, None] * ring[None] + rows[:, 1:, None] * axis).reshape(-1, 3)

    def _inside(found: Array) -> Array:
        away = found - foot
        height = away @ axis
        radius = np.linalg.norm(away - height[:, None] * axis, axis=1)
        return _from_line(corners, np.stack([radius, height], axis=1))

    return RigidBody(name, carried, points, max(apart, 2 * np.pi * float(line[:, 0].max()) / _AROUND), _inside)


def _from_line(corners: Array, places: Array) -> Array:
    """Distance of places (radius, height) from the area between a polyline and the axis, negative inside."""
    least = np.full(len(places), np.inf)
    crossings = np.zeros(len(places), dtype=int)
    for (r0, z0), (r1, z1) in pairwise(corners):
        way = np.array([r1 - r0, z1 - z0])
        size = (r1 - r0) ** 2 + (z1 - z0) ** 2
        offset = places - [r0, z0]
        along = np.clip((offset @ way) / max(size, 1e-30), 0.0, 1.0)
        least = np.minimum(least, lengths(offset - along[:, None] * way))
        # A place is inside where a ray outwards from it, at its height, crosses the line an odd number of times.
        radius, height = places.T
        between = (np.minimum(z0, z1) <= height) & (height < np.maximum(z0, z1))
        rise = z1 - z0 if z1 != z0 else 1.0
        at = r0 + (height - z0) * (r1 - r0) / rise
        crossings += between & (at > radius)
    return np.where(crossings % 2 == 1, -least, least)


def cutter_line(profile: Profile) -> Array:
    """The generatrix of a cutter as a polyline (radius, height above the tip), (k, 2) mm.

    Parameters
    ----------
    profile : Profile
    """
    a, r, beta = profile.flat_radius, profile.corner_radius, profile.half_angle
    angle = np.linspace(0.0, np.pi / 2 - beta, _ARC + 1)
    arc = np.stack([a + r * np.sin(angle), r * (1 - np.cos(angle))], axis=1)
    end_radius, end_height = arc[-1]
    rise = profile.top - end_height
    top = [end_radius + rise * np.tan(beta), profile.top]
    return np.concatenate([arc, [top]])
