"""Progress reports and cancellation: the one object that long work is handed, and what reports tell of the rest."""

import math
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import NamedTuple

from toolaxis.errors import Cancelled, InvalidInput

#: "face 4a (2 of 9): axes" is the second of nine pieces of work.
_PIECE = re.compile(r"^(.*?)[^:]*\((\d+) of (\d+)\)")
#: What is left of a step is told once this share of it was done since it began, and that took so long, s.
_KNOWN, _LONG_ENOUGH = 0.1, 1.0


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
    on_piece : callable or None
        Called with each part of the result as soon as it is known: what tools reach of a face, or an operation.
        Processes that plan side by side do not call it.
    """

    on_report: Callable[[str, float, float], None] | None = None
    cancelled: Callable[[], bool] | None = None
    on_offer: Callable[[Callable[[], object]], None] | None = None
    on_piece: Callable[[object], None] | None = None

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
            Work done and work in all, in any common unit; zero in all where it is not known.

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

    def hand_over(self, piece: object) -> None:
        """Hand over a part of the result to whoever wants to see it at once.

        Parameters
        ----------
        piece : object
            What tools reach of a face, or an operation.
        """
        if self.on_piece is not None:
            self.on_piece(piece)

    def within(self, name: str) -> "Progress":
        """The same for a part of the work: stages are led by its name, the rest is shared.

        Parameters
        ----------
        name : str
        """
        return Progress(lambda stage, done, total: self.report(f"{name}: {stage}", done, total), self.cancelled,
                        self.on_offer, self.on_piece)


class TimeLimit:
    """Minutes after which work is to stop, from when this is made: its `is_up` serves as `cancelled` of a `Progress`.

    Parameters
    ----------
    minutes : float or None
        None for no limit.

    Raises
    ------
    InvalidInput
        When it is not above zero.
    """

    def __init__(self, minutes: float | None) -> None:
        if minutes is not None and not minutes > 0:
            raise InvalidInput(f"minutes is {minutes:g}: it must be above zero; leave it out for no limit")
        self._end = math.inf if minutes is None else time.monotonic() + 60 * minutes

    def is_up(self) -> bool:
        """Whether the time is over."""
        return time.monotonic() > self._end


NO_PROGRESS = Progress()

_HEARD: ContextVar[Progress] = ContextVar("toolaxis_progress", default=NO_PROGRESS)


@contextmanager
def activate_progress(progress: Progress) -> Iterator[None]:
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
        When the progress that is `activate_progress` in this thread says so.
    """
    _HEARD.get().check()


class WorkLeft(NamedTuple):
    """What is left of the work.

    seconds : float;  of_all : bool, whether of all the work, or of the present step alone.
    """

    seconds: float
    of_all: bool


class _Piece(NamedTuple):
    """When a piece of work was first heard of, and when last."""

    begun: float
    heard: float


class Remaining:
    """How long work may still take, told from what it reports: from what was finished, and from nothing else.

    Pieces of work may be done one after the other or side by side.  A step that begins again, or whose amount changes
    as it goes on, is measured anew from there.

    Notes
    -----
    **Properties**: 1. nothing is told before a piece, or a tenth of a step, was finished; 2. it never falls to zero
    while something is left; 3. it is told rightly where all pieces take the same.
    """

    def __init__(self) -> None:
        self._group: tuple[str, int] = "", 0
        self._pieces: dict[int, _Piece] = {}
        self._in_pieces = False
        self._stage, self._total, self._share = "", 0.0, 0.0
        self._since = 0.0, 0.0

    def hear(self, stage: str, done: float, total: float, now: float) -> None:
        """Take in a report.

        Parameters
        ----------
        stage : str
        done, total : float
            A total that is not above zero says that it is not known how far the stage is.
        now : float
            When it was heard, s.
        """
        found = _PIECE.search(stage)
        self._in_pieces = found is not None
        if found is not None:
            number, group = int(found[2]), (found[1], int(found[3]))
            if group != self._group:
                self._group, self._pieces = group, {}
            begun = self._pieces.get(number, _Piece(now, now)).begun
            self._pieces[number] = _Piece(begun, now)
        share = min(max(done / total, 0.0), 1.0) if total > 0 else 0.0
        if stage != self._stage or total != self._total or share < self._share:
            self._since = now, share
        self._stage, self._total, self._share = stage, total, share

    def left(self, now: float) -> WorkLeft | None:
        """What is left, or None while nothing is known of it.

        Parameters
        ----------
        now : float
            s
        """
        seconds = self._seconds_of_pieces(now) if self._in_pieces else None
        if seconds is not None:
            return WorkLeft(seconds, not self._group[0])  # led by a name they are of one tool, and others follow
        begun, start = self._since
        if self._share - start < _KNOWN or now - begun < _LONG_ENOUGH:
            return None
        return WorkLeft((now - begun) * (1.0 - self._share) / (self._share - start), False)

    def _seconds_of_pieces(self, now: float) -> float | None:
        """Seconds that all pieces still take, as many at a time as now and as long as those that are finished took.

        A piece that is not heard of again after a later one began is finished.  When the present ones take longer than
        the mean, the mean is what it would be if they ended now.
        """
        took, present = [], []
        for piece in self._pieces.values():
            # Pieces that are done side by side begin together: that a neighbour has begun does not finish a piece.
            ends = [one.begun for one in self._pieces.values()
                    if one.begun >= piece.heard and one.begun >= piece.begun + _LONG_ENOUGH]
            if ends:
                took.append(min(ends) - piece.begun)
            else:
                present.append(now - piece.begun)
        waiting = self._group[1] - len(self._pieces)
        if not took or not present or (waiting <= 0 and min(present) >= sum(took) / len(took)):
            return None
        over = [age for age in present if age > sum(took) / len(took)]
        mean = (sum(took) + sum(over)) / (len(took) + len(over))
        rest = waiting * mean + sum(max(mean - age, 0.0) for age in present)
        return rest / len(present)
