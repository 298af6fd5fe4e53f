"""Found: what passes leave in steps along a slanting wall was not told, and the judge found more left than the plan said."""

import numpy as np

import toolaxis as ta
from toolaxis.orient.indexed import task


def test_what_the_strips_leave_is_told() -> None:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 60, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.004 * (x - 30) ** 2 - 0.003 * (y - 30) ** 2], axis=-1))
    corners = np.array([[30.0, 20], [40, 31], [30, 42], [20, 31]])
    walls = tuple(ta.Face.from_bspline(np.array([[[*a, -5.0], [*a, 12.0]], [[*b, -5.0], [*b, 12.0]]]), degree=(1, 1))
                  for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
    plan = ta.plan(face, ta.Tool.torus(12, 1), 0.1, obstacles=list(walls), machine="cone:0,0,1,30")
    found = plan.operations[0].orientation
    assert found.outcome == "feasible", found.reasons
    job = task(face, plan.tool, 0.1, obstacles=walls)
    assert 0.05 < job.laid(found.axis, found.feed).uncut <= found.unreached + 1e-12
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
