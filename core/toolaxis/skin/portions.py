"""Faces that are closed in a parameter, as around a dome, taken apart into portions that are open."""

from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.clipping import clip_half_plane
from toolaxis.numeric.polygon_boolean import cut_spikes
from toolaxis.numeric.polygons import polygon_area, signed_area, stations, walk
from toolaxis.skin.covered_parts import Loops
from toolaxis.skin.seen_face import SeenFace

Array = NDArray[np.float64]

#: Portions of the range of a parameter in which a face is closed: of two, each is open and as far as can be from the
#: next turn of itself.
_PORTIONS = 2
#: Pieces of the longest side of a loop that is carried over to a face's own parameters.
_DIVIDED = 128
#: By how much the area of a loop may change as it is carried over, as a share of it, and of its portion.
_CHANGE, _CHANGE_OF_ALL = 2e-3, 1e-6
#: Where going once around moves a point by less than this share of the face's diagonal, it lies at a pole.
_POLE = 1e-6


class Portion(NamedTuple):
    """A portion of a face.

    seen : SeenFace;  ends : (2, 2) array, least and greatest u, and v;  outline : loops in the plane
    of_closed : bool, whether it is less than the face
    """

    seen: SeenFace
    ends: Array
    outline: Loops
    of_closed: bool


def open_portions(seen: SeenFace) -> list[Portion]:
    """The portions of a face, side by side in the plane; the whole of one that is open.

    Parameters
    ----------
    seen : SeenFace

    **Properties**: 1. areas add up.
    """
    u0, u1, v0, v1 = seen.face.bounds
    ranges = [_halves(low, high, bool(np.isfinite(period)))
              for (low, high), period in zip(((u0, u1), (v0, v1)), seen.periods, strict=True)]
    if all(len(one) == 1 for one in ranges):
        return [Portion(seen, np.array([[u0, u1], [v0, v1]]), seen.outline, False)]
    found = []
    for ends in product(*ranges):
        loops = seen.outline_uv
        for axis, (low, high) in enumerate(ends):
            loops = clip_half_plane(clip_half_plane(loops, axis, low, True), axis, high, False)
        fine = [walk(loop, stations(loop, (np.diff(ends[0])[0] / _DIVIDED, np.diff(ends[1])[0] / _DIVIDED)))
                for loop in loops]
        outline = [cut_spikes(seen.project(seen.face.evaluate(loop).point)) for loop in fine]
        found.append(Portion(seen, np.array(ends), tuple(loop for loop in outline if len(loop) > 2), True))
    return [one for one in found if one.outline]


def _halves(low: float, high: float, closed: bool) -> list[tuple[float, float]]:
    lines = np.linspace(low, high, (_PORTIONS if closed else 1) + 1)
    return [(float(a), float(b)) for a, b in pairwise(lines)]


def carry_into_parameters(portion: Portion, loop: Array) -> Array | None:
    """A loop of the plane within a portion in the face's own parameters; None where it holds no area there, or
    where its area changes: the whole face is judged then, so that no part of it goes unjudged.

    Parameters
    ----------
    portion : Portion
    loop : (m, 2) array
    """
    size = np.ptp(loop, axis=0) / _DIVIDED
    fine = walk(loop, stations(loop, (float(size[0]), float(size[1]))))
    uv, periods = portion.seen.find(fine), portion.seen.periods
    middle = portion.ends.mean(axis=1)
    closed = np.isfinite(periods)
    turns = np.round((middle - uv)[:, closed] / periods[closed])
    uv[:, closed] += turns * periods[closed]
    uv = np.clip(uv, portion.ends[:, 0], portion.ends[:, 1])
    uv = _spread_poles(portion, uv)
    if len(uv) < 3 or signed_area(uv) == 0:
        return None
    seen = portion.seen
    area = abs(signed_area(loop))
    change = abs(abs(signed_area(seen.project(seen.face.evaluate(uv).point))) - area)
    return None if change > _CHANGE * area + _CHANGE_OF_ALL * polygon_area(portion.outline) else uv


def _spread_poles(portion: Portion, uv: Array) -> Array:
    """A loop in which each pole, where every value of a parameter is the same point, stands twice: with the value of
    the corner before, and of the corner behind."""
    d = portion.seen.face.evaluate(uv)
    span, least = np.diff(portion.ends, axis=1)[:, 0], _POLE * portion.seen.face.diagonal
    for axis, along in enumerate((d.su, d.sv)):
        pole = np.linalg.norm(along, axis=1) * span[axis] <= least
        if pole.any() and not pole.all():
            return _doubled(uv, pole, axis)
    return uv


def _doubled(uv: Array, pole: NDArray[np.bool_], axis: int) -> Array:
    """A loop with two corners for each one at a pole, which differ in the parameter that has no meaning there."""
    other = np.flatnonzero(~pole)
    rows = []
    for k, point in enumerate(uv):
        if not pole[k]:
            rows.append(point)
            continue
        at = int(np.searchsorted(other, k))
        for beside in (other[at - 1], other[at % len(other)]):
            twin = point.copy()
            twin[axis] = uv[beside, axis]
            rows.append(twin)
    return np.array(rows)
