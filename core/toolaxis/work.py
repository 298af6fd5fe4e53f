"""Work that is counted, not timed: a limit of it ends a search at the same place on every run and every machine.

What is counted are bounds taken, each of one piece of a tool over one cell of a face, and what takes as long as some.
What is kept from before, such as the cells of faces, is not counted: it may or may not be there.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from toolaxis.advice import COARSER_SCALLOP
from toolaxis.errors import ToolAxisError

#: Bounds that make up one of the units in which limits are given, and how many units are allowed unless said otherwise:
#: about half a minute on one core.
UNIT, LIMIT = 1000, 100_000.0
#: How many times that much is allowed to an axis that moves: no part of its search is worth anything by itself.
MOVING = 10.0


#: How messages call a limit that ended a search.
_LIMIT_WORDS = "the work limit of"


class OutOfWork(ToolAxisError):
    """The work that was allowed is done."""


class Budget:
    """How much work may be done, and how much was.

    Parameters
    ----------
    limit : float
        In units.
    times : float
        How many times the limit is allowed.
    more : float
        How many times the limit is allowed besides once an axis was found: its passes are made and proven once, which
        takes as much as they are long, and what was done before is lost where that is not finished.
    """

    def __init__(self, limit: float, times: float = 1.0, more: float = 0.0) -> None:
        self.limit, self.done = limit, 0.0
        self._stop, self._kept_back = limit * times, limit * more

    def allow_proof(self) -> None:
        """Allow what was kept back for the passes of an axis that was found; a second time nothing is left of it."""
        self._stop += self._kept_back
        self._kept_back = 0.0

    def allow(self, bounds: float) -> None:
        """Allow further work: what was found is proven to the end, however long it is.

        Parameters
        ----------
        bounds : float
        """
        self._stop += bounds / UNIT

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
            raise OutOfWork(self.words(found=False))

    def words(self, *, found: bool) -> str:
        """A sentence that says that the limit ended a search, and what to do.

        Parameters
        ----------
        found : bool
            Whether the search had found an axis by then.
        """
        limit = f"{_LIMIT_WORDS} {self.limit:,.10g}"
        if found:
            return f"search stopped at {limit}: a better axis may exist (raise --limit)"
        return f"no axis found within {limit}: raise --limit, use {COARSER_SCALLOP} or another tool"

    @contextmanager
    def _up_to(self, share: float) -> Iterator[None]:
        before = self._stop
        self._stop = self.done + share * max(before - self.done, 0.0)
        try:
            yield
        finally:
            self._stop = before


_SPENT: ContextVar[Budget | None] = ContextVar("toolaxis_work", default=None)


def is_out_of_work(reasons: Iterable[str]) -> bool:
    """Whether reasons tell that the limit of work ended a search.

    Parameters
    ----------
    reasons : iterable of str
    """
    return any(_LIMIT_WORDS in why for why in reasons)


@contextmanager
def limit_work(budget: Budget) -> Iterator[Budget]:
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


def allow_proof() -> None:
    """Allow the work that is kept back until an axis is found."""
    budget = _SPENT.get()
    if budget is not None:
        budget.allow_proof()


def allow(bounds: float) -> None:
    """Allow further work, where somebody limits it.

    Parameters
    ----------
    bounds : float
    """
    budget = _SPENT.get()
    if budget is not None:
        budget.allow(bounds)


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


def better_may_exist() -> str:
    """The sentence that tells that an axis was found, and that the limit ended the search for a better one."""
    budget = _SPENT.get()
    assert budget is not None
    return budget.words(found=True)
