"""A batch that is stopped or killed at any moment leaves no process behind, and goes on where it stopped."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import toolaxis as ta
from toolaxis.batch.hand import descendants
from toolaxis.batch.journal import Journal
from toolaxis.batch.run import batch
from toolaxis.progress import Progress

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


def test_a_stop_leaves_no_process_and_no_debris(domes: Made, tmp_path: Path,
                                                started: Callable[[], list[int]]) -> None:
    jobs, out, told = domes(4), tmp_path / "out", []
    made = batch(jobs, out, workers=2, told=told.append, progress=Progress(cancelled=lambda: len(told) > 0))
    assert made.cancelled and 1 <= sum(row.outcome == "complete" for row in made.rows) < 4
    assert started() == []
    done = {row.job for row in made.rows if row.outcome == "complete"}
    assert names(out) == {"journal.jsonl", "summary.csv", "summary.json", *done}
    again = batch(jobs, out, workers=2)
    assert again.complete and again.repeated == len(done)
    nothing = batch(jobs, tmp_path / "a" / "b", progress=Progress(cancelled=lambda: True))
    assert nothing.cancelled and not (tmp_path / "a").exists()


CLIENT = """
import json, sys
from toolaxis.batch.run import batch
sys.path.insert(0, sys.argv[1])
from conftest_jobs import jobs
batch(jobs, sys.argv[2], workers=2, told=lambda text: print(text, flush=True))
"""


def client(count: int, folder: Path, out: Path) -> "subprocess.Popen[str]":
    """A process of its own that carries out so many domes."""
    text = (Path(__file__).parent / "conftest.py").read_text() + (
        "\njobs = [{'name': f'dome-{k:03}', 'part': dome(1 + 0.01 * k), 'tool': 'ball:8', 'scallop': 0.2, "
        f"'method': 'normal'}} for k in range({count})]\n")
    (folder / "conftest_jobs.py").write_text(text)
    root = str(Path(ta.__file__).parents[1])
    return subprocess.Popen([sys.executable, "-c", CLIENT, str(folder), str(out)], stdout=subprocess.PIPE, text=True,
                            env={**os.environ, "PYTHONPATH": root})


def running(number: int) -> bool:
    try:
        return bool(Path(f"/proc/{number}/cmdline").read_bytes())
    except OSError:
        return False


def gone(numbers: list[int]) -> bool:
    for _ in range(300):
        if not any(map(running, numbers)):
            return True
        time.sleep(0.1)
    return False


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
@pytest.mark.parametrize("count, kills", [(4, [2]), pytest.param(200, [30, 55, 75], marks=pytest.mark.long)])
def test_a_batch_that_is_killed_goes_on(tmp_path: Path, domes: Made, contents: Contents, count: int,
                                        kills: list[int]) -> None:
    out = tmp_path / "out"
    for jobs_until_the_end in kills:
        process = client(count, tmp_path, out)
        assert process.stdout is not None
        for _ in range(jobs_until_the_end):
            process.stdout.readline()
        children = descendants(process.pid)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert len(children) == 2 and gone(children), "processes were left behind"
    told: list[str] = []
    made = batch(domes(count), out, workers=2, told=told.append)
    assert made.complete and made.repeated >= max(kills) - 1
    assert not names(out) & {".work", ".lock"}
    assert len(set(planned(out))) == len(planned(out)), "a finished job was planned again"
    done = [text.split()[1].rstrip(":") for text in told if text.endswith(": complete")]
    assert len(done) == count - made.repeated
    plain = tmp_path / "plain"
    assert batch(domes(count), plain, workers=2).complete
    assert contents(out) == contents(plain)


def test_a_process_that_is_killed_costs_its_job_alone(tmp_path: Path, domes: Made,
                                                      started: Callable[[], list[int]]) -> None:
    out, told, jobs = tmp_path / "out", [], domes(4)
    easy, jobs[0] = jobs[0], {**jobs[0], "scallop": 0.0002, "method": "sphere", "timeout": 300}

    def kill(text: str) -> None:
        told.append(text)
        if len(told) == 1:  # the first process has the first job, which takes minutes
            os.kill(started()[0], signal.SIGKILL)

    made = batch(jobs, out, workers=2, told=kill)
    assert [(row.outcome, row.cause) for row in made.rows] == [("failed", "crash"), *[("complete", "")] * 3]
    assert "signal 9 (SIGKILL)" in made.rows[0].reason
    assert batch([easy, *jobs[1:]], out, workers=1, told=told.append).complete
    assert told[-2:] == ["3 of 4 jobs are finished already", "job dome-000: complete"]
