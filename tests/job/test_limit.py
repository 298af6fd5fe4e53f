"""A limit of work: counted, so that it ends a search at the same place on every run."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.cli.main import parser
from toolaxis.contact.clearance.queries import lower_bounds, motions
from toolaxis.errors import InvalidInput
from toolaxis.plan.document import plan_document, plan_from
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.work import LIMIT, UNIT, Budget, OutOfWork, allow, allow_proof, limit_work, spend, up_to

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TOOL = ta.Tool.torus(diameter=12, corner_radius=1, stickout=50, holder=[(10, 0), (10, 40)])


def sheet(shift: float = 0.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 24, 6), np.linspace(0, 16, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y + shift, np.sin(x / 9) * np.cos(y / 8)], axis=-1))


def none_found(limit: str) -> str:
    return f"no axis found within the work limit of {limit}: raise --limit, use a coarser scallop or another tool"


def planned(limit: float, **given: object) -> Plan:
    return ta.plan(sheet(), TOOL, 0.1, limit=limit, **given)


@pytest.fixture(scope="module")
def plans() -> dict[float, Plan]:
    return {limit: planned(limit) for limit in (1.0, 4000.0, 8000.0, 1e6)}


def test_next_to_no_work_finds_nothing_and_says_so(plans: dict[float, Plan]) -> None:
    found = plans[1.0].operations[0].orientation
    assert found.axis is None and found.outcome == "not_found"
    assert found.reasons[0] == none_found("1")
    assert plans[1.0].outcome == "incomplete"


def test_what_was_found_within_the_limit_is_proven(plans: dict[float, Plan]) -> None:
    ended = []
    for limit, plan in plans.items():
        found = plan.operations[0].orientation
        if found.axis is None:
            assert found.outcome == "not_found" and "within the work limit" in found.reasons[0]
            continue
        assert found.outcome == "feasible" and found.gouge <= plan.inputs.tolerance.gouge
        assert found.clearance["holder"] >= 1.0
        words = f"search stopped at the work limit of {limit:,.0f}: a better axis may exist (raise --limit)"
        ended += [limit] if words in found.reasons else []
    assert ended and 1e6 not in ended


def test_more_work_finds_nothing_worse(plans: dict[float, Plan]) -> None:
    """The counts decide; passes made differ from them by a share of a pass."""
    lengths = [plan.operations[0].orientation.length for plan in plans.values()
               if plan.operations[0].orientation.axis is not None]
    assert len(lengths) >= 2
    assert lengths[-1] <= 1.02 * min(lengths)


@pytest.mark.parametrize("limit", [pytest.param(500.0, marks=pytest.mark.long), 4000.0])
def test_the_limit_ends_at_the_same_place_on_every_run_and_for_any_number_of_workers(limit: float) -> None:
    part = ta.Part.from_faces([sheet(), sheet(40.0)])
    one, *others = (ta.plan(part, TOOL, 0.1, limit=limit, workers=workers) for workers in (1, 2, 1))
    for first, *same in zip(one.operations, *(plan.operations for plan in others), strict=True):
        assert any("work limit" in reason for reason in first.orientation.reasons)
        assert (first.path is None) == (limit == 500.0)
        for other in same:
            assert first.orientation.reasons == other.orientation.reasons
            assert first.orientation.evaluations == other.orientation.evaluations
            np.testing.assert_array_equal(first.orientation.map.axis, other.orientation.map.axis)
            if first.path is not None:
                np.testing.assert_array_equal(first.path.cl, other.path.cl)


def test_axis_and_passes_belong_together_wherever_the_limit_ends_the_search(plans: dict[float, Plan]) -> None:
    for plan in (planned(3000.0), plans[4000.0], planned(6000.0)):
        (op,) = plan.operations
        if op.path is not None:
            np.testing.assert_allclose(op.path.axis, np.broadcast_to(op.orientation.axis, op.path.axis.shape),
                                       atol=1e-12)
            assert op.orientation.passes == op.path.passes


@pytest.mark.parametrize("method", ["sectors", "jerk", "roman", "normal", "ball"])
def test_every_method_is_limited(method: str) -> None:
    found = planned(1.0, method=method, machine="mikron-ucp-710").operations[0].orientation
    assert found.axis is None and found.outcome == "not_found"
    assert found.reasons[0] == none_found("1")


def test_the_limit_stops_no_example_unless_asked_to() -> None:
    """A fifth of what is allowed is enough."""
    made = ta.plan(EXAMPLES / "trimmed.step", "ball:12", 0.05, limit=LIMIT / 5)
    assert made.outcome == "complete"
    assert not any("work limit" in reason for op in made.operations for reason in op.orientation.reasons)


@pytest.mark.parametrize("strategy", ["sturz", "two-point"])
def test_a_moving_axis_is_allowed_several_times_the_limit(strategy: str) -> None:
    found = planned(20.0, strategy=strategy).operations[0].orientation
    assert found.axis is None and found.outcome == "not_found"
    assert found.reasons == (none_found("20"),)


def test_bounds_are_charged_while_a_budget_is_there() -> None:
    cells, tips = forest((sheet(),)), np.tile([10.0, 8.0, 5.0], (50, 1))
    with limit_work(Budget(1e6)) as budget:
        found = lower_bounds(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)
    assert budget.done >= found.looked.sum() / UNIT > 0
    done = budget.done
    lower_bounds(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)
    assert budget.done == done
    with pytest.raises(OutOfWork, match="work limit of 1:"), limit_work(Budget(1.0)):
        lower_bounds(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)


def test_a_part_of_what_is_left_can_be_kept() -> None:
    with limit_work(Budget(10.0)) as budget:
        spend(2 * UNIT)
        with pytest.raises(OutOfWork), up_to(0.5):
            for _ in range(9):
                spend(UNIT)
        assert budget.done == 7  # one more than the six of half of what was left
        spend(3 * UNIT)
        with pytest.raises(OutOfWork):
            spend(1)
    spend(1e9)  # nobody limits it
    with up_to(0.1):
        spend(1e9)


def test_work_for_the_proof_is_kept_back_until_an_axis_is_found() -> None:
    with limit_work(Budget(10.0, 0.5, more=1.0)):
        spend(5 * UNIT)
        with pytest.raises(OutOfWork):
            spend(UNIT)
        allow_proof()
        spend(9 * UNIT)
        allow_proof()  # a second time there is nothing to be had
        with pytest.raises(OutOfWork):
            spend(UNIT)


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), float("inf")])
def test_a_limit_is_a_finite_number_above_zero(limit: float) -> None:
    with pytest.raises(InvalidInput, match="limit is"):
        PlanInputs(0.1, limit=limit)


def test_a_plan_says_what_it_was_limited_to(plans: dict[float, Plan]) -> None:
    plan = plans[8000.0]
    files = {"part": {"file": "part.step", "sha256": "0" * 64}, "obstacles": [], "operations": [None]}
    document = json.loads(json.dumps(plan_document(plan, files)))
    assert document["inputs"]["limit"] == 8000.0
    del document["inputs"]["limit"]  # a plan of before
    before = plan_from(document, plan.part, plan.obstacles, [None])
    assert before.inputs == replace(plan.inputs, limit=PlanInputs(0.1).limit)


def test_the_command_and_batches_take_a_limit(tmp_path: Path) -> None:
    read = parser().parse_args(["plan", "part.step", "--tool=ball:6", "--scallop=0.1", "--limit=123"])
    assert read.limit == 123.0
    (tmp_path / "part.step").write_text("ISO-10303-21;\n")
    jobs = [{"part": str(tmp_path / "part.step"), "tool": "ball:6", "scallop": 0.1, "limit": 123}]
    assert read_jobs(jobs)[0].spec.inputs.limit == 123.0


def test_further_work_is_allowed_to_what_was_found_and_ends_with_it():
    with limit_work(Budget(1.0)) as budget:
        allow(2 * UNIT)
        spend(2.5 * UNIT)
        assert budget.done == 2.5
        with pytest.raises(OutOfWork, match="work limit of 1:"):
            spend(UNIT)
    allow(UNIT)  # nobody limits anything here
