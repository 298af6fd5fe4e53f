"""Area and box of a trimmed face."""

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.polygons import chords, stations, walk
from toolaxis.numeric.roots import least_between

if TYPE_CHECKING:
    from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Panels over the range of v, pieces over the range of u, and Gauss points in each.
PANELS, PIECES, POINTS = 48, 6, 4

#: Samples along each side of the face in the search of its extremes.
SAMPLES = 48


def area(face: "Face") -> float:
    """Area, mm^2, by Gauss points on the chords that lines v = const cut out of the trim loops.

    The relative error is below 1e-5 where the loops have corners or smooth ends, and much below on smooth surfaces
    with straight borders.

    Parameters
    ----------
    face : Face
    """
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    u0, u1, v0, v1 = face.bounds
    lines = _breaks(v0, v1, face.surface.knots_v, face.outline)
    cuts_u = _cuts(face.surface.knots_u, np.linspace(u0, u1, PIECES + 1))
    table = []
    for low, high in pairwise(lines.tolist()):
        for node, weight in zip(nodes, weights, strict=True):
            v = 0.5 * (low + high) + 0.5 * (high - low) * node
            table += [(v, 0.5 * (high - low) * weight, a, b) for x0, x1 in chords(face.outline, v)
                      for a, b in _pieces(cuts_u, x0, x1)]
    v, share, a, b = np.array(table).T
    u = 0.5 * (a + b)[:, None] + 0.5 * (b - a)[:, None] * nodes
    d = face.evaluate(np.stack([u, np.broadcast_to(v[:, None], u.shape)], axis=-1).reshape(-1, 2))
    size = np.linalg.norm(np.cross(d.su, d.sv), axis=1).reshape(u.shape)
    return float(np.sum(size * weights * (0.5 * (b - a) * share)[:, None]))


def _cuts(knots: Array, extra: Array) -> Array:
    """Knots and further values in the range of the latter, each once."""
    inner = knots[(knots > extra[0]) & (knots < extra[-1])]
    return np.unique(np.concatenate([extra, inner[:: max(1, len(inner) // 256)]]))


def _breaks(v0: float, v1: float, knots: Array, loops: tuple[Array, ...]) -> Array:
    """Ends of the panels in v: at knots, at corners unless there are many, and closer towards where a loop ends."""
    ends = np.unique(np.clip([v for loop in loops for v in (loop[:, 1].min(), loop[:, 1].max())] + [v0, v1], v0, v1))
    parts = []
    for a, b in pairwise(ends.tolist()):
        count = max(4, round(PANELS * (b - a) / (v1 - v0)))
        parts.append(0.5 * (a + b) - 0.5 * (b - a) * np.cos(np.linspace(0.0, np.pi, count + 1)))
    corners = np.concatenate([loop[:, 1] for loop in loops])
    return _cuts(knots, np.unique(np.clip(np.concatenate([*parts, corners if len(corners) <= 64 else []]), v0, v1)))


def _pieces(cuts: Array, low: float, high: float) -> list[tuple[float, float]]:
    inner = cuts[(cuts > low) & (cuts < high)]
    ends = [low, *inner.tolist(), high]
    return list(pairwise(ends))


def box(face: "Face") -> Array:
    """Lower and upper corner, (2, 3) mm, from samples that are refined to the extremes next to them.

    Parameters
    ----------
    face : Face
    """
    sign = np.repeat([-1.0, 1.0], 3)
    axis = np.tile(np.arange(3), 2)
    best = np.max([_inner_extremes(face, axis, sign), *(_border_extremes(face, loop, axis, sign)
                                                        for loop in face.outline)], axis=0)
    return np.stack([-best[:3], best[3:]])


def _inner_extremes(face: "Face", axis: NDArray[np.int64], sign: Array) -> Array:
    """Greatest signed coordinates over a grid, each after Newton steps as far as they rise and stay on the face."""
    grid = face.grid(SAMPLES, SAMPLES)
    if not len(grid):
        return np.full(len(axis), -np.inf)
    values = face.evaluate(grid).point[:, axis] * sign
    uv, best = grid[values.argmax(axis=0)], values.max(axis=0)
    row = np.arange(len(axis))
    for _ in range(5):
        d = face.evaluate(uv)
        su, sv, suu, suv, svv = (x[row, axis] for x in d[1:])
        determinant = suu * svv - suv**2
        sound = np.abs(determinant) > 1e-12 * (np.abs(suu) + np.abs(suv) + np.abs(svv)) ** 2
        step = np.stack([svv * su - suv * sv, suu * sv - suv * su], axis=1)
        trial = uv - step / np.where(sound, determinant, 1.0)[:, None]
        found = face.evaluate(trial).point[row, axis] * sign
        better = sound & (found > best) & face.contains(trial)
        uv, best = np.where(better[:, None], trial, uv), np.where(better, found, best)
    return np.asarray(best)


def _border_extremes(face: "Face", loop: Array, axis: NDArray[np.int64], sign: Array) -> Array:
    u0, u1, v0, v1 = face.bounds
    position = stations(loop, ((u1 - u0) / SAMPLES, (v1 - v0) / SAMPLES))
    values = face.evaluate(walk(loop, position)).point[:, axis] * sign
    best = values.argmax(axis=0)
    low = np.where(best > 0, position[best - 1], position[-1] - len(loop))
    high = np.append(position, len(loop))[best + 1]
    row = np.arange(len(axis))

    def height(at: Array) -> Array:
        return np.asarray(-face.evaluate(walk(loop, at)).point[row, axis] * sign)

    _, before = least_between(height, low, position[best])
    _, after = least_between(height, position[best], high)
    return -np.minimum(before, after)
