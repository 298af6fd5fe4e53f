"""Found: a wall whose ends lie flush with the sides of the floor forbade every axis, as if nothing were near it."""

import numpy as np
import pytest

import toolaxis as ta

cq = pytest.importorskip("cadquery")


def test_what_lies_at_a_wall_is_left_to_clean_up_though_the_cutter_meets_the_flush_side_there_too() -> None:
    outline = [(0, -10), (20, -10), (20, 12), (16, 12), (16, 0), (0, 0)]
    part = ta.load(cq.Workplane("XZ").polyline(outline).close().extrude(-14))
    floor = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(3, 3)).point[:, 2], 0))
    sides = part.neighbours(floor.number, "convex")
    assert any(np.ptp(part.faces[n - 1].box[:, 2]) > 20 for n in sides)
    found = ta.best_axis(floor, ta.Tool.torus(diameter=6, corner_radius=1, stickout=40), 0.2, "cone:-1,0,2,10",
                         part=part)
    assert found.outcome == "feasible", found.reasons
    assert 0 < found.unreached < 0.5
    assert found.clearance["cutter"] >= 0.1
