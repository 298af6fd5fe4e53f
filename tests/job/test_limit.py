"""A limit of work: counted, so that it ends a search at the same place on every run."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.distances import bounded, motions
from toolaxis.errors import InvalidInput
from toolaxis.plan.document import plan_document, plan_from
from toolaxis.plan.plan import Inputs, Plan
from toolaxis.shape.cells import forest
from toolaxis.work import UNIT, Budget, OutOfWork, limited, spend, up_to

TOOL = ta.Tool.torus(diameter=12, corner_radius=1, stickout=50, holder=[(10, 0), (10, 40)])


def sheet(shift: float = 0.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 24, 6), np.linspace(0, 16, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y + shift, np.sin(x / 9) * np.cos(y / 8)], axis=-1))


def planned(limit: float, **given: object) -> Plan:
    return ta.plan(sheet(), TOOL, 0.1, limit=limit, **given)


@pytest.fixture(scope="module")
def plans() -> dict[float, Plan]:
    return {limit: planned(limit) for limit in (1.0, 4000.0, 8000.0, 12_000.0, 1e6)}


def test_next_to_no_work_finds_nothing_and_says_so(plans: dict[float, Plan]) -> None:
    found = plans[1.0].operations[0].orientation
    assert found.axis is None and found.outcome == "not_found"
    assert found.reasons[0] == "not found within the limit of 1 thousand bounds (raise --limit)"
    assert plans[1.0].outcome == "incomplete"


def test_what_was_found_within_the_limit_is_proven(plans: dict[float, Plan]) -> None:
    ended = []
    for limit, plan in plans.items():
        found = plan.operations[0].orientation
        if found.axis is None:
            assert found.outcome == "not_found" and "within the limit" in found.reasons[0]
            continue
        assert found.outcome == "feasible" and found.gouge <= plan.inputs.tolerance.gouge
        assert found.clearance["holder"] >= 1.0
        words = f"no better one found within the limit of {limit:,.0f} thousand bounds (raise --limit)"
        ended += [limit] if words in found.reasons else []
    assert ended and 1e6 not in ended


def test_more_work_finds_nothing_worse(plans: dict[float, Plan]) -> None:
    """The counts decide; passes made differ from them by a share of a pass."""
    lengths = [plan.operations[0].orientation.length for plan in plans.values()
               if plan.operations[0].orientation.axis is not None]
    assert len(lengths) >= 2
    assert lengths[-1] <= 1.02 * min(lengths)


def test_the_limit_ends_at_the_same_place_on_every_run_and_for_any_number_of_workers() -> None:
    part = ta.Part.from_faces([sheet(), sheet(40.0)])
    one, two, again = (ta.plan(part, TOOL, 0.1, limit=8000.0, workers=workers) for workers in (1, 2, 1))
    for first, second, third in zip(one.operations, two.operations, again.operations, strict=True):
        for other in (second, third):
            assert first.orientation.reasons == other.orientation.reasons
            assert first.orientation.evaluations == other.orientation.evaluations
            np.testing.assert_array_equal(first.orientation.map.axes, other.orientation.map.axes)


@pytest.mark.parametrize("strategy", ["sturz", "two-point"])
def test_a_moving_axis_is_limited_too(strategy: str) -> None:
    found = planned(20.0, strategy=strategy).operations[0].orientation
    assert found.axis is None and found.outcome == "not_found"
    assert found.reasons == ("not found within the limit of 20 thousand bounds (raise --limit)",)


def test_bounds_are_charged_while_a_budget_is_there() -> None:
    cells, tips = forest((sheet(),)), np.tile([10.0, 8.0, 5.0], (50, 1))
    with limited(Budget(1e6)) as budget:
        found = bounded(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)
    assert budget.done >= found.looked.sum() / UNIT > 0
    done = budget.done
    bounded(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)
    assert budget.done == done
    with pytest.raises(OutOfWork, match="limit of 1 thousand bounds"), limited(Budget(1.0)):
        bounded(cells, TOOL, motions(tips, [0, 0, 1.0]), 1.0, 0.001)


def test_a_part_of_what_is_left_can_be_kept() -> None:
    with limited(Budget(10.0)) as budget:
        spend(2 * UNIT)
        with pytest.raises(OutOfWork), up_to(0.5):
            for _ in range(9):
                spend(UNIT)
        assert budget.done == 7
        spend(3 * UNIT)
        with pytest.raises(OutOfWork):
            spend(1)
    spend(1e9)  # nobody limits it
    with up_to(0.1):
        spend(1e9)


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), float("inf")])
def test_a_limit_is_a_finite_number_above_zero(limit: float) -> None:
    with pytest.raises(InvalidInput, match="limit is"):
        Inputs(0.1, limit=limit)


def test_a_plan_says_what_it_was_limited_to(plans: dict[float, Plan]) -> None:
    plan = plans[8000.0]
    document = plan_document(plan, {})
    assert document["inputs"]["limit"] == 8000.0
    del document["inputs"]["limit"]  # a plan of before
    assert plan_from(document, plan.part, plan.obstacles).inputs == replace(plan.inputs, limit=Inputs(0.1).limit)
