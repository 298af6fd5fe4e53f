"""Polytopes of velocity, acceleration and jerk: the paper's numbers, and brute force."""

import numpy as np
import pytest
from scipy.optimize import linprog

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.machine.axis import LinearAxis
from toolaxis.machine.feed_polytopes import (
    Level,
    alignments,
    along,
    best_along,
    best_angles,
    box,
    pole_zone,
    preferred_direction,
)
from toolaxis.machine.kinematics import part_from_machine
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.numeric.polytopes import box_vertices, halfspaces, reach

MIKRON = load_machine("mikron-ucp-710")
DIAGONAL = np.ones(3) / np.sqrt(3)


def _degrees(angles: np.ndarray) -> set[tuple[float, float]]:
    """Pairs (A, C) in degrees, within -180 to 180."""
    return {(round(a, 4) + 0.0, round(c, 4) + 0.0) for c, a in np.degrees(angles.reshape(-1, 2))}


def _longest(level: Level, feed: np.ndarray, rotary: np.ndarray) -> float:
    """The longest multiple of the feed that the axes allow, by linear programming."""
    matrix, limits = part_from_machine(MIKRON, rotary)[0], box(MIKRON, level)
    found = linprog([0, 0, 0, -1], A_eq=np.column_stack([matrix, -feed]), b_eq=np.zeros(3),
                    bounds=[*((-limit, limit) for limit in limits), (0, None)])
    return float(found.x[3])


def test_table_2() -> None:
    printed = {Level.VELOCITY: (0.8660, 3.6373, 8.6603), Level.ACCELERATION: (0.7390, 4.4340, 7.3899),
               Level.JERK: (0.8660, 3.6373, 8.6603)}
    for level, row in printed.items():
        assert np.allclose(preferred_direction(MIKRON, level)[1] / 1000, row, atol=5.1e-5)


def test_the_diagonal_feed_has_its_two_trivial_solutions() -> None:
    found = alignments(MIKRON, Level.JERK, DIAGONAL)
    assert found.reached.all() and found.corners[0].min() > 0
    assert _degrees(found.angles[0, 0]) == {(0, 0), (90, 90)}
    assert found.angles.reshape(-1, 2).shape == (16, 2)


def test_the_feed_along_x() -> None:
    pairs = _degrees(alignments(MIKRON, Level.JERK, (1, 0, 0)).angles)
    assert {a for a, _ in pairs} == {45, -45, 135, -135}
    assert {c for _, c in pairs} == {54.7356, -54.7356, 125.2644, -125.2644} and len(pairs) == 16


def test_the_feed_along_z_meets_no_corner() -> None:
    found = alignments(MIKRON, Level.JERK, (0, 0, 1))
    assert not found.reached.any() and found.free.all()
    assert best_along(MIKRON, Level.JERK, (0, 0, 1))[0] / 1000 == pytest.approx(np.sqrt(50), abs=1e-12)
    angles = best_angles(MIKRON, Level.JERK, (0, 0, 1))
    assert {a for a, _ in _degrees(angles)} == {45, 135, -45, -135}
    for turn in (0.0, 1.0, 2.0):  # any C
        assert np.allclose(along(MIKRON, Level.JERK, np.tile((0, 0, 1), (len(angles), 1)),
                                 np.column_stack([np.full(len(angles), turn), angles[:, 1]])), 5000 * np.sqrt(2))


def test_where_the_pole_zones_begin() -> None:
    assert np.cos(pole_zone(MIKRON, Level.JERK)) == pytest.approx(np.sqrt(2 / 3), abs=1e-15)
    edge = pole_zone(MIKRON, Level.JERK)
    feeds = [(np.sin(edge + d), 0, np.cos(edge + d)) for d in (-1e-6, 1e-6)]
    assert alignments(MIKRON, Level.JERK, feeds).reached.all(axis=1).tolist() == [False, True]
    assert np.abs(np.diff(best_along(MIKRON, Level.JERK, feeds)))[0] < 0.02  # the two branches meet


@pytest.mark.parametrize("level", list(Level))
def test_every_alignment_gives_the_corners_length(level: Level) -> None:
    """Eq. 21 bounds the best, and linear programming at the solved angles finds exactly it."""
    feeds = np.random.default_rng(3).normal(size=(30, 3))
    feeds /= np.linalg.norm(feeds, axis=1, keepdims=True)
    limits, best = box(MIKRON, level), best_along(MIKRON, level, feeds)
    assert (best <= np.linalg.norm(limits) + 1e-9).all() and (best >= np.linalg.norm(limits[1:]) - 1e-9).all()
    for feed, most in zip(feeds, best, strict=True):
        angles = best_angles(MIKRON, level, feed)
        assert len(angles) in (8, 16)
        assert np.abs(along(MIKRON, level, np.tile(feed, (len(angles), 1)), angles) - most).max() < 1e-6 * most
        assert _longest(level, feed, angles[0]) == pytest.approx(most, rel=1e-6)


def test_no_angles_give_more() -> None:
    rng, level = np.random.default_rng(4), Level.ACCELERATION
    turns = np.radians(np.arange(0, 360, 2.0))
    grid = np.stack(np.meshgrid(turns, turns), -1).reshape(-1, 2)
    for feed in [(0, 0.05, 1), *rng.normal(size=(4, 3))]:
        scanned = along(MIKRON, level, np.tile(feed, (len(grid), 1)), grid).max()
        most = best_along(MIKRON, level, feed)[0]
        assert 0.95 * most < scanned <= most * (1 + 1e-12)


def _rules(offsets: np.ndarray) -> np.ndarray:
    """Directions of the rules y = x + c of the paraboloid z = (y^2 - x^2)/500."""
    rows = np.stack([np.ones_like(offsets), np.ones_like(offsets), 2 * offsets / 500], axis=1)
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def test_the_hyperbolic_paraboloid() -> None:
    """The branch that starts at the corner +++ : what the paper prints as the jerk's is the acceleration's."""
    feeds = _rules(np.linspace(-99.5, 99.5, 400))
    spans = {}
    for level in (Level.JERK, Level.ACCELERATION):
        found = alignments(MIKRON, level, feeds)
        assert found.reached.all()
        turn, tilt = np.degrees(found.angles[..., 0]), np.degrees(found.angles[..., 1])
        inside = (tilt > 0) & (tilt < 90) & (np.abs(turn) < 15)
        spans[level] = (tilt[inside].max(), tilt[inside].min(), np.abs(turn[inside]).max(), np.abs(turn[inside]).min())
    assert np.allclose(spans[Level.JERK], (64.5, 25.5, 9.7, 8.1), atol=0.15)
    assert np.allclose(spans[Level.ACCELERATION], (54.2, 15.8, 10.7, 9.1), atol=0.15)


def test_the_manta_setup_is_an_alignment() -> None:
    """A = -45, C = 35.26 degrees, the smallest |A| + |C| for a feed along y."""
    pairs = _degrees(alignments(MIKRON, Level.JERK, (0, 1, 0)).angles)
    assert min(abs(a) + abs(c) for a, c in pairs) == pytest.approx(45 + 35.2644, abs=1e-3)
    assert (-45, 35.2644) in pairs


def test_boxes() -> None:
    corners = box_vertices((1.0, 2.0, 3.0))
    assert corners.shape == (8, 3) and corners[0].tolist() == [1, 2, 3]
    matrix = np.array([[1.0, 0.2, 0], [0, 1, 0.3], [0.1, 0, 1]])
    rows, ends = halfspaces((1.0, 2.0, 3.0), matrix)
    assert np.allclose((rows @ (matrix @ corners.T)).max(axis=1), ends)
    assert reach((1.0, 2.0), (1, 0))[0] == 1 and reach((1.0, 2.0), (0.6, 0.8))[0] == pytest.approx(1 / 0.6)


@pytest.mark.parametrize("bad", [(), (0.0, 1.0), (1.0, -1.0), (1.0, np.nan)])
def test_bad_boxes(bad: tuple[float, ...]) -> None:
    with pytest.raises(InvalidInput, match="each must be a finite number above zero"):
        box_vertices(bad)


def test_what_has_no_closed_form() -> None:
    with pytest.raises(InvalidInput, match="regular 2 x 2 matrix"):
        halfspaces((1.0, 1.0), np.zeros((2, 2)))
    with pytest.raises(UnsupportedGeometry, match="kind head-table"):
        alignments(load_machine("dmg-dmu-60t"), Level.JERK, (1, 0, 0))
    skew = (MIKRON.linear[0], LinearAxis("Y", np.array([0.1, 1, 0]), MIKRON.linear[1].drive), MIKRON.linear[2])
    with pytest.raises(UnsupportedGeometry, match="not at right angles"):
        best_along(Machine("skew", skew, MIKRON.table), Level.JERK, (1, 0, 0))
    with pytest.raises(InvalidInput, match="2 feed directions"):
        best_angles(MIKRON, Level.JERK, np.eye(3)[:2])
