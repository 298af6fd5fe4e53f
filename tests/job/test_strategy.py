"""Strategies: a moving axis through plan, folder and judge, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.files.plan_folder import read_json, read_plan, write_plan
from toolaxis.job.planning.comparison import compare_methods
from toolaxis.job.planning.timing import add_times
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import standing
from toolaxis.report.tables import plan_table
from toolaxis.report.warnings import warnings_of
from toolaxis.strategies.registry import strategies, strategy_of, title_of

TOOL = "torus:12x1"


def _face() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 24, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.006 * (x - 20) ** 2 - 0.004 * (y - 12) ** 2], axis=-1))


@pytest.fixture(scope="module")
def plan() -> Plan:
    return ta.plan(_face(), TOOL, 0.05, strategy="sturz", workers=1, tolerance=0.002)


def test_the_judge_passes_a_constant_lead(plan) -> None:
    op = plan.operations[0]
    assert plan.outcome == "complete" and op.orientation.lead is not None
    assert np.ptp(op.path.axis, axis=0).max() > 0.05
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    assert 0.8 * 0.05 < verdict.operations[0].scallop_max <= 1.02 * 0.05


def test_the_judge_refuses_a_smaller_lead_on_the_same_passes(plan) -> None:
    """What the passes were spaced for is seen: with upright axes the same tips gouge."""
    op = plan.operations[0]
    wrong = replace(op, path=replace(op.path, axis=op.path.normal))
    assert not ta.verify(replace(plan, operations=(wrong,))).passed


def test_the_lead_goes_through_the_folder(plan, tmp_path) -> None:
    write_plan(plan, tmp_path)
    again = read_plan(tmp_path)
    lead = plan.operations[0].orientation.lead
    assert again.inputs.method == "sturz" and again.operations[0].orientation.lead == lead
    assert np.allclose(again.operations[0].path.axis, plan.operations[0].path.axis, atol=1e-8)
    assert read_json(tmp_path / "plan.json")["operations"][0]["orientation"]["lead"] == lead


def test_a_plan_for_least_time_can_be_written(plan, tmp_path) -> None:
    write_plan(replace(plan, inputs=replace(plan.inputs, objective="time")), tmp_path)
    assert read_plan(tmp_path).inputs.objective == "time"


def test_the_table_tells_the_lead_and_that_gouges_are_checked_at_points(plan) -> None:
    shown = plan_table(plan)
    assert "moves, lead" in "".join(map(str, shown.columns[1].cells)) and "checked at points" in str(shown.caption)
    assert "moving axes" in str(shown.title)


def test_the_picture_s_tool_stands_as_it_does_on_the_pass(plan) -> None:
    path = plan.operations[0].path
    tip, axis = standing(path)
    k = int(np.argmin(np.linalg.norm(path.cl - tip, axis=1)))
    assert np.array_equal(path.axis[k], axis) and np.linalg.norm(axis - plan.operations[0].frame.z) > 0.01


def test_a_machine_times_the_path_and_not_below_what_its_feed_takes(plan) -> None:
    machine = Mounting(ta.load_machine("mikron-ucp-710"))
    made = add_times(replace(plan, machine=machine))
    time = made.operations[0].time
    assert made.timed and time is not None and time.cut > plan.length / (plan.inputs.feedrate / 60)
    assert time.cut < 1.5 * plan.length / (plan.inputs.feedrate / 60) and len(time.rotary) == 2
    assert "collision with the machine itself" in made.not_checked
    short = replace(machine.machine, table=tuple(replace(axis, low=0.3, high=0.4) for axis in machine.machine.table))
    lost = add_times(replace(plan, machine=Mounting(short)))
    assert not lost.timed and lost.operations[0].orientation.reasons[-1].startswith("not timed: ")
    assert any("not timed" in one.text for one in warnings_of(lost, None))


def test_a_path_on_which_the_axis_jumps_is_told(plan) -> None:
    """Where the tip would all but stand still, the operation says so with the place, once."""
    machine, op = Mounting(ta.load_machine("mikron-ucp-710")), plan.operations[0]
    cut = np.flatnonzero(op.path.kind == 0)
    k = int(cut[len(cut) // 2])
    leant = op.path.axis.copy()
    leant[k:] = leant[k:] + np.array([0.0, 1.0, 0.0])
    jumping = replace(plan, machine=machine, operations=(replace(op, path=replace(op.path, axis=unit(leant))),))
    made = add_times(add_times(jumping))
    told = [why for why in made.operations[0].orientation.reasons if why.startswith("the feed falls below")]
    assert made.timed and len(told) == 1 and any(told[0] in one.text for one in warnings_of(made, None))
    place = np.array([float(word) for word in told[0].partition("[")[2].partition("]")[0].split(",")])
    assert np.linalg.norm(place - op.path.cl[k]) < 5.0
    fine = add_times(replace(plan, machine=machine))
    assert not any(why.startswith("the feed falls") for why in fine.operations[0].orientation.reasons)


def test_five_axes_are_compared_where_the_machine_moves_two(plan) -> None:
    def methods(machine: Mounting | None) -> list[str]:
        asked = []
        made = replace(plan, machine=machine, inputs=replace(plan.inputs, method="sphere"))
        compare_methods(made, [plan.operations[0].face], lambda name, some: (asked.append(name), plan)[1])
        return asked

    assert {"sturz", "jerk"} <= set(methods(Mounting(ta.load_machine("mikron-ucp-710"))))
    assert "jerk" not in methods(None) and "jerk" in methods(Mounting(ta.load_machine("three-axes-fixture")))
    assert "sturz" not in methods(None) and "sturz" not in methods(Mounting(ta.load_machine("three-axes-fixture")))


@pytest.mark.parametrize(("words", "message"), [
    ({"strategy": "six-axis"}, "strategy 'six-axis' is unknown: use indexed, sturz"),
    ({"strategy": "sturz", "method": "roman"}, "method 'roman' is for fixed axes"),
    ({"method": "sturz"}, "give it as the strategy instead"),
    ({"strategy": "sturz", "objective": "time"}, "not time: leave out"),
    ({"strategy": "sturz", "orientations": 3}, "no shared axes to count: leave out the number of orientations"),
    ({"method": "roman", "orientations": 3}, "leave out one of the two"),
    ({"method": "jerk"}, "method 'jerk' needs a machine.*most along the passes: name a machine"),
    ({"method": "jerk", "orientations": 2, "machine": "mikron-ucp-710"}, "leave out one of the two"),
    ({"method": "best"}, "method 'best' is unknown: use sphere, sectors, jerk, roman, normal, one or ball"),
    ({"strategy": "sturz", "machine": "three-axes-fixture"}, "needs two driven rotary axes")])
def test_what_does_not_go_with_a_moving_axis_is_refused(words, message) -> None:
    with pytest.raises(ta.InvalidInput, match=message):
        ta.plan(_face(), TOOL, 0.05, **words)


def test_names_of_strategies() -> None:
    assert list(strategies()) == ["indexed", "sturz", "two-point", "blade", "blade-keys", "four-plus-one", "multiscale"]
    assert strategy_of("roman").name == "indexed" and strategy_of("sturz").name == "sturz"
    assert title_of("roman") == "Roman's rule" and title_of("sturz") == "five axes, constant lead"
    for method in ("indexed", "best"):
        with pytest.raises(ta.InvalidInput, match=f"method '{method}' is unknown: use sphere, "):
            strategy_of(method)
