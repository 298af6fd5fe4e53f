"""Room around the tool: the least distance of each of its components from faces, along all motions."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.numeric.shares import share_out
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.verify.component_clearance_numpy import clear_numpy
from toolaxis.verify.linear_motions import Hierarchy, Tile, Tiles, floors, near_groups
from toolaxis.verify.revolved_solids import reach_of
from toolaxis.verify.sample_cells import SampleCells, ball_around, face_cells, merge_cells, share_cells, split
from toolaxis.verify.spatial_blocks import CHUNK, Blocks, blocks_of
from toolaxis.verify.swept_solid import LOOK, gradient, least_over_motion, moment, sway

Array = NDArray[np.float64]
Index: TypeAlias = NDArray[np.int64]
Body: TypeAlias = tuple[Array, tuple[Array, Array, Array, Array]]
TakenOff: TypeAlias = Callable[[Index, Array], Array]

#: Side of the cells at the start, mm; error at which the search ends, mm, or as a share of the distance.
CELL, RESOLUTION, SHARE = 3.0, 5e-4, 1e-3

#: Cells that are split at a time: what comes of them is held in memory together.
TILE = 4_000

#: Once cells are smaller than FINE, mm, only so many are split again, the closest first; most rounds.
FINE, _BEAM, _ROUNDS = 0.5, 4_000, 12

#: Distances above this are not measured, mm; sums of distances and radii are rounded by less than that.
FAR, _ROUNDING = 100.0, 1e-9

#: More than this many times what is enough need only be known to this share of itself.
AMPLE, AMPLE_SHARE = 5.0, 0.05


@dataclass(frozen=True)
class Clearance:
    """The least distance found.

    Attributes
    ----------
    component : str
        "cutter", "shank" or "holder".
    distance : float
        mm; negative where the component is inside the material; `FAR` where nothing is nearer.
    face : str
        Label of the face; empty where nothing is near.
    point : (float, float, float)
        The place on the face, mm.
    motion : int
        Index of the cutter location at which the motion arrives; -1 where nothing is near.
    uncertainty : float
        Error by the spacing of the points looked at last, and by turning motions, mm.
    """

    component: str
    distance: float
    face: str
    point: tuple[float, float, float]
    motion: int
    uncertainty: float


class ClearanceTables(NamedTuple):
    """What is known of motions: groups, how far the tool goes on each, mm, and where each arrives."""

    groups: Hierarchy
    slack: Array
    arrival: Index


class _Tangent(NamedTuple):
    """A plane below a component's function while it is carried along a motion.

    low : float, mm, at the middle of a block of points, the least over the motion;
    slope : (float, float, float), of the function over the part.
    """

    low: float
    slope: tuple[float, float, float]


@jit_inline
def _tangent_at(body: Body, k: int, ball: Array) -> _Tangent:
    """A plane below the function of one solid on motion k, for points in a ball (4,).

    The solid's function f is convex and changes by no more than it is gone.  Where the tool is at share s, a point at
    d from the ball's middle is in the tool's frame where the middle is, and d turned with the axis, which from the
    middle of the motion on turns by no more than half its sway.  The middle itself runs along a chord but for a bow
    that `LOOK` holds.  So at all s f is at least its value at the middle of ball and motion, less half the slope in s,
    less `LOOK`, less half the sway times |d|, and more by its gradient times d.
    """
    solid, motion = body
    start = motion[0]
    w = (ball[0] - start[k, 0], ball[1] - start[k, 1], ball[2] - start[k, 2])
    value, slope, g0, g1, g2 = gradient(solid, motion, (k, 0.5), w)
    low = value - 0.5 * abs(slope) - LOOK
    turn = motion[3]
    if turn[k, 0] != 0.0 or turn[k, 1] != 0.0 or turn[k, 2] != 0.0:
        low -= 0.5 * sway(motion, k) * ball[3]
    return _Tangent(low, (g0, g1, g2))


@jit_inline
def _greatest(level: Array, low: int, high: int) -> float:
    greatest = -np.inf
    for i in range(low, high):
        greatest = max(greatest, level[i])
    return greatest


@jit
def _clear_block(body: Body, tables: ClearanceTables, block: tuple[Array, int, int], out: tuple[Array, Index, Array],
                 level: Array) -> None:
    """Distances of one block of points from all motions; those above their levels stay as they are.

    The levels come down to the distances that are found.
    """
    solids, motion = body
    groups = tables.groups
    ball, low, high = block
    value, by, point = out
    near, least = np.empty(groups.narrow.shape[0] + 1, dtype=np.int64), np.empty(groups.narrow.shape[0] + 1)
    found = near_groups(solids, groups, ball, _greatest(level, low, high), (near, least))
    for n in np.argsort(least[:found]):
        lever = _greatest(level, low, high)
        if least[n] > lever:
            break
        for k in range(groups.first[near[n]], groups.first[near[n] + 1]):
            for j in range(solids.shape[0]):
                plane = _tangent_at((solids[j], motion), k, ball)
                if plane.low - ball[3] > lever:  # no slope is above one
                    continue
                g0, g1, g2 = plane.slope
                for i in range(low, high):
                    d0, d1, d2 = point[i, 0] - ball[0], point[i, 1] - ball[1], point[i, 2] - ball[2]
                    if plane.low + g0 * d0 + g1 * d1 + g2 * d2 < level[i]:
                        _approach((solids[j], motion), (k, tables.arrival[k]), point, (value, by, level), i)


@jit_inline
def _approach(body: Body, which: tuple[int, int], point: Array, out: tuple[Array, Index, Array], i: int) -> None:
    """Distance of point i from motion which[0], which arrives at which[1], where it is less than what is known."""
    solid, motion = body
    k, arrival = which
    value, by, level = out
    ray = (point[i, 0], point[i, 1], point[i, 2], 0.0, 0.0, 0.0)
    middle, slope, _ = moment(solid, motion, (k, 0.5), ray, 0.0)
    if middle - 0.5 * abs(slope) - LOOK < level[i]:
        least, _, _, _ = least_over_motion(solid, motion, k, ray, 0.0)
        if least < value[i]:
            value[i] = least
            by[i] = arrival
            level[i] = min(level[i], least)


@jit
def _clear(body: Body, tables: ClearanceTables, blocks: tuple[Array, Index, Index],
           out: tuple[Array, Index, Array, NDArray[np.bool_]], levels: tuple[float, Array, int, int]) -> None:
    """Distances of the points of blocks levels[2] up to levels[3], true where within their margins of the least."""
    ball, first, which = blocks
    value, by, point, counts = out
    best, margin, low, high = levels
    level = np.empty(len(value))
    for n in range(low, high):
        b = which[n]
        for i in range(first[b], first[b + 1]):
            level[i] = min(value[i], best + margin[i] + _ROUNDING)
        _clear_block(body, tables, (ball[b], first[b], first[b + 1]), (value, by, point), level)
        for i in range(first[b], first[b + 1]):
            if counts[i] and value[i] < best:
                best = value[i]


class _Found(NamedTuple):
    """The least distance known: mm, index of the face, place on it, and where the motion arrives; -1 for none."""

    distance: float
    owner: int
    point: Array
    motion: int


class _Search:
    """Distances of cells of faces from one component along the motions, and the least of them.

    Attributes
    ----------
    best : _Found
    taken_off : callable or None
        As for `clearance`.
    """

    def __init__(self, solids: Array, tiles: Tiles, faces: tuple[Face, ...],
                 workers: tuple[int, Callable[[float, float], None]], taken_off: TakenOff | None = None) -> None:
        self.solids, self.tiles, self.faces = solids, tiles, faces
        self.workers, self.taken_off = workers, taken_off
        self.best = _Found(FAR, -1, np.zeros(3), -1)

    def floors(self, balls: Array) -> Array:
        """Lower bounds of the distances of balls (b, 4) from the component."""
        least = np.full(len(balls), np.inf)
        for tile in self.tiles:
            np.minimum(least, self._floors(tile, balls), out=least)
        return least

    def _floors(self, tile: Tile, balls: Array) -> Array:
        """The same for one tile of motions; where nothing is compiled it is quicker not to ask."""
        if not _compiled.available:
            return np.full(len(balls), -np.inf)
        least = np.full(len(balls), np.inf)
        floors(self.solids, tile.groups, balls, least)
        return least

    def look(self, cells: SampleCells, blocks: Blocks, *, even_equal: bool = False) -> SampleCells:
        """Measure cells; those that may stand for a place that is nearer than the least distance known then.

        Parameters
        ----------
        cells : SampleCells
        blocks : Blocks
            Of their centres.
        even_equal : bool
            Whether an equal distance on a face that comes before the one known is taken for it.
        """
        value, by = self._distances(cells, blocks)
        here = np.where(cells.on_face & (by >= 0), value, np.inf)
        i = int(np.argmin(here))
        found = _Found(float(here[i]), int(cells.owner[i]), cells.point[i], int(by[i]))
        before = even_equal and found.distance == self.best.distance and found.owner < self.best.owner
        if found.distance < self.best.distance or before:
            self.best = found
        rows = np.flatnonzero((value - cells.radius <= self.best.distance) & (by >= 0))
        return replace(cells.rows(rows), value=value[rows])

    def _distances(self, cells: SampleCells, blocks: Blocks) -> tuple[Array, Index]:
        """Distance of each cell's centre, true where it may be near, and the location at which the motion arrives."""
        order = blocks.order
        value, by = np.full(len(order), FAR), np.full(len(order), -1, dtype=np.int64)
        point = np.ascontiguousarray(cells.point[order])
        off = np.zeros(len(order)) if self.taken_off is None else self.taken_off(cells.owner[order], point)
        # A place at a step must not end the search for places beside it, which is farther than its distance tells.
        counts = np.ascontiguousarray(cells.on_face[order] & (off == 0.0))
        for tile in self.tiles:
            self._lower(tile, blocks, (value, by, point, counts), cells.radius[order])
        value = np.maximum(value, np.minimum(value + off, 0.0))
        result, reached = np.empty_like(value), np.empty_like(by)
        result[order], reached[order] = value, by
        return result, reached

    def _lower(self, tile: Tile, blocks: Blocks, out: tuple[Array, Index, Array, NDArray[np.bool_]],
               margin: Array) -> None:
        """Lower distances to those from a tile of motions, as far as they may come within margins of the least."""
        motions = tile.motions
        body = (self.solids, (motions.start, motions.step, motions.axis, motions.turn))
        tables = ClearanceTables(tile.groups, tile.slack, motions.arrival)
        least = self._floors(tile, blocks.ball)
        which = np.argsort(least, kind="stable")  # the nearest first: with their distance most others are passed over
        kernel = _clear if _compiled.available else clear_numpy

        def _work(part: slice) -> None:
            best = min(self.best.distance, float(out[0][out[3]].min(initial=np.inf)))
            kernel(body, tables, (blocks.ball, blocks.first, which), out, (best, margin, part.start, part.stop))

        count, (threads, report) = int((least <= self.best.distance + margin.max()).sum()), self.workers
        for done in share_out(_work, count, CHUNK, threads):
            report(done.stop, count)

    def first_look(self) -> SampleCells:
        """Cells of whole faces, the nearest faces first, as long as one may come nearer than what is known."""
        balls = np.array([ball_around(face, CELL) for face in self.faces])
        least = self.floors(balls)
        parts: dict[int, SampleCells] = {}
        for owner in np.argsort(least, kind="stable"):
            if parts and least[owner] > self.best.distance:
                break
            made = face_cells(self.faces[owner], CELL)
            parts[int(owner)] = self.look(share_cells(made.cells, int(owner)), made.blocks, even_equal=True)
        return self.near([parts[owner] for owner in sorted(parts)])

    def near(self, parts: Sequence[SampleCells]) -> SampleCells:
        """Of cells that were looked at those that still may stand for a nearer place."""
        cells = merge_cells(parts)
        return cells.rows(np.flatnonzero(cells.value - cells.radius <= self.best.distance))

    def closer_look(self, cells: SampleCells) -> SampleCells:
        """The pieces of cells, measured some at a time."""
        parts = []
        for low in range(0, len(cells), TILE):
            pieces = split(self.faces, cells.rows(np.arange(low, min(low + TILE, len(cells)))))
            parts.append(self.look(pieces, blocks_of(pieces.point)))
        return self.near(parts)


def clearance(cl: tuple[ArrayLike, ArrayLike, ArrayLike], component: tuple[str, Array], faces: tuple[Face, ...], *,
              enough: float = np.inf, taken_off: TakenOff | None = None, among: tuple[int, ...] | None = None,
              threads: int = 1, progress: Progress = NO_PROGRESS) -> Clearance:
    """Least distance of one component of the tool from faces along cutter location data, links included.

    Points all over the faces and their borders are measured against the swept solids, more densely around the nearest.
     At a distance d, points of spacing e miss the nearest place of a smooth face by about
    e^2 / d, of any face by e; the search ends where the lesser of both is `RESOLUTION`, or `SHARE` of d.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        As for `removal`.
    component : (str, (k, 7) array)
        Name, and its solids as `solids.cutter_solid` and `solids.frustum_solids` give them.
    faces : tuple of Face
    enough : float
        Distance that is asked for, mm: where the tool stays `AMPLE` times as far away, the search ends early.
    taken_off : callable, optional
        What faces miss each other by at points (n, 3) of those with some indices (n,), mm: depths are less by that.
    among : tuple of int, optional
        Kinds of motion that are looked at; all of them unless given.
    threads : int
        Threads of the compiled kernel; the result does not depend on it.
    progress : Progress

    Raises
    ------
    InvalidInput
        When there is no cutter location, a number is not finite, or shapes do not fit.

    Properties
    ----------
    1. A component that enters a face by 0.005 mm on one motion is found.
    2. Rigid motions and mirrors change nothing.
    """
    name, solids = component
    tiles = Tiles(cl, reach_of(solids), among)
    nothing = Clearance(name, FAR, "", (0.0, 0.0, 0.0), -1, tiles.uncertainty)
    if not faces or not any(True for _ in tiles):
        return nothing
    search = _Search(solids, tiles, faces, (threads, partial(progress.report, f"{name} clearance")), taken_off)
    error = 0.0
    near = search.first_look()
    for _ in range(_ROUNDS - 1):
        best = search.best.distance
        radius = float(near.radius.max(initial=0.0))
        error = min(radius, radius**2 / max(best, RESOLUTION))
        ample = AMPLE_SHARE if best - error > AMPLE * enough else SHARE
        if not len(near) or error <= max(RESOLUTION, ample * best):
            break
        if radius < FINE:
            near = near.rows(np.sort(np.argsort(near.value, kind="stable")[:_BEAM]))
        near = search.closer_look(near)
    found = search.best
    if found.motion < 0:
        return nothing
    x, y, z = (float(c) for c in found.point)
    return Clearance(name, found.distance, faces[found.owner].label, (x, y, z), found.motion, tiles.uncertainty + error)
