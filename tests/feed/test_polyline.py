"""Straight segments: axis limits never exceeded, tolerance kept, and outside oracles for the time."""

from itertools import pairwise

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import reachable, travel_time
from toolaxis.feed.limits import AxisBounds
from toolaxis.feed.polyline import look_ahead, schedule_polyline

MIKRON = AxisBounds(np.full(3, 500.0), np.array([2500.0, 3000.0, 2100.0]), np.full(3, 5000.0))


def _path(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.cumsum(rng.normal(size=(count, 3)) * 10 ** rng.uniform(-2, 1.5, (count, 1)), axis=0)


@pytest.mark.parametrize("tolerance", [0.0, 1e-4, 0.01, 0.5])
@pytest.mark.parametrize("seed", range(4))
def test_no_axis_exceeds_a_limit(tolerance: float, seed: int) -> None:
    points = _path(np.random.default_rng(seed), 60)
    found = schedule_polyline(points, points, 200.0, MIKRON, tolerance)
    motion = found.motion()
    for size, limit in zip(motion.extremes(), (MIKRON.velocity, MIKRON.acceleration, MIKRON.jerk), strict=True):
        assert (size <= limit * (1 + 1e-9)).all()
    assert motion.duration == pytest.approx(found.duration, rel=1e-12)
    q, v, a = motion.knots()
    assert np.abs(q[-1] - points[-1]).max() < 1e-8 and np.abs(v[-1]).max() < 1e-7 and np.abs(a[-1]).max() < 1e-6


def test_sampled_derivatives_stay_within_limits() -> None:
    """Finite differences of positions alone, as a judge sees them."""
    points = _path(np.random.default_rng(11), 30)
    motion = schedule_polyline(points, points, 100.0, MIKRON, 0.05).motion()
    step = motion.duration / 20000
    q = motion.at(np.arange(20001) * step)[0]
    for order, limit in enumerate((MIKRON.velocity, MIKRON.acceleration, MIKRON.jerk), start=1):
        assert (np.abs(np.diff(q, order, axis=0)).max(axis=0) / step**order <= limit * (1 + 1e-3)).all()


@pytest.mark.parametrize("tolerance", [0.0, 0.01, 0.2])
def test_the_tip_stays_within_tolerance_and_feed(tolerance: float) -> None:
    points = _path(np.random.default_rng(5), 25)
    motion = schedule_polyline(points, points, 80.0, MIKRON, tolerance).motion()
    q, v, _, _ = motion.at(np.linspace(0, motion.duration, 4000))
    a, d = points[:-1], np.diff(points, axis=0)
    share = np.clip(((q[:, None] - a) * d).sum(axis=2) / (d * d).sum(axis=1), 0, 1)
    away = np.linalg.norm(q[:, None] - a - share[..., None] * d, axis=2).min(axis=1)
    assert away.max() <= tolerance + 1e-7
    assert np.linalg.norm(v, axis=1).max() <= 80.0 * (1 + 1e-9)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-2])
def test_a_blend_uses_its_tolerance_and_no_more(tolerance: float) -> None:
    """At gentle corners the tip passes the corner at just the tolerance."""
    turns = np.radians(4) * np.arange(6)
    steps = 60 * np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    points = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    found = schedule_polyline(points, points, np.inf, MIKRON, tolerance)
    q = found.motion().at(np.linspace(0, found.duration, 200_000))[0]
    missed = [np.linalg.norm(q - corner, axis=1).min() for corner in points[1:-1]]
    assert np.allclose(missed, tolerance, rtol=0.03)


def test_a_straight_move_as_ruckig_in_three_axes() -> None:
    ruckig = pytest.importorskip("ruckig", reason="ruckig is the oracle of straight moves")
    rng = np.random.default_rng(8)
    for _ in range(20):
        move = rng.normal(size=3) * 10 ** rng.uniform(-1, 3)
        given = ruckig.InputParameter(3)
        given.current_position, given.target_position = [0.0] * 3, move.tolist()
        given.synchronization = ruckig.Synchronization.Phase
        given.max_velocity, given.max_acceleration, given.max_jerk = (
            limit.tolist() for limit in (MIKRON.velocity, MIKRON.acceleration, MIKRON.jerk))
        trajectory = ruckig.Trajectory(3)
        ruckig.Ruckig(3).calculate(given, trajectory)
        line = np.stack([np.zeros(3), move])
        assert schedule_polyline(line, line, np.inf, MIKRON).duration == pytest.approx(trajectory.duration, rel=1e-6)


def test_more_points_on_a_line_change_nothing() -> None:
    ends = np.array([[0.0, 0, 0], [30.0, 40.0, 10.0]])
    whole = schedule_polyline(ends, ends, 150.0, MIKRON).duration
    shares = np.sort(np.random.default_rng(2).uniform(size=40))
    points = ends[0] + np.concatenate([[0], shares, [1]])[:, None] * ends[1]
    for tolerance in (0.0, 0.01):
        found = schedule_polyline(points, points, 150.0, MIKRON, tolerance)
        assert found.duration == pytest.approx(whole, rel=1e-6) and found.segment_times.shape == (41,)


def test_an_exact_stop_is_the_sum_of_its_moves() -> None:
    points = np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0], [10, 10, 10]])
    single = [float(travel_time(10.0, 500.0, a, 5000.0)) for a in (2500.0, 3000.0, 2100.0)]
    found = schedule_polyline(points, points, np.inf, MIKRON)
    assert found.duration == pytest.approx(sum(single), rel=1e-12) and not found.corners.any()


@pytest.mark.parametrize("degrees", [1, 5, 20, 45, 90, 170])
def test_a_tolerance_never_costs_time(degrees: float) -> None:
    turns = np.radians(degrees) * np.arange(12) * np.resize((1, 0), 12)
    steps = 20 * np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    points = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    times = [schedule_polyline(points, points, 100.0, MIKRON, cut).duration for cut in (0.0, 1e-3, 0.1, 1.0)]
    assert max(times) <= times[0] * (1 + 1e-12)
    assert degrees > 5 or times[-1] < 0.9 * times[0]


def test_a_faster_feed_never_costs_time() -> None:
    """Blends that fill short chords leave no way to change speed: the slowest must not hold back all others."""
    turns = np.cumsum(10 ** np.random.default_rng(4).uniform(-2, 0, 400)) / 60
    points = np.stack([60 * np.cos(turns), 60 * np.sin(turns), 0 * turns], axis=1)
    times = [schedule_polyline(points, points, feed, MIKRON, 1e-3).duration for feed in (5, 10, 20, 80, 300)]
    assert all(fast <= slow * 1.01 for slow, fast in pairwise(times))


def test_the_axes_rest_where_they_must() -> None:
    points = np.array([[0.0, 0, 0], [40, 0, 0], [100, 0, 0], [140, 3, 0]])
    rest = np.array([False, True, False, False])
    whole, split = (schedule_polyline(points, points, 80.0, MIKRON, 0.01, stops) for stops in (None, rest))
    assert split.corners[1] == 0 and split.duration > whole.duration
    parts = [schedule_polyline(some, some, 80.0, MIKRON, 0.01).duration for some in (points[:2], points[1:])]
    assert split.duration == pytest.approx(sum(parts), rel=1e-9)


def test_feeds_of_each_segment() -> None:
    points = np.array([[0.0, 0, 0], [100, 0, 0], [200, 0, 0]])
    found = schedule_polyline(points, points, [50.0, np.inf], MIKRON, 0.01)
    assert found.corners[1] == pytest.approx(50.0) and found.segment_times[0] > 2 > found.segment_times[1]


def test_look_ahead_is_the_greatest() -> None:
    """Every speed is at its cap or as much as a neighbour allows, and none is more."""
    rng = np.random.default_rng(3)
    runs, caps = 10 ** rng.uniform(-3, 1, 200), np.concatenate([[0.0], 10 ** rng.uniform(-1, 3, 199), [0.0]])
    a, j = np.full(200, 2000.0), np.full(200, 5000.0)
    speeds = look_ahead(runs, a, j, caps)
    right = np.concatenate([[np.inf], reachable(speeds[:-1], runs, a, j)])
    left = np.concatenate([reachable(speeds[1:], runs, a, j), [np.inf]])
    most = np.minimum(caps, np.minimum(left, right))
    assert (speeds <= most * (1 + 1e-9) + 1e-12).all() and (speeds >= most * (1 - 1e-6) - 1e-9).all()


@pytest.mark.parametrize(("change", "said"), [
    ({"feeds": 0.0}, "feed 0 is 0"), ({"feeds": [1.0, -1.0]}, "feed 1 is -1"),
    ({"tips": np.zeros((3, 3))}, "segment 0 has no length"), ({"joints": np.zeros((3, 3))}, "segment 0 moves no axis"),
    ({"joints": np.zeros((2, 3))}, "2 joint positions for 3 tips"), ({"tolerance": -1.0}, "corner tolerance is -1"),
    ({"tips": np.full((3, 3), np.nan)}, "tips row 0"),
])
def test_bad_input(change: dict[str, object], said: str) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    given = {"joints": points, "tips": points, "feeds": 1.0, "bounds": MIKRON, "tolerance": 0.0, **change}
    with pytest.raises(InvalidInput, match=said):
        schedule_polyline(**given)  # type: ignore[arg-type]


def test_bad_bounds() -> None:
    with pytest.raises(InvalidInput, match="jerk limits are"):
        AxisBounds(np.ones(3), np.ones(3), np.array([1.0, 0.0, 1.0]))
