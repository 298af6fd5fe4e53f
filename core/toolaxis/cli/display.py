"""Progress on stderr: a bar with the time that remains on a terminal, plain lines elsewhere."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from toolaxis.progress import Progress, Remaining

_EVERY, _STEP = 5.0, 5.0


@dataclass
class _Stage:
    """How far a stage is, and what was said of it, in hundredths."""

    share: float = 0.0
    said: float = 0.0


class _Lines:
    """One plain line when a stage begins for the first time, and every few seconds after where it came on since.

    A stage that begins again (the next candidate's passes) is not told again before it is further than ever.
    """

    def __init__(self) -> None:
        self._stages: dict[str, _Stage] = {}
        self._remaining = Remaining()
        self._said = 0.0

    def report(self, stage: str, done: float, total: float) -> None:
        """Say how far a stage is, with the time that remains."""
        now, share = time.monotonic(), 100 * done / total if total > 0 else 0.0
        self._remaining.hear(stage, done, total, now)
        known = self._stages.get(stage)
        if known is None:
            self._stages[stage] = _Stage(share)
            self._said = now
            print(stage + _format_time_left(self._remaining, now, ", {}"), file=sys.stderr, flush=True)
            return
        further = share > known.share
        known.share = share
        if now - self._said >= _EVERY and further and share < 100 and share >= known.said + _STEP:
            self._said, known.said = now, share
            print(f"{stage}: {share:.0f} %" + _format_time_left(self._remaining, now, ", {}"), file=sys.stderr,
                  flush=True)


def _format_time_left(remaining: Remaining, now: float, form: str) -> str:
    """What is left in words, or nothing while it is not known."""
    left = remaining.left(now)
    if left is None or left.seconds < 0.5:
        return ""
    minutes, seconds = divmod(round(left.seconds), 60)
    words = f"{minutes}:{seconds:02d} min" if minutes else f"{seconds} s"
    return form.format(f"about {words} left" + (" of all" if left.of_all else ""))


@contextmanager
def show_progress(asked: Callable[[], bool]) -> Iterator[Progress]:
    """Progress that is shown on stderr and stops when the user asks for it.

    Parameters
    ----------
    asked : callable
        Whether the user asked to stop.
    """
    if not sys.stderr.isatty():
        yield Progress(_Lines().report, asked)
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    with Bars(TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.fields[left]}"),
              console=Console(stderr=True), transient=True) as bars:
        tasks: dict[str, int] = {}
        remaining = Remaining()

        def _report(stage: str, done: float, total: float) -> None:
            now, known = time.monotonic(), total if total > 0 else None
            remaining.hear(stage, done, total, now)
            left = _format_time_left(remaining, now, "{}")
            if stage not in tasks:
                for task in tasks.values():
                    bars.update(task, visible=False)  # type: ignore[arg-type]
                tasks[stage] = bars.add_task(stage, total=known, left=left)
            bars.update(tasks[stage], completed=done, total=known, visible=True, left=left)  # type: ignore[arg-type]

        yield Progress(_report, asked)
