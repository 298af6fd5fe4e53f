"""What a rack machines as one can be asked before anything is planned, and is what is planned then."""

from pathlib import Path

import pytest

import toolaxis as ta
from toolaxis.job.inputs.spec import with_joined
from toolaxis.job.planning.pipeline import WIDE, group_faces
from toolaxis.plan.plan import PlanInputs

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TOOLS = [ta.Tool.ball(diameter=size, number=k) for k, size in enumerate((6, 20, 12), 1)]


@pytest.fixture(scope="module")
def skin() -> ta.Part:
    return ta.load(EXAMPLES / "skin.step")


def test_the_skins_are_those_that_are_planned(skin: ta.Part) -> None:
    found = group_faces(skin, TOOLS, PlanInputs(0.05))
    joined, _ = with_joined(skin, "skins", width=WIDE * 6.0)
    assert found == tuple(face.numbers for face in joined.faces if len(face.numbers) > 1) and len(found[0]) > 2


def test_tools_below_the_scallop_height_do_not_count_and_faces_to_avoid_join_nothing(skin: ta.Part) -> None:
    fine = ta.Tool.ball(diameter=0.2, number=9)
    assert group_faces(skin, [*TOOLS, fine], PlanInputs(0.15)) == group_faces(skin, TOOLS, PlanInputs(0.15))
    whole, = group_faces(skin, TOOLS, PlanInputs(0.05))
    rest = group_faces(skin, TOOLS, PlanInputs(0.05, avoid=whole[:1]))
    assert all(whole[0] not in numbers for numbers in rest)


def test_a_part_with_blades_has_no_skins() -> None:
    wheel = ta.load(EXAMPLES / "blisk.step")
    assert group_faces(wheel, TOOLS, PlanInputs(0.05)) == ()
