"""Kinks: knot lines along which a surface is only C0, and the pieces between them."""

from dataclasses import replace

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
    found = []
    surface = face.surface
    for axis, knots in enumerate((surface.knots_u, surface.knots_v)):
        values, counts = distinct_inner(knots, surface.degree[axis])
        low, high = face.bounds[2 * axis:2 * axis + 2]
        found.append(tuple(float(t) for t in values[counts >= surface.degree[axis]]
                           if low < t < high and turn_at(face, axis, float(t)) > jump))
    return found[0], found[1]


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
    sides = [face.normal(uv) for uv in beside(face, axis, t)]
    sound = (np.linalg.norm(sides[0], axis=1) > 0.5) & (np.linalg.norm(sides[1], axis=1) > 0.5)
    return float(angle_between(sides[0], sides[1])[sound].max(initial=0.0))


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
    low, high = face.bounds[2 - 2 * axis:4 - 2 * axis]
    along = low + (high - low) * (np.arange(SAMPLES) + 0.5) / SAMPLES
    before, on = (np.stack([np.full(SAMPLES, value), along][::1 - 2 * axis], axis=1)
                  for value in (np.nextafter(t, -np.inf), t))
    return before, on


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
    pieces: list[Face] = []
    for strip_u in zip((u0, *face.kinks[0]), (*face.kinks[0], u1), strict=True):
        column = _within(face.outline, 0, strip_u)
        for strip_v in zip((v0, *face.kinks[1]), (*face.kinks[1], v1), strict=True):
            loops = _within(column, 1, strip_v)
            pieces += [_piece(face, strip_u, strip_v, own) for own in outer_with_holes(loops)]
    return tuple(replace(piece, label=face.label + letters(k)) for k, piece in enumerate(pieces))


def _within(loops: tuple[Array, ...], axis: int, strip: tuple[float, float]) -> tuple[Array, ...]:
    return clip_half_plane(clip_half_plane(loops, axis, strip[0], True), axis, strip[1], False)


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
