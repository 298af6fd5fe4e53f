"""Pictures of kinematics: what they say is what the machine does."""

import numpy as np
import pytest

from toolaxis.feed.limits import linear_bounds
from toolaxis.feed.time_optimal import schedule_near
from toolaxis.machine.feed_polytopes import Level, along
from toolaxis.machine.kinematics import linear_coordinates
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.report.figures.kinematics import feed_figure, polytope_figure, reach_figure

MIKRON = Mounting(load_machine("mikron-ucp-710"))


def test_the_arrow_reaches_the_surface_of_the_box() -> None:
    setups = {"as drawn": (0.0, 0.0), "turned": np.radians((-9.7, 44.1))}
    made = polytope_figure(MIKRON, Level.JERK, (1, 1, 0), setups)
    assert len(made.axes) == 2
    for ax, rotary in zip(made.axes, setups.values(), strict=True):
        reach = along(MIKRON.machine, Level.JERK, (1, 1, 0), rotary)[0] / 1000
        x, y, z = np.array(ax.lines[-1].get_data_3d())
        assert np.hypot(np.hypot(x[1], y[1]), z[1]) == pytest.approx(reach)
        assert f"{reach:.2f} m/s³" in ax.get_title() and len(ax.lines) == 13
    made.canvas.draw()


def test_the_map_goes_from_two_axes_to_three() -> None:
    made = reach_figure(MIKRON, Level.JERK)
    values = made.axes[0].collections[0].get_array()
    assert values.min() == pytest.approx(5 * np.sqrt(2)) and values.max() == pytest.approx(5 * np.sqrt(3))
    made.canvas.draw()


def test_the_feed_rises_from_rest_and_falls_to_rest() -> None:
    tips = np.linspace(0, 1, 40)[:, None] * (30.0, 30.0, 0.0)
    bounds = linear_bounds(MIKRON.machine)
    found = {name: schedule_near(linear_coordinates(MIKRON.machine, tips, rotary), 300.0, bounds, 1e-3)
             for name, rotary in (("a", (0.0, 0.0)), ("b", np.radians((-9.7, 44.1))))}
    ax = feed_figure(found, 300.0).axes[0]
    for line, one in zip(ax.lines, found.values(), strict=False):
        places, speeds = line.get_data()
        assert np.abs(speeds[[0, -1]]).max() < 1e-9 and 0 < speeds.max() <= 18.0 * (1 + 1e-9)
        assert places[-1] == pytest.approx(30 * np.sqrt(2)) and f"{one.duration:.3f} s" in line.get_label()
    assert ax.lines[1].get_data()[1].max() > ax.lines[0].get_data()[1].max()
