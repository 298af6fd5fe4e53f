"""Set-ups by predicted time against brute force over A and C, and time against the planner of single passes."""

from math import comb, radians

import numpy as np
import pytest

from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.limits import linear_bounds
from toolaxis.feed.polyline import schedule_polyline
from toolaxis.feed.velocity_ramps import bend_of, durations
from toolaxis.machine.kinematics import linear_coordinates
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.search.fastest_setup import cutting_seconds, find_fastest_setup
from toolaxis.search.kinematic_setup import Domain, PassSegment, are_angles_allowed, find_setup, rotary_grid

MIKRON = Mounting(load_machine("mikron-ucp-710"))
MANTA = np.array([[0.0, 0, 100, 100], [0, 0, 100, 100], [100, 100, 0, 0], [100, 100, 0, 0]])


def _rules(count: int) -> tuple[PassSegment, ...]:
    """Rules of the paraboloid z = (y^2 - x^2)/500."""
    found = []
    for c in np.linspace(-97, 97, count):
        x = np.array([max(-50, -50 - c), min(50, 50 - c)])
        normals = np.stack([2 * x / 500, -2 * (x + c) / 500, np.ones(2)], axis=1)
        found.append(PassSegment(np.stack([x, x + c, ((x + c) ** 2 - x * x) / 500], axis=1),
                                 normals / np.linalg.norm(normals, axis=1, keepdims=True)))
    return tuple(found)


def _manta(count: int, points: int = 120) -> tuple[PassSegment, ...]:
    """Centres of a ball of radius 8 mm over the Manta, feed along y."""
    v = np.linspace(0, 1, points)

    def _basis(t: np.ndarray, degree: int) -> np.ndarray:
        return np.stack([comb(degree, i) * t**i * (1 - t) ** (degree - i) for i in range(degree + 1)], axis=-1)

    found = []
    for u in np.linspace(0.02, 0.98, count):
        across = _basis(np.array([u]), 3)[0]
        slope = 3 * _basis(np.array([u]), 2)[0] @ np.diff(MANTA, axis=0)
        z, zu = _basis(v, 3) @ (across @ MANTA), _basis(v, 3) @ slope
        zv = 3 * _basis(v, 2) @ np.diff(across @ MANTA)
        normals = np.stack([-zu / 600, -zv / 600, np.ones(points)], axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        found.append(PassSegment(np.stack([np.full(points, 600 * u), 600 * v, z], axis=1) + 8 * normals, normals))
    return tuple(found)


def _compared(passes: tuple[PassSegment, ...], feed: float, step: float) -> float:
    """The found set-up's time over the best on a grid."""
    feeds = Feeds(feed / 60, tolerance=0.01)
    grid = rotary_grid(MIKRON, radians(step))
    grid = grid[are_angles_allowed(MIKRON, grid, passes, Domain())]
    found, seconds = find_fastest_setup(MIKRON, passes, feeds)
    assert seconds == pytest.approx(float(cutting_seconds(MIKRON, passes, found.rotary, feeds)[0]), rel=1e-9)
    assert seconds <= cutting_seconds(MIKRON, passes, find_setup(MIKRON, passes).rotary, feeds)[0] * (1 + 1e-9)
    return seconds / float(cutting_seconds(MIKRON, passes, grid, feeds).min())


@pytest.mark.parametrize("feed", [5000.0, 30000.0])
def test_the_paraboloid_within_a_percent_of_one_degree(feed: float) -> None:
    assert _compared(_rules(16), feed, 1.0) < 1.002


def test_the_manta_within_a_percent_of_four_degrees() -> None:
    assert _compared(_manta(3), 30000.0, 4.0) < 1.002


@pytest.mark.long
@pytest.mark.parametrize("feed", [5000.0, 30000.0])
def test_the_manta_within_a_percent_of_one_degree(feed: float) -> None:
    assert _compared(_manta(5), feed, 1.0) < 1.002


def test_times_are_those_of_the_planners() -> None:
    rotary, feeds = np.radians([(30.0, 20.0), (-80.0, 45.0)]), Feeds(80.0, tolerance=0.01)
    bounds = linear_bounds(MIKRON.machine)
    for one, most in ((_rules(3)[0], 1e-9), (_manta(3)[1], 0.02)):
        found = cutting_seconds(MIKRON, (one,), rotary, feeds)
        for row, seconds in zip(rotary, found, strict=True):
            joints = linear_coordinates(MIKRON.machine, one.tips, row)
            if len(one.tips) > 5:
                known = durations(bend_of(joints, one.tips, 80.0, 3, 0.01), np.eye(3)[None], 80.0, bounds)[0]
            else:
                known = schedule_polyline(joints, one.tips, 80.0, bounds).duration
            assert seconds == pytest.approx(known, rel=most)


def test_the_domain_binds() -> None:
    passes, feeds = _rules(5), Feeds(500.0)
    free, narrow = (find_fastest_setup(MIKRON, passes, feeds, domain)[1] for domain in
                    (None, Domain((radians(-25), radians(25)), (radians(-25), radians(25)))))
    assert free < narrow < cutting_seconds(MIKRON, passes, (0.0, 0.0), feeds)[0] * (1 + 1e-9)
    nowhere, seconds = find_fastest_setup(MIKRON, (*passes, passes[0]._replace(normals=-passes[0].normals)), feeds)
    assert nowhere.outcome == "infeasible" and seconds == np.inf
