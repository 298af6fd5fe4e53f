"""One layer of a path around a blade: the closed section of its cutter centres, with arc lengths and tangent angles.

Lengths S begin at the base point, tangent angles grow along the convex parts and fall along the hollow ones; one turn
around the blade adds a full turn to them.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import SMALLER_CUTTER
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]
Index = NDArray[np.intp]

#: A section is open where its ends are farther apart than so many of its steps, and than this share of its length.
_STEPS, _SHARE = 3.0, 0.02
#: Tangents must fall by this much, rad, for a part to count as hollow.
HOLLOW = np.radians(3.0)
#: Pieces of a section that are compared with each other before their segments are.
_CHUNK = 16


@dataclass(frozen=True, eq=False)
class Section:
    """A closed section, anticlockwise, from its base point on.

    Attributes
    ----------
    points : (n + 1, 2) array
        mm; the last one closes it.
    lengths : (n + 1,) array
        S of each point, mm.
    ahead, behind : (n + 1,) array
        Directions of the edges after and before each point, rad, unwrapped; both grow by a full turn from the first
        point to the last.
    """

    points: Array
    lengths: Array
    ahead: Array
    behind: Array

    @property
    def length(self) -> float:
        """Of the whole section, mm."""
        return float(self.lengths[-1])

    def begun_at(self, first: int) -> "Section":
        """The same section from another point on.

        Parameters
        ----------
        first : int
        """
        distinct = self.points[:-1]
        begin = first % len(distinct)
        return _make_section(np.roll(distinct, -begin, axis=0))


def section(points: ArrayLike, place: str = "section") -> Section:
    """A section from its points, turned anticlockwise.

    Parameters
    ----------
    points : (n, 2) array_like
        Cutter centres in their plane, mm; the first one may stand at the end again.
    place : str
        What messages call it.

    Raises
    ------
    InvalidInput
        When it is open, crosses itself or has fewer than eight points.
    """
    rows = as_rows(points, 2, f"points of {place}")
    moves = (np.diff(rows, axis=0) != 0).any(axis=1)
    is_new = np.concatenate([[True], moves])
    rows = rows[is_new]
    if len(rows) > 1 and (rows[0] == rows[-1]).all():
        rows = rows[:-1]
    if len(rows) < 8:
        raise InvalidInput(f"{place} has {len(rows)} different points: eight at least are needed")
    _check_closed(rows, place)
    _check_simple(rows, place)
    x, y = rows.T
    twice_area = x * np.roll(y, -1) - y * np.roll(x, -1)
    if not float(twice_area.sum()) > 0:
        rows = np.concatenate([rows[:1], rows[:0:-1]])
    return _make_section(rows)


def _make_section(rows: Array) -> Section:
    closed = np.concatenate([rows, rows[:1]])
    step = np.diff(closed, axis=0)
    angle = np.arctan2(step[:, 1], step[:, 0])
    turn = np.diff(angle, append=angle[:1])
    turn = (turn + pi) % (2 * pi) - pi
    turned = np.concatenate([[0.0], np.cumsum(turn)])
    ahead = angle[0] + turned
    before_first = ahead[-2] - 2 * pi
    behind = np.concatenate([[before_first], ahead[:-1]])
    size = np.hypot(step[:, 0], step[:, 1])
    lengths = np.concatenate([[0.0], np.cumsum(size)])
    return Section(closed, lengths, ahead, behind)


def _check_closed(rows: Array, place: str) -> None:
    along_x, along_y = np.diff(rows, axis=0).T
    step = np.hypot(along_x, along_y)
    gap = float(np.hypot(*(rows[-1] - rows[0])))
    by_steps = _STEPS * float(step.max())
    by_length = _SHARE * float(step.sum())
    if gap > max(by_steps, by_length):
        raise InvalidInput(f"{place} is open: its ends are {gap:.3f} mm apart at {np.round(rows[0], 3).tolist()}; "
                           "close it, or choose faces that go all around the blade")


def _check_simple(rows: Array, place: str) -> None:
    """That no two segments cross, pieces of the section first."""
    ends = np.roll(rows, -1, axis=0)
    pieces = np.arange(0, len(rows), _CHUNK)
    i, j = _pieces_that_may_cross(rows, ends, pieces)
    segments = pieces[:, None] + np.arange(_CHUNK)
    segments = np.minimum(segments, len(rows) - 1)
    one = segments[i][:, :, None]
    other = segments[j][:, None, :]
    step = ends - rows
    crosses = _cross_inside(rows[one], step[one], rows[other], step[other])
    gap = np.abs(one - other)
    are_neighbours = (gap <= 1) | (gap >= len(rows) - 1)
    found = np.argwhere(crosses & ~are_neighbours)
    if len(found):
        pair, segment, _ = found[0]
        at = rows[segments[i[pair], segment]]
        raise InvalidInput(f"{place} crosses itself near {np.round(at, 3).tolist()}: take {SMALLER_CUTTER} where it is "
                           "concave, or repair the section")


def _pieces_that_may_cross(begins: Array, ends: Array, pieces: Index) -> tuple[Index, Index]:
    """Pairs of pieces whose boxes meet; a piece is the segments from one of some numbers to the next."""
    low = np.minimum.reduceat(np.minimum(begins, ends), pieces)
    high = np.maximum.reduceat(np.maximum(begins, ends), pieces)
    begins_before = low[:, None] <= high[None]
    ends_behind = low[None] <= high[:, None]
    near = (begins_before & ends_behind).all(axis=2)
    one, other = np.nonzero(np.triu(near))
    return one, other


def _cross_inside(p: Array, r: Array, q: Array, s: Array) -> NDArray[np.bool_]:
    """Whether segments p + t r and q + u s cross between their ends."""
    across = _cross(r, s)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = _cross(q - p, s) / across
        u = _cross(q - p, r) / across
    inside_one = (t > 0) & (t < 1)
    inside_other = (u > 0) & (u < 1)
    return np.asarray((across != 0) & inside_one & inside_other)


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def base_of(one: Section) -> int:
    """The point at which layers begin: the end of the deepest hollow, where the section turns convex again.

    Of a section without a hollow, the place from which the way to a quarter of a turn is longest on both sides.

    Parameters
    ----------
    one : Section

    Notes
    -----
    **Source**: [stheta2023] Sec. 2.1.
    """
    first_turn = one.ahead[:-1]
    count = len(first_turn)
    tangent = np.concatenate([first_turn, first_turn + 2 * pi])
    drop = np.maximum.accumulate(tangent) - tangent
    deepest = int(np.argmax(drop[count:])) + count
    if drop[deepest] > HOLLOW:
        return deepest % count
    turns = np.array([-1.0, 0.0, 1.0])[:, None]
    angle = (first_turn + 2 * pi * turns).ravel()
    greatest = np.maximum.accumulate(angle)
    here = one.lengths[:-1]
    places = (here + one.length * turns).ravel()
    ahead = np.interp(first_turn + pi / 2, greatest, places)
    before = np.interp(first_turn - pi / 2, greatest, places)
    shorter = np.minimum(ahead - here, here - before)
    return int(np.argmax(np.round(shorter, 6)))
