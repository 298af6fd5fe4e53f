"""Cutter location data as motions: straight pieces on which the tip runs evenly and the axis turns little."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]

#: Motions of neighbouring pieces that are rejected together.
GROUP = 16

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
    bow : float
        Greatest departure from a straight relative motion on any piece, mm; 0 where the axis is fixed.
    """

    start: Array
    step: Array
    axis: Array
    turn: Array
    arrival: NDArray[np.int64]
    kind: NDArray[np.int8]
    bow: float

    def __len__(self) -> int:
        return len(self.start)

    def rows(self, which: NDArray[np.bool_]) -> "Motions":
        """Some of the motions.

        Parameters
        ----------
        which : (n,) array of bool
        """
        return Motions(self.start[which], self.step[which], self.axis[which], self.turn[which], self.arrival[which],
                       self.kind[which], self.bow)

    @property
    def uncertainty(self) -> float:
        """How far the least over a piece may be missed because the axis turns, mm."""
        return BOW_FACTOR * self.bow


def _checked(tips: ArrayLike, axes: ArrayLike, kind: ArrayLike) -> tuple[Array, Array, NDArray[np.int8]]:
    if np.size(tips) == 0:
        raise InvalidInput("the cutter location data holds no point: nothing can be judged")
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


def motions_from_cl(tips: ArrayLike, axes: ArrayLike, kind: ArrayLike, reach: float) -> Motions:
    """Motions between the points of cutter location data.

    Parameters
    ----------
    tips, axes : (n, 3) array_like
        Tool tips, mm, and tool axes; both are interpolated linearly between the points, the axis then normalised.
    kind : (n,) array_like of int
        `Motion` that arrives at each point; the one of the first point is not used unless it is the only one.
    reach : float
        Greatest distance of a point of the tool from its tip, mm: how fine turning motions are split.

    Raises
    ------
    InvalidInput
        When there is no point, shapes do not fit, a number is not finite, an axis is zero or turns straight back.
    """
    tip, axis, motion = _checked(tips, axes, kind)
    if len(tip) == 1:
        zero = np.zeros((1, 3))
        return Motions(tip, zero, axis, zero, np.zeros(1, dtype=np.int64), motion, 0.0)
    step, turn = np.diff(tip, axis=0), np.diff(axis, axis=0)
    least = np.sqrt(np.maximum(1 - 0.25 * (turn**2).sum(axis=1), 0.0))
    if (least < 1e-3).any():
        i = int(np.argmin(least))
        raise InvalidInput(f"the tool axis turns straight back between points {i} and {i + 1}: "
                           "the way between them is not defined; add a point between")
    pieces, bow = _pieces(np.linalg.norm(step, axis=1), np.linalg.norm(turn, axis=1) / least, reach)
    owner = np.repeat(np.arange(len(step)), pieces)
    part = np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = 1.0 / pieces[owner]
    low = (part * share)[:, None]
    return Motions(tip[:-1][owner] + low * step[owner], step[owner] * share[:, None],
                   axis[:-1][owner] + low * turn[owner], turn[owner] * share[:, None],
                   owner + 1, motion[1:][owner], bow)


def _pieces(way: Array, rate: Array, reach: float) -> tuple[NDArray[np.int64], float]:
    """Number of pieces of each motion, and the greatest bow that stays.

    A point fixed in the part moves in the tool's frame with acceleration at most 3 w^2 reach + 2 w way for the
    turning rate w (per unit of s); over a piece it leaves its chord by an eighth of that times the square of the share.
    """
    acceleration = 3 * rate**2 * reach + 2 * rate * way
    turning = np.ceil(np.sqrt(acceleration / (8 * BOW)))
    pieces = np.maximum(np.maximum(turning, np.ceil(way / max(reach / 4, 1e-3))), 1).astype(np.int64)
    return pieces, float((acceleration / (8.0 * pieces**2)).max())


def grouped(motions: Motions) -> tuple[Array, NDArray[np.int64]]:
    """Balls around neighbouring motions: one row (tip x, y, z, radius, mean axis x, y, z, half angle) for each group.

    Parameters
    ----------
    motions : Motions

    Returns
    -------
    groups : (g, 8) array
        The angle is given as the greatest distance between a unit axis and the mean one.
    first : (g + 1,) array of int
        Where each group begins.
    """
    count = len(motions)
    first = np.append(np.arange(0, count, GROUP), count).astype(np.int64)
    ends = np.stack([motions.start, motions.start + motions.step], axis=1)
    axes = np.stack([motions.axis, motions.axis + motions.turn], axis=1)
    axes = axes / np.linalg.norm(axes, axis=2, keepdims=True)
    low, high = (f.reduceat(ends, first[:-1], axis=0) for f in (np.minimum, np.maximum))
    centre = 0.5 * (low.min(axis=1) + high.max(axis=1))
    mean = np.add.reduceat(axes.sum(axis=1), first[:-1], axis=0)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    mean = np.where(size > 1e-6, mean / np.maximum(size, 1e-6), axes[first[:-1], 0])
    owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
    far = np.linalg.norm(ends - centre[owner][:, None], axis=2).max(axis=1)
    lean = np.linalg.norm(axes - mean[owner][:, None], axis=2).max(axis=1)
    radius, angle = (np.maximum.reduceat(x, first[:-1]) for x in (far, lean))
    return np.ascontiguousarray(np.column_stack([centre, radius, mean, angle])), first
