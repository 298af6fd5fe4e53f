"""A whole plan on a machine: its axes, its written form, the judge, and what is not judged."""

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.feed.fixed_axis_time import index_time
from toolaxis.job.files.plan_folder import read_json, read_plan, write_plan
from toolaxis.job.output.verify import verdict_document
from toolaxis.job.planning.edit_axis import try_axis, with_operations
from toolaxis.job.planning.timing import add_times
from toolaxis.machine.setup import Mounting
from toolaxis.plan.playback import playback_of
from toolaxis.report.tables import plan_table

HOLDER = [(10.0, 0.0), (10.0, 40.0)]
TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=HOLDER)


@pytest.fixture(scope="module")
def plan() -> ta.Part:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 3 * np.sin(x / 15) + 2 * np.cos(y / 12)], axis=-1))
    return ta.plan(face, TOOL, 0.2, machine="mikron-ucp-710", offset=(-20.0, -15.0, 60.0), limits="cone:0,0,1,40")


def test_axes_are_held_and_the_plan_says_where(plan, tmp_path: Path) -> None:
    op = plan.operations[0]
    assert plan.outcome == "complete", op.orientation.reasons
    assert plan.machine is not None and plan.inputs.limits == "cone:0,0,1,40"
    assert "machine" not in plan.not_checked and "collision with the machine itself" not in plan.not_checked
    write_plan(plan, tmp_path)
    document = read_json(tmp_path / "plan.json")
    assert document["machine"]["name"] == "Mikron UCP 710" and document["machine"]["kind"] == "table-table"
    angles = np.array(document["operations"][0]["rotary"])
    steps = [axis.increment for axis in plan.machine.machine.rotary]
    for row in angles:
        assert np.allclose(plan.machine.axis_at(row), op.orientation.axis, atol=1e-9)
        assert all(step == 0 or abs(value / step - round(value / step)) < 1e-6
                   for value, step in zip(row, steps, strict=True))
    again = read_plan(tmp_path)
    assert again.machine is not None and np.allclose(again.machine.table_from_part, [[1, 0, 0, -20], [0, 1, 0, -15],
                                                                                     [0, 0, 1, 60], [0, 0, 0, 1]])
    verdict = ta.verify(again)
    assert verdict.passed
    assert verdict_document(again, verdict)["not_checked"] == ["obstacles other than the part"]
    rooms = verdict.operations[0].clearance
    assert rooms["machine"].distance >= 1.0 and rooms["index move"].distance >= 1.0, "bodies are judged too"


@pytest.mark.parametrize("on_machine", [True, False])
def test_a_plan_is_played_in_its_own_time(plan, on_machine: bool) -> None:
    op = plan.operations[0]
    other = replace(try_axis(plan, op, (0.05, -0.3, 0.95)), number=2)
    whole = add_times(replace(plan, operations=(op, other, replace(op, number=3)), machine=plan.machine))
    if not on_machine:
        whole = replace(whole, operations=tuple(replace(one, time=None) for one in whole.operations), machine=None)
    assert whole.timed == on_machine
    played = playback_of(whole)
    assert played.seconds == pytest.approx(whole.seconds) and len(played.between) == 2 and min(played.between) > 0
    assert played.cutting == pytest.approx(sum(
        one.time.cut if one.time else 60 * one.path.length(Motion.CUT) / 1000 for one in whole.operations))
    none = replace(plan, operations=(replace(op, path=None),))
    with pytest.raises(ta.InvalidInput):
        playback_of(none)


def test_the_judge_refuses_a_part_that_was_moved_out_of_the_travel(plan) -> None:
    moved = replace(plan, machine=Mounting(plan.machine.machine, (900.0, 0.0, 60.0)))
    verdict = ta.verify(moved)
    assert not verdict.passed and any("would leave its travel by" in reason for reason in verdict.reasons)


def test_an_axis_that_is_tried_stands_on_the_machine_s_steps(plan) -> None:
    op = plan.operations[0]
    wanted = np.array([0.05, -0.3, 0.95])
    tried = try_axis(plan, op, wanted)
    assert tried.done, tried.orientation.reasons
    held = plan.machine.solutions(tried.orientation.axis)
    assert len(held) and np.allclose(plan.machine.axis_at(held[0]), tried.orientation.axis, atol=1e-12)
    beyond = try_axis(plan, op, (0.0, -0.9, 0.436))
    assert not beyond.done and "outside the limits" in beyond.orientation.reasons[0]


def test_travel_is_said_not_to_be_judged_without_a_place(plan) -> None:
    bare = replace(plan, machine=Mounting(plan.machine.machine))
    assert "travel of the machine's linear axes" in bare.not_checked
    tool = ta.Tool.torus(diameter=12, corner_radius=2)
    short = replace(plan, tools=(tool,), operations=tuple(replace(op, tool=tool) for op in plan.operations))
    assert "travel of the machine's linear axes" in short.not_checked
    hollow = replace(plan, machine=replace(plan.machine, machine=replace(plan.machine.machine, bodies=())))
    assert all("collision with the machine itself" in one.not_checked for one in (bare, short, hollow))


@pytest.mark.parametrize(("words", "message"), [
    ({"machine": "lathe"}, "machine 'lathe' is neither a file nor one of the library"),
    ({"objective": "time"}, "objective .time. needs a machine"),
    ({"machine": "cone:0,0,1,40", "offset": (0, 0, 1)}, "without a machine"),
    ({"offset": (0, 0, 1)}, "without a machine"), ({"machine": "mikron-ucp-710", "offset": (0, 1)}, "work offset")])
def test_wrong_machines_and_places_are_refused(words, message) -> None:
    face = ta.Face.from_bspline(np.stack(np.meshgrid([0.0, 9, 20], [0.0, 9, 20], [0.0]), -1)[:, :, 0], degree=(2, 2))
    with pytest.raises(ta.InvalidInput, match=message):
        ta.plan(face, "torus:6x1", 0.1, **words)


def test_a_machine_with_coarse_steps_still_machines() -> None:
    coarse = ta.load_machine("dmg-dmu-60t")
    coarse = replace(coarse, table=tuple(replace(axis, increment=radians(5)) for axis in coarse.table),
                     head=tuple(replace(axis, increment=radians(5)) for axis in coarse.head))
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.003 * (x - 20) ** 2], axis=-1))
    made = ta.plan(face, TOOL, 0.2, machine=coarse)
    angles = np.degrees(made.machine.solutions(made.operations[0].orientation.axis))
    assert len(angles) and np.allclose(angles / 5, np.round(angles / 5), atol=1e-9)


def test_a_machine_with_known_limits_tells_its_own_time(plan, tmp_path: Path) -> None:
    time = plan.operations[0].time
    assert plan.timed and time is not None and time.index == 0 and plan.seconds == time.total
    plain = replace(plan, operations=tuple(replace(op, time=None) for op in plan.operations), machine=None)
    assert plan.seconds > plain.operations[0].seconds(1000.0, 30000.0)  # full rates are a lower bound
    cut = plan.length / (1000 / 60)
    assert 1.0 < time.cut / cut < 1.3 and time.link > 0 and time.entry > 0
    write_plan(plan, tmp_path)
    document = read_json(tmp_path / "plan.json")
    assert document["seconds"] == plan.seconds and document["operations"][0]["seconds"] == time.path
    again = read_plan(tmp_path)
    assert again.operations[0].time == time and again.seconds == plan.seconds
    assert "within velocity, acceleration and jerk" in (plan_table(plan).caption or "")


def test_index_moves_are_part_of_the_time(plan) -> None:
    """Up, turn, over and down, each from rest to rest, between two operations that stand at different angles."""
    op = plan.operations[0]
    other = try_axis(plan, op, (0.05, -0.3, 0.95))
    two = add_times(replace(plan, operations=(op, replace(other, number=2))))
    first, second = (one.time for one in two.operations)
    assert first == op.time and second.index > 0 and two.seconds == pytest.approx(first.total + second.total)
    turn = index_time(plan.machine.machine, first.rotary, second.rotary)
    assert turn > 0 and second.index > turn + 0.5  # retracts included
    bare = add_times(replace(two, machine=Mounting(plan.machine.machine)))
    assert bare.operations[1].time.index == pytest.approx(turn)
    assert "without retracts" in (plan_table(bare).caption or "")
    same = add_times(replace(plan, operations=(op, replace(op, number=2))))
    assert 0.5 < same.operations[1].time.index < second.index + 1.0


def test_a_machine_that_does_not_state_its_limits_is_told(plan) -> None:
    machine = plan.machine.machine
    x = replace(machine.linear[0], drive=replace(machine.linear[0].drive, jerk=None))
    unknown = add_times(replace(plan, machine=replace(plan.machine, machine=replace(machine,
                                                                               linear=(x, *machine.linear[1:])))))
    assert not unknown.timed and unknown.operations[0].time is None
    assert unknown.seconds == pytest.approx(replace(unknown, machine=None).seconds)
    assert "does not state jerk of axis X" in (plan_table(unknown).caption or "")


def test_a_changed_operation_is_timed_again(plan) -> None:
    op = plan.operations[0]
    tried = try_axis(plan, op, (0.05, -0.3, 0.95))
    changed = with_operations(plan, {op.number: tried})
    assert changed.timed and changed.operations[0].time != op.time
