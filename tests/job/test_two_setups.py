"""A part that one setup cannot serve: what the first one leaves is planned in the next, no more and no less."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.planning.earlier_setups import leave_out_machined
from toolaxis.numeric.polygons import signed_area
from toolaxis.plan.plan import Plan
from toolaxis.plan.unplanned_area import NOT_BEGUN, UnplannedArea

TOOL = ta.Tool.torus(diameter=8, corner_radius=2, stickout=30, holder=[(12, 0), (12, 30)])
SMALL = ta.Tool.ball(4, stickout=30, holder=[(12, 0), (12, 30)])


def patch(number: int, x0: float, x1: float) -> ta.Face:
    """A patch, 16 mm across, of a sheet that waves a little."""
    x, y = np.meshgrid(np.linspace(x0, x1, 8), np.linspace(0, 16, 6), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 0.05 * x + 0.4 * np.sin(y / 5)], axis=-1))
    return replace(face, number=number)


def made(part: ta.Part, tools: object = TOOL, **more: object) -> Plan:
    return ta.plan(part, tools, 0.1, limits="cone:0,0,1,30", workers=1, **more)


def area_of(plan: Plan) -> float:
    """What is asked for, what is held and what was machined before, mm^2."""
    return plan.account.area + sum(one.area for one in (*plan.held, *plan.machined_before))


def lowest_and_highest(plan: Plan) -> tuple[float, float]:
    """Between which x the sub-surfaces lie, mm."""
    x = np.concatenate([op.face.evaluate(op.face.grid(40, 40)).point[:, 0] for op in plan.operations if op.done])
    return float(x.min()), float(x.max())


@pytest.fixture(scope="module")
def part() -> ta.Part:
    return ta.Part.from_faces([patch(1, 0, 30)])


@pytest.fixture(scope="module")
def first(part: ta.Part) -> Plan:
    return made(part, held="x<10")


@pytest.fixture(scope="module")
def second(part: ta.Part, first: Plan) -> Plan:
    return made(part, held="x>29", after=[first])


def test_the_second_setup_machines_what_the_first_one_left(part: ta.Part, first: Plan, second: Plan) -> None:
    whole = part.face(1).area
    assert area_of(first) == pytest.approx(whole, rel=1e-6) and area_of(second) == pytest.approx(whole, rel=1e-6)
    (before,) = second.machined_before
    assert before.face == 1 and not before.whole
    assert before.area == pytest.approx(first.account.machined, rel=1e-3)
    low, high = lowest_and_highest(second)
    assert low < 1.0, "what was held is machined"
    assert high < 10.0 + 2 * TOOL.radius, "what the first one machines is not asked for once more"
    assert first.account.machined + second.account.machined > 0.99 * whole
    assert not second.held, "what the second one holds was machined before"


def test_the_judge_passes_both(first: Plan, second: Plan) -> None:
    for plan in (first, second):
        verdict = ta.verify(plan)
        assert verdict.passed, verdict.reasons


def test_it_is_written_and_read(second: Plan, tmp_path: Path) -> None:
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(second, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "plan" / "plan.json").read_text())
    (row,) = document["part"]["machined_before"]
    assert row["face"] == 1 and row["area"] == second.machined_before[0].area
    assert read_plan(tmp_path / "plan").machined_before == second.machined_before


def test_a_third_one_begins_after_both(part: ta.Part, first: Plan, second: Plan) -> None:
    with pytest.raises(InvalidInput, match="nothing is left to plan"):
        made(part, after=[first, second])
    narrow = made(part, held="x>20", after=[first])  # between the sides that both hold a holder has no room
    third = made(part, after=[first, narrow])
    left = part.face(1).area - first.account.machined - narrow.account.machined
    assert left > 30 and third.account.area == pytest.approx(left, abs=0.05)
    assert third.account.machined > 0.99 * left and ta.verify(third).passed


def test_what_two_plans_machine_is_taken_off_once(part: ta.Part, first: Plan) -> None:
    """Sub-surfaces that overlap: the same plan twice is the extreme."""
    once, (before,) = leave_out_machined(part.faces, [first])
    twice, (both,) = leave_out_machined(part.faces, [first, first])
    assert sum(face.area for face in twice) == pytest.approx(sum(face.area for face in once), rel=1e-4)
    assert both.area == pytest.approx(before.area, rel=1e-4)


@pytest.mark.parametrize("share", [0.28125, 1 / 3, 0.7])
def test_corners_that_lie_on_the_edges_of_others_leave_nothing(part: ta.Part, first: Plan, share: float) -> None:
    """What rounding leaves between a corner and the edge it lies on is no piece of the face."""
    face = part.face(1)
    low, high = np.array([0.625, 0.0]), np.array([0.7, 1.0])
    corner = low + share * (high - low)
    left = np.array([[0.0, 0.0], low, high, [0.0, 1.0]])
    below = np.array([low, [1.0, 0.0], [1.0, corner[1]], corner])
    beside = corner - [0.0, 1.2e-16]  # the same corner, cut once more
    above = np.array([beside, [1.0, corner[1]], [1.0, 1.0], high])
    pieces = [face.trimmed((loop,)) for loop in (left, below, above)]
    done = [replace(first.operations[0], face=piece, zones=()) for piece in pieces]
    for names in ((0, 1), (0, 2), (1, 2), (0, 1, 2)):
        (*rest, other), _ = leave_out_machined((face, patch(2, 40, 60)),
                                               [replace(first, operations=tuple(done[i] for i in names))])
        assert other.number == 2
        kept = sum(piece.area for i, piece in enumerate(pieces) if i not in names)
        assert sum(piece.area for piece in rest) == pytest.approx(kept, rel=1e-6)
        assert all(abs(signed_area(loop)) > 1e-3 for piece in rest for loop in piece.outline)


def test_several_tools_and_a_skin(tmp_path: Path) -> None:
    """Rests of larger tools were machined by smaller ones; faces are joined as they were."""
    part = ta.Part.from_faces([patch(1, 0, 16), patch(2, 16, 32)])
    first = made(part, [TOOL, SMALL], held="x<8")
    assert [face.numbers for face in first.part.faces] == [(1, 2)]
    with stage_folder(tmp_path / "first") as stage:
        write_plan(first, stage.folder)
        stage.publish()
    second = made(part, [SMALL, TOOL], held="x>24", after=[read_plan(tmp_path / "first")])
    assert [face.numbers for face in second.part.faces] == [(1, 2)]
    assert area_of(second) == pytest.approx(area_of(first), rel=1e-6)
    assert first.account.machined + second.account.machined > 0.99 * area_of(first)
    assert lowest_and_highest(second)[1] < 8.0 + 2 * TOOL.radius
    for plan in (first, second):
        assert ta.verify(plan).passed


def test_a_plan_that_was_stopped_goes_on(part: ta.Part, first: Plan) -> None:
    two = ta.Part.from_faces([part.face(1), patch(2, 40, 60)])
    begun = made(two, faces=[1])
    left = UnplannedArea(2, "2", two.face(2).area, True, NOT_BEGUN)
    stopped = replace(begun, outcome="cancelled", unplanned=(left,))
    rest = made(two, after=[stopped])
    assert {op.face.number for op in rest.operations if op.face.area > 1.0} == {2}
    assert rest.account.machined > 0.99 * two.face(2).area


def test_what_does_not_go_together_is_refused_with_a_sentence(part: ta.Part, first: Plan) -> None:
    other = ta.Part.from_faces([patch(1, 0, 31)])
    for words, asked in (("the plan of setup 1 is one of another part", {"part": other, "after": [first]}),
                          ("faces are named, and earlier setups too", {"after": [first], "faces": [1]})):
        with pytest.raises(InvalidInput, match=words):
            made(**{"part": part, **asked})


def test_the_command_plans_both(sheet_file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["plan", sheet_file, "--tool", "ball:8", "--scallop", "0.2", "--limits", "cone:0,0,1,30",
             "--no-pictures", "--workers", "1"]
    one, two = str(tmp_path / "one"), str(tmp_path / "two")
    assert main([*words, "--held", "x<9", "--out", one]) == 0
    out = capsys.readouterr()
    assert f"for the other setup: toolaxis plan {words[1]} --after {one} --held SIDE --out DIR" in out.out + out.err
    assert main([*words, "--held", "x>20", "--after", one, "--out", two]) == 0
    out = capsys.readouterr()
    assert "machined in earlier setups and not asked for:" in out.out + out.err
    assert main(["verify", two, "--no-pictures"]) == 0
    assert main([*words, "--after", one, "--out", one]) == 2
    out = capsys.readouterr()
    assert "is the folder that this plan is written to" in out.out + out.err
