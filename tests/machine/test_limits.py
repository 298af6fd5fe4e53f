"""Axis limits against dense sets of allowed axes."""

from math import pi, radians

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.machine.limits import AllOf, Cone, RotaryRanges, format_limits, parse_limits
from toolaxis.numeric.vectors import angle_between, rotation, unit


def axes_of(tilt, turn):
    tilt, turn = np.asarray(tilt, dtype=float), np.asarray(turn, dtype=float)
    return np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1)


def random_axes(count, seed=0):
    return unit(np.random.default_rng(seed).normal(size=(count, 3)))


def test_cone_measures_the_angle_beyond_its_border():
    cone = parse_limits("cone:0,0,2,45")
    tilt = np.radians([0, 44.9, 45, 46, 180])
    assert cone.allowed(axes_of(tilt, tilt * 0)).tolist() == [True, True, True, False, False]
    np.testing.assert_allclose(cone.excess(axes_of(tilt, tilt * 0)), [0, 0, 0, radians(1), radians(135)], atol=1e-12)


@pytest.mark.parametrize("tilt, turn", [((0, 40), (-30, 100)), ((-20, 70), (0, 90)), ((30, 60), (170, 200)),
                                        ((-90, 90), (-10, 10)), ((10, 180), (-180, 180)), ((-50, -10), (20, 75))])
def test_rotary_excess_is_the_angle_to_the_nearest_allowed_axis(tilt, turn):
    ranges = RotaryRanges(tuple(np.radians(tilt)), tuple(np.radians(turn)))
    grid = np.stack(np.meshgrid(np.radians(np.arange(tilt[0], tilt[1] + 0.1, 0.5)),
                                np.radians(np.arange(turn[0], turn[1] + 0.1, 0.5))), axis=-1).reshape(-1, 2)
    every = axes_of(grid[:, 0], grid[:, 1])
    axes = random_axes(200)
    nearest = np.array([angle_between(axis, every).min() for axis in axes])
    np.testing.assert_allclose(ranges.excess(axes), nearest, atol=radians(0.4))
    assert (ranges.excess(axes) <= nearest + 1e-9).all()
    assert ranges.allowed(every).all()
    assert (ranges.allowed(axes) == (ranges.excess(axes) < 1e-8)).all()


def test_a_pair_with_negative_tilt_is_the_opposite_turn():
    ranges = parse_limits("rotary:tilt=-30..0,turn=0..0")
    assert ranges.allowed(axes_of(radians(20), pi)[None]).all()
    assert not ranges.allowed(axes_of(radians(20), 0.0)[None]).any()


def test_limits_turn_with_their_frame():
    turn = rotation([1, 2, 3], 1.1)
    still = RotaryRanges((0.1, 0.9), (-0.4, 1.2))
    turned = RotaryRanges((0.1, 0.9), (-0.4, 1.2), turn @ [0, 0, 1], turn @ [1, 0, 0])
    axes = random_axes(100)
    np.testing.assert_allclose(still.excess(axes), turned.excess(axes @ turn.T), atol=1e-12)


def test_excess_changes_no_faster_than_the_axis():
    ranges = parse_limits("rotary:tilt=5..50,turn=-40..80,z=1/0/1,x=0/1/0+cone:0,0,1,60")
    one, other = random_axes(400, 1), random_axes(400, 2)
    other = unit(one + 0.2 * other)
    assert (np.abs(ranges.excess(one) - ranges.excess(other)) <= angle_between(one, other) + 1e-9).all()


def test_joined_limits_hold_together():
    both = parse_limits("cone:0,0,1,45 + cone:1,0,1,45")
    assert isinstance(both, AllOf)
    assert both.allowed([[0, 0, 1], [1, 0, 1], [1, 0, 0], [-0.1, 0, 1]]).tolist() == [True, True, False, False]


@pytest.mark.parametrize("text", ["", "cone", "cone:0,0,1", "cone:0,0,1,x", "rotary:tilt=1", "rotary:tilt=1..2,c=3..4",
                                  "sphere:1", "rotary:tilt=1..2..3"])
def test_what_is_no_limit_is_refused_with_the_forms(text):
    with pytest.raises(InvalidInput, match="cone:X,Y,Z,DEG"):
        parse_limits(text)


@pytest.mark.parametrize("text, part", [
    ("cone:0,0,0,45", "direction"), ("cone:0,0,1,-4", "between 0 and pi"), ("rotary:tilt=50..40", "reversed"),
    ("rotary:tilt=-200..40", "within -pi to pi"), ("rotary:tilt=0..40,z=0/0/1,x=0/0/2", "along z")])
def test_impossible_limits_name_the_quantity(text, part):
    with pytest.raises(InvalidInput, match=part):
        parse_limits(text)


def test_a_cone_of_nothing_is_its_direction():
    cone = Cone(np.array([0.0, 1.0, 0.0]), 0.0)
    assert cone.allowed([[0, 1, 0], [0, 1, 1e-6]]).tolist() == [True, False]


@pytest.mark.parametrize("text", ["cone:0.6,0,0.8,37.5", "rotary:tilt=-5..110,turn=-30..275,z=0/0.6/0.8,x=1/0/0",
                                  "cone:0,0,1,60+rotary:tilt=0..50"])
def test_what_is_written_is_read_back(text: str) -> None:
    limits = parse_limits(text)
    again = parse_limits(format_limits(limits))
    axes = np.random.default_rng(0).normal(size=(500, 3))
    np.testing.assert_allclose(again.excess(axes), limits.excess(axes), atol=1e-12)
    assert format_limits(again) == format_limits(limits)
    assert format_limits(None) == ""
