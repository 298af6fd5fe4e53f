"""Tool angles around a blade: sections, channels against brute force, curves by keys and of least acceleration."""

import numpy as np
import pytest
from benchmarks._blades import FAMILIES, even, offset, profile, sections

from toolaxis.errors import InvalidInput
from toolaxis.strategies.blade.angle_channel import AngleChannel, channel
from toolaxis.strategies.blade.key_points import best_rule, key_curve
from toolaxis.strategies.blade.minimum_acceleration import least_curve, least_peak
from toolaxis.strategies.blade.section import base_of, section
from toolaxis.tools.tool import Tool

TURN = 2 * np.pi
CLEAR = np.radians(1.0)


def circle(radius=20.0, count=360):
    t = np.linspace(0, TURN, count, endpoint=False)
    return radius * np.column_stack([np.cos(t), np.sin(t)])


def based(name, count=300, radius=4.0):
    made = section(sections(name, 1, radius, count)[0])
    return made.begun_at(base_of(made))


def ends_of(free):
    width = free.high[0] - free.low[0]
    return free.high[0] - 0.1 * width, free.high[0] - 0.1 * width + TURN


def hits(points, place, angle):
    """Whether rays from points of a polygon meet it anywhere else, by brute force."""
    a, b = points[:-1], points[1:]
    way = np.column_stack([np.cos(angle), np.sin(angle)])[:, None]
    p, edge = points[place][:, None], (b - a)[None]
    across = way[..., 0] * edge[..., 1] - way[..., 1] * edge[..., 0]
    off = a[None] - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (off[..., 0] * edge[..., 1] - off[..., 1] * edge[..., 0]) / across
        u = (off[..., 0] * way[..., 1] - off[..., 1] * way[..., 0]) / across
    return ((t > 1e-6) & (u > 0) & (u < 1)).any(axis=1)


def test_a_circle_leaves_half_a_turn_everywhere():
    made = channel(section(circle()))
    np.testing.assert_allclose(made.high - made.low, np.pi + np.radians(1.0), atol=1e-9)  # edges turn by one degree
    normal = np.arctan2(*circle().T[::-1])
    middle = (made.high + made.low)[:-1] / 2
    assert np.abs(np.cos(middle - normal) - 1).max() < 1e-3


@pytest.mark.parametrize("name", list(FAMILIES))
def test_no_rising_curve_in_the_channel_meets_the_section(name):
    one = based(name)
    free = channel(one).narrowed(CLEAR)
    rng = np.random.default_rng(5)
    place = np.arange(len(one.points) - 1)
    for _ in range(8):
        share = np.sort(rng.uniform(size=len(one.points)))
        rising = np.clip(np.maximum.accumulate(free.low + share * (free.high - free.low)), free.low, free.high)
        assert (np.diff(rising) >= -1e-12).all()
        assert not hits(one.points, place, rising[:-1]).any()


@pytest.mark.parametrize("name", ["turbine", "steam", "impulse"])
def test_just_outside_the_channel_no_rising_curve_is_free(name):
    one = based(name)
    made = channel(one)
    # a curve above the channel at one place is above the tangent at a later one, or would have to fall
    for k in range(0, len(one.points) - 1, 7):
        later = np.arange(k, len(one.points) - 1)
        angle = np.full(len(later), made.high[k] + np.radians(1.5))
        direction = one.ahead[later]
        assert (hits(one.points, later, angle) | (angle > direction)).any()


def test_the_printed_rule_is_unsafe_before_a_hollow_and_ours_is_not():
    one = based("impulse")
    before = np.flatnonzero((one.ahead[:-1] - channel(one).high[:-1]) > np.radians(5))
    assert hits(one.points, before, one.ahead[before] - np.radians(2)).any()
    assert not hits(one.points, before, channel(one).high[before] - CLEAR).any()


def test_a_taper_takes_its_angle_off_both_sides():
    one = based("steam")
    plain, tapered = channel(one), channel(one, Tool.tapered(8, 4, 5, flute_length=400))
    np.testing.assert_allclose(plain.high - tapered.high, np.radians(5), atol=1e-12)
    np.testing.assert_allclose(tapered.low - plain.low, np.radians(5), atol=1e-12)


def test_a_holder_is_held_against_the_section_point_by_point():
    one = based("impulse")
    tool = Tool.ball(8, flute_length=20, stickout=30, shank=[(4, 0), (4, 30)], holder=[(15, 0), (15, 60)])
    made = channel(one, tool)
    plain = channel(one)
    assert (plain.high - made.high).max() > np.radians(3)
    way = (one.ahead + one.behind) / 2
    blade = one.points + 4.0 * np.column_stack([-np.sin(way), np.cos(way)])
    for sides in (made.narrowed(CLEAR).low, made.narrowed(CLEAR).high):
        for k in range(0, len(blade) - 1, 5):
            axis = np.array([np.cos(sides[k]), np.sin(sides[k])])
            seen = blade - one.points[k]
            high, aside = seen @ axis + 4.0, np.abs(seen[:, 0] * axis[1] - seen[:, 1] * axis[0])
            inside = ((high > 30) & (high < 90) & (aside < 15)) | ((high > 4) & (high <= 30) & (aside < 4 - 1e-3))
            assert not inside.any()


def test_turning_and_moving_a_section_turns_its_channel():
    one = based("turbine")
    a = 0.7
    turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    other = section((one.points[:-1] @ turn) + [3.0, -8.0])
    made, moved = channel(one), channel(other)
    shift = (moved.high - made.high)
    assert np.ptp(shift) < 1e-9 and np.cos(shift[0] - a) == pytest.approx(1)


@pytest.mark.parametrize("name", list(FAMILIES))
def test_curves_rise_keep_to_the_channel_and_the_bound_is_below_them(name):
    one = based(name)
    free = channel(one).narrowed(CLEAR)
    start, end = ends_of(free)
    if name == "lens":
        start, end = start - 1.2, end - 1.2
    keyed = key_curve(free, start, end, best_rule(free, start, end))
    least = least_curve(free, start, end)
    bound = least_peak(free, start, end)
    x = np.linspace(0, one.length, 20001)
    for made in (keyed, least):
        theta, slope, bend = made.at(x)
        assert slope.min() > -1e-9 and (np.diff(theta) > -1e-9).all()
        assert theta[0] == pytest.approx(start) and theta[-1] == pytest.approx(end)
        assert slope[[0, -1]] == pytest.approx([0, 0], abs=1e-9) and bend[[0, -1]] == pytest.approx([0, 0], abs=1e-9)
        assert free.slack(one.lengths, made.at(one.lengths)[0]).min() > -1e-3
        np.testing.assert_allclose(np.gradient(slope, x)[2:-2], bend[2:-2], atol=0.03 * np.abs(bend).max())
        assert np.abs(bend).max() >= bound * (1 - 1e-6)
    assert np.abs(least.bend).max() <= np.abs(keyed.at(x)[2]).max() * 1.001
    assert not hits(one.points, np.arange(len(one.points) - 1), least.at(one.lengths)[0][:-1]).any()


def test_the_bound_of_a_wide_channel_is_that_of_full_acceleration_and_braking():
    s = np.linspace(0, 100.0, 401)
    free = AngleChannel(s, -np.full(401, 9.0), np.full(401, 9.0))
    assert least_peak(free, 0.0, 1.0, 401) == pytest.approx(4 / 100**2, rel=2e-2)
    assert least_peak(free, 0.0, 1.0, 401) <= 4 / 100**2 * (1 + 1e-9)
    made = least_curve(free, 0.0, 1.0, rise=1e-3)
    assert np.abs(made.bend).max() == pytest.approx(4 / 100**2, rel=0.05)


def test_key_points_are_needed_where_the_channel_bends():
    found = {}
    for name in FAMILIES:
        free = channel(based(name, radius=3.0)).narrowed(np.radians(2.0))
        start, end = ends_of(free)
        shift = 1.2 if name == "lens" else 0.0
        found[name] = len(key_curve(free, start - shift, end - shift, best_rule(free, start - shift, end - shift)).keys)
    assert sum(count > 0 for count in found.values()) >= 2, found


def test_the_base_lies_at_the_end_of_the_hollow():
    one = based("impulse")
    turn = np.diff(one.ahead)
    assert turn[:5].min() > 0 and turn[-8:].max() < 1e-9


def eight():
    t = np.linspace(0, TURN, 100, endpoint=False)
    return np.column_stack([np.sin(t), np.sin(2 * t)]) * 10


@pytest.mark.parametrize("points, words", [
    (circle()[:200], "is open: its ends are"), (eight() + 0.013 * np.arange(100)[:, None] / 100, "crosses itself"),
    (circle()[::60], "eight at least"), (np.full((20, 2), np.nan), "finite")])
def test_wrong_sections_are_named(points, words):
    with pytest.raises(InvalidInput, match=words):
        section(points)


def test_a_channel_that_closes_tells_where_and_by_how_much():
    one = based("impulse")
    width = channel(one).width
    with pytest.raises(InvalidInput, match=r"closes on layer 3 at S = .* mm: 2.00 deg are missing"):
        channel(one).narrowed(width / 2 + np.radians(1.0), "layer 3")


def test_a_cutter_larger_than_a_hollow_makes_the_section_cross_itself():
    rows = even(profile(np.radians(150), 8.0, 40.0, 1.0, 1200), 400)
    with pytest.raises(InvalidInput, match="crosses itself near"):
        section(offset(rows, 30.0))
