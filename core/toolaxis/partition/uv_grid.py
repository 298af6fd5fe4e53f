"""A lattice of iso-parametric lines over a face, and rectangles of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.grids import grid_nodes, grid_rows
from toolaxis.numeric.polygons import polygon_area
from toolaxis.numeric.vectors import angle_between
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Lines in each direction from which distances on the surface are taken.
_FINE = 64


@dataclass(frozen=True, eq=False)
class Lattice:
    """Lines over the range of a face, evenly apart by their mean distance on the surface.

    Attributes
    ----------
    face : Face
    cells : (int, int)
        Cells along u and along v.
    """

    face: Face
    cells: tuple[int, int] = (16, 16)

    @cached_property
    def lines(self) -> tuple[Array, Array]:
        """Parameters u and v of the lines, (nu + 1,) and (nv + 1,)."""
        u0, u1, v0, v1 = self.face.bounds
        u, v = np.linspace(u0, u1, _FINE + 1), np.linspace(v0, v1, _FINE + 1)
        points = self.face.evaluate(grid_rows(u, v)).point
        net = points.reshape(_FINE + 1, _FINE + 1, 3)
        return _even(u, net, self.cells[0]), _even(v, net.swapaxes(0, 1), self.cells[1])

    @cached_property
    def uv(self) -> Array:
        """Parameters of the nodes, (nu + 1, nv + 1, 2)."""
        return grid_nodes(*self.lines)

    @cached_property
    def points(self) -> Array:
        """Points at the nodes, (nu + 1, nv + 1, 3) mm."""
        return self.face.evaluate(self.uv.reshape(-1, 2)).point.reshape(*self.uv.shape[:2], 3)

    @cached_property
    def normals(self) -> Array:
        """Normals at the nodes, (nu + 1, nv + 1, 3)."""
        return self.face.normal(self.uv.reshape(-1, 2)).reshape(*self.uv.shape[:2], 3)

    @cached_property
    def material(self) -> Bools:
        """Whether a node stands for material of the face, (nu + 1, nv + 1).

        True on the face, and within half a cell of it, so that no corner of the face is left without a node.
        """
        halves = [np.concatenate([line[:1], (line[1:] + line[:-1]) / 2, line[-1:]]) for line in self.lines]
        places = [np.stack([half[:-1], line, half[1:]]) for half, line in zip(halves, self.lines, strict=True)]
        found = np.zeros(self.uv.shape[:2], dtype=bool)
        for u in places[0]:
            for v in places[1]:
                uv = grid_rows(u, v)
                found |= self.face.contains(uv).reshape(found.shape)
        return found & (np.linalg.norm(self.normals, axis=-1) > 0.5)

    @cached_property
    def spread(self) -> Array:
        """Half the greatest angle of a node's normal to those of its neighbours, (nu + 1, nv + 1) rad."""
        most = np.zeros(self.uv.shape[:2])
        for axis in (0, 1):
            n = np.moveaxis(self.normals, axis, 0)
            step = np.asarray(angle_between(n[1:], n[:-1])) / 2
            view = np.moveaxis(most, axis, 0)
            view[1:] = np.maximum(view[1:], step)
            view[:-1] = np.maximum(view[:-1], step)
        return most

    @cached_property
    def filled(self) -> Array:
        """Share of each cell that lies on the face, (nu, nv), exactly 0 only where nothing of it does."""
        if not self.face.trims:
            return np.ones(self.cells)
        size = np.diff(self.lines[0])[:, None] * np.diff(self.lines[1])
        found = np.zeros(self.cells)
        for i in range(self.cells[0]):
            column = self._clipped(self.face.outline, 0, i, i + 1)
            for j in range(self.cells[1]):
                pieces = outer_with_holes(self._clipped(column, 1, j, j + 1))
                found[i, j] = sum(map(polygon_area, pieces))
        return found / size

    @cached_property
    def areas(self) -> Array:
        """Area of the face in each cell, (nu, nv) mm^2, from the middle of the cell."""
        u, v = ((line[1:] + line[:-1]) / 2 for line in self.lines)
        d = self.face.evaluate(grid_rows(u, v))
        size = np.linalg.norm(np.cross(d.su, d.sv), axis=1).reshape(self.cells)
        return np.asarray(size * np.diff(self.lines[0])[:, None] * np.diff(self.lines[1]) * self.filled)

    @cached_property
    def lengths(self) -> tuple[Array, Array]:
        """Length of the lines between neighbouring nodes, along u (nu, nv + 1) and along v (nu + 1, nv), mm."""
        along_u, along_v = (np.linalg.norm(np.diff(self.points, axis=axis), axis=-1) for axis in (0, 1))
        return np.asarray(along_u), np.asarray(along_v)

    @cached_property
    def sides(self) -> tuple[Array, Array]:
        """How much of each of these pieces of the lines lies on the face: the mean of the cells beside it."""
        found = []
        for axis in (0, 1):
            sides = np.zeros(self.lengths[axis].shape)
            cells = np.moveaxis(self.filled, 1 - axis, 0)
            view = np.moveaxis(sides, 1 - axis, 0)
            view[:-1] += cells
            view[1:] += cells
            view[1:-1] /= 2
            found.append(sides)
        return found[0], found[1]

    def _clipped(self, loops: tuple[Array, ...], axis: int, first: int, last: int) -> tuple[Array, ...]:
        """The part of loops between two lines."""
        line = self.lines[axis]
        if first > 0:
            loops = clip_half_plane(loops, axis, float(line[first]), True)
        if last < len(line) - 1:
            loops = clip_half_plane(loops, axis, float(line[last]), False)
        return loops

    def rectangle(self, corners: tuple[int, int, int, int]) -> tuple[tuple[Array, ...], ...]:
        """Loops of the pieces of the face inside a rectangle of the lattice.

        Parameters
        ----------
        corners : (int, int, int, int)
            Numbers of its lines: first and last along u, first and last along v.

        Returns
        -------
        tuple of tuples of (m, 2) arrays
            One tuple a piece, its border first; a rectangle may hold several pieces, or none.
        """
        column = self._clipped(self.face.outline, 0, *corners[:2])
        return tuple(outer_with_holes(self._clipped(column, 1, *corners[2:])))


def _even(values: Array, net: Array, count: int) -> Array:
    """Parameters of count + 1 lines that are evenly apart, from points on lines (rows of the net) at parameters."""
    apart = np.linalg.norm(np.diff(net, axis=0), axis=-1).mean(axis=1)
    length = np.concatenate([[0.0], np.cumsum(apart)])
    if length[-1] <= 0:
        return np.linspace(values[0], values[-1], count + 1)
    lines = np.interp(np.linspace(0.0, length[-1], count + 1), length, values)
    lines[[0, -1]] = values[[0, -1]]
    return np.asarray(lines)
