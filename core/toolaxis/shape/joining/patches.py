"""Patches of one surface on their way to be joined: the same parameters, degrees and knots in each column and row."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.knots import distinct_inner, elevate_degree, insert_knots, restrict_spline
from toolaxis.shape.face import Face
from toolaxis.shape.joining.patch_grid import Cell, Grid
from toolaxis.shape.joining.shared_boundary import GAP
from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]
Pair = tuple[float, float]

#: Parameters that are nearer than this share of their range are one.
SAME = 1e-9


@dataclass(frozen=True, eq=False)
class JoinedPatch:
    """A face turned into the joined directions, with the parameters of its column and its row.

    Attributes
    ----------
    face : Face
    scale, shift : (2,) array
        Parameter of the column (row) = scale * own + shift, in the order of the joined directions.
    axes : (int, int)
        Own axis along each joined direction.
    """

    face: Face
    scale: Array
    shift: Array
    axes: tuple[int, int]

    def ours(self, axis: int, own: float) -> float:
        """Parameter of the column or row from the face's own.

        Parameters
        ----------
        axis : int
            0 for the column's, 1 for the row's.
        own : float
        """
        return float(self.scale[axis] * own + self.shift[axis])

    def own(self, axis: int, ours: float) -> float:
        """The face's own parameter in its domain, that of an end where it is as good as that.

        Parameters
        ----------
        axis : int
            0 for the column's, 1 for the row's.
        ours : float
        """
        low, high = self.face.surface.domain[self.axes[axis]]
        mapped = float((ours - self.shift[axis]) / self.scale[axis])
        value = min(max(mapped, low), high)
        nearest_end = min((low, high), key=lambda end: abs(end - value))
        is_end = abs(nearest_end - value) <= SAME * (high - low)
        return nearest_end if is_end else value

    def speed(self, axis: int) -> float:
        """Greatest length of the derivative by the parameter of the column or row, mm.

        Parameters
        ----------
        axis : int
            0 for the column's, 1 for the row's.
        """
        d = self.face.evaluate(self.face.grid(7, 7))
        derivative = (d.su, d.sv)[self.axes[axis]]
        own_speed = np.linalg.norm(derivative, axis=1).max(initial=0)
        return float(own_speed / abs(self.scale[axis]))


def align_parameters(grid: Grid) -> dict[Cell, JoinedPatch]:
    """Patches with parameters that agree in each column and in each row.

    Parameters
    ----------
    grid : Grid
    """
    patches = {cell: JoinedPatch(face, np.ones(2), np.zeros(2), _own_axes(grid.turns[cell]))
               for cell, face in grid.faces.items()}
    for axis in (0, 1):
        across = 1 - axis
        # From one end of each column, or row, to the other: what is before a cell has its map already.
        for cell in sorted(grid.faces, key=lambda c: c[across]):
            patch = patches[cell]
            before = _cell_before(cell, across)
            meeting = grid.meetings.get((before, across))
            if meeting is None:
                patch.scale[axis] = grid.turns[cell][axis, patch.axes[axis]]
            else:
                neighbour = patches[before]
                patch.scale[axis] = neighbour.scale[axis] / meeting.slope
                patch.shift[axis] = neighbour.shift[axis] - neighbour.scale[axis] * meeting.shift / meeting.slope
    return patches


def _cell_before(cell: Cell, axis: int) -> Cell:
    """The cell before another one along an axis."""
    column, row = cell
    return (column - 1, row) if axis == 0 else (column, row - 1)


def _own_axes(turn: Array) -> tuple[int, int]:
    return int(abs(turn[0, 1]) > 0.5), int(abs(turn[1, 1]) > 0.5)


def range_of(grid: Grid, patches: dict[Cell, JoinedPatch], axis: int, k: int) -> Pair:
    """Range of the parameter of a column or row, in which all its patches are cut out.

    Parameters
    ----------
    grid : Grid
    patches : dict of (int, int) to Patch
    axis : int
        0 for columns, 1 for rows.
    k : int
        Number of the column or row, from 0.

    Raises
    ------
    UnsupportedGeometry
        When joins do not lie in one line, or a face goes on beyond the end of a neighbour's surface.
    """
    cells = [cell for cell in patches if cell[axis] == k]
    line = [patches[cell] for cell in cells]
    ends = []
    for end in (0, 1):
        places = [_end_of_patch(grid, cell, patches[cell], axis, end) for cell in cells]
        is_join = 0 < k + end < grid.shape[axis]
        if is_join:
            value = places[0]
        else:  # as far as all surfaces go
            value = max(places) if end == 0 else min(places)
        ends.append(value)
        _check_range(line, axis, _LineEnd(value, end, is_join), places)
    return ends[0], ends[1]


def _end_of_patch(grid: Grid, cell: Cell, patch: JoinedPatch, axis: int, end: int) -> float:
    """The parameter at which a patch begins or ends: where it meets its neighbour, or where its surface does."""
    before = _cell_before(cell, axis) if end == 0 else cell
    meeting = grid.meetings.get((before, axis))
    if meeting is not None:
        return patch.ours(axis, meeting.sides[1 - end].at)
    domain = patch.face.surface.domain[patch.axes[axis]]
    return sorted(patch.ours(axis, t) for t in domain)[end]


class _LineEnd(NamedTuple):
    """Where a column or row begins (end 0) or ends (end 1), and whether another one follows there."""

    value: float
    end: int
    is_join: bool


def _check_range(line: list[JoinedPatch], axis: int, found: _LineEnd, places: list[float]) -> None:
    """That the joins of a column's patches lie in one line, and its faces between its outer ends."""
    for patch, place in zip(line, places, strict=True):
        if found.is_join:
            gap = abs(place - found.value)
        else:
            own = patch.axes[axis]
            bounds = patch.face.bounds[2 * own:2 * own + 2]
            reach = sorted(patch.ours(axis, t) for t in bounds)[found.end]
            gap = found.value - reach if found.end == 0 else reach - found.value
        off = gap * patch.speed(axis)
        if off > GAP:
            names = " and ".join(dict.fromkeys([line[0].face.label, patch.face.label, line[-1].face.label]))
            raise UnsupportedGeometry(f"faces {names} cannot be joined: they end {off:.3g} mm apart along their common "
                                      "direction: join faces that meet along whole sides")


def surface_over(patch: JoinedPatch, box: tuple[Pair, Pair]) -> NurbsSurface:
    """A patch's surface over its box, in the parameters of its column and its row.

    Parameters
    ----------
    patch : JoinedPatch
    box : pair of (float, float)
        Ranges of the column's and the row's parameter.
    """
    source = patch.face.surface
    knots = [source.knots_u, source.knots_v]
    control = source.control
    for axis in (0, 1):
        low, high = box[axis]
        own = patch.axes[axis]
        start = patch.own(axis, low)
        end = patch.own(axis, high)
        degree = source.degree[own]
        own_knots, points = restrict_spline(knots[own], np.moveaxis(control, own, 0), degree, min(start, end),
                                            max(start, end))
        mapped = low + (own_knots - start) * ((high - low) / (end - start))
        if start > end:
            mapped, points = mapped[::-1], points[::-1]
        # The ends exactly, without rounding.
        mapped[:degree + 1] = low
        mapped[-degree - 1:] = high
        knots[own] = mapped
        control = np.moveaxis(points, 0, own)
    made = NurbsSurface(knots[0], knots[1], control, source.degree)
    return made if patch.axes == (0, 1) else made.swapped()


def alike(grid: Grid, surfaces: dict[Cell, NurbsSurface]) -> dict[Cell, NurbsSurface]:
    """The same surfaces with the same degrees, and the same knots along u in each column and along v in each row.

    Parameters
    ----------
    grid : Grid
    surfaces : dict of (int, int) to NurbsSurface
        In the parameters of columns and rows, over the same ranges in each.
    """
    surfaces = dict(surfaces)
    for axis in (0, 1):
        degree = max(surface.degree[axis] for surface in surfaces.values())
        for k in range(grid.shape[axis]):
            cells = [cell for cell in surfaces if cell[axis] == k]
            splines = [_elevate_along(surfaces[cell], axis, degree) for cell in cells]
            target = _common_knots([knots for knots, _ in splines], degree)
            for cell, (knots, points) in zip(cells, splines, strict=True):
                more = insert_knots(_snap_knots(knots, target), points, degree, target)
                surfaces[cell] = _replace_along(surfaces[cell], axis, target, np.moveaxis(more, 0, axis), degree)
    return surfaces


def _elevate_along(surface: NurbsSurface, axis: int, degree: int) -> tuple[Array, Array]:
    """Knots, and control points with those along the axis first, of a surface with a higher degree along an axis."""
    points = np.moveaxis(surface.control, axis, 0)
    return elevate_degree(knots_along(surface, axis), points, surface.degree[axis], degree)


def knots_along(surface: NurbsSurface, axis: int) -> Array:
    """Knots of a surface in u (axis 0) or v (axis 1).

    Parameters
    ----------
    surface : NurbsSurface
    axis : int
    """
    return surface.knots_v if axis else surface.knots_u


def _replace_along(surface: NurbsSurface, axis: int, knots: Array, control: Array, degree: int) -> NurbsSurface:
    """A surface with other knots along an axis, and what goes with them."""
    if axis == 0:
        return NurbsSurface(knots, surface.knots_v, control, (degree, surface.degree[1]))
    return NurbsSurface(surface.knots_u, knots, control, (surface.degree[0], degree))


def _common_knots(sequences: list[Array], degree: int) -> Array:
    """Knots that hold those of several splines over the same range, each as often as in any of them."""
    low, high = sequences[0][0], sequences[0][-1]
    same = SAME * (high - low)
    values: list[float] = []
    counts: list[int] = []
    for knots in sequences:
        for t, count in zip(*distinct_inner(knots, degree), strict=True):
            near = next((i for i, value in enumerate(values) if abs(value - t) <= same), None)
            if near is None:
                values.append(float(t))
                counts.append(int(count))
            else:
                counts[near] = max(counts[near], int(count))
    order = np.argsort(values, kind="stable")
    inner = np.repeat(np.array(values)[order], np.array(counts, dtype=int)[order])
    return np.concatenate([np.full(degree + 1, low), inner, np.full(degree + 1, high)])


def _snap_knots(knots: Array, target: Array) -> Array:
    """Knots as those of the target that are nearest to them."""
    nearest = np.abs(knots[:, None] - target[None]).argmin(axis=1)
    return np.asarray(target[nearest])
