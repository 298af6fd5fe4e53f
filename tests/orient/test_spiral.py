"""Even sets of axes."""

from math import pi, radians

import numpy as np
import pytest

from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.search.direction_grid import COVER, own_frame, ring, spiral


@pytest.mark.parametrize("degrees", [15, 7.5, 4])
def test_no_axis_of_the_hemisphere_is_far_from_the_spiral(degrees):
    axes = spiral(np.eye(3), radians(degrees))
    probes = unit(np.random.default_rng(0).normal(size=(20000, 3)))
    probes = probes[probes[:, 2] > 0]
    nearest = np.arccos(np.clip((probes @ axes.T).max(axis=1), -1, 1))
    assert nearest.max() < COVER * radians(degrees)
    assert abs(len(axes) * radians(degrees) ** 2 / (2 * pi) - 1) < 0.05


def test_a_cap_is_filled_and_not_exceeded():
    frame = rotation([1, 2, 3], 0.6)
    axes = spiral(frame, radians(3), radians(40))
    away = angle_between(axes, frame[2])
    assert away.max() < radians(40) and away.max() > radians(37)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1, atol=1e-12)


def test_rings_keep_their_angle_and_are_even():
    axis = unit([0.3, -0.4, 0.9])
    around = ring(axis, 0.1, 0.5, 8)
    np.testing.assert_allclose(angle_between(around, axis), 0.1, atol=1e-12)
    gaps = angle_between(around, np.roll(around, 1, axis=0))
    assert np.ptp(gaps) < 1e-12


def test_seven_discs_of_half_the_radius_cover_a_disc():
    axis, radius = unit([0.3, -0.4, 0.9]), radians(7)
    centres = np.vstack([axis, ring(axis, radius * 3**0.5 / 2)])
    rng = np.random.default_rng(0)
    probes = np.concatenate([ring(axis, radius * rng.random() ** 0.5, rng.random(), 40) for _ in range(200)])
    nearest = np.arccos(np.clip((probes @ centres.T).max(axis=1), -1, 1))
    assert nearest.max() < 0.52 * radius


def test_own_frame_turns_with_the_normals_and_does_not_mirror():
    normals = unit(np.random.default_rng(3).normal(size=(80, 3)) * [0.4, 0.2, 0.1] + [0, 0, 1])
    middle = unit(normals.mean(axis=0))
    turn = rotation([2, 1, 1], 1.2)
    one, other = own_frame(normals, middle), own_frame(normals @ turn.T, turn @ middle)
    np.testing.assert_allclose(other, one @ turn.T, atol=1e-9)
    np.testing.assert_allclose(one @ one.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(one) > 0


def test_own_frame_of_one_normal_is_a_frame():
    frame = own_frame(np.array([[0, 0, 1.0]] * 3), np.array([0, 0, 1.0]))
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)


@pytest.mark.parametrize("spread", [(0.3, 0.3), (0.3, 0.1), (0.0, 0.0)])
def test_own_frame_does_not_hang_on_the_last_digits_of_normals_that_spread_evenly(spread):
    way = np.linspace(0, 2 * pi, 12, endpoint=False)
    normals = unit(np.stack([spread[0] * np.cos(way), spread[1] * np.sin(way), np.ones(12)], axis=1))
    frame = own_frame(normals, np.array([0, 0, 1.0]))
    for seed in range(4):
        noise = np.random.default_rng(seed).uniform(-1e-15, 1e-15, (13, 3))
        np.testing.assert_allclose(own_frame(unit(normals + noise[:12]), unit([0, 0, 1] + noise[12])), frame, atol=1e-6)
