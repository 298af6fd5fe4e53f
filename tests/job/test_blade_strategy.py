"""Strategies around blades from end to end: plan, clean-up, judge, pictures, and what they refuse."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks._blades import loft

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.spec import with_rings
from toolaxis.job.output.pictures import draw_plan
from toolaxis.shape.joining.closed_rings import ring_around
from toolaxis.strategies.blade.layers import find_closed_parameter
from toolaxis.strategies.inputs import check_strategy
from toolaxis.strategies.strategy import Asked

TOOL = ta.Tool.ball(8, stickout=90, holder=[(12.5, 0), (12.5, 60)])


def along_x(points):
    return np.stack([points[..., 2], points[..., 0], points[..., 1]], axis=-1)


def plate(x=-6.0, size=34.0):
    return ta.Face.from_bspline([[[x, y, z] for z in (-size, size)] for y in (-size, size)], (1, 1), flip=True)


@pytest.fixture(scope="module", params=["blade", "blade-keys"])
def plan(request):
    return ta.plan(loft("turbine", 5.0, place=along_x), TOOL, 0.1, strategy=request.param, machine="four-axis-a",
                   direction="climb", workers=1, obstacles=plate())


def test_a_plan_around_a_blade_is_complete_and_timed(plan):
    op = plan.operations[0]
    assert plan.outcome == "complete", op.orientation.reasons
    assert op.time is not None and op.time.cut > 0 and op.path.passes == op.orientation.passes > 3
    assert np.abs(op.path.axis[:, 0]).max() < 1e-9
    assert "without turning back" in op.orientation.reasons[-4 if op.zones else 0] or op.zones


def test_the_judge_passes_it_and_knows_what_is_left_at_the_root(plan):
    op = plan.operations[0]
    assert 0.0 < op.orientation.unreached < 0.4 and len(op.zones) == 1
    found = ta.verify(plan)
    assert found.operations[0].gouge_max < 0.002
    assert found.passed, found.reasons


@pytest.mark.parametrize("plan", ["blade-keys", pytest.param("blade", marks=pytest.mark.long)], indirect=True)
def test_its_pictures_show_the_plane_and_the_axes(plan, tmp_path):
    draw_plan(plan, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert {"op01-face1-angles.png", "op01-face1-motion.png", "op01-face1-passes.png"} <= names
    assert all((tmp_path / name).stat().st_size > 20_000 for name in names)


def test_machines_need_one_driven_rotary_axis():
    check_strategy("blade", Asked(TOOL, ta.load_machine("four-axis-a")))
    with pytest.raises(InvalidInput, match="needs one driven rotary axis and"):
        check_strategy("blade", Asked(TOOL, ta.load_machine("three-axes-fixture")))
    with pytest.raises(InvalidInput, match="needs two driven rotary axes"):
        check_strategy("sturz", Asked(TOOL, ta.load_machine("four-axis-a")))


@pytest.mark.parametrize("given, words", [
    ({"tool": "torus:8x1"}, "no ball end"), ({"objective": "time"}, "leave out the objective")])
def test_what_it_cannot_take_is_named(given, words):
    asked = {"tool": TOOL, "strategy": "blade", "machine": "four-axis-a", **given}
    with pytest.raises(InvalidInput, match=words):
        ta.plan(loft("turbine", 5.0, place=along_x), scallop=0.1, workers=1, **asked)


def test_one_face_of_a_blade_brings_those_around_it():
    part = ta.load(Path(__file__).parents[2] / "examples" / "blisk.step")
    assert [set(ring_around(part, number)) for number in (1, 163, 3, 161)] == [{1, 3, 161, 163}] * 4
    assert ring_around(part, 2) == ()
    joined, numbers = with_rings(part, [3, 2, 1])
    assert numbers == [3, 2] and find_closed_parameter(joined.face(3)) in "uv" and not joined.face(2).members
    assert {member.face.number for member in joined.face(3).members} == {1, 3, 161, 163}
    again, numbers = with_rings(joined, [3])
    assert again is joined and numbers == [3]


def test_a_face_that_closes_by_itself_is_in_no_ring():
    part = ta.load(loft("turbine", 5.0, place=along_x))
    assert with_rings(part, None) == (part, [1])
