"""The line around faces that meet, in the plane in which they are seen."""

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.polygons import inside, signed_area, slabs
from toolaxis.numeric.simplify_polyline import simplify_loop
from toolaxis.skin.seen_face import SeenFace

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
_Free: TypeAlias = Callable[[NDArray[np.intp], Array], Bools]

#: Halvings that find where a border leaves another face.
_HALVED = 12
#: How far ends of lines that follow each other may lie apart, in widths of the gap.
_JOINED = 25.0
#: How far points that are left out lie beside the line at most, as a share of the gap's width.
_PLAIN = 0.02


def outline_around(seen: Sequence[SeenFace], gap: float) -> tuple[Array, ...]:
    """Loops around faces that meet, the outer one first, then the holes.

    Parameters
    ----------
    seen : sequence of SeenFace
        In one plane.
    gap : float
        Faces whose borders lie nearer to each other meet, mm; so far the loops may lie off where faces end side by
        side.

    Returns
    -------
    tuple of (m, 2) arrays

    Raises
    ------
    UnsupportedGeometry
        When the lines do not close, or the faces do not hang together.

    Notes
    -----
    A stretch of a face's border belongs to the outline where no face lies beside it on its outer side.
    """
    loops = [(_with_material_left(loop, k), one) for one in seen for k, loop in enumerate(one.outline)]
    pieces: list[Array] = []
    for loop, _ in loops:
        pieces += _free_stretches(loop, seen, gap)
    made = [loop for loop in _close(pieces, gap) if abs(signed_area(loop)) > gap * gap]
    if not made:
        raise UnsupportedGeometry("faces cannot be machined as one: nothing of their border is seen along the axis")
    made = [loop[simplify_loop(loop, _PLAIN * gap)] for loop in made]
    order = sorted(made, key=lambda loop: -abs(signed_area(loop)))
    outer = slabs(tuple(order[:1]))
    if not all(inside(outer, loop).mean() > 0.5 for loop in order[1:]):
        raise UnsupportedGeometry("faces cannot be machined as one: they do not hang together")
    return tuple(order)


def _with_material_left(loop: Array, number: int) -> Array:
    """A loop whose face lies to the left: outer loops run anticlockwise, holes clockwise."""
    anticlockwise = signed_area(loop) > 0
    return loop if anticlockwise == (number == 0) else loop[::-1]


def _free_stretches(loop: Array, seen: Sequence[SeenFace], gap: float) -> list[Array]:
    """Stretches of a loop beside which no face lies on the right, in the sense of the loop, (m, 2) each."""
    ahead = np.roll(loop, -1, axis=0)
    way = ahead - loop
    length = np.linalg.norm(way, axis=1)
    some = length > 0
    loop, ahead, way, length = loop[some], ahead[some], way[some], length[some]
    right = np.column_stack([way[:, 1], -way[:, 0]]) / length[:, None] * gap

    def free(rows: NDArray[np.intp], share: Array) -> Bools:
        places = loop[rows] + share[:, None] * way[rows] + right[rows]
        return ~np.any([one.contains(places) for one in seen], axis=0)

    every = np.arange(len(loop))
    open_ = free(every, np.full(len(loop), 0.5))
    if open_.all():
        return [np.vstack([loop, loop[:1]])]
    first = np.flatnonzero(open_ & ~np.roll(open_, 1))
    found = []
    for start in first:
        count = int(np.argmin(np.roll(open_, -start)))
        rows = (start + np.arange(count)) % len(loop)
        # the border of the face beside it may end within the pieces before the first and behind the last
        before, behind = (rows[0] - 1) % len(loop), (rows[-1] + 1) % len(loop)
        leads = [*_part(loop, way, free, before, False), *loop[rows], ahead[rows[-1]],
                 *_part(loop, way, free, behind, True)]
        found.append(np.array(leads))
    return found


def _part(loop: Array, way: Array, free: _Free, row: int, at_start: bool) -> list[Array]:
    """The end of the free part of a piece of border whose middle is not free; nothing where all of it is not."""
    one = np.array([row])
    edge = 0.0 if at_start else 1.0
    if not free(one, np.array([edge + (1e-6 if at_start else -1e-6)]))[0]:
        return []
    good, bad = edge, 0.5
    for _ in range(_HALVED):
        middle = (good + bad) / 2
        if free(one, np.array([middle]))[0]:
            good = middle
        else:
            bad = middle
    return [loop[row] + good * way[row]]


def _close(pieces: list[Array], gap: float) -> list[Array]:
    """Loops from stretches that follow each other."""
    left = list(range(len(pieces)))
    starts = np.array([piece[0] for piece in pieces]).reshape(-1, 2)
    loops = []
    while left:
        chain = [left.pop(0)]
        while True:
            end = pieces[chain[-1]][-1]
            choices = [chain[0], *left]
            away = np.linalg.norm(starts[choices] - end, axis=1)
            nearest = int(np.argmin(away))
            if away[nearest] > _JOINED * gap:
                x, y = end
                raise UnsupportedGeometry(f"faces cannot be machined as one: their border does not close, by "
                                          f"{away[nearest]:.2g} mm at {x:.2f}, {y:.2f} across the axis")
            if nearest == 0:
                break
            chain.append(choices[nearest])
            left.remove(choices[nearest])
        points = np.concatenate([pieces[k] for k in chain])
        apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
        loops.append(points[apart > 1e-3 * gap])
    return [loop for loop in loops if len(loop) > 2]
