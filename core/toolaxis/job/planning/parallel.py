"""Independent pieces of work on several processes, with one progress and one stop for all."""

import ctypes
import faulthandler
import mmap
import multiprocessing
import signal
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import IO, Generic, NamedTuple, TypeVar

from toolaxis.errors import Cancelled, Fault, InvalidInput, fault, process_fault
from toolaxis.numeric.shares import count_cores, use_cores
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress

Result = TypeVar("Result")

#: Seconds between two looks for a stop, and between two reports of a worker.
_TICK = 0.1
#: Signals that ask the parent to stop; they go to its whole group.
_STOPS = (signal.SIGINT, signal.SIGTERM)


@dataclass(frozen=True)
class Outcome(Generic[Result]):
    """What came of pieces of work.

    Attributes
    ----------
    results : dict of int to result
        Those of the pieces that were finished, by their numbers and in their order.
    faults : dict of int to Fault
        What went wrong with others: a piece that fails, or whose process dies, costs none beside it.
    cancelled : bool
        Whether the user asked to stop before all were tried.
    """

    results: dict[int, Result]
    faults: dict[int, Fault]
    cancelled: bool


def check_workers(workers: int | None) -> int:
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
    return count_cores() if workers is None else workers


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
        The same for every number of workers, unless the user stops it or a process dies.
    """
    found: Outcome[Result] = Outcome({}, {}, False)
    waiting = deque(range(count))
    if min(workers, count) > 1:
        crew = _Crew(work, workers, progress, found, waiting)
        try:
            crew.work()
        except Cancelled:
            crew.gather()
            return _in_order(found, True)
        finally:
            crew.dismiss()
    try:
        while waiting:
            index = waiting.popleft()
            try:
                found.results[index] = work(index, progress)
            except Cancelled:
                raise
            except Exception as reason:
                found.faults[index] = fault(reason)
    except Cancelled:
        return _in_order(found, True)
    return _in_order(found, False)


def _in_order(found: Outcome[Result], cancelled: bool) -> Outcome[Result]:
    """An outcome with its pieces in the order of their numbers."""
    return Outcome(dict(sorted(found.results.items())), dict(sorted(found.faults.items())), cancelled)


def how_it_ended(code: int | None) -> str:
    """How a process ended, in words.

    Parameters
    ----------
    code : int or None
        Its exit code; that of a signal is negative.
    """
    if code is None or code >= 0:
        return f"exit code {code}"
    try:
        return f"signal {-code} ({signal.Signals(-code).name})"
    except ValueError:
        return f"signal {-code}"


class _Member(NamedTuple):
    """A process, the piece that it has, and the file into which it writes where it stood when it crashes."""

    process: BaseProcess
    piece: int
    said: IO[bytes]


class _Crew(Generic[Result]):
    """Forked processes, each of which is handed the next piece when it has finished one.

    Parameters
    ----------
    work : callable
    workers : int
        Processes at most; they share as many cores.
    progress : Progress
    found : Outcome
        Receives what comes of the pieces.
    waiting : deque of int
        Pieces that nobody has yet; those that remain when no process can be started stay in it.
    """

    def __init__(self, work: Callable[[int, Progress], Result], workers: int, progress: Progress,
                 found: Outcome[Result], waiting: deque[int]) -> None:
        self._work, self._progress, self._found, self._waiting = work, progress, found, waiting
        self._members: dict[Connection, _Member] = {}
        self._workers = workers
        #: How many of the processes are at work, for all of them to see.
        self._busy = ctypes.c_int.from_buffer(mmap.mmap(-1, mmap.PAGESIZE))
        self._released: list[_Member] = []

    def work(self) -> None:
        """Have all pieces done.

        Raises
        ------
        Cancelled
            When the user asked to stop.
        """
        self._fill(min(self._workers, len(self._waiting)))
        while self._members:
            self._progress.check()
            for pipe in wait(list(self._members), _TICK):
                assert isinstance(pipe, Connection)
                if not self._take_message(pipe, self._progress):
                    continue
                if pipe in self._members and self._waiting:
                    self._hand(pipe)
                elif pipe in self._members:
                    self._release(pipe)
                else:  # its process has died
                    self._fill(len(self._members) + 1)

    def gather(self) -> None:
        """Take what was finished and has not been heard yet."""
        while ready := wait(list(self._members), 0):
            for pipe in ready:
                assert isinstance(pipe, Connection)
                if self._take_message(pipe, NO_PROGRESS) and pipe in self._members:
                    self._release(pipe)

    def _release(self, pipe: Connection) -> _Member:
        """Let a process go that no piece is left for, or that has died."""
        member = self._members.pop(pipe)
        self._released.append(member)
        self._busy.value = len(self._members)
        pipe.close()
        return member

    def _fill(self, workers: int) -> None:
        """Start processes for pieces that wait, until there are so many, or the system lets no more be started."""
        while self._waiting and len(self._members) < workers:
            try:
                pipe = self._engage()
            except OSError:
                return
            self._hand(pipe)

    def _engage(self) -> Connection:
        context = multiprocessing.get_context("fork")
        with ExitStack() as stack:
            said = stack.enter_context(tempfile.TemporaryFile())
            ours, theirs = map(stack.enter_context, context.Pipe())
            process = context.Process(target=_labour, args=(self._do_piece, theirs, (*self._members, ours), said),
                                      daemon=True)
            # Until the child ignores them, signals to the group wait.
            before = signal.pthread_sigmask(signal.SIG_BLOCK, _STOPS)
            try:
                process.start()
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)
            stack.pop_all()
        theirs.close()
        self._members[ours] = _Member(process, -1, said)
        self._busy.value = len(self._members)
        return ours

    def _do_piece(self, index: int, progress: Progress) -> Result:
        """Do a piece, on the cores that the other processes leave."""
        with use_cores(self._workers, self._busy):
            return self._work(index, progress)

    def _hand(self, pipe: Connection) -> None:
        """Give a process its next piece."""
        index = self._waiting.popleft()
        self._members[pipe] = self._members[pipe]._replace(piece=index)
        with suppress(BrokenPipeError, ConnectionResetError):  # it has died: that is heard next
            pipe.send(index)

    def _take_message(self, pipe: Connection, progress: Progress) -> bool:
        """Take one message; whether its sender is done with its piece."""
        try:
            kind, value = pipe.recv()
        except (EOFError, ConnectionResetError):
            member = self._release(pipe)
            member.process.join()
            member.said.seek(0)
            self._found.faults[member.piece] = process_fault(how_it_ended(member.process.exitcode),
                                                             member.said.read().decode(errors="replace"))
            return True
        index = self._members[pipe].piece
        if kind == "report":
            progress.report(*value)
        elif kind == "failed":
            self._found.faults[index] = value
        else:
            self._found.results[index] = value
        return bool(kind != "report")

    def dismiss(self) -> None:
        """End all processes; they hold nothing that would have to be put away."""
        for pipe, member in self._members.items():
            pipe.close()
            member.process.kill()
        for member in (*self._members.values(), *self._released):
            member.process.join()
            member.said.close()


def _labour(work: Callable[[int, Progress], object], pipe: Connection, others: tuple[Connection, ...],
            said: IO[bytes]) -> None:
    """Pieces of work in a forked process, until there are none; the parent alone hears the user."""
    for number in _STOPS:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _STOPS)
    faulthandler.enable(said)
    for other in others:
        other.close()
    reported: dict[str, float] = {}

    def _report(stage: str, done: float, total: float) -> None:
        if time.monotonic() - reported.get(stage, -_TICK) >= _TICK:
            reported[stage] = time.monotonic()
            pipe.send(("report", (stage, done, total)))

    progress = Progress(_report)
    with activate_progress(progress), suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the parent is gone
        while True:
            index = pipe.recv()
            try:
                pipe.send(("done", work(index, progress)))
            except (BrokenPipeError, ConnectionResetError):
                return
            except Exception as reason:
                pipe.send(("failed", fault(reason)))
