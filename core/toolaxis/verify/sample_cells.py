"""Faces as cells: points with the radius of what they stand for, split where a closer look is wanted."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.parts import number_parts
from toolaxis.shape.face import Face
from toolaxis.verify.kept import SizedCache
from toolaxis.verify.spatial_blocks import Blocks, blocks_of

Array = NDArray[np.float64]

#: Cells along one parameter of a face at most, at the start; they are split later where it matters.
MOST = 200


@dataclass(frozen=True, eq=False)
class SampleCells:
    """Cells of faces.

    Attributes
    ----------
    owner : (m,) array of int
        Index of the face.
    uv, half : (m, 2) array
        Centre and half the sides (the half way, signed, where the cell is a piece of a trim loop).
    edge : (m,) array of bool
        Whether the cell is a piece of a trim loop.
    point : (m, 3) array
        Centre, mm.
    radius : (m,) array
        Distance within which the cell's part of the face lies, by the derivatives at the centre, mm.
    on_face : (m,) array of bool
        Whether the centre lies on the face.
    value : (m,) array
        Distance of the centre from what is looked for, mm; inf where it was not measured.
    """

    owner: NDArray[np.int64]
    uv: Array
    half: Array
    edge: NDArray[np.bool_]
    point: Array
    radius: Array
    on_face: NDArray[np.bool_]
    value: Array

    def __len__(self) -> int:
        return len(self.owner)

    def rows(self, which: NDArray[np.int64]) -> "SampleCells":
        """Some of the cells.

        Parameters
        ----------
        which : array of int
        """
        return SampleCells(*(getattr(self, one.name)[which] for one in fields(self)))


class SampledFace(NamedTuple):
    """Cells over one face and its borders.

    Attributes
    ----------
    cells : SampleCells
        All of owner 0.
    blocks : Blocks
        Their centres in blocks of neighbours.
    """

    cells: SampleCells
    blocks: Blocks


_KEPT: SizedCache[SampledFace] = SizedCache(100_000_000, lambda one: 150 * len(one.cells))
_AROUND: WeakKeyDictionary[Face, dict[float, Array]] = WeakKeyDictionary()


def face_cells(face: Face, size: float) -> SampledFace:
    """Cells over a face and its borders; those of the faces used last are kept.

    Parameters
    ----------
    face : Face
    size : float
        Side of a cell aimed at, mm; larger on faces with more than `MOST` of them along a parameter.
    """
    return _KEPT.get((face, size), lambda: _make_cells(face, size))


def ball_around(face: Face, size: float) -> Array:
    """Ball (x, y, z, radius) around all that the cells of a face stand for, (4,) mm.

    Parameters
    ----------
    face : Face
    size : float
        As for `face_cells`.
    """
    known = _AROUND.setdefault(face, {})
    if size not in known:
        cells = face_cells(face, size).cells
        low, high = (f(cells.point, axis=0) for f in (np.min, np.max))
        centre = 0.5 * (low + high)
        far = float((np.linalg.norm(cells.point - centre, axis=1) + cells.radius).max())
        known[size] = np.append(centre, far)
    return known[size]


def _make_cells(face: Face, size: float) -> SampledFace:
    u0, u1, v0, v1 = face.bounds
    d = face.evaluate(face.grid(16, 16))
    wide, tall = (float(np.linalg.norm(x, axis=1).max()) if len(x) else 1.0 for x in (d.su, d.sv))
    nu = int(np.clip(np.ceil((u1 - u0) * wide / size), 4, MOST))
    nv = int(np.clip(np.ceil((v1 - v0) * tall / size), 4, MOST))
    u = u0 + (u1 - u0) * (np.arange(nu) + 0.5) / nu
    v = v0 + (v1 - v0) * (np.arange(nv) + 0.5) / nv
    inner = grid_rows(u, v)
    half = np.tile([0.5 * (u1 - u0) / nu, 0.5 * (v1 - v0) / nv], (len(inner), 1))
    line, way = _loop_pieces(face, size)
    count = len(inner) + len(line)
    owner = np.zeros(count, dtype=np.int64)
    edge = np.arange(count) >= len(inner)
    cells = _cells((face,), owner, np.vstack([inner, line]), np.vstack([half, way]), edge)
    return SampledFace(cells, blocks_of(cells.point))


def _loop_pieces(face: Face, size: float) -> tuple[Array, Array]:
    """Middles and half ways of the pieces of a face's trim loops."""
    middles = []
    ways = []
    for loop in face.outline:
        way = np.roll(loop, -1, axis=0) - loop
        d = face.evaluate(loop + 0.5 * way)
        length = np.linalg.norm(d.su * way[:, :1] + d.sv * way[:, 1:], axis=1)
        least = 32 if len(loop) <= 8 else 1
        parts = np.clip(np.ceil(length / size), least, 4 * MOST).astype(np.int64)
        edge, number = number_parts(parts)
        whole = parts[edge][:, None]
        step = (number[:, None] + 0.5) / whole
        middles.append(loop[edge] + step * way[edge])
        ways.append(0.5 * way[edge] / whole)
    return np.concatenate(middles), np.concatenate(ways)


def _cells(faces: tuple[Face, ...], owner: NDArray[np.int64], uv: Array, half: Array,
           edge: NDArray[np.bool_]) -> SampleCells:
    """Evaluate centres and drop cells that do not touch their face."""
    point = np.zeros((len(uv), 3))
    radius = np.zeros(len(uv))
    on_face = edge.copy()
    keep = edge.copy()
    corner = np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]])
    for index in np.unique(owner):
        rows = np.flatnonzero(owner == index)
        d = faces[index].evaluate(uv[rows])
        point[rows] = d.point
        on_loop = edge[rows]
        du, dv = half[rows].T
        a = d.su * du[:, None]
        b = d.sv * dv[:, None]
        along = np.linalg.norm(a + b, axis=1)
        other = np.linalg.norm(a - b, axis=1)
        bend = 0.5 * np.linalg.norm(d.suu, axis=1) * du**2 + 0.5 * np.linalg.norm(d.svv, axis=1) * dv**2
        bend += np.linalg.norm(d.suv, axis=1) * np.abs(du * dv)
        radius[rows] = 1.1 * (np.where(on_loop, along, np.maximum(along, other)) + bend)
        inner = rows[~on_loop]
        centre = faces[index].contains(uv[inner])
        around = (uv[inner][:, None] + corner * half[inner][:, None]).reshape(-1, 2)
        on_face[inner] = centre
        keep[inner] = centre | faces[index].contains(around).reshape(-1, 4).any(axis=1)
    unknown = np.full(len(uv), np.inf)
    every = SampleCells(owner, uv, half, edge, point, radius, on_face, unknown)
    return every.rows(np.flatnonzero(keep))


def share_cells(cells: SampleCells, owner: int) -> SampleCells:
    """The same cells as those of another face.

    Parameters
    ----------
    cells : SampleCells
    owner : int
        Index of the face.
    """
    return replace(cells, owner=np.full(len(cells), owner))


def split(faces: tuple[Face, ...], cells: SampleCells) -> SampleCells:
    """Each cell cut into nine, each piece of a loop into three.

    Parameters
    ----------
    faces : tuple of Face
    cells : SampleCells
    """
    third = np.array([-2.0, 0.0, 2.0]) / 3
    inner = cells.rows(np.flatnonzero(~cells.edge))
    line = cells.rows(np.flatnonzero(cells.edge))
    offset = grid_rows(third, third)
    inner_uv = (inner.uv[:, None] + offset * inner.half[:, None]).reshape(-1, 2)
    line_uv = (line.uv[:, None] + third[:, None] * line.half[:, None]).reshape(-1, 2)
    inner_half = np.repeat(inner.half, 9, axis=0)
    line_half = np.repeat(line.half, 3, axis=0)
    owner = np.append(np.repeat(inner.owner, 9), np.repeat(line.owner, 3))
    uv = np.vstack([inner_uv, line_uv])
    half = np.vstack([inner_half, line_half]) / 3
    on_loop = np.arange(len(owner)) >= len(inner_uv)
    return _cells(faces, owner, uv, half, on_loop)


def merge_cells(parts: Sequence[SampleCells]) -> SampleCells:
    """Cells of several as one.

    Parameters
    ----------
    parts : sequence of SampleCells
        One at least.
    """
    return SampleCells(*(np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(SampleCells)))
