"""Pictures of solids without a display: points splatted into a depth buffer, seen in parallel projection."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.shape.differential import normals
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_MOST = 1400
_LIGHT = unit([-0.35, 0.55, 1.0])


@dataclass(frozen=True, eq=False)
class Camera:
    """A parallel projection.

    Attributes
    ----------
    right, up, back : (3,) array
        Unit vectors of the picture's x and y, and towards the viewer.
    low : (2,) array
        Picture coordinates of the lower left corner, mm.
    pixel : float
        Size of a pixel, mm.
    shape : (int, int)
        Rows and columns.
    """

    right: Array
    up: Array
    back: Array
    low: Array
    pixel: float
    shape: tuple[int, int]

    def project(self, points: Array) -> Array:
        """Picture coordinates and depth (greater is nearer) of (n, 3) points, mm."""
        return np.asarray(points @ np.stack([self.right, self.up, self.back], axis=1))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top, mm."""
        rows, columns = self.shape
        return (float(self.low[0]), float(self.low[0] + columns * self.pixel),
                float(self.low[1]), float(self.low[1] + rows * self.pixel))


def camera(back: ArrayLike, up: ArrayLike, points: Array, pixels: int = 900) -> Camera:
    """A camera that sees all of some points.

    Parameters
    ----------
    back : (3,) array_like
        Direction towards the viewer.
    up : (3,) array_like
        Direction that is upright in the picture.
    points : (n, 3) array
    pixels : int
        Of the longer side.
    """
    z = unit(back)
    x = np.cross(np.asarray(up, dtype=float), z)
    x = unit(x) if np.linalg.norm(x) > 1e-6 else perpendicular(z)[0]
    y = np.cross(z, x)
    flat = points @ np.stack([x, y], axis=1)
    low, high = flat.min(axis=0), flat.max(axis=0)
    margin = 0.03 * float((high - low).max() or 1.0)
    low = low - np.array([margin, 2.5 * margin])  # room for the scale bar
    size = high + margin - low
    pixel = float(size.max()) / pixels
    columns, rows = (int(n) for n in np.ceil(size / pixel))
    return Camera(x, y, z, low, pixel, (rows, columns))


@dataclass(eq=False)
class Canvas:
    """A picture in the making.

    Attributes
    ----------
    camera : Camera
    colour : (rows, columns, 3) array
    depth : (rows, columns) array
        -inf where nothing is drawn yet.
    """

    camera: Camera
    colour: Array = field(init=False)
    depth: Array = field(init=False)

    def __post_init__(self) -> None:
        self.colour = np.ones((*self.camera.shape, 3))
        self.depth = np.full(self.camera.shape, -np.inf)

    def splat(self, points: Array, directions: Array, colour: tuple[float, float, float]) -> None:
        """Draw a surface given densely by points, shaded from either side.

        Parameters
        ----------
        points, directions : (n, 3) array
            Points and normals.
        colour : (float, float, float)
            Red, green and blue, 0 to 1.
        """
        flat = self.camera.project(points)
        column, row = (np.floor((flat[:, k] - self.camera.low[k]) / self.camera.pixel).astype(np.int64) for k in (0, 1))
        rows, columns = self.camera.shape
        seen = np.flatnonzero((column >= 0) & (row >= 0) & (column < columns) & (row < rows))
        cell, depth = row[seen] * columns + column[seen], flat[seen, 2]
        before = self.depth.reshape(-1)
        nearest = before.copy()
        np.maximum.at(nearest, cell, depth)
        # Of points that lie equally near in one pixel the last one is seen.
        front = np.flatnonzero((depth == nearest[cell]) & (depth > before[cell]))
        light = 0.45 + 0.55 * np.abs(self._lit(directions[seen[front]]))
        before[cell[front]] = depth[front]
        self.colour.reshape(-1, 3)[cell[front]] = light[:, None] * np.asarray(colour)

    def close(self) -> None:
        """Fill single pixels that splats have missed from their neighbours."""
        depth = self.depth
        for axis in (0, 1):
            before, after = np.roll(depth, 1, axis), np.roll(depth, -1, axis)
            least = np.minimum(before, after)
            gap = np.isfinite(least) & (depth < least - 3 * self.camera.pixel)
            self.colour[gap] = 0.5 * (np.roll(self.colour, 1, axis) + np.roll(self.colour, -1, axis))[gap]
            depth[gap] = least[gap]

    def _lit(self, directions: Array) -> Array:
        light = np.stack([self.camera.right, self.camera.up, self.camera.back], axis=1) @ _LIGHT
        return np.asarray(directions @ light)

    def blend(self, other: "Canvas", share: float) -> None:
        """Lay another canvas over this one, half transparent, where it is nearer.

        Parameters
        ----------
        other : Canvas
        share : float
            How much of the other one shows, 0 to 1.
        """
        front = other.depth > self.depth
        self.colour[front] = share * other.colour[front] + (1 - share) * self.colour[front]

    def visible(self, points: Array, slack: float) -> NDArray[np.bool_]:
        """Whether (n, 3) points are not behind what is drawn by more than a slack in mm, (n,)."""
        flat = self.camera.project(points)
        return np.asarray(flat[:, 2] >= self.depth_at(flat[:, :2]) - slack)

    def depth_at(self, flat: Array) -> Array:
        """Depth of what is drawn at picture coordinates (n, 2), mm; that of the nearest pixel outside the picture."""
        pixels = np.floor((flat - self.camera.low) / self.camera.pixel).astype(np.int64)
        rows, columns = self.camera.shape
        column = np.clip(pixels[:, 0], 0, columns - 1)
        row = np.clip(pixels[:, 1], 0, rows - 1)
        return np.asarray(self.depth[row, column])


def points_on(faces: Iterable[Face]) -> Array:
    """Points between which all of some faces lies, (n, 3) mm: of their borders, and inside, where a closed one bulges.

    Parameters
    ----------
    faces : iterable of Face
    """
    points = []
    for face in faces:
        on_face = (*face.outline, face.grid(24, 24))
        points += [face.evaluate(uv).point for uv in on_face]
    return np.concatenate(points)


def face_splats(face: Face, seen: Camera) -> tuple[Array, Array]:
    """Points and normals of a face, dense enough to leave no gap in the picture.

    Parameters
    ----------
    face : Face
    seen : Camera

    Returns
    -------
    points, normals : (n, 3) array
    """
    counts = np.ceil(1.3 * _lengths(face) / seen.pixel)
    along, across = np.clip(counts, 8, _MOST).astype(int)
    dense = face.evaluate(face.grid(along, across))
    return dense.point, normals(dense, face.flip)


_LENGTHS: WeakKeyDictionary[Face, Array] = WeakKeyDictionary()


def _lengths(face: Face) -> Array:
    """Greatest lengths of a face along u and along v, (2,) mm: the same in every picture, so measured once."""
    if face not in _LENGTHS:
        u0, u1, v0, v1 = face.bounds
        coarse = face.grid(24, 24)
        middle = [((u0 + u1) / 2, (v0 + v1) / 2)]
        d = face.evaluate(coarse if len(coarse) else middle)
        rates = np.linalg.norm([d.su, d.sv], axis=2).max(axis=1)
        _LENGTHS[face] = rates * np.array([u1 - u0, v1 - v0])
    return _LENGTHS[face]


def splats_of_revolution(outline: Array, tip: Array, axis: Array, pixel: float) -> tuple[Array, Array]:
    """Points and normals of a solid of revolution.

    Parameters
    ----------
    outline : (k, 2) array
        (radius, z) rows.
    tip, axis : (3,) array
        Where z is zero, and the direction of z.
    pixel : float
        Size of a pixel, mm.
    """
    x, y = perpendicular(axis)
    count_around = int(np.clip(np.ceil(10 * outline[:, 0].max() / pixel), 24, 3 * _MOST))
    around = np.linspace(0, 2 * np.pi, count_around, endpoint=False)
    ring = np.cos(around)[:, None] * x + np.sin(around)[:, None] * y
    points, directions = [], []
    for (r0, z0), (r1, z1) in pairwise(outline):
        length = float(np.hypot(r1 - r0, z1 - z0))
        if length == 0:
            continue
        count_along = int(np.clip(np.ceil(1.6 * length / pixel), 2, _MOST))
        share = np.linspace(0, 1, count_along)
        radius = r0 + share * (r1 - r0)
        z = z0 + share * (z1 - z0)
        rings = radius[:, None, None] * ring + z[:, None, None] * axis
        points.append(rings.reshape(-1, 3) + tip)
        normal = (z1 - z0) / length * ring - (r1 - r0) / length * axis
        directions.append(np.broadcast_to(normal, (count_along, *normal.shape)).reshape(-1, 3))
    return np.concatenate(points), np.concatenate(directions)


def tool_outlines(tool: Tool, reach: float) -> dict[str, Array]:
    """Closed outlines of cutter, shank and holder for drawing, (radius, z from the tip) in mm.

    Parameters
    ----------
    tool : Tool
    reach : float
        Where a shank of unknown length ends in the picture, mm.
    """
    cutter = tool.profile.polyline(0.002 * tool.radius)
    outlines = {"cutter": np.vstack([cutter, [0.0, cutter[-1, 1]]])}
    for name, line in tool.outlines.items():
        outlines[name] = np.vstack([[0.0, line[0, 1]], line, [0.0, line[-1, 1]]])
    if "shank" not in outlines and tool.stickout is None and reach > cutter[-1, 1]:
        radius = tool.profile.top_radius
        outlines["shank (not given)"] = np.array([[radius, cutter[-1, 1]], [radius, reach]])
    return outlines


def visible_runs(canvas: Canvas, line: Array, slack: float) -> list[Array]:
    """The parts of a polyline that are not hidden, in picture coordinates.

    Parameters
    ----------
    canvas : Canvas
    line : (n, 3) array
    slack : float
        mm

    Returns
    -------
    list of (m, 2) arrays
    """
    steps = np.diff(line, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    count = np.clip(np.ceil(lengths / (2 * canvas.camera.pixel)).astype(int), 1, 4000)
    owner, part = number_parts(count)
    share = (part / count[owner])[:, None]
    dense = np.vstack([line[owner] + share * steps[owner], line[-1:]])
    seen = canvas.visible(dense, slack)
    flat = canvas.camera.project(dense)[:, :2]
    cuts = np.flatnonzero(np.diff(seen)) + 1
    return [run for run, shown in zip(np.split(flat, cuts), np.split(seen, cuts), strict=True)
            if shown[0] and len(run) > 1]


def camera_onto(directions: Array, points: Array, pixels: int = 900) -> Camera:
    """The camera that looks along the mean of some normals and sees all of some points.

    Parameters
    ----------
    directions : (k, 3) array
        Unit normals.
    points : (n, 3) array
    pixels : int
        Of the longer side.
    """
    normal = mean_direction(directions)
    up = [0.0, 0.0, 1.0] if abs(normal[2]) < 0.9 else [0.0, 1.0, 0.0]
    return camera(normal, up, points, pixels)


def mean_direction(directions: Array) -> Array:
    """Mean of (n, 3) unit vectors, (3,); the first one where they cancel."""
    mean = directions.sum(axis=0)
    return unit(mean) if np.linalg.norm(mean) > 1e-6 * len(directions) else unit(directions[0])

