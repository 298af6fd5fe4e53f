"""The command does its work: inspect, plan, verify, the answer no, and Ctrl-C in a real process."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from functools import partial
from math import radians
from pathlib import Path
from typing import Any

import pytest

from toolaxis.cli.main import main
from toolaxis.errors import Cancelled
from toolaxis.search.sectors import sectors

Capture = pytest.CaptureFixture[str]
#: Few axes to choose from, where each costs a search of its own.
UPRIGHT = "--limits=cone:0,0,1,8"
FAST = ("--tool=torus:12x1", "--scallop=0.1", UPRIGHT)
#: What takes long enough to be stopped, and leaves other methods axes of their own.
SLOW = ("--tool=torus:12x1", "--scallop=0.1", "--limits=cone:0,0,1,60")


def strict(text: str) -> dict:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.fixture(scope="session")
def planned(sheet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The plan of the first two faces, with pictures, made by the command."""
    out = tmp_path_factory.mktemp("planned") / "out"
    assert main(["plan", str(sheet), *FAST, "--faces=1-2", "--stickout=50", "--holder=10,0;10,40",
                 "--out", str(out)]) == 0
    return out


def test_inspect_lists_faces_in_table_and_json(sheet: Path, capsys: Capture) -> None:
    assert main(["inspect", str(sheet)]) == 0
    out = capsys.readouterr().out
    assert "3 faces, 3 sculptured" in out and out.count("bspline") == 3
    assert main(["inspect", str(sheet), "--json"]) == 0
    found = strict(capsys.readouterr().out)
    assert (found["schema"], found["version"]) == ("toolaxis.inspect", 1)
    assert found["sha256"] == hashlib.sha256(sheet.read_bytes()).hexdigest()
    face = found["faces"][0]
    assert face["number"] == 1 and 432 < face["area"] < 450 and face["size"][:2] == pytest.approx([24, 18], abs=0.01)
    assert 0 < face["spread"] < 0.3 and face["convex_radius"] > 40


def test_plan_writes_everything_that_verify_and_people_need(sheet: Path, planned: Path) -> None:
    names = {path.name for path in planned.iterdir()}
    assert {"plan.json", "part.step", "op01-face1.apt", "op02-face2.apt", "op01-face1-passes.png",
            "op02-face2-passes.png", "op01-face1-axes.png", "op02-face2-widths.png"} <= names
    assert not {name for name in names if "estimate" in name}, "a study that only a comparison asks for"
    assert not [path for path in planned.parent.iterdir() if path != planned], "debris"
    document = strict((planned / "plan.json").read_text())
    assert document["outcome"] == "complete" and document["part"]["source"] == str(sheet)
    assert document["part"]["sha256"] == hashlib.sha256((planned / "part.step").read_bytes()).hexdigest()
    assert (planned / "part.step").read_bytes() == sheet.read_bytes()
    assert [op["face"] for op in document["operations"]] == [1, 2]
    for op in document["operations"]:
        found = op["orientation"]
        assert found["passes"] >= 3 and found["axis"][2] > 0.49 and found["gouge"] <= 0.01
        assert found["clearance"]["holder"] >= 1.0
        assert op["work_coordinates"]["z"] == pytest.approx(found["axis"], abs=1e-12)


def test_verify_passes_and_writes_verdict_and_maps(planned: Path, capsys: Capture) -> None:
    assert main(["verify", str(planned)]) == 0
    out = capsys.readouterr().out
    assert out.count("pass") >= 2 and "FAIL" not in out
    document = strict((planned / "verdict.json").read_text())
    assert document["passed"] is True and len(document["operations"]) == 2
    for op in document["operations"]:
        assert op["share_within"] >= 0.999 and op["gouge_max"] <= op["gouge_allowed"] == 0.01
    assert (planned / "op01-face1-verdict.png").stat().st_size > 10_000
    assert main(["verify", str(planned), "--json", "--no-pictures"]) == 0
    assert strict(capsys.readouterr().out)["passed"] is True


def test_the_machining_tolerance_goes_with_the_plan(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    """It stands in plan.json, in tables and in the setup sheet's settings, and `verify` judges by it."""
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--faces=1", "--tolerance=0.004", "--no-pictures", "--out", str(out)]) == 0
    assert "tolerance 0.004 mm" in " ".join(capsys.readouterr().out.split())
    assert strict((out / "plan.json").read_text())["inputs"]["tolerance"]["gouge"] == 0.004
    assert main(["verify", str(out), "--no-pictures"]) == 0
    assert "machining tolerance 0.004 mm" in " ".join(capsys.readouterr().out.split())
    judged = strict((out / "verdict.json").read_text())["operations"][0]
    assert judged["gouge_allowed"] == 0.004 and judged["gouge_max"] <= 0.004


@pytest.mark.parametrize("value", ["0", "-1", "nan", "1e9", "1e-9"])
def test_a_machining_tolerance_out_of_range_is_refused(sheet: Path, tmp_path: Path, capsys: Capture,
                                                       value: str) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--faces=1", f"--tolerance={value}", "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert "machining tolerance is " in said and "from 0.0005 to 0.1 mm; 0.01 mm is usual" in said
    assert said.count("\n") == 1 and not out.exists()


def test_verify_fails_where_the_cl_file_was_spoilt(planned: Path, tmp_path: Path, capsys: Capture) -> None:
    import shutil

    folder = tmp_path / "spoilt"
    shutil.copytree(planned, folder)
    path = folder / "op01-face1.apt"
    lines = path.read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line == "PPRINT/PASS 3")
    last = next(k for k, line in enumerate(lines) if line == "PPRINT/PASS 4")
    path.write_text("\n".join(lines[:first] + lines[last:]))
    assert main(["verify", str(folder), "--no-pictures"]) == 1
    out, err = capsys.readouterr()
    assert "FAIL" in out and "op01-face1" in err and "of the area" in err
    assert strict((folder / "verdict.json").read_text())["passed"] is False


def test_plan_prints_json_on_stdout_alone(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--faces=1", "--json", "--no-pictures", "--out", str(out)]) == 0
    printed, err = capsys.readouterr()
    assert strict(printed) == strict((out / "plan.json").read_text())
    assert "not checked: holder" in err.replace("shank, ", "")
    assert not list(out.glob("*.png"))


def test_other_methods_stand_beside_the_plan(sheet: Path, tmp_path: Path, capsys: Capture,
                                             monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("toolaxis.job.planning.comparison.BY_SUB_SURFACE", ("roman",))
    monkeypatch.setattr("toolaxis.strategies.indexed.pictures.sectors", partial(sectors, roll=radians(60)))
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *SLOW, "--faces=1", "--compare", "--feedrate=600", "--rapid=6000",
                 "--out", str(out)]) == 0
    printed, _ = capsys.readouterr()
    assert "the same faces by other methods" in printed and "ball:12" in printed and "600 mm/min in the cut" in printed
    document = strict((out / "plan.json").read_text())
    assert [row["method"] for row in document["baselines"]] == ["plan", "roman", "one", "ball"]
    assert document["inputs"]["rapid"] == 6000 and document["seconds"] > document["length"] / 10
    assert document["operations"][0]["seconds"] == pytest.approx(document["seconds"])
    assert (out / "baselines.png").stat().st_size > 5_000
    assert (out / "op01-face1-estimate.png").stat().st_size > 5_000


def test_a_face_that_no_axis_can_reach_is_the_answer_no(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    code = main(["plan", str(sheet), "--tool=torus:12x1", "--scallop=0.1", "--faces=1", "--limits=cone:0,0,-1,20",
                 "--no-pictures", "--out", str(out)])
    _, err = capsys.readouterr()
    assert code == 1
    assert "face 1: outcome" in err and "Traceback" not in err
    document = strict((out / "plan.json").read_text())
    assert document["outcome"] == "incomplete" and document["operations"][0]["orientation"]["reasons"]
    assert main(["verify", str(out), "--no-pictures"]) == 1
    said = capsys.readouterr().err
    assert "no axis" in said and "verdict on what was made: nothing was made" in said and "stays open: " in said


def start(words: list[str]) -> subprocess.Popen[str]:
    return subprocess.Popen([sys.executable, "-m", "toolaxis.cli.main", *words], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})


def wait_for(process: subprocess.Popen[str], text: str, limit: float = 120.0) -> None:
    assert process.stderr is not None
    began = time.monotonic()
    for line in process.stderr:
        if text in line:
            return
        assert time.monotonic() - began < limit
    pytest.fail(f"the command ended before it said {text!r}")


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
@pytest.mark.parametrize("sign", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)])
def test_a_stop_keeps_finished_faces_in_one_whole_plan(sheet: Path, tmp_path: Path, sign: signal.Signals) -> None:
    process = start(["plan", str(sheet), *SLOW, "--faces=1,2,3", "--workers=2", "--no-pictures",
                     "--out", str(tmp_path / "out")])
    wait_for(process, "face 3 (3 of 3)")
    process.send_signal(sign)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "Traceback" not in err
    assert [path.name for path in tmp_path.iterdir()] == ["out"], "debris"
    document = strict((tmp_path / "out" / "plan.json").read_text())
    assert document["outcome"] == "cancelled"
    finished = {op["face"] for op in document["operations"]}
    assert finished and finished <= {1, 2}
    for face in finished:
        assert (tmp_path / "out" / f"op{face:02}-face{face}.apt").read_text().rstrip().endswith("FINI")


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_ctrl_c_twice_leaves_nothing(sheet: Path, tmp_path: Path) -> None:
    process = start(["plan", str(sheet), "--tool=torus:12x1", "--scallop=0.001", "--faces=1", "--out",
                     str(tmp_path / "out")])
    wait_for(process, "face 1 (1 of 1)")
    process.send_signal(signal.SIGINT)
    time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130 and "Traceback" not in err
    left = list(tmp_path.iterdir())
    assert left == [] or strict((tmp_path / "out" / "plan.json").read_text())["outcome"] == "cancelled"


def test_a_plan_ends_when_its_minutes_are_over_and_keeps_finished_faces(sheet: Path, tmp_path: Path, capsys: Capture,
                                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    from toolaxis.job.planning.planner import PlanningJob
    from toolaxis.progress import TimeLimit

    begun: list[int] = []
    plan_one = PlanningJob._operation

    def count(self: PlanningJob, *rest: Any) -> Any:
        begun.append(1)
        return plan_one(self, *rest)

    monkeypatch.setattr(PlanningJob, "_operation", count)
    monkeypatch.setattr(TimeLimit, "is_up", lambda self: len(begun) > 1)
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--faces=1,2", "--workers=1", "--minutes=5", "--out", str(out)]) == 1
    assert "as the 5 min of --minutes were over" in capsys.readouterr().err
    document = strict((out / "plan.json").read_text())
    assert document["outcome"] == "cancelled" and [op["face"] for op in document["operations"]] == [1]
    assert (out / "op01-face1-passes.png").exists()
    begun.append(1)
    assert main(["plan", str(sheet), *FAST, "--faces=1", "--minutes=5", "--out", str(tmp_path / "none")]) == 1
    assert "no face was finished within 5 min" in capsys.readouterr().err
    assert not (tmp_path / "none").exists()


def test_minutes_have_to_be_above_zero(sheet: Path, capsys: Capture) -> None:
    assert main(["plan", str(sheet), "--minutes=0"]) == 2
    assert "minutes is 0: it must be above zero" in capsys.readouterr().err


@pytest.mark.parametrize("reason, said", [(RuntimeError("no ink"), "RuntimeError: no ink"),
                                          (Cancelled("enough"), "stopped while drawing")])
def test_a_plan_survives_its_pictures(sheet: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch,
                                      reason: Exception, said: str) -> None:
    import toolaxis.job.output.pictures

    def fail(*_: object) -> None:
        raise reason

    monkeypatch.setattr(toolaxis.job.output.pictures, "draw_plan", fail)
    assert main(["plan", str(sheet), *FAST, "--faces=1", "--out", str(tmp_path / "out")]) == 0
    assert said in capsys.readouterr().err
    assert strict((tmp_path / "out" / "plan.json").read_text())["outcome"] == "complete"


def test_a_face_is_planned_in_regions_and_verified(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), "--tool=torus:4x1", "--scallop=0.1", UPRIGHT, "--faces=1", "--regions=2",
                 "--no-pictures", "--out", str(out)]) == 0
    document = strict((out / "plan.json").read_text())
    assert [op["label"] for op in document["operations"]] == ["1a", "1b"]
    assert all(op["region"] for op in document["operations"])
    assert main(["verify", str(out), "--no-pictures"]) == 0
    assert main(["plan", str(sheet), "--tool=torus:8x1", "--scallop=0.1", UPRIGHT, "--faces=1,2", "--orientations=1",
                 "--no-pictures", "--out", str(out)]) == 0
    document = strict((out / "plan.json").read_text())
    assert {op["face"] for op in document["operations"]} == {1, 2}
    assert len({tuple(op["orientation"]["axis"]) for op in document["operations"]}) == 1
    capsys.readouterr()
    assert main(["plan", str(sheet), "--tool=torus:4x1", "--scallop=0.1", "--regions=17", "--out", str(out)]) == 2
    assert "from 1 to 16" in capsys.readouterr().err
