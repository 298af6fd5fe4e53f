"""Rectangles of a face's parameters as cells: where they lie, and how far they reach and their normals turn."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.vectors import angle_between
from toolaxis.partition.uv_grid import Lattice
from toolaxis.progress import breathe
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

#: Cells at first, about, and the fewest each way.
_CELLS, _FEWEST = 100, 3
#: Cells each way from which it is told how long a face is, and how wide.
_COARSE = 8
#: By how much more than at nine places of it a cell may reach from its middle, and its normals may turn.
_BULGE = 1.1
#: Places of a cell, in halves of it from its middle, and how near to its border it is asked whether it is on the face.
_PLACES, _WITHIN = np.array([-1.0, 0.0, 1.0]), 0.98
#: Places each way of a cell at which it is looked once more before anything is claimed of it, nowhere evenly apart:
#: what repeats itself along a face, ribs or waves, could look the same at all the others.
_CHECKED = np.concatenate([[-1.0, 1.0], 2 * (0.6180339887498949 * np.arange(1, 12) % 1.0) - 1.0])
#: Distance and angle that are none, mm and rad, and cells that are looked at at once.
_LEAST, _AT_ONCE = 1e-4, 256


@dataclass(frozen=True, eq=False)
class FaceRectangles:
    """Rectangles of the parameters.

    middle, half : (n, 2) arrays, of u and v;  point, normal : (n, 3) arrays, at the contact, mm;  area : (n,) array,
    mm^2 of the face;  off : (n,) array, mm, how far a place of the cell lies from the contact at most;  turn : (n,)
    array, rad, the same of its normals.
    """

    middle: Array
    half: Array
    point: Array
    normal: Array
    area: Array
    off: Array
    turn: Array

    def pick(self, rows: Bools | Indices) -> "FaceRectangles":
        """Some of the cells."""
        return FaceRectangles(*(getattr(self, one.name)[rows] for one in fields(self)))

    @staticmethod
    def join(parts: Sequence["FaceRectangles"]) -> "FaceRectangles":
        """The cells of all of some lists, of which there is one at least."""
        columns = []
        for one in fields(FaceRectangles):
            columns.append(np.concatenate([getattr(part, one.name) for part in parts]))
        return FaceRectangles(*columns)

    def shrink(self) -> "FaceRectangles":
        """Their contacts alone, as cells that reach nowhere else."""
        none = np.zeros(len(self))
        return replace(self, off=none, turn=none)

    @property
    def rectangles(self) -> Array:
        """Least and greatest u, least and greatest v, (n, 4)."""
        u0, v0 = (self.middle - self.half).T
        u1, v1 = (self.middle + self.half).T
        return np.column_stack([u0, u1, v0, v1])

    def __len__(self) -> int:
        return len(self.middle)


def first_rectangles(face: Face) -> FaceRectangles:
    u, v = Lattice(face, _shape_for(face)).lines
    middle_u = (u[1:] + u[:-1]) / 2
    middle_v = (v[1:] + v[:-1]) / 2
    middle = grid_rows(middle_u, middle_v)
    half = grid_rows(np.diff(u) / 2, np.diff(v) / 2)
    found, _ = _measure(face, middle, half, face.area)
    return found


def _shape_for(face: Face) -> tuple[int, int]:
    """Cells along u and along v, about as long as they are wide."""
    lengths_u, lengths_v = Lattice(face, (_COARSE, _COARSE)).lengths
    along = float(np.median(lengths_u.sum(axis=0)))
    across = float(np.median(lengths_v.sum(axis=1)))
    ratio = 1.0
    if along > 0 and across > 0:
        ratio = np.sqrt(along / across)
    wanted = np.ceil(np.sqrt(_CELLS) * np.array([ratio, 1 / ratio]))
    cells_u, cells_v = np.clip(wanted, _FEWEST, _CELLS // _FEWEST)
    return int(cells_u), int(cells_v)


def halve_rectangles(face: Face, cells: FaceRectangles) -> tuple[FaceRectangles, Indices]:
    """Four cells in place of each, those that have something of the face, and of which each is a quarter."""
    ways = np.array([[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]])
    middle = cells.middle[:, None] + ways * cells.half[:, None]
    half = np.repeat(cells.half / 2, 4, axis=0)
    found, kept = _measure(face, middle.reshape(-1, 2), half, float(cells.area.sum()))
    quarter_of = np.repeat(np.arange(len(cells)), 4)
    return found, quarter_of[kept]


def _measure(face: Face, middle: Array, half: Array, area: float) -> tuple[FaceRectangles, Bools]:
    """Cells with their contacts, which share an area, and which of the rectangles have a place on the face."""
    places = grid_rows(_PLACES, _PLACES)  # nine in each, in halves of it
    looked_at = middle[:, None] + _WITHIN * places * half[:, None]
    is_inside = face.contains(looked_at.reshape(-1, 2)).reshape(-1, 9)
    kept = np.asarray(is_inside.any(axis=1))
    middle = middle[kept]
    half = half[kept]
    is_inside = is_inside[kept]
    uv = (middle[:, None] + places * half[:, None]).reshape(-1, 2)
    d = face.evaluate(uv)
    points = d.point.reshape(-1, 9, 3)
    normals = face.normal(uv).reshape(-1, 9, 3)
    has_normal = np.linalg.norm(normals, axis=2) > 0.5
    # A cell stands for the place on the face that is nearest to its middle.
    away = np.hypot(*places.T)
    from_middle = np.where(is_inside & has_normal, away, np.inf)
    chosen = np.argmin(from_middle, axis=1)
    row = np.arange(len(middle))
    point = points[row, chosen]
    normal = normals[row, chosen]
    off = np.linalg.norm(points - point[:, None], axis=2).max(axis=1, initial=0.0)
    turns = np.asarray(angle_between(normals, normal[:, None]))
    turn = np.where(has_normal, turns, np.pi).max(axis=1, initial=0.0)
    density = np.linalg.norm(np.cross(d.su, d.sv), axis=1).reshape(-1, 9)
    mean_density = np.where(is_inside, density, 0.0).mean(axis=1)
    share = mean_density * half.prod(axis=1)
    whole = float(share.sum())
    if whole > 0:  # of a sliver no cell may have a place
        share *= area / whole
    most_turn = np.minimum(_BULGE * turn, np.pi)
    return FaceRectangles(middle, half, point, normal, share, _BULGE * off, most_turn), kept


def is_as_measured(face: Face, cells: FaceRectangles) -> Bools:
    """Whether cells reach no farther, and their normals turn no more, at many places than was told from nine, (n,)."""
    ways = grid_rows(_CHECKED, _CHECKED)
    every = np.arange(len(cells))
    found = np.ones(len(cells), dtype=bool)
    for first in range(0, len(cells), _AT_ONCE):
        breathe()
        some = slice(first, first + _AT_ONCE)
        places = cells.middle[some, None] + ways * cells.half[some, None]
        uv = places.reshape(-1, 2)
        row = np.repeat(every[some], len(ways))
        inside = face.contains(uv)
        uv = uv[inside]
        row = row[inside]
        d = face.evaluate(uv)
        normal = face.normal(uv, d)
        off = np.linalg.norm(d.point - cells.point[row], axis=1)
        known = np.linalg.norm(normal, axis=1) > 0.5
        turn = np.asarray(angle_between(normal, cells.normal[row]))
        turn = np.where(known, turn, np.pi)
        farther = off > cells.off[row] + _LEAST
        turned = turn > cells.turn[row] + _LEAST
        found[row[farther | turned]] = False
    return found
