"""Faces that no axis reaches whole, divided into what one axis reaches, what another reaches of the rest, and so on."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.polygon_boolean import divide_nearly, unite_polygons
from toolaxis.numeric.polygons import inside, polygon_area, signed_area, slabs
from toolaxis.numeric.vectors import angle_between
from toolaxis.partition.uv_grid import Lattice
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.regions.cell_borders import CellBorders
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.prices import fits_hollows
from toolaxis.regions.reach_screen import ReachScreen, seen_cells
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.searched_scene import tighten_scene
from toolaxis.search.direction_grid import ring
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.measure import mean_width
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]
Loops = tuple[Array, ...]

#: Size of cells in radii of the cutter and in mean widths of the face at most, how many a face has at most, and how
#: much finer those are by which the borders go, and how many.
_SIZE, _ACROSS, _COARSE, _FINER, _FINE = 0.4, 1 / 3, 1000, 2.5, 15000
#: Axes that are screened between two moments to stop.
_TOGETHER = 32
#: Axes from which others are looked for, the angle between them, and how many are held against each other each time.
_BEGINNINGS, _APART, _LOOKED_AT = 5, np.radians(25), 8
#: Axes that are looked at finely for what others leave.
_FILLED = 4
#: Angles at which neighbours of an axis are tried, one after the other, rad.
_NEARER = tuple(np.radians([6.0, 3.0]))
#: Angle by which axes are kept from the greatest one to a normal, rad, so that their neighbours serve too.
_ROOM = np.radians(5)
#: Axes of a face at most, the share of it that a sub-surface must hold, and how many squares of the cutter's diameter.
_MOST_AXES, _WORTH, _SQUARES = 24, 0.015, 0.25
#: What a coarse cell at the edge of what an axis reaches counts beside others: finer ones may tell that it is beyond.
_EDGE = 0.8
#: Share of this least area that a further axis has to bring.
_PRICE = 0.5
#: Cells from what an axis does not reach beyond which it counts as any other that reaches the place.
_APRON = 8.0
#: Cells from what its axis does not reach at which a smaller sub-surface ends.
_SMALLER = 2.0
#: What an island of a sub-surface holds at least, in squares of the cutter's diameter and shares of the least area of a
#: sub-surface, and the share of this that one costs: the tool is lifted and comes down for it.
_ISLAND, _OF_LEAST, _LIFT = 0.25, 0.05, 0.5
#: Share of a polygon's area in u and v below which a part of it is nothing.
_NOTHING = 1e-6


class ReachPiece(NamedTuple):
    """A sub-surface that one axis reaches.

    loops : its border first, then its holes, and the same of further islands
    axis : (3,) unit vector
    smaller : loops of the same one cell farther from what the axis does not reach; empty where nothing is left
    margin : loops of what lies between the two
    """

    loops: Loops
    axis: Array
    smaller: Loops = ()
    margin: Loops = ()


class LeastAreas(NamedTuple):
    """Areas below which there is nothing to be machined by itself.

    piece : float, of a sub-surface, mm^2
    island : float, of one of the parts into which a sub-surface falls, mm^2
    """

    piece: float
    island: float


class ReachDivision(NamedTuple):
    """A face divided by what axes reach.

    pieces : the sub-surfaces, the largest first
    rest : loops of each part that none of the axes reaches
    tried : how many axes were looked at
    """

    pieces: tuple[ReachPiece, ...]
    rest: tuple[Loops, ...]
    tried: int

    def shrink(self, numbers: Sequence[int]) -> "ReachDivision":
        """The division with some of its sub-surfaces one cell smaller, and the rest larger by that.

        Parameters
        ----------
        numbers : sequence of int
            From 0; those of which nothing would be left stay as they are.
        """
        pieces = list(self.pieces)
        rest: Loops = tuple(loop for loops in self.rest for loop in loops)
        for k in numbers:
            piece = pieces[k]
            if piece.smaller:
                pieces[k] = ReachPiece(piece.smaller, piece.axis)
                rest = _unite(rest, piece.margin)
        return self._replace(pieces=tuple(pieces), rest=tuple(_parts(rest)))


def divide_by_reach(job: FaceProblem, scene: ReachScene, progress: Progress = NO_PROGRESS) -> ReachDivision:
    """Divide a face into sub-surfaces each of which one axis reaches, as the screening of its cells sees it.

    Parameters
    ----------
    job : FaceProblem
        Of the face that no axis reaches whole.
    scene : ReachScene
        Of the part that the face belongs to.
    progress : Progress

    Returns
    -------
    ReachDivision
        Without a sub-surface where no axis reaches enough of the face.

    Raises
    ------
    Cancelled

    Notes
    -----
    Coarse cells tell which axes are taken: the one that reaches most, then the one that reaches most of the rest, from
    several beginnings; then each gives way to one that reaches more beside all the others.  Fine cells tell where each
    ends: one cell before what it does not reach, and where two reach a place, with the one that is farther from what
    it does not.  Whether an axis serves a sub-surface is for its own search to prove.

    **Properties**: 1. sub-surfaces and rest add up to the face; 2. so they do with some of them smaller.
    """
    face, tool = job.worth.face, job.worth.tool
    if not face.area > 0:
        return ReachDivision((), tuple(_parts(face.outline)), 0)
    kept = tighten_scene(job, scene)
    width = mean_width(face)
    square = 2 * tool.radius * min(2 * tool.radius, width)
    piece = max(_WORTH * face.area, _SQUARES * square)
    least = LeastAreas(piece, max(_ISLAND * square, _OF_LEAST * piece))
    size = min(_SIZE * tool.radius, _ACROSS * width)
    coarse = _Reach(FaceCells.sized(face, max(size, (face.area / _COARSE) ** 0.5)), tool, kept, job.worth.scallop,
                    least)
    some = screening_axes([coarse.cells], kept.limits)
    for first in range(0, len(some), _TOGETHER):
        progress.report("division by reach", first, len(some))
        coarse.screen(some[first:first + _TOGETHER])
    found = _Cover(coarse).find()
    if not found:
        return ReachDivision((), tuple(_parts(face.outline)), len(coarse.axes))
    fine = _Reach(FaceCells.sized(face, max(size / _FINER, (face.area / _FINE) ** 0.5)), tool, kept, job.worth.scallop,
                  least, edges=1)
    progress.report("division by reach", 1, 2)
    chosen = _Cover(fine).fill(list(fine.screen(coarse.axes[found])), coarse.axes)
    return _Borders(fine).divide(chosen, len(coarse.axes))


class _Reach:
    """Which cells of a face a tool reaches under axes.

    Parameters
    ----------
    cells : FaceCells
    tool : Tool
    scene : ReachScene
    scallop : float
        mm
    least : LeastAreas
    edges : int
        Cells beside those that are in the way that are left out.
    """

    def __init__(self, cells: FaceCells, tool: Tool, scene: ReachScene, scallop: float, least: LeastAreas,
                 edges: int = 0) -> None:
        self.cells, self.tool, self.scene, self.scallop, self.least = cells, tool, scene, scallop, least
        self._edges = edges
        self._screen = ReachScreen(cells, scene)
        self._place = tuple(cells.index.T)
        self.axes = np.empty((0, 3))
        #: What each axis reaches, (k, n).
        self.reached = np.empty((0, len(cells)), dtype=bool)
        #: How far that goes on around each cell until the axis does not reach one, in cells, (k, n).
        self.depth = np.empty((0, len(cells)), dtype=np.float32)

    def screen(self, axes: Array) -> range:
        """Look at axes; their numbers."""
        cells, before = self.cells, len(self.axes)
        angle = np.asarray(angle_between(axes[:, None], cells.normal[None]))
        roomy = angle <= np.pi / 2 - self.tool.half_angle - _ROOM
        asked = fits_hollows(cells, self.tool, axes, self.scallop, self.scene.allowance)
        if not self._edges:  # only with edges it counts what stands in the way where there is little room
            asked &= roomy
        free = self._screen.screen([self.tool], axes, asked[None])[0]
        reached = free & roomy
        if self._edges:
            seen = seen_cells(cells, self.tool, axes, self.scene.tolerance)
            reached = np.array([_shrink(self, one, there, self._edges)
                                for one, there in zip(reached, seen & ~free, strict=True)]).reshape(reached.shape)
        self.axes = np.concatenate([self.axes, axes])
        self.reached = np.concatenate([self.reached, reached])
        self.depth = np.concatenate([self.depth, *(self._depth(one)[None] for one in reached)])
        return range(before, len(self.axes))

    def area_free(self, rows: Indices, axes: Array) -> Array:
        """Area of some cells at which the tool may stand under axes, hollow or not, (k,) mm^2.

        Parameters
        ----------
        rows : (m,) array of int
            The cells.
        axes : (k, 3) array
        """
        some = self._screen.pick(rows)
        return np.asarray(some.screen([self.tool], axes)[0] @ some.cells.area)

    def _depth(self, reached: Bools) -> NDArray[np.float32]:
        from scipy.ndimage import distance_transform_edt

        away = self.spread_out(~reached)
        if not away.any():
            return np.full(len(reached), np.inf, dtype=np.float32)
        far = distance_transform_edt(~away)
        return np.asarray(far[self._place] * reached, dtype=np.float32)

    def spread_out(self, cells: Bools) -> Bools:
        """Cells on their lattice, (nu, nv), False where there are none.

        Parameters
        ----------
        cells : (n,) array of bool
        """
        grid = np.zeros(self.cells.shape, dtype=bool)
        grid[self._place] = cells
        return grid

    def assign(self, numbers: Sequence[int]) -> Indices:
        """Which axis each cell goes to, by its place among some; -1 where none of them reaches it, (n,).

        Parameters
        ----------
        numbers : sequence of int
            Of axes, those aside that are looked at first where others are no farther from what they do not reach.
        """
        depth = np.minimum(self.depth[list(numbers)], _APRON)
        for _ in range(len(numbers) + 1):
            taken = np.where(depth.max(axis=0, initial=0.0) > 0, depth.argmax(axis=0), -1)
            crumbs = [self._crumbs(taken == place) for place in range(len(numbers))]
            for place, one in enumerate(crumbs):
                depth[place, one] = 0.0
            if not any(one.any() for one in crumbs):
                break
        return np.asarray(np.where(depth.max(axis=0, initial=0.0) > 0, depth.argmax(axis=0), -1))

    def price_of(self, cells: Bools) -> float:
        """What the sub-surfaces under one axis cost beside their cuts, as an area, mm^2.

        Parameters
        ----------
        cells : (n,) array of bool
            That go to this axis.
        """
        areas = np.bincount(self._parts(cells), weights=self.cells.area, minlength=1)[1:]
        large = int((areas >= self.least.piece).sum())
        return _PRICE * self.least.piece * max(large, 1) + _LIFT * self.least.island * (len(areas) - large)

    def _parts(self, cells: Bools) -> NDArray[np.int32]:
        """Numbers of connected parts from 1, 0 beside cells, (n,)."""
        from scipy.ndimage import label

        parts, _ = label(self.spread_out(cells), structure=np.ones((3, 3)))
        return np.asarray(parts[self._place])

    def _crumbs(self, cells: Bools) -> Bools:
        """Connected parts of cells that are smaller than an island, (n,); all where the others are no sub-surface."""
        own = self._parts(cells)
        areas = np.bincount(own, weights=self.cells.area, minlength=1)
        small = areas < self.least.island
        if areas[1:][~small[1:]].sum() < self.least.piece:
            return cells
        return np.asarray(cells & small[own])


def _shrink(reach: _Reach, cells: Bools, missed: Bools, count: int) -> Bools:
    """Cells, those aside that are no more than some cells from missed ones, (n,)."""
    from scipy.ndimage import maximum_filter

    near = maximum_filter(reach.spread_out(missed), size=2 * count + 1, mode="constant")
    return np.asarray(cells & ~near[tuple(reach.cells.index.T)])


class _Cover:
    """Few axes that reach much of a face together.

    Parameters
    ----------
    reach : _Reach
    """

    def __init__(self, reach: _Reach) -> None:
        self._reach, self._area = reach, reach.cells.area

    def find(self) -> list[int]:
        """Numbers of the axes."""
        found: list[int] = []
        for first in self._beginnings():
            other = self._extend([first])
            if self._worth(other) > self._worth(found):
                found = other
        if found:
            found = self._extend(self._exchange(found))
        return found

    def fill(self, numbers: list[int], axes: Array) -> list[int]:
        """Axes with further ones for what they leave, as long as each is worth it.

        Parameters
        ----------
        numbers : list of int
        axes : (k, 3) array
            From which further ones are taken.
        """
        reach = self._reach
        while len(numbers) < _MOST_AXES:
            left = np.flatnonzero(reach.assign(numbers) < 0)
            if self._area[left].sum() < _PRICE * reach.least.piece:
                break
            gain = reach.area_free(left[::1 + len(left) // _COARSE], axes)
            best = np.argsort(-gain, kind="stable")[:_FILLED]
            longer = max(([*numbers, new] for new in reach.screen(axes[best])), key=self._worth)
            if self._worth(longer) <= self._worth(numbers):
                break
            numbers = longer
        return numbers

    def _worth(self, numbers: Sequence[int]) -> float:
        """Area of what axes reach together, what is near the edge for less, and less a price on each, mm^2."""
        if not numbers:
            return 0.0
        reach = self._reach
        goes_to = reach.assign(numbers)
        depth = reach.depth[np.asarray(numbers)[goes_to], np.arange(len(goes_to))]
        value = np.where(goes_to >= 0, np.where(depth > 1.5, 1.0, _EDGE), 0.0)
        price = sum(reach.price_of(goes_to == place) for place in range(len(numbers)))
        return float(self._area @ value) - price

    def _beginnings(self) -> list[int]:
        """Axes that reach most, apart from each other."""
        reach = self._reach
        found: list[int] = []
        for k in np.argsort(-(reach.reached @ self._area), kind="stable"):
            apart = angle_between(reach.axes[k], reach.axes[found]) if found else np.array([np.pi])
            if np.min(apart) >= _APART:
                found.append(int(k))
            if len(found) == _BEGINNINGS:
                break
        return found

    def _extend(self, numbers: list[int]) -> list[int]:
        """Axes with further ones, as long as each is worth it."""
        while len(numbers) < _MOST_AXES:
            longer = [*numbers, self._next(numbers)]
            if self._worth(longer) <= self._worth(numbers):
                break
            numbers = longer
        return numbers

    def _next(self, numbers: Sequence[int], among: Sequence[int] | None = None) -> int:
        """The axis beside which others together reach most."""
        reach = self._reach
        left = ~reach.reached[list(numbers)].any(axis=0)
        some = np.arange(len(reach.axes)) if among is None else np.asarray(among)
        most = reach.reached[some] @ (self._area * left)
        best = some[np.argsort(-most, kind="stable")[:_LOOKED_AT]]
        return int(max(best, key=lambda k: self._worth([*numbers, int(k)])))

    def _exchange(self, numbers: list[int]) -> list[int]:
        """Axes, each exchanged for one that reaches more beside all others, its own neighbours among these."""
        for place in range(len(numbers)):
            others = [*numbers[:place], *numbers[place + 1:]]
            number = numbers[place]
            for one in (self._next(others), *self._near(others, number)):
                if self._worth([*others[:place], one, *others[place:]]) > self._worth(numbers):
                    numbers = [*others[:place], one, *others[place:]]
        return numbers

    def _near(self, others: Sequence[int], number: int) -> Iterator[int]:
        """The best neighbours of an axis, one after the other nearer to the best so far."""
        reach = self._reach
        for angle in _NEARER:
            near = ring(reach.axes[number], angle)
            limits = reach.scene.limits
            near = near if limits is None else near[limits.allowed(near)]
            if len(near):
                number = self._next(others, [number, *reach.screen(near)])
                yield number


class _Borders:
    """Borders around cells that axes reach.

    Parameters
    ----------
    reach : _Reach
    """

    def __init__(self, reach: _Reach) -> None:
        self._reach, self._cells = reach, reach.cells
        lines = [(line[1:] + line[:-1]) / 2 for line in Lattice(reach.cells.face, reach.cells.shape).lines]
        self._borders = CellBorders(reach.spread_out(np.ones(len(reach.cells), dtype=bool)), (lines[0], lines[1]))

    def divide(self, numbers: Sequence[int], tried: int) -> ReachDivision:
        """The face divided.

        Parameters
        ----------
        numbers : sequence of int
            Of the axes of its sub-surfaces.
        tried : int
            How many axes were looked at.
        """
        reach = self._reach
        rest: Loops = reach.cells.face.outline
        pieces: list[ReachPiece] = []
        goes_to = reach.assign(numbers)
        for place, number in enumerate(numbers):
            left = self._inside(rest)
            held = (goes_to == place) & left
            core = held & (reach.depth[number] > _SMALLER)
            found, rest = self._cut_out(rest, held, ~left)
            for loops in self._group(found):
                inner, margin = self._cut_out(loops, core & self._inside(loops), ~left)
                smaller = tuple(loop for island in inner for loop in island)
                pieces.append(ReachPiece(loops, reach.axes[number], smaller, margin))
        pieces.sort(key=lambda one: -polygon_area(one.loops))
        return ReachDivision(tuple(pieces), tuple(_parts(rest)), tried)

    def _group(self, islands: list[Loops]) -> list[Loops]:
        """Sub-surfaces under one axis: each large island, and the small ones together, or with the largest one where
        they are too little."""
        islands = sorted(islands, key=lambda one: -self._area_of(one))
        large = [one for one in islands if self._area_of(one) >= self._reach.least.piece]
        small = islands[len(large):]
        together = tuple(loop for one in small for loop in one)
        if not large or sum(map(self._area_of, small)) >= self._reach.least.piece:
            return [*large, together] if together else large
        return [large[0] + together, *large[1:]]

    def _area_of(self, loops: Loops) -> float:
        """Area of the cells in a polygon, mm^2."""
        return float(self._cells.area @ self._inside(loops))

    def _cut_out(self, loops: Loops, held: Bools, taken: Bools) -> tuple[list[Loops], Loops]:
        """Islands of a polygon around cells, and the rest of it, crumbs included."""
        if not held.any():
            return [], loops
        for around in self._borders.around(self._reach.spread_out(held), self._reach.spread_out(taken)):
            with suppress(InvalidInput):
                both, rest = divide_nearly(loops, around)
                break
        else:
            return [], loops
        found: list[Loops] = []
        for one in outer_with_holes(both):
            if self._area_of(one) >= _LIFT * self._reach.least.island:
                found.append(one)
            else:
                rest = _unite(rest, one)
        return found, rest

    def _inside(self, loops: Loops) -> Bools:
        """Cells whose contact lies in a polygon, (n,)."""
        if not loops:
            return np.zeros(len(self._cells), dtype=bool)
        return np.asarray(inside(slabs(loops), self._cells.uv))


def _unite(loops: Loops, beside: Loops) -> Loops:
    return unite_polygons(loops, beside) if loops and beside else loops or beside


def _parts(loops: Loops) -> list[Loops]:
    """Polygons that hold anything, with the holes that leave anything out."""
    if not loops:
        return []
    whole = sum(abs(signed_area(loop)) for loop in loops)
    kept = (part for part in outer_with_holes(loops) if polygon_area(part) > _NOTHING * whole)
    return [(part[0], *(hole for hole in part[1:] if abs(signed_area(hole)) > _NOTHING**2 * whole)) for part in kept]

