"""Setups of one part in a batch: a job goes on after the jobs for the setups before it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.batch.journal import Journal
from toolaxis.batch.run import Batch, batch
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.plan.plan import Plan

Jobs = list[dict[str, Any]]


def sheet(length: float) -> ta.Part:
    """A sheet, 16 mm across, that waves a little."""
    x, y = np.meshgrid(np.linspace(0, length, 8), np.linspace(0, 16, 6), indexing="ij")
    return ta.Part.from_faces([ta.Face.from_bspline(np.stack([x, y, 0.4 * np.sin(y / 5)], axis=-1))])


@pytest.fixture(scope="module")
def setups() -> Jobs:
    one = {"part": sheet(30), "tool": "ball:8", "scallop": 0.2, "limits": "cone:0,0,1,30", "verify": True}
    return [{**one, "name": "left", "held": "x<10"}, {**one, "name": "right", "held": "x>25", "after": "left"},
            {**one, "name": "else", "part": sheet(12)}]


@pytest.fixture(scope="module")
def made(setups: Jobs, tmp_path_factory: pytest.TempPathFactory) -> Batch:
    return batch(setups, tmp_path_factory.mktemp("setups") / "out", workers=2)


def test_the_second_job_machines_what_the_first_one_left(made: Batch) -> None:
    assert made.complete, [row.reason for row in made.rows]
    left, right = (read_plan(made.folder / name) for name in ("left", "right"))
    assert [len(plan.machined_before) for plan in (left, right)] == [0, 1]
    assert right.machined_before[0].area == pytest.approx(left.account.machined, rel=1e-3)
    whole = sheet(30).faces[0].area
    assert left.account.machined + right.account.machined > 0.99 * whole
    assert [row.figures["verdict"] for row in made.rows] == ["passed"] * 3


def test_it_is_the_plan_that_the_library_makes(setups: Jobs, made: Batch) -> None:
    def planned(job: dict[str, Any], *after: Plan) -> Plan:
        return ta.plan(job["part"], job["tool"], job["scallop"], limits=job["limits"], held=job["held"], workers=1,
                       after=after)

    second = planned(setups[1], planned(setups[0]))
    assert read_plan(made.folder / "right").length == pytest.approx(second.length, rel=1e-9)


def test_setups_that_did_not_change_are_not_planned_again(setups: Jobs, made: Batch) -> None:
    again = batch(setups, made.folder, workers=1)
    assert again.complete and again.repeated == 3


def test_a_change_of_the_first_setup_is_one_of_the_second(setups: Jobs) -> None:
    first, second, other = (job.key for job in read_jobs(setups))
    changed = [{**setups[0], "held": "x<12"}, *setups[1:]]
    assert [job.key == key for job, key in zip(read_jobs(changed), (first, second, other), strict=True)] == [
        False, False, True]


def test_without_the_first_plan_there_is_none_for_the_second(setups: Jobs, tmp_path: Path) -> None:
    wrong = {**setups[1], "name": "wrong", "after": "else"}
    third = {**setups[1], "name": "third", "after": ["left", "wrong"]}
    found = batch([setups[0], setups[2], wrong, third], tmp_path / "out", workers=2)
    rows = {row.job: row for row in found.rows}
    assert (rows["wrong"].outcome, rows["wrong"].cause) == ("failed", "input")
    assert rows["wrong"].reason == "the plan of setup 1 is one of another part: plan all setups of one part"
    assert (rows["third"].outcome, rows["third"].cause) == ("failed", "input")
    assert rows["third"].reason == "job wrong, after which this one goes on, has no plan: see to that one first"
    assert rows["left"].outcome == rows["else"].outcome == "complete"


def test_each_job_begins_after_those_that_it_goes_on_after(setups: Jobs, made: Batch) -> None:
    journal = Journal(made.folder / "journal.jsonl")
    journal.close()
    ended = next(k for k, entry in enumerate(journal.entries) if entry["job"] == "left" and "outcome" in entry)
    begun = {entry["job"]: k for k, entry in enumerate(journal.entries) if "started" in entry}
    assert begun["left"] < begun["else"] < ended < begun["right"], "another job is done meanwhile"
