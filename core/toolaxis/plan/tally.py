"""The sentence that counts tested axes by what they were refused for, and its counts read again.

An operation that has no map has no other record of them.
"""

import re
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from toolaxis.plan.orientation import REASONS

#: What an axis misses, in the order of `REASONS`: after its count.
COUNTED = ("free", "outside the limits", "too far from a normal", "too near to a normal for the flat bottom",
           "with a gouge", "with a collision of the cutter", "with a collision of the shank",
           "with a collision of the holder")
#: Which of these is told of a ball end in other words: it has no flat bottom.
_UPRIGHT = REASONS.index("too near to a normal")
_LEANS_TOO_LITTLE = "too near to a normal for the least lean"
_TESTED = "axes tested"


def tally_sentence(counts: NDArray[np.intp], flat: bool) -> str:
    """How many axes were tested, and for what they were refused.

    Parameters
    ----------
    counts : (8,) array
        Axes of each of `REASONS`.
    flat : bool
        Whether the cutter has a flat bottom.
    """
    parts = [f"{counts[k]} {_words_of(k, flat)}" for k in range(1, len(REASONS)) if counts[k]]
    return f"{counts.sum()} {_TESTED}: " + (", ".join(parts) if parts else "none was refused")


def is_tally(why: str) -> bool:
    """Whether a sentence is one of `tally_sentence`."""
    return _TESTED in why


def counts_of(reasons: Iterable[str]) -> NDArray[np.float64]:
    """Axes that sentences of `tally_sentence` count, (8,), of each of `REASONS`.

    Parameters
    ----------
    reasons : iterable of str
        Others among them count nothing.
    """
    text = " ".join(filter(is_tally, reasons))
    rows = [re.findall(f"([0-9]+) (?:{_words_of(k, True)}|{_words_of(k, False)})", text) for k in range(len(REASONS))]
    return np.array([sum(map(float, row)) for row in rows])


def _words_of(reason: int, flat: bool) -> str:
    return _LEANS_TOO_LITTLE if reason == _UPRIGHT and not flat else COUNTED[reason]
