"""Faces divided into sub-surfaces that fixed axes cut in the least length."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.limits import AxisLimits
from toolaxis.orient.indexed import Task, combined, task
from toolaxis.orient.setting import Obstacles
from toolaxis.orient.spiral import own_frame, ring, spiral
from toolaxis.partition.guillotine import Corners, Division, Offers, offers, proper
from toolaxis.partition.lattice import Lattice
from toolaxis.partition.prices import Prices, priced
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import letters
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]

#: Greatest number of sub-surfaces of one face that is looked at.
MOST = 16
#: What one more sub-surface costs unless told, in mm of cutting length: about 6 s at 1000 mm/min.
INDEX_COST = 100.0
#: Angles between the first axes and to those tried around the ones that serve, rad.
_SPACING, _CLOSER = np.radians(8.0), (np.radians(4.0), np.radians(2.0))


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
        Its reckoned cutting length, mm.
    curve : (m, 2) array
        Number of sub-surfaces and the least cutting length reckoned for it, mm; inf where there is no division.
    """

    faces: tuple[Face, ...]
    axes: Array
    feeds: tuple[str, ...]
    lengths: tuple[float, ...]
    curve: Array

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


class Divider:
    """One face on its way to sub-surfaces.

    Parameters
    ----------
    job : Task
        The face, its surroundings and the price of an axis.
    cells : (int, int)
        Cells of the lattice along u and v.
    most : int
        Greatest number of sub-surfaces.
    progress : Progress
    """

    def __init__(self, job: Task, cells: tuple[int, int] = (16, 16), most: int = MOST,
                 progress: Progress = NO_PROGRESS) -> None:
        self.job, self.most, self.progress = job, most, progress
        self.lattice = Lattice(job.worth.face, cells)
        self.prices = self._priced(self._first_axes())
        self.offers, self.division = self._solved()
        for angle in _CLOSER:
            self._look_around(angle)

    @property
    def curve(self) -> Array:
        """Least cutting length with 0, 1, … sub-surfaces, mm."""
        return self.division.curve

    def _first_axes(self) -> Array:
        normals = self.lattice.normals[self.lattice.material]
        if not len(normals):
            raise InvalidInput(f"face {self.job.worth.face.label} has no place with a normal: it cannot be divided")
        middle = normals.mean(axis=0)
        norm = float(np.linalg.norm(middle))
        middle = middle / norm if norm > 1e-6 else normals[0]
        return spiral(own_frame(normals, middle), float(_SPACING), float(np.pi) if norm < 0.3 else float(np.pi) / 2)

    def _priced(self, axes: Array) -> Prices:
        return priced(self.lattice, self.job.worth, self.job.feasibility, axes, self.progress)

    def _solved(self) -> tuple[Offers, Division]:
        lattice = self.lattice
        pitch = np.diff(lattice.lines[0]), np.diff(lattice.lines[1])
        ends = 2 * np.sqrt(2 * self.job.worth.tool.radius * self.job.worth.scallop - self.job.worth.scallop**2)
        found = offers(self.prices.rates, self._gaps, pitch, float(ends))
        cost = np.where(self._narrow, np.inf, found.cost)
        return found, Division(cost, (self._filled == 0) & proper(*lattice.cells), self.most)

    @cached_property
    def _gaps(self) -> tuple[Array, Array]:
        """Length of the face's lines between nodes, mm."""
        points, filled = self.lattice.points, self.lattice.filled
        found = []
        for axis in (0, 1):
            length = np.linalg.norm(np.diff(points, axis=axis), axis=-1)
            sides = np.zeros(length.shape)
            cells = np.moveaxis(filled, 1 - axis, 0)
            view = np.moveaxis(sides, 1 - axis, 0)
            view[:-1] += cells
            view[1:] += cells
            view[1:-1] /= 2
            found.append(length * sides)
        return found[0], found[1]

    @cached_property
    def _filled(self) -> Array:
        """Cells' worth of material in every rectangle, by first and last line along u and along v."""
        nu, nv = self.lattice.cells
        total = np.zeros((nu + 1, nv + 1))
        total[1:, 1:] = self.lattice.filled.cumsum(axis=0).cumsum(axis=1)
        across = total[None, :, :] - total[:, None, :]
        return np.asarray(across[:, :, :, None] - across[:, :, None, :])

    @cached_property
    def _narrow(self) -> NDArray[np.bool_]:
        """Rectangles that are narrower than the cutter, though the face is not: marks without use."""
        found = np.zeros(self._filled.shape, dtype=bool)
        for axis, gaps in enumerate(self._gaps):
            lines = np.maximum((gaps > 0).sum(axis=1 - axis), 1)
            line = np.concatenate([[0.0], np.cumsum(gaps.sum(axis=1 - axis) / lines)])
            apart = line[None] - line[:, None]
            thin = (apart < 2 * self.job.worth.tool.radius) & (apart < line[-1])
            found |= thin[:, :, None, None] if axis == 0 else thin[None, None]
        return found

    def _look_around(self, angle: float) -> None:
        """Price the axes around those that serve some division, and solve again."""
        used = sorted({int(self.offers.axis[box]) for count in range(1, self.most + 1)
                       if np.isfinite(self.curve[count]) for box in self.division.pieces(count)})
        if used:
            near = np.concatenate([ring(self.prices.axes[k], angle) for k in used])
            self.prices = self.prices.joined(self._priced(near))
            self.offers, self.division = self._solved()

    def regions(self, count: int) -> Regions:
        """The cheapest division into a number of sub-surfaces.

        Parameters
        ----------
        count : int
        """
        boxes = self.division.pieces(count)
        faces: list[Face] = []
        owners: list[Corners] = []
        for box in boxes:
            for loops in self.lattice.rectangle(box):
                faces.append(self.job.worth.face.trimmed(loops))
                owners.append(box)
        label = self.job.worth.face.label
        named = tuple(face.trimmed(face.trims, label + letters(k) if len(faces) > 1 else label)
                      for k, face in enumerate(faces))
        axes = np.array([self.prices.axes[self.offers.axis[box]] for box in owners]).reshape(-1, 3)
        feeds = tuple("uv"[self.offers.feed[box]] for box in owners)
        known = np.flatnonzero(np.isfinite(self.curve))
        lengths = tuple(float(self.offers.cost[box]) for box in owners)
        return Regions(named, axes, feeds, lengths, np.stack([known, self.curve[known]], axis=1))


def partition(source: Face | Part, tool: Tool, scallop: float, count: int | str | None = None, *,
              machine: AxisLimits | str | None = None, obstacles: Obstacles = None, part: Part | None = None,
              faces: Sequence[int] | None = None, tolerance: Tolerance | None = None, allowance: float = 0.0,
              index_cost: float = INDEX_COST, progress: Progress = NO_PROGRESS) -> tuple[Face, ...]:
    """Divide faces into sub-surfaces so that fixed axes, one for each, cut them in the least length.

    Parameters
    ----------
    source : Face or Part
        A part's sculptured faces are divided one by one.
    tool : Tool
    scallop : float
        Scallop height, mm.
    count : int or "auto", optional
        Sub-surfaces for each face, at most 16; what pays for its index moves unless given.
    machine : AxisLimits or str, optional
        What the machine allows; see `toolaxis.machine.limits`.
    obstacles : Part, Face or sequence of Face, optional
        What the tool must keep away from besides the part.
    part : Part, optional
        The part that a single face belongs to, by its number.
    faces : sequence of int, optional
        Faces of a part instead of its sculptured ones.
    tolerance : Tolerance, optional
    allowance : float
        Stock left on the faces, mm.
    index_cost : float
        What one more sub-surface costs, in mm of cutting length: its index move, retract and mark on the border.
    progress : Progress

    Returns
    -------
    tuple of Face
        Pieces of the faces with their own trims, in the order of the faces; `regions` tells more of a single face.

    Raises
    ------
    InvalidInput
        When an argument is out of range, or a face cannot be divided into so many sub-surfaces.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [zhu2016] Sec. 5.1 takes the division as given; here it is the cheapest one by cuts along iso-parametric
    lines of a lattice, each piece with its cheapest axis and feed, from exact strip widths at the nodes.

    **Properties**: 1. the pieces are the face, without overlap; 2. more sub-surfaces never take more length.
    """
    whole, chosen = part, [source] if isinstance(source, Face) else []
    if isinstance(source, Part):
        whole, chosen = source, [source.face(number) for number in faces] if faces else list(source.sculptured)
        if not chosen:
            raise InvalidInput("the part has no sculptured face: name faces, planes and cylinders among them")
    pieces: list[Face] = []
    for face in chosen:
        job = task(face, tool, scallop, combined(machine, None), obstacles, part=whole, tolerance=tolerance,
                   allowance=allowance)
        pieces += regions(job, count, index_cost, progress.within(f"face {face.label}")).faces
    return tuple(pieces)


def regions(job: Task, count: int | str | None = None, index_cost: float = INDEX_COST,
            progress: Progress = NO_PROGRESS) -> Regions:
    """Divide one face.

    Parameters
    ----------
    job : Task
        From `toolaxis.orient.indexed.task`.
    count, index_cost, progress
        As for `partition`.

    Raises
    ------
    InvalidInput
        When the face cannot be divided into so many sub-surfaces.
    Cancelled
        When the user asked to stop.
    """
    number = checked_count(count)
    divider = Divider(job, most=MOST if number is None else number, progress=progress)
    known = np.flatnonzero(np.isfinite(divider.curve))
    label = job.worth.face.label
    if not len(known) and number in (None, 1):
        return Regions((job.worth.face,), np.zeros((0, 3)), (), (), np.zeros((0, 2)))
    if number is None:
        number = int(known[np.argmin(divider.curve[known] + index_cost * known)])
    if number not in known:
        raise InvalidInput(f"face {label} cannot be divided into {number} sub-surfaces: {_why_not(divider, number)}")
    return divider.regions(number)


def _why_not(divider: Divider, number: int) -> str:
    known = np.flatnonzero(np.isfinite(divider.curve))
    if len(known) and number > known[-1]:
        return f"at most {known[-1]} are wider than the cutter"
    return "some places allow no axis that goes with their neighbours' one; ask for more, or take a smaller tool, a " \
           "longer stick-out or fewer obstacles"


def checked_count(count: int | str | None) -> int | None:
    """A number of sub-surfaces, or None for "auto".

    Parameters
    ----------
    count : int, "auto" or None

    Raises
    ------
    InvalidInput
        When it is neither, or out of range.
    """
    if count is None or count == "auto":
        return None
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or not 1 <= count <= MOST:
        raise InvalidInput(f"number of sub-surfaces is {count!r}: it must be a whole number from 1 to {MOST}, or auto")
    return int(count)
