"""Allowances on some faces: each is machined to its own height, and none goes deeper on what others keep."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.cldata.toolpath import Motion
from toolaxis.feasibility.surroundings import OTHER, SKIN, TOUCHING, group_surroundings
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.inputs.spec import parse_allowances
from toolaxis.job.output.verify import verify_plan
from toolaxis.messages.translate import translate
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import allowance_line
from toolaxis.shape.part import Edge
from toolaxis.skin.find import find_skins
from toolaxis.tolerances import Tolerance

LEFT = 0.3
BALL = ta.Tool.ball(6, flute_length=12, stickout=40)
_PLANNED: dict[str, Plan] = {}


def plate(corner: tuple[float, ...], one: tuple[float, ...], two: tuple[float, ...]) -> ta.Face:
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def step() -> ta.Part:
    """A floor (1), a wall at its back (2), a floor that continues it (3) and a side that falls off (4)."""
    floor = plate((0, 0, 0), (30, 0, 0), (0, 20, 0))
    wall = plate((0, 20, 0), (30, 0, 0), (0, 0, 12))
    further = plate((30, 0, 0), (20, 0, 0), (0, 20, 0))
    side = plate((0, 0, -10), (30, 0, 0), (0, 0, 10))
    edges = [Edge((1, 2), "concave", np.array([[0.0, 20, 0], [30, 20, 0]])),
             Edge((1, 3), "tangent", np.array([[30.0, 0, 0], [30, 20, 0]])),
             Edge((1, 4), "convex", np.array([[0.0, 0, 0], [30, 0, 0]]))]
    return ta.Part.from_faces([floor, wall, further, side], edges=edges)


def plan_step(on: object, faces: object = (1,), **more: object) -> Plan:
    """The plan of some of its faces; a plan that several tests look at is made once."""
    told = repr((on, faces, sorted(more.items())))
    if told not in _PLANNED:
        _PLANNED[told] = ta.plan(step(), BALL, 0.05, faces=list(faces), allowance_on=on,  # type: ignore[call-overload]
                                 workers=1, limits="cone:0,0,1,40" if 2 in faces else "cone:0,0,1,10", **more)
    return _PLANNED[told]


def lowest(plan: Plan, point: tuple[float, float, float], normal: tuple[float, float, float]) -> float:
    """How low the ball comes over a plane anywhere, along its normal, beside the part too, mm."""
    heights = []
    for op in plan.operations:
        if op.path is not None:
            centres = op.path.cl + 3 * op.path.axis
            heights.append(((centres - point) @ np.array(normal)).min() - 3)
    return min(heights)


def asked_afterwards(plan: Plan, on: dict[int, float]) -> Plan:
    """A plan as if it had been made for allowances."""
    return replace(plan, inputs=replace(plan.inputs, allowance_on=tuple(on.items())))


def test_a_face_is_machined_to_its_own_height() -> None:
    plan, plain = plan_step({1: LEFT}), plan_step(None)
    assert plan.outcome == plain.outcome == "complete"
    assert lowest(plan, (0, 0, 0), (0, 0, 1)) == pytest.approx(LEFT, abs=0.011)
    assert lowest(plain, (0, 0, 0), (0, 0, 1)) == pytest.approx(0, abs=0.011)
    verdict = ta.verify(plan)
    assert verdict.passed and verdict.operations[0].allowance == LEFT
    # Too high and too low are both found.
    low = ta.verify(asked_afterwards(plain, {1: LEFT}))
    assert any("gouge 0.3" in why for why in low.reasons)
    high = ta.verify(replace(plan, inputs=replace(plan.inputs, allowance_on=())))
    assert any("% of the area" in why and "up to 0.3" in why for why in high.reasons)


def test_a_wall_keeps_what_is_left_on_it_while_its_floor_is_finished() -> None:
    plan, plain, thick = plan_step({2: 1.5}), plan_step(None), 1.5
    assert plan.outcome == "complete"
    assert lowest(plan, (0, 20, 0), (0, -1, 0)) >= thick + 0.1
    assert lowest(plan, (0, 0, 0), (0, 0, 1)) == pytest.approx(0, abs=0.011)
    assert 0.09 <= lowest(plain, (0, 20, 0), (0, -1, 0)) < thick
    assert ta.verify(plan).passed
    found = ta.verify(asked_afterwards(plain, {2: thick}))
    why, = (reason for reason in found.reasons if "are left" in reason and "cutter" in reason)
    assert "cutter is 1.0" in why and "face 2 at (" in why and "on which 1.5 mm are left, needed 1.49 mm, on the" in why
    assert "stehen bleiben" in translate(why, "german")


def test_faces_that_continue_it_and_that_fall_off_keep_theirs() -> None:
    """Where more is left on a neighbour it is a wall, however it meets the face: a strip beside it stays."""
    plan = plan_step({3: LEFT, 4: LEFT})
    assert plan.outcome == "complete"
    op = plan.operations[0]
    assert op.path is not None and op.zones and all(zone.at_wall for zone in op.zones)
    cut = op.path.kind == Motion.CUT
    centres = (op.path.cl + 3 * op.path.axis)[cut]
    for face in (plan.part.face(3), plan.part.face(4)):
        near = face.evaluate(face.grid(200, 200)).point
        apart = min(np.linalg.norm(near - centre, axis=1).min() for centre in centres[::5]) - 3
        assert apart >= LEFT + 0.1
    assert ta.verify(plan).passed
    plain = plan_step(None)
    found = ta.verify(asked_afterwards(plain, {3: LEFT, 4: LEFT}))
    assert any("face 3" in why and "0.3 mm are left" in why for why in found.reasons)


def test_each_face_of_a_plan_has_its_own() -> None:
    plan = plan_step("2=0.3; 3=0.1", faces=(1, 2, 3), allowance=0.05)
    left = {op.face.number: op for op in plan.operations}
    assert [plan.inputs.allowance_of(left[n].face) for n in (1, 2, 3)] == [0.05, 0.3, 0.1]
    assert allowance_line(plan) == "left on purpose: 0.1 mm on face 3, 0.3 mm on face 2, 0.05 mm on all others"
    verdict = ta.verify(plan)
    assert [op.allowance for op in verdict.operations] == [plan.inputs.allowance_of(op.face)
                                                           for op in plan.operations if op.done]
    assert verdict.passed == (plan.outcome == "complete"), verdict.reasons


def test_what_stands_around_a_face_is_kept_at_its_own_allowance() -> None:
    part = step().leave_allowances(0.0, {2: 0.3, 3: 0.2, 4: 0.1})
    keep = Tolerance(gouge=0.01)

    def around(number: int, left: float) -> dict[tuple[str, float], list[int]]:
        groups = group_surroundings(part.face(number), keep, left, part=part)
        return {(group.role, round(float(group.required[0]), 6)): [face.number for face in group.faces]
                for group in groups}

    assert around(1, 0.0) == {(SKIN, -0.01): [1], (OTHER, 0.4): [2], (OTHER, 0.3): [3], (OTHER, 0.2): [4]}
    assert around(3, 0.2) == {(SKIN, 0.19): [3, 1], (OTHER, 0.4): [2], (TOUCHING, 0.09): [4]}
    # Without allowances of their own nothing changes.
    plain = group_surroundings(step().face(1), keep, 0.3, part=step())
    assert [(group.role, [face.number for face in group.faces]) for group in plain] == [
        (SKIN, [1, 3]), (TOUCHING, [4]), (OTHER, [2])]


def test_faces_that_keep_different_allowances_are_not_joined() -> None:
    with pytest.raises(ta.InvalidInput, match=r"face 1 keeps an allowance of 0 mm and face 3 one of 0\.3 mm") as raised:
        plan_step({3: LEFT}, faces=((1, 3),))
    assert "Aufmaß" in translate(str(raised.value), "german")
    apart = plan_step({3: LEFT}, faces=(1, 3))
    assert {op.face.numbers for op in apart.operations} == {(1,), (3,)}


def test_skins_end_where_the_allowance_changes() -> None:
    assert [face.numbers for face in find_skins(step()).faces] == [(1, 3)]
    assert not find_skins(step().leave_allowances(0.0, {3: LEFT})).faces
    assert [face.numbers for face in find_skins(step().leave_allowances(0.0, {1: LEFT, 3: LEFT})).faces] == [(1, 3)]


@pytest.mark.parametrize("given, found", [
    (None, ()), ("", ()), ({3: 0.3}, ((3, 0.3),)), ("3,5-6=0.3;9=0.1", ((3, 0.3), (5, 0.3), (6, 0.3), (9, 0.1))),
    (["3=0.2", "1=0"], ((1, 0.0), (3, 0.2))), ({"1-2": 0.4}, ((1, 0.4), (2, 0.4))), ([(3, 0.3)], ((3, 0.3),))])
def test_ways_to_write_them(given: object, found: tuple[tuple[int, float], ...]) -> None:
    assert parse_allowances(given) == found  # type: ignore[arg-type]


@pytest.mark.parametrize("given, said", [
    ("3", "allowance on faces '3' is not understood: write numbers and a length"), ("all=0.3", "not understood"),
    ("3=", "not understood"), ("3=-0.1", "allowance on face 3 is -0.1 mm: it must be zero or more, and at most 50 mm"),
    ("3=inf", "allowance on face 3 is inf mm"), ("3=0.1;3=0.2", "face 3 is to keep an allowance of 0.1 mm and one of"),
    ({0: 0.1}, "face 0 with an allowance is no number of a face"), ([7], "allowance on faces 7 is not understood"),
    ("9=0.1", "face 9 is to keep an allowance and is not in the part")])
def test_allowances_that_make_no_sense(given: object, said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said) as raised:
        plan_step(given)
    assert translate(str(raised.value), "german") != str(raised.value)


def test_what_does_not_go_with_them() -> None:
    with pytest.raises(ta.InvalidInput, match="face 2 is to keep an allowance and to be avoided: leave out one"):
        plan_step({2: LEFT}, avoid=[2])
    with pytest.raises(ta.InvalidInput, match=r"below the allowance of 0\.3 mm: give at least the allowance"):
        plan_step({2: LEFT}, stock=0.2)


def test_they_are_written_and_come_back(tmp_path: Path) -> None:
    plan = plan_step({2: LEFT})
    write_plan(plan, tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["allowance_on"] == [[2, 0.3]]
    back = read_plan(tmp_path)
    assert back.inputs == plan.inputs and back.part.allowances == plan.part.allowances
    assert verify_plan(back).passed
    del document["inputs"]["allowance_on"]
    (tmp_path / "plan.json").write_text(json.dumps(document))
    assert allowance_line(read_plan(tmp_path)) == ""


def test_a_job_of_a_batch_gives_them() -> None:
    job, = read_jobs([{"name": "one", "part": step(), "tool": "ball:6", "scallop": 0.1, "allowance_on": "1,3-4=0.2"}])
    assert job.task().options["allowance_on"] == ((1, 0.2), (3, 0.2), (4, 0.2))
