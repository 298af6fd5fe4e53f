"""Times by ramps in windows: never below the optimum that another planner finds, and not far from it."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import profile
from toolaxis.feed.limits import AxisBounds
from toolaxis.feed.time_optimal import schedule_curve
from toolaxis.feed.velocity_ramps import bend_of, durations

MIKRON = AxisBounds(np.full(3, 500.0), np.array([2500.0, 3000.0, 2100.0]), np.full(3, 5000.0))


def _pass(seed: int, bend: float = 1.0) -> np.ndarray:
    """A pass over a wavy face."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, rng.uniform(30, 120), 300)
    heights = rng.uniform(1, 6, 2)[:, None] * np.cos(x / rng.uniform(8, 25, 2)[:, None] + rng.uniform(0, 6, 2)[:, None])
    return np.stack([x, bend * heights[0], bend * heights[1]], axis=1)


def _time(points: np.ndarray, feed: float, tolerance: float = 1e-3) -> float:
    return float(durations(bend_of(points, points, feed, 3, tolerance), np.eye(3)[None], feed, MIKRON)[0])


@pytest.mark.parametrize(("feed", "most"), [(15.0, 1.03), (60.0, 1.25)])
def test_near_the_optimum(feed: float, most: float) -> None:
    for seed in range(5):
        points = _pass(seed, 0.7)
        best = schedule_curve(points, points, feed, MIKRON, stations=500).duration
        assert 0.985 < _time(points, feed, 1e-4) / best < most


def test_a_straight_line_is_one_ramp() -> None:
    points = np.linspace(0, 1, 50)[:, None] * (60.0, 0.0, 0.0)
    assert _time(points, 40.0) == pytest.approx(profile(60.0, 40.0, 2500.0, 5000.0).duration, rel=1e-3)


def test_more_points_change_little() -> None:
    """What noise of coordinates does to third derivatives is smoothed within the tolerance."""
    points = _pass(3)
    noisy = np.repeat(points, 2, axis=0)[:-1]
    noisy[1::2] = (points[1:] + points[:-1]) / 2
    plain, many = (_time(rows, 30.0, 0.01) for rows in (points, noisy))
    assert many == pytest.approx(plain, rel=0.03)


@pytest.mark.parametrize(("change", "said"), [
    ({"feed": 0.0}, "feed is 0.0 mm/s"), ({"tips": np.zeros((300, 3))}, "points 0 and the next coincide"),
    ({"points": np.zeros((5, 3)), "tips": np.zeros((5, 3))}, "six or more"),
    ({"tips": np.zeros((9, 3))}, "300 joint positions for 9 tips")])
def test_bad_input(change: dict[str, object], said: str) -> None:
    given = {"points": _pass(1), "tips": _pass(1), "feed": 10.0, **change}
    with pytest.raises(InvalidInput, match=said):
        bend_of(**given)  # type: ignore[arg-type]
