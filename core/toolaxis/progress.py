"""Progress reports and cancellation: the one object that long work is handed."""

from collections.abc import Callable
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
    """

    on_report: Callable[[str, float, float], None] | None = None
    cancelled: Callable[[], bool] | None = None

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

    def within(self, name: str) -> "Progress":
        """The same for a part of the work: stages are led by its name, cancellation is shared.

        Parameters
        ----------
        name : str
        """
        return Progress(lambda stage, done, total: self.report(f"{name}: {stage}", done, total), self.cancelled)


NO_PROGRESS = Progress()
