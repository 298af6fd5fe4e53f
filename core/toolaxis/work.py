"""Work that is counted, not timed: a limit of it ends a search at the same place on every run and every machine.

What is counted are bounds taken, each of one piece of a tool over one cell of a face, and what takes as long as some.
What is kept from before, such as the cells of faces, is not counted: it may or may not be there.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from toolaxis.errors import ToolAxisError

#: Bounds that make up one of the units in which limits are given, and how many units are allowed unless said otherwise:
#: about half a minute on one core.
UNIT, LIMIT = 1000, 100_000.0


class OutOfWork(ToolAxisError):
    """The work that was allowed is done."""


class Budget:
    """How much work may be done, and how much was.

    Parameters
    ----------
    limit : float
        In units.
    """

    def __init__(self, limit: float) -> None:
        self.limit, self.done = limit, 0.0
        self._stop = limit

    def spend(self, bounds: float) -> None:
        """Count work that was done.

        Parameters
        ----------
        bounds : float

        Raises
        ------
        OutOfWork
            When it is more than was allowed.
        """
        self.done += bounds / UNIT
        if self.done > self._stop:
            raise OutOfWork(self.words("not found"))

    def words(self, outcome: str) -> str:
        """A sentence that says what came of it, and what to do.

        Parameters
        ----------
        outcome : str
            "not found".
        """
        return f"{outcome} within the limit of {self.limit:,.0f} thousand bounds (raise --limit)"

    @contextmanager
    def _up_to(self, share: float) -> Iterator[None]:
        before = self._stop
        self._stop = self.done + share * max(before - self.done, 0.0)
        try:
            yield
        finally:
            self._stop = before


_SPENT: ContextVar[Budget | None] = ContextVar("toolaxis_work", default=None)


@contextmanager
def limited(budget: Budget) -> Iterator[Budget]:
    """Charge what is done in this thread meanwhile to a budget.

    Parameters
    ----------
    budget : Budget
    """
    token = _SPENT.set(budget)
    try:
        yield budget
    finally:
        _SPENT.reset(token)


def spend(bounds: float) -> None:
    """Count work that was done, where somebody limits it.

    Parameters
    ----------
    bounds : float
        As many bounds as take as long.

    Raises
    ------
    OutOfWork
        When it is more than was allowed.
    """
    budget = _SPENT.get()
    if budget is not None:
        budget.spend(bounds)


@contextmanager
def up_to(share: float) -> Iterator[None]:
    """Stop earlier meanwhile, so that some of the work that is allowed is left for what comes after.

    Parameters
    ----------
    share : float
        Of what is left, 0 to 1.
    """
    budget = _SPENT.get()
    if budget is None:
        yield
        return
    with budget._up_to(share):
        yield


def at_the_limit(outcome: str) -> str:
    """The sentence that tells what came of work that was limited.

    Parameters
    ----------
    outcome : str
        "not found".
    """
    budget = _SPENT.get()
    assert budget is not None
    return budget.words(outcome)
