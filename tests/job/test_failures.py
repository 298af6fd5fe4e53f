"""Where the program itself fails on one face, that is its outcome: the others are planned, judged and written."""

import json
import os
import signal
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import REPORT_AT
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.job.files.plan_folder import PLAN, read_plan, stage_folder, write_plan
from toolaxis.job.output import verify as judge
from toolaxis.job.output.verify import verdict_document
from toolaxis.job.planning import asked_division, timing
from toolaxis.job.planning import clean_up_zones as zones
from toolaxis.job.planning.parallel import check_workers
from toolaxis.plan.plan import Plan
from toolaxis.shape.part import Part
from toolaxis.strategies.constant_lead import search

TOOL = ta.Tool.ball(4)
SCALLOP, LIMITS = 0.2, "cone:0,0,1,4"
FORKED = pytest.param(2, marks=pytest.mark.skipif(check_workers(2) == 1, reason="processes are only forked on Linux"))


def sheets(count: int = 3) -> Part:
    """Wavy sheets of 9 x 6 mm beside each other."""
    x, y = np.meshgrid(np.linspace(0, 9, 4), np.linspace(0, 6, 4), indexing="ij")
    z = 0.4 * np.sin(x / 6) * np.cos(y / 5)
    return Part.from_faces([ta.Face.from_bspline(np.stack([x + 40 * k, y, z], axis=-1)) for k in range(count)])


@pytest.fixture(scope="module")
def faultless() -> Plan:
    """The plan of three sheets in which nothing fails."""
    return ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=1)


def planted(monkeypatch: pytest.MonkeyPatch, raised: Exception, number: int = 2) -> None:
    """A fault in whatever looks closer at axes of one face."""
    whole, screen = Feasibility.witness, Feasibility.screen

    def _witness(self, axis):
        if self.face.number == number:
            raise raised
        return whole(self, axis)

    def _screen(self, axes):
        if self.face.number == number:
            raise raised
        return screen(self, axes)

    monkeypatch.setattr(Feasibility, "witness", _witness)
    monkeypatch.setattr(Feasibility, "screen", _screen)


def checked(made: Plan, said: str, number: int = 2) -> None:
    """That one face failed, and every other one is there."""
    lost = [op for op in made.operations if op.face.number == number]
    assert lost and all(op.failed and not op.done and not op.left for op in lost)
    assert all(op.done for op in made.operations if op.face.number != number), [
        op.orientation.reasons for op in made.operations]
    assert {op.face.number for op in made.operations} >= {1, 2, 3}
    assert made.outcome == "incomplete"
    (reason, *_), trace = lost[0].orientation.reasons, lost[0].traceback
    assert reason.startswith(f"failed: {said}") and "test_failures.py:" in reason and REPORT_AT in reason
    assert "Traceback" in trace and "test_failures.py" in trace


@pytest.mark.parametrize("workers", [1, FORKED])
@pytest.mark.parametrize("raised, said", [
    (IndexError("odd index"), "IndexError: odd index"), (MemoryError(), "out of memory"),
    pytest.param(AssertionError(), "AssertionError", marks=pytest.mark.long)])
def test_a_fault_in_a_search_costs_its_face(workers: int, raised: Exception, said: str,
                                            monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    planted(monkeypatch, raised)
    made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=workers)
    checked(made, said)
    with stage_folder(tmp_path / "out") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "out" / PLAN).read_text())
    (op,) = [op for op in document["operations"] if op["face"] == 2]
    assert op["orientation"]["outcome"] == "failed" and op["cl_file"] is None
    text = (tmp_path / "out" / op["failure_file"]).read_text()
    assert op["failure_file"] == "failed-op02-face2.txt"
    assert all(words in text for words in (said.split(":")[0], REPORT_AT, "Traceback", TOOL.name, ta.__version__))
    again = read_plan(tmp_path / "out")
    assert [one.orientation.outcome for one in again.operations] == [one.orientation.outcome for one in made.operations]


def slow(asked: dict[str, object], workers: int) -> object:
    return pytest.param(asked, workers, marks=pytest.mark.long)


@pytest.mark.parametrize("asked, workers", [
    ({"regions": 2}, 2), ({"orientations": 1}, 1), ({"method": "one"}, 1), ({"method": "normal"}, 1),
    slow({"regions": 2}, 1), slow({"orientations": "auto"}, 1), slow({"orientations": 1}, 2),
    slow({"method": "one"}, 2), slow({"method": "sectors"}, 2), slow({"method": "ball"}, 1)], ids=str)
def test_in_every_way_to_plan(asked: dict[str, object], workers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    planted(monkeypatch, IndexError("planted"))
    made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=min(workers, check_workers(workers)),
                   **asked)  # type: ignore[arg-type]
    checked(made, "IndexError: planted")


@pytest.mark.parametrize("workers", [1, FORKED])
def test_where_the_axis_moves(workers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = search.sturz

    def _moving(task):
        if task.worth.face.number == 2:
            raise IndexError("planted")
        return whole(task)

    monkeypatch.setattr(search, "sturz", _moving)
    tool = ta.Tool.torus(diameter=6, corner_radius=1)
    made = ta.plan(sheets(), tool, SCALLOP, limits=LIMITS, workers=workers, strategy="sturz")
    checked(made, "IndexError: planted")


def test_of_two_faces_that_fail_each_has_its_own_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Feasibility.quick

    def _quick(self, rows):
        if self.face.number != 3:
            raise KeyError(f"face {self.face.number}")
        return whole(self, rows)

    monkeypatch.setattr(Feasibility, "quick", _quick)
    for asked in ({}, {"method": "one"}, {"orientations": 1}):
        made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=1, **asked)  # type: ignore[arg-type]
        reasons = {op.face.number: op.orientation.reasons[0] for op in made.operations if op.failed}
        assert sorted(reasons) == [1, 2] and all(f"face {number}" in why for number, why in reasons.items()), reasons


@pytest.mark.skipif(check_workers(2) == 1, reason="processes are only forked on Linux")
def test_a_worker_that_dies_costs_its_face(monkeypatch: pytest.MonkeyPatch) -> None:
    whole, here = Feasibility.witness, os.getpid()

    def _witness(self, axis):
        if self.face.number == 2 and os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return whole(self, axis)

    monkeypatch.setattr(Feasibility, "witness", _witness)
    made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=2)
    assert [op.orientation.outcome for op in made.operations] == ["feasible", "failed", "feasible"]
    assert "SIGKILL" in made.operations[1].orientation.reasons[0] and made.outcome == "incomplete"


@pytest.mark.parametrize("workers", [1, FORKED])
def test_a_fault_after_the_search_costs_its_face(workers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = zones.zones_of

    def _zones(plan, op):
        if op.face.number == 2:
            raise ZeroDivisionError("planted")
        return whole(plan, op)

    monkeypatch.setattr(zones, "zones_of", _zones)
    made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=workers)
    assert [op.orientation.outcome for op in made.operations] == ["feasible", "failed", "feasible"]
    assert made.operations[1].path is None and made.outcome == "incomplete"


def test_a_fault_in_timing_costs_its_face(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = timing._path_time

    def _time(mounting, op, angles, inputs):
        if op.face.number == 2:
            raise FloatingPointError("planted")
        return whole(mounting, op, angles, inputs)

    monkeypatch.setattr(timing, "_path_time", _time)
    made = ta.plan(sheets(), TOOL, SCALLOP, machine="mikron-ucp-710", limits=LIMITS, workers=1)
    assert {op.face.number: op.orientation.outcome for op in made.operations} == {1: "feasible", 2: "failed",
                                                                                  3: "feasible"}
    assert all(op.time is not None for op in made.operations if op.done)


def test_a_fault_of_the_whole_keeps_every_face_and_the_plan_incomplete(monkeypatch: pytest.MonkeyPatch,
                                                                       tmp_path: Path) -> None:
    def _fail(*_: object, **__: object) -> None:
        raise IndexError("planted")

    monkeypatch.setattr("toolaxis.job.planning.pipeline.add_times", _fail)
    made = ta.plan(sheets(), TOOL, SCALLOP, limits=LIMITS, workers=1)
    assert all(op.done for op in made.operations) and made.outcome == "incomplete"
    (fault,) = made.faults
    assert fault.sentence.startswith("failed: IndexError") and "Traceback" in fault.traceback
    with stage_folder(tmp_path / "out") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "out" / PLAN).read_text())
    assert document["faults"] == [fault.sentence] and document["failure_file"] == "failed-plan.txt"
    assert "Traceback" in (tmp_path / "out" / "failed-plan.txt").read_text()
    assert [one.sentence for one in read_plan(tmp_path / "out").faults] == [fault.sentence]


def test_a_face_that_cannot_be_written_keeps_no_other_from_the_disk(faultless: Plan, monkeypatch: pytest.MonkeyPatch,
                                                                    tmp_path: Path) -> None:
    from toolaxis.job.files import plan_folder as folder

    whole = folder.operation_text
    monkeypatch.setattr(folder, "operation_text", lambda op, inputs: 1 // 0 if op.name.endswith("face2") else
                        whole(op, inputs))
    with stage_folder(tmp_path / "out") as stage:
        written = write_plan(faultless, stage.folder)
        stage.publish()
    assert [op.done for op in written.operations] == [True, False, True] and written.outcome == "incomplete"
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "failed-op02-face2.txt", "op01-face1.apt", "op03-face3.apt", "part.json", PLAN]


def test_the_judge_s_own_fault_is_told_of_the_operation_that_it_was_about(faultless: Plan,
                                                                              monkeypatch: pytest.MonkeyPatch) -> None:
    made, whole = faultless, judge.measure

    def _measure(task, *rest):
        if task.name.endswith("face2"):
            raise MemoryError if rest[1] == 1 else IndexError("planted")
        return whole(task, *rest)

    monkeypatch.setattr(judge, "measure", _measure)
    for threads, said in ((1, "out of memory"), (2, "IndexError: planted")):
        verdict = ta.verify(made, threads=threads)
        assert [op.passed for op in verdict.operations] == [True, False, True] and not verdict.passed
        assert verdict.operations[1].reasons[0].startswith(f"failed: {said}") and not verdict.unjudged
        document = json.loads(json.dumps(verdict_document(made, verdict), allow_nan=False))
        assert document["passed"] is False and document["operations"][1]["gouge_max"] is None


def test_several_processes_judge_as_one_does(faultless: Plan) -> None:
    one, two = (ta.verify(faultless, workers=workers) for workers in (1, 2))
    assert verdict_document(faultless, one) == verdict_document(faultless, two) and one.passed
    for own, other in zip(one.operations, two.operations, strict=True):
        assert [seen.face.label for seen in own.maps] == [seen.face.label for seen in other.maps]
        for seen, there in zip(own.maps, other.maps, strict=True):
            assert seen.face.surface.control.tolist() == there.face.surface.control.tolist()
            assert seen.remaining.tolist() == there.remaining.tolist() and seen.gouge.tolist() == there.gouge.tolist()


def test_a_process_that_dies_costs_the_operation_that_it_judged(faultless: Plan,
                                                                monkeypatch: pytest.MonkeyPatch) -> None:
    whole = judge.measure

    def _measure(task, *rest):
        return os._exit(3) if task.name.endswith("face2") else whole(task, *rest)

    monkeypatch.setattr(judge, "measure", _measure)
    verdict = ta.verify(faultless, workers=2)
    assert [op.passed for op in verdict.operations] == [True, False, True] and not verdict.unjudged
    assert "exit code 3" in verdict.operations[1].reasons[0]


def test_a_face_that_cannot_be_divided_so_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 3, 4), indexing="ij")
    small = ta.Face.from_bspline(np.stack([x + 40, y, np.zeros_like(x)], axis=-1))
    monkeypatch.setattr(asked_division, "mean_width", lambda face: 100.0)  # else narrow faces are asked for no number
    made = ta.plan(Part.from_faces([*sheets(1).faces, small]), TOOL, SCALLOP, faces=[1, 2], regions=2, limits=LIMITS,
                   workers=1)
    assert [op.face.label for op in made.operations] == ["1a", "1b", "2"]
    assert made.operations[2].orientation.outcome == "not_found" and made.operations[0].done
    assert "cannot be divided" in made.operations[2].orientation.reasons[0]


def test_the_address_for_reports_is_told_once() -> None:
    root = ET.parse(Path(__file__).parents[2] / "package.xml").getroot()
    space = root.tag.partition("}")[0] + "}"
    assert [one.text for one in root.iter(f"{space}url") if one.get("type") == "bugtracker"] == [REPORT_AT]
