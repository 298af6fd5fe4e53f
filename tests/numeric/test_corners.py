"""Rounded corners: the exact one, the three rules and curvature on random ones, and the curve as a function of x."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.numeric.corner_rounding import RoundedLine, corner, greatest_height

EXACT = {"Bi0": (5.80323, 1.160646), "Bi1": (7.976613, 1.595323), "Bj1": (11.650766, 3.238075),
         "Bj3": (13.09737, 4.323028)}


def random_corners(count=2000):
    rng = np.random.default_rng(23)
    angle = np.radians(rng.uniform(-80, 80, (count, 2)))
    angle = angle[np.abs(np.diff(angle, axis=1))[:, 0] > 0.01]
    length = rng.uniform(0.1, 20, angle.shape)
    way = length[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    p2 = rng.uniform(-5, 5, (len(angle), 2))
    eps = np.sign(angle[:, 1] - angle[:, 0]) * rng.uniform(0.001, 1, len(angle))
    return p2 - way[:, 0], p2, p2 + way[:, 1], eps


def test_the_exact_corner():
    one, other = corner((0, 0), (10, 2), (18, 8), 0.5)[0]
    for name, point in (("Bi0", one[0]), ("Bi1", one[1]), ("Bj1", other[1]), ("Bj3", other[3])):
        np.testing.assert_allclose(point, EXACT[name], atol=1e-5)
    assert np.hypot(*(one[0] - (10, 2))) == pytest.approx(4.279882, abs=1e-5)
    assert np.hypot(*(other[3] - (10, 2))) == pytest.approx(3.871713, abs=1e-5)


def test_the_three_rules_hold_on_random_corners():
    p1, p2, p3, eps = random_corners()
    made = corner(p1, p2, p3, eps)
    size = np.abs(made).max()
    top = p2 + np.column_stack([0 * eps, eps])
    np.testing.assert_allclose(made[:, 0, 3], top, atol=1e-12 * size)
    np.testing.assert_allclose(made[:, 1, 0], top, atol=1e-12 * size)
    unit = [(b - a) / np.linalg.norm(b - a, axis=1)[:, None] for a, b in ((p1, p2), (p2, p3))]
    bisector = unit[1] - unit[0]
    for k in (0, 1):
        inner = made[:, k, 1]
        assert (made[:, k, 2] == inner).all()
        across = ((inner - top) * bisector).sum(axis=1) / np.linalg.norm(bisector, axis=1)
        assert np.abs(across).max() < 1e-9 * size
        for point in (inner, made[:, k, 3 * k]):
            off = (point - p2)[:, 0] * unit[k][:, 1] - (point - p2)[:, 1] * unit[k][:, 0]
            assert np.abs(off).max() < 1e-9 * size
        arms = [np.linalg.norm(made[:, k, i] - made[:, k, j], axis=1) for i, j in ((0, 1), (2, 3))]
        np.testing.assert_allclose(arms[0], arms[1], rtol=1e-8)


def test_tangents_are_continuous_and_curvature_vanishes_at_all_joints():
    made = corner(*random_corners())
    first, second = 3 * np.diff(made, axis=2), 6 * np.diff(made, n=2, axis=2)
    for k in (0, 1):
        for joint, end in ((0, 0), (2, 1)):
            d, dd = first[:, k, joint], second[:, k, end]
            bend = (d[:, 0] * dd[:, 1] - d[:, 1] * dd[:, 0]) / np.linalg.norm(d, axis=1)**3
            assert np.abs(bend).max() < 1e-7
    before, after = first[:, 0, 2], first[:, 1, 0]
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    assert np.abs(turn / np.linalg.norm(before, axis=1) / np.linalg.norm(after, axis=1)).max() < 1e-9


def line():
    points = np.array([[0.0, 0.0], [20.0, 0.0], [50.0, 1.5], [90.0, 2.0], [120.0, 2.0]])
    return RoundedLine(points, 0.8 * greatest_height(points, (1.0, 1.0)))


def test_a_rounded_line_is_a_rising_function_with_its_derivatives():
    made = line()
    x = np.linspace(0, 120, 24001)
    y, slope, second = made.at(x)
    assert (np.diff(y) >= -1e-12).all() and slope.min() > -1e-12
    np.testing.assert_allclose(np.gradient(y, x)[1:-1], slope[1:-1], atol=2e-5)
    np.testing.assert_allclose(np.gradient(slope, x)[1:-1], second[1:-1], atol=2e-4)
    assert np.abs(np.diff(second)).max() < 2e-4
    np.testing.assert_allclose(made.at([20.0, 50.0])[0], made.points[1:3, 1] + made.heights[:2], atol=1e-9)


def test_peak_acceleration_is_that_of_small_slopes():
    points = np.array([[0.0, 0.0], [100.0, 0.0], [200.0, 1.0]])
    made = RoundedLine(points, np.array([0.05]))
    peak = np.abs(made.at(np.linspace(0, 200, 20001))[2]).max()
    assert peak == pytest.approx(0.01**2 / (3 * 0.05), rel=1e-3)


def test_greatest_height_takes_half_of_the_shorter_segment():
    points = np.array([[0.0, 0.0], [10.0, 2.0], [18.0, 8.0]])
    made = corner(*points, greatest_height(points)[0])[0]
    reach = np.hypot(*(made[0, 0] - points[1])), np.hypot(*(made[1, 3] - points[1]))
    half = np.hypot(10, 2) / 2, np.hypot(8, 6) / 2
    assert min(half[0] - reach[0], half[1] - reach[1]) == pytest.approx(0.0, abs=1e-9)
    assert max(reach[0] - half[0], reach[1] - half[1]) < 1e-9


@pytest.mark.parametrize("points, height, words", [
    (((0, 0), (10, 2), (10, 8)), 0.5, "x does not ascend"), (((0, 0), (10, 2), (18, 8)), -0.5, "outer side"),
    (((0, 0), (10, 2), (20, 4)), 0.5, "slope does not change"), (((0, 0), (10, 2), (18, 8)), 0.0, "zero")])
def test_wrong_corners_are_named(points, height, words):
    with pytest.raises(InvalidInput, match=words):
        corner(*points, height)
