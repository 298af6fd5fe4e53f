"""Feeds with a moving axis: one continuous solution of the machine, and no axis beyond its limits."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import OFF, following
from toolaxis.feed.fixed_axis_time import Feeds, machining_time
from toolaxis.feed.moving_axis_time import FiveAxisSchedule, axis_bounds, five_axis_time, turns
from toolaxis.machine.kinematics import forward, tool_axes
from toolaxis.machine.library import load_machine
from toolaxis.numeric.vectors import angle_between, unit

FEEDS = Feeds(50.0, crossing=150.0, tolerance=0.002, smooth=True)
MIKRON = load_machine("mikron-ucp-710")


def _path(beside_deg: float = 5.0, swing_deg: float = 30.0, points: int = 120) -> ToolPath:
    """A wavy pass along x whose axis swings in x and passes the pole at an angle, with ramps and a turning link."""
    s = np.linspace(0, 1, points)
    cut = np.column_stack([60 * s, 3 * np.sin(5 * s), 4 * np.cos(7 * s)])
    lean = np.radians(swing_deg) * np.cos(np.pi * s)
    axes = unit(np.column_stack([np.tan(lean), np.full(points, np.tan(np.radians(beside_deg))), np.ones(points)]))
    first, last = axes[:1], axes[-1:]
    tips = np.concatenate([cut[:1] + 20 * first, cut[:1] + 2 * first, cut, cut[-1:] + 20 * last, cut[:1] + 20 * first])
    axis = np.concatenate([first, first, axes, last, first])
    kind = np.array([3, 3, 1] + [0] * (points - 1) + [3, 3], dtype=np.int8)
    return ToolPath(tips, tips, axis, axis, kind, np.array([0, len(tips)]))


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "head-head-portal",
                                  "nutating-head"])
@pytest.mark.parametrize("beside_deg", [8.0, 0.3, 0.0])
def test_axes_follow_without_jumps_and_evenly_between_points(name: str, beside_deg: float) -> None:
    machine, path = load_machine(name), _path(beside_deg)
    place = np.array([30.0, -20.0, 40.0])
    along = following(machine, path, place, 120.0)
    tips, axes = forward(machine, np.hstack([along.linear, along.rotary]), 120.0, place)
    assert np.abs(tips - along.tips).max() < 1e-9 and np.abs(axes - along.axes).max() < 1e-9
    middle = tool_axes(machine, (along.rotary[1:] + along.rotary[:-1]) / 2)
    assert angle_between(middle, unit(along.axes[1:] + along.axes[:-1])).max() <= OFF
    for k, point in enumerate(path.cl):
        assert np.abs(along.tips[along.arrival == k] - point).sum(axis=1).min() == 0
    assert np.abs(np.diff(along.rotary, axis=0)).max() < np.pi / 2


def test_beside_the_pole_the_turning_axis_swings_and_through_it_stands_still() -> None:
    beside = following(MIKRON, _path(0.3)).rotary[:, 0]
    through = following(MIKRON, _path(0.0)).rotary[:, 0]
    assert np.degrees(np.ptp(beside)) > 170 and np.degrees(np.ptp(through)) < 1e-6
    assert len(beside) > 1.2 * len(_path().cl)


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "head-head-portal"])
@pytest.mark.parametrize("beside_deg", [8.0, 1.0])
def test_no_axis_exceeds_a_limit_by_finite_differences(name: str, beside_deg: float) -> None:
    machine = load_machine(name)
    plan = FiveAxisSchedule(machine, _path(beside_deg), FEEDS, np.array([30.0, -20.0, 40.0]), 120.0)
    bounds, scale = axis_bounds(machine), np.concatenate([np.ones(3), plan.levers])
    moving = [one for one in plan.stretches() if one.turning]
    assert {one.kind for one in moving} == {Motion.CUT, Motion.LINK}
    for one in moving:
        found = plan.curve(one)
        t = np.linspace(0, found.duration, 4001)
        q = found.at(t)[0] / scale
        for order, limit in ((1, bounds.velocity), (2, bounds.acceleration), (3, bounds.jerk)):
            step = t[1] - t[0]
            difference = np.abs(np.diff(q, order, axis=0)) / step**order
            assert (difference.max(axis=0) <= limit * 1.01).all()
        rows = slice(one.begin, one.end + 1)
        ends = np.hstack([plan.along.linear[rows], plan.along.rotary[rows]])[[0, -1]]
        assert np.allclose(q[[0, -1]], ends, atol=1e-5)


def test_the_tip_keeps_to_the_path_and_to_its_feed() -> None:
    plan = FiveAxisSchedule(MIKRON, _path(8.0), FEEDS)
    cut = next(one for one in plan.stretches() if one.kind == Motion.CUT)
    found, scale = plan.curve(cut), np.concatenate([np.ones(3), plan.levers])
    t = np.linspace(0, found.duration, 3000)
    tips, axes = forward(MIKRON, found.at(t)[0] / scale)
    assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() / (t[1] - t[0]) <= 50.0 * 1.002
    points, path_axes = plan.along.tips[cut.begin:cut.end + 1], plan.along.axes[cut.begin:cut.end + 1]
    off, lean = [], []
    for tip, axis in zip(tips[::50], axes[::50], strict=True):
        line = np.diff(points, axis=0)
        share = np.clip(((tip - points[:-1]) * line).sum(axis=1) / (line**2).sum(axis=1), 0, 1)
        away = np.linalg.norm(tip - points[:-1] - share[:, None] * line, axis=1)
        k = int(np.argmin(away))
        off.append(away[k])
        lean.append(angle_between(axis, unit((1 - share[k]) * path_axes[k] + share[k] * path_axes[k + 1])))
    assert max(off) < 0.012  # the points are 0.5 mm apart on a curve, the chords between them miss it by 0.01 mm
    assert max(lean) < 1e-3


def test_a_still_axis_takes_about_as_long_as_planned_for_fixed_axes() -> None:
    path = _path(8.0)
    fixed = replace(path, axis=np.tile(path.axis[0], (len(path.axis), 1)))
    assert turns(path) and not turns(fixed)
    taken, begin, end = five_axis_time(MIKRON, fixed, FEEDS)
    known = machining_time(MIKRON, fixed, FEEDS)
    assert np.array_equal(begin, end)
    assert taken.cut == pytest.approx(known.cut, rel=0.15) and taken.cut <= known.cut
    assert taken.entry == pytest.approx(known.entry, rel=0.05)


def test_weaker_rotary_axes_take_longer_and_a_moving_axis_longer_than_a_fixed_one() -> None:
    def _weaker(share: float) -> float:
        table = tuple(replace(axis, drive=replace(axis.drive, velocity=share * axis.drive.velocity,
                                                  acceleration=share * axis.drive.acceleration,
                                                  jerk=share * axis.drive.jerk)) for axis in MIKRON.table)
        return five_axis_time(replace(MIKRON, table=table), _path(5.0), FEEDS)[0].cut

    strong, weak, weakest = (_weaker(share) for share in (1.0, 0.3, 0.1))
    assert strong < weak < weakest


def test_what_cannot_be_followed_is_refused_in_a_sentence() -> None:
    short = replace(MIKRON, table=tuple(replace(axis, low=-np.radians(40), high=np.radians(40))
                                        for axis in MIKRON.table))
    with pytest.raises(InvalidInput, match=r"rotary axes of .* cannot follow|no position of"):
        following(short, _path(5.0, 60.0))
    with pytest.raises(InvalidInput, match=r"set by hand|no position of|cannot follow"):
        five_axis_time(load_machine("three-axes-fixture"), _path(5.0), FEEDS)
    with pytest.raises(InvalidInput, match="leave its travel"):
        following(MIKRON, _path(5.0), np.array([0.0, 0.0, 5000.0]), 100.0, travel=True)
