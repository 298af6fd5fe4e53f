"""The least distance between two groups of faces, and the widest cutter that it lets pass."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_GRID, _ROUNDS, _STARTS = 16, 60, 3
#: Two points see each other straight along a normal within this angle, rad.
STRAIGHT = np.radians(0.5)
#: How near a ray passes to what it meets, mm.
_MEETS = 1e-6


class BladeGapPoints(NamedTuple):
    """The two nearest points of a face and of others.

    distance : mm;  here, there : (3,) their places, mm;  number : of the other's face;  straight : whether `there`
    lies straight along the normal of the face at `here`.
    """

    distance: float
    here: Array
    there: Array
    number: int
    straight: bool


def nearness(face: Face, others: Sequence[Face]) -> BladeGapPoints:
    """The two nearest points of a face and of others, by walking downhill from the nearest samples.

    Parameters
    ----------
    face : Face
    others : sequence of Face
        At least one.

    Notes
    -----
    **Properties**: 1. never below the true distance; 2. exact for planes and spheres; 3. moves with the faces.
    """
    from scipy.spatial import cKDTree

    mine = _samples(face)
    points = face.evaluate(mine).point
    best: BladeGapPoints | None = None
    for other in others:
        theirs = _samples(other)
        tree = cKDTree(other.evaluate(theirs).point)
        away, number = tree.query(points)
        between_samples = 0.5 * (face.diagonal + other.diagonal) / _GRID
        if best is not None and away.min() > best.distance + between_samples:
            continue
        nearest_first = np.argsort(away, kind="stable")
        for k in nearest_first[:_STARTS]:
            found = _walk_downhill(face, other, (mine[k], theirs[number[k]]))
            if best is None or found.distance < best.distance:
                best = found
    assert best is not None
    return best


def _samples(face: Face) -> Array:
    border = np.concatenate(face.outline)
    stride = max(1, len(border) // 64)
    return np.concatenate([face.grid(_GRID, _GRID), border[::stride]])


def _walk_downhill(face: Face, other: Face, start: tuple[Array, Array]) -> BladeGapPoints:
    """Downhill in the parameters of both faces from a place on each, and where trims end that, to and fro."""
    here, there = _slid(face, other, start)
    if not (face.contains(here[None])[0] and other.contains(there[None])[0]):
        here, there = _to_and_fro(face, other, face.evaluate(start[0][None]).point)
    a = face.evaluate(here[None]).point[0]
    b = other.evaluate(there[None]).point[0]
    length = float(np.linalg.norm(b - a))
    along_normal = float(face.normal(here[None])[0] @ (b - a))
    straight = length > 0 and along_normal >= length * np.cos(STRAIGHT)
    return BladeGapPoints(length, a, b, other.number, straight)


def _slid(face: Face, other: Face, start: tuple[Array, Array]) -> tuple[Array, Array]:
    """Parameters of two near points from those of a start, trims apart."""
    from scipy.optimize import minimize

    bounds = np.array([*np.reshape(face.bounds, (2, 2)), *np.reshape(other.bounds, (2, 2))])
    low = bounds[:, 0]
    span = np.ptp(bounds, axis=1)

    def _half_square(x: Array) -> tuple[float, Array]:
        at = low + x * span
        a = face.evaluate(at[None, :2])
        b = other.evaluate(at[None, 2:])
        gap = a.point[0] - b.point[0]
        slope = np.array([gap @ a.su[0], gap @ a.sv[0], -gap @ b.su[0], -gap @ b.sv[0]])
        return float(gap @ gap) / 2, slope * span

    first = (np.concatenate(start) - low) / span
    first = np.clip(first, 0.0, 1.0)
    options = {"maxiter": 200, "ftol": 1e-15, "gtol": 1e-10}
    found = minimize(_half_square, first, jac=True, method="L-BFGS-B", bounds=[(0.0, 1.0)] * 4, options=options)
    at = low + found.x * span
    return at[:2], at[2:]


def _to_and_fro(face: Face, other: Face, start: Array) -> tuple[Array, Array]:
    """Nearest points of each on the other until the distance does not fall any more: their parameters."""
    here = nearest(face, start, 12)
    there = nearest(other, here.point, 12)
    last = np.inf
    for _ in range(_ROUNDS):
        distance = there.distance[0]
        if distance > last * (1 - 1e-6):
            break
        last = float(distance)
        here = nearest(face, there.point, 12)
        there = nearest(other, here.point, 12)
    return here.uv[0], there.uv[0]


def ahead(face: Face, others: Sequence[Face]) -> BladeGapPoints | None:
    """The least distance straight along the normals of a face to others, at samples of the face.

    Parameters
    ----------
    face : Face
    others : sequence of Face

    Returns
    -------
    BladeGapPoints, or None where no normal meets another face.

    Notes
    -----
    **Properties**: 1. never below the least distance along a normal, and exact at the place that it names;
    2. moves with the faces.
    """
    mine = _samples(face)
    points = face.evaluate(mine).point
    normals = face.normal(mine)
    best: BladeGapPoints | None = None
    for other in others:
        length, uv = _ray_hits(points, normals, other)
        k = int(np.argmin(length))
        if not np.isfinite(length[k]):
            continue
        if best is None or length[k] < best.distance:
            there = other.evaluate(uv[k:k + 1]).point[0]
            best = BladeGapPoints(float(length[k]), points[k], there, other.number, True)
    return best


def _ray_hits(points: Array, normals: Array, other: Face) -> tuple[Array, Array]:
    """Where rays meet a face, by Newton's method from the samples next to each: length, inf where not, and (u, v)."""
    theirs = _samples(other)
    way = other.evaluate(theirs).point[None] - points[:, None]
    along = np.einsum("ijk,ik->ij", way, normals)
    aside = np.linalg.norm(way - along[..., None] * normals[:, None], axis=2)
    pick = np.where(along > 0, aside, np.inf).argmin(axis=1)
    uv = theirs[pick].copy()
    length = along[np.arange(len(points)), pick]
    low, high = np.reshape(other.bounds, (2, 2)).T
    for _ in range(20):
        d = other.evaluate(uv)
        miss = points + length[:, None] * normals - d.point
        table = np.stack([d.su, d.sv, -normals], axis=2)
        sound = np.abs(np.linalg.det(table)) > 1e-12
        step = np.zeros_like(miss)
        solution = np.linalg.solve(table[sound], miss[sound][..., None])
        step[sound] = solution[..., 0]
        uv = np.clip(uv + step[:, :2], low, high)
        length = length + step[:, 2]
    ends = points + length[:, None] * normals
    off = np.linalg.norm(ends - other.evaluate(uv).point, axis=1)
    hits = (off < _MEETS) & (length > _MEETS) & other.contains(uv)
    return np.where(hits, length, np.inf), uv


def widest(gap: BladeGapPoints, clearance: float) -> float:
    """Diameter of the widest cutter that can machine a place which others stand straight ahead of, mm.

    Parameters
    ----------
    gap : BladeGapPoints
    clearance : float
        What the cutter has to keep from the others, mm.

    Returns
    -------
    float, inf where the gap does not tell: its places do not see each other along the face's normal.

    Notes
    -----
    A cutter in contact reaches its own diameter or more along the surface's normal, with every axis: from a contact at
    radius a + r sin t of a torus (a = R - r, t the angle between axis and normal) the line along the normal leaves it
    on the other side after (a + r sin t + R) / sin t >= 2 R.  So the point straight ahead at a smaller distance lies
    inside the tool.
    """
    return gap.distance - clearance if gap.straight else float("inf")


def reach_along_normal(tool: Tool) -> float:
    """How far a cutter reaches at least along the normal from its contact, mm: its diameter, or what its flutes allow.

    Parameters
    ----------
    tool : Tool
    """
    return min(2 * tool.radius, max(tool.flute_length - tool.corner_radius, 0.0))
