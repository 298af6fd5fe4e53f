"""Lines along which a face is divided into base cells, each with its own bounds of the second derivatives."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Halvings towards a border beyond where its lines are as short as a point, and halvings at most.
_BEYOND, _MOST_GRADED = 4, 24


def grid_lines(knots: Array, degree: int, low: float, high: float) -> Array:
    """Lines of the base cells: the knots, and spans of curved directions divided until there are 8 or more.

    Parameters
    ----------
    knots : (m,) array
    degree : int
    low, high : float
        Range to be covered.
    """
    inner = knots[(knots > low) & (knots < high)]
    ends = np.unique(np.concatenate([[low], inner, [high]]))
    wanted = 1 if degree == 1 else 8
    shares = np.diff(ends) / (high - low)
    parts = np.maximum(1, np.ceil(shares * wanted - 1e-9)).astype(int)
    pieces = [np.linspace(begin, end, count + 1)[:-1]
              for begin, end, count in zip(ends[:-1], ends[1:], parts, strict=True)]
    return np.concatenate([*pieces, [high]])


def grade_lines(face: Face, lines: tuple[Array, Array], across: int, fineness: float) -> Array:
    """Lines of one direction, with more of them towards a border that shrinks to a point (the pole of a sphere).

    Second derivatives along such a border vanish at it, but their bound over a cell is that of the cell's far side:
    between lines that halve the way to the border it is never much more than what it is at the cell itself.

    Parameters
    ----------
    face : Face
    lines : tuple of two arrays
        From `grid_lines`, for u and v.
    across : int
        0 for lines of constant u, 1 for those of constant v.
    fineness : float
        Length of a border that counts as a point, mm.
    """
    own = lines[across]
    other = lines[1 - across]
    more = [own]
    for end, inner in ((own[0], own[1]), (own[-1], own[-2])):
        border = _length_along(face, end, other, across)
        beside = _length_along(face, inner, other, across)
        if border <= fineness < beside:
            halvings = int(np.ceil(np.log2(beside / fineness)))
            count = min(halvings + _BEYOND, _MOST_GRADED)
            more.append(end + (inner - end) * 0.5 ** np.arange(1, count + 1))
    return np.unique(np.concatenate(more))


def _length_along(face: Face, at: float, other: Array, across: int) -> float:
    """About the length of one line of a grid, mm: never less than the longest of its derivatives says."""
    same = np.full(len(other), at)
    uv = np.column_stack([same, other] if across == 0 else [other, same])
    found = face.evaluate(uv)
    rates = np.linalg.norm(found.sv if across == 0 else found.su, axis=1)
    return float(rates.max() * (other[-1] - other[0]))
