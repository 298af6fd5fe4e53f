"""Found: a boss with a fillet at its foot forbade every axis, for the cutter gouges the fillet beside the face."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.path.rest_material import may_stay, undercut

cq = pytest.importorskip("cadquery")


def test_what_lies_beside_a_fillet_is_left_to_clean_up() -> None:
    solid = (cq.Workplane().box(36, 30, 10).faces(">Z").workplane().circle(4).extrude(12)
             .edges(cq.selectors.BoxSelector((-5, -5, 4.5), (5, 5, 5.5))).fillet(2.0))
    part = ta.load(solid)
    floor = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(4, 4)).point[:, 2], 5))
    assert len(part.skin(floor.number)) > 1
    plan = ta.plan(part, ta.Tool.torus(diameter=8, corner_radius=0.5, stickout=30), 0.1, faces=[floor.number],
                   tolerance=0.002)
    (op,) = plan.operations
    assert op.done, op.orientation.reasons
    assert 0 < op.orientation.unreached < 0.4 and op.orientation.gouge <= 0.002
    at_walls = sum(zone.area for zone in op.zones if zone.at_wall)
    assert at_walls == pytest.approx(op.orientation.unreached * floor.area, rel=1e-9)
    assert undercut(op.zones) <= may_stay(op.zones, floor.area) < 0.01 * at_walls + 0.5
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    judged = verdict.operations[0]
    assert judged.declared / judged.area == pytest.approx(op.orientation.unreached, abs=4e-3)
    assert judged.share_within >= 0.999
