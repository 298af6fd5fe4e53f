"""What the tool of an operation meets along its passes, against distances that can be counted."""

import numpy as np
import Part
import pytest
from FreeCAD import Vector
from freecad.toolaxis.document.passes import PassStations
from freecad.toolaxis.services.collisions import DEPTH, ShapeCopy
from freecad.toolaxis.services.path_collisions import bumps

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import Cancelled
from toolaxis.progress import NO_PROGRESS, Progress

TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=30, holder=[(10, 0), (10, 40)])
UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def copies():
    """A block with its top at z = 10, and a post beside it whose near side is at x = 12."""
    return [ShapeCopy(name, f"the {name}", Part.makeBox(*size, Vector(*corner)))
            for name, size, corner in (("Block", (40, 40, 10), (-20, -20, 0)), ("Post", (10, 10, 60), (12, -5, 0)))]


def path_of(tips, axis=UP):
    tips = np.array(tips, dtype=float)
    axes = np.tile(axis, (len(tips), 1)) if np.ndim(axis) == 1 else np.array(axis)
    return ToolPath(tips, tips, axes, axes, np.full(len(tips), Motion.CUT), np.array([0, len(tips)]))


def test_the_holder_meets_a_post_where_it_comes_near(copies):
    """The holder of 20 mm begins 30 mm above the tip: it reaches the post, 60 mm high, from x = 2 on."""
    x = np.arange(-15.0, 6.0)
    found = bumps(TOOL, path_of([(value, 0, 11) for value in x]), copies, NO_PROGRESS)
    one, = found.found
    assert found.checked == ("cutter", "shank", "holder"), "without its own, the shank is as thick as the cutter"
    assert x[one.first] == 3 and one.last == len(x) - 1
    assert one.text.startswith("the holder collides with face ") and one.text.endswith(" of the Post by 3.0 mm")
    assert found.at(one.first) is one and found.at(one.first - 1) is None


def test_a_motion_that_alone_runs_into_the_post(copies):
    found = bumps(TOOL, path_of([(-15, 0, 11), (-5, 0, 11), (5, 0, 11), (-5, 0, 11.5)]), copies, NO_PROGRESS)
    one, = found.found
    assert (one.first, one.last) == (2, 3) and one.text.endswith(" of the Post by 3.0 mm")
    alone, = bumps(TOOL, path_of([(-15, 0, 11), (-5, 0, 11), (4, 0, 11)]), copies, NO_PROGRESS).found
    assert (alone.first, alone.last) == (2, 2) and alone.text.endswith(" of the Post by 2.0 mm")


def test_the_cutter_may_touch_what_it_cuts(copies):
    lows = (10.0, 10 - 0.5 * DEPTH, 9.5, 10.0, 9.0)
    path = path_of([(3.0 * k - 15, -10, low) for k, low in enumerate(lows)])
    found = bumps(TOOL, path, copies, NO_PROGRESS)
    assert {k for one in found.found for k in range(one.first, one.last + 1)} == {2, 3, 4}
    assert all("the cutter collides with face" in one.text and "of the Block by" in one.text for one in found.found)
    assert not bumps(TOOL, path_of([(-15, -10, 10), (15, -10, 10)]), copies[:1], NO_PROGRESS).found


def test_where_the_axis_moves_the_points_count(copies):
    """Leaning towards the post by 20 degrees, the tool's holder is in it; leaning away it is not."""
    lean = np.radians(20)
    axes = [(np.sin(a), 0, np.cos(a)) for a in np.linspace(-lean, lean, 9)]
    found = bumps(TOOL, path_of([(0, 0, 11)] * 9, axes), copies, NO_PROGRESS)
    assert found.at(8) is not None and found.at(0) is None
    assert "the holder collides with" in found.at(8).text and "of the Post" in found.at(8).text


def test_looking_can_be_stopped(copies):
    with pytest.raises(Cancelled):
        bumps(TOOL, path_of([(0, 0, 11), (5, 0, 11)]), copies, Progress(cancelled=lambda: True))


def test_stations_know_their_motion(document, parts):
    thing = parts.block(document)
    operation, = parts.planned(document, (thing, parts.sculptured_name(thing)))
    stations = PassStations(next(one for one in operation.Group if one.TypeId == "Path::Feature"))
    for share in (0.0, 0.2, 0.5, 0.999, 1.0):
        k = stations.motion(share)
        assert stations.share(k - 1) <= share + 1e-9 and share <= stations.share(k) + 1e-9
        start, end, tip = stations.points[k - 1], stations.points[k], np.array(stations.at(share).Base)
        assert np.linalg.norm(tip - start) + np.linalg.norm(end - tip) == pytest.approx(np.linalg.norm(end - start))
