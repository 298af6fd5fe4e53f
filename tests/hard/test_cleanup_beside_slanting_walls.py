"""Found: what strips leave beside a wall was told from contacts alone; the judge found more left than the plan said."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.verify.task import VerificationTask as Judged
from toolaxis.verify.verdict import judge


def test_what_the_strips_leave_is_told() -> None:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 60, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.004 * (x - 30) ** 2 - 0.003 * (y - 30) ** 2], axis=-1))
    corners = np.array([[28.0, 29], [32, 29], [32, 31], [28, 31]])
    walls = tuple(ta.Face.from_bspline(np.array([[[*a, -5.0], [*a, 12.0]], [[*b, -5.0], [*b, 12.0]]]), degree=(1, 1))
                  for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
    tool = ta.Tool.torus(12, 1)
    found = evaluate_axis(face, tool, [0.2, 0, 0.98], 0.1, obstacles=walls, feed="u")
    assert found.outcome == "feasible", found.reasons
    job = task(face, tool, 0.1, obstacles=walls)
    path = job.made(found.axis, "u")
    zones = job.left_by(path)
    assert found.unreached == sum(zone.area for zone in zones) / face.area
    assert job.feasibility.unreached(found.axis) < found.unreached, "contacts alone tell it all: find another case"
    asked = Judged("op", path.cl, path.axis, path.kind, tool.profile, (face,), 0.1)
    assert 1 - judge(asked).share_within == pytest.approx(found.unreached, abs=5e-4)
    declared = tuple(face.trimmed(zone.loops) for zone in zones)
    seen = judge(replace(asked, left=declared))
    assert seen.passed and seen.share_within >= 0.9995, seen.reasons
