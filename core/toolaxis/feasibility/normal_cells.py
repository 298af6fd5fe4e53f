"""Cells over a face, each with the normal in its middle and a proven bound of how far all others in it are from that.

Nothing of a cell depends on an axis: cells that were divided for one are kept for the next.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import lengths
from toolaxis.progress import breathe
from toolaxis.shape.face import Face
from toolaxis.work import spend

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

_CELLS = 24
#: Cells that are made between two moments to stop; cells and edges of loops that are compared at once.
_AT_ONCE, _PAIRS = 4096, 200_000
#: Size, mm, of a cell at a pole, where normals have no bound, below which it counts with the normal in its middle.
_SPECK = 0.01
#: Cells that are kept; what is divided beyond that is made anew whenever it is asked for.
_KEPT = 50_000
#: Cells are cut across one parameter alone where normals turn so many times as much along it as along the other.
_ONE_WAY = 4.0
#: As many bounds of distances as take as long as making no cell, and one.
_QUESTION, _CELL = 3000, 3


class TrimmedFaceCells(NamedTuple):
    """Cells that may hold a point of the face.

    rect : (n, 4) u0, u1, v0, v1;  bounds : (n, 3) of |Suu|, |Suv|, |Svv|;  crossed : (n,) whether an edge of a loop
    comes near;  inside : (n,) whether the middle lies on the face;  normal : (n, 3) unit normals in the middles;
    spread : (n,) how far other normals of the cell are from that at most, rad;  turn : (n, 2) how much of that comes
    from the width along u and along v, in the same measure.
    """

    rect: Array
    bounds: Array
    crossed: Bools
    inside: Bools
    normal: Array
    spread: Array
    turn: Array

    @property
    def middle(self) -> Array:
        """Parameters of the middles, (n, 2)."""
        return (self.rect[:, 0::2] + self.rect[:, 1::2]) / 2

    def chosen(self, rows: Index | Bools) -> "TrimmedFaceCells":
        """Some of the cells."""
        return TrimmedFaceCells(self.rect[rows], self.bounds[rows], self.crossed[rows], self.inside[rows],
                                self.normal[rows], self.spread[rows], self.turn[rows])


class NormalCells:
    """The cells of one face, as far as they were asked for.

    Parameters
    ----------
    face : Face
    """

    def __init__(self, face: Face) -> None:
        self._face = face
        self._edges = [(loop, np.roll(loop, -1, axis=0)) for loop in face.trims]
        self._cells = self._first()
        #: First child of each kept cell, and how many follow it; -1 where the cell was not divided.
        self._child = np.full((len(self._cells.rect), 2), -1, dtype=np.intp)
        self.roots: tuple[Index | None, TrimmedFaceCells] = np.arange(len(self._cells.rect)), self._cells

    def below(self, kept: Index | None, cells: TrimmedFaceCells) -> tuple[Index | None, TrimmedFaceCells]:
        """The quarters of cells, as far as they may hold a point of the face.

        Parameters
        ----------
        kept : (n,) array of int or None
            Numbers of the cells, from `roots` or from here; None where they are not kept.
        cells : TrimmedFaceCells
            The cells themselves.
        """
        if kept is None:
            return None, self._divided(cells)[0]
        fresh = np.flatnonzero(self._child[kept, 0] < 0)
        if len(self._child) + 4 * len(fresh) > _KEPT:
            return None, self._divided(cells)[0]
        if len(fresh):
            made, count = self._divided(cells.chosen(fresh))
            first = len(self._child) + np.cumsum(count) - count
            self._child[kept[fresh]] = np.column_stack([first, count])
            self._child = np.concatenate([self._child, np.full((len(made.rect), 2), -1, dtype=np.intp)])
            self._cells = TrimmedFaceCells(*(np.concatenate(both) for both in zip(self._cells, made, strict=True)))
        first, count = self._child[kept].T
        row, within = number_parts(count)
        numbers = first[row] + within
        return numbers, self._cells.chosen(numbers)

    def _first(self) -> TrimmedFaceCells:
        """An even grid of cells, with the surface's knots among their borders."""
        u0, u1, v0, v1 = self._face.bounds
        data = self._face.surface.data
        lines_u = _grid_lines(data[0], u0, u1)
        lines_v = _grid_lines(data[1], v0, v1)
        nets = bezier_nets(data, lines_u, lines_v)
        bounds = derivative_bounds(nets, np.diff(lines_u), np.diff(lines_v), 2)
        low = grid_rows(lines_u[:-1], lines_v[:-1])
        high = grid_rows(lines_u[1:], lines_v[1:])
        rect = np.stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]], axis=1)
        crossed = np.full(len(rect), bool(self._edges))
        made, _ = self._make_cells(rect, bounds.reshape(-1, 3), crossed)
        return made

    def _divided(self, cells: TrimmedFaceCells) -> tuple[TrimmedFaceCells, Index]:
        """The quarters of cells, those of one after those of the other, and how many there are of each."""
        owner = np.repeat(np.arange(len(cells.rect)), 4)
        made, met = self._make_cells(_divide_rectangles(cells.rect, cells.turn), cells.bounds[owner],
                                     cells.crossed[owner])
        return made, np.bincount(owner[met], minlength=len(cells.rect))

    def _make_cells(self, rect: Array, bounds: Array, crossed: Bools) -> tuple[TrimmedFaceCells, Index]:
        """Cells from rectangles, a few thousand at once: those that hold something of the face, and their numbers."""
        parts = []
        for first in range(0, len(rect), _AT_ONCE):
            breathe()
            some = slice(first, first + _AT_ONCE)
            parts.append(self._looked(rect[some], bounds[some], crossed[some]))
        found = parts[0] if len(parts) == 1 else TrimmedFaceCells(*map(np.concatenate, zip(*parts, strict=True)))
        met = np.flatnonzero(found.inside | found.crossed)
        return found.chosen(met), met

    def _looked(self, rect: Array, bounds: Array, near: Bools) -> TrimmedFaceCells:
        spend(_QUESTION + _CELL * len(rect))
        middle = (rect[:, 0::2] + rect[:, 1::2]) / 2
        half = (rect[:, 1::2] - rect[:, 0::2]) / 2
        crossed, inside = near.copy(), np.ones(len(rect), dtype=bool)
        crossed[near] = self._edges_meet(middle[near], half[near])
        inside[near] = self._face.contains(middle[near])
        normal, spread, turn = self._normals(middle, half, bounds)
        return TrimmedFaceCells(rect, bounds, crossed, inside, normal, spread, turn)

    def _normals(self, middle: Array, half: Array, bounds: Array) -> tuple[Array, Array, Array]:
        """Normals in the middles of cells, how far others of the cell are from them at most, and by which width."""
        d = self._face.evaluate(middle)
        normal = self._face.normal(middle, d)
        hu, hv = half.T
        off_u = bounds[:, 0] * hu + bounds[:, 1] * hv
        off_v = bounds[:, 1] * hu + bounds[:, 2] * hv
        su = lengths(d.su)
        sv = lengths(d.sv)
        size = lengths(np.cross(d.su, d.sv))
        share = (off_u * sv + su * off_v + off_u * off_v) / np.where(size > 0, size, np.finfo(float).tiny)
        spread = np.where(share < 1, np.arcsin(np.minimum(share, 1.0)), np.pi)
        across_u = 2 * su * hu + off_u * hu
        across_v = 2 * sv * hv + off_v * hv
        spread[(share >= 1) & (across_u + across_v < _SPECK) & (lengths(normal) > 0.5)] = 0.0
        # In a fold a narrow cell has no normals but those of the cells beside it.
        narrow = np.flatnonzero((share >= 1) & (np.minimum(across_u, across_v) < _SPECK))
        spread[narrow[self._face.folds(middle[narrow]).rows]] = 0.0
        rate_u = bounds[:, 0] * sv + bounds[:, 1] * su
        rate_v = bounds[:, 1] * sv + bounds[:, 2] * su
        turn = half * np.column_stack([rate_u, rate_v])
        return normal, spread, turn

    def _edges_meet(self, middle: Array, half: Array) -> Bools:
        """Whether any edge of a loop meets the rectangles with these middles and half sizes (separating axes)."""
        met = np.zeros(len(middle), dtype=bool)
        for start, end in self._edges:
            step = max(_PAIRS // len(start), 1)
            for first in range(0, len(middle), step):
                breathe()
                some = slice(first, first + step)
                met[some] |= _meet(start, end, middle[some, None], half[some, None])
        return met


def _meet(start: Array, end: Array, middle: Array, half: Array) -> Bools:
    """Which boxes, (n, 1, 2) middles and half sizes, any of the edges (k, 2) meets, (n,)."""
    centre = (start + end) / 2 - middle
    way = end - start
    size = np.abs(way)
    # A box and an edge are apart where their shadows on u, on v or across the edge are.
    apart = (np.abs(centre) > size / 2 + half).any(axis=2)
    way_u, way_v = way.T
    size_u, size_v = size.T
    across = np.abs(centre[..., 0] * way_v - centre[..., 1] * way_u)
    apart |= across > half[..., 0] * size_v + half[..., 1] * size_u
    return np.asarray((~apart).any(axis=1))


def _grid_lines(knots: Array, low: float, high: float) -> Array:
    """Even lines from low to high, with the knots between them."""
    inner = np.unique(knots)
    inner = inner[(inner > low) & (inner < high)]
    spans = len(inner) + 1
    cells_in_span = max(2, _CELLS // spans)
    even = np.linspace(low, high, cells_in_span * spans + 1)
    to_knot = np.abs(even[:, None] - inner).min(axis=1, initial=np.inf)
    apart = to_knot > 1e-9 * (high - low)
    return np.sort(np.concatenate([even[apart], inner]))


def _divide_rectangles(rect: Array, turn: Array) -> Array:
    """The quarters of rectangles, (4 n, 4), those of one after those of the other.

    Parameters
    ----------
    rect : (n, 4) array
    turn : (n, 2) array
        How much the normals turn along each parameter: where it is much more along one, all cuts are across that.
    """
    along = [turn[:, axis] > _ONE_WAY * turn[:, 1 - axis] for axis in (0, 1)]
    parts = np.empty((len(rect), 4, 4))
    number = np.arange(4)
    for axis, place_of_two in ((0, number // 2), (1, number % 2)):
        # The quarters are four along this parameter, one and the same range of it, or two by two.
        four, one = along[axis][:, None], along[1 - axis][:, None]
        count = np.where(four, 4, np.where(one, 1, 2))
        place = np.where(four, number, np.where(one, 0, place_of_two))
        low, high = rect[:, 2 * axis, None], rect[:, 2 * axis + 1, None]
        parts[:, :, 2 * axis] = low + (high - low) * (place / count)
        parts[:, :, 2 * axis + 1] = low + (high - low) * ((place + 1) / count)
    return parts.reshape(-1, 4)
