"""Paths around blades that were made elsewhere: read, re-scheduled, written again."""

import numpy as np
import pytest
from benchmarks._blades import sections

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.post.apt import apt_text
from toolaxis.post.read_apt import read_apt
from toolaxis.strategies.blade.reschedule import reschedule_path, swing_of_path
from toolaxis.strategies.blade.schedule import SwivelAxis
from toolaxis.strategies.blade.section import section
from toolaxis.tools.tool import Tool

TOOL = Tool.ball(6, flute_length=20)
UP = SwivelAxis(np.array([0.0, 0.0, 1.0]))


def path(name="steam", turns=3.3, count=240, start=37, flip=False, lean=0.1):
    """A helix with the axis along the normal, entry and exit included, that begins anywhere."""
    rows = sections(name, 1, 3.0, count)[0]
    one = section(rows)
    k = (np.arange(int(turns * count)) + start) % count
    z = np.arange(len(k)) / count
    x, y = UP.plane
    theta = (one.ahead[:-1] + one.behind[:-1])[k] / 2 - np.pi / 2
    axis = SwivelAxis(UP.direction, lean).axes(theta)
    centre = one.points[k][:, :1] * x + one.points[k][:, 1:] * y + z[:, None] * UP.direction
    if flip:
        axis, centre = axis[::-1], centre[::-1]
    axis = np.concatenate([axis[:1], axis[:1], axis, axis[-1:]])
    centre = np.concatenate([centre[:1] + 9 * axis[:1], centre[:1], centre, centre[-1:] + 9 * axis[-1:]])
    kind = np.full(len(axis), Motion.CUT, dtype=np.int8)
    kind[[0, 1, -1]] = Motion.LINK, Motion.ENTRY, Motion.EXIT
    tips = centre - 3.0 * axis
    return ToolPath(tips, tips, axis, axis, kind, np.array([0, len(axis)]))


@pytest.mark.parametrize("curve", ["least", "keys"])
@pytest.mark.parametrize("flip", [False, True])
def test_a_helix_from_elsewhere_swings_without_turning_back(curve, flip):
    old = path(flip=flip)
    made = reschedule_path(old, TOOL, curve=curve)
    new, swing = made.path, made.swing
    np.testing.assert_allclose(new.cl + 3 * new.axis, old.cl + 3 * old.axis, atol=1e-9)
    np.testing.assert_allclose(new.axis @ UP.direction, np.sin(0.1), atol=1e-9)
    cut = new.kind == Motion.CUT
    angle = swing.angles(new.axis[cut])
    step = np.diff(angle) * np.sign(angle[-1] - angle[0])
    assert step.min() > -1e-9 and abs(angle[-1] - angle[0]) > 3 * 2 * np.pi - 2.5
    assert step.max() < np.radians(12) and len(made.layers) in (2, 3)
    assert (np.diff(swing.angles(old.axis[cut])) * np.sign(angle[-1] - angle[0])).min() < -1e-3
    np.testing.assert_array_equal(new.kind, old.kind)
    assert (new.axis[0] == new.axis[2]).all() and (new.axis[-1] == new.axis[-2]).all()


def test_what_lies_before_the_first_base_point_follows_smoothly():
    made = reschedule_path(path(turns=3.6, start=120), TOOL)
    cut = made.path.kind == Motion.CUT
    angle = made.swing.angles(made.path.axis[cut])
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff((made.path.cl + 3 * made.path.axis)[cut], axis=0),
                                                        axis=1))])
    slope = np.gradient(angle, way)
    assert np.abs(np.diff(slope)).max() < 0.15 * np.abs(slope).max()


def test_a_file_is_read_rescheduled_and_written_again():
    old = path(lean=0.0)
    read = read_apt(apt_text(old, TOOL, "blade", 1000.0, 8000.0)).path
    made = reschedule_path(read, TOOL)
    again = read_apt(apt_text(made.path, TOOL, "blade", 1000.0, 8000.0)).path
    np.testing.assert_allclose(again.cl, made.path.cl, atol=2e-6)
    assert np.degrees(np.abs(np.diff(made.swing.angles(made.path.axis)))).max() < 15


def test_the_rotary_axis_is_found():
    found = swing_of_path(path(lean=-0.2))
    assert abs(found.direction[2]) == pytest.approx(1) and abs(found.lean) == pytest.approx(0.2)


def changed(**more):
    old = path(**more)
    return lambda axis: ToolPath(old.cl, old.cl, axis(old.axis), axis(old.axis), old.kind, old.breaks)


@pytest.mark.parametrize("made, words", [
    (changed()(lambda axis: np.tile([0.0, 0.0, 1.0], (len(axis), 1))), "tells no tool axes that move"),
    (changed()(lambda axis: np.array([(a + 0.3 * np.sin(k / 9) * np.array([0, 0, 1.0]))
                                      / np.linalg.norm(a + 0.3 * np.sin(k / 9) * np.array([0, 0, 1.0]))
                                      for k, a in enumerate(axis)])), "leave their common cone"),
    (path(turns=0.6), "its section is open")])
def test_cl_data_that_is_none_of_four_axis_milling_is_named(made, words):
    with pytest.raises(InvalidInput, match=words):
        reschedule_path(made, TOOL)


def test_a_bull_nose_is_refused():
    with pytest.raises(InvalidInput, match="no ball end"):
        reschedule_path(path(), Tool.torus(6, 1))
