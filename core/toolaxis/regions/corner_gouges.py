"""What of a face is out of reach as the corner of each tool is too large for it, whatever the axis.

So it is beside sharp edges at walls, and in fillets that are too tight.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.regions.cell_levels import CellLevels
from toolaxis.regions.rectangles import FaceRectangles
from toolaxis.regions.tool_slices import ToolSearch, ToolSlices
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Height of the ball that stands for a cutter's corner, in its radius: a little more than its lower half.
_HALF = 1.0001
#: How far most cells reach whose middles are looked at first, and the smallest ones, in radii of the ball.
_NEAR, _FINEST = 0.6, 0.04
#: Share of the face's area that has to be proven in cells of one size, and in how many sizes one after the other it may
#: be less before smaller ones are not tried.
_WORTH, _IN_VAIN = 0.005, 2


class CornerBall:
    """The ball that a tool holds at its contact, whatever its axis.

    Parameters
    ----------
    tool : Tool
    search : ToolSearch
    required : (faces + 1, 4) array
        Of `toolaxis.regions.scene.ReachScene.required`.
    allowance : float
        Stock left on the face, mm.

    Attributes
    ----------
    radius : float
        mm; 0 where the tool holds none.
    """

    def __init__(self, tool: Tool, search: ToolSearch, required: Array, allowance: float) -> None:
        self.radius = tool.corner_radius if tool.flute_length >= 2 * tool.corner_radius else 0.0
        self._corner, self._search, self._allowance = tool.corner_radius, search, allowance
        self._slices = ToolSlices(np.array([[0.0, self.radius, 1.0, 0.0, 0.0, _HALF * self.radius, self.radius, 0.0]]),
                                  required[:, :1], np.zeros(1))

    def gouges(self, cells: FaceRectangles) -> tuple[Bools, Bools]:
        """Where it gouges at every contact of a cell, and where it does in the middle, (n,) each.

        Parameters
        ----------
        cells : FaceRectangles
        """
        if self.radius <= 0 or not len(cells):
            return np.zeros(len(cells), dtype=bool), np.zeros(len(cells), dtype=bool)
        places, none = cells.point + self._allowance * cells.normal, np.zeros(len(cells))
        middle = self._search.blocked(self._slices, none, none, places, cells.normal)
        at = np.flatnonzero(middle)
        surely = middle.copy()
        surely[at] = self._search.blocked(self._slices, none[at], self.off(cells)[at], places[at], cells.normal[at])
        return surely, middle

    def off(self, cells: FaceRectangles) -> Array:
        """How far the middle of the corner's ball lies from that at the contact of its cell, at most, (n,) mm.

        Parameters
        ----------
        cells : FaceRectangles
        """
        return np.asarray(cells.off + 2 * (self._corner + self._allowance) * np.sin(cells.turn / 2))


def smallest_ball(balls: Sequence[CornerBall]) -> CornerBall | None:
    """The ball that gouges nowhere where one of the others does not; None where a tool holds none.

    Parameters
    ----------
    balls : sequence of CornerBall
    """
    ball = min(balls, key=lambda one: one.radius, default=None)
    return None if ball is None or ball.radius <= 0 else ball


class CornerGouges(NamedTuple):
    """What the smallest corner of some tools alone tells of a face.

    proven : list of FaceRectangles, cells in which it gouges everywhere;  left : FaceRectangles, the largest cells in
    which nothing is proven.
    """

    proven: list[FaceRectangles]
    left: FaceRectangles

    @staticmethod
    def look(face: Face, balls: Sequence[CornerBall], cells: FaceRectangles, most: int) -> "CornerGouges":
        """Look where the smallest corner gouges.

        Parameters
        ----------
        face : Face
        balls : sequence of CornerBall
            Of all tools.
        cells : FaceRectangles
            Of the face, those that are asked for.
        most : int
            Cells of one size at most.
        """
        ball = smallest_ball(balls)
        if ball is None or not len(cells):
            return CornerGouges([], cells)
        levels = CellLevels(face, cells)
        while levels.reach > _NEAR * ball.radius and levels.halve(most):
            pass
        proven, in_vain = 0.0, 0
        while proven == 0 or in_vain < _IN_VAIN:
            surely, narrow = ball.gouges(levels.cells)
            gained = levels.claim(surely)
            levels.keep_beside(narrow)
            proven += gained
            in_vain = 0 if gained >= _WORTH * face.area else in_vain + 1
            if levels.reach <= _FINEST * ball.radius or not levels.halve(most):
                break
        return CornerGouges(*levels.gather())
