"""Seven-segment profiles: every degenerate case, held against ruckig."""

from itertools import product

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.jerk_profile import peak_velocity, profile, ramp_length, reachable, travel_time

RNG = np.random.default_rng(7)


def _ruckig(length: float, limits: tuple[float, float, float], ends: tuple[float, float]) -> float:
    ruckig = pytest.importorskip("ruckig", reason="ruckig is the oracle of straight moves")
    given = ruckig.InputParameter(1)
    given.current_position, given.current_velocity, given.current_acceleration = [0.0], [ends[0]], [0.0]
    given.target_position, given.target_velocity, given.target_acceleration = [length], [ends[1]], [0.0]
    given.max_velocity, given.max_acceleration, given.max_jerk = ([limit] for limit in limits)
    trajectory = ruckig.Trajectory(1)
    assert ruckig.Ruckig(1).calculate(given, trajectory) == ruckig.Result.Working
    return float(trajectory.duration)


def test_jerk_alone() -> None:
    assert travel_time(117.0, 1e9, 1e9, 5000.0) == pytest.approx(4 * (117 / 10000) ** (1 / 3), rel=1e-13)


def test_what_the_papers_model_allows_on_a_straight_path() -> None:
    """Aligned with a corner (sqrt 3) against a 45 degree start (sqrt 2): 6.5 %; and its index move of 0.119 s."""
    slow, fast = (float(travel_time(100.0, 1e9, 1e9, 5000 * np.sqrt(k))) for k in (2, 3))
    assert 1 - fast / slow == pytest.approx(0.065, abs=5e-4)
    assert float(travel_time(0.094 / 360, 0.25, 0.83, 5.0)) == pytest.approx(0.119, abs=5e-4)


@pytest.mark.parametrize("length", [1e-9, 1e-3, 0.5, 1.0, 4.0, 20.0, 500.0, 1e5])
@pytest.mark.parametrize("limits", [(10.0, 100.0, 1000.0), (10.0, 1e6, 1000.0), (1e6, 5.0, 1000.0), (1e6, 1e6, 7.0)])
def test_rest_to_rest_as_ruckig(length: float, limits: tuple[float, float, float]) -> None:
    assert float(travel_time(length, *limits)) == pytest.approx(_ruckig(length, limits, (0.0, 0.0)), rel=1e-6)


def test_between_velocities_as_ruckig() -> None:
    for _ in range(200):
        limits = tuple(float(x) for x in 10 ** RNG.uniform((0, 0, 1), (3, 4, 5)))
        ends = tuple(float(x) for x in RNG.uniform(0, limits[0], 2) * RNG.choice([0.0, 0.3, 1.0], 2))
        least = float(ramp_length(*ends, *limits[1:]))
        length = least * RNG.choice([1.0, 1.001, 1.3, 5.0, 100.0]) + RNG.choice([1e-6, 1.0])
        assert float(travel_time(length, *limits, ends)) == pytest.approx(_ruckig(length, limits, ends), rel=1e-6)


def test_a_profile_goes_where_it_should_within_its_limits() -> None:
    for _ in range(200):
        v, a, j = 10 ** RNG.uniform((0, 0, 1), (3, 4, 5))
        ends = tuple(float(x) for x in RNG.uniform(0, v, 2) * RNG.choice([0.0, 0.5, 1.0], 2))
        length = float(ramp_length(*ends, a, j) * RNG.choice([1.0, 1.2, 10.0]) + RNG.choice([0.0, 3.0]))
        found = profile(length, v, a, j, ends)
        states = found.at(np.linspace(0, found.duration, 400))
        assert states[0, :3].tolist() == [0, ends[0], 0]
        assert states[-1, 0] == pytest.approx(length, rel=1e-9, abs=1e-9)
        assert states[-1, 1] == pytest.approx(ends[1], rel=1e-6, abs=1e-6 * v) and abs(states[-1, 2]) < 1e-6 * a
        assert states[:, 1].max() <= v * (1 + 1e-9) and states[:, 1].min() >= -1e-9 * v
        assert np.abs(states[:, 2]).max() <= a * (1 + 1e-9) and np.abs(states[:, 3]).max() <= j
        assert found.duration == pytest.approx(float(travel_time(length, v, a, j, ends)), rel=1e-12)


def test_no_length_takes_no_time() -> None:
    assert profile(0.0, 10.0, 10.0, 10.0).duration == 0
    assert profile(0.0, 10.0, 10.0, 10.0).at([0.0])[0, :3].tolist() == [0, 0, 0]
    assert profile(0.0, 10.0, 10.0, 10.0, (5.0, 5.0)).duration == 0
    assert profile(20.0, 10.0, 10.0, 10.0, (10.0, 10.0)).duration == pytest.approx(2.0)


def test_reachable_is_the_inverse_of_the_ramp() -> None:
    for start, gain, a, j in product((0.0, 1e-6, 3.0, 400.0), (1e-9, 1e-3, 5.0, 300.0), (2.0, 500.0), (10.0, 1e5)):
        length = ramp_length(start, start + gain, a, j)
        assert float(reachable(start, length, a, j)) == pytest.approx(start + gain, rel=1e-9)
    assert reachable(5.0, 0.0, 10.0, 10.0) == 5.0


def test_the_seam_between_the_cases() -> None:
    """At the velocity gain a^2/j the hold vanishes; both branches agree there."""
    a, j = 30.0, 200.0
    length = float(ramp_length(0.0, a * a / j, a, j))
    near = [float(reachable(0.0, length * (1 + d), a, j)) for d in (-1e-9, 0.0, 1e-9)]
    assert near[2] - near[0] < 1e-7 * near[1] and near == sorted(near)


def test_arrays() -> None:
    lengths, ends = np.array([1.0, 10.0, 100.0]), (np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 2.0]))
    times = travel_time(lengths, 10.0, 100.0, 1000.0, ends)
    single = [float(travel_time(lengths[i], 10.0, 100.0, 1000.0, (ends[0][i], ends[1][i]))) for i in range(3)]
    assert np.allclose(times, single, rtol=1e-13)
    assert peak_velocity(lengths, 10.0, 100.0, 1000.0, ends).shape == (3,)


@pytest.mark.parametrize(("values", "said"), [
    ((1.0, 0.0, 1.0, 1.0), "velocity limit 0 is 0"), ((1.0, 1.0, -1.0, 1.0), "acceleration limit 0 is -1"),
    ((1.0, 1.0, 1.0, np.nan), "jerk limit 0 is nan"), ((-1.0, 1.0, 1.0, 1.0), "length is -1"),
    ((1.0, 1.0, 1.0, 1.0, (2.0, 0.0)), "between 0 and"), ((0.1, 9.0, 1.0, 1.0, (5.0, 0.0)), "takes"),
])
def test_bad_input(values: tuple[float, ...], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        profile(*values)  # type: ignore[arg-type]
