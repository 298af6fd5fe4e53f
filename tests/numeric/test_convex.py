"""Lower bounds of distances between convex bodies, against closed forms and against linear and quadratic programmes."""

from math import cos, radians, sin

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from toolaxis.numeric.support_functions import boxes, hull, places, revolve_body, segments, separation

RNG = np.random.default_rng(5)


def test_boxes_and_cylinders_at_known_distances() -> None:
    box = boxes([0, 0, 0], [10, 10, 10])
    assert separation([box], [boxes([13, 14, 0], [20, 20, 10])])[0] == pytest.approx(5)
    assert separation([box], [boxes([7, 4, 0], [20, 20, 10])])[0] == pytest.approx(-3)
    assert separation([box], [boxes([10, 0, 0], [20, 10, 10])])[0] == pytest.approx(0, abs=1e-9)
    above, beside = revolve_body([[5, 5, 20], [5, 5, 50]], [5, 5]), revolve_body([[20, 5, 5], [20, 5, 50]], [5, 5])
    assert separation([box], [above])[0] == pytest.approx(10)
    assert 5 - 1e-3 <= separation([box], [beside])[0] <= 5 + 1e-9
    round_one = revolve_body([[20, 5, 5], [21, 5, 5]], 0.0, 4.0)
    assert 6 - 1e-3 <= separation([box], [round_one])[0] <= 6 + 1e-9


@pytest.mark.parametrize("tilt", [5, 30, 60, 85])
def test_a_leaning_cylinder_over_a_box(tilt: float) -> None:
    """The lowest point of the lower rim: h cos t - r sin t above the box."""
    angle = radians(tilt)
    axis = np.array([sin(angle), 0.0, cos(angle)])
    low = 40.0 * axis
    found = separation([revolve_body([low, low + 30 * axis], 12.0)], [boxes([-500, -500, -20], [500, 500, 0])])[0]
    assert found == pytest.approx(40 * cos(angle) - 12 * sin(angle), abs=1e-3)


def test_random_hulls_against_quadratic_programmes() -> None:
    for _ in range(25):
        a, b = RNG.normal(size=(7, 3)) * 5, RNG.normal(size=(6, 3)) * 5 + RNG.normal(size=3) * 12

        def far(shares: np.ndarray, a: np.ndarray = a, b: np.ndarray = b) -> float:
            return float(((shares[:7] @ a - shares[7:] @ b) ** 2).sum())

        rules = [{"type": "eq", "fun": lambda s: s[:7].sum() - 1}, {"type": "eq", "fun": lambda s: s[7:].sum() - 1}]
        best = minimize(far, np.full(13, 1 / 7), bounds=[(0, 1)] * 13, constraints=rules, options={"ftol": 1e-12,
                                                                                                  "maxiter": 500})
        expected, found = best.fun ** 0.5, separation([hull(a)], [hull(b)])[0]
        assert found <= expected + 1e-5
        assert found >= expected - 2e-2 or expected < 1e-2
        if expected < 1e-4:
            assert found <= 1e-4


def test_no_bound_is_above_the_distance_of_any_two_points() -> None:
    """Points of a cylinder carried along a segment, and of a turned box, by brute force."""
    for _ in range(20):
        ends, radius = RNG.normal(size=(2, 3)) * 8, RNG.uniform(1, 6)
        way, box = RNG.normal(size=(2, 3)) * 6, (RNG.normal(size=3) * 25, RNG.uniform(2, 12, 3))
        pose = np.eye(4)
        pose[:3, :3] = Rotation.random(random_state=int(RNG.integers(1 << 30))).as_matrix()
        pose[:3, 3] = box[0]
        solid = boxes(-box[1], box[1]).moved(pose)
        found = separation([revolve_body(ends, radius), segments(way)], [solid])[0]
        axis = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        n, m = 4000, RNG.uniform(0, 1, (3, 4000))
        across = np.cross(axis, RNG.normal(size=(n, 3)))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        points = (ends[0] + m[0][:, None] * (ends[1] - ends[0]) + np.sqrt(m[1])[:, None] * radius * across
                  + way[0] + m[2][:, None] * (way[1] - way[0]))
        local = (points - pose[:3, 3]) @ pose[:3, :3]
        away = np.linalg.norm(np.maximum(np.abs(local) - box[1], 0), axis=1).min()
        assert found <= away + 1e-9
        assert found >= away - 0.25 * radius - 2.0 or away == 0
        if away == 0:
            assert found <= 1e-6


def test_many_pairs_at_once_are_the_pairs_one_by_one() -> None:
    low = RNG.normal(size=(40, 3)) * 15
    many, one = boxes(low, low + RNG.uniform(1, 9, (40, 3))), revolve_body([[0, 0, -3], [0, 0, 6]], [4, 2])
    at = places(RNG.normal(size=(40, 3)))
    whole = separation([one, at], [many])
    for k in range(40):
        row = np.array([k])
        assert separation([one, at.rows(row)], [many.rows(row)])[0] == pytest.approx(whole[k], abs=1e-9)


def test_enough_is_enough_and_depths_that_nobody_asks_for_are_still_bounds() -> None:
    one, far = boxes([0, 0, 0], [1, 1, 1]), boxes([50, 0, 0], [51, 1, 1])
    assert 5 <= separation([one], [far], enough=5.0)[0] <= 49 + 1e-9
    inside = boxes([0.4, 0.4, 0.4], [3, 3, 3])
    assert separation([one], [inside])[0] == pytest.approx(-0.6)
    assert separation([one], [inside], inner=np.array([True]))[0] <= -0.6 + 1e-9


def test_along_the_axis_of_a_turned_disc_rounding_is_no_direction() -> None:
    """A direction that is the axis up to rounding: what is left across it must not become a unit vector."""
    for seed in range(200):
        turn = Rotation.random(random_state=seed).as_matrix()
        pose = np.eye(4)
        pose[:3, :3] = turn
        cylinder = revolve_body([[0, 0, 0], [0, 0, 100]], 55.0).moved(pose)
        way = (turn @ [0.0, 0, 1.0])[None]
        way = way / np.linalg.norm(way)
        assert (cylinder.support(way) @ way[0])[0] == pytest.approx(100.0, abs=1e-5)
        assert (cylinder.support(-way) @ way[0])[0] == pytest.approx(0.0, abs=1e-5)
        roof = boxes([-900, -900, 90], [900, 900, 110]).moved(pose)
        assert separation([cylinder], [roof])[0] == pytest.approx(-10.0, abs=1e-5)
