"""Lambert's equal-area map: areas, the border, and the way back."""

import numpy as np
import pytest

from toolaxis.numeric.equal_area import equal_area, from_equal_area

POLE, RIGHT = np.array([1.0, -2.0, 2.0]) / 3, [0.0, 1.0, 1.0]


@pytest.mark.parametrize("angle", [0.0, 30.0, 60.0, 90.0, 150.0])
def test_radius_follows_the_area_of_the_cap(angle: float) -> None:
    a = np.radians(angle)
    across = np.cross(POLE, [0.0, 0.0, 1.0])
    axis = np.cos(a) * POLE + np.sin(a) * across / np.linalg.norm(across)
    radius = np.linalg.norm(equal_area(axis, POLE, RIGHT))
    assert np.pi * radius**2 == pytest.approx(np.pi * (1 - np.cos(a)), abs=1e-12)  # cap 2 pi (1 - cos), half of it


def test_there_and_back() -> None:
    turn, radius = np.meshgrid(np.linspace(0, 6, 13), np.linspace(0.01, 1.3, 9))
    places = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1).reshape(-1, 2)
    axes = from_equal_area(places, POLE, RIGHT)
    assert np.allclose(np.linalg.norm(axes, axis=1), 1.0, atol=1e-14)
    assert np.allclose(equal_area(axes, POLE, RIGHT), places, atol=1e-7)


def test_x_is_the_direction_asked_for_seen_from_outside() -> None:
    assert np.allclose(from_equal_area([[1.0, 0.0]], [0, 0, 1], [2, 0, 1]), [[1, 0, 0]], atol=1e-15)
    assert np.allclose(from_equal_area([[0.0, 1.0]], [0, 0, 1], [2, 0, 1]), [[0, 1, 0]], atol=1e-15)
    assert np.allclose(from_equal_area([[0.0, 0.0]], POLE), POLE)
