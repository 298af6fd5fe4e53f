"""Cutter location data as motions: straight pieces on which the tip runs evenly and the axis turns little."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import as_rows
from toolaxis.verify.revolved_solids import meridian

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Motions of neighbouring pieces that are rejected together, and groups of them.
GROUP = 16

#: Motions in a tile, about; and how many tiles are kept once they are made: 0.1 kB a motion.
MOST, _KEPT = 100_000, 8

#: A turning piece is split until the cutter's points leave their chords in the tool's frame by no more than this, mm.
BOW = 2e-5

#: A local least of a function within e of a convex one lies within 6 e of the global least.
BOW_FACTOR = 6.0


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions of a tool: on piece k, for s in [0, 1], the tip is start + s step and the axis is along axis + s turn.

    Attributes
    ----------
    start, step : (n, 3) array
        Tip at the start of each piece, and its way, mm.
    axis, turn : (n, 3) array
        Direction of the axis at the start (not of unit length inside a turning motion) and its change.
    arrival : (n,) array of int
        Index of the cutter location at which the motion arrives.
    kind : (n,) array of int8
        Kind of that motion.
    """

    start: Array
    step: Array
    axis: Array
    turn: Array
    arrival: Index
    kind: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.start)


def _check_motions(tips: ArrayLike, axes: ArrayLike, kind: ArrayLike) -> tuple[Array, Array, NDArray[np.int8]]:
    if np.size(tips) == 0:
        raise InvalidInput("the cutter location data holds no point: nothing can be verified")
    tip, axis = as_rows(tips, 3, "tool tip"), as_rows(axes, 3, "tool axis")
    motion = np.asarray(kind, dtype=np.int8).reshape(-1)
    if len(axis) != len(tip) or len(motion) != len(tip):
        raise InvalidInput(f"{len(tip)} tool tips come with {len(axis)} axes and {len(motion)} kinds of motion: "
                           "one of each is needed for every point")
    length = np.linalg.norm(axis, axis=1)
    if (length < 1e-9).any():
        i = int(np.argmin(length))
        raise InvalidInput(f"tool axis {i} is {axis[i].tolist()}: an axis needs a direction")
    return tip, axis / length[:, None], motion


class Hierarchy(NamedTuple):
    """Balls around groups of neighbouring motions, and around groups of those groups.

    Attributes
    ----------
    wide : (w, 8) array
        Ball (x, y, z, radius) around the tips of a wide group, mm, their mean axis, and how far the difference of an
        axis from the mean one moves a point of the tool at most, mm.
    begin : (w + 1,) array of int
        Where the narrow groups of each wide one begin.
    narrow : (g, 8) array
        The same for each `GROUP` of motions.
    first : (g + 1,) array of int
        Where the motions of each narrow group begin.
    """

    wide: Array
    begin: Index
    narrow: Array
    first: Index


class Tile(NamedTuple):
    """As many motions as are looked at together.

    Attributes
    ----------
    motions : Motions
    groups : Hierarchy
    slack : (n,) array
        How far any point of the tool is at most from where it is in the middle of its motion, mm.
    sway : (n,) array
        Angle by which the axis turns on each motion, rad.
    """

    motions: Motions
    groups: Hierarchy
    slack: Array
    sway: Array


class Tiles:
    """Cutter location data as motions, in tiles of bounded size whatever the number of locations.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Tool tips, mm, and tool axes; both are interpolated linearly between the points, the axis then normalised.
        `Motion` that arrives at each point; the one of the first point is not used unless it is the only one.
    reach : float
        Greatest distance of a point of the tool from its tip, mm: how fine turning motions are split.
    among : tuple of int, optional
        Kinds of motion that are looked at; all of them unless given.

    Attributes
    ----------
    uncertainty : float
        How far the least over a motion may be missed because the axis turns, mm.

    Raises
    ------
    InvalidInput
        When there is no point, shapes do not fit, a number is not finite, an axis is zero or turns straight back.
    """

    def __init__(self, cl: tuple[ArrayLike, ArrayLike, ArrayLike], reach: float,
                 among: tuple[int, ...] | None = None) -> None:
        self._reach = reach
        self._tip, self._axis, self._kind = _check_motions(*cl)
        self._pieces, self._bow = _pieces_of(self._tip, self._axis, reach)
        arriving = self._kind if len(self._tip) == 1 else self._kind[1:]
        self._wanted = np.ones(len(arriving), dtype=bool) if among is None else np.isin(arriving, among)
        self._ends = _ranges(np.where(self._wanted, self._pieces, 0), MOST)
        self._kept: tuple[Tile, ...] | None = None

    @property
    def uncertainty(self) -> float:
        """How far the least over a motion may be missed because the axis turns, mm."""
        return BOW_FACTOR * self._bow

    def __iter__(self) -> Iterator[Tile]:
        """The tiles one after the other: kept where they are few, made anew each time where they are many."""
        if len(self._ends) > _KEPT:
            return (self._tile(*ends) for ends in self._ends)
        if self._kept is None:
            self._kept = tuple(self._tile(*ends) for ends in self._ends)
        return iter(self._kept)

    def _tile(self, low: int, high: int) -> Tile:
        """The motions that arrive at locations low + 1 to high."""
        motions = self._motions(low, high)
        lean = np.linalg.norm(motions.axis + 0.5 * motions.turn, axis=1)
        sway = np.linalg.norm(motions.turn, axis=1) / lean
        way = np.linalg.norm(motions.step, axis=1)
        return Tile(motions, group_motions(motions, self._reach), 0.5 * way + 0.5 * sway * self._reach, sway)

    def _motions(self, low: int, high: int) -> Motions:
        if len(self._tip) == 1:
            zero = np.zeros((1, 3))
            return Motions(self._tip, zero, self._axis, zero, np.zeros(1, dtype=np.int64), self._kind)
        rows = low + np.flatnonzero(self._wanted[low:high])
        pieces = self._pieces[rows]
        row, number = number_parts(pieces)
        begin = rows[row]
        end = begin + 1
        share = (1.0 / self._pieces[begin])[:, None]
        before = number[:, None] * share
        step = self._tip[end] - self._tip[begin]
        turn = self._axis[end] - self._axis[begin]
        return Motions(self._tip[begin] + before * step, step * share, self._axis[begin] + before * turn,
                       turn * share, end, self._kind[end])


def _ranges(pieces: Index, most: int) -> list[tuple[int, int]]:
    """Ranges of consecutive motions with about so many pieces in each; none where there is no piece."""
    total = np.cumsum(pieces)
    if not len(total) or total[-1] == 0:
        return []
    tile = np.where(pieces > 0, total - 1, total) // most
    cuts = np.flatnonzero(np.diff(tile)) + 1
    ends = [0, *cuts.tolist(), len(pieces)]
    return [(low, high) for low, high in pairwise(ends) if pieces[low:high].any()]


def _pieces_of(tip: Array, axis: Array, reach: float) -> tuple[Index, float]:
    """Number of pieces of each motion, and the greatest bow that stays, mm."""
    if len(tip) == 1:
        return np.ones(1, dtype=np.int64), 0.0
    step, turn = np.diff(tip, axis=0), np.diff(axis, axis=0)
    least = np.sqrt(np.maximum(1 - 0.25 * (turn**2).sum(axis=1), 0.0))
    if (least < 1e-3).any():
        i = int(np.argmin(least))
        raise InvalidInput(f"the tool axis turns straight back between points {i} and {i + 1}: "
                           "the way between them is not defined; add a point between")
    return _pieces(np.linalg.norm(step, axis=1), np.linalg.norm(turn, axis=1) / least, reach)


def _pieces(way: Array, rate: Array, reach: float) -> tuple[Index, float]:
    """Number of pieces of each motion, and the greatest bow that stays.

    A point fixed in the part moves in the tool's frame with acceleration at most 3 w^2 reach + 2 w way for the
    turning rate w (per unit of s); over a piece it leaves its chord by an eighth of that times the square of the share.
    """
    acceleration = 3 * rate**2 * reach + 2 * rate * way
    turning = np.ceil(np.sqrt(acceleration / (8 * BOW)))
    pieces = np.maximum(np.maximum(turning, np.ceil(way / max(reach / 4, 1e-3))), 1).astype(np.int64)
    return pieces, float((acceleration / (8.0 * pieces**2)).max())


def group_motions(motions: Motions, reach: float) -> Hierarchy:
    """Balls around neighbouring motions, and around neighbouring balls.

    Parameters
    ----------
    motions : Motions
    reach : float
        Greatest distance of a point of the tool from its tip, mm.
    """
    begins = _beginnings(len(motions))
    first = begins[:-1]
    group = _numbers_of_groups(begins)
    ends = np.stack([motions.start, motions.start + motions.step], axis=1)
    axes = np.stack([motions.axis, motions.axis + motions.turn], axis=1)
    axes = axes / np.linalg.norm(axes, axis=2, keepdims=True)
    low = np.minimum.reduceat(ends, first, axis=0).min(axis=1)
    high = np.maximum.reduceat(ends, first, axis=0).max(axis=1)
    centre = 0.5 * (low + high)
    sums = np.add.reduceat(axes.sum(axis=1), first, axis=0)
    mean = _mean(sums, axes[first, 0])
    distances = np.linalg.norm(ends - centre[group][:, None], axis=2).max(axis=1)
    leans = np.linalg.norm(axes - mean[group][:, None], axis=2).max(axis=1)
    radius = np.maximum.reduceat(distances, first)
    moved = np.maximum.reduceat(leans, first) * reach
    narrow = np.ascontiguousarray(np.column_stack([centre, radius, mean, moved]))
    wide, wide_begins = _group_balls(narrow, reach)
    return Hierarchy(wide, wide_begins, narrow, begins)


def _group_balls(narrow: Array, reach: float) -> tuple[Array, Index]:
    """Balls around neighbouring balls, as rows of the same kind, and where the balls of each begin."""
    begins = _beginnings(len(narrow))
    first = begins[:-1]
    group = _numbers_of_groups(begins)
    own_centre, own_radius, own_axis, own_moved = narrow[:, :3], narrow[:, 3], narrow[:, 4:7], narrow[:, 7]
    low = np.minimum.reduceat(own_centre - own_radius[:, None], first, axis=0)
    high = np.maximum.reduceat(own_centre + own_radius[:, None], first, axis=0)
    centre = 0.5 * (low + high)
    mean = _mean(np.add.reduceat(own_axis, first, axis=0), own_axis[first])
    distances = np.linalg.norm(own_centre - centre[group], axis=1) + own_radius
    ways = np.linalg.norm(own_axis - mean[group], axis=1) * reach + own_moved
    radius = np.maximum.reduceat(distances, first)
    moved = np.maximum.reduceat(ways, first)
    return np.ascontiguousarray(np.column_stack([centre, radius, mean, moved])), begins


def _numbers_of_groups(begins: Index) -> Index:
    """To which group each row belongs, of groups that begin at some rows and end at the last of these."""
    return np.repeat(np.arange(len(begins) - 1), np.diff(begins))


def _beginnings(count: int) -> Index:
    return np.append(np.arange(0, count, GROUP), count).astype(np.int64)


def _mean(total: Array, instead: Array) -> Array:
    """Directions of sums of unit vectors; others where a sum vanishes."""
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(size > 1e-6, total / np.maximum(size, 1e-6), instead)


@jit_inline
def bound(solids: Array, row: Array, ball: Array) -> float:
    """Lower bound of the distance between a ball of points and all motions of a group."""
    w0, w1, w2 = ball[0] - row[0], ball[1] - row[1], ball[2] - row[2]
    z = w0 * row[4] + w1 * row[5] + w2 * row[6]
    rho = np.sqrt(max(w0 * w0 + w1 * w1 + w2 * w2 - z * z, 0.0))
    nearest = np.inf
    for j in range(solids.shape[0]):
        nearest = min(nearest, meridian(solids[j], rho, z)[0])
    return nearest - row[3] - row[7] - ball[3]


@jit
def near_groups(solids: Array, groups: Hierarchy, ball: Array, lever: float, near: tuple[Index, Array]) -> int:
    """Collect the groups that may come within a lever of a ball, and bounds of their distances; how many they are."""
    which, least = near
    count = 0
    for w in range(groups.wide.shape[0]):
        if bound(solids, groups.wide[w], ball) > lever:
            continue
        for g in range(groups.begin[w], groups.begin[w + 1]):
            least[count] = bound(solids, groups.narrow[g], ball)
            if least[count] <= lever:
                which[count] = g
                count += 1
    return count


@jit
def floors(solids: Array, groups: Hierarchy, balls: Array, out: Array) -> None:
    """Lower bounds of the distances of balls of points from all motions; each lowers what stands in the output."""
    for b in range(balls.shape[0]):
        for w in range(groups.wide.shape[0]):
            if bound(solids, groups.wide[w], balls[b]) < out[b]:
                for g in range(groups.begin[w], groups.begin[w + 1]):
                    out[b] = min(out[b], bound(solids, groups.narrow[g], balls[b]))
