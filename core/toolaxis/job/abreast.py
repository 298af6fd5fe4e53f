"""Independent pieces of work on several processes, with one progress and one stop for all."""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

from toolaxis.errors import Cancelled, InvalidInput, JobError
from toolaxis.progress import Progress

Result = TypeVar("Result")

#: Seconds between two looks for a stop, and between two reports of a worker.
_TICK = 0.1


@dataclass(frozen=True)
class Outcome(Generic[Result]):
    """What came of pieces of work.

    Attributes
    ----------
    results : tuple
        Those that were finished, in the order of the pieces.
    cancelled : bool
        Whether the user asked to stop before all were.
    """

    results: tuple[Result, ...]
    cancelled: bool


def checked_workers(workers: int | None) -> int:
    """How many processes to work with.

    Parameters
    ----------
    workers : int, optional
        As many as the machine lets this process run on unless given; 1 where processes cannot be forked safely: in
        FreeCAD, away from the main thread, and on systems without fork.

    Raises
    ------
    InvalidInput
        When it is no whole number above zero.
    """
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InvalidInput(f"workers is {workers!r}: it must be a whole number above zero, or be left out")
    if not sys.platform.startswith("linux") or "FreeCAD" in sys.modules or multiprocessing.current_process().daemon \
            or threading.current_thread() is not threading.main_thread():
        return 1
    return len(os.sched_getaffinity(0)) if workers is None else workers


def abreast(work: Callable[[int, Progress], Result], count: int, workers: int, progress: Progress) -> Outcome[Result]:
    """Do pieces of work 0, 1, …, several at a time.

    Parameters
    ----------
    work : callable
        Takes the number of the piece and the progress to report to; what it returns can be pickled.
    count : int
        Number of pieces.
    workers : int
        Processes; with 1 the work is done in this one.
    progress : Progress

    Returns
    -------
    Outcome
        The same for every number of workers, unless the user stops it.

    Raises
    ------
    JobError
        When a process ended without a word.
    Exception
        The first that a piece of work raised.
    """
    if min(workers, count) <= 1:
        done: list[Result] = []
        try:
            for index in range(count):
                done.append(work(index, progress))
        except Cancelled:
            return Outcome(tuple(done), True)
        return Outcome(tuple(done), False)
    crew = _Crew(work, progress)
    try:
        return crew.outcome(count, min(workers, count))
    finally:
        crew.dismiss()


class _Crew(Generic[Result]):
    """Forked processes, each of which is handed the next piece when it has finished one."""

    def __init__(self, work: Callable[[int, Progress], Result], progress: Progress) -> None:
        self._work, self._progress = work, progress
        self._members: dict[Connection, Any] = {}
        self._released: list[Any] = []
        self._results: dict[int, Result] = {}

    def outcome(self, count: int, workers: int) -> Outcome[Result]:
        """Results of all pieces.

        Parameters
        ----------
        count, workers : int
        """
        cancelled, waiting = False, iter(range(count))
        for _ in range(workers):
            self._engage().send(next(waiting))
        try:
            while len(self._results) < count:
                self._progress.check()
                for pipe in wait(list(self._members), _TICK):
                    assert isinstance(pipe, Connection)
                    if self._heard(pipe):
                        self._hand(pipe, next(waiting, None))
        except Cancelled:
            cancelled = True
        return Outcome(tuple(self._results[k] for k in sorted(self._results)), cancelled)

    def _engage(self) -> Connection:
        context = multiprocessing.get_context("fork")
        ours, theirs = context.Pipe()
        process = context.Process(target=_labour, args=(self._work, theirs, (*self._members, ours)), daemon=True)
        process.start()
        theirs.close()
        self._members[ours] = process
        return ours

    def _hand(self, pipe: Connection, index: int | None) -> None:
        """Give a process its next piece, or let it go."""
        if index is None:
            self._released.append(self._members.pop(pipe))
            pipe.close()
        else:
            pipe.send(index)

    def _heard(self, pipe: Connection) -> bool:
        """Take one message; whether its sender is ready for the next piece."""
        try:
            kind, value = pipe.recv()
        except EOFError:
            process = self._members.pop(pipe)
            process.join()
            raise JobError("work on several processes", f"process {process.pid}", f"it ended with code "
                           f"{process.exitcode} before its work was done; where memory is short, ask for fewer workers"
                           ) from None
        if kind == "report":
            self._progress.report(*value)
        elif kind == "failed":
            raise value
        else:
            self._results[value[0]] = value[1]
        return bool(kind == "done")

    def dismiss(self) -> None:
        """End all processes; they hold nothing that would have to be put away."""
        for pipe, process in self._members.items():
            pipe.close()
            process.terminate()
        for process in (*self._members.values(), *self._released):
            process.join()


def _labour(work: Callable[[int, Progress], object], pipe: Connection, others: tuple[Connection, ...]) -> None:
    """Pieces of work in a forked process, until there are none; the parent alone hears the user."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    for other in others:
        other.close()
    said: dict[str, float] = {}

    def _report(stage: str, done: float, total: float) -> None:
        if time.monotonic() - said.get(stage, -_TICK) >= _TICK:
            said[stage] = time.monotonic()
            pipe.send(("report", (stage, done, total)))

    progress = Progress(_report)
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the parent is gone
        while True:
            index = pipe.recv()
            try:
                pipe.send(("done", (index, work(index, progress))))
            except (BrokenPipeError, ConnectionResetError):
                return
            except Exception as reason:
                pipe.send(("failed", _portable(reason)))


def _portable(reason: Exception) -> Exception:
    """An exception that the parent can raise."""
    try:
        pickle.loads(pickle.dumps(reason))
    except Exception:
        return JobError("work on several processes", type(reason).__name__, str(reason))
    return reason
