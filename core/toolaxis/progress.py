"""Progress reports and cancellation: the one object that long work is handed."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from toolaxis.errors import Cancelled


@dataclass(frozen=True)
class Progress:
    """Receives reports and answers whether to stop.

    Attributes
    ----------
    on_report : callable or None
        Called with (stage, done, total) as work proceeds.
    cancelled : callable or None
        Returns True once the user has asked to stop.
    on_offer : callable or None
        Called with a callable that makes an intermediate result; it need not call it.
    """

    on_report: Callable[[str, float, float], None] | None = None
    cancelled: Callable[[], bool] | None = None
    on_offer: Callable[[Callable[[], object]], None] | None = None

    def check(self) -> None:
        """Stop here if the user asked to.

        Raises
        ------
        Cancelled
            When `cancelled` answers True.
        """
        if self.cancelled is not None and self.cancelled():
            raise Cancelled("cancelled by the user")

    def report(self, stage: str, done: float, total: float) -> None:
        """Tell how far a stage is, after a check for cancellation.

        Parameters
        ----------
        stage : str
            What is being done.
        done, total : float
            Work done and work in all, in any common unit.

        Raises
        ------
        Cancelled
            When `cancelled` answers True.
        """
        self.check()
        if self.on_report is not None:
            self.on_report(stage, done, total)

    def offer(self, make: Callable[[], object]) -> None:
        """Offer an intermediate result to whoever wants to look at one; it is made only when asked for.

        Parameters
        ----------
        make : callable
            Makes the result; called at once or never.
        """
        if self.on_offer is not None:
            self.on_offer(make)

    def within(self, name: str) -> "Progress":
        """The same for a part of the work: stages are led by its name, the rest is shared.

        Parameters
        ----------
        name : str
        """
        return Progress(lambda stage, done, total: self.report(f"{name}: {stage}", done, total), self.cancelled,
                        self.on_offer)


NO_PROGRESS = Progress()

_HEARD: ContextVar[Progress] = ContextVar("toolaxis_progress", default=NO_PROGRESS)


@contextmanager
def heard(progress: Progress) -> Iterator[None]:
    """Let loops deep inside, which are handed no progress, hear in this thread whether to stop.

    Parameters
    ----------
    progress : Progress
    """
    token = _HEARD.set(progress)
    try:
        yield
    finally:
        _HEARD.reset(token)


def breathe() -> None:
    """Stop here if the user asked to: called every few milliseconds by long loops that are handed no progress.

    Raises
    ------
    Cancelled
        When the progress that is `heard` in this thread says so.
    """
    _HEARD.get().check()
