"""Found: a boss on the face forbade every axis: the shank was nearest to its top, which is far from the contacts."""

import numpy as np
import pytest

import toolaxis as ta

cq = pytest.importorskip("cadquery")


def test_what_lies_at_a_boss_is_left_to_clean_up_though_the_shank_is_nearest_to_its_top() -> None:
    part = ta.load(cq.Workplane().box(24, 20, 10).faces(">Z").workplane().circle(3).extrude(12))
    floor = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(4, 4)).point[:, 2], 5))
    found = ta.best_axis(floor, ta.Tool.ball(diameter=5, stickout=30), 0.2, "cone:0,0,1,4", part=part)
    assert found.outcome == "feasible", found.reasons
    assert 0 < found.unreached < 0.4
    assert found.clearance["shank"] >= 0.5
