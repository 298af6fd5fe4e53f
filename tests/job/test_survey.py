"""The survey against closed forms: radii, cones of normals, areas."""

from math import pi, sqrt

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.output.inspect import survey

ARC = sqrt(0.5)


def quarter(radius: float, length: float, flip: bool) -> ta.Face:
    """A quarter of a cylinder, exact."""
    arc = np.array([[radius, 0, 0], [radius, radius, 0], [0, radius, 0.0]])
    points = np.stack([arc, arc + np.array([0, 0, length])], axis=1)
    weights = np.array([[1, 1], [ARC, ARC], [1, 1]])
    return ta.Face.from_bspline(points, (2, 1), weights=weights, flip=flip)


def test_a_quarter_cylinder_from_outside_and_inside() -> None:
    part = ta.Part.from_faces([quarter(10, 30, False), quarter(10, 30, True)])
    for found in survey(part):
        assert found.area == pytest.approx(0.5 * pi * 10 * 30, rel=1e-4)
        assert found.spread == pytest.approx(pi / 4, abs=1e-6)
        assert found.size == pytest.approx((10, 10, 30), rel=1e-6)
        assert found.sculptured and found.holes == 0 and found.pieces == 1
    out, inside = survey(part)
    convex, concave = (out, inside) if out.convex_radius is not None else (inside, out)
    assert convex.convex_radius == pytest.approx(10.0, rel=1e-9) and convex.concave_radius is None
    assert concave.concave_radius == pytest.approx(10.0, rel=1e-9) and concave.convex_radius is None


def test_a_plane_with_a_hole() -> None:
    square = np.array([[[0.0, 0, 0], [0, 20, 0]], [[30, 0, 0], [30, 20, 0]]])
    turn = np.linspace(0, 2 * pi, 60, endpoint=False)
    outer = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    hole = 0.5 + np.stack([np.cos(turn) * 5 / 30, np.sin(turn) * 5 / 20], axis=1)
    (found,) = survey(ta.Part.from_faces([ta.Face.from_bspline(square, (1, 1), trims=(outer, hole))]))
    assert found.holes == 1 and found.convex_radius is None and found.concave_radius is None
    assert found.spread == pytest.approx(0.0, abs=1e-9)
    assert found.area == pytest.approx(600 - 30 * 25 * np.sin(2 * pi / 60), rel=2e-3)
