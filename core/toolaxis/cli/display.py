"""Progress on stderr: a bar with the time that remains on a terminal, plain lines elsewhere."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from toolaxis.progress import Progress

_EVERY, _STEP = 5.0, 5.0


@dataclass
class _Stage:
    """When a stage began, or began again, how far it was then and is now, and what was said of it, in hundredths."""

    began: float
    start: float
    share: float
    said: float = 0.0


class _Lines:
    """One plain line when a stage begins for the first time, and every few seconds after where it came on since.

    A stage that begins again (the next candidate's passes) is not told again before it is further than ever.
    """

    def __init__(self) -> None:
        self._stages: dict[str, _Stage] = {}
        self._said = 0.0

    def report(self, stage: str, done: float, total: float) -> None:
        """Say how far a stage is, with the time that remains."""
        now, share = time.monotonic(), 100 * done / total if total > 0 else 0.0
        known = self._stages.get(stage)
        if known is None:
            self._stages[stage] = _Stage(now, share, share)
            self._said = now
            print(stage, file=sys.stderr, flush=True)
            return
        if share < known.share:
            known.began, known.start = now, share
        known.share = share
        if now - self._said >= _EVERY and share < 100 and share >= known.said + _STEP and share > known.start:
            self._said, known.said = now, share
            left = (now - known.began) * (100 - share) / (share - known.start)
            print(f"{stage}: {share:.0f} %, about {left:.0f} s left", file=sys.stderr, flush=True)


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
