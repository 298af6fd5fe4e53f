"""How far rays go until another place of the part is nearer: closed forms, and the exact search."""

import numpy as np
import pytest

from toolaxis.shape.analytic import CylindricalSurface, PlanarSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.thin_walls import depth_to_other_places

Array = np.ndarray


def plane(height: float, across: float = 0.0) -> Face:
    """A square of 10 x 10 mm, which may rise across."""
    x, y = np.meshgrid(np.linspace(0, 10, 4), np.linspace(0, 10, 4), indexing="ij")
    return Face.from_bspline(np.stack([x, y, height + across * x], axis=-1))


def rays(count: int = 200) -> tuple[Array, Array]:
    """Feet on the top of a wall, away from its border, and normals."""
    feet = np.column_stack([np.random.default_rng(3).uniform(3, 7, (count, 2)), np.zeros(count)])
    return feet, np.tile([0.0, 0.0, 1.0], (count, 1))


@pytest.mark.parametrize("thick", [0.02, 0.3, 2.5])
def test_a_wall_is_followed_to_its_middle(thick: float) -> None:
    feet, normal = rays()
    faces = plane(0.0), plane(-thick)
    found = depth_to_other_places(feet, normal, faces, np.full(len(feet), 20.0 * thick))
    assert (found >= thick / 2 * (1 - 1e-9)).all() and (found <= thick / 2 * 1.03).all()


def test_a_wedge_is_followed_to_where_both_sides_are_as_near() -> None:
    """Below the foot of a ray by t the other side, which falls by s for each mm, is t (1 - cos) farther away."""
    fall = 0.2
    feet, normal = rays()
    found = depth_to_other_places(feet, normal, (plane(0.0), plane(0.0, -fall)), np.full(len(feet), 9.0))
    cosine = 1 / np.hypot(1, fall)
    middle = fall * feet[:, 0] * cosine / (1 + cosine)
    assert (found >= middle * (1 - 1e-9)).all() and (found <= middle * 1.03).all()


def test_a_rod_is_followed_to_its_axis() -> None:
    angle, along = np.random.default_rng(5).uniform((0.5, 3.0), (5.5, 7.0), (200, 2)).T
    normal = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(200)])
    rod = Face(CylindricalSurface(1.5, v_range=(0.0, 10.0)).nurbs())
    feet = 1.5 * normal + np.column_stack([np.zeros((200, 2)), along])
    found = depth_to_other_places(feet, normal, (rod,), np.full(200, 2.9))
    assert (found >= 1.5 * (1 - 1e-9)).all() and (found <= 1.5 * 1.03).all()


def test_no_place_is_much_nearer_at_the_depth_that_is_told() -> None:
    """A bent sheet over a plane: its foot is the nearest there, but for three in a hundred."""
    x, y = np.meshgrid(np.linspace(0, 10, 8), np.linspace(0, 10, 8), indexing="ij")
    sheet = Face.from_bspline(np.stack([x, y, 0.4 * np.sin(x) * np.cos(y)], axis=-1))
    uv = np.random.default_rng(6).uniform(0.2, 0.8, (300, 2))
    feet, normal = sheet.evaluate(uv).point, sheet.normal(uv)
    faces = sheet, plane(-1.0)
    found = depth_to_other_places(feet, normal, faces, np.full(300, 5.0))
    end = feet - found[:, None] * normal
    least = np.min([nearest(face, end).distance for face in faces], axis=0)
    assert (least >= 0.97 * found - 2e-6).all()
    farther = feet - 1.05 * found[:, None] * normal
    beyond = np.min([nearest(face, farther).distance for face in faces], axis=0)
    assert (beyond < 1.05 * found * 0.9999).all()


def test_far_faces_are_left_alone() -> None:
    feet, normal = rays()
    far = Face(PlanarSurface((0.0, 10.0), (0.0, 6.0)).nurbs())
    assert (depth_to_other_places(feet - [0, 0, 50.0], normal, (far,), np.full(len(feet), 2.0)) == 2.0).all()
