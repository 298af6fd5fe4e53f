"""Faces divided by the distance to their bosses: rings around them, cuts where two are equally far, and the rest."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.contours import contours
from toolaxis.numeric.grids import grid_nodes
from toolaxis.numeric.polygon_boolean import divide_polygon
from toolaxis.numeric.sparse_grid import SparseGrid
from toolaxis.partition.cost_grid import CostGrid
from toolaxis.partition.face_division import Divider, DivisionRow, Regions, Solution, name_pieces
from toolaxis.partition.guillotine import Corners
from toolaxis.partition.uv_grid import Lattice
from toolaxis.search.direction_grid import ring
from toolaxis.shape.face import Face
from toolaxis.shape.measure import mean_width
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Distance = Callable[[Array], Array]
Loops = tuple[Array, ...]

#: Radii of rings that are tried, in diameters of the cutter.
RINGS = (1.0, 1.75, 3.0)
#: Lines of the grid on which borders are traced.
_GRID = 120
#: Pieces with less mean width than this share of the cutter's radius are slivers.
_SLIVER = 1.0
_CLOSER = (np.radians(4.0), np.radians(2.0))
_TRIES = 6


@dataclass(frozen=True, eq=False)
class RingDivision:
    """One division by distance: parts of the face, each divided further by iso-parametric cuts where that pays.

    Attributes
    ----------
    radius : float
        Outer distance of the rings, mm; inf where the whole face is divided by the nearest boss.
    parts : tuple of Divider
        One a part, on the lattice of the whole face.
    prices : CostGrid
        Of the whole face.
    """

    radius: float
    parts: tuple[Divider, ...]
    prices: CostGrid

    @cached_property
    def solutions(self) -> tuple[Solution, ...]:
        """The cheapest divisions of each part."""
        return tuple(part.solved(_mask_costs(self.prices, part.lattice)) for part in self.parts)

    @cached_property
    def shares(self) -> Array:
        """Least cost of the first 1, 2, … parts together with 0, 1, … sub-surfaces, (parts, most + 1) mm or s."""
        rows = [self.solutions[0].division.curve]
        for one in self.solutions[1:]:
            rows.append(_together(rows[-1], one.division.curve))
        return np.array(rows)

    @property
    def curve(self) -> Array:
        """Least cost reckoned with 0, 1, … sub-surfaces, mm or s; inf where there is no such division."""
        return np.asarray(self.shares[-1])

    def boxes(self, count: int) -> list[list[Corners]]:
        """Rectangles of each part in the cheapest division.

        Parameters
        ----------
        count : int
        """
        found: list[list[Corners]] = []
        for k in range(len(self.parts) - 1, -1, -1):
            own = self.solutions[k].division.curve
            before = self.shares[k - 1] if k else np.where(np.arange(len(own)) == 0, 0.0, np.inf)
            mine = int(np.argmin([before[count - m] + own[m] for m in range(count + 1)]))
            found.append(self.solutions[k].pieces(mine))
            count -= mine
        return found[::-1]

    def closer(self, whole: Divider, count: int) -> "RingDivision":
        """The same with axes around those that serve.

        Parameters
        ----------
        whole : Divider
            Of the whole face, which prices axes.
        count : int
            Number of sub-surfaces.
        """
        best = self
        for angle in _CLOSER:
            places = {int(one.offers.axis[box]) for one, boxes in zip(best.solutions, best.boxes(count), strict=True)
                      for box in boxes}
            near = np.concatenate([ring(best.prices.axes[k], float(angle)) for k in sorted(places)])
            best = RingDivision(self.radius, self.parts, best.prices.joined(whole.priced(near)))
        return best

    def regions(self, count: int) -> Regions:
        """The sub-surfaces of the cheapest division.

        Parameters
        ----------
        count : int
        """
        rows = [DivisionRow(part.job.worth.face.trimmed(loops), part, one, box)
                for part, one, boxes in zip(self.parts, self.solutions, self.boxes(count), strict=True)
                for box in boxes for loops in part.lattice.rectangle(box)]
        known = np.flatnonzero(np.isfinite(self.curve))
        told = name_pieces(self.parts[0].job.worth.face.label, rows, np.stack([known, self.curve[known]], axis=1))
        return replace(told, radius=self.radius)


def candidates(whole: Divider, bosses: Sequence[Distance]) -> tuple[RingDivision, ...]:
    """Divisions of a face by the distance to its bosses.

    Parameters
    ----------
    whole : Divider
        Of the whole face.
    bosses : sequence of callable
        Each takes (n, 2) parameters and returns the distance to one boss, (n,) mm.

    Returns
    -------
    tuple of RingDivision
        Rings of a few radii, and, where there are several bosses, the whole face by the nearest; none where that leaves
        slivers.

    Notes
    -----
    **Source**: [zhu2016] Sec. 6.5 parts a face by the distance to its boss, and between bosses first; radii and
    further cuts are left open there and are those of the least cutting length here.

    **Properties**: 1. parts are the face, without overlap.
    """
    face, tool = whole.job.worth.face, whole.job.worth.tool
    prices = whole.best.prices.of(_worth_a_try(whole.best))
    found = []
    for radius in [*(2 * tool.radius * share for share in RINGS), *([np.inf] if len(bosses) > 1 else [])]:
        try:
            parts = divide_in_rings(face, bosses, radius)
        except InvalidInput:  # this radius leaves borders that cannot be told apart: others may not
            continue
        if len(parts) > 1 and len(parts) <= whole.most and not any(_thin(part, tool.radius) for part in parts):
            found.append(RingDivision(radius, tuple(_on_lattice(whole, part) for part in parts), prices))
    return tuple(found)


def divide_in_rings(face: Face, bosses: Sequence[Distance], radius: float) -> tuple[Face, ...]:
    """A face parted into rings around bosses and the rest.

    Parameters
    ----------
    face : Face
    bosses : sequence of callable
        Each takes (n, 2) parameters and returns the distance to one boss, (n,) mm.
    radius : float
        Outer distance of the rings, mm; inf for no rest.

    Returns
    -------
    tuple of Face
        Connected parts: of each boss what is nearest to it, then what is farther than the radius from all; the face
        itself where nothing parts it.

    Raises
    ------
    InvalidInput
        When borders cannot be told apart from the face's own.
    """
    near: Loops = face.outline
    rest: Loops = ()
    if np.isfinite(radius):
        near, rest = _split(face, near, lambda uv: radius - np.min([boss(uv) for boss in bosses], axis=0))
    loops: list[Loops] = []
    for k, boss in enumerate(bosses[:-1]):
        own, near = _split(face, near, lambda uv, k=k, boss=boss: np.min(  # type: ignore[misc]
            [other(uv) for other in bosses[k + 1:]], axis=0) - boss(uv))
        loops.append(own)
    return tuple(face.trimmed(one) for part in (*loops, near, rest) for one in outer_with_holes(part))


def _split(face: Face, loops: Loops, function: Distance) -> tuple[Loops, Loops]:
    """The part of loops where a function is above zero, and the rest."""
    if not loops:
        return (), ()
    u0, u1, v0, v1 = face.bounds
    for attempt in range(_TRIES):
        beyond = 0.0317 + 0.0041 * attempt
        lines = tuple(np.linspace(a - beyond * (b - a), b + beyond * (b - a), _GRID) for a, b in ((u0, u1), (v0, v1)))
        nodes = grid_nodes(*lines)
        values = function(nodes.reshape(-1, 2)).reshape(_GRID, _GRID)
        line = contours(SparseGrid.of_all((lines[0], lines[1]), values), function)
        try:
            return divide_polygon(loops, line)
        except InvalidInput:
            continue
    raise InvalidInput(f"face {face.label} cannot be divided by the distance to its bosses: borders coincide")


def _worth_a_try(found: Solution) -> NDArray[np.intp]:
    """The axes that are the cheapest of some rectangle."""
    return np.unique(found.offers.axis[np.isfinite(found.offers.cost)])


def _on_lattice(whole: Divider, part: Face) -> Divider:
    """A part of the face on the lattice of the whole."""
    job = replace(whole.job, worth=replace(whole.job.worth, face=part))
    own = Divider(job, whole.lattice.cells, whole.most, whole.progress)
    own.lattice = Lattice(part, whole.lattice.cells)
    own.lattice.__dict__["lines"] = whole.lattice.lines
    return own


def _mask_costs(prices: CostGrid, lattice: Lattice) -> CostGrid:
    """Prices of the whole face on a part of it."""
    whole = prices.whole
    share = np.divide(lattice.areas, whole, out=np.zeros_like(whole), where=whole > 0)
    return replace(prices, rates=np.where(lattice.material, prices.rates, 0.0), left=prices.left & lattice.material,
                   extra=prices.extra * np.minimum(share, 1.0), whole=lattice.areas)


def _together(one: Array, other: Array) -> Array:
    """Least sums of two costs over all ways to share a number."""
    most = len(one)
    return np.array([min(one[k] + other[n - k] for k in range(n + 1)) for n in range(most)])


def _thin(part: Face, radius: float) -> bool:
    """Whether a part is a sliver: narrower on the mean than the cutter's radius."""
    return mean_width(part) < _SLIVER * radius


def slivers(found: Regions, tool: Tool) -> bool:
    """Whether a piece of a division is a sliver: narrower on the mean than the cutter's radius.

    Parameters
    ----------
    found : Regions
    tool : Tool
    """
    return any(_thin(piece, tool.radius) for piece in found.faces)
