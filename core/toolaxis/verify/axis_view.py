"""Maps of a verdict as seen along the tool axis: the greatest height and depth in every square cell."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.verify.maps import SurfaceMap

Array = NDArray[np.float64]
Cells = NDArray[np.float32]

#: Cells of one view.
MOST_CELLS = 90_000
#: How far beyond a ray its value still stands for the face, in spacings of the rays.
_REACH = 1.5


@dataclass(frozen=True, eq=False)
class RestMaterialView:
    """What is left on the faces of an operation, in square cells of a plane.

    Attributes
    ----------
    corner : (2,) array
        Where the cells begin, mm along x and y of the plane.
    cell : float
        Side of a cell, mm.
    scallop, gouge : (rows, columns) array of float32
        The greatest in each cell, mm; rows go along y, columns along x.  NaN where there is no face; inf where the
        cutter never came.
    """

    corner: Array
    cell: float
    scallop: Cells
    gouge: Cells


def view_along(maps: Sequence[SurfaceMap], x: ArrayLike, y: ArrayLike, origin: ArrayLike,
               most: int = MOST_CELLS) -> RestMaterialView:
    """The maps of an operation's faces in a plane.

    Parameters
    ----------
    maps : sequence of SurfaceMap
    x, y : (3,) array_like
        Unit vectors of the plane: those of the work coordinate system.
    origin : (3,) array_like
        Where x and y are zero, mm.
    most : int
        Cells are as large as the rays are apart, and larger where that makes more of them than this.

    Raises
    ------
    InvalidInput
        When there is no map.

    Notes
    -----
    **Properties**: 1. the greatest value of the view is that of the rays; 2. a cell without a ray has the value of the
    nearest one within 1.5 spacings and half a cell, or is empty.
    """
    from scipy.spatial import cKDTree

    if not maps:
        raise InvalidInput("there are no maps: an operation has one for each of its faces")
    plane = np.stack([np.asarray(x, dtype=float), np.asarray(y, dtype=float)], axis=1)
    flat = (np.concatenate([one.point for one in maps]) - np.asarray(origin, dtype=float)) @ plane
    spacing = max(one.spacing for one in maps)
    low, size = flat.min(axis=0), np.ptp(flat, axis=0)
    cell = max(spacing, float(np.sqrt(np.prod(size + spacing) / most)))
    columns, rows = (max(ceil(float(length) / cell + 1e-9), 1) for length in size)
    place = np.clip(np.floor((flat - low) / cell).astype(np.int64), 0, [columns - 1, rows - 1])
    index = place[:, 1] * columns + place[:, 0]
    middles = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
    centres = np.stack(middles, axis=-1).reshape(-1, 2) * cell + low
    empty = np.bincount(index, minlength=rows * columns) == 0
    distance, near = cKDTree(flat).query(centres[empty], distance_upper_bound=_REACH * spacing + 0.5 * cell)
    found = np.isfinite(distance)
    remaining = np.concatenate([one.remaining for one in maps])
    gouge = np.concatenate([one.gouge for one in maps])
    views = []
    for value in (remaining, gouge):
        cells = np.full(rows * columns, -np.inf)
        np.maximum.at(cells, index, value)
        cells[np.flatnonzero(empty)[found]] = value[near[found]]
        views.append(np.where(cells == -np.inf, np.nan, cells).reshape(rows, columns).astype(np.float32))
    return RestMaterialView(low, cell, *views)


def coarser(view: RestMaterialView, most: int) -> RestMaterialView:
    """A view in larger cells, the greatest value of the smaller ones in each.

    Parameters
    ----------
    view : RestMaterialView
    most : int
        About how many cells.
    """
    rows, columns = view.scallop.shape
    step = ceil(np.sqrt(rows * columns / most) - 1e-9)
    if step <= 1:
        return view

    scallop = _pool_cells(view.scallop, step)
    gouge = _pool_cells(view.gouge, step)
    return RestMaterialView(view.corner, view.cell * step, scallop, gouge)


def _pool_cells(cells: Cells, step: int) -> Cells:
    """The greatest value of every square of so many cells each way; NaN where none of them has one."""
    rows, columns = cells.shape
    high = ceil(rows / step)
    wide = ceil(columns / step)
    padded = np.full((high * step, wide * step), -np.inf, dtype=np.float32)
    padded[:rows, :columns] = np.where(np.isnan(cells), -np.inf, cells)
    squares = padded.reshape(high, step, wide, step)
    greatest = squares.max(axis=(1, 3))
    return np.where(greatest == -np.inf, np.nan, greatest).astype(np.float32)
