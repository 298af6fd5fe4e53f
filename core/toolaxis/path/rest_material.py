"""Zones of a sub-surface that its passes leave higher than the scallop limit, as closed loops with their area."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.strip.swept_volume import sweep_motions
from toolaxis.errors import InvalidInput
from toolaxis.numeric.blocks import in_blocks
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.contours import contours
from toolaxis.numeric.polygon_boolean import divide_nearly, without
from toolaxis.numeric.polygons import polygon_area
from toolaxis.numeric.sparse_grid import SparseGrid
from toolaxis.path.rest_grid import FINE, sample_again, sample_grid
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
T = TypeVar("T")

#: Heights count as left from this multiple of the scallop limit on.
FACTOR = 1.02
#: Zones that do not come to this multiple of the limit, or are smaller than this share of the cutter's radius squared,
#: are specks: no work for anybody.
DEEP, _SPECK = 2.0, 1e-3
#: Share of a face, clean-up zones aside, that may stay high: specks and undercut zones together. The judge overlooks
#: twice as much of the same area: the other half is for what lies between the nodes of the grid here, and between the
#: rays there.
OVERLOOKED = 5e-4
#: Size of the cells that outline zones, as shares of the cutter's radius, of the narrowest strip that it may leave, and
#: of a square as large as the face.
_OF_RADIUS, _OF_STRIP, _OF_FACE = 1 / 14, 1 / 20, 1 / 200
#: Share of what is machined that may lie in cells on the border of zones before these are made smaller, and how many
#: there are along a side then at most: pieces as narrow as the ends of strips add up there.
_ON_BORDER, _FINEST = 0.1, 6000
#: Distances are told up to this, mm: only their signs are asked for.
_FAR = 1e-3
#: How much farther than its corners and the middles of its sides a cell may reach from its middle.
_BULGE = 1.2
#: How closely the border of a zone is found on the edges of fine cells, mm.
_CLOSE = 1e-4
#: Share of a face's range of parameters below which a zone is so small that its area is not integrated.
_CRUMB = 2e-4
#: Nodes at which it is looked first whether a zone is deep.
_FIRST = 500


def motions_of(path: ToolPath) -> tuple[Array, Array]:
    """Tips at the start and the end of every cutting motion, (m, 3) each.

    Parameters
    ----------
    path : ToolPath
    """
    at = np.flatnonzero(path.kind[1:] == Motion.CUT)
    return path.cl[at], path.cl[at + 1]


class Excess:
    """By how much points at a height above a face stay outside of what the passes remove.

    Parameters
    ----------
    face : Face
    tool : Tool
    path : ToolPath
        With one fixed axis.
    height : float
        Above the face, allowance included, mm.
    motions : pair of (m, 3) arrays, optional
        Tips at the start and the end of the motions that count; all cutting motions of the path unless given.
    """

    def __init__(self, face: Face, tool: Tool, path: ToolPath, height: float,
                 motions: tuple[Array, Array] | None = None) -> None:
        self._face, self._tool, self._height = face, tool, height
        self._swept = sweep_motions(path.axis[0], *(motions_of(path) if motions is None else motions))

    def __call__(self, uv: Array, most: float = _FAR) -> Array:
        """Numbers (n,) at parameters (n, 2), beyond the face too: above zero where more than that height is left.

        Parameters
        ----------
        uv : (n, 2) array
        most : float
            Up to how much more is told, mm.
        """
        return self._distance(self._raise_points(uv), most)

    def whole(self, middle: Array, around: Array) -> Bools:
        """Which cells of the face are left all over: their middles are farther from what is removed than they reach.

        Parameters
        ----------
        middle : (k, 2) array
        around : (k, 8, 2) array
            Corners and middles of the sides of each.
        """
        at = self._raise_points(middle)
        ends = self._raise_points(around.reshape(-1, 2)).reshape(*around.shape[:2], 3)
        reach = _BULGE * np.linalg.norm(ends - at[:, None], axis=2).max(axis=1)
        left = self._distance(at, _FAR) > 0  # most middles are cut: how far others are takes long to tell
        greatest = float(reach[left].max(initial=0.0))
        left[left] = self._distance(at[left], greatest) >= reach[left]
        return left

    def _raise_points(self, uv: Array) -> Array:
        return in_blocks(self._raise_some, uv)

    def _raise_some(self, uv: Array) -> Array:
        d = self._face.evaluate(uv)
        return np.asarray(d.point + self._height * self._face.normal(uv, d))

    def _distance(self, points: Array, most: float) -> Array:
        return self._swept.distance(self._tool, points, most, 0.0)


@dataclass(frozen=True, eq=False)
class _RestSeen:
    """What was seen when it was looked at some passes.

    motions : frozenset of bytes, the cutting motions;  grid : SparseGrid, above zero where something is left.
    """

    motions: frozenset[bytes]
    grid: SparseGrid


@dataclass(eq=False)
class _KnownZone:
    """What is known of a zone, worked out when it is first asked for.

    zone : that piece of the sub-surface;  area : mm^2;  speck : whether it is too small or too shallow to be told;
    at_wall : None before it is asked for.
    """

    zone: Face
    area: float
    speck: bool
    at_wall: bool | None = None


@dataclass(eq=False)
class RestFinder:
    """Finds the zones that passes over one sub-surface leave higher than the scallop limit.

    More passes never leave more.  Where all passes of an earlier look are among those of the next one, it is looked
    only where they left something, and only at what the others cut of that.

    Attributes
    ----------
    face : Face
        The sub-surface.
    tool : Tool
    scallop : float
        Limit of the scallop height, mm.
    allowance : float
        Stock left on the face, mm.
    walls : callable or None
        Takes (n, 2) parameters and tells where the tool may not stand; all zones lie at walls where there is none.
    progress : Progress
    between : (k, 2) array or None
        Further parameters at which it is looked, see `toolaxis.path.pass_layout.places_between`.
    """

    face: Face
    tool: Tool
    scallop: float
    allowance: float = 0.0
    walls: Callable[[Array], Bools] | None = None
    progress: Progress = NO_PROGRESS
    between: Array | None = None
    _last: _RestSeen | None = None
    _known: dict[bytes, _KnownZone] = field(default_factory=dict)

    def find(self, path: ToolPath) -> tuple[Zone, ...]:
        """The zones that the passes of a path leave, the largest first.

        Parameters
        ----------
        path : ToolPath
            With one fixed axis; its cutting motions count.

        Returns
        -------
        tuple of Zone
            A zone is what stays higher than `FACTOR` times the limit; small and shallow ones are left out where they
            are less than `may_stay` together with those that do not lie at walls.

        Raises
        ------
        Cancelled
            When the user asked to stop.

        Notes
        -----
        The border of a zone is the line on which the surface, raised by that height, meets the swept cutter: exact at
        the vertices, straight between them, which are a fourteenth of the cutter's radius apart or less.  Zones inside
        the sub-surface that lie between the nodes of a coarse grid, and at no place that is given, may be missed; at
        its border it is looked at closely everywhere, and where something is found, as far as it goes.

        **Properties**: 1. zones and machined area are the sub-surface, without overlap; 2. after an earlier look no
        zone is missed that a first look would find.
        """
        if not len(motions_of(path)[0]):
            return (Zone(self.face.outline, self.face.area),)
        self.progress.check()
        high = Excess(self.face, self.tool, path, self.allowance + FACTOR * self.scallop)
        look = self._last = self._look(path, high)
        nodes = look.grid.places_of(look.grid.above)
        if not len(nodes):
            return ()
        self.progress.check()
        found = contours(look.grid, high, _halvings(self.face, self.tool, self.scallop))
        self.progress.check()
        return self._zones_in(found, path, nodes)

    def _look(self, path: ToolPath, high: Excess) -> _RestSeen:
        """What is left at the nodes of a grid."""
        starts, ends = motions_of(path)
        rows = _name_motions(starts, ends)
        motions = frozenset(rows)
        if self._last is None or not self._last.motions <= motions:
            return _RestSeen(motions, self._sample(high))
        new = np.array([row not in self._last.motions for row in rows])
        fresh = Excess(self.face, self.tool, path, self.allowance + FACTOR * self.scallop, (starts[new], ends[new]))
        return _RestSeen(motions, sample_again(self._last.grid, fresh, fresh.whole))

    def _sample(self, high: Excess) -> SparseGrid:
        """A grid as fine as the border of the zones asks for, and what is left at its nodes."""
        face, size = self.face, _size(self.face, self.tool, self.scallop)
        grid = sample_grid(face, high, size, high.whole, self.between)
        on_border = _share_on_border(face, grid)
        if max(grid.shape) < FINE or on_border <= _ON_BORDER:
            return grid
        self.progress.check()
        most = min(round(FINE * on_border / _ON_BORDER), _FINEST)
        return sample_grid(face, high, size, high.whole, self.between, most)

    def _zones_in(self, found: tuple[Array, ...], path: ToolPath, nodes: Array) -> tuple[Zone, ...]:
        """The zones within loops, the largest first, without what is too small or too shallow to be told."""
        face = self.face
        deep = Excess(face, self.tool, path, self.allowance + DEEP * self.scallop)
        zones = [face.trimmed(loops) for loops in outer_with_holes(split(face.outline, found)[0])]
        # Most zones stay as they were from one look to the next: further passes are few.
        fresh = [zone for zone in zones if _name_zone(zone) not in self._known]
        for zone, area in zip(fresh, _areas(face, fresh), strict=True):
            speck = area <= _SPECK * self.tool.radius**2 or not _deep(zone, deep, nodes)
            self._known[_name_zone(zone)] = _KnownZone(zone, area, speck)
        small, large = _partition_by([self._known[_name_zone(zone)] for zone in zones], lambda known: known.speck)
        told = tuple(map(self._tell, large))
        if undercut(told) + sum(known.area for known in small) > may_stay(told, face.area):
            told += tuple(map(self._tell, small))
        return tuple(sorted(told, key=lambda zone: -zone.area))

    def _tell(self, known: _KnownZone) -> Zone:
        """A zone as it is told."""
        if known.at_wall is None:
            known.at_wall = _at_wall(known.zone, self.walls)
        return Zone(known.zone.trims, known.area, known.at_wall)


def _name_zone(zone: Face) -> bytes:
    """A name for a zone, that of another only where all corners of both are the same."""
    return b"".join(loop.tobytes() for loop in zone.trims)


def _name_motions(starts: Array, ends: Array) -> list[bytes]:
    """A name for each motion, the same for either way along it."""
    turned = (starts[:, 0] > ends[:, 0]) | ((starts[:, 0] == ends[:, 0]) & (starts[:, 1] > ends[:, 1]))
    rows = np.where(turned[:, None], np.hstack([ends, starts]), np.hstack([starts, ends]))
    return [row.tobytes() for row in np.ascontiguousarray(rows)]


def _areas(face: Face, zones: Sequence[Face]) -> list[float]:
    """Areas of zones of a face, mm^2: those of crumbs from the mean area per parameter along their borders."""
    if not zones:
        return []
    sizes = [polygon_area(zone.trims) for zone in zones]
    u0, u1, v0, v1 = face.bounds
    d = face.evaluate(np.concatenate([zone.trims[0] for zone in zones]))
    first = np.cumsum([0, *(len(zone.trims[0]) for zone in zones[:-1])])
    counts = np.diff([*first, len(d.su)])
    density = np.add.reduceat(np.linalg.norm(np.cross(d.su, d.sv), axis=1), first) / counts
    return [float(size * here) if size <= _CRUMB * (u1 - u0) * (v1 - v0) else zone.area
            for zone, size, here in zip(zones, sizes, density, strict=True)]


def undercut(zones: Sequence[Zone]) -> float:
    """Area of the zones that do not lie at walls, mm^2.

    Parameters
    ----------
    zones : sequence of Zone
    """
    return sum(zone.area for zone in zones if not zone.at_wall)


def may_stay(zones: Sequence[Zone], area: float) -> float:
    """How much of a face may stay high outside of the zones at walls, mm^2.

    Parameters
    ----------
    zones : sequence of Zone
    area : float
        Of the face, mm^2.
    """
    return OVERLOOKED * max(0.0, area - sum(zone.area for zone in zones if zone.at_wall))


def _partition_by(some: Sequence[T], test: Callable[[T], bool]) -> tuple[list[T], list[T]]:
    """Those that pass a test, and the others."""
    passed = [test(one) for one in some]
    return ([one for one, good in zip(some, passed, strict=True) if good],
            [one for one, good in zip(some, passed, strict=True) if not good])


def split(outline: tuple[Array, ...], loops: tuple[Array, ...]) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """What of an outline lies inside loops, and the rest; loops are moved by a millionth of their size where corners
    coincide.

    Parameters
    ----------
    outline, loops : tuple of (m, 2) arrays
    """
    try:
        return divide_nearly(outline, loops)
    except InvalidInput as reason:
        raise InvalidInput("zones cannot be cut out of the face: their borders coincide with its own") from reason


def also_machined(face: Face, zone: Zone, others: Sequence[Excess]) -> Zone:
    """A zone with the area of it that other operations machine.

    Parameters
    ----------
    face : Face
    zone : Zone
    others : sequence of Excess
        One an operation.
    """
    piece = face.trimmed(zone.loops)
    uv = piece.grid(48, 48)
    if not others or not len(uv):
        return zone
    d = face.evaluate(uv)
    weight = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    free = np.min([other(uv) for other in others], axis=0) <= 0
    return replace(zone, elsewhere=float(zone.area * weight[free].sum() / max(weight.sum(), np.finfo(float).tiny)))


def machined_regions(face: Face, zones: tuple[Zone, ...]) -> tuple[Face, ...]:
    """A sub-surface without its zones, as pieces.

    Parameters
    ----------
    face : Face
    zones : tuple of Zone
        Of this very sub-surface.
    """
    loops: tuple[Array, ...] = face.outline
    for zone in zones:
        loops = without(loops, zone.loops)
    return tuple(face.trimmed(one) for one in outer_with_holes(loops))


def _size(face: Face, tool: Tool, scallop: float) -> float:
    """Size of the cells that outline zones, mm: passes leave pieces as narrow as the ends of their strips."""
    strip = 2 * np.sqrt(2 * (tool.corner_radius or tool.radius) * scallop)
    return float(min(_OF_RADIUS * tool.radius, _OF_STRIP * strip, _OF_FACE * np.sqrt(face.area)))


def _halvings(face: Face, tool: Tool, scallop: float) -> int:
    """How often the edges of fine cells are halved to find the border of a zone."""
    return max(1, int(np.ceil(np.log2(_size(face, tool, scallop) / _CLOSE))))


def _share_on_border(face: Face, grid: SparseGrid) -> float:
    """Area of the cells on the border of what is above zero, as a share of what of the face is not above zero."""
    cells = grid.cells_on_border()
    within = ((cells > 0) & (cells < grid.shape)).all(axis=1)
    cell = float(np.diff(grid.lines[0]).mean() * np.diff(grid.lines[1]).mean())
    border = cell * np.count_nonzero(within)
    whole = sum(map(polygon_area, outer_with_holes(face.outline)))
    machined = whole - cell * len(grid.above)
    return float(border / max(machined, cell))


def _deep(zone: Face, deep: Excess, nodes: Array) -> bool:
    """Whether a zone comes to `DEEP` times the limit at its border or at nodes, (n, 2), of the grid."""
    u0, u1, v0, v1 = zone.bounds
    u, v = nodes.T
    near = nodes[(u >= u0) & (u <= u1) & (v >= v0) & (v <= v1)]
    # A few of them first: they often tell.
    few = near[::max(1, len(near) // _FIRST)]
    first = np.concatenate([few, *zone.trims])
    if (deep(first[zone.contains(first)]) > 0).any():
        return True
    every = np.concatenate([near[zone.contains(near)], *zone.trims])
    return bool((deep(every) > 0).any())


def _at_wall(zone: Face, walls: Callable[[Array], Bools] | None) -> bool:
    if walls is None:
        return True
    uv = zone.grid(12, 12)
    return bool(walls(np.concatenate([uv, *(loop[::5] for loop in zone.trims)])).any())
