"""Ramps along curves: no axis beyond its limits, and not far from the optimum that another planner seeks."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import profile
from toolaxis.feed.limits import AxisBounds
from toolaxis.feed.time_optimal import schedule_curve
from toolaxis.feed.velocity_ramps import VelocityRamps, ramps

MIKRON = AxisBounds(np.full(3, 500.0), np.array([2500.0, 3000.0, 2100.0]), np.full(3, 5000.0))


def _pass(seed: int, bend: float = 1.0) -> np.ndarray:
    """A pass over a wavy face."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, rng.uniform(30, 120), 300)
    heights = rng.uniform(1, 6, 2)[:, None] * np.cos(x / rng.uniform(8, 25, 2)[:, None] + rng.uniform(0, 6, 2)[:, None])
    return np.stack([x, bend * heights[0], bend * heights[1]], axis=1)


def _worst(found: VelocityRamps, bounds: AxisBounds, feed: float) -> float:
    """The greatest share of a limit that an axis takes, sampled; speed of the path against the feed too."""
    worst = 0.0
    for k, length in enumerate(np.diff(found.borders)):
        limits = [float(each[k]) for each in found.limits]
        motion = profile(float(length), *limits, ends=(float(found.speeds[k]), float(found.speeds[k + 1])))
        s, v, a, j = motion.at(np.linspace(0, motion.duration, 200)[1:-1]).T[:, :, None]
        q1, q2, q3 = (found.curve(found.borders[k] + s[:, 0], order) for order in (1, 2, 3))
        sizes = (q1 * v, q1 * a + q2 * v**2, q1 * j + 3 * q2 * v * a + q3 * v**3)
        shares = [np.abs(size) / limit for size, limit in
                  zip(sizes, (bounds.velocity, bounds.acceleration, bounds.jerk), strict=True)]
        worst = max(worst, float(np.max(shares)), float(v.max()) / feed)
    return worst


@pytest.mark.parametrize("feed", [10.0, 60.0, 500.0])
@pytest.mark.parametrize("seed", range(4))
def test_no_axis_exceeds_a_limit(seed: int, feed: float) -> None:
    points = _pass(seed)
    found = ramps(points, points, feed, MIKRON, 1e-3)
    assert found.speeds[0] == found.speeds[-1] == 0 and found.borders[-1] == pytest.approx(
        np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    assert _worst(found, MIKRON, feed) <= 1.02  # between the places that were looked at
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    assert np.abs(found.curve(along) - points).max() <= 1e-3


@pytest.mark.parametrize(("feed", "most"), [(15.0, 1.03), (60.0, 1.25)])
def test_near_the_optimum(feed: float, most: float) -> None:
    for seed in range(5):
        points = _pass(seed, 0.7)
        best = schedule_curve(points, points, feed, MIKRON, stations=500).duration
        assert 0.985 < ramps(points, points, feed, MIKRON, 1e-4).duration / best < most


def test_a_straight_line_is_one_ramp() -> None:
    points = np.linspace(0, 1, 50)[:, None] * (60.0, 0.0, 0.0)
    assert ramps(points, points, 40.0, MIKRON).duration == pytest.approx(
        profile(60.0, 40.0, 2500.0, 5000.0).duration, rel=1e-3)


def test_more_points_change_little() -> None:
    """What noise of coordinates does to third derivatives is smoothed within the tolerance."""
    points = _pass(3)
    noisy = np.repeat(points, 2, axis=0)[:-1]
    noisy[1::2] = (points[1:] + points[:-1]) / 2
    plain, many = (ramps(rows, rows, 30.0, MIKRON, 0.01).duration for rows in (points, noisy))
    assert many == pytest.approx(plain, rel=0.03)


@pytest.mark.parametrize(("change", "said"), [
    ({"feed": 0.0}, "feed is 0.0 mm/s"), ({"tips": np.zeros((300, 3))}, "points 0 and the next coincide"),
    ({"points": np.zeros((5, 3)), "tips": np.zeros((5, 3))}, "six or more"),
    ({"tips": np.zeros((9, 3))}, "300 joint positions for 9 tips")])
def test_bad_input(change: dict[str, object], said: str) -> None:
    given = {"points": _pass(1), "tips": _pass(1), "feed": 10.0, "bounds": MIKRON, **change}
    with pytest.raises(InvalidInput, match=said):
        ramps(**given)  # type: ignore[arg-type]
