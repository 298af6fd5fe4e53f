"""A face on which the program fails, or for which there is no time, costs its job no other face."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.batch.labour import answer_task
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.job.output import verify as judge
from toolaxis.progress import TimeLimit
from toolaxis.shape.part import Part


@pytest.fixture
def job() -> list[dict[str, object]]:
    x, y = np.meshgrid(np.linspace(0, 14, 5), np.linspace(0, 10, 5), indexing="ij")
    part = Part.from_faces([ta.Face.from_bspline(np.stack([x + 40 * k, y, 0.4 * np.sin(x / 6)], axis=-1))
                            for k in range(2)])
    return [{"name": "two", "part": part, "tool": "ball:6", "scallop": 0.2, "limits": "cone:0,0,1,5", "verify": True}]


def test_a_fault_in_planning(job: list[dict[str, object]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    witness = Feasibility.witness
    monkeypatch.setattr(Feasibility, "witness", lambda self, axis: witness(self, axis) if self.face.number != 2 else
                        1 // 0)
    answer = answer_task(read_jobs(job)[0].task(), tmp_path, {})
    assert answer.outcome == "incomplete" and "face 2: failed: ZeroDivisionError" in answer.reason
    document = json.loads(answer.files["plan.json"])
    assert [op["orientation"]["outcome"] for op in document["operations"]] == ["feasible", "failed"]
    assert b"Traceback" in answer.files["failed-op02-face2.txt"] and "op01-face1.apt" in answer.files


def test_a_fault_in_judging(job: list[dict[str, object]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = judge.measure
    monkeypatch.setattr(judge, "measure", lambda task, *rest: whole(task, *rest) if task.name == "op01-face1" else
                        1 // 0)
    answer = answer_task(read_jobs(job)[0].task(), tmp_path, {})
    assert answer.outcome == "incomplete" and "op02-face2: failed: ZeroDivisionError" in answer.reason
    assert [op["passed"] for op in json.loads(answer.files["verdict.json"])["operations"]] == [True, False]


def test_a_job_whose_minutes_are_over(job: list[dict[str, object]], tmp_path: Path,
                                      monkeypatch: pytest.MonkeyPatch) -> None:
    begun: set[int] = set()
    witness = Feasibility.witness

    def note(self: Feasibility, axis: NDArray[np.float64]) -> object:
        begun.add(self.face.number)
        return witness(self, axis)

    monkeypatch.setattr(Feasibility, "witness", note)
    monkeypatch.setattr(TimeLimit, "is_up", lambda self: 2 in begun)
    job[0] |= {"minutes": 5}
    answer = answer_task(read_jobs(job)[0].task(), tmp_path, {})
    assert answer.outcome == "incomplete"
    assert "planning was stopped when the 5 min of 'minutes' were over" in answer.reason
    document = json.loads(answer.files["plan.json"])
    assert document["outcome"] == "cancelled" and [op["face"] for op in document["operations"]] == [1]
    assert [op["passed"] for op in json.loads(answer.files["verdict.json"])["operations"]] == [True]
    answer = answer_task(read_jobs(job)[0].task(), tmp_path, {})
    assert (answer.outcome, answer.cause, answer.files) == ("failed", "timeout", {})
    assert answer.reason == "no face was finished within the 5 min of 'minutes'"
