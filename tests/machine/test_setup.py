"""Work coordinate systems: +z is the axis, +x the mean feed direction, one origin for all."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.machine.setup import work_coordinates
from toolaxis.numeric.vectors import unit

RNG = np.random.default_rng(3)


@pytest.mark.parametrize("seed", range(20))
def test_the_frame_is_right_handed_and_moves_with_the_part(seed: int) -> None:
    rng = np.random.default_rng(seed)
    axis, datum = unit(rng.normal(size=3)), rng.normal(size=3)
    feed = rng.normal(size=3) + 0.3 * rng.normal(size=(40, 3))
    frame = work_coordinates(axis, feed, datum, datum + 1)
    matrix = frame.part_from_work
    assert np.allclose(matrix[:3, :3].T @ matrix[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1.0)
    assert np.allclose(frame.z, axis, atol=1e-15)
    points = rng.normal(size=(5, 3))
    back = frame.from_part(points) @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.allclose(back, points, atol=1e-12)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    moved = work_coordinates(turn @ axis, feed @ turn.T, turn @ datum, datum)
    assert np.allclose(moved.x, turn @ frame.x, atol=1e-9)


def test_x_is_the_mean_feed_projected_and_zigzag_does_not_cancel_it() -> None:
    feed = np.array([[1.0, 0.1, 5.0], [1.0, -0.1, -3.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
    frame = work_coordinates([0, 0, 1], feed, np.zeros(3), np.zeros(3))
    assert np.allclose(frame.x, [1, 0, 0], atol=1e-3)


def test_feeds_along_the_axis_still_give_a_frame() -> None:
    frame = work_coordinates([0, 0, 2.0], np.array([[0, 0, 1.0]]), np.zeros(3), np.zeros(3))
    assert frame.x @ frame.z == 0 and np.linalg.norm(frame.x) == 1


def test_an_axis_without_direction_is_refused() -> None:
    with pytest.raises(InvalidInput, match="direction"):
        work_coordinates([0, 0, 0], np.array([[1.0, 0, 0]]), np.zeros(3), np.zeros(3))
