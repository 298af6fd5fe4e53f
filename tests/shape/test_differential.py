"""Curvatures: an independent eigenvalue solver, Euler's formula, and the changes they must follow."""

import numpy as np
import pytest

from toolaxis.numeric.vectors import dot, rotation
from toolaxis.shape.analytic import SphericalSurface, ToroidalSurface
from toolaxis.shape.differential import (
    curvature_form,
    curvatures,
    degenerate,
    first_form,
    normals,
    second_form,
)
from toolaxis.shape.face import Face


def freeform(seed: int = 0) -> Face:
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 80, 7), np.linspace(0, 60, 6), indexing="ij")
    points = np.stack([x, y, 6 * rng.normal(size=x.shape)], -1) + rng.normal(0, 2, (*x.shape, 3))
    return Face.from_bspline(points, weights=rng.uniform(0.7, 1.4, x.shape))


UV = np.random.default_rng(1).uniform(0.02, 0.98, (200, 2))


def test_shape_operator_by_another_solver() -> None:
    face = freeform()
    d, n = face.evaluate(UV), face.normal(UV)
    found = face.curvature(UV)
    wanted = np.sort(np.linalg.eigvals(np.linalg.solve(first_form(d), second_form(d, n))).real, axis=1)
    assert found.k2 == pytest.approx(wanted[:, 0], abs=1e-12)
    assert found.k1 == pytest.approx(wanted[:, 1], abs=1e-12)


def test_directions_are_principal_and_right_handed() -> None:
    face = freeform()
    n, found = face.normal(UV), face.curvature(UV)
    assert np.cross(found.d1, found.d2) == pytest.approx(n, abs=1e-12)
    form = curvature_form(face.evaluate(UV), n, found.d1)
    assert form[:, 0, 0] == pytest.approx(found.k1, abs=1e-12)
    assert form[:, 1, 1] == pytest.approx(found.k2, abs=1e-12)
    assert np.abs(form[:, 0, 1]).max() < 1e-12


def test_normal_curvature_of_a_curve_on_the_surface() -> None:
    """k = (second difference along the iso-curve . n) / |Su|^2, positive where the surface bends towards n."""
    face, h = freeform(), 1e-4
    d, n, found = face.evaluate(UV), face.normal(UV), face.curvature(UV)
    step = np.array([h, 0.0])
    bend = (face.evaluate(UV + step).point - 2 * d.point + face.evaluate(UV - step).point) / h**2
    along = d.su / np.linalg.norm(d.su, axis=1)[:, None]
    euler = found.k1 * dot(along, found.d1) ** 2 + found.k2 * dot(along, found.d2) ** 2
    assert dot(bend, n) / dot(d.su, d.su) == pytest.approx(euler, abs=2e-4)


def test_follows_motion_mirror_scale_swap_and_flip() -> None:
    face = freeform()
    base, n = face.curvature(UV), face.normal(UV)
    turn = np.eye(4)
    turn[:3, :3], turn[:3, 3] = rotation([1, 2, 3], 0.9), [10, -70, 400]
    moved = face.transformed(turn)
    assert moved.normal(UV) == pytest.approx(n @ turn[:3, :3].T, abs=1e-12)
    assert moved.curvature(UV).k1 == pytest.approx(base.k1, abs=1e-11)
    mirrored = face.transformed(np.diag([-1.0, 1, 1, 1]))
    assert mirrored.flip and mirrored.normal(UV) == pytest.approx(n * [-1, 1, 1], abs=1e-12)
    assert mirrored.curvature(UV).k2 == pytest.approx(base.k2, abs=1e-12)
    scaled = face.transformed(np.diag([2.5, 2.5, 2.5, 1]))
    assert 2.5 * scaled.curvature(UV).k1 == pytest.approx(base.k1, abs=1e-12)
    swapped = Face(face.surface.swapped(), flip=True)
    assert swapped.normal(UV[:, ::-1]) == pytest.approx(n, abs=1e-12)
    assert swapped.curvature(UV[:, ::-1]).k2 == pytest.approx(base.k2, abs=1e-12)
    flipped = Face(face.surface, flip=True).curvature(UV)
    assert flipped.k1 == pytest.approx(-base.k2, abs=1e-12) and flipped.k2 == pytest.approx(-base.k1, abs=1e-12)


def test_concave_is_positive() -> None:
    uv = np.array([[0.4, 0.3]])
    outside, inside = Face(SphericalSurface(5.0).nurbs()), Face(SphericalSurface(5.0).nurbs(), flip=True)
    assert outside.curvature(uv).k1[0] == pytest.approx(-0.2) and inside.curvature(uv).k1[0] == pytest.approx(0.2)
    inner = Face(ToroidalSurface(20.0, 6.0).nurbs()).curvature([[0.0, np.pi]])
    assert (inner.k1[0], inner.k2[0]) == pytest.approx((1 / 14, -1 / 6))


def test_derivatives_alone_at_a_pole_leave_the_crossing_curvature_out() -> None:
    d = SphericalSurface(10.0).nurbs().evaluate(np.array([[0.3, np.pi / 2], [0.3, 0.2]]))
    assert degenerate(d).tolist() == [True, False]
    n = normals(d, inward=(0.0, -1.0))
    assert n[0] == pytest.approx([0, 0, 1], abs=1e-12)
    assert normals(d, inward=(0.0, 1.0))[0] == pytest.approx([0, 0, -1], abs=1e-12)
    found = curvatures(d, n)
    assert (found.k1[0], found.k2[0]) == pytest.approx((0.0, -0.1), abs=1e-9)
    assert (found.k1[1], found.k2[1]) == pytest.approx((-0.1, -0.1), abs=1e-9)


def test_nan_in_nan_out() -> None:
    face = freeform()
    uv = np.array([[np.nan, 0.5], [0.5, 0.5]])
    found = face.curvature(uv)
    assert np.isnan(face.normal(uv)[0]).all() and np.isnan(found.k1[0]) and np.isfinite(found.k1[1])
