"""Area, mean width and box of a trimmed face."""

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.golden_section import least_between
from toolaxis.numeric.polygons import signed_area, stations, walk
from toolaxis.numeric.vectors import lengths

if TYPE_CHECKING:
    from toolaxis.shape.face import Face
    from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]

#: Panels over the range of v, pieces over the range of u, and Gauss points in each.
PANELS, PIECES, POINTS = 48, 12, 4

#: Share of its area by which a plane may be no parallelogram.
_TWISTED = 1e-12

#: Samples along each side of the face in the search of its extremes.
SAMPLES = 48

#: Steps of the search between two samples: to 4e-6 of their distance, and so to far less than that of the height.
_STEPS = 26


def area(face: "Face") -> float:
    """Area, mm^2, as the integral along the trim loops of the area between them and the middle of the u range.

    The relative error is below 1e-6 on smooth surfaces, however many corners the loops have; and areas of pieces add
    up to that of the whole to rounding where their loops share edges.

    Parameters
    ----------
    face : Face
    """
    density = _even_density(face.surface)
    if density is not None:
        def size(loop: Array) -> float:
            return density * abs(signed_area(loop))
    else:
        cuts = _panels(face)

        def size(loop: Array) -> float:
            return abs(_area_inside(face, loop, cuts))
    total = 0.0
    for loops in outer_with_holes(face.outline) if len(face.outline) > 1 else [face.outline]:
        sizes = [size(loop) for loop in loops]
        total += float(sizes[0] - sum(sizes[1:]))
    return total


def _panels(face: "Face") -> tuple[Array, Array]:
    """Lines of constant u and of constant v between which the area is integrated."""
    u0, u1, v0, v1 = face.bounds
    breaks_u, breaks_v = face.surface.breaks
    return _cuts(breaks_u, np.linspace(u0, u1, PIECES + 1)), _breaks(v0, v1, breaks_v, face.outline[:1])


def _even_density(surface: "NurbsSurface") -> float | None:
    """Area for a unit of both parameters of a parallelogram, as planes are; None for other surfaces."""
    if surface.control.shape[:2] != (2, 2) or np.ptp(surface.control[..., 3]) > 0:
        return None
    corners = surface.control[..., :3] / surface.control[..., 3:]
    along = corners[1, 0] - corners[0, 0]
    across = corners[0, 1] - corners[0, 0]
    twist = corners[1, 1] - corners[0, 0] - along - across
    size = float(np.linalg.norm(np.cross(along, across)))
    longest = max(np.abs(along).max(), np.abs(across).max())
    if np.abs(twist).max() * longest > _TWISTED * size:
        return None
    (u0, u1), (v0, v1) = surface.domain
    return size / ((u1 - u0) * (v1 - v0))


def _area_inside(face: "Face", loop: Array, cuts: tuple[Array, Array]) -> float:
    """Area inside a closed polygon, positive where it runs anticlockwise in the parameters."""
    start, end = _cut_polygon(loop, cuts)
    cuts_u, cuts_v = cuts
    moved = start[:, 1] != end[:, 1]
    start = start[moved]
    end = end[moved]
    short = np.abs(end - start)[:, 1] < (cuts_v[-1] - cuts_v[0]) / 256
    total = 0.0
    for rows, points in ((short, 2), (~short, POINTS)):
        nodes, weights = np.polynomial.legendre.leggauss(points)
        a = start[rows, None]
        b = end[rows, None]
        uv = (a + b) / 2 + (b - a) / 2 * nodes[:, None]
        height = (b - a)[..., 1] / 2 * weights
        beside = _up_to(face, uv.reshape(-1, 2), cuts_u).reshape(height.shape)
        total += float((beside * height).sum())
    return total


def _cut_polygon(loop: Array, cuts: tuple[Array, Array]) -> tuple[Array, Array]:
    """Starts and ends of the parts of a closed polygon between lines of constant u and of constant v."""
    way = np.roll(loop, -1, axis=0) - loop
    edges = [np.arange(len(loop))]
    shares = [np.zeros(len(loop))]
    for axis in (0, 1):
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (cuts[axis] - loop[:, axis, None]) / way[:, axis, None]
        edge, at = np.nonzero((share > 0) & (share < 1))
        edges.append(edge)
        shares.append(share[edge, at])
    place = np.sort(np.concatenate(edges) + np.concatenate(shares))
    edge = np.minimum(place.astype(np.intp), len(loop) - 1)
    points = loop[edge] + (place - edge)[:, None] * way[edge]
    return points, np.roll(points, -1, axis=0)


def _up_to(face: "Face", uv: Array, cuts: Array) -> Array:
    """Integral of the area for a unit of v, from the middle one of the cuts along u to places, (n,)."""
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    middle = cuts[len(cuts) // 2]
    near = np.clip(uv[:, :1], cuts[:-1], cuts[1:])  # the place, or the end of each piece that is nearer to it
    start = np.where(cuts[:-1] >= middle, cuts[:-1], cuts[1:])
    row, piece = np.nonzero(near != start)
    half = (near[row, piece] - start[piece]) / 2
    middles = start[piece] + half
    u = middles[:, None] + half[:, None] * nodes
    v = np.broadcast_to(uv[row, 1:], u.shape)
    d = face.evaluate(np.stack([u, v], axis=-1).reshape(-1, 2))
    size = lengths(np.cross(d.su, d.sv)).reshape(u.shape)
    areas = (size * weights).sum(axis=1) * half
    return np.asarray(np.bincount(row, weights=areas, minlength=len(uv)))


def _cuts(knots: Array, extra: Array) -> Array:
    """Knots and further values in the range of the latter, each once."""
    inner = knots[(knots > extra[0]) & (knots < extra[-1])]
    return np.unique(np.concatenate([extra, inner[:: max(1, len(inner) // 256)]]))


def _breaks(v0: float, v1: float, knots: Array, loops: tuple[Array, ...]) -> Array:
    """Ends of the panels in v: at knots, at corners unless there are many, and closer towards where a loop ends."""
    heights = [loop[:, 1] for loop in loops]
    ranges = [v for height in heights for v in (height.min(), height.max())]
    ends = np.unique(np.clip([*ranges, v0, v1], v0, v1))
    parts = []
    for a, b in pairwise(ends.tolist()):
        count = max(4, round(PANELS * (b - a) / (v1 - v0)))
        parts.append(0.5 * (a + b) - 0.5 * (b - a) * np.cos(np.linspace(0.0, np.pi, count + 1)))
    corners = np.concatenate(heights)
    if len(corners) <= 64:
        parts.append(corners)
    return _cuts(knots, np.unique(np.clip(np.concatenate(parts), v0, v1)))


def mean_width(face: "Face") -> float:
    """Width of a long face on the mean, mm: twice the area over the length of its border, to 1 %.

    Parameters
    ----------
    face : Face
    """
    u0, u1, v0, v1 = face.bounds
    step = ((u1 - u0) / SAMPLES, (v1 - v0) / SAMPLES)
    length = 0.0
    for loop in face.outline:
        points = face.evaluate(walk(loop, stations(loop, step))).point
        length += float(np.linalg.norm(points - np.roll(points, -1, axis=0), axis=1).sum())
    return 2 * face.area / length if length > 0 else 0.0


def box(face: "Face") -> Array:
    """Lower and upper corner, (2, 3) mm, from samples that are refined to the extremes next to them.

    Parameters
    ----------
    face : Face
    """
    sign = np.repeat([-1.0, 1.0], 3)
    axis = np.tile(np.arange(3), 2)
    found = [_border_extremes(face, loop, axis, sign) for loop in face.outline]
    best = np.max([_inner_extremes(face, axis, sign), *found], axis=0)
    return np.stack([-best[:3], best[3:]])


def _inner_extremes(face: "Face", axis: NDArray[np.int64], sign: Array) -> Array:
    """Greatest signed coordinates over a grid, each after Newton steps as far as they rise and stay on the face."""
    grid = face.grid(SAMPLES, SAMPLES)
    if not len(grid):
        return np.full(len(axis), -np.inf)
    values = face.evaluate(grid).point[:, axis] * sign
    uv = grid[values.argmax(axis=0)]
    best = values.max(axis=0)
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
        uv = np.where(better[:, None], trial, uv)
        best = np.where(better, found, best)
    return np.asarray(best)


def _border_extremes(face: "Face", loop: Array, axis: NDArray[np.int64], sign: Array) -> Array:
    """Greatest signed coordinates along a loop, each between the neighbours of the greatest sample."""
    u0, u1, v0, v1 = face.bounds
    position = stations(loop, ((u1 - u0) / SAMPLES, (v1 - v0) / SAMPLES))
    values = face.evaluate(walk(loop, position)).point[:, axis] * sign
    best = values.argmax(axis=0)
    before = np.where(best > 0, position[best - 1], position[-1] - len(loop))
    behind = np.append(position, len(loop))[best + 1]
    low = np.concatenate([before, position[best]])
    high = np.concatenate([position[best], behind])
    row = np.arange(len(low))
    towards = np.tile(axis, 2)
    opposite = -np.tile(sign, 2)

    def depth(at: Array) -> Array:
        return np.asarray(face.evaluate(walk(loop, at)).point[row, towards] * opposite)

    _, least = least_between(depth, low, high, _STEPS)
    return np.asarray(-least.reshape(2, -1).min(axis=0))
