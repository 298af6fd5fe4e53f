"""A batch on a real cluster, a scheduler with two workers on this machine: the same results, whoever is killed."""

import gc
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

import toolaxis as ta
from toolaxis.batch import cluster as cluster_module
from toolaxis.batch.hand import descendants
from toolaxis.batch.run import batch
from toolaxis.errors import InvalidInput, JobError, MissingBackend
from toolaxis.progress import Progress

pytestmark = [pytest.mark.filterwarnings("ignore::DeprecationWarning"),
              pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
              pytest.mark.filterwarnings("ignore::ResourceWarning")]

Made = Callable[[int], list[dict[str, Any]]]
Contents = Callable[[Path], dict[str, bytes]]


class Cluster:
    """A scheduler and two workers with a thread each."""

    def __init__(self, folder: Path) -> None:
        file = folder / "scheduler.json"
        self.scheduler = self._start(folder, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                                     "--scheduler-file", str(file))
        self.address = ""
        for _ in range(600):
            if file.exists() and file.read_text():
                self.address = json.loads(file.read_text())["address"]
                break
            time.sleep(0.1)
        assert self.address, "the scheduler did not start"
        self.workers = [self._start(folder, "worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard",
                                    "--local-directory", str(folder / f"worker-{k}")) for k in range(2)]
        with cluster_module.connect_to_scheduler(self.address) as client:
            assert until(lambda: len(client.nthreads()) == 2), "the workers did not start"

    @staticmethod
    def _start(folder: Path, *words: str) -> "subprocess.Popen[bytes]":
        root = str(Path(ta.__file__).parents[1])
        return subprocess.Popen([sys.executable, "-m", "dask", *words], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL,
                                env={**os.environ, "PYTHONPATH": root, "TMPDIR": str(folder)})

    def hands(self) -> list[int]:
        """Processes that carry out jobs."""
        return [number for worker in self.workers for number in descendants(worker.pid)]

    def close(self) -> None:
        """End all processes."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[], Cluster]]:
    pytest.importorskip("distributed")
    with ExitStack() as stack:
        def started() -> Cluster:
            found = Cluster(tmp_path_factory.mktemp("cluster"))
            stack.callback(found.close)
            return found

        yield started


def until(asked: Callable[[], bool]) -> bool:
    for _ in range(300):
        if asked():
            return True
        time.sleep(0.1)
    return False


def test_wrong_words_for_a_cluster_are_refused_and_write_nothing(domes: Made, tmp_path: Path,
                                                                 monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InvalidInput, match="either a scheduler or a number of workers"):
        batch(domes(1), tmp_path / "out", scheduler="tcp://127.0.0.1:1", workers=2)
    monkeypatch.setattr(cluster_module, "_PATIENCE", 1.0)
    pytest.importorskip("distributed")
    for address in ("tcp://127.0.0.1:1", "nonsense://x", ""):
        with pytest.raises(InvalidInput, match="no scheduler answers at"):
            batch(domes(1), tmp_path / "out", scheduler=address)
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingBackend, match=r"toolaxis\[cluster\]"):
        batch(domes(1), tmp_path / "out", scheduler="tcp://127.0.0.1:1")
    assert list(tmp_path.iterdir()) == []


def test_what_does_not_answer_leaves_nothing_that_is_closed_while_python_collects(
        monkeypatch: pytest.MonkeyPatch) -> None:
    """Closing takes a lock, and the next connection would wait for it for ever."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(cluster_module, "_PATIENCE", 1.0)
    gc.collect()
    gc.disable()
    try:
        for address in ("tcp://127.0.0.1:1", "nonsense://x", ""):
            with pytest.raises(InvalidInput), cluster_module.connect_to_scheduler(address):
                pass
        left = {one.status for one in gc.get_objects() if issubclass(type(one), distributed.Client)}
        assert left <= {"closed"}
    finally:
        gc.enable()


def test_the_same_as_on_this_machine_and_a_hang_costs_its_job_alone(cluster: Callable[[], Cluster], domes: Made,
                                                                    tmp_path: Path, contents: Contents) -> None:
    jobs, there = domes(4), cluster()
    slow = {**jobs[0], "name": "slow", "scallop": 0.0002, "method": "sphere", "timeout": 3}
    made = batch([slow, *jobs], tmp_path / "there", scheduler=there.address)
    assert [(row.outcome, row.cause) for row in made.rows] == [("failed", "timeout"), *[("complete", "")] * 4]
    assert batch(jobs, tmp_path / "here", workers=2).complete
    assert contents(tmp_path / "there") == contents(tmp_path / "here")
    assert all(worker.poll() is None for worker in there.workers)


def test_a_stop_ends_the_jobs_on_the_cluster_too(cluster: Callable[[], Cluster], domes: Made, tmp_path: Path) -> None:
    there, told, (one, two) = cluster(), [], domes(2)
    slow = [{**one, "name": f"slow-{k}", "scallop": 0.0002, "method": "sphere", "timeout": 300} for k in range(3)]
    made = batch([two, *slow], tmp_path / "out", scheduler=there.address, told=told.append,
                 progress=Progress(cancelled=lambda: "job dome-001: complete" in told and len(there.hands()) == 2))
    assert made.cancelled and [row.outcome for row in made.rows] == ["complete", *["not done"] * 3]
    assert until(lambda: there.hands() == []), "jobs go on though nobody waits for them"


@pytest.mark.parametrize("count, early, late", [(5, 1, 2), pytest.param(200, 40, 90, marks=pytest.mark.long)])
def test_whoever_is_killed_nothing_is_lost_and_nothing_done_twice(cluster: Callable[[], Cluster], domes: Made,
                                                                  tmp_path: Path, contents: Contents, count: int,
                                                                  early: int, late: int) -> None:
    jobs, first, told, out = domes(count), cluster(), [], tmp_path / "out"

    def kill(text: str) -> None:
        if not text.startswith("job "):  # that the workers are not there yet
            return
        told.append(text)
        if len(told) == early:
            first.workers[0].send_signal(signal.SIGKILL)
        if len(told) == late:
            first.scheduler.send_signal(signal.SIGKILL)

    with pytest.raises(JobError, match=r"run the batch again, it goes on where it stopped"):
        batch(jobs, out, scheduler=first.address, told=kill)
    assert all(text.endswith(": complete") for text in told) and late <= len(told) < count
    second = cluster()
    made = batch(jobs, out, scheduler=second.address)
    assert made.complete and made.repeated == len(told)
    outcomes = [json.loads(line.partition(" ")[2]) for line in (out / "journal.jsonl").read_text().splitlines()]
    done = [entry["job"] for entry in outcomes if "outcome" in entry]
    assert sorted(done) == [job["name"] for job in jobs]
    assert batch(jobs, tmp_path / "here", workers=2).complete
    assert contents(out) == contents(tmp_path / "here")
