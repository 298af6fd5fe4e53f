"""4+1 axes through plan, folder, judge and post."""

import re

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.plan.plan import Plan

TOOL, MACHINE = "torus:12x1", "mikron-ucp-710"


def _face() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 36, 5), np.linspace(0, 22, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.012 * (x - 18) ** 2 - 0.012 * (y - 11) ** 2], axis=-1))


@pytest.fixture(scope="module")
def plan() -> Plan:
    return ta.plan(_face(), TOOL, 0.1, strategy="four-plus-one", machine=MACHINE, workers=1)


def test_the_judge_passes_it_and_the_machine_times_it(plan) -> None:
    op = plan.operations[0]
    assert plan.outcome == "complete" and op.orientation.lead is not None and "clamped at" in op.orientation.reasons[0]
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    assert plan.timed and op.time.cut > op.orientation.length / (plan.inputs.feedrate / 60)


def test_its_program_holds_one_rotary_axis_still(plan, tmp_path) -> None:
    write_plan(plan, tmp_path)
    again = read_plan(tmp_path)
    assert again.inputs.method == "four-plus-one"
    text = next(text for file, text in post_plan(again, "fanuc", again.machine).items() if file.startswith("program"))
    blocks = [line for line in text.splitlines() if line.startswith("G1 X")]
    spans = [np.ptp([float(found[1]) for found in (re.search(rf"{name}(-?[\d.]+)", line) for line in blocks) if found])
             for name in "AC"]
    assert min(spans) <= 0.02 and max(spans) > 3.0


def test_a_machine_is_needed() -> None:
    with pytest.raises(ta.InvalidInput, match="name a machine"):
        ta.plan(_face(), TOOL, 0.1, strategy="four-plus-one")
    with pytest.raises(ta.InvalidInput, match="needs two driven rotary axes"):
        ta.plan(_face(), TOOL, 0.1, strategy="four-plus-one", machine="three-axes-fixture")
