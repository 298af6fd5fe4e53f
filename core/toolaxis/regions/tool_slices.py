"""A tool in pieces with what each of them has to keep, and whether it may stand at places from which it may be off."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.regions.reach_kernel import MOST_PIECES, ReachTips, ReachTool, find_blocked_tips
from toolaxis.regions.scene import ReachScene

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: A part of a tool is cut into slices whose upper end is so many times as high as the lower one; they overlap by half.
#: Height from which on slices grow, mm.
_SLICE, _LOWEST = 4.0, 2.0
#: Pairs go together whose tools are off by distances, mm, from the least on, and angles that differ less than this.
_ALIKE, _LEAST = 1.25, 1e-4


@dataclass(frozen=True, eq=False)
class ToolSlices:
    """A tool in pieces.

    pieces : (k, 8) array;  required : (faces + 1, k) array, mm, what each has to keep;  arm : (k,) array, mm, greatest
    distance of each from the middle of the tool's corner circle.
    """

    pieces: Array
    required: Array
    arm: Array


class ToolSearch:
    """Looks where tools come too near to what stands around a part.

    Parameters
    ----------
    scene : ReachScene
    """

    def __init__(self, scene: ReachScene) -> None:
        self._scene = scene

    def blocked(self, slices: ToolSlices, turn: Array, off: Array, places: Array, axes: Array) -> Bools:
        """Whether a tool comes nearer to something than it may by more than it may be off.

        Parameters
        ----------
        slices : ToolSlices
        turn, off : (n,) arrays
            By how much the axis may be off, rad, and the middle of the corner circle, mm.
        places, axes : (n, 3) arrays
            Tips, mm, and axes.
        """
        blocked = np.zeros(len(off), dtype=bool)
        level = [np.ceil(np.log(np.maximum(one, _LEAST) / _LEAST) / np.log(_ALIKE)).astype(int) for one in (turn, off)]
        key = level[0] * (level[1].max(initial=0) + 1) + level[1]
        for one in np.unique(key):
            rows = np.flatnonzero(key == one)
            less = float(off[rows].max()) + 2 * np.sin(float(turn[rows].max()) / 2) * slices.arm
            for first in range(0, len(slices.pieces), MOST_PIECES):
                some = slice(first, first + MOST_PIECES)
                pieces = slices.pieces[some].copy()
                pieces[:, 7] = np.arange(len(pieces))
                tool = ReachTool.of(pieces, np.ascontiguousarray(slices.required[:, some] - less[some]))
                rest = rows[~blocked[rows]]
                blocked[rest] = find_blocked_tips(self._scene.tree, tool, ReachTips.of(places[rest], axes[rest]))
        return blocked


def take_off(whole: ReachTool, radius: float) -> ReachTool:
    """A tool with a smaller radius all along; what is no wider than that goes."""
    pieces = whole.pieces - np.array([radius, 0.0, 0.0, 0.0, 0.0, 0.0, radius, 0.0])
    return ReachTool.of(pieces[(pieces[:, 0] >= 0) & (pieces[:, 6] > 0)], whole.limits)


def cut_into_slices(whole: ReachTool, corner: float) -> ToolSlices:
    """A tool with what holds it, in slices that overlap by half."""
    pieces = np.array([part for piece in whole.pieces for part in _slice_piece(piece, corner)])
    # Seen from the middle of the corner circle; a slice is widest at its upper end, at its lower one, or in its arc.
    wide = np.maximum(pieces[:, 6], pieces[:, 0] + pieces[:, 1])
    high = np.abs(pieces[:, 4:6] - corner).max(axis=1)
    return ToolSlices(pieces, whole.limits[:, pieces[:, 7].astype(int)], np.hypot(wide, high))


def _slice_piece(piece: Array, corner: float) -> list[Array]:
    """A convex piece, its straight side in slices."""
    flat, radius, cosine, sine, low, top, rim, component = piece
    straight = max(low + radius * (1 - sine), low + 1.5 * radius)
    if straight >= top:
        return [piece]

    def side(z: float) -> float:
        """Radius at a height."""
        return float(rim - (top - z) * sine / cosine)

    found = []
    if radius > 0:
        found.append(np.array([flat, radius, cosine, sine, low, straight, side(straight), component]))
    z, end = straight, straight
    while end < top:
        end = min(_SLICE * max(z, corner, _LOWEST), top)
        found.append(np.array([side(z), 0.0, cosine, sine, z, end, side(end), component]))
        z = np.sqrt(_SLICE) * max(z, corner, _LOWEST)
    return found
