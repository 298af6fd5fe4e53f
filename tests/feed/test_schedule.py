"""Machining time of whole paths, with links and index moves."""

import json
from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feed.fixed_axis_time import Feeds, index_time, machining_time, path_schedule
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.machine.freecad_machine import machine_from_fcm
from toolaxis.machine.kinematics import inverse
from toolaxis.machine.library import load_machine
from toolaxis.plan.timing import MachiningTime

MIKRON = load_machine("mikron-ucp-710")
UP = np.array([0.0, 0.0, 1.0])


def _path(tips: np.ndarray, kinds: list[int], axis: np.ndarray = UP) -> ToolPath:
    axes = np.tile(axis / np.linalg.norm(axis), (len(tips), 1))
    return ToolPath(tips, tips, axes, axes, np.array(kinds, dtype=np.int8), np.array([0, len(tips)]))


def _rules(count: int) -> tuple[np.ndarray, list[int]]:
    """Zigzag along rules y = x + c of the paraboloid z = (y^2 - x^2)/500."""
    tips, kinds = [], []
    for k, c in enumerate(np.linspace(-60, 60, count)):
        x = np.array([max(-50, -50 - c), min(50, 50 - c)])[:: 1 if k % 2 == 0 else -1]
        tips += [(t, t + c, ((t + c) ** 2 - t * t) / 500) for t in x]
        kinds += [Motion.LINK, Motion.CUT]
    return np.array(tips), kinds


def test_one_straight_cut() -> None:
    tips = np.array([[0.0, 0, 0], [100, 0, 0]])
    found = machining_time(MIKRON, _path(tips, [3, 0]), Feeds(50.0))
    assert found.cut == pytest.approx(float(travel_time(100.0, 50.0, 2500.0, 5000.0)))
    assert found.total == found.cut


def test_kinds_add_up() -> None:
    tips = np.array([[0.0, 0, 30], [0, 0, 30], [0, 0, 0], [80, 0, 0], [80, 0, 30], [0, 20, 30]])
    path = _path(tips, [3, 3, 1, 0, 2, 3])
    found = machining_time(MIKRON, path, Feeds(50.0, 10.0))
    schedule, kinds = path_schedule(MIKRON, path, Feeds(50.0, 10.0))
    assert found.total == pytest.approx(schedule.duration) and kinds.tolist() == [1, 0, 2, 3]
    assert found.entry > 3 and found.exit > 3 and 1.6 < found.cut < 2.2 and found.link < 1.0
    assert (found + MachiningTime(index=2.0)).total == pytest.approx(found.total + 2)


def test_the_papers_orientation_of_the_paraboloid_saves_what_the_model_allows() -> None:
    """One orientation in the middle of the rules' alignments against A = C = 0, exact stops: below 6.5 %."""
    tips, kinds = _rules(12)
    feeds = Feeds(500.0, tolerance=0.0)
    basic = path_schedule(MIKRON, _path(tips, kinds), feeds, (0.0, 0.0))[0].segment_times[::2].sum()
    angles = np.radians((-9.3, 45.0))  # (C, A)
    aligned = path_schedule(MIKRON, _path(tips, kinds), feeds, angles)[0].segment_times[::2].sum()
    assert 0.03 < 1 - aligned / basic < 0.066


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "nutating-head",
                                  "head-head-portal", "ab-trunnion", "three-axes-fixture"])
def test_no_axis_exceeds_a_limit_on_any_machine(name: str) -> None:
    machine = load_machine(name)
    tips, kinds = _rules(8)
    axis = np.array([0.1, -0.2, 1.0])
    for tolerance in (0.0, 0.02):
        motion = path_schedule(machine, _path(tips, kinds, axis), Feeds(200.0, tolerance=tolerance))[0].motion()
        levels = np.array([each.drive.levels(each.name) for each in machine.linear])
        for k, size in enumerate(motion.extremes()):
            assert (size <= levels[:, k] * (1 + 1e-9)).all()
        axes = np.tile(axis, (len(tips), 1))
        travel = [inverse(machine, tips, axes).joints[:, branch, :3] for branch in range(2)]
        assert any(np.abs(motion.knots()[0][-1] - joints[-1]).max() < 1e-6 for joints in travel)


def test_a_slower_feed_takes_longer_and_more_jerk_less() -> None:
    tips, kinds = _rules(6)
    times = [machining_time(MIKRON, _path(tips, kinds), Feeds(feed)).total for feed in (20.0, 50.0, 100.0, 400.0)]
    assert times == sorted(times, reverse=True)


def test_moving_the_part_changes_nothing() -> None:
    tips, kinds = _rules(5)
    offset = np.array([100.0, -50.0, 20.0])
    here, there = (machining_time(MIKRON, _path(tips, kinds), Feeds(50.0), table_from_part=place).total
                   for place in (None, offset))
    assert there == pytest.approx(here, rel=1e-9)


def test_smooth_passes_are_followed_faster_than_their_chords() -> None:
    """A curved zigzag of many points: as curves its cuts take less, its links and straight cuts the same."""
    x = np.linspace(-40, 40, 120)
    tips, kinds = [], []
    for k in range(3):
        way = x[:: 1 if k % 2 == 0 else -1]
        tips.append(np.stack([way, np.full_like(x, 4.0 * k), 15 * np.cos(way / 20)], axis=1))
        kinds += [Motion.LINK, *[Motion.CUT] * (len(x) - 1)]
    path = _path(np.concatenate(tips), kinds)
    chords, curves = (machining_time(MIKRON, path, Feeds(80.0, smooth=smooth)) for smooth in (False, True))
    length = path.length(Motion.CUT)
    assert length / 80 < curves.cut < 0.7 * chords.cut and 0 < curves.link < 1.5
    straight = _path(*_rules(4))
    times = [machining_time(MIKRON, straight, Feeds(50.0, tolerance=0.0, smooth=way)).total for way in (False, True)]
    assert times[1] == pytest.approx(times[0], rel=1e-9)


def test_index_moves() -> None:
    """416 moves of about 0.094 deg at 0.119 s are what separates the paper's per-path strategy from one orientation."""
    assert index_time(MIKRON, (0, 0), (0, np.radians(0.094))) == pytest.approx(0.119, abs=5e-4)
    both = index_time(MIKRON, (0, 0), (2.0, 1.0))
    assert both == max(index_time(MIKRON, (0, 0), (2.0, 0.0)), index_time(MIKRON, (0, 0), (0.0, 1.0)))
    assert index_time(MIKRON, (1, 1), (1, 1)) == 0
    fixture = load_machine("three-axes-fixture")
    assert index_time(fixture, (0, 0), (1, 0), by_hand=90.0) == 90
    slow, free = MIKRON.table
    half = replace(MIKRON, table=(slow, replace(free, drive=None)))
    turn = index_time(MIKRON, (0, 0), (2.0, 0))
    assert index_time(half, (0, 0), (2.0, 1.0), by_hand=0.1) == turn > 0.1
    with pytest.raises(InvalidInput, match="axis C is set by hand"):
        index_time(fixture, (0, 0), (1, 0))
    with pytest.raises(InvalidInput, match="2 each are needed"):
        index_time(MIKRON, (0,), (1,))


def test_what_cannot_be_timed() -> None:
    tips, kinds = _rules(3)
    with pytest.raises(InvalidInput, match="outside its rotary limits"):
        machining_time(load_machine("ab-trunnion"), _path(tips, kinds, np.array([0.0, 1, 0.2])), Feeds(50.0))
    with pytest.raises(InvalidInput, match="no motion"):
        machining_time(MIKRON, _path(tips[[0, 0]], [3, 0]), Feeds(50.0))
    path = _path(tips, kinds)
    axes = path.axis.copy()
    axes[2] = (0.6, 0, 0.8)
    with pytest.raises(UnsupportedGeometry, match="axis varies"):
        machining_time(MIKRON, ToolPath(tips, tips, axes, axes, path.kind, path.breaks), Feeds(50.0))
    ways = zip("XYZ", np.eye(3).tolist(), strict=True)
    slides = {name: {"type": "linear", "joint": [[0, 0, 0], way]} for name, way in ways}
    unknown = machine_from_fcm(json.dumps({"machine": {"name": "m", "axes": slides}}))
    with pytest.raises(InvalidInput, match="axis X has no acceleration"):
        machining_time(unknown, path, Feeds(50.0))


@pytest.mark.parametrize("values", [(0.0,), (-1.0,), (np.nan,), (np.inf,), (1.0, 0.0), (1.0, 1.0, 0.0),
                                    (1.0, 1.0, 1.0, -1.0)])
def test_bad_feeds(values: tuple[float, ...]) -> None:
    with pytest.raises(InvalidInput, match="zero"):
        Feeds(*values)
