"""A narrow, round face cut into strips in which its normals turn little: noses and root fillets of blades."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.vectors import angle_between
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import letters

Array = NDArray[np.float64]

_FINE = 64


def strips(face: Face, most: float) -> tuple[Face, ...]:
    """Cut a face along iso-parametric lines into the fewest strips in which normals turn by no more than an angle.

    Parameters
    ----------
    face : Face
    most : float
        By how much normals may turn across a strip, rad.

    Returns
    -------
    tuple of Face
        Labelled "7a", "7b", …, in the order of the parameter across; the face itself where one strip is enough.

    Raises
    ------
    InvalidInput
        When the angle is not above zero.

    Notes
    -----
    Across is the parameter along which the normals of the face turn more, on the mean over its lines; strips share
    this turn evenly.

    **Properties**: 1. the strips are the face, without overlap; 2. moving the face moves the strips.
    """
    if not most > 0:
        raise InvalidInput(f"greatest turn of normals is {most} rad: it must be above zero")
    u0, u1, v0, v1 = face.bounds
    lines = np.linspace(u0, u1, _FINE + 1), np.linspace(v0, v1, _FINE + 1)
    uv = grid_rows(*lines)
    normals = face.normal(uv).reshape(_FINE + 1, _FINE + 1, 3)
    on = face.contains(uv).reshape(_FINE + 1, _FINE + 1)
    turns = [_turn(np.moveaxis(normals, axis, 0), np.moveaxis(on, axis, 0)) for axis in (0, 1)]
    axis = int(turns[1][-1] > turns[0][-1])
    total = turns[axis]
    count = max(1, int(np.ceil(total[-1] / most - 1e-9)))
    if count == 1:
        return (face,)
    cuts = np.interp(np.linspace(0, total[-1], count + 1)[1:-1], total, lines[axis])
    pieces = [piece for k in range(count) for piece in outer_with_holes(_between(face.outline, axis, cuts, k))]
    return tuple(face.trimmed(piece, face.label + letters(k)) for k, piece in enumerate(pieces))


def _turn(normals: Array, on: NDArray[np.bool_]) -> Array:
    """By how much normals have turned up to each line, from the first one, on the mean over the face, (n,) rad."""
    both = on[1:] & on[:-1]
    step = np.where(both, np.asarray(angle_between(normals[1:], normals[:-1])), 0.0).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(step / np.maximum(both.sum(axis=1), 1))])


def _between(loops: tuple[Array, ...], axis: int, cuts: Array, k: int) -> tuple[Array, ...]:
    """The part of loops between two neighbouring cuts."""
    if k > 0:
        loops = clip_half_plane(loops, axis, float(cuts[k - 1]), True)
    if k < len(cuts):
        loops = clip_half_plane(loops, axis, float(cuts[k]), False)
    return loops
