"""Faces joined for planning: the plan of the whole surface, the written form, divisions, and the judge on own faces."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.inputs.spec import parse_faces, with_joined
from toolaxis.job.output.verify import _task
from toolaxis.numeric.knots import restrict_spline
from toolaxis.plan.plan import Plan
from toolaxis.shape.nurbs import NurbsSurface

TOOL = "torus:12x1"
LINES = (0.0, 1 / 3, 1.0), (0.0, 2 / 3, 1.0)


def sheet(height: float = 1.0, away: float = 0.0) -> ta.Face:
    """The wavy patch of `small_plan`, elsewhere or higher if asked for."""
    x, y = np.meshgrid(np.linspace(0, 24, 6), np.linspace(0, 16, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x + away, y, height * np.sin(x / 9) * np.cos(y / 8)], axis=-1))


def patches(face: ta.Face) -> list[ta.Face]:
    """Four patches between knot lines; each but the first one is written with u and v exchanged, reversed, or both."""
    surface, found = face.surface, []
    for u in pairwise(LINES[0]):
        ku, net = restrict_spline(surface.knots_u, surface.control, 3, *u)
        for v in pairwise(LINES[1]):
            kv, own = restrict_spline(surface.knots_v, net.swapaxes(0, 1), 3, *v)
            found.append(NurbsSurface(ku, kv, own.swapaxes(0, 1), (3, 3)))
    back = NurbsSurface(-3 * found[1].knots_u[::-1], found[1].knots_v, found[1].control[::-1], (3, 3))
    return [replace(face, surface=found[0]), replace(face, surface=back, flip=True),
            replace(face, surface=found[2].swapped(), flip=True), replace(face, surface=found[3])]


@pytest.fixture(scope="module")
def joined_plan(small_plan: Plan) -> Plan:
    return ta.plan(patches(sheet()), small_plan.tools[0], 0.1, faces=[(1, 2, 3, 4)])


def test_the_plan_of_joined_patches_is_that_of_the_whole_surface(joined_plan: Plan, small_plan: Plan) -> None:
    one, whole = joined_plan.operations[0].orientation, small_plan.operations[0].orientation
    assert len(joined_plan.operations) == 1 and joined_plan.operations[0].name == "op01-face1+2+3+4"
    assert one.axis is not None and np.allclose(one.axis, whole.axis, rtol=0, atol=1e-9)
    assert (one.passes, one.feed, one.outcome) == (whole.passes, whole.feed, whole.outcome)
    assert one.length == pytest.approx(whole.length, rel=1e-6) and one.gouge == pytest.approx(whole.gouge, abs=1e-6)
    mine, theirs = joined_plan.operations[0].path, small_plan.operations[0].path
    assert mine is not None and theirs is not None and np.abs(mine.cl - theirs.cl).max() < 1e-6


def test_the_written_form_names_all_faces_and_joins_them_again(joined_plan: Plan, tmp_path: Path) -> None:
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(joined_plan, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "plan" / "plan.json").read_text())
    op = document["operations"][0]
    assert (op["face"], op["faces"], op["label"], op["region"]) == (1, [1, 2, 3, 4], "1+2+3+4", None)
    assert document["part"]["joined"] == [[1, 2, 3, 4]] and document["part"]["faces"] == 4
    assert len(json.loads((tmp_path / "plan" / "part.json").read_text())["faces"]) == 4
    assert (tmp_path / "plan" / "op01-face1+2+3+4.apt").is_file()
    again = read_plan(tmp_path / "plan")
    assert [face.label for face in again.part.faces] == ["1+2+3+4"]
    face, mine = again.operations[0].face, joined_plan.operations[0].face
    assert face.numbers == (1, 2, 3, 4) and np.array_equal(face.surface.control, mine.surface.control)


def test_the_judge_measures_on_the_faces_themselves(joined_plan: Plan) -> None:
    part = joined_plan.part.original
    assert part is not None
    task = _task(joined_plan, joined_plan.operations[0])
    assert [face.surface for face in task.targets] == [face.surface for face in part.faces] and task.skin == ()
    verdict = ta.verify(joined_plan)
    assert verdict.passed, verdict.reasons
    assert verdict.operations[0].faces == ("1", "2", "3", "4")
    assert verdict.operations[0].area == pytest.approx(sum(face.area for face in part.faces), rel=1e-3)


def test_a_gouge_into_a_member_is_found_on_that_member(joined_plan: Plan) -> None:
    op = joined_plan.operations[0]
    assert op.path is not None
    last = joined_plan.part.original.faces[3] if joined_plan.part.original else op.face
    middle = last.evaluate(np.array([[2 / 3, 5 / 6]])).point[0]
    near = np.linalg.norm(op.path.cc - middle, axis=1) < 3.0
    deep = replace(op.path, cl=op.path.cl - 0.02 * near[:, None] * op.path.axis)
    verdict = ta.verify(replace(joined_plan, operations=(replace(op, path=deep),)))
    assert not verdict.passed
    assert verdict.operations[0].worst_gouge[0].face == "4" and verdict.operations[0].gouge_max > 0.01


def test_the_picture_shows_the_joins(joined_plan: Plan, small_plan: Plan) -> None:
    from toolaxis.report.figures.plots import operation_picture

    for plan, shown in ((joined_plan, True), (small_plan, False)):
        legend = operation_picture(plan, plan.operations[0]).axes[0].get_legend()
        assert legend is not None and ("join of faces" in {text.get_text() for text in legend.get_texts()}) == shown


@pytest.mark.long
def test_a_joined_face_is_divided_as_one() -> None:
    part = ta.load(patches(sheet()))
    made = ta.plan(part, "ball:6", 0.3, faces=[(1, 2, 3, 4)], regions=2, method="normal", workers=1)
    assert [op.face.label for op in made.operations] == ["1+2+3+4a", "1+2+3+4b"]
    assert sum(op.face.area for op in made.operations) == pytest.approx(sum(face.area for face in part.faces), rel=1e-6)
    targets = [face for op in made.operations for face in _task(made, op).targets]
    assert sum(face.area for face in targets) == pytest.approx(sum(face.area for face in part.faces), rel=1e-6)
    assert {face.number for face in targets} == {1, 2, 3, 4} and len(targets) > 4
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons


def test_the_rest_of_a_part_is_planned_beside_a_joined_face() -> None:
    """A joined face and one that stays alone, in whose way both members stand."""
    part = ta.load([*patches(sheet())[:2], sheet(away=40.0)])
    made = ta.plan(part, "ball:6", 0.4, faces="skins", method="normal", workers=1)
    assert [op.face.label for op in made.operations] == ["1+2", "3"] and made.outcome == "complete"
    assert {face.number for face in _task(made, made.operations[1]).surroundings} == {1, 2}
    assert ta.verify(made).passed


def test_lists_with_joined_faces() -> None:
    assert parse_faces("3+4, 7,9-10") == ((3, 4), 7, 9, 10) and parse_faces("Skins") == "skins"
    part = ta.load(patches(sheet()))
    found, left = with_joined(part, "1+2,4")
    assert left == [1, 4] and [face.label for face in found.faces] == ["1+2", "3", "4"]
    found, left = with_joined(part, "skins")
    assert left is None and [face.label for face in found.faces] == ["1+2+3+4"]
    assert with_joined(part, None) == (part, None) and with_joined(part, 2) == (part, 2)
    for wrong in ("3+", "3+4-5", "1-2+3", "+", "3++4"):
        with pytest.raises(InvalidInput, match="is not understood at"):
            parse_faces(wrong)
    apart = ta.load([sheet(), sheet(away=40.0)])
    with pytest.raises(UnsupportedGeometry, match="face 2 does not continue any of the others smoothly"):
        ta.plan(apart, TOOL, 0.1, faces=[(1, 2)])
    with pytest.raises(InvalidInput, match=r"face 2 is joined to face 1\+2"):
        ta.plan(part, TOOL, 0.1, faces="1+2,2")


def test_skins_that_join_nothing_say_so() -> None:
    """Found: `--faces skins` that joined nothing said nothing."""
    apart = ta.load([sheet(), sheet(away=40.0)])
    found, left = with_joined(apart, "skins")
    assert left is None and [face.label for face in found.faces] == ["1", "2"]
    (said,) = (text for text in found.warnings if "skins" in text)
    assert said == ("--faces skins joins nothing: each of the 2 sculptured faces is machined by itself, since none "
                    "continues another one smoothly")
    joined, _ = with_joined(ta.load(patches(sheet())), "skins")
    assert not any("joins nothing" in text for text in joined.warnings)
