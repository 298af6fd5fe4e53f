"""A part on a grid of cells, and from where lines of a cone of directions get by its material: the kernels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.regions.reach_kernel import ReachTree, is_on_leaf

Array = NDArray[np.float64]
Bytes = NDArray[np.uint8]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]
Words = NDArray[np.uint64]

NO_BORDER, BORDER, HELD = 0, 1, 2
"""A cell that no face meets, one that a face may meet, and one in which, or nearly so, there is a place of a face."""
BITS = 64
"""Cells in a word."""
_STEP = 0.25
"""Distance of the places of a leaf at which it is looked at, in the length of a cell."""
_AROUND = 1.5
"""How near to a part of a leaf trim edges count, in its own size."""
_ROUNDING = 1e-4
"""What is added to the reach of parts of a leaf, in the length of a cell."""
NEARLY = 0.06
"""How far beside a cell that place may be, in the length of a cell."""
_WHOLE = 0.999
"""By how many cells lines may shift within a block, a little less than one."""


class ConeLines(NamedTuple):
    """Lines along (1, p, q), or against that, with any p and q of some range, in turned coordinates."""

    forth: int
    """1 where lines run to greater numbers along the first coordinate, -1 where they run to smaller ones."""
    slope: tuple[float, float]
    """The middles of p and q."""
    spread: tuple[float, float]
    """By how much they differ from these at most."""
    thick: float
    """Way in cells from where on lines are thick."""
    length: float
    """Whole way of the lines, in cells."""


@jit_inline
def _crosses(tree: ReachTree, edge: int, place: tuple[float, float], half: tuple[float, float]) -> bool:
    """Whether a trim edge runs through a rectangle of u and v, or along its border."""
    u, v = tree.edges[edge, 0] - place[0], tree.edges[edge, 1] - place[1]
    du, dv = tree.edges[edge, 2] - place[0] - u, tree.edges[edge, 3] - place[1] - v
    if max(u, u + du) < -half[0] or min(u, u + du) > half[0] or max(v, v + dv) < -half[1] or min(v, v + dv) > half[1]:
        return False
    # All four corners lie on one side of the edge's line where the middle is farther from it than any corner.
    return bool(abs(u * dv - v * du) <= abs(dv) * half[0] + abs(du) * half[1])


@jit_inline
def _may_be_on_face(tree: ReachTree, leaf: int, place: tuple[float, float], half: tuple[float, float]) -> bool:
    """Whether anything of a rectangle of u and v in a leaf may lie inside the loops of the face."""
    for edge in range(tree.edge_start[leaf], tree.edge_start[leaf + 1]):
        if _crosses(tree, edge, place, half):
            return True
    return is_on_leaf(tree, leaf, place[0], place[1])


@jit_inline
def _mark(cells: Bytes, low: Indices, high: Indices) -> None:
    """Mark a box of cells as those of a border, but for those of which more is known."""
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            for k in range(low[2], high[2] + 1):
                cells[i, j, k] = max(cells[i, j, k], BORDER)


@jit
def mark_borders(tree: ReachTree, leaves: Indices, cells: Bytes, origin: Array, size: float) -> None:
    """Mark the cells of a grid that faces may meet.

    Parameters
    ----------
    tree : ReachTree
        Of the faces.
    leaves : (n,) array of int
        Nodes of it that are leaves.
    cells : (i, j, k) array of bytes
        BORDER where a face may meet a cell, HELD where a place of it is there.
    origin : (3,) array
        Corner of the first cell, mm.
    size : float
        Length of a cell, mm.
    """
    low, high, inside = np.empty(3, np.int64), np.empty(3, np.int64), np.empty(3, np.int64)
    for n in range(len(leaves)):
        node = tree.shape[leaves[n]]
        leaf = int(tree.link[leaves[n], 3])
        bend = tree.bend[leaf]
        trimmed = tree.edge_start[leaf + 1] > tree.edge_start[leaf]
        long = np.sqrt(node[3] ** 2 + node[4] ** 2 + node[5] ** 2)
        wide = np.sqrt(node[6] ** 2 + node[7] ** 2 + node[8] ** 2)
        along, across = int(np.ceil(2 * long / (_STEP * size))) + 1, int(np.ceil(2 * wide / (_STEP * size))) + 1
        hs, ht = 1 / along, 1 / across
        half = (_AROUND * hs * tree.rect[leaf, 2], _AROUND * ht * tree.rect[leaf, 3])
        for i in range(along):
            s = (2 * i + 1) * hs - 1
            for j in range(across):
                t = (2 * j + 1) * ht - 1
                u, v = tree.rect[leaf, 0] + s * tree.rect[leaf, 2], tree.rect[leaf, 1] + t * tree.rect[leaf, 3]
                if trimmed and not _may_be_on_face(tree, leaf, (u, v), half):
                    continue
                for c in range(3):
                    a, b, aa, ab, bb = node[3 + c], node[6 + c], bend[c], bend[3 + c], bend[6 + c]
                    at = node[c] + s * a + t * b + (s * s * aa + 2 * s * t * ab + t * t * bb) / 2 - origin[c]
                    # No point of this part of the leaf is farther from its middle.
                    reach = (abs(a + s * aa + t * ab) * hs + abs(b + s * ab + t * bb) * ht
                             + (abs(aa) * hs * hs + 2 * abs(ab) * hs * ht + abs(bb) * ht * ht) / 2
                             + bend[9] + _ROUNDING * size)
                    low[c] = max(int(np.floor((at - reach) / size)), 0)
                    high[c] = min(int(np.floor((at + reach) / size)), cells.shape[c] - 1)
                    inside[c] = min(max(int(np.floor(at / size)), 0), cells.shape[c] - 1)
                _mark(cells, low, high)
                if bend[9] <= NEARLY * size and (not trimmed or is_on_leaf(tree, leaf, u, v)):
                    cells[inside[0], inside[1], inside[2]] = HELD


@jit_inline
def _add_open(plane: Words, beyond: Words, row: int, first: int, found: Words) -> None:
    """Add to words of rows which of their cells are open, from a row and a bit of a plane (words, rows) on.

    All that lies beyond the plane is open, as the words of `beyond` (rows,) are.
    """
    every = ~np.uint64(0)
    words, rows = plane.shape
    word = first // BITS
    low = plane[word] if 0 <= word < words else beyond
    high = plane[word + 1] if 0 <= word + 1 < words else beyond
    begin, end = min(max(-row, 0), len(found)), max(min(rows - row, len(found)), 0)
    down = np.uint64(first % BITS)
    # A word is not moved by all of its bits at once: that is not defined.
    up = np.uint64(BITS - 1) - down
    for i in range(begin, end):
        found[i] |= (low[row + i] >> down) | ((high[row + i] << np.uint64(1)) << up)
    found[:begin] = every
    found[end:] = every


@jit_inline
def _find_open_columns(plane: Words, beyond: Words, row: int, first: int, line: Words, free: Words) -> None:
    """Bits of the columns that are open in a plane, (words, rows): those that meet an open cell among the four that a
    column meets, of which a row and a bit are given for the first column.

    `line` (rows + 1,) is room to work in.
    """
    words, rows = free.shape
    for w in range(words):
        line[:] = np.uint64(0)
        _add_open(plane, beyond, row, first + BITS * w, line)
        _add_open(plane, beyond, row, first + BITS * w + 1, line)
        for i in range(rows):
            free[w, i] = line[i] | line[i + 1]


@jit_inline
def _and_beside(before: np.uint64, here: np.uint64, after: np.uint64) -> np.uint64:
    """Bits of a word, with those beside each set bit."""
    one, last = np.uint64(1), np.uint64(BITS - 1)
    return here | (here << one) | (before >> last) | (here >> one) | (after << last)


@jit_inline
def _pass_plane(free: Words, still: Words, by_p: Words, by_q: Words, both: Words) -> None:
    """From which columns lines get by a plane, and on from there.

    Parameters
    ----------
    free : (words, rows) array
        Columns that are open in the plane.
    still, by_p, by_q, both : (words + 2, rows + 2) arrays
        Columns of lines that get by all planes beyond, with a border of those that do: without crossing to the column
        beside theirs, crossing once at most along p, along q, and once along each.  They are changed to those that get
        by this plane too.
    """
    words, rows = free.shape
    for w in range(1, words + 1):
        for i in range(1, rows + 1):
            found = both[w, i] | by_q[w, i - 1] | by_q[w, i] | by_q[w, i + 1]
            found |= _and_beside(by_p[w - 1, i], by_p[w, i], by_p[w + 1, i])
            found |= _and_beside(still[w - 1, i - 1] | still[w - 1, i] | still[w - 1, i + 1],
                                 still[w, i - 1] | still[w, i] | still[w, i + 1],
                                 still[w + 1, i - 1] | still[w + 1, i] | still[w + 1, i + 1])
            both[w, i] = found & free[w - 1, i - 1]
    for w in range(1, words + 1):
        for i in range(1, rows + 1):
            by_p[w, i] = (by_p[w, i] | still[w, i - 1] | still[w, i] | still[w, i + 1]) & free[w - 1, i - 1]
        for i in range(1, rows + 1):
            by_q[w, i] = (by_q[w, i] | _and_beside(still[w - 1, i], still[w, i], still[w + 1, i])) & free[w - 1, i - 1]
    for w in range(1, words + 1):
        for i in range(1, rows + 1):
            still[w, i] &= free[w - 1, i - 1]


@jit_inline
def _gets_by(both: Words, low_p: int, high_p: int, low_q: int, high_q: int) -> bool:
    """Whether a line gets by from any of some columns; those beyond what is known count as if it did."""
    words, rows = both.shape
    for i in range(low_p, high_p + 1):
        for j in range(low_q, high_q + 1):
            if i < 0 or i >= rows - 2 or j < 0 or j >= BITS * (words - 2):
                return True
            if (both[j // BITS + 1, i + 1] >> np.uint64(j % BITS)) & np.uint64(1):
                return True
    return False


@jit
def _columns_of(cone: ConeLines, start: Array, off: float, side: int, begin: int) -> tuple[int, int]:
    """Least and greatest number of the columns that lines of a bundle are in at the plane in which all have begun."""
    slope, spread = cone.slope[side], cone.spread[side]
    steepest = abs(slope) + spread
    wide = off * np.sqrt(1 + steepest * steepest) + abs(begin + 0.5 - start[0]) * spread
    middle = start[1 + side] - slope * start[0]
    return int(np.floor(middle - wide)), int(np.floor(middle + wide))


@jit
def sweep_lines(open_: Words, clear: Words, cone: ConeLines, start: Array, off: Array, stopped: Bools) -> None:
    """Whether all lines along a cone of directions meet material that begin near some places.

    Parameters
    ----------
    open_, clear : (planes, words, rows) arrays
        Bits of cells that are not known to be material, and of those in which a thick line meets nothing for sure, by
        planes across the lines.
    cone : ConeLines
    start : (n, 3) array
        Places in cells from the grid's corner, turned as the planes are, of which there is one at least.
    off : (n,) array
        How far from there lines begin at most, in cells.
    stopped : (n,) array of bool
        Whether every line is met.

    Notes
    -----
    Planes run through the middles of cells, and are taken from the far end of the lines to their beginnings.  Columns
    are slanted as the middle of the cone, so that lines change to another one seldom: in a block of planes in which a
    line shifts by less than a cell it crosses one border of columns along p at most, and one along q.  A column is
    closed in a plane where all four cells that it meets there are: there every line in it is met.
    """
    every, forth = ~np.uint64(0), cone.forth
    spread = max(cone.spread[0], cone.spread[1])
    # How far lines go along the first coordinate: to where they end at least, and to where they are thick at most.
    length = cone.length / np.sqrt(1 + (abs(cone.slope[0]) + cone.spread[0]) ** 2
                                   + (abs(cone.slope[1]) + cone.spread[1]) ** 2)
    thick = cone.thick / np.sqrt(1 + max(abs(cone.slope[0]) - cone.spread[0], 0.0) ** 2
                                 + max(abs(cone.slope[1]) - cone.spread[1], 0.0) ** 2)
    begins, columns = np.empty(len(start), np.int64), np.empty((len(start), 4), np.int64)
    nearest, farthest = np.inf, -np.inf
    for n in range(len(start)):
        nearest = min(nearest, forth * start[n, 0] - off[n])
        farthest = max(farthest, forth * start[n, 0] + off[n])
        # All lines have begun at the first plane beyond, which counts from the far end here.
        begins[n] = -int(np.ceil(forth * start[n, 0] + off[n] - 0.5 * forth))
        columns[n, 0], columns[n, 1] = _columns_of(cone, start[n], off[n], 0, -forth * begins[n])
        columns[n, 2], columns[n, 3] = _columns_of(cone, start[n], off[n], 1, -forth * begins[n])
    ends = int(np.floor(min(nearest + length - 0.5 * forth, float(len(open_) - 1) if forth > 0 else 0.0)))
    closes = int(np.ceil(min(farthest + thick - 0.5 * forth, float(ends + 1))))
    margin = int(np.ceil(spread * max(ends + begins.max(), -ends - begins.min(), 0))) + 1
    first_p, first_q = columns[:, 0].min() - margin, columns[:, 2].min() - margin
    rows = columns[:, 1].max() + margin + 1 - first_p
    words = (columns[:, 3].max() + margin - first_q) // BITS + 1
    free, line = np.empty((words, rows), np.uint64), np.empty(rows + 1, np.uint64)
    beyond = np.full(open_.shape[2], every)
    still, by_p = np.full((words + 2, rows + 2), every), np.full((words + 2, rows + 2), every)
    by_q, both = np.full((words + 2, rows + 2), every), np.full((words + 2, rows + 2), every)
    block = int(_WHOLE / spread)
    order = np.argsort(begins, kind="mergesort")
    passed, n, k = 0, 0, ends
    while n < len(order):
        plane = k * forth
        free[:] = every
        if 0 <= plane < len(open_):
            _find_open_columns(clear[plane] if k >= closes else open_[plane], beyond,
                               first_p + int(np.floor(cone.slope[0] * (plane + 0.5))),
                               first_q + int(np.floor(cone.slope[1] * (plane + 0.5))), line, free)
        _pass_plane(free, still, by_p, by_q, both)
        passed += 1
        if passed % block == 0:
            still[:], by_p[:], by_q[:] = both, both, both
        while n < len(order) and -begins[order[n]] >= k:
            bundle = order[n]
            stopped[bundle] = -begins[bundle] == k and not _gets_by(
                both, columns[bundle, 0] - first_p, columns[bundle, 1] - first_p, columns[bundle, 2] - first_q,
                columns[bundle, 3] - first_q)
            n += 1
        k -= 1
