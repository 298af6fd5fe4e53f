"""Cells of a face that are halved where it is worth it, and what is proven of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.regions.rectangles import FaceRectangles, halve_rectangles, is_as_measured
from toolaxis.shape.face import Face

Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


@dataclass(eq=False)
class _CellSize:
    """Cells of one size.

    parent : (n,) array of int, of which cell of the level before each is a quarter;  asked, proven : (n,) arrays of
    bool, those of whose quarters more may be proven, and those that are.
    """

    cells: FaceRectangles
    parent: Indices
    asked: Bools
    proven: Bools

    @staticmethod
    def make(cells: FaceRectangles, parent: Indices) -> "_CellSize":
        """Cells of which nothing is known."""
        return _CellSize(cells, parent, np.ones(len(cells), dtype=bool), np.zeros(len(cells), dtype=bool))


class CellLevels:
    """Cells of a face, halved again and again where that tells more.

    Parameters
    ----------
    face : Face
    cells : FaceRectangles
        The first ones.
    """

    def __init__(self, face: Face, cells: FaceRectangles) -> None:
        self._face, self._levels = face, [_CellSize.make(cells, np.zeros(len(cells), dtype=np.int64))]

    @property
    def cells(self) -> FaceRectangles:
        """The smallest ones."""
        return self._levels[-1].cells

    @property
    def reach(self) -> float:
        """How far most of the smallest cells reach, mm."""
        return float(np.median(self.cells.off)) if len(self.cells) else 0.0

    def halve(self, most: int) -> bool:
        """Halve the smallest cells of which more may be proven; whether there are any, and not too many.

        Parameters
        ----------
        most : int
            Cells at most.
        """
        last = self._levels[-1]
        rows = np.flatnonzero(last.asked & ~last.proven)
        if not len(rows) or 4 * len(rows) > most:
            return False
        cells, quarter = halve_rectangles(self._face, last.cells.pick(rows))
        self._levels.append(_CellSize.make(cells, rows[quarter]))
        return True

    def keep_beside(self, found: Bools) -> None:
        """Ask no more of the smallest cells but some, and those that are quarters of one with them.

        Parameters
        ----------
        found : (n,) array of bool
        """
        last = self._levels[-1]
        some = np.zeros(last.parent.max(initial=0) + 1, dtype=bool)
        some[last.parent[found]] = True
        last.asked &= some[last.parent]

    def claim(self, found: Bools) -> float:
        """Take some of the smallest cells for proven; the area of those that are, mm^2.

        Parameters
        ----------
        found : (n,) array of bool
        """
        last = self._levels[-1]
        rows = np.flatnonzero(found)
        last.proven[rows] = is_as_measured(self._face, last.cells.pick(rows))
        return float(last.cells.area[last.proven].sum())

    def gather(self) -> tuple[list[FaceRectangles], FaceRectangles]:
        """Proven cells of all sizes, and the largest ones with nothing proven in them."""
        levels = self._levels
        some = [level.proven.copy() for level in levels]
        for upper, lower, found in zip(some[-2::-1], levels[:0:-1], some[:0:-1], strict=True):
            upper[lower.parent[found]] = True
        left = []
        asked = np.ones(len(levels[0].cells), dtype=bool)
        for k, level in enumerate(levels):
            left.append(level.cells.pick(asked & ~some[k]))
            if k + 1 < len(levels):
                asked = (asked & some[k] & ~level.proven)[levels[k + 1].parent]
        return [level.cells.pick(level.proven) for level in levels], FaceRectangles.join(left)
