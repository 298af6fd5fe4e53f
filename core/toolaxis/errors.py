"""The exception family: the caller's fault is an exception, the world's answer is a result.

Everything else that is raised is a fault of the program itself.  It costs the piece of work in which it occurs, not
those beside it: `Fault` is what stays of it.
"""

import os
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from toolaxis.advice import LARGER_SCALLOP

#: Where faults of the program are reported; package.xml names the same address.
REPORT_AT = "https://toolaxis.example/issues"
#: How the sentence of a fault begins that is a lack of memory.
OUT_OF_MEMORY = "failed: out of memory"
_ROOT, _PYTHON = Path(__file__).parent, Path(os.__file__).parent
#: The most of an exception's own words that a sentence repeats.
_MOST = 200


class ToolAxisError(Exception):
    """Base of everything that toolaxis raises on purpose."""


class InvalidInput(ToolAxisError, ValueError):
    """A value given by the caller breaks a rule; the message names quantity, value, index, rule and remedy."""


class PartMisplaced(InvalidInput):
    """A machine cannot carry out a plan where its part stands on the table: another place there may help."""


class AxisOutOfReach(InvalidInput):
    """No position of a machine reaches an axis of a plan, wherever the part stands: a plan for that machine helps."""


class UnsupportedGeometry(ToolAxisError):
    """The geometry is valid but of a kind that cannot be handled; the message names it and what to do."""


class MissingBackend(ToolAxisError, ImportError):
    """An optional library that the request needs is not installed; the message says how to install it."""


class JobError(ToolAxisError):
    """A stage of a job failed on one item; the cause is chained.

    Parameters
    ----------
    stage : str
        What was being done, in the words of the progress display.
    item : str
        What it was done to ("face 7").
    message : str
        One sentence on what went wrong.
    """

    def __init__(self, stage: str, item: str, message: str) -> None:
        super().__init__(f"{stage}, {item}: {message}")
        self.stage = stage
        self.item = item
        self.message = message

    def __reduce__(self) -> tuple[type["JobError"], tuple[str, str, str]]:
        return type(self), (self.stage, self.item, self.message)


class Cancelled(ToolAxisError):
    """The user asked to stop."""


@dataclass(frozen=True)
class Fault:
    """What stays of an exception that nobody expected.

    Attributes
    ----------
    sentence : str
        What failed, where in the program, and what to do: begins with "failed: ".
    traceback : str
        Of the exception, as Python writes it; what the process said at its end where it died; empty where neither is
        known.
    """

    sentence: str
    traceback: str = ""


def fault(reason: BaseException) -> Fault:
    """What stays of an exception.

    Parameters
    ----------
    reason : BaseException

    Notes
    -----
    What the program raises on purpose is told in its own words; a lack of memory with what helps against it.
    """
    written = "".join(traceback.format_exception(reason))
    words = _shorten_words(str(reason))
    if isinstance(reason, ToolAxisError):
        return Fault(f"failed: {words}", written)
    where = place_of(reason)
    if isinstance(reason, MemoryError):
        return Fault(f"{OUT_OF_MEMORY}, at {where}: plan fewer faces at a time, with one worker or "
                     f"{LARGER_SCALLOP}; where that does not help, {report_it()}", written)
    what = f"{type(reason).__name__}: {words}" if words else type(reason).__name__
    return Fault(f"failed: {what}, at {where}: {report_it()}", written)


def process_fault(how: str, said: str = "") -> Fault:
    """What stays of a process that died over a piece of work.

    Parameters
    ----------
    how : str
        How it ended ("signal 9 (SIGKILL)").
    said : str
        What it wrote at its end.
    """
    return Fault(f"failed: the process that worked on it ended by {how}: where memory is short, plan with fewer "
                 f"workers; otherwise {report_it()}", said)


def report_it(what: str = "the part") -> str:
    """The end of a sentence that asks for a report.

    Parameters
    ----------
    what : str
        What to send with it.
    """
    return f"please report it with {what}, at {REPORT_AT}"


def place_of(reason: BaseException) -> str:
    """File and line that an exception was raised at: the innermost that is of no library, if there is one.

    Parameters
    ----------
    reason : BaseException
    """
    frames = traceback.extract_tb(reason.__traceback__)
    if not frames:
        return "an unknown place"
    own = [frame for frame in frames if not _of_library(Path(frame.filename))]
    frame = (own or frames)[-1]
    path = Path(frame.filename)
    return f"{path.relative_to(_ROOT) if path.is_relative_to(_ROOT) else path.name}:{frame.lineno}"


def _of_library(path: Path) -> bool:
    """Whether a file belongs to Python or to something installed other than this program."""
    if path.is_relative_to(_ROOT):
        return False
    return path.is_relative_to(_PYTHON) or bool({"site-packages", "dist-packages"} & set(path.parts))


def _shorten_words(words: str) -> str:
    """An exception's words in one line, not too long."""
    line = " ".join(words.split()).rstrip(".")
    return line if len(line) <= _MOST else f"{line[:_MOST]} ..."


@contextmanager
def about(piece: object) -> Iterator[None]:
    """Let exceptions that leave the block carry which piece of work they are about, the innermost that is told.

    Parameters
    ----------
    piece : object
        A face's label, an operation's number.
    """
    try:
        yield
    except Exception as reason:
        if not hasattr(reason, "about"):
            reason.about = piece  # type: ignore[attr-defined]
        raise


def piece_of(reason: BaseException) -> object | None:
    """The piece of work that an exception is about; None where nobody told.

    Parameters
    ----------
    reason : BaseException
    """
    return getattr(reason, "about", None)
