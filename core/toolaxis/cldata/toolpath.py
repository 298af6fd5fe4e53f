"""The tool path as plain arrays."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

#: Length, mm, by which a link may miss the tool axis, or the crossing height, and still be rapid.
STRAIGHT = 1e-5
#: Turn of the axis, rad, below which it stands still.
STILL = 1e-6


class Motion(IntEnum):
    """What the motion that arrives at a point is for."""

    CUT = 0
    ENTRY = 1
    EXIT = 2
    LINK = 3


@dataclass(frozen=True, eq=False)
class ToolPath:
    """Cutter locations in the order in which they are visited; tips and axes are interpolated linearly.

    Attributes
    ----------
    cc, cl : (n, 3) array
        Cutter contact and cutter location (tool tip), mm; at points without contact cc repeats cl.
    axis, normal : (n, 3) array
        Unit tool axis (tip to spindle) and unit surface normal; at points without contact the normal is the axis.
    kind : (n,) array of int8
        `Motion` that arrives at each point; the first one of a path is where the tool comes from.
    breaks : (k + 1,) array of int
        Where each pass starts, entry included, and n at the end.

    Raises
    ------
    InvalidInput
        When shapes do not fit or a number is not finite.
    """

    cc: Array
    cl: Array
    axis: Array
    normal: Array
    kind: NDArray[np.int8]
    breaks: NDArray[np.int64]

    def __post_init__(self) -> None:
        count = len(self.cl)
        for name in ("cc", "cl", "axis", "normal"):
            rows = np.ascontiguousarray(getattr(self, name), dtype=float)
            object.__setattr__(self, name, rows)
            if rows.shape != (count, 3):
                raise InvalidInput(f"tool path {name} has shape {rows.shape}: ({count}, 3) is needed")
            bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
            if bad.size:
                raise InvalidInput(f"tool path {name} row {bad[0]} is {rows[bad[0]].tolist()}: it must be finite")
        self._check_kind(count)
        length = np.linalg.norm(self.axis, axis=1)
        if (np.abs(length - 1) > 1e-4).any():
            i = int(np.argmax(np.abs(length - 1)))
            raise InvalidInput(f"tool path axis row {i} has length {length[i]}: unit vectors are needed")
        ends = np.asarray(self.breaks)
        if len(ends) < 1 or ends[0] != 0 or ends[-1] != count or (np.diff(ends) < 0).any():
            raise InvalidInput(f"tool path breaks must run from 0 to {count} without decreasing")

    def _check_kind(self, count: int) -> None:
        kind = np.ascontiguousarray(self.kind, dtype=np.int8)
        object.__setattr__(self, "kind", kind)
        if kind.shape != (count,):
            raise InvalidInput(f"tool path kind has shape {kind.shape}: ({count},) is needed")
        bad = np.flatnonzero((kind < min(Motion)) | (kind > max(Motion)))
        if bad.size:
            raise InvalidInput(f"tool path kind {bad[0]} is {kind[bad[0]]}: 0 cut, 1 entry, 2 exit or 3 link is needed")

    @property
    def passes(self) -> int:
        """Number of passes."""
        return len(self.breaks) - 1

    @property
    def rapid(self) -> NDArray[np.bool_]:
        """Which motions are rapid, (n,): links along the axis, and those across above everything that is cut, both only
        where the axis stands still."""
        axis = self.axis.mean(axis=0)
        axis = axis / np.linalg.norm(axis)
        steps, turns = (np.diff(rows, axis=0, prepend=rows[:1]) for rows in (self.cl, self.axis))
        heights = self.cl @ axis
        aside = steps - (steps * self.axis).sum(axis=1, keepdims=True) * self.axis
        along = np.linalg.norm(aside, axis=1) <= STRAIGHT
        low = float(heights[self.kind != Motion.LINK].max(initial=-np.inf))
        above = heights >= max(float(heights.max(initial=-np.inf)) - STRAIGHT, low + STRAIGHT)
        both = above & np.concatenate([[True], above])[:-1]
        still = np.linalg.norm(turns, axis=1) <= STILL
        return np.asarray((self.kind == Motion.LINK) & still & (along | both))

    def length(self, *kinds: Motion) -> float:
        """Length of the tip's motion, mm, of the given kinds; of all when none is given.

        Parameters
        ----------
        *kinds : Motion
        """
        steps = np.linalg.norm(np.diff(self.cl, axis=0), axis=1)
        if kinds:
            steps = steps[np.isin(self.kind[1:], kinds)]
        return float(steps.sum())
