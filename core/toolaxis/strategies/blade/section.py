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
        count = len(self.points) - 1
        return _make_section(np.roll(self.points[:count], -(first % count), axis=0))


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
    rows = rows[np.concatenate([[True], (np.diff(rows, axis=0) != 0).any(axis=1)])]
    if len(rows) > 1 and (rows[0] == rows[-1]).all():
        rows = rows[:-1]
    if len(rows) < 8:
        raise InvalidInput(f"{place} has {len(rows)} different points: eight at least are needed")
    _check_closed(rows, place)
    _check_simple(rows, place)
    x, y = rows.T
    area = float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    return _make_section(rows if area > 0 else np.concatenate([rows[:1], rows[:0:-1]]))


def _make_section(rows: Array) -> Section:
    closed = np.concatenate([rows, rows[:1]])
    step = np.diff(closed, axis=0)
    angle = np.arctan2(step[:, 1], step[:, 0])
    turn = (np.diff(angle, append=angle[:1]) + pi) % (2 * pi) - pi
    ahead = angle[0] + np.concatenate([[0.0], np.cumsum(turn)])
    behind = np.concatenate([[ahead[-2] - 2 * pi], ahead[:-1]])
    size = np.hypot(step[:, 0], step[:, 1])
    lengths = np.concatenate([[0.0], np.cumsum(size)])
    return Section(closed, lengths, ahead, behind)


def _check_closed(rows: Array, place: str) -> None:
    step = np.hypot(*np.diff(rows, axis=0).T)
    gap = float(np.hypot(*(rows[-1] - rows[0])))
    if gap > max(_STEPS * float(step.max()), _SHARE * float(step.sum())):
        raise InvalidInput(f"{place} is open: its ends are {gap:.3f} mm apart at {np.round(rows[0], 3).tolist()}; "
                           "close it, or choose faces that go all around the blade")


def _check_simple(rows: Array, place: str) -> None:
    """That no two segments cross, pieces of the section first."""
    a, b = rows, np.roll(rows, -1, axis=0)
    low, high = np.minimum(a, b), np.maximum(a, b)
    edges = np.arange(0, len(rows), _CHUNK)
    low, high = np.minimum.reduceat(low, edges), np.maximum.reduceat(high, edges)
    near = ((low[:, None] <= high[None]) & (low[None] <= high[:, None])).all(axis=2)
    i, j = np.nonzero(np.triu(near))
    own = np.minimum(edges[:, None] + np.arange(_CHUNK), len(rows) - 1)
    one, other = own[i][:, :, None], own[j][:, None, :]
    p, r, q, s = a[one], (b - a)[one], a[other], (b - a)[other]
    across = _cross(r, s)
    gap = np.abs(one - other)
    with np.errstate(divide="ignore", invalid="ignore"):
        t, u = _cross(q - p, s) / across, _cross(q - p, r) / across
    found = np.argwhere((gap > 1) & (gap < len(rows) - 1) & (across != 0) & (t > 0) & (t < 1) & (u > 0) & (u < 1))
    if len(found):
        at = rows[own[i[found[0, 0]], found[0, 1]]]
        raise InvalidInput(f"{place} crosses itself near {np.round(at, 3).tolist()}: take {SMALLER_CUTTER} where it is "
                           "concave, or repair the section")


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
    count = len(one.points) - 1
    tangent = np.concatenate([one.ahead[:-1], one.ahead[:-1] + 2 * pi])
    drop = np.maximum.accumulate(tangent) - tangent
    deepest = int(np.argmax(drop[count:])) + count
    if drop[deepest] > HOLLOW:
        return deepest % count
    turns = np.array([-1.0, 0.0, 1.0])[:, None]
    angle = np.maximum.accumulate((one.ahead[:-1] + 2 * pi * turns).ravel())
    places = (one.lengths[:-1] + one.length * turns).ravel()
    here = one.lengths[:-1]
    ahead, before = (np.interp(one.ahead[:-1] + sense * pi / 2, angle, places) for sense in (1, -1))
    return int(np.argmax(np.round(np.minimum(ahead - here, here - before), 6)))
