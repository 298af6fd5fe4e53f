"""What passes machine beside the sub-surfaces that they were laid for: nobody has to come there again.

Where a face is divided by reach, its sub-surfaces end before what their axes do not reach, and what lies between them
is left.  Passes run out beyond the border of a sub-surface, and the last strip is wider than what is left of it: much
of what lies between is machined all the same.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.numeric.grids import grid_nodes
from toolaxis.numeric.polygon_boolean import divide_nearly, unite_polygons
from toolaxis.partition.uv_grid import Lattice
from toolaxis.path.rest_material import Excess, RestFinder, may_stay, undercut
from toolaxis.plan.operation import Operation
from toolaxis.regions.cell_borders import CellBorders
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Loops = tuple[Array, ...]

#: Size of the cells in which it is looked, in widths of the narrowest strip that a cutter may leave; how many of them a
#: rest has about at most, and the box around it; and the fewest along a side.
_SIZE, _MOST, _IN_BOX, _FEWEST_ALONG = 1 / 10, 80_000, 4_000_000, 12
#: Cells beside those that passes do not machine that are left too: ends of strips leave tips narrower than a cell.
_EDGE = 2
#: Area from which on it is told, mm^2.
_TOLD = 0.05
#: Connected cells fewer than this are not worth a border.
_FEWEST = 12


def take_machined_beside(operations: Sequence[Operation], scallop: float, allowance: float) -> list[Operation]:
    """Operations on pieces of one face, those with passes on larger ones by what they machine of pieces without any.

    Parameters
    ----------
    operations : sequence of Operation
        Of sub-surfaces that do not overlap, some of them without an axis.
    scallop : float
        Limit of the scallop height, mm.
    allowance : float
        Stock left on the face, mm.

    Returns
    -------
    list of Operation
        In their order; those of which nothing is left are missing.

    Notes
    -----
    What is machined is told in the middles of small cells: of each that is taken, and of all around it, two cells far.
    Then it is looked at as closely as for the proof of passes, and left where too much of it stays high.

    **Properties**: 1. areas of the sub-surfaces add up as before, and none of them overlaps another one.
    """
    found = dict(enumerate(operations))
    done = [k for k, op in found.items() if op.path is not None]
    rests = [k for k, op in found.items() if op.orientation.axis is None and not op.failed] if done else []
    for k in rests:
        whole = found[k]
        rest = _Rest(whole.face, min(_strip(found[j].tool, scallop) for j in done))
        for j in done:
            gained = rest.take(found[j], scallop, allowance)
            if gained:
                found[j] = _on(found[j], unite_polygons(found[j].face.outline, gained))
        if rest.loops:
            found[k] = _tell(_on(whole, rest.loops), whole.face.area)
        else:
            del found[k]
    return list(found.values())


def _strip(tool: Tool, scallop: float) -> float:
    """Width of the narrowest strip that a cutter may leave on a plane, mm."""
    return float(2 * np.sqrt(2 * (tool.corner_radius or tool.radius) * scallop))


def _tell(op: Operation, area: float) -> Operation:
    """An operation without an axis that tells how much of an area, mm^2, others machine."""
    gained = area - op.face.area
    if gained < _TOLD:
        return op
    words = f"passes beside it machine {gained:.1f} mm2 of that"
    return replace(op, orientation=replace(op.orientation, reasons=(*op.orientation.reasons, words)))


def _on(op: Operation, loops: Loops) -> Operation:
    """An operation on another piece of its face."""
    return replace(op, face=replace(op.face, trims=loops))


class _Rest:
    """What is left of a face, in cells.

    Attributes
    ----------
    loops : tuple of (m, 2) arrays
        Around what nothing has taken yet; empty where all is taken.
    """

    def __init__(self, face: Face, strip: float) -> None:
        along, across = (float(np.median(lengths.sum(axis=way))) for way, lengths in enumerate(Lattice(face).lengths))
        size = max(_SIZE * strip, (face.area / _MOST) ** 0.5, (along * across / _IN_BOX) ** 0.5)
        counts = [max(int(np.ceil(side / size)), _FEWEST_ALONG) for side in (along, across)]
        u, v = (_middles(line) for line in Lattice(face, (counts[0], counts[1])).lines)
        self._face, self._lines = face, (u, v)
        middles = grid_nodes(u, v)
        self._on = face.contains(middles.reshape(-1, 2)).reshape(middles.shape[:2])
        self._taken = np.zeros_like(self._on)
        self.loops: Loops = face.outline
        self._borders = CellBorders(self._on, self._lines) if self._on.any() else None

    def take(self, op: Operation, scallop: float, allowance: float) -> Loops:
        """Take off what an operation leaves no higher than the limit, and return loops around it; none for nothing."""
        if self._borders is None or op.path is None:
            return ()
        held = self._machined(Excess(self._face, op.tool, op.path, allowance + scallop))
        if not held.any():
            return ()
        for around in self._borders.around(held, self._taken):
            with suppress(InvalidInput):
                gained, left = divide_nearly(self.loops, around)
                if not gained or not _is_machined(self._face.trimmed(gained), op.tool, op.path, scallop, allowance):
                    return ()
                self.loops = left
                self._taken |= held
                return gained
        return ()

    def _machined(self, high: Excess) -> Bools:
        """Cells that passes machine, those aside that lie next to one that they do not, (m, n)."""
        from scipy.ndimage import binary_dilation, label

        beside = np.ones((3, 3))
        # Up to its border a rest is machined only where that goes on beyond it.
        asked = binary_dilation(self._on, structure=beside, iterations=_EDGE)
        above = np.zeros_like(asked)
        i, j = np.nonzero(asked)
        above[i, j] = high(np.column_stack([self._lines[0][i], self._lines[1][j]])) > 0
        held = self._on & ~self._taken & ~binary_dilation(above, structure=beside, iterations=_EDGE)
        parts, _ = label(held, structure=beside)
        return np.asarray(held & (np.bincount(parts.ravel()) >= _FEWEST)[parts])


def _is_machined(face: Face, tool: Tool, path: ToolPath, scallop: float, allowance: float) -> bool:
    """Whether passes leave no more of a face high than may stay, looked at as closely as for the proof of passes."""
    finder = RestFinder(face, tool, scallop, allowance, walls=lambda uv: np.zeros(len(uv), dtype=bool))
    zones = finder.find(path)
    return undercut(zones) <= may_stay(zones, face.area)


def _middles(line: Array) -> Array:
    """Middles between parameters, with some more on either side."""
    more = np.arange(_EDGE) + 0.5
    first, last = line[1] - line[0], line[-1] - line[-2]
    return np.concatenate([line[0] - first * more[::-1], (line[1:] + line[:-1]) / 2, line[-1] + last * more])
