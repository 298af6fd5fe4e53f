"""Work coordinate systems: +z is the axis, +x the mean feed."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.numeric.vectors import rotation, unit

FEED = np.array([[1.0, 0.1, 0.3], [1.0, -0.1, 0.2], [0.9, 0.0, -0.4]])


def test_z_is_the_axis_and_x_the_mean_feed_across_it():
    frame = work_coordinates([0, 0, 3], FEED, [1, 2, 3], [4, 5, 6])
    np.testing.assert_allclose(frame.z, [0, 0, 1])
    np.testing.assert_allclose(frame.x, [1, 0, 0], atol=0.02)
    assert frame.x[2] == 0 and abs(np.linalg.norm(frame.x) - 1) < 1e-12


def test_frame_is_right_handed_and_rigid():
    frame = work_coordinates([0.3, -0.2, 0.9], FEED, [0, 0, 0], [0, 0, 0])
    axes = np.stack([frame.x, frame.y, frame.z])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.cross(frame.x, frame.y), frame.z, atol=1e-12)


def test_datum_is_the_origin_and_the_matrix_undoes_the_coordinates():
    frame = work_coordinates([0.3, -0.2, 0.9], FEED, [7, 8, 9], [0, 0, 0])
    points = np.random.default_rng(0).normal(size=(5, 3))
    local = frame.from_part(points)
    np.testing.assert_allclose(frame.from_part([7, 8, 9]), [[0, 0, 0]], atol=1e-12)
    back = frame.part_from_work @ np.column_stack([local, np.ones(5)]).T
    np.testing.assert_allclose(back[:3].T, points, atol=1e-12)


def test_frame_turns_with_the_part():
    turn = rotation([1, 1, 0], 0.7)
    one = work_coordinates([0.3, -0.2, 0.9], FEED, [0, 0, 0], [0, 0, 0])
    other = work_coordinates(turn @ unit([0.3, -0.2, 0.9]), FEED @ turn.T, [0, 0, 0], [0, 0, 0])
    np.testing.assert_allclose(other.x, turn @ one.x, atol=1e-12)


def test_zigzag_feeds_give_the_line_of_x():
    frame = work_coordinates([0, 0, 1], np.concatenate([FEED, -FEED, FEED[:1]]), [0, 0, 0], [0, 0, 0])
    np.testing.assert_allclose(frame.x, [1, 0, 0], atol=0.05)


def test_feed_along_the_axis_still_gives_a_frame():
    frame = work_coordinates([0, 0, 1], [[0, 0, 1.0]], [0, 0, 0], [0, 0, 0])
    assert abs(frame.x @ frame.z) < 1e-12 and abs(np.linalg.norm(frame.x) - 1) < 1e-12


def test_an_axis_without_direction_is_refused():
    with pytest.raises(InvalidInput, match="direction"):
        work_coordinates([0, 0, 0], FEED, [0, 0, 0], [0, 0, 0])


def test_steep_feeds_count_by_their_projection() -> None:
    feed = np.array([[0.06, 0.08, 5.0], [0.06, 0.08, -5.0], [0.06, 0.08, 5.0], [0.06, 0.08, -5.0]])
    frame = work_coordinates([0, 0, 1], feed, np.zeros(3), np.zeros(3))
    assert np.allclose(frame.x, [0.6, 0.8, 0.0], atol=1e-12)
