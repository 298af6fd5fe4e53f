"""Points along the pieces of passes; those of pieces that were traced before are not traced again."""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from toolaxis.path.chord_tolerance import follow, rises
from toolaxis.path.links import CuttingMove
from toolaxis.path.parametrization import Chart, Cut, tip_points

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TracedPiece:
    """A piece of a pass with its points.

    Attributes
    ----------
    along : (n,) array
        Values of the along parameter.
    move : CuttingMove
        In the sense of that parameter.
    """

    along: Array
    move: CuttingMove


@dataclass(eq=False)
class TracedPieces:
    """Pieces of passes with the same parameters and the same cut, as they come and go while passes are mended.

    Few pieces of many change then, and to follow the others once more would give the same points.
    """

    _found: dict[tuple[float, ...], TracedPiece] = field(default_factory=dict)

    def trace(self, chart: Chart, cut: Cut, pieces: Array, chord: float) -> list[TracedPiece]:
        """The points of pieces.

        Parameters
        ----------
        chart : Chart
            The same each time.
        cut : Cut
            The same each time.
        pieces : (m, 3) array
            along0, along1, step of each piece.
        chord : float
            How far straight motions may leave passes, mm.
        """
        keys = [(low, high, step, chord) for low, high, step in pieces.tolist()]
        new = [row for row, key in enumerate(keys) if key not in self._found]
        if new:
            self._found.update(zip((keys[row] for row in new), _trace(chart, cut, pieces[new], chord), strict=True))
        return [self._found[key] for key in keys]


def _trace(chart: Chart, cut: Cut, pieces: Array, chord: float) -> list[TracedPiece]:
    piece, along = follow(chart, cut, pieces, chord)
    steps = pieces[piece, 2]
    contact, tip, normal = tip_points(chart, cut, along, steps)
    tip = tip - rises(chart, cut, steps, (piece, along), tip)[:, None] * normal
    ends = np.searchsorted(piece, np.arange(len(pieces) + 1)).tolist()
    return [TracedPiece(along[a:b], CuttingMove(contact[a:b], tip[a:b], normal[a:b]))
            for a, b in pairwise(ends)]
