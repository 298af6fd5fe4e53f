"""What goes wrong in a batch is told in a sentence, stops no other job, and loses nothing."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from toolaxis.batch.hand import WorkerProcess
from toolaxis.batch.jobfile import CheckedJob, read_jobs
from toolaxis.batch.run import batch
from toolaxis.batch.task import BatchTask

Jobs = list[dict[str, Any]]
Made = Callable[[int], Jobs]
NEVER: dict[str, Any] = {"tool": "ball:8", "scallop": 0.0002}


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


class Crash:
    """Ends the process that reads it from a pickle."""

    def __reduce__(self) -> tuple[Any, ...]:
        return os.abort, ()


class Garbled:
    """Cannot be read from a pickle."""

    def __reduce__(self) -> tuple[Any, ...]:
        return int, ("seven",)


def test_a_crash_a_hang_and_a_lack_of_memory_are_told_and_stop_nobody(domes: Made, tmp_path: Path,
                                                                      monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = [*domes(5), {**domes(1)[0], "name": "garbled"}]
    jobs[0] |= {"name": "crash"}
    jobs[1] |= {**NEVER, "method": "sphere", "name": "hang", "timeout": 3}
    jobs[2] |= {"name": "memory", "memory": 60}
    task = CheckedJob.task

    def spoilt(job: CheckedJob) -> BatchTask:
        made = task(job)
        spoil = {"crash": Crash(), "garbled": Garbled()}
        return replace(made, options={"spoilt": spoil[job.name]}) if job.name in spoil else made

    monkeypatch.setattr(CheckedJob, "task", spoilt)
    told: list[str] = []
    made = batch(jobs, tmp_path / "out", workers=2, told=told.append)
    assert [(row.outcome, row.cause) for row in made.rows] == [
        ("failed", "crash"), ("failed", "timeout"), ("failed", "memory"), ("complete", ""), ("complete", ""),
        ("failed", "crash")]
    assert [row.folder for row in made.rows] == ["", "", "", "dome-003", "dome-004", ""]
    assert "exit code 1: ValueError" in made.rows[5].reason
    assert "signal 6 (SIGABRT)" in made.rows[0].reason and "limit of 3 s" in made.rows[1].reason
    assert "limit is 60 MB" in made.rows[2].reason and not made.complete
    assert names(tmp_path / "out") == {"journal.jsonl", "summary.csv", "summary.json", "dome-003", "dome-004"}
    monkeypatch.undo()
    jobs[1].pop("timeout"), jobs[2].pop("memory")
    jobs[1] |= {"scallop": 0.2, "method": "normal"}
    again = batch(jobs, tmp_path / "out", workers=2)
    assert again.complete and again.repeated == 2


class Compile:
    """Leaves a mark in a file and compiles a kernel in the process that reads it from a pickle."""

    def __init__(self, mark: Path) -> None:
        self.mark = mark

    def __reduce__(self) -> tuple[Any, ...]:
        return exec, (f"open({str(self.mark)!r}, 'a').write('x')\nimport numba\nnumba.njit(lambda: 1)()",)


def test_a_process_that_had_to_compile_does_the_job_again_with_what_is_on_disk(domes: Made, tmp_path: Path) -> None:
    pytest.importorskip("numba")
    (job,) = read_jobs(domes(1))
    task, hand = job.task(), WorkerProcess(tmp_path)
    try:
        for options, count in (({"compile": Compile(tmp_path / "mark")}, "xx"), ({"none": None}, "xx")):
            hand.give(replace(task, options=options))
            while (answer := hand.answer(1.0)) is None:
                pass
            assert answer.cause == "error" and (tmp_path / "mark").read_text() == count
        assert not answer.compiled
    finally:
        hand.dismiss()
    assert [path.name for path in tmp_path.iterdir()] == ["mark"]


def test_memory_that_planning_asks_for_beyond_the_limit_is_refused(domes: Made, tmp_path: Path) -> None:
    code = ("import sys, resource, numpy as np\n"
            "from pathlib import Path\n"
            "from toolaxis.batch import labour\n"
            "from toolaxis.job.planning import pipeline\n"
            "from toolaxis.batch.jobfile import read_jobs\n"
            "pipeline.plan = lambda *_, **__: np.ones(10**9)\n"
            "points = [[[x, y, 0.01 * x * y] for y in range(4)] for x in range(4)]\n"
            "import toolaxis as ta\n"
            "face = ta.Face.from_bspline(points)\n"
            "task = read_jobs([dict(name='a', part=face, tool='ball:2', scallop=0.1, memory=900)])[0].task()\n"
            "answer = labour.answer_task(task, Path(sys.argv[1]), {})\n"
            "assert (answer.cause, answer.reason) == ('memory', 'it ran out of memory: its limit is 900 MB'), answer\n")
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=True, timeout=120)
    assert list(tmp_path.iterdir()) == []


def test_faces_without_an_axis_and_wrong_parts_are_told(domes: Made, tmp_path: Path) -> None:
    job = domes(1)[0]
    (tmp_path / "broken.step").write_text("no STEP file\n" * 9)
    made = batch([{**job, "name": "below", "limits": "cone:0,0,-1,20"},
                  {**job, "name": "broken", "part": tmp_path / "broken.step"}], tmp_path / "out", workers=1)
    assert [(row.outcome, row.cause, row.folder) for row in made.rows] == [
        ("incomplete", "", "below"), ("failed", "input", "")]
    assert made.rows[0].reason.startswith("face 1: ") and made.rows[0].figures["without_axis"] == 1
    assert made.rows[1].reason.startswith(str(tmp_path / "broken.step"))
    assert json.loads((tmp_path / "out" / "below" / "plan.json").read_text())["outcome"] == "incomplete"
    again = batch([{**job, "name": "below", "limits": "cone:0,0,-1,20"}], tmp_path / "out", workers=1)
    assert again.repeated == 1 and again.rows[0].reason == made.rows[0].reason
