"""Axis motion at a constant speed against circles in closed form, and baselines of tool angles on smooth sections."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.axis_motion import axis_motion
from toolaxis.machine.library import load_machine
from toolaxis.strategies.blade.baselines import SmoothSection, by_quaternions, constant_angles
from toolaxis.strategies.blade.section import section

MACHINE = load_machine("four-axis-a")


def circle(radius=30.0, count=4001):
    """A tip on a circle about X, the axis along its normal: the table turns, the linear axes stand still."""
    t = np.linspace(0, 1.8 * np.pi, count)
    normal = np.column_stack([0 * t, np.cos(t), np.sin(t)])
    cl = radius * normal
    return ToolPath(cl, cl, normal, normal, np.zeros(count, dtype=np.int8), np.array([0, count])), radius * t


def test_a_table_that_turns_under_a_standing_tool():
    path, way = circle()
    found = axis_motion(MACHINE, path, way, 60.0)
    velocity, acceleration = found.peaks
    assert found.names == ("X", "Y", "Z", "A")
    np.testing.assert_allclose(velocity, [0, 0, 0, 2.0], atol=1e-6)
    np.testing.assert_allclose(acceleration, 0, atol=1e-3)


def test_linear_axes_go_around_where_the_axis_stands():
    path, way = circle()
    still = ToolPath(path.cc, path.cl, np.tile([0.0, 0.0, 1.0], (len(way), 1)), path.normal, path.kind, path.breaks)
    velocity, acceleration = axis_motion(MACHINE, still, way, 60.0).peaks
    np.testing.assert_allclose(velocity, [0, 60, 60, 0], atol=1e-2)
    np.testing.assert_allclose(acceleration, [0, 120, 120, 0], atol=0.1)


def test_wrong_places_and_speeds_are_named():
    path, way = circle(count=50)
    with pytest.raises(InvalidInput, match="one for each is needed"):
        axis_motion(MACHINE, path, way[::-1], 60.0)
    with pytest.raises(InvalidInput, match="above zero"):
        axis_motion(MACHINE, path, way, 0.0)


def test_baselines_follow_the_normal_of_an_ellipse():
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    one = section(np.column_stack([40 * np.cos(t), 12 * np.sin(t)]))
    smooth = SmoothSection(one)
    s = np.linspace(0, one.length, 1500)
    plain = constant_angles(smooth, s, 0.1)
    points = smooth.points(s)
    normal = np.arctan2(points[:, 1] / 12**2, points[:, 0] / 40**2)
    assert np.abs(np.angle(np.exp(1j * (plain - 0.1 - normal)))).max() < 1e-3
    assert plain[-1] - plain[0] == pytest.approx(2 * np.pi)
    few, many = by_quaternions(smooth, s, 12, 0.1), by_quaternions(smooth, s, 150, 0.1)
    assert np.abs(many - plain).max() < 0.02 < np.abs(few - plain).max()
    assert few[-1] - few[0] == pytest.approx(2 * np.pi, abs=1e-9)
    keys = np.arange(0, 1500 - 1, 1499 / 12).round().astype(int)
    assert np.abs(np.angle(np.exp(1j * (few - plain)))[keys[[0]]]).max() < 1e-6
