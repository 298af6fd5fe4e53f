"""The study behind the picture of estimate and count, and the pictures' files."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.output.pictures import draw_verdict
from toolaxis.job.output.verify import verify_plan
from toolaxis.plan.plan import Plan
from toolaxis.strategies.indexed.pictures import width_study


def test_estimate_and_count_stay_near_the_passes_made(small_plan: Plan) -> None:
    op = small_plan.operations[0]
    axis = np.array([np.sin(0.5), 0.0, np.cos(0.5)])
    study = width_study(op.face, small_plan.tools[0], axis, 0.01, "u", angles=4)  # a dozen passes and more
    assert len(study.angle) >= 3 and study.chosen == pytest.approx(0.5, abs=0.1)
    close = study.angle < np.radians(50)
    assert np.abs(study.count / study.made - 1)[close].max() < 0.005
    assert np.abs(study.estimate / study.made - 1)[close].max() < 0.02


def test_axes_that_leave_no_strip_are_left_out() -> None:
    x, y = np.meshgrid(np.linspace(0, 12, 4), np.linspace(0, 12, 4), indexing="ij")
    bowl = ta.Face.from_bspline(np.stack([x, y, 0.3 * (x - 6) ** 2], axis=-1))
    study = width_study(bowl, ta.Tool.torus(12, 1), [0.3, 0.0, 1.0], 0.02, "u", angles=3)
    assert np.isfinite(study.made).all() and (study.made > 0).all()


def test_a_verdict_is_drawn_per_operation(small_plan: Plan, tmp_path: Path) -> None:
    draw_verdict(small_plan, verify_plan(small_plan, spacing=1.0), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["op01-face1-verdict.png"]
