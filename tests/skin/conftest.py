"""Faces that continue each other, but for their parameters."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.numeric.knots import restrict_spline
from toolaxis.shape.nurbs import NurbsSurface


def wave() -> ta.Face:
    """A wavy patch of 60 x 40 mm."""
    x, y = np.meshgrid(np.linspace(0, 60, 7), np.linspace(0, 40, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y + 0.1 * x, 4 * np.sin(x / 14) * np.cos(y / 12)], axis=-1))


def part_of(face: ta.Face, us: tuple[float, float], vs: tuple[float, float]) -> ta.Face:
    """The face between lines of its parameters, with a surface of its own."""
    surface = face.surface
    ku, net = restrict_spline(surface.knots_u, surface.control, 3, *us)
    kv, own = restrict_spline(surface.knots_v, net.swapaxes(0, 1), 3, *vs)
    return replace(face, surface=NurbsSurface(ku, kv, own.swapaxes(0, 1), (3, 3)))


@pytest.fixture(scope="session")
def whole() -> ta.Face:
    """The patch before it is cut."""
    return wave()


@pytest.fixture(scope="session")
def quilt(whole: ta.Face) -> ta.Part:
    """The patch cut into three, two of which meet the long side of the third: no rows and columns."""
    left = [part_of(whole, (0.0, 0.45), (0.0, 0.4)), part_of(whole, (0.0, 0.45), (0.4, 1.0))]
    right = part_of(whole, (0.45, 1.0), (0.0, 1.0))
    return ta.Part.from_faces([left[0], replace(right, surface=right.surface.swapped(), flip=True), left[1]])
