"""Patches of one surface on their way to be joined: the same parameters, degrees and knots in each column and row."""

from dataclasses import dataclass

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
        ends = self.face.surface.domain[self.axes[axis]]
        value = min(max(float((ours - self.shift[axis]) / self.scale[axis]), ends[0]), ends[1])
        near = min(ends, key=lambda end: abs(end - value))
        return near if abs(near - value) <= SAME * (ends[1] - ends[0]) else value

    def speed(self, axis: int) -> float:
        """Greatest length of the derivative by the parameter of the column or row, mm.

        Parameters
        ----------
        axis : int
            0 for the column's, 1 for the row's.
        """
        d = self.face.evaluate(self.face.grid(7, 7))
        return float(np.linalg.norm((d.su, d.sv)[self.axes[axis]], axis=1).max(initial=0) / abs(self.scale[axis]))


def align_parameters(grid: Grid) -> dict[Cell, JoinedPatch]:
    """Patches with parameters that agree in each column and in each row.

    Parameters
    ----------
    grid : Grid
    """
    maps: dict[Cell, tuple[Array, Array]] = {cell: (np.ones(2), np.zeros(2)) for cell in grid.faces}
    for axis in (0, 1):
        for cell in sorted(grid.faces, key=lambda c: c[1 - axis]):
            own = _own_axes(grid.turns[cell])[axis]
            scale, shift = maps[cell]
            before = (cell[0] - axis, cell[1] - (1 - axis))
            meeting = grid.meetings.get((before, 1 - axis))
            if meeting is None:
                scale[axis] = grid.turns[cell][axis, own]
            else:
                other, gone = maps[before]
                scale[axis] = other[axis] / meeting.slope
                shift[axis] = gone[axis] - other[axis] * meeting.shift / meeting.slope
    return {cell: JoinedPatch(face, *maps[cell], _own_axes(grid.turns[cell])) for cell, face in grid.faces.items()}


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
    line = [(cell, patch) for cell, patch in patches.items() if cell[axis] == k]
    ends = []
    for end in (0, 1):
        places = []
        for cell, patch in line:
            before = (cell[0] - (axis == 0), cell[1] - (axis == 1)) if end == 0 else cell
            meeting = grid.meetings.get((before, axis))
            at = patch.face.surface.domain[patch.axes[axis]] if meeting is None else (meeting.sides[1 - end].at,) * 2
            ours = sorted(patch.ours(axis, t) for t in at)
            places.append(ours[end])
        inner = 0 < k + end < grid.shape[axis]
        ends.append(places[0] if inner else (max, min)[end](places))
        _check_range([patch for _, patch in line], axis, (ends[-1], end, inner), places)
    return ends[0], ends[1]


def _check_range(line: list[JoinedPatch], axis: int, found: tuple[float, int, bool], places: list[float]) -> None:
    """That the joins of a column's patches lie in one line, and its faces between its outer ends."""
    value, end, inner = found
    for patch, place in zip(line, places, strict=True):
        bounds = patch.face.bounds[2 * patch.axes[axis]:2 * patch.axes[axis] + 2]
        reach = sorted(patch.ours(axis, t) for t in bounds)[end]
        off = (abs(place - value) if inner else (value - reach) * (1 - 2 * end)) * patch.speed(axis)
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
    knots, control = [source.knots_u, source.knots_v], source.control
    for axis in (0, 1):
        own = patch.axes[axis]
        start, end = (patch.own(axis, t) for t in box[axis])
        degree = source.degree[own]
        knots[own], moved = restrict_spline(knots[own], np.moveaxis(control, own, 0), degree, min(start, end),
                                            max(start, end))
        mapped = box[axis][0] + (knots[own] - start) * ((box[axis][1] - box[axis][0]) / (end - start))
        if start > end:
            mapped, moved = mapped[::-1], moved[::-1]
        mapped[:degree + 1], mapped[-degree - 1:] = box[axis]
        knots[own], control = mapped, np.moveaxis(moved, 0, own)
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
            splines = {cell: elevate_degree(knots_along(surfaces[cell], axis),
                                            np.moveaxis(surfaces[cell].control, axis, 0),
                                            surfaces[cell].degree[axis], degree) for cell in cells}
            target = _common([knots for knots, _ in splines.values()], degree)
            for cell in cells:
                knots, control = splines[cell]
                more = insert_knots(_snap_knots(knots, target), control, degree, target)
                surfaces[cell] = _with(surfaces[cell], axis, (target, np.moveaxis(more, 0, axis)), degree)
    return surfaces


def knots_along(surface: NurbsSurface, axis: int) -> Array:
    """Knots of a surface in u (axis 0) or v (axis 1).

    Parameters
    ----------
    surface : NurbsSurface
    axis : int
    """
    return surface.knots_v if axis else surface.knots_u


def _with(surface: NurbsSurface, axis: int, spline: tuple[Array, Array], degree: int) -> NurbsSurface:
    if axis == 0:
        return NurbsSurface(spline[0], surface.knots_v, spline[1], (degree, surface.degree[1]))
    return NurbsSurface(surface.knots_u, spline[0], spline[1], (surface.degree[0], degree))


def _common(sequences: list[Array], degree: int) -> Array:
    """Knots that hold those of several splines over the same range, each as often as in any of them."""
    low, high = sequences[0][0], sequences[0][-1]
    values: list[float] = []
    counts: list[int] = []
    for knots in sequences:
        for t, count in zip(*distinct_inner(knots, degree), strict=True):
            near = next((i for i, value in enumerate(values) if abs(value - t) <= SAME * (high - low)), None)
            if near is None:
                values.append(float(t))
                counts.append(int(count))
            else:
                counts[near] = max(counts[near], int(count))
    order = np.argsort(values, kind="stable")
    inner = np.repeat(np.array(values)[order], np.array(counts, dtype=int)[order])
    return np.concatenate([np.full(degree + 1, low), inner, np.full(degree + 1, high)])


def _snap_knots(knots: Array, target: Array) -> Array:
    return np.asarray(target[np.abs(knots[:, None] - target[None]).argmin(axis=1)])
