"""Faces that no axis reaches whole, divided into what one axis reaches, what another reaches of the rest, and so on."""

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.contours import contours
from toolaxis.numeric.polygon_boolean import divide_nearly
from toolaxis.numeric.polygons import inside, signed_area, slabs
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.numeric.vectors import angle_between
from toolaxis.partition.uv_grid import Lattice
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.direction_grid import own_frame, spiral
from toolaxis.search.fixed_axis import FaceProblem
from toolaxis.search.infeasibility import corner_depths

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Loops = tuple[Array, ...]

#: Cells each way at least and at most, and their size in radii of the cutter.
_FEWEST, _MOST, _SIZE = 16, 48, 0.4
#: Places along each side of a cell at which it is looked whether the cutter's corner fits.
_FINE = 3
#: Angle between the axes that are tried, rad, and how many of the best by normals alone are tried each time.
_SPACING, _TRIED = np.radians(12), 48
#: Angle by which axes are kept from the greatest one to a normal, rad, so that their neighbours serve too.
_ROOM = np.radians(5)
#: Sub-surfaces at most, and the share of the face that one must hold, and how many squares of the cutter's diameter.
_PIECES, _WORTH, _SQUARES = 8, 0.03, 0.25
#: How far values fade at the edge of what is reached, in cells, and what is left of them where it ends.
_BLUR, _EDGE = 0.8, 0.15
#: Cells by which borders run on into other sub-surfaces, before what these hold is taken off.
_OVER = 3
#: How far corners that are left out lie beside the border, in cells.
_STRAIGHT = 0.3


class ReachDivision(NamedTuple):
    """A face divided by what axes reach.

    pieces : loops of each sub-surface, with the axis (3,) that reaches it
    rest : loops of each part that none of the axes reaches
    tried : how many axes were looked at
    """

    pieces: tuple[tuple[Loops, Array], ...]
    rest: tuple[Loops, ...]
    tried: int


def divide_by_reach(job: FaceProblem, progress: Progress = NO_PROGRESS) -> ReachDivision:
    """Divide a face into sub-surfaces each of which one axis reaches, as seen at the nodes of a lattice.

    Parameters
    ----------
    job : FaceProblem
        Of the face that no axis reaches whole.
    progress : Progress

    Returns
    -------
    ReachDivision
        The largest sub-surface first; without one where no axis reaches enough of the face.

    Raises
    ------
    OutOfWork, Cancelled
    InvalidInput
        When the border of what is reached cannot be told from that of the face.

    Notes
    -----
    Of the axes tried the one is taken that reaches most, then the one that reaches most of the rest. Sub-surfaces end
    one cell before what their axis does not reach. Whether an axis serves a sub-surface is for its own search to prove.

    **Properties**: 1. sub-surfaces and rest add up to the face.
    """
    reach = _Reach(job.feasibility)
    rest: Loops = job.worth.face.outline
    pieces: list[tuple[Loops, Array]] = []
    least = max(_WORTH * job.worth.face.area, _SQUARES * (2 * job.worth.tool.radius) ** 2)
    for count in range(_PIECES):
        progress.report("division by reach", count, _PIECES)
        left = inside(slabs(rest), reach.nodes) if rest else np.zeros(len(reach.nodes), dtype=bool)
        found = reach.best(left, least)
        if found is None:
            break
        both, rest = divide_nearly(rest, reach.border(found.held, ~left))
        if not both:
            break
        pieces += [(loops, found.axis) for loops in outer_with_holes(both)]
    area = abs(signed_area(job.worth.face.outline[0]))
    pieces = [one for one in pieces if _area(one[0]) > 1e-6 * area]
    parts = [loops for loops in outer_with_holes(rest) if _area(loops) > 1e-6 * area] if rest else []
    pieces.sort(key=lambda one: -_area(one[0]))
    return ReachDivision(tuple(pieces), tuple(parts), len(reach.known))


def _area(loops: Loops) -> float:
    return abs(signed_area(loops[0])) - sum(abs(signed_area(hole)) for hole in loops[1:])


class _Held(NamedTuple):
    """An axis, and what it reaches of what is left: (nu, nv) bool."""

    axis: Array
    held: Bools


class _Reach:
    """Which nodes of a lattice over a face each axis reaches.

    Parameters
    ----------
    feasibility : Feasibility
    """

    def __init__(self, feasibility: Feasibility) -> None:
        face, radius = feasibility.face, feasibility.tool.radius
        coarse = Lattice(face, (_FEWEST, _FEWEST))
        sides = [float(np.median(length.sum(axis=axis))) for axis, length in enumerate(coarse.lengths)]
        count = [int(np.clip(np.ceil(side / (_SIZE * radius)), _FEWEST, _MOST)) for side in sides]
        self._feasibility, self._lattice = feasibility, Lattice(face, (count[0], count[1]))
        self._shape = self._lattice.uv.shape[:2]
        self.nodes = self._lattice.uv.reshape(-1, 2)
        self._on = self._lattice.material.ravel()
        self._normal = self._lattice.normals.reshape(-1, 3)
        self._tight = self._too_tight()
        self._area = _node_areas(self._lattice).ravel() * self._on
        self._area *= face.area / max(self._area.sum(), np.finfo(float).tiny)
        #: What each axis that was looked at reaches, by its number.
        self.known: dict[int, Bools] = {}

    def _too_tight(self) -> Bools:
        """Nodes next to places that are too tight for the cutter's corner, whatever the axis, (n,)."""
        own, lines = self._feasibility, self._lattice.lines
        fine = [np.interp(np.arange(_FINE * (len(line) - 1) + 1) / _FINE, np.arange(len(line)), line) for line in lines]
        uv = np.stack(np.meshgrid(*fine, indexing="ij"), axis=-1).reshape(-1, 2)
        uv = uv[own.face.contains(uv)]
        normal = own.face.normal(uv)
        sound = np.linalg.norm(normal, axis=1) > 0.5
        uv, normal = uv[sound], normal[sound]
        tight = np.zeros(self._shape, dtype=bool)
        if len(uv):
            deep = corner_depths(own, own.face.evaluate(uv).point, normal) > own.tolerance.gouge
            cell = [np.clip(np.searchsorted(line, uv[deep, axis], side="right") - 1, 0, len(line) - 2)
                    for axis, line in enumerate(lines)]
            for i in (0, 1):
                for j in (0, 1):
                    tight[cell[0] + i, cell[1] + j] = True
        return tight.ravel()

    @cached_property
    def axes(self) -> Array:
        """Axes to be tried, inside the limits, (k, 3)."""
        normals = self._normal[self._on]
        if not len(normals):  # a face without area
            return np.empty((0, 3))
        cap = smallest_cap(normals)
        middle = cap.centre if cap.radius < np.pi / 2 else normals[0]
        rows = np.vstack([middle[None], spiral(own_frame(normals, middle), _SPACING, np.pi)])
        limits = self._feasibility.limits
        return rows if limits is None else rows[limits.allowed(rows)]

    @cached_property
    def _seen(self) -> Bools:
        """Which nodes each axis may touch by the angle to their normals, (k, n)."""
        own = self._feasibility
        angle = angle_between(self.axes[:, None], self._normal[None])
        # A flat bottom must not meet a normal between the nodes either.
        least = own.least_angle + self._lattice.spread.ravel() if own.least_angle > 0 else 0.0
        inside = (angle >= least) & (angle <= own.greatest_angle - _ROOM)
        return np.asarray(inside & self._on & ~self._tight)

    def best(self, left: Bools, least: float) -> _Held | None:
        """The axis that reaches most of what is left, and that; None where none reaches a part of the least area.

        Parameters
        ----------
        left : (n,) array of bool
            Nodes that are not reached yet.
        least : float
            mm^2
        """
        left = left & self._on
        most = self._seen @ (self._area * left)
        best, value = None, least
        for k in np.argsort(-most, kind="stable")[:_TRIED]:
            if most[k] <= value:
                break
            held = self._large(self._reached(int(k)) & left, left, least)
            area = float(self._area @ held.ravel())
            if area > value:
                best, value = _Held(self.axes[k], held), area
        return best

    def _reached(self, number: int) -> Bools:
        """The nodes that one axis reaches, (n,)."""
        if number not in self.known:
            found, seen = np.zeros(len(self.nodes), dtype=bool), np.flatnonzero(self._seen[number])
            if len(seen):
                found[seen] = self._feasibility.reach(self.nodes[seen], self.axes[number], itself=True)
            self.known[number] = found
        return self.known[number]

    def _large(self, held: Bools, left: Bools, least: float) -> Bools:
        """Nodes one cell away from what is not reached, in connected parts of the least area, (nu, nv)."""
        from scipy.ndimage import binary_dilation, label, minimum_filter

        grid = held.reshape(self._shape)
        missed = (left & ~held).reshape(self._shape)
        core = grid & minimum_filter(~missed, size=3, mode="nearest")
        parts, count = label(core)
        areas = np.bincount(parts.ravel(), weights=self._area, minlength=count + 1)
        areas[0] = 0.0
        kept = (areas >= least)[parts]
        return np.asarray(binary_dilation(kept, mask=core) if kept.any() else kept)

    def border(self, held: Bools, taken: Bools) -> Loops:
        """Loops in u and v around what is reached; where the face ends there, or others begin, they run beyond it.

        Parameters
        ----------
        held : (nu, nv) array of bool
        taken : (n,) array of bool
            Nodes that belong to other sub-surfaces.
        """
        from scipy.ndimage import binary_dilation, distance_transform_edt, gaussian_filter

        held = binary_dilation(held, iterations=_OVER, mask=held | taken.reshape(self._shape))
        on = self._on.reshape(self._shape)
        nearest = distance_transform_edt(~on, return_distances=False, return_indices=True)
        value = np.pad(np.where(held, 1.0, -1.0)[tuple(nearest)], 2, mode="edge")
        lines = []
        for line in self._lattice.lines:
            before, behind = line[1] - line[0], line[-1] - line[-2]
            lines.append(np.concatenate([line[0] - before * np.array([2.0, 1.0]), line,
                                         line[-1] + behind * np.array([1.0, 2.0])]))
        loops = contours(gaussian_filter(value, _BLUR, mode="nearest") - _EDGE, (lines[0], lines[1]))
        size = np.array([np.median(np.diff(line)) for line in self._lattice.lines])
        return tuple(loop[simplify_loop(loop / size, _STRAIGHT)] for loop in loops)


def _node_areas(lattice: Lattice) -> Array:
    """Area of the face that each node stands for, (nu + 1, nv + 1), in proportion: quarters of the cells around."""
    total = np.zeros(lattice.uv.shape[:2])
    for shift_u in (0, 1):
        for shift_v in (0, 1):
            total[shift_u:shift_u + lattice.cells[0], shift_v:shift_v + lattice.cells[1]] += lattice.areas / 4
    return total

