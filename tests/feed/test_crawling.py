"""Where a tip crawls because its axes cannot follow: found at the place, and nowhere else."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.feed.feed_drop import LONG, SLOW
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.moving_axis_time import FiveAxisMotion, five_axis_motion
from toolaxis.machine.library import load_machine
from toolaxis.numeric.vectors import unit

MIKRON = load_machine("mikron-ucp-710")


def _made(jump_deg: float, feed: float = 50.0) -> FiveAxisMotion:
    """A pass along x, 60 mm long, on which the axis turns evenly, and at x = 30 suddenly."""
    x = np.arange(0.0, 60.0, 0.2)
    lean, side = np.radians(20 + 25 * x / 60 + np.where(x > 30, jump_deg, 0.0)), np.radians(30 * x / 60)
    axes = unit(np.column_stack([np.sin(lean) * np.cos(side), np.sin(lean) * np.sin(side), np.cos(lean)]))
    tips = np.column_stack([x, np.zeros(len(x)), 3 * np.cos(x / 20)])
    path = ToolPath(tips, tips, axes, axes, np.zeros(len(x), dtype=np.int8), np.array([0, len(x)]))
    return five_axis_motion(MIKRON, path, Feeds(feed, tolerance=0.01, smooth=True))


def test_an_even_turn_crawls_nowhere() -> None:
    for feed in (5.0, 50.0):
        made = _made(0.0, feed)
        assert made.crawl is None and made.time.cut < 1.2 * 60 / feed + 0.5


@pytest.mark.parametrize("jump_deg", [20.0, 60.0])
def test_a_jump_of_the_axis_is_found_where_it_is(jump_deg: float) -> None:
    found = _made(jump_deg).crawl
    assert found is not None and abs(found.place[0] - 30.0) < 3.0 and found.place[1] == 0.0
    assert LONG < found.seconds < 10.0 and 0.0 < found.way < SLOW * 50.0 * found.seconds
    # The axis alone takes as long: it turns by 90 degrees a second at most.
    assert _made(jump_deg).time.cut > _made(0.0).time.cut + np.radians(jump_deg) / (np.pi / 2)
