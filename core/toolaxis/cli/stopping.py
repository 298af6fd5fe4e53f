"""Ctrl-C and SIGTERM: the first one asks the work to stop and keeps what is finished, a later one ends at once.

Some senders send twice: `timeout` signals the process and then its group, and a hand on the keyboard is impatient.  So
signals that follow closely are taken for the same one, and none interrupts the writing of what is finished.
"""

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

#: For so long after the first signal others are taken for the same one, s.
TOGETHER = 2.0


class Ended(KeyboardInterrupt):
    """A later signal.

    A class of its own: where KeyboardInterrupt itself leaves code that ``exec`` runs (dataclasses are made so), Python
    ends the process by the signal, whoever caught it since.
    """


class StopSignals:
    """Hears the signals while it is entered."""

    def __init__(self) -> None:
        self._first: float | None = None
        self._ended = False
        self._writing = 0
        self._before: dict[signal.Signals, Any] = {}

    def asked(self) -> bool:
        """Whether Ctrl-C was pressed or SIGTERM came."""
        return self._first is not None

    @contextmanager
    def writing(self) -> Iterator[None]:
        """A block that no signal interrupts: it writes what is finished."""
        self._writing += 1
        try:
            yield
        finally:
            self._writing -= 1

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if self._first is None:
            self._first = now
            again = b"Ctrl-C" if number == signal.SIGINT else b"the signal"
            # print may be interrupted itself
            os.write(2, b"toolaxis: stopping and keeping what is finished; " + again + b" once more, "
                     + str(int(TOGETHER)).encode() + b" s from now or later, ends at once and keeps nothing\n")
        elif now - self._first > TOGETHER and not self._writing and not self._ended:
            self._ended = True  # one more would only disturb the clearing up
            raise Ended

    def __enter__(self) -> "StopSignals":
        global _current
        with suppress(ValueError):  # not the main thread: no signal comes here
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._on_signal)
        _current = self
        return self

    def __exit__(self, *reason: object) -> None:
        global _current
        _current = None
        for number, before in self._before.items():
            signal.signal(number, before)


#: Signals are the process's, and so is who hears them.
_current: StopSignals | None = None


@contextmanager
def writing() -> Iterator[None]:
    """A block that no signal interrupts, whoever hears them; see `Stopping.writing`."""
    if _current is None:
        yield
        return
    with _current.writing():
        yield
