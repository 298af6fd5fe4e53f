"""A batch: whole folders or none, the same on any number of processes, resumed, and nothing stops the other jobs."""

import csv
import json
import os
import shutil
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest

import toolaxis as ta
from toolaxis.batch.folder import BatchFolder
from toolaxis.batch.journal import Journal
from toolaxis.batch.run import Batch, batch
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import write_plan

Jobs = list[dict[str, Any]]
Made = Callable[[int], Jobs]
Contents = Callable[[Path], dict[str, bytes]]


def planned(folder: Path) -> list[str]:
    """Names of the jobs that were planned, as often as they were, from the journal."""
    journal = Journal(folder / "journal.jsonl")
    journal.close()
    return [entry["job"] for entry in journal.entries if "outcome" in entry]


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@pytest.fixture(scope="module")
def four(domes: Made, tmp_path_factory: pytest.TempPathFactory) -> tuple[Jobs, Batch, list[str]]:
    """Four jobs on two processes."""
    told: list[str] = []
    jobs = domes(4)
    jobs[1]["verify"] = True
    return jobs, batch(jobs, tmp_path_factory.mktemp("four") / "out", workers=2, told=told.append), told


def plan_into(folder: Path, job: dict[str, Any]) -> None:
    folder.mkdir()
    write_plan(ta.plan(job["part"], job["tool"], job["scallop"], method=job["method"], workers=1), folder)


def test_each_job_has_the_folder_that_plan_writes(four: tuple[Jobs, Batch, list[str]], tmp_path: Path) -> None:
    jobs, made, told = four
    assert made.complete and made.repeated == 0 and not made.cancelled
    assert names(made.folder) == {"journal.jsonl", "summary.csv", "summary.json", *(job["name"] for job in jobs)}
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as fresh:  # one that has compiled no kernel itself
        list(fresh.map(plan_into, [tmp_path / job["name"] for job in jobs], jobs))
    for job in jobs:
        wanted = {path.name: path.read_bytes() for path in (tmp_path / job["name"]).iterdir()}
        found = {path.name: path.read_bytes() for path in (made.folder / job["name"]).iterdir()}
        assert wanted.items() <= found.items()
        judged = {"verdict.json", "verdict-maps.npz"} if "verify" in job else set()
        assert set(found) - set(wanted) == {"job.json"} | judged
    assert sorted(told) == [f"job {job['name']}: complete" for job in jobs]


def test_the_summary_tells_every_job(four: tuple[Jobs, Batch, list[str]]) -> None:
    jobs, made, _ = four
    document = json.loads((made.folder / "summary.json").read_text())
    assert (document["schema"], document["counts"]) == ("toolaxis.batch", {"complete": 4})
    with (made.folder / "summary.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["job"] for row in rows] == [row["job"] for row in document["jobs"]] == [job["name"] for job in jobs]
    for row, record in zip(rows, document["jobs"], strict=True):
        plan = json.loads((made.folder / row["folder"] / "plan.json").read_text())
        assert float(row["length"]) == record["length"] == plan["length"] > 0
        assert record["passes"] == sum(op["orientation"]["passes"] for op in plan["operations"])
    assert [row["verdict"] for row in rows] == ["", "passed", "", ""]


def test_the_same_on_any_number_of_processes_and_in_any_order(four: tuple[Jobs, Batch, list[str]], tmp_path: Path,
                                                              contents: Contents) -> None:
    jobs, made, _ = four
    assert batch(jobs[::-1], tmp_path / "one", workers=1).complete
    assert contents(tmp_path / "one") == contents(made.folder)


def test_a_finished_job_is_not_planned_again_and_a_changed_one_is(domes: Made, tmp_path: Path) -> None:
    jobs, out = domes(3), tmp_path / "out"
    assert batch(jobs[:2], out, workers=1).complete
    before = (out / "dome-000" / "plan.json").stat().st_ino
    told: list[str] = []
    again = batch(jobs, out, workers=1, told=told.append)
    assert again.complete and again.repeated == 2 and told[0] == "2 of 3 jobs are finished already"
    assert (out / "dome-000" / "plan.json").stat().st_ino == before
    assert planned(out) == ["dome-000", "dome-001", "dome-002"]
    jobs[0]["scallop"] = 0.3
    shutil.move(out / "dome-001", tmp_path / "away")
    (out / "dome-002" / "notes.txt").write_text("mine")
    (out / "dome-002" / "op01-face1.apt").unlink()
    told.clear()
    assert batch(jobs, out, workers=1, told=told.append).complete
    assert planned(out)[3:] == ["dome-000", "dome-001", "dome-002"]
    assert {"job dome-000 is not the one that was planned: it is planned again",
            "job dome-001 was finished, but its folder is gone: it is planned again",
            "job dome-002 was finished, but its op01-face1.apt is gone: it is planned again"} <= set(told)
    assert json.loads((out / "dome-000" / "plan.json").read_text())["inputs"]["scallop"] == 0.3
    assert (out / "dome-002.earlier-1" / "notes.txt").read_text() == "mine"
    assert (out / "dome-002" / "op01-face1.apt").exists() and (tmp_path / "away" / "plan.json").exists()


def test_a_job_is_finished_where_its_folder_stands_whatever_the_journal_says(domes: Made, tmp_path: Path) -> None:
    jobs, out = domes(2), tmp_path / "out"
    assert batch(jobs, out, workers=1).complete
    text = (out / "journal.jsonl").read_bytes()
    (out / "journal.jsonl").write_bytes(text.replace(b"dome-001", b"dome-0?1", 1))
    told: list[str] = []
    assert batch(jobs, out, workers=1, told=told.append).repeated == 2
    assert "1 lines of the journal are damaged: it is kept as" in told[0] and "damaged-1" in told[0]
    (out / "journal.jsonl").unlink()
    assert batch(jobs, out, workers=1).repeated == 2


def test_two_batches_do_not_work_on_one_folder(domes: Made, tmp_path: Path) -> None:
    with BatchFolder(tmp_path / "out"), pytest.raises(InvalidInput, match=rf"another batch .*process {os.getpid()} on"):
        batch(domes(1), tmp_path / "out")
    assert list(tmp_path.iterdir()) == []
    assert batch(domes(1), tmp_path / "out", workers=1).complete


def test_folders_of_others_are_left_alone(domes: Made, tmp_path: Path) -> None:
    jobs = domes(1)
    (tmp_path / "dome-000").mkdir()
    (tmp_path / "dome-000" / "plan.json").write_text("mine")
    with pytest.raises(InvalidInput, match="no batch has made it"):
        batch(jobs, tmp_path)
    assert names(tmp_path) == {"dome-000"} and (tmp_path / "dome-000" / "plan.json").read_text() == "mine"
    with pytest.raises(InvalidInput, match="a file of the batch"):
        batch([{**jobs[0], "name": "Summary.csv"}], tmp_path / "new")
    (tmp_path / "file").write_text("x")
    with pytest.raises(InvalidInput, match="is a file"):
        batch(jobs, tmp_path / "file")
    with pytest.raises(InvalidInput, match="cannot be written"):
        batch(jobs, tmp_path / "file" / "out")
    assert names(tmp_path) == {"dome-000", "file"}
