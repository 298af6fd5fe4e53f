"""Borders around cells of a face: smooth loops in u and v, by which a polygon is cut."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.contours import contours
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.numeric.sparse_grid import SparseGrid

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Loops = tuple[Array, ...]

#: How far values fade at the edge of what is held, in cells, and what is left of them where it ends: the next is taken
#: where corners of the border would lie on that of the face.
_BLUR, _EDGES = 0.8, (0.15, 0.17, 0.13)
#: Cells by which borders run on into what others have, before that is taken off.
_OVER = 3
#: How far corners that are left out lie beside the border, in cells.
_STRAIGHT = 0.3


class CellBorders:
    """Borders around cells of a lattice.

    Parameters
    ----------
    on : (m, n) array of bool
        Which cells have something of the face.
    lines : pair of (m,) and (n,) arrays
        Parameters u and v of the middles of the cells.
    """

    def __init__(self, on: Bools, lines: tuple[Array, Array]) -> None:
        from scipy.ndimage import distance_transform_edt

        self._nearest = tuple(distance_transform_edt(~on, return_distances=False, return_indices=True))
        self._size = np.array([np.median(np.diff(line)) for line in lines])
        self._lines = _longer(lines[0]), _longer(lines[1])

    def around(self, held: Bools, taken: Bools) -> Iterator[Loops]:
        """Loops around cells; where the face ends there, or what others have begins, they run beyond it.

        Parameters
        ----------
        held, taken : (m, n) arrays of bool
            The cells, and those that others have.

        Yields
        ------
        tuple of (k, 2) arrays
            The same a little larger or smaller each time: no corner of one of them lies on the border of the face.
        """
        from scipy.ndimage import binary_dilation, gaussian_filter

        own = binary_dilation(held, iterations=_OVER, mask=held | taken)
        value = np.pad(np.where(own, 1.0, -1.0)[self._nearest], 2, mode="edge")
        faded = gaussian_filter(value, _BLUR, mode="nearest")
        for edge in _EDGES:
            loops = contours(SparseGrid.of_all(self._lines, faded - edge))
            yield tuple(loop[simplify_loop(loop / self._size, _STRAIGHT)] for loop in loops)


def _longer(line: Array) -> Array:
    """Parameters with two more on either side."""
    before, behind = line[1] - line[0], line[-1] - line[-2]
    return np.concatenate([line[0] - before * np.array([2.0, 1.0]), line, line[-1] + behind * np.array([1.0, 2.0])])
