"""One face on its way to sub-surfaces: lattice, prices of axes, and the divisions that they make cheapest."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Concatenate, NamedTuple, ParamSpec, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, about
from toolaxis.partition.cost_grid import CostGrid, compute_cost_grid
from toolaxis.partition.guillotine import BestCosts, CheapestDivisions, Corners, each_axis, offers, proper
from toolaxis.partition.uv_grid import Lattice
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.direction_grid import own_frame, ring, spiral
from toolaxis.search.face_problem import FaceProblem
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import letters

Array = NDArray[np.float64]

#: Greatest number of sub-surfaces of one face that is looked at.
MOST = 16
#: Angles between the first axes and to those tried around the ones that serve, rad.
_SPACING, _CLOSER = np.radians(8.0), (np.radians(4.0), np.radians(2.0))
#: How many axes that serve the whole face are offered to others.
_FEW = 12
#: Share of a cell below which there is nothing in it.
_NOTHING = 1e-12
#: What the way from a pass over to the next one is worth, mm of cutting: a step aside and two stops.  Without it the
#: waved example was cut into as many small pieces as allowed: 2 % less cutting, but half as many passes more.
LINK = 3.0
#: What one more sub-surface costs unless told, in mm of cutting length: about 6 s at 1000 mm/min.
INDEX_COST = 100.0
#: What it costs where its axis is there already, mm: retract, approach and a mark on the border.
PIECE_COST = 20.0


@dataclass(frozen=True, eq=False)
class Regions(Sequence[Face]):
    """Sub-surfaces of one face.

    Attributes
    ----------
    faces : tuple of Face
        Pieces of the face, labelled "7a", "7b", …; together they are the face.
    axes : (n, 3) array
        The axis of each that the division reckoned with; none where it could not reckon and left the face whole.
    feeds : tuple of str
        Its feed direction.
    lengths : tuple of float
        Its reckoned length, mm: cutting, `LINK` for each pass, and what clean-up is charged.
    curve : (m, 2) array
        Number of sub-surfaces and the least cost reckoned for it, mm or s; inf where there is no division.
    seconds : tuple of float
        The reckoned time of each where the division goes by time; else empty.
    radius : float
        Outer distance of the rings where the face is divided around bosses, inf where by the nearest boss alone, mm; 0
        where by iso-parametric cuts alone.
    """

    faces: tuple[Face, ...]
    axes: Array
    feeds: tuple[str, ...]
    lengths: tuple[float, ...]
    curve: Array
    seconds: tuple[float, ...] = ()
    radius: float = 0.0

    @property
    def costs(self) -> tuple[float, ...]:
        """What the division went by: times where there are some, else lengths."""
        return self.seconds or self.lengths

    def __len__(self) -> int:
        return len(self.faces)

    @overload
    def __getitem__(self, index: int) -> Face: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Face, ...]: ...

    def __getitem__(self, index: int | slice) -> Face | tuple[Face, ...]:
        return self.faces[index]

    def __iter__(self) -> Iterator[Face]:
        return iter(self.faces)


class Solution(NamedTuple):
    """What prices come to: the cheapest axis of every rectangle, and the cheapest divisions."""

    prices: CostGrid
    offers: BestCosts
    division: CheapestDivisions

    @property
    def known(self) -> NDArray[np.intp]:
        """Numbers of sub-surfaces for which there is a division."""
        return np.flatnonzero(np.isfinite(self.division.curve))

    def pieces(self, count: int) -> list[Corners]:
        """Rectangles of the cheapest division into a number of sub-surfaces.

        Parameters
        ----------
        count : int
        """
        return self.division.pieces(count)


class DivisionRow(NamedTuple):
    """A piece of a face with the rectangle that it comes from, in a solution of its divider."""

    piece: Face
    divider: "Divider"
    found: Solution
    box: Corners

    def name_piece(self, label: str) -> Face:
        """The piece with a name of its own."""
        return self.piece.trimmed(self.piece.trims, label)

    @property
    def axis(self) -> Array:
        """The cheapest axis, (3,)."""
        number = self.found.offers.axis[self.box]
        return self.found.prices.axes[number]

    @property
    def feed(self) -> str:
        """The cheapest feed direction with that axis, u or v."""
        return "uv"[self.found.offers.feed[self.box]]

    @property
    def cost(self) -> float:
        """What the rectangle costs with both, mm or s."""
        return float(self.found.offers.cost[self.box])

    @property
    def length(self) -> float:
        """Its reckoned length with both, mm."""
        return self.divider.length(self.found, self.box)


def name_pieces(label: str, rows: list[DivisionRow], curve: Array) -> Regions:
    """Pieces with their names and what the division reckons of each.

    Parameters
    ----------
    label : str
        Of the whole face.
    rows : list of DivisionRow
    curve : (m, 2) array
        As in `Regions`.
    """
    labels = [label]
    if len(rows) > 1:
        labels = [label + letters(k) for k in range(len(rows))]
    faces = tuple(row.name_piece(name) for row, name in zip(rows, labels, strict=True))
    axes = np.array([row.axis for row in rows]).reshape(-1, 3)
    feeds = tuple(row.feed for row in rows)
    lengths = tuple(row.length for row in rows)
    timed = any(row.divider.job.worth.timed is not None for row in rows)
    seconds = tuple(row.cost for row in rows) if timed else ()
    return Regions(faces, axes, feeds, lengths, curve, seconds)


Given = ParamSpec("Given")
Answer = TypeVar("Answer")


def _of_its_face(method: "Callable[Concatenate[Divider, Given], Answer]",
                 ) -> "Callable[Concatenate[Divider, Given], Answer]":
    """The same method; exceptions that leave it tell which face they are about, where several share axes."""
    @wraps(method)
    def told(divider: "Divider", *given: Given.args, **named: Given.kwargs) -> Answer:
        with about(divider.job.worth.face.label):
            return method(divider, *given, **named)

    return told



class Divider:
    """One face, its lattice, and what axes cost on it.

    Parameters
    ----------
    job : FaceProblem
        The face, its surroundings and the price of an axis.
    cells : (int, int)
        Cells of the lattice along u and v.
    most : int
        Greatest number of sub-surfaces.
    progress : Progress
    begin : (k, 3) array, optional
        Axes to begin with, in place of axes all over the hemisphere; the first is known to machine the whole face.
    """

    def __init__(self, job: FaceProblem, cells: tuple[int, int] = (16, 16), most: int = MOST,
                 progress: Progress = NO_PROGRESS, begin: Array | None = None) -> None:
        self.job, self.most, self.progress, self._begin = job, most, progress, begin
        self.lattice = Lattice(job.worth.face, cells)

    @cached_property
    def best(self) -> Solution:
        """The cheapest divisions with an axis for each piece, from axes over the hemisphere and around the best."""
        found = self.solved(self.priced(self._first_axes()))
        for angle in _CLOSER:
            used = self.used(found)
            if len(used):
                near = np.concatenate([ring(axis, float(angle)) for axis in used])
                found = self.solved(found.prices.joined(self.priced(near)))
        return found

    @property
    def curve(self) -> Array:
        """Least cost reckoned with 0, 1, … sub-surfaces, mm or s; inf where there is no such division."""
        return self.best.division.curve

    def used(self, found: Solution) -> Array:
        """Axes that serve in some division, (k, 3).

        Parameters
        ----------
        found : Solution
        """
        places = {int(found.offers.axis[box]) for count in found.known for box in found.pieces(int(count))}
        return found.prices.axes[sorted(places)]

    @_of_its_face
    def candidates(self) -> Array:
        """Axes for sub-surfaces to share: those that serve in some division, and the cheapest for the whole, (k, 3)."""
        nu, nv = self.lattice.cells
        prices = self.best.prices
        whole = self.costs(prices, (0, nu, 0, nv))
        order = np.argsort(whole, kind="stable")[:_FEW]
        return np.concatenate([self.used(self.best), prices.axes[order[np.isfinite(whole[order])]]])

    @_of_its_face
    def priced(self, axes: Array) -> CostGrid:
        """Prices of axes on the lattice.

        Parameters
        ----------
        axes : (k, 3) array
        """
        return compute_cost_grid(self.lattice, self.job.worth, self.job.feasibility, axes, self.progress,
                                 None if self._begin is None else self._begin[0])

    @_of_its_face
    def solved(self, prices: CostGrid, piece_cost: float = 0.0) -> Solution:
        """The cheapest divisions with some axes.

        Parameters
        ----------
        prices : CostGrid
        piece_cost : float
            What each sub-surface costs besides, mm or s.
        """
        found = offers(prices.rates, self._on_the_face(prices.lines), self._pitch, self._ends, prices.extra)
        cost = np.where(self._narrow | self._torn, np.inf, found.cost + piece_cost)
        empty = (self._filled < _NOTHING) & proper(*self.lattice.cells)
        return Solution(prices, found, CheapestDivisions(cost, empty, self.most))

    @_of_its_face
    def costs(self, prices: CostGrid, box: Corners) -> Array:
        """What a rectangle costs with each axis and its better feed, (k,) mm or s; inf where an axis may not be used.

        Parameters
        ----------
        prices : CostGrid
        box : (int, int, int, int)
        """
        return self._each(prices, self._on_the_face(prices.lines), box, self._ends, prices.extra).min(axis=1)

    def length(self, found: Solution, box: Corners) -> float:
        """Reckoned length of a rectangle with its cheapest axis and feed, mm.

        Parameters
        ----------
        found : Solution
        box : (int, int, int, int)
        """
        if self.job.worth.timed is None:
            return float(found.offers.cost[box])
        one = found.prices.of(found.offers.axis[[box[0]], [box[1]], [box[2]], [box[3]]])
        lines = self.lattice.lengths[0][None], self.lattice.lengths[1][None]
        extra = one.extra * self.job.worth.timed.feeds.cut
        costs = self._each(one, self._on_the_face(lines), box, self._strip + LINK, extra)
        return float(costs[0, found.offers.feed[box]])

    def _each(self, prices: CostGrid, gaps: tuple[Array, Array], box: Corners, ends: float, extra: Array) -> Array:
        u0, u1, v0, v1 = box
        rates = prices.rates[:, :, u0:u1 + 1, v0:v1 + 1]
        inside = gaps[0][:, u0:u1, v0:v1 + 1], gaps[1][:, u0:u1 + 1, v0:v1]
        return each_axis(rates, inside, (self._pitch[0][u0:u1], self._pitch[1][v0:v1]), ends, extra[:, u0:u1, v0:v1])

    @cached_property
    def index_cost(self) -> float:
        """What one more sub-surface with an axis of its own costs, mm or s."""
        pace = self.job.worth.timed
        return INDEX_COST if pace is None else self.piece_cost + pace.turning(self._middle)

    @cached_property
    def piece_cost(self) -> float:
        """What one more sub-surface costs where its axis is there already, mm or s."""
        pace = self.job.worth.timed
        return PIECE_COST if pace is None else PIECE_COST / pace.feeds.cut + pace.ends

    def regions(self, count: int) -> Regions:
        """The cheapest division into a number of sub-surfaces, with an axis each.

        Parameters
        ----------
        count : int
        """
        return self.named(self.best, self.best.pieces(count))

    @_of_its_face
    def named(self, found: Solution, boxes: list[Corners]) -> Regions:
        """Sub-surfaces as pieces of the face.

        Parameters
        ----------
        found : Solution
        boxes : list of (int, int, int, int)
        """
        face = self.job.worth.face
        rows = [DivisionRow(face.trimmed(loops), self, found, box) for box in boxes
                for loops in self.lattice.rectangle(box)]
        return name_pieces(face.label, rows, np.stack([found.known, found.division.curve[found.known]], axis=1))

    def _first_axes(self) -> Array:
        if self._begin is not None:
            return self._begin
        normals = self.lattice.normals[self.lattice.material]
        if not len(normals):
            raise InvalidInput(f"face {self.job.worth.face.label} has no place with a normal: it cannot be divided")
        widest = np.pi if np.linalg.norm(normals.mean(axis=0)) < 0.3 else np.pi / 2
        return spiral(own_frame(normals, self._middle), float(_SPACING), float(widest))

    @property
    def _middle(self) -> Array:
        """The mean normal of the face; any where there is none."""
        normals = self.lattice.normals[self.lattice.material]
        middle = normals.mean(axis=0)
        norm = float(np.linalg.norm(middle))
        return np.asarray(middle / norm if norm > 1e-6 else normals[0])

    @property
    def _pitch(self) -> tuple[Array, Array]:
        return np.diff(self.lattice.lines[0]), np.diff(self.lattice.lines[1])

    @property
    def _strip(self) -> float:
        """By how much a pass is longer than its line on the face, mm: the strip of a ball of the cutter's radius."""
        worth = self.job.worth
        return float(2 * np.sqrt(2 * worth.tool.radius * worth.scallop - worth.scallop**2))

    @cached_property
    def _ends(self) -> float:
        """By how much a pass is dearer than its line on the face, mm or s: what it is longer, and its link."""
        pace = self.job.worth.timed
        return self._strip + LINK if pace is None else self._strip / pace.feeds.cut + pace.start_and_stop + pace.ends

    def _on_the_face(self, lines: tuple[Array, Array]) -> tuple[Array, Array]:
        """What lies on the face of lines between nodes."""
        sides = self.lattice.sides
        return lines[0] * sides[0], lines[1] * sides[1]

    @cached_property
    def _filled(self) -> Array:
        """Cells' worth of material in every rectangle, by first and last line along u and along v."""
        nu, nv = self.lattice.cells
        total = np.zeros((nu + 1, nv + 1))
        total[1:, 1:] = self.lattice.filled.cumsum(axis=0).cumsum(axis=1)
        across = total[None, :, :] - total[:, None, :]
        return np.asarray(across[:, :, None, :] - across[:, :, :, None])

    @cached_property
    def _torn(self) -> NDArray[np.bool_]:
        """Rectangles in which the face falls apart, though it hangs together: they are no one piece."""
        from scipy.ndimage import label

        found = np.zeros(self._filled.shape, dtype=bool)
        cells = self.lattice.filled > _NOTHING
        if not cells.all():
            for u0, u1, v0, v1 in np.argwhere(proper(*self.lattice.cells)):
                found[u0, u1, v0, v1] = label(cells[u0:u1, v0:v1])[1] > 1
            found[0, -1, 0, -1] = False
        return found

    @cached_property
    def _narrow(self) -> NDArray[np.bool_]:
        """Rectangles that are narrower than the cutter, though the face is not: marks without use."""
        found = np.zeros(self._filled.shape, dtype=bool)
        for axis, gaps in enumerate(self._on_the_face(self.lattice.lengths)):
            lines = np.maximum((gaps > 0).sum(axis=1 - axis), 1)
            line = np.concatenate([[0.0], np.cumsum(gaps.sum(axis=1 - axis) / lines)])
            apart = line[None] - line[:, None]
            thin = (apart < 2 * self.job.worth.tool.radius) & (apart < line[-1])
            found |= thin[:, :, None, None] if axis == 0 else thin[None, None]
        return found
