"""Sub-surfaces changed by hand: put together, cut apart along a line, and cut out along a closed one."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.polygon_boolean import divide_polygon, unite_polygons
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Loops = tuple[Array, ...]

#: Share of its size by which a drawn line is moved where one of its corners lies on a border.
_NUDGE = 1e-6
_TRIES = 4


def merge_sub_surfaces(pieces: Sequence[Face]) -> Loops:
    """The border of several sub-surfaces of one face as one.

    Parameters
    ----------
    pieces : sequence of Face
        Two or more of one face.

    Returns
    -------
    tuple of (m, 2) arrays

    Raises
    ------
    InvalidInput
        When they are of different faces, or do not touch along a line.

    **Properties**: 1. areas add up.
    """
    if len(pieces) < 2 or len({piece.number for piece in pieces}) > 1:
        raise InvalidInput("sub-surfaces that are put together have to be two or more of one face: choose them so")
    left, loops = list(pieces[1:]), pieces[0].outline
    while left:
        found = [(k, unite_polygons(loops, piece.outline)) for k, piece in enumerate(left)]
        near = next(((k, both) for k, both in found if len(outer_with_holes(both)) == 1), None)
        if near is None:
            names = ", ".join(piece.label for piece in left)
            raise InvalidInput(f"sub-surface {pieces[0].label} does not touch {names} along a line: choose neighbours")
        loops = near[1]
        del left[near[0]]
    return loops


def halves(piece: Face, parameter: str = "", at: float | None = None) -> tuple[Loops, ...]:
    """A sub-surface cut along an iso-parametric line.

    Parameters
    ----------
    piece : Face
    parameter : "u", "v" or ""
        The one that is constant on the line; the one along which the sub-surface is longer unless given.
    at : float, optional
        Its value; the middle unless given.

    Returns
    -------
    tuple of loops, two or more

    Raises
    ------
    InvalidInput
        When the line does not cross the sub-surface.
    """
    u0, u1, v0, v1 = piece.bounds
    d = piece.evaluate(piece.grid(8, 8))
    along = [(u1 - u0) * np.linalg.norm(d.su, axis=1).mean(), (v1 - v0) * np.linalg.norm(d.sv, axis=1).mean()]
    if parameter not in ("", "u", "v"):
        raise InvalidInput(f"parameter is {parameter!r}: use u, v or nothing for the longer one")
    axis = int(along[1] > along[0]) if not parameter else "uv".index(parameter)
    low, high = ((u0, u1), (v0, v1))[axis]
    value = (low + high) / 2 if at is None else float(at)
    if not low < value < high:
        raise InvalidInput(f"{'uv'[axis]} = {value:g} does not cross sub-surface {piece.label}: it lies between "
                           f"{low:g} and {high:g}")
    return tuple(group for above in (False, True) for group in outer_with_holes(clip_half_plane(piece.outline, axis,
                                                                                                value, above)))


def cut_along(piece: Face, line: ArrayLike) -> tuple[Loops, ...]:
    """A sub-surface cut along a drawn line, which goes on straight beyond its ends.

    Parameters
    ----------
    piece : Face
    line : (k, 2) array_like
        Corners in (u, v), two or more.

    Returns
    -------
    tuple of loops, two or more

    Raises
    ------
    InvalidInput
        When the line does not cross the sub-surface.
    """
    rows = _check_line(line, 2)
    low, high = (np.array(piece.bounds)[k::2] for k in (0, 1))
    size = high - low
    unit = (rows - low) / size
    first, last = unit[0] - unit[1], unit[-1] - unit[-2]
    ends = [end + 4 * way / np.linalg.norm(way) for end, way in ((unit[0], first), (unit[-1], last))]
    chord = ends[1] - ends[0]
    side = 8 * np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
    ring = low + size * np.array([ends[0], *unit, ends[1], ends[1] + side, ends[0] + side])
    both = _divide_by_ring(piece.outline, ring, size)
    if not all(both):
        raise InvalidInput(f"the line does not cross sub-surface {piece.label}: draw it from border to border")
    return tuple(group for loops in both for group in outer_with_holes(loops))


def cut_out(pieces: Sequence[Face], ring: ArrayLike) -> tuple[Loops, list[tuple[Loops, ...]]]:
    """A new sub-surface inside a closed line, and what stays of the others.

    Parameters
    ----------
    pieces : sequence of Face
        All sub-surfaces of a face.
    ring : (k, 2) array_like
        Corners in (u, v), three or more, without the first one again.

    Returns
    -------
    loops of the new one; for each of the others the pieces that stay, none where it lies in the line as a whole

    Raises
    ------
    InvalidInput
        When nothing of the face lies in the line, or what lies in it does not hang together.
    """
    rows = _check_line(ring, 3)
    size = np.ptp(np.concatenate([loop for piece in pieces for loop in piece.outline]), axis=0)
    within: Loops = ()
    stay: list[tuple[Loops, ...]] = []
    for piece in pieces:
        own, rest = _divide_by_ring(piece.outline, rows, size)
        within = own if not within else unite_polygons(within, own) if own else within
        stay.append(tuple(outer_with_holes(rest)))
    if not within or len(outer_with_holes(within)) != 1:
        what = "nothing of the face lies" if not within else "several pieces that do not hang together lie"
        raise InvalidInput(f"{what} in the closed line: draw another one on the face")
    return within, stay


def _check_line(line: ArrayLike, least: int) -> Array:
    rows = np.asarray(line, dtype=float)
    if rows.ndim != 2 or rows.shape[1:] != (2,) or not np.isfinite(rows).all():
        raise InvalidInput("the line has no corners in (u, v): draw it on the face")
    rows = rows[np.concatenate([[True], (np.diff(rows, axis=0) != 0).any(axis=1)])]
    if len(rows) < least:
        raise InvalidInput(f"the line has {len(rows)} different corners: it needs {least} at least")
    return rows


def _divide_by_ring(loops: Loops, ring: Array, size: Array) -> tuple[Loops, Loops]:
    """Inside and outside of a ring; it is moved a little where rounding would decide."""
    for k in range(_TRIES):
        try:
            return divide_polygon(loops, (ring + _NUDGE * k * size * np.array([1.0, 0.7]),))
        except InvalidInput:
            if k + 1 == _TRIES:
                raise
    raise AssertionError
