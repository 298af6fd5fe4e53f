"""Cells of a face: small pieces, each with one contact that stands for it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.limits import AxisLimits
from toolaxis.numeric.vectors import angle_between, dot
from toolaxis.partition.uv_grid import Lattice
from toolaxis.search.direction_grid import spiral
from toolaxis.shape.differential import curvature_form
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Cells each way at least and at most, their size in radii of the smallest cutter, and the turn of normals over each.
_FEWEST, _MOST, _SIZE, _TURN = 12, 32, 0.8, np.radians(5)
#: Cells each way at least, and the turn of normals over each, where few are to do.
_FEW, _FAR_TURN = 6, np.radians(10)
#: Cells each way at most where most of the lattice is beside the face.
_MOST_SPARSE = 256
#: How often cells are halved each way where none of them has a sample on the face.
_HALVINGS = 3
#: Places of the samples in a cell, in halves of it from its centre, and the share of the cell that each stands for.
_PLACES, _SHARES = np.array([-0.98, 0.0, 0.98]), np.array([0.25, 0.5, 0.25])
#: Angle between axes of a screening, rad.
AXES_APART = np.radians(12)


@dataclass(frozen=True, eq=False)
class FaceCells:
    """A face, or a skin, as cells between iso-parametric lines; make them with `FaceCells.of`.

    Attributes
    ----------
    face : Face
    shape : (int, int)
        Cells along u and along v of the whole lattice.
    index : (n, 2) array of int
        Row and column in the lattice of the cells that have something of the face; neighbours differ by one.
    uv : (n, 2) array
        Parameters of each cell's contact: its centre, or the sample on the face that is nearest to it.
    point, normal : (n, 3) array
        The contacts, mm, and unit normals out of the material.
    area : (n,) array
        mm^2 of the face in each cell; they add up to that of the face.
    tangent : (n, 3) array
        Unit vector along Su.
    form : (n, 3) array
        Second fundamental form along the tangent, mixed, and along normal x tangent, 1/mm: positive where the face
        bends towards its normal.
    spread : (n,) array
        Greatest angle of the normals in the cell to that at its contact, rad.
    """

    face: Face
    shape: tuple[int, int]
    index: Indices
    uv: Array
    point: Array
    normal: Array
    area: Array
    tangent: Array
    form: Array
    spread: Array

    @staticmethod
    def of(face: Face, radius: float) -> "FaceCells":
        """Cells of a face.

        Parameters
        ----------
        face : Face
        radius : float
            Of the smallest cutter, mm: cells are about so large, and normals turn by 5 degrees over one, but there are
            at least 12 and at most 32 each way.

        Notes
        -----
        **Properties**: 1. areas add up to that of the face; 2. moving the face moves the contacts.
        """
        return _cells_of(face, _shape_for(face, _SIZE * radius, (_FEWEST, _MOST)))

    @staticmethod
    def few(face: Face, radius: float) -> "FaceCells":
        """As few cells of a face as will do to choose tools for it.

        There are at least 6 each way, and normals turn by 10 degrees over one.

        Parameters
        ----------
        face : Face
        radius : float
            Cells are about so large, mm.
        """
        return _cells_of(face, _shape_for(face, _SIZE * radius, (_FEW, _MOST), _FAR_TURN))

    @staticmethod
    def sized(face: Face, size: float) -> "FaceCells":
        """Cells of a face in a given size, for faces that fill little of their box too.

        Parameters
        ----------
        face : Face
        size : float
            Of a cell each way, mm; normals turn by 5 degrees over one, and there are at least 12 and at most 256 each
            way.
        """
        return _cells_of(face, _shape_for(face, size, (_FEWEST, _MOST_SPARSE)))

    def pick(self, rows: Indices) -> "FaceCells":
        """Some of the cells.

        Parameters
        ----------
        rows : (m,) array of int
        """
        return replace(self, index=self.index[rows], uv=self.uv[rows], point=self.point[rows],
                       normal=self.normal[rows], area=self.area[rows], tangent=self.tangent[rows],
                       form=self.form[rows], spread=self.spread[rows])

    def __len__(self) -> int:
        return len(self.uv)


def _cells_of(face: Face, shape: tuple[int, int]) -> FaceCells:
    """Cells of a lattice, which is made finer where none of them has a sample on the face."""
    for halving in range(_HALVINGS + 1):
        samples = _CellSamples(face, (shape[0] << halving, shape[1] << halving))
        if samples.inside.any():
            break
    return samples.cells()


def _shape_for(face: Face, size: float, bounds: tuple[int, int], greatest: float = _TURN) -> tuple[int, int]:
    """Cells along u and along v, within bounds for either; normals turn by no more than the greatest turn over one."""
    coarse = Lattice(face, (_FEWEST, _FEWEST))
    counts = []
    for way, lengths in enumerate(coarse.lengths):
        normals = np.moveaxis(coarse.normals, way, 0)
        turn = np.median(np.asarray(angle_between(normals[1:], normals[:-1])).sum(axis=0))
        side = np.median(lengths.sum(axis=way))
        wanted = max(side / size, turn / greatest)
        counts.append(int(np.clip(np.ceil(wanted), *bounds)))
    return counts[0], counts[1]


class _CellSamples:
    """Nine samples in each cell of a lattice, and which of them lie on the face."""

    def __init__(self, face: Face, shape: tuple[int, int]) -> None:
        self.face, self.shape = face, shape
        lines = Lattice(face, shape).lines
        middle = [(line[1:] + line[:-1]) / 2 for line in lines]
        half = [np.diff(line) / 2 for line in lines]
        u, v = (m[:, None] + h[:, None] * _PLACES for m, h in zip(middle, half, strict=True))
        uv = np.empty((*shape, 3, 3, 2))
        uv[..., 0] = u[:, None, :, None]
        uv[..., 1] = v[None, :, None, :]
        self.uv = uv.reshape(-1, 9, 2)
        self.inside = face.contains(self.uv.reshape(-1, 2)).reshape(-1, 9)
        self.size = (4 * half[0][:, None] * half[1]).ravel()

    def cells(self) -> FaceCells:
        """The cells that have a sample on the face with a normal."""
        face = self.face
        rows = np.flatnonzero(self.inside.any(axis=1))
        uv, inside = self.uv[rows], self.inside[rows]
        normals = face.normal(uv.reshape(-1, 2)).reshape(-1, 9, 3)
        inside = inside & (np.linalg.norm(normals, axis=2) > 0.5)
        kept = inside.any(axis=1)
        rows, uv, inside, normals = rows[kept], uv[kept], inside[kept], normals[kept]
        across, down = np.meshgrid(np.abs(_PLACES), np.abs(_PLACES), indexing="ij")
        pick = np.argmin(np.where(inside, np.hypot(across, down).ravel(), np.inf), axis=1)
        one = np.arange(len(rows))
        own, normal = uv[one, pick], normals[one, pick]
        d = face.evaluate(own)
        share = inside @ np.outer(_SHARES, _SHARES).ravel()
        area = np.linalg.norm(np.cross(d.su, d.sv), axis=1) * share * self.size[rows]
        if len(rows):
            area *= face.area / area.sum()
        tangent = _tangents(d.su, d.sv, normal)
        bend = curvature_form(d, normal, tangent)
        form = np.stack([bend[:, 0, 0], bend[:, 0, 1], bend[:, 1, 1]], axis=1)
        turn = np.asarray(angle_between(normals, normal[:, None]))
        spread = np.where(inside, turn, 0.0).max(axis=1, initial=0.0)
        index = np.stack(np.divmod(rows, self.shape[1]), axis=1)
        return FaceCells(face, self.shape, index, own, d.point, normal, area, tangent, form, spread)


def _tangents(su: Array, sv: Array, normal: Array) -> Array:
    """Unit tangents along Su; along Sv where that is next to nothing."""
    longer = dot(su, su) >= 1e-16 * dot(sv, sv)
    base = np.where(longer[:, None], su, sv)
    base = base - dot(base, normal)[:, None] * normal
    return np.asarray(base / np.linalg.norm(base, axis=1, keepdims=True))


def screening_axes(some: Sequence[FaceCells], limits: AxisLimits | None = None,
                   apart: float = AXES_APART) -> Array:
    """Axes to be screened for some faces: the six along the coordinate axes, and others evenly over the sphere.

    Parameters
    ----------
    some : sequence of FaceCells
    limits : AxisLimits, optional
    apart : float
        Angle between neighbouring axes, rad.

    Returns
    -------
    (k, 3) array of unit vectors within the limits, each within 90 degrees of the normal of some cell
    """
    straight = np.concatenate([np.eye(3), -np.eye(3)])
    axes = np.concatenate([straight, spiral(np.eye(3), apart, np.pi)])
    seen = np.zeros(len(axes), dtype=bool)
    for cells in some:
        seen |= (cells.normal @ axes.T > 0).any(axis=0)
    axes = axes[seen]
    return axes if limits is None else axes[limits.allowed(axes)]
