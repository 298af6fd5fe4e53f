"""Two-point contact through the doors: planned, written, read and judged; refused where it makes no sense."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.report.tables import plan_table
from toolaxis.shape.analytic import CylindricalSurface

H = 0.03


def trough(radius=40.0, half=0.2, hollow=True) -> ta.Face:
    return ta.Face(CylindricalSurface(radius, (-half, half), (0.0, 16.0)).nurbs(), flip=hollow)


@pytest.fixture(scope="module")
def plan():
    return ta.plan(trough(), "flat:20", H, strategy="two-point", allowance=0.1, workers=1, direction="climb")


def test_the_judge_passes_it(plan) -> None:
    op = plan.operations[0]
    assert plan.outcome == "complete" and plan.inputs.method == "two-point", op.orientation.reasons
    assert any(why.startswith("two contacts on") for why in op.orientation.reasons)
    lean = np.arccos(np.clip((op.path.axis * op.path.normal).sum(axis=1), -1, 1))[op.path.kind == 0]
    assert np.degrees(np.median(lean)) == pytest.approx(np.degrees(op.orientation.lead), abs=3.0)
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    assert verdict.operations[0].gouge_max < 0.002


def test_tables_do_not_say_that_it_is_checked_at_points(plan) -> None:
    shown = plan_table(plan)
    assert "moves, lead" in "".join(map(str, shown.columns[1].cells)) and "checked at points" not in str(shown.caption)


def test_it_is_read_back(plan, tmp_path) -> None:
    write_plan(plan, tmp_path)
    again = read_plan(tmp_path)
    before, after = plan.operations[0], again.operations[0]
    assert again.inputs.method == "two-point" and after.orientation.passes == before.path.passes
    np.testing.assert_allclose(after.path.axis, before.path.axis, atol=1e-8)


@pytest.mark.long
def test_a_convex_face_is_said_to_have_one_contact() -> None:
    made = ta.plan(trough(hollow=False), "flat:8", 0.1, strategy="two-point", workers=1)
    assert made.outcome == "complete", made.operations[0].orientation.reasons
    assert any(why.startswith("one contact: the surface is not concave") and "100.0 %" in why
               for why in made.operations[0].orientation.reasons)


@pytest.mark.parametrize("given, what", [({"tool": "ball:8"}, "no flat bottom"), ({"tool": "tapered:6x1x4"}, "no flat"),
                                         ({"objective": "time"}, "not time: leave out"),
                                         ({"method": "roman"}, "is for fixed axes"),
                                         ({"machine": "three-axes-fixture"},
                                          "'two-point' needs two driven rotary axes")])
def test_what_makes_no_sense_is_refused(given, what) -> None:
    asked = {"tool": "flat:20", "strategy": "two-point", **given}
    with pytest.raises(InvalidInput, match=what):
        ta.plan(trough(), asked.pop("tool"), H, workers=1, **asked)
