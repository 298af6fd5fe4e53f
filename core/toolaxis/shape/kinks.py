"""Kinks: knot lines along which a surface is only C0, and the pieces between them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.knots import distinct_inner, restrict_spline
from toolaxis.numeric.vectors import angle_between
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]

JUMP = 1e-4
SAMPLES = 33


def kinks_of(face: Face, jump: float = JUMP) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Parameters u and v at which the normal of a face jumps.

    Only knots that repeat as often as the degree can be kinks.  A jump of 1e-4 rad under a cutter of 10 mm
    radius hides a step of 13 nm at most; the noise of CAD systems stays below 1e-7.

    Parameters
    ----------
    face : Face
    jump : float
        Least angle between the normals on both sides, rad.
    """
    return _kinks_along(face, 0, jump), _kinks_along(face, 1, jump)


def _kinks_along(face: Face, axis: int, jump: float) -> tuple[float, ...]:
    """Parameters of one axis, 0 for u and 1 for v, at which the normal jumps."""
    surface = face.surface
    knots = (surface.knots_u, surface.knots_v)[axis]
    degree = surface.degree[axis]
    values, counts = distinct_inner(knots, degree)
    low, high = face.bounds[2 * axis:2 * axis + 2]
    inside = [float(t) for t in values[counts >= degree] if low < t < high]
    return tuple(t for t in inside if turn_at(face, axis, t) > jump)


def turn_at(face: Face, axis: int, t: float) -> float:
    """Greatest angle between the normals on both sides of a knot line, rad.

    Parameters
    ----------
    face : Face
    axis : int
        0 for a line of constant u, 1 for one of constant v.
    t : float
        The knot.
    """
    before, on = (face.normal(uv) for uv in beside(face, axis, t))
    # Where a surface is degenerate its normal is zero.
    has_normals = (np.linalg.norm(before, axis=1) > 0.5) & (np.linalg.norm(on, axis=1) > 0.5)
    turns = angle_between(before, on)
    return float(turns[has_normals].max(initial=0.0))


def beside(face: Face, axis: int, t: float) -> tuple[Array, Array]:
    """Parameters of places just before a knot line and on it, (n, 2) each.

    Parameters
    ----------
    face : Face
    axis : int
        0 for a line of constant u, 1 for one of constant v.
    t : float
        The knot.
    """
    u0, u1, v0, v1 = face.bounds
    low, high = (v0, v1) if axis == 0 else (u0, u1)
    along = low + (high - low) * (np.arange(SAMPLES) + 0.5) / SAMPLES
    just_before = float(np.nextafter(t, -np.inf))
    return _knot_line(axis, just_before, along), _knot_line(axis, t, along)


def _knot_line(axis: int, value: float, along: Array) -> Array:
    """Parameters of places on a line where one parameter has a value, (n, 2)."""
    constant = np.full(len(along), value)
    u, v = (constant, along) if axis == 0 else (along, constant)
    return np.stack([u, v], axis=1)


def with_kinks(face: Face) -> Face:
    """The face with its kinks noted.

    Parameters
    ----------
    face : Face
    """
    kinks = kinks_of(face)
    return replace(face, kinks=kinks) if kinks != ((), ()) else face


def split_at_kinks(face: Face) -> tuple[Face, ...]:
    """The smooth pieces of a face between its kinks, each on its own piece of the surface.

    Parameters
    ----------
    face : Face

    Returns
    -------
    tuple of Face
        The face itself where it has no kinks; else pieces labelled "7a", "7b", … with the number of the face.

    **Properties**: 1. areas add up; 2. no piece has kinks.
    """
    if face.kinks == ((), ()):
        return (face,)
    (u0, u1), (v0, v1) = face.surface.domain
    kinks_u, kinks_v = face.kinks
    pieces: list[Face] = []
    for strip_u in pairwise((u0, *kinks_u, u1)):
        column = _within(face.outline, 0, strip_u)
        for strip_v in pairwise((v0, *kinks_v, v1)):
            loops = _within(column, 1, strip_v)
            pieces += [_piece(face, strip_u, strip_v, own) for own in outer_with_holes(loops)]
    return tuple(replace(piece, label=face.label + letters(k)) for k, piece in enumerate(pieces))


def _within(loops: tuple[Array, ...], axis: int, strip: tuple[float, float]) -> tuple[Array, ...]:
    """Loops clipped to a strip of one parameter."""
    low, high = strip
    above = clip_half_plane(loops, axis, low, True)
    return clip_half_plane(above, axis, high, False)


def _piece(face: Face, strip_u: tuple[float, float], strip_v: tuple[float, float], loops: tuple[Array, ...]) -> Face:
    surface = face.surface
    knots_u, net = restrict_spline(surface.knots_u, surface.control, surface.degree[0], *strip_u)
    knots_v, net = restrict_spline(surface.knots_v, net.swapaxes(0, 1), surface.degree[1], *strip_v)
    own = NurbsSurface(knots_u, knots_v, net.swapaxes(0, 1), surface.degree)
    trims = () if _is_rectangle(loops, strip_u, strip_v) else loops
    return replace(face, surface=own, trims=trims, kinks=((), ()))


def _is_rectangle(loops: tuple[Array, ...], strip_u: tuple[float, float], strip_v: tuple[float, float]) -> bool:
    """Whether the only loop runs around the whole of a rectangle."""
    if len(loops) != 1 or len(loops[0]) != 4:
        return False
    u, v = loops[0].T
    return bool(np.isin(u, strip_u).all() and np.isin(v, strip_v).all())


def letters(index: int) -> str:
    """a, b, …, z, aa, ab, … for 0, 1, …

    Parameters
    ----------
    index : int
    """
    text = ""
    while index >= 0:
        text = chr(ord("a") + index % 26) + text
        index = index // 26 - 1
    return text
