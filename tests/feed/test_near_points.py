"""The fastest motion near points: limits kept as finite differences see them, curves near, times near the optimum."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.feed.limits import AxisBounds
from toolaxis.feed.time_optimal import CurveSchedule, schedule_curve, schedule_near

MIKRON = AxisBounds(np.full(3, 500.0), np.array([2500.0, 3000.0, 2100.0]), np.full(3, 5000.0))
Rows = np.ndarray


def _wavy(seed: int) -> Rows:
    """A pass over a wavy face, its points anything but even."""
    rng = np.random.default_rng(seed)
    x = np.cumsum(rng.choice([0.05, 0.2, 0.6], 260))
    heights = rng.uniform(1, 6, 2)[:, None] * np.cos(x / rng.uniform(8, 25, 2)[:, None] + rng.uniform(0, 6, 2)[:, None])
    return np.stack([x, heights[0], heights[1]], axis=1)


def _with_a_narrow_bend(radius: float) -> Rows:
    """Two straight lines at 60 degrees with a narrow arc between them, as where a normal passes near the axis."""
    turn = np.linspace(0.0, np.pi / 3, 40)
    arc = radius * np.stack([np.sin(turn), 1 - np.cos(turn), 0 * turn], axis=1)
    way = np.array([np.cos(np.pi / 3), np.sin(np.pi / 3), 0.0])
    steps = np.geomspace(0.02, 5.0, 40)
    before = -np.cumsum(steps)[::-1, None] * np.array([1.0, 0.0, 0.0])
    return np.concatenate([before, arc, arc[-1] + np.cumsum(steps)[:, None] * way])


def _worst(found: CurveSchedule, feed: float) -> float:
    """The greatest share of a limit, by finite differences of positions."""
    count = 20_000
    step = found.duration / count
    q = found.at(np.arange(count + 1) * step)[0]
    shares = [float((np.abs(np.diff(q, order, axis=0)).max(axis=0) / step**order / limit).max())
              for order, limit in enumerate((MIKRON.velocity, MIKRON.acceleration, MIKRON.jerk), start=1)]
    return max(*shares, float(np.linalg.norm(np.diff(q, axis=0), axis=1).max()) / step / feed)


def _along(points: Rows) -> Rows:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


@pytest.mark.parametrize("feed", [15.0, 60.0, 300.0])
@pytest.mark.parametrize("seed", range(3))
def test_no_axis_exceeds_a_limit(seed: int, feed: float) -> None:
    points = _wavy(seed)
    found = schedule_near(points, feed, MIKRON, 1e-3)
    assert _worst(found, feed) <= 1.005
    assert np.abs(found.curve(_along(points)) - points).max() <= 1e-3
    assert np.abs(found.curve(_along(points))[[0, -1]] - points[[0, -1]]).max() <= 1e-6
    _, v, a, _ = found.at([0.0, found.duration])
    assert np.abs(v).max() < 1e-5 and np.abs(a).max() < 1e-3


@pytest.mark.parametrize("feed", [15.0, 60.0])
@pytest.mark.parametrize("seed", range(3))
def test_as_fast_as_with_many_more_stations(seed: int, feed: float) -> None:
    points = _wavy(seed)
    near = schedule_near(points, feed, MIKRON, 1e-3)
    rows = near.curve(np.linspace(0.0, _along(points)[-1], 1500))
    best = schedule_curve(rows, rows, feed, MIKRON, stations=3000)
    assert 0.985 * best.duration < near.duration < 1.015 * best.duration


@pytest.mark.parametrize("radius", [2.0, 0.5, 0.1])
def test_a_narrow_bend_slows_down_there_only(radius: float) -> None:
    points, feed = _with_a_narrow_bend(radius), 50.0
    found = schedule_near(points, feed, MIKRON, 5e-4)
    assert _worst(found, feed) <= 1.01
    alone = [float(travel_time(length, feed, MIKRON.acceleration.min(), MIKRON.jerk.min()))
             for length in (_along(points)[-1], _along(points)[-1] / 2)]
    assert alone[0] < found.duration < 2 * alone[1] + 1.0


@pytest.mark.parametrize("length", [0.01, 3.0, 400.0])
def test_a_straight_line_takes_as_long_as_the_closed_form(length: float) -> None:
    points = np.linspace(0, 1, 50)[:, None] * (length, 0.0, 0.0)
    exact = float(travel_time(length, 40.0, 2500.0, 5000.0))
    assert exact * (1 - 1e-9) <= schedule_near(points, 40.0, MIKRON, 1e-3).duration <= 1.006 * exact


@pytest.mark.parametrize(("points", "feed", "said"), [
    (_wavy(0), 0.0, "feed is 0.0 mm/s"), (np.zeros((30, 3)), 10.0, "points 0 and the next coincide"),
    (np.eye(3), 10.0, "six or more")])
def test_bad_input(points: Rows, feed: float, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        schedule_near(points, feed, MIKRON, 1e-3)
