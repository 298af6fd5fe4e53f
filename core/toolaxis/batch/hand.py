"""Processes that carry out jobs, watched from outside: whether they crash, hang or are no longer wanted."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from pathlib import Path

import toolaxis
from toolaxis.batch.task import BatchAnswer, BatchTask
from toolaxis.job.planning.parallel import how_it_ended

#: Seconds between two looks at the user and the clock.
TICK = 0.1
MEGABYTE = 1_000_000
_QUIET = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class WorkerProcess:
    """A process that carries out one task at a time; another one takes its place when it is lost.

    Parameters
    ----------
    above : Path, optional
        Folder in which it has a folder of its own; the system's for temporary files unless given.
    """

    def __init__(self, above: Path | None = None) -> None:
        self._above = above
        self._process: subprocess.Popen[bytes] | None = None
        self._pipe: Connection | None = None
        self._scratch = Path()
        self._task: BatchTask | None = None
        self._began = 0.0
        self._repeated = False

    @property
    def busy(self) -> bool:
        """Whether it has a task."""
        return self._task is not None

    @property
    def pipe(self) -> Connection | None:
        """Where the answer comes from; None without a process."""
        return self._pipe

    def give(self, task: BatchTask) -> None:
        """Begin a task.

        Parameters
        ----------
        task : BatchTask
            With a limit of memory it gets a fresh process, which took none for others yet.
        """
        if task.memory is not None:
            self.dismiss()
        if self._process is None or self._process.poll() is not None:
            self._engage()
        self._task, self._began, self._repeated = task, time.monotonic(), False
        self._send(task)

    def _send(self, task: BatchTask) -> None:
        assert self._pipe is not None
        with suppress(BrokenPipeError, ConnectionResetError):  # the answer tells that the process has ended
            self._pipe.send(task)

    def _engage(self) -> None:
        self.dismiss()
        self._scratch = Path(tempfile.mkdtemp(prefix="hand-" if self._above else "toolaxis-", dir=self._above))
        ours, theirs = Pipe()
        paths = [str(Path(toolaxis.__file__).parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])]
        environment = {**dict.fromkeys(_QUIET, "1"), **os.environ, "PYTHONPATH": os.pathsep.join(paths),
                       "TMPDIR": str(self._scratch.resolve())}
        with (self._scratch / "errors").open("wb") as errors:
            # In a session of its own: Ctrl-C in a terminal goes to every process of the group.
            self._process = subprocess.Popen(
                [sys.executable, "-m", "toolaxis.batch.labour", str(theirs.fileno()), str(self._scratch.resolve())],
                pass_fds=(theirs.fileno(),), env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=errors, start_new_session=True)
        theirs.close()
        self._pipe = ours

    def answer(self, patience: float = 0.0) -> BatchAnswer | None:
        """What came of the task; None while it is at work.

        Parameters
        ----------
        patience : float
            s to wait for it.
        """
        task = self._task
        assert task is not None and self._pipe is not None
        if self._pipe.poll(patience):
            try:
                found: BatchAnswer = self._pipe.recv()
            except (EOFError, OSError):
                found = self._answer_of_crash(task)
            if found.compiled and not self._repeated:  # now the kernels are on disk, and every process gets the same
                self._engage()
                self._task, self._began, self._repeated = task, time.monotonic(), True
                self._send(task)
                return None
            if found.cause not in ("", "input") or task.memory is not None:
                self.dismiss()
        elif (beyond := self._beyond(task)) is not None:
            found = beyond
            self.dismiss()
        else:
            return None
        self._task = None
        return found

    def _beyond(self, task: BatchTask) -> BatchAnswer | None:
        """What is said of a process that is beyond its limits; None where it is within them."""
        spent = time.monotonic() - self._began
        if task.timeout is not None and spent > task.timeout:
            return BatchAnswer("failed", "timeout", f"it took longer than its limit of {task.timeout:g} s", spent=spent)
        if task.memory is not None and self._process is not None:
            taken = sum(map(_resident, (self._process.pid, *descendants(self._process.pid)))) / MEGABYTE
            if taken > task.memory:
                return BatchAnswer("failed", "memory", f"it ran out of memory: its limit is {task.memory:g} MB",
                                   spent=spent)
        return None

    def _answer_of_crash(self, task: BatchTask) -> BatchAnswer:
        """What is said of a process that ended without an answer."""
        assert self._process is not None
        code = self._process.wait()
        said = (self._scratch / "errors").read_text(errors="replace").strip().splitlines() \
            if (self._scratch / "errors").exists() else []
        limit = f"; its limit of memory is {task.memory:g} MB" if task.memory is not None else ""
        last = f": {said[-1]}" if said else ""
        return BatchAnswer("failed", "crash", f"its process ended by {how_it_ended(code)}{limit}{last}",
                           spent=time.monotonic() - self._began)

    def dismiss(self) -> None:
        """End the process at once, with all that it has started, and remove what it left."""
        self._task = None
        if self._process is None:
            return
        if self._process.poll() is None:  # else its number may be another's by now
            for number in (*descendants(self._process.pid), self._process.pid):
                with suppress(ProcessLookupError):
                    os.kill(number, signal.SIGKILL)
        self._process.wait()
        if self._pipe is not None:
            self._pipe.close()
        shutil.rmtree(self._scratch, ignore_errors=True)
        self._process = self._pipe = None


def descendants(number: int) -> list[int]:
    """Processes that a process has started, and those these have started: the kernel of a CAD library is one.

    Parameters
    ----------
    number : int
        Of the process.

    Returns
    -------
    list of int
        Their numbers; empty where the system does not tell.
    """
    found = []
    for task in Path("/proc").glob(f"{number}/task/*/children"):
        with suppress(OSError):
            for child in map(int, task.read_text().split()):
                found += [*descendants(child), child]
    return found


def _resident(number: int) -> int:
    """Bytes of memory that a process has; 0 where the system does not tell."""
    try:
        return int(Path(f"/proc/{number}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0


def by_hand(tasks: Iterator[BatchTask | None], workers: int,
            above: Path) -> Iterator[tuple[BatchTask, BatchAnswer] | None]:
    """Answers to tasks from processes of this machine, as they come.

    Parameters
    ----------
    tasks : iterator of BatchTask
        Asked for the next one when a process is free; None where the next one has to wait for one at work.
    workers : int
        Number of processes.
    above : Path
        Folder for what they write meanwhile.

    Yields
    ------
    tuple of Task and Answer, or None
        None every `TICK` seconds, so that the caller can look after other things.
    """
    at_work: dict[WorkerProcess, BatchTask] = {}
    hands = [WorkerProcess(above) for _ in range(workers)]
    try:
        while True:
            for hand in hands:
                if not hand.busy and (task := next(tasks, None)) is not None:
                    at_work[hand] = task
                    hand.give(task)
            if not at_work:
                return
            wait([hand.pipe for hand in at_work if hand.pipe is not None], TICK)
            yield None
            for hand in list(at_work):
                answer = hand.answer()
                if answer is not None:
                    yield at_work.pop(hand), answer
    finally:
        for hand in hands:
            hand.dismiss()
