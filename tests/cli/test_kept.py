"""What is finished when the user stops is kept and said: real processes, real signals, `timeout` too."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from toolaxis.cli import stopping
from toolaxis.cli.main import main
from toolaxis.cli.stopping import Ended, StopSignals, writing
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.job.output.post import verdict_of

FAST = ["--tool=ball:6", "--scallop=0.2", "--limits=cone:0,0,1,10", "--no-pictures"]
posix = pytest.mark.skipif(sys.platform == "win32", reason="no signals to other processes")
COMMAND = ["-m", "toolaxis.cli.main"]


def start(words: list[str], before: list[str] | None = None, run: list[str] | None = None) -> subprocess.Popen[str]:
    return subprocess.Popen([*(before or []), sys.executable, *(run or COMMAND), *words], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})


def wait_for(process: subprocess.Popen[str], text: str) -> None:
    assert process.stderr is not None
    assert any(text in line for line in process.stderr), f"the command ended before it said {text!r}"


def whole(folder: Path) -> list[int]:
    """Faces of a plan that was stopped and is otherwise whole."""
    plan = read_plan(folder)
    assert plan.outcome == "cancelled" and plan.operations and all(op.done for op in plan.operations)
    return [op.face.number for op in plan.operations]


@pytest.fixture(scope="session")
def planned(sheet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("kept") / "out"
    assert main(["plan", str(sheet), *FAST, "--out", str(out)]) == 0
    return out


@posix
@pytest.mark.skipif(shutil.which("timeout") is None, reason="there is no timeout(1)")
@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.long), 2])
def test_timeout_leaves_the_finished_faces(sheet: Path, tmp_path: Path, workers: int) -> None:
    """It signals the process and then its whole group, so that the process hears it twice and its workers once."""
    out = tmp_path / "out"
    process = start(["plan", str(sheet), *FAST, f"--workers={workers}", "--out", str(out)], ["timeout", "500"])
    wait_for(process, "face 3 (3 of 3)")
    process.send_signal(signal.SIGTERM)  # that it passes on as it does when the time is over
    _, said = process.communicate(timeout=120)
    assert "Traceback" not in said and "holds those that were" in said
    assert set(whole(out)) <= {1, 2} and [path.name for path in tmp_path.iterdir()] == ["out"]


@posix
def test_signals_while_the_plan_is_written_do_not_interrupt_it(sheet: Path, tmp_path: Path) -> None:
    slow = ("import sys, time, toolaxis.cli.plan as command\n"
            "write = command.write_plan\n"
            "def written(*given):\n"
            "    print('writing', file=sys.stderr, flush=True)\n"
            "    time.sleep(4)\n"
            "    return write(*given)\n"
            "command.write_plan = written\n"
            "from toolaxis.cli.main import main\n"
            "sys.exit(main(sys.argv[1:]))")
    out = tmp_path / "out"
    process = start(["plan", str(sheet), *FAST, "--workers=1", "--out", str(out)], run=["-c", slow])
    wait_for(process, "face 2 (2 of 3)")
    process.send_signal(signal.SIGINT)
    wait_for(process, "writing")
    for pause, sign in ((0.0, signal.SIGTERM), (stopping.TOGETHER + 0.5, signal.SIGINT), (0.1, signal.SIGTERM)):
        time.sleep(pause)
        process.send_signal(sign)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130 and "Traceback" not in said
    assert whole(out) == [1] and [path.name for path in tmp_path.iterdir()] == ["out"]


@posix
@pytest.mark.parametrize(("sign", "workers"), [pytest.param(signal.SIGINT, 1, marks=pytest.mark.long),
                                               (signal.SIGTERM, 1), (signal.SIGINT, 2)])
def test_a_judge_that_is_stopped_keeps_what_was_judged(planned: Path, tmp_path: Path, sign: signal.Signals,
                                                       workers: int) -> None:
    folder = tmp_path / "out"
    shutil.copytree(planned, folder)
    process = start(["verify", str(folder), "--no-pictures", f"--workers={workers}"])
    wait_for(process, f"op{workers + 1:02d}")  # that begins when another one is judged
    process.send_signal(sign)
    process.send_signal(sign)
    out, said = process.communicate(timeout=120)
    if process.returncode == 0:
        pytest.skip("the verdict was finished before the signal came")
    assert process.returncode == 130 and "Traceback" not in said and "no verdict on the plan" in said
    document = json.loads((folder / "verdict.json").read_text())
    judged = [op["name"] for op in document["operations"]]
    assert document["passed"] is False and document["complete"] is False
    assert judged[0] in ("op01-face1", "op02-face2")[:workers] and document["operations"][0]["passed"] is True
    assert document["unjudged"] and len(judged) + len(document["unjudged"]) == 3
    for name in document["unjudged"]:
        assert any(why.startswith(f"{name}: not verified") for why in document["reasons"])
    assert "NOT VERIFIED" in out and "not verified to the end" in verdict_of(folder)
    assert main(["report", str(folder)]) == 0
    assert "not verified to the end" in (folder / "report.html").read_text()


def test_a_verdict_survives_its_pictures(planned: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                         capsys: pytest.CaptureFixture[str]) -> None:
    from toolaxis.errors import Cancelled

    folder = tmp_path / "out"
    shutil.copytree(planned, folder)

    def _fail(*_: object) -> None:
        raise Cancelled("enough")

    monkeypatch.setattr("toolaxis.job.output.pictures.draw_verdict", _fail)
    assert main(["verify", str(folder)]) == 0
    assert "the verdict is whole" in capsys.readouterr().err
    assert json.loads((folder / "verdict.json").read_text())["passed"] is True


def test_a_face_that_fails_is_told_with_how_to_report_it(sheet: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                         capsys: pytest.CaptureFixture[str]) -> None:
    from toolaxis.feasibility.feasibility import Feasibility

    witness = Feasibility.witness
    monkeypatch.setattr(Feasibility, "witness", lambda self, axis: witness(self, axis) if self.face.number != 2 else
                        1 // 0)
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--workers=1", "--out", str(out)]) == 1
    printed, said = capsys.readouterr()
    assert "face 2: failed: ZeroDivisionError" in said and "failed-op02-face2.txt" in said and "failed" in printed
    assert "Traceback" not in said and "Traceback" in (out / "failed-op02-face2.txt").read_text()
    assert main(["verify", str(out), "--no-pictures"]) == 1
    assert main(["report", str(out)]) == 0
    page = (out / "report.html").read_text()
    assert "op02-face2 has no axis: failed: ZeroDivisionError" in page and "failed-op02-face2.txt" in page
    monkeypatch.undo()
    assert main(["plan", str(sheet), *FAST, "--faces=2", "--out", str(out)]) == 0
    assert not list(out.glob("failed-*")), "an earlier plan's files stay"


def test_what_fails_outside_of_a_face_is_told_in_a_sentence_too(sheet: Path, tmp_path: Path,
                                                                monkeypatch: pytest.MonkeyPatch,
                                                                capsys: pytest.CaptureFixture[str]) -> None:
    def _fail(*_: object, **__: object) -> None:
        raise KeyError("planted")

    monkeypatch.setattr("toolaxis.job.planning.pipeline.choose_faces", _fail)
    assert main(["plan", str(sheet), *FAST, "--out", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert "Traceback" in said and said.splitlines()[-1].startswith("toolaxis: failed: KeyError: 'planted', at ")


@posix
def test_signals_close_together_are_one_and_a_later_one_ends(monkeypatch: pytest.MonkeyPatch,
                                                             capfd: pytest.CaptureFixture[str]) -> None:
    now = [100.0]
    monkeypatch.setattr(stopping.time, "monotonic", lambda: now[0])
    before = signal.getsignal(signal.SIGTERM)
    with StopSignals() as heard:
        assert not heard.asked()
        for sign in (signal.SIGTERM, signal.SIGTERM, signal.SIGINT):
            os.kill(os.getpid(), sign)
            now[0] += 0.9
            assert heard.asked()
        with writing(), writing():
            os.kill(os.getpid(), signal.SIGTERM)
        with pytest.raises(Ended):
            os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)  # one more does not disturb the clearing up
    assert signal.getsignal(signal.SIGTERM) is before
    assert capfd.readouterr().err.count("stopping and keeping what is finished") == 1
    with writing():  # nobody hears signals
        pass
