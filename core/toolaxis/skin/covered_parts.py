"""Which parts of faces that are seen together lie under another one of them."""

from collections.abc import Sequence
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.polygon_boolean import divide_nearly
from toolaxis.numeric.polygons import inside, polygon_area, slabs
from toolaxis.skin.seen_face import SeenFace

Array = NDArray[np.float64]
Loops = tuple[Array, ...]

#: Faces one of which lies so far above the other are not just borders that miss each other, mm.
_ABOVE = 0.05
#: Area in the plane below which what two faces have in common is a crumb of their borders, mm^2.
_CRUMB = 1e-3
#: Places along each side of the box of a part at which it is looked which face lies above.
_LOOKED = 24


def covered_parts(seen: Sequence[SeenFace]) -> tuple[tuple[Loops, ...], ...]:
    """For each of some faces the parts of it, loops in the plane, above which another one lies.

    Parameters
    ----------
    seen : sequence of SeenFace
        In one plane.

    Notes
    -----
    Neighbours are drawn as polygons that overlap by slivers; there both lie at one height, and none covers the other.

    **Properties**: 1. the order of the faces does not matter.
    """
    found: list[list[Loops]] = [[] for _ in seen]
    for k, one in enumerate(seen):
        for m, other in enumerate(seen[:k]):
            if _overlap(one, other):
                found[k] += _parts_under(one, other)
                found[m] += _parts_under(other, one)
    return tuple(map(tuple, found))


def _parts_under(one: SeenFace, other: SeenFace) -> list[Loops]:
    """The parts of a face, cut out of its outline, above which another one lies."""
    return [part for part in _common_parts(one, other) if _height_above(part, other, one) > _ABOVE]


def places_in(part: Loops, count: int = _LOOKED) -> Array:
    """Places within a polygon, (n, 2), on a grid over its box.

    Parameters
    ----------
    part : tuple of (m, 2) arrays
        Loops, the outer one first.
    count : int
        Along each side of the box.
    """
    low, high = part[0].min(axis=0), part[0].max(axis=0)
    share = (np.arange(count) + 0.5) / count
    places = low + (high - low) * np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
    return np.asarray(places[inside(slabs(part), places)])


def _overlap(one: SeenFace, other: SeenFace) -> bool:
    """Whether the border of one of two faces runs above or below the other."""
    if (one.box[0] > other.box[1]).any() or (other.box[0] > one.box[1]).any():
        return False
    return _runs_apart(one, other) or _runs_apart(other, one)


def _runs_apart(one: SeenFace, other: SeenFace) -> bool:
    """Whether places of a face's border lie within another one's, and well above or below it."""
    places = np.concatenate(one.outline)
    within = other.contains(places)
    if not within.any():
        return False
    height = one.heights_of(np.concatenate([one.face.evaluate(loop).point for loop in one.outline_uv])[within])
    return bool((np.abs(height - other.heights_at(places[within])) > _ABOVE).any())


def _common_parts(one: SeenFace, other: SeenFace) -> list[Loops]:
    """What the outlines of two faces have in common; nothing where no one can tell."""
    with suppress(InvalidInput):
        both, _ = divide_nearly(one.outline, other.outline)
        return [part for part in outer_with_holes(both) if polygon_area(part) >= _CRUMB]
    return []


def _height_above(part: Loops, one: SeenFace, other: SeenFace) -> float:
    """By how much a face lies above another one over a part of the plane, mm, on the median."""
    places = places_in(part)
    if not len(places):  # a sliver
        return 0.0
    return float(np.median(one.heights_at(places) - other.heights_at(places)))
