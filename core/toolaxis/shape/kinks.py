"""Kinks: knot lines along which a surface is only C0, and the pieces between them."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.knots import distinct_inner, restricted
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
                           if low < t < high and _jump(face, axis, float(t)) > jump))
    return found[0], found[1]


def _jump(face: Face, axis: int, t: float) -> float:
    """Greatest angle between the normals on both sides of a knot line, rad."""
    low, high = face.bounds[2 - 2 * axis:4 - 2 * axis]
    across = low + (high - low) * (np.arange(SAMPLES) + 0.5) / SAMPLES
    sides = []
    for value in (np.nextafter(t, -np.inf), t):
        uv = np.stack([np.full(SAMPLES, value), across] if axis == 0 else [across, np.full(SAMPLES, value)], axis=1)
        sides.append(face.normal(uv))
    sound = (np.linalg.norm(sides[0], axis=1) > 0.5) & (np.linalg.norm(sides[1], axis=1) > 0.5)
    return float(angle_between(sides[0], sides[1])[sound].max(initial=0.0))


def with_kinks(face: Face) -> Face:
    """The face with its kinks noted.

    Parameters
    ----------
    face : Face
    """
    kinks = kinks_of(face)
    return replace(face, kinks=kinks) if kinks != ((), ()) else face
