"""The written form: whole or not at all, read back as written, and refused where something changed."""

import json
from pathlib import Path

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import OF_PLAN, OF_VERDICT, read_plan, stage_folder, write_plan
from toolaxis.plan.plan import Plan


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_plan_is_read_back_as_it_was_written(small_plan: Plan, folder: Path) -> None:
    assert names(folder) == ["op01-face1.apt", "part.json", "plan.json"]
    back = read_plan(folder)
    assert back.outcome == "complete" and back.inputs == small_plan.inputs and back.tools[0].name == "torus:12x1"
    mine, theirs = back.operations[0], small_plan.operations[0]
    assert mine.path is not None and theirs.path is not None and mine.frame is not None and theirs.frame is not None
    assert np.abs(mine.path.cl - theirs.path.cl).max() <= 0.5001e-6
    assert np.abs(mine.path.axis - theirs.path.axis).max() <= 2e-9
    assert np.array_equal(mine.path.kind, theirs.path.kind)
    assert np.array_equal(mine.frame.x, theirs.frame.x)
    assert np.array_equal(mine.orientation.axis, theirs.orientation.axis)
    uv = np.random.default_rng(1).random((20, 2))
    assert np.array_equal(back.part.faces[0].evaluate(uv).point, small_plan.part.faces[0].evaluate(uv).point)


def test_nothing_appears_when_writing_fails(small_plan: Plan, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError), stage_folder(tmp_path / "a" / "b") as stage:
        write_plan(small_plan, stage.folder)
        raise RuntimeError("the power went")
    assert names(tmp_path) == []


def test_an_earlier_plan_is_replaced_and_the_users_files_stay(small_plan: Plan, folder: Path) -> None:
    (folder / "notes.txt").write_text("mine")
    (folder / "op07-face9.apt").write_text("old")
    (folder / "verdict.json").write_text("{}")
    with stage_folder(folder) as stage:
        write_plan(small_plan, stage.folder)
        assert "op07-face9.apt" in names(folder), "the old plan stands until the new one is whole"
        stage.publish(OF_PLAN)
    assert names(folder) == ["notes.txt", "op01-face1.apt", "part.json", "plan.json"]


def test_an_earlier_verdict_goes_with_its_pictures_and_the_plan_stays(folder: Path) -> None:
    before = names(folder)
    for name in ("verdict.json", "verdict-maps.npz", "op02-face2-verdict.png"):
        (folder / name).write_text("old")
    (folder / "op01-face1-passes.png").write_text("of the plan")
    with stage_folder(folder) as stage:
        (stage.folder / "verdict.json").write_text("{}")
        stage.publish(OF_VERDICT)
    assert names(folder) == sorted([*before, "op01-face1-passes.png", "verdict.json"])


def test_an_earlier_plan_stays_when_the_new_one_fails(small_plan: Plan, folder: Path) -> None:
    before = {name: (folder / name).read_bytes() for name in names(folder)}
    with pytest.raises(RuntimeError), stage_folder(folder) as stage:
        write_plan(small_plan, stage.folder)
        raise RuntimeError
    assert {name: (folder / name).read_bytes() for name in names(folder)} == before


def _edit(folder: Path, old: str, new: str) -> None:
    text = (folder / "plan.json").read_text()
    assert old in text
    (folder / "plan.json").write_text(text.replace(old, new, 1))


def test_missing_empty_cut_and_foreign_files_are_refused(folder: Path) -> None:
    whole = (folder / "plan.json").read_text()
    for content, said in (("", "is not JSON, or was cut short"), (whole[:500], "was cut short"), ("[]", "is \\[\\]"),
                          ('{"schema": "other"}', "no 'version'|is 'other'")):
        (folder / "plan.json").write_text(content)
        with pytest.raises(InvalidInput, match=said):
            read_plan(folder)
    (folder / "plan.json").unlink()
    with pytest.raises(InvalidInput, match=r"plan.json does not exist"):
        read_plan(folder)
    with pytest.raises(InvalidInput, match="does not exist"):
        read_plan(folder / "nowhere")


def test_a_changed_part_is_refused(folder: Path) -> None:
    path = folder / "part.json"
    path.write_text(path.read_text().replace('"flip": false', '"flip": true'))
    with pytest.raises(InvalidInput, match="has changed since the plan was made"):
        read_plan(folder)


def test_a_missing_or_cut_cl_file_is_refused(folder: Path) -> None:
    path = folder / "op01-face1.apt"
    text = path.read_text()
    path.write_text(text[:len(text) // 2])
    with pytest.raises(InvalidInput, match=r"op01-face1.apt: CL .*"):
        read_plan(folder)
    path.unlink()
    with pytest.raises(InvalidInput, match="folder is incomplete"):
        read_plan(folder)


def test_names_that_lead_out_of_the_folder_are_refused(folder: Path) -> None:
    _edit(folder, '"op01-face1.apt"', '"../op01-face1.apt"')
    with pytest.raises(InvalidInput, match="plain name"):
        read_plan(folder)


def test_a_plan_of_another_version_is_refused(folder: Path) -> None:
    _edit(folder, '"version": 2', '"version": 99')
    with pytest.raises(InvalidInput, match="schema version 99"):
        read_plan(folder)


def test_plan_json_is_strict_and_names_its_schema(folder: Path) -> None:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    document = json.loads((folder / "plan.json").read_text(), parse_constant=refuse)
    assert (document["schema"], document["version"], document["units"]["length"]) == ("toolaxis.plan", 2, "mm")
