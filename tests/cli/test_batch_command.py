"""`toolaxis batch` as a command: tables, JSON, exit codes, and Ctrl-C in a real process."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from toolaxis.cli.main import main

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def job_file(sheet: Path, tmp_path: Path) -> Path:
    """Two jobs on the sheet, the second one of which has no axis."""
    path = tmp_path / "jobs.toml"
    path.write_text(f'[defaults]\npart = "{sheet}"\ntool = "ball:8"\nscallop = 0.2\nfaces = 1\nmethod = "normal"\n'
                    '[[jobs]]\nname = "good"\n[[jobs]]\nname = "bad"\nlimits = "cone:0,0,-1,20"\n')
    return path


def test_a_batch_is_planned_printed_and_not_repeated(job_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["batch", str(job_file), "--workers=1", "--out", str(out)]) == 1
    printed, err = capsys.readouterr()
    assert "good" in printed and "incomplete" in printed
    assert "job good: complete" in err and "job bad: incomplete: face 1" in err
    assert "2 of 2 jobs ended, 0 of them in an earlier run" in err
    assert main(["batch", str(job_file), "--json", "--out", str(out)]) == 1
    printed, err = capsys.readouterr()
    document = json.loads(printed)
    assert document == json.loads((out / "summary.json").read_text())
    assert [row["outcome"] for row in document["jobs"]] == ["complete", "incomplete"]
    assert "2 of 2 jobs are finished already" in err
    assert main(["verify", str(out / "good"), "--no-pictures"]) == 0


def test_a_good_batch_ends_with_zero_beside_its_job_file(job_file: Path, tmp_path: Path, capsys: Capture,
                                                         monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    job_file.write_text(job_file.read_text().split('[[jobs]]\nname = "bad"')[0])
    assert main(["batch", "jobs.toml"]) == 0
    assert (tmp_path / "out" / "jobs" / "good" / "plan.json").exists()


@pytest.mark.parametrize("change, words, said", [
    ("colour = 1", (), "job 2 (bad): unknown 'colour'"), ("part = 'no.step'", (), "no.step' does not exist"),
    ("", ("--workers=0",), "workers is 0"), ("", ("--workers=2", "--scheduler=tcp://x:1"), "either a scheduler"),
    ("", ("--out=/proc/out",), "cannot be written"),
])
def test_wrong_input_is_one_sentence_and_writes_nothing(job_file: Path, tmp_path: Path, capsys: Capture, change: str,
                                                        words: tuple[str, ...], said: str) -> None:
    job_file.write_text(job_file.read_text() + change)
    assert main(["batch", str(job_file), "--out", str(tmp_path / "new" / "out"), *words]) == 2
    printed, err = capsys.readouterr()
    assert printed == "" and len(err.splitlines()) == 1 and said in err
    assert [path.name for path in tmp_path.iterdir()] == ["jobs.toml"]


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_ctrl_c_leaves_what_is_finished_and_no_debris(job_file: Path, tmp_path: Path) -> None:
    text = job_file.read_text().replace('limits = "cone:0,0,-1,20"', 'scallop = 0.0002\nmethod = "sphere"')
    job_file.write_text(text)
    process = subprocess.Popen([sys.executable, "-m", "toolaxis.cli.main", "batch", str(job_file), "--workers=2",
                                "--out", str(tmp_path / "out")], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True)
    assert process.stderr is not None
    for line in process.stderr:
        if "job good: complete" in line:
            break
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130 and "the same command goes on where it stopped" in err and "Traceback" not in err
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"good", "journal.jsonl", "summary.csv",
                                                                   "summary.json"}
    assert {path.name for path in tmp_path.iterdir()} == {"jobs.toml", "out"}
