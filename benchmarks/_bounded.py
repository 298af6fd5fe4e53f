"""Run a command as a process of its own that is bounded in time and memory, and tell what it took (Linux)."""

import os
import resource
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

#: Clock seconds for each second of processor time, beyond which a process counts as hung.
PATIENCE = 6.0
#: Share of the limit that a process gets, once it is asked to stop, to put away what it has.
GRACE = 0.5
_TICK = 0.2
_HERTZ = os.sysconf("SC_CLK_TCK")
#: Where /proc/PID/stat has the session, and the times of a process and of its children, after the name; see proc(5).
_SESSION, _TIMES = 3, slice(11, 15)
_SHORT_OF_MEMORY = ("MemoryError", "bad_alloc", "Cannot allocate memory", "Unable to allocate", "OutOfMemory",
                    "out of memory")


class Bounds(NamedTuple):
    """seconds : of processor time;  memory : of address space, bytes."""

    seconds: float
    memory: int


class MessageLine(NamedTuple):
    """A line of the process's messages with the processor seconds that it had used by then."""

    cpu: float
    text: str


class Ran(NamedTuple):
    """code : what the process returned, below zero for the signal that ended it;  wall, cpu : seconds;  peak : greatest
    resident set of one process, bytes;  ended : "" where it ended by itself, "time" where it used up its processor
    time, "clock" where that was waited for too long;  killed : whether it had to be, as it did not stop;
    output : its stdout;  lines : its stderr."""

    code: int
    wall: float
    cpu: float
    peak: int
    ended: str
    killed: bool
    output: str
    lines: tuple[MessageLine, ...]

    @property
    def short_of_memory(self) -> bool:
        """Whether it failed for want of memory."""
        return self.code != 0 and any(word in line.text for line in self.lines for word in _SHORT_OF_MEMORY)

    @property
    def last_words(self) -> str:
        """The last line that it said, or by which signal it went."""
        said = [line.text for line in self.lines if line.text.strip()]
        if self.code < 0:
            return f"ended by {signal.Signals(-self.code).name}"
        return said[-1].strip() if said else f"ended with code {self.code} without a word"


def python(*words: str) -> list[str]:
    """A command in the interpreter that runs this."""
    return [sys.executable, *words]


def run(command: Sequence[str], bounds: Bounds, folder: Path) -> Ran:
    """Run a command; past its time it gets SIGTERM once, and SIGKILL where it does not end by that.

    Time is processor time, of the process and of all that it starts, so that a busy machine does not change what is
    finished, with `PATIENCE` times as much on the clock for what hangs.

    Parameters
    ----------
    command : sequence of str
    bounds : Bounds
    folder : Path
        For its output while it runs.
    """
    def _bind() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (bounds.memory, bounds.memory))

    began = time.monotonic()
    with open(folder / "stdout", "w+", encoding="utf-8", errors="replace") as out:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.PIPE,
                                   preexec_fn=_bind, start_new_session=True)
        watch = _ProcessWatch(process.pid, bounds.seconds, began)
        try:
            lines, status, used = watch.followed(process)
        except BaseException:
            _kill(process.pid)
            raise
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        return Ran(process.returncode, time.monotonic() - began, used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss,
                   watch.ended, watch.killed, out.read(), tuple(lines))


class _ProcessWatch:
    """Listens to a process and ends it in time."""

    def __init__(self, number: int, seconds: float, began: float) -> None:
        self._number, self._seconds, self._began = number, seconds, began
        self._told: tuple[float, float] | None = None
        self.ended, self.killed = "", False

    def followed(self, process: "subprocess.Popen[bytes]") -> tuple[list[MessageLine], int, resource.struct_rusage]:
        """Its messages, its wait status, and what it used."""
        assert process.stderr is not None
        lines: list[MessageLine] = []
        rest, ended = b"", None
        with selectors.DefaultSelector() as selector, process.stderr as pipe:
            os.set_blocking(pipe.fileno(), False)
            selector.register(pipe, selectors.EVENT_READ)
            while ended is None:
                heard = bool(selector.select(_TICK)) if selector.get_map() else bool(time.sleep(_TICK))
                more = pipe.read() if heard else None
                if more == b"":
                    selector.unregister(pipe)
                *whole, rest = (rest + (more or b"")).split(b"\n")
                cpu = self._cpu()
                lines += [MessageLine(cpu, text.decode("utf-8", "replace")) for text in whole]
                self._bound(cpu)
                number, status, used = os.wait4(self._number, os.WNOHANG)
                ended = (status, used) if number else None
            *whole, rest = (rest + (pipe.read() or b"")).split(b"\n")
            cpu = ended[1].ru_utime + ended[1].ru_stime
            lines += [MessageLine(cpu, text.decode("utf-8", "replace")) for text in (*whole, rest) if text]
        _kill(self._number)  # what it may have left behind
        return lines, *ended

    def _cpu(self) -> float:
        """Processor seconds of the process, of those that it started, and of those that they have waited for."""
        ticks = 0
        for path in Path("/proc").glob("[0-9]*/stat"):
            with suppress(OSError):  # gone meanwhile
                fields = path.read_text().rpartition(")")[2].split()
                if int(fields[_SESSION]) == self._number:
                    ticks += sum(int(count) for count in fields[_TIMES])
        return ticks / _HERTZ

    def _bound(self, cpu: float) -> None:
        wall = time.monotonic() - self._began
        if self._told is None:
            if cpu > self._seconds or wall > PATIENCE * self._seconds:
                self._told, self.ended = (cpu, wall), "time" if cpu > self._seconds else "clock"
                with suppress(ProcessLookupError):
                    os.kill(self._number, signal.SIGTERM)
        elif cpu - self._told[0] > GRACE * self._seconds or wall - self._told[1] > PATIENCE * GRACE * self._seconds:
            self.killed = True
            _kill(self._number)


def _kill(group: int) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(group, signal.SIGKILL)
