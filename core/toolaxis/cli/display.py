"""Progress on stderr: a bar with the time that remains on a terminal, plain lines elsewhere."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from toolaxis.progress import Progress

_EVERY = 5.0


class _Lines:
    """One plain line when a stage begins for the first time, and every few seconds after."""

    def __init__(self) -> None:
        self._began: dict[str, float] = {}
        self._said = 0.0

    def report(self, stage: str, done: float, total: float) -> None:
        """Say how far a stage is, with the time that remains."""
        now = time.monotonic()
        if stage not in self._began:
            self._began[stage] = self._said = now
            print(stage, file=sys.stderr, flush=True)
        elif now - self._said >= _EVERY and 0 < done < total:
            self._said = now
            left = (now - self._began[stage]) * (total - done) / done
            print(f"{stage}: {100 * done / total:.0f} %, about {left:.0f} s left", file=sys.stderr, flush=True)


@contextmanager
def shown_progress(asked: Callable[[], bool]) -> Iterator[Progress]:
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
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    with Bars(TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn(),
              console=Console(stderr=True), transient=True) as bars:
        tasks: dict[str, int] = {}

        def _report(stage: str, done: float, total: float) -> None:
            if stage not in tasks:
                for task in tasks.values():
                    bars.update(task, visible=False)  # type: ignore[arg-type]
                tasks[stage] = bars.add_task(stage, total=total)
            bars.update(tasks[stage], completed=done, total=total, visible=True)  # type: ignore[arg-type]

        yield Progress(_report, asked)
