"""Projection planes and quasi-feasible sectors: closed cases, and rigid motion."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.search.projection_planes import axis_at, initial_plane, project_angles, sector, turn_plane
from toolaxis.search.sectors import golden_section


def arch(half_deg, count=11):
    """Normals of a cylinder about +x, spread evenly to either side of +z."""
    angle = np.radians(np.linspace(-half_deg, half_deg, count))
    return np.stack([0 * angle, np.sin(angle), np.cos(angle)], axis=1)


def cap(half_deg, rings=6, around=24):
    turn = np.linspace(0, 2 * pi, around, endpoint=False)
    tilt = np.radians(np.linspace(0, half_deg, rings))
    t, a = (x.ravel() for x in np.meshgrid(tilt, turn, indexing="ij"))
    return np.stack([np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)], axis=1)


def test_plane_of_a_cylinder_holds_its_rulings():
    normals = arch(20)
    plane = initial_plane(normals, np.tile([1.0, 0, 0], (11, 1)))
    np.testing.assert_allclose(plane.y, [0, 0, 1], atol=1e-12)
    assert abs(plane.x @ [1, 0, 0]) > 1 - 1e-12
    np.testing.assert_allclose(np.cross(plane.x, plane.y), plane.z, atol=1e-12)


def test_signs_of_directions_do_not_matter():
    rng = np.random.default_rng(0)
    normals = cap(20)
    lines = unit(np.cross(normals, [0.1, 1, 0.05]) + 0.2 * rng.normal(size=normals.shape))
    signs = rng.choice([-1.0, 1.0], size=(len(lines), 1))
    one, other = initial_plane(normals, lines), initial_plane(normals, lines * signs)
    assert abs(one.x @ other.x) > 1 - 1e-12


def test_plane_turns_with_the_normals():
    turn = rotation([1, 2, 3], 0.9)
    normals, lines = arch(20), unit(np.tile([1.0, 0.2, 0.1], (11, 1)))
    one, other = initial_plane(normals, lines), initial_plane(normals @ turn.T, lines @ turn.T)
    np.testing.assert_allclose(other.y, turn @ one.y, atol=1e-12)
    assert abs(other.x @ (turn @ one.x)) > 1 - 1e-9


def test_a_full_turn_comes_back_and_a_half_turn_reverses_x():
    plane = initial_plane(cap(10), np.tile([1.0, 0, 0], (144, 1)))
    for phi, sign in ((2 * pi, 1), (pi, -1)):
        np.testing.assert_allclose(turn_plane(plane, phi).x, sign * plane.x, atol=1e-12)
    quarter = turn_plane(plane, pi / 2)
    np.testing.assert_allclose(quarter.x, -plane.z, atol=1e-12)
    np.testing.assert_allclose(np.cross(quarter.x, quarter.y), quarter.z, atol=1e-12)


def test_projected_angles_tell_both_sides_of_y_apart():
    plane = initial_plane(np.array([[0, 0, 1.0]]), np.array([[1.0, 0, 0]]))
    sign = float(np.sign(plane.x[0]))
    normals = np.array([[sin(0.3) * sign, 0, cos(0.3)], [-sin(0.3) * sign, 0, cos(0.3)], [0, 0.5, 1]])
    np.testing.assert_allclose(project_angles(plane, normals), [pi / 2 - 0.3, pi / 2 + 0.3, pi / 2], atol=1e-12)


def test_axis_and_angle_are_each_other_s_inverse():
    plane = initial_plane(cap(25), np.tile([0.3, 1.0, 0], (144, 1)))
    gamma = np.linspace(0.1, 2.9, 7)
    np.testing.assert_allclose(project_angles(plane, axis_at(plane, gamma)), gamma, atol=1e-12)


def test_sector_of_a_plane_is_the_whole_quadrant():
    plane = initial_plane(np.array([[0, 0, 1.0]]), np.array([[1.0, 0, 0]]))
    np.testing.assert_allclose(sector(plane, [[0, 0, 1.0]]), [0, pi / 2], atol=1e-12)


def test_sector_of_a_sphere_cap_is_the_same_in_every_plane():
    normals = cap(20)
    first = initial_plane(normals, np.tile([1.0, 0, 0], (len(normals), 1)))
    for phi in np.radians([0, 15, 30, 180, 285]):
        low, high = sector(turn_plane(first, phi), normals)
        assert abs(low - radians(20)) < 1e-9 and abs(high - radians(70)) < 1e-9


def test_sector_of_a_cylinder_is_widest_along_its_rulings():
    normals = arch(25)
    first = initial_plane(normals, np.tile([1.0, 0, 0], (11, 1)))
    np.testing.assert_allclose(sector(first, normals), [0, pi / 2], atol=1e-9)
    np.testing.assert_allclose(sector(turn_plane(first, pi / 2), normals), np.radians([25, 65]), atol=1e-9)


def test_axes_of_the_sector_stand_in_front_of_every_normal():
    normals = cap(22)
    plane = turn_plane(initial_plane(normals, np.tile([1.0, 0, 0], (len(normals), 1))), 0.7)
    low, high = sector(plane, normals)
    for gamma in np.linspace(low + 1e-6, high - 1e-6, 9):
        axis = axis_at(plane, gamma)
        assert angle_between(normals, axis).max() < pi / 2
        assert (normals @ np.cross(axis, plane.z) <= 1e-9).all() or (normals @ np.cross(axis, plane.z) >= -1e-9).all()


def test_normals_that_fill_a_half_turn_leave_no_sector():
    normals = arch(89.9)
    plane = turn_plane(initial_plane(normals, np.tile([1.0, 0, 0], (11, 1))), pi / 2)
    low, high = sector(plane, normals)
    assert high - low < radians(0.3)


@pytest.mark.parametrize("place", [0.3, 1.0, 1.9])
def test_golden_section_finds_the_least_value(place):
    calls = []

    def valley(x):
        calls.append(x)
        return abs(x - place) ** 1.5

    assert abs(golden_section(valley, (0.0, 2.0), 1e-3) - place) < 1e-3
    assert len(calls) < 20
