"""What roughing left on a part: how far its faces stand proud before they are finished."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite

from toolaxis.errors import InvalidInput

#: More stock than this is not planned with, mm: distances are looked at no farther.
MOST_STOCK = 50.0


@dataclass(frozen=True)
class Stock:
    """Material that stands on faces before they are finished; all of it counts as there throughout a plan.

    Attributes
    ----------
    height : float
        How far it stands above the finished surface, measured as a distance from it, mm.
    faces : frozenset of int
        Numbers of the faces that carry it, those of joined faces one by one.

    Raises
    ------
    InvalidInput
        When the height is not above zero and finite, or no face carries it.
    """

    height: float
    faces: frozenset[int]

    def __post_init__(self) -> None:
        if not (isfinite(self.height) and 0 < self.height <= MOST_STOCK):
            raise InvalidInput(f"stock is {self.height} mm: it must be above zero and at most {MOST_STOCK:g} mm")
        if not self.faces:
            raise InvalidInput(f"a stock of {self.height} mm is given and no face carries it: name the faces")


def format_faces(numbers: Iterable[int]) -> str:
    """Numbers of faces in words, "face 7" or "faces 3, 5-8".

    Parameters
    ----------
    numbers : iterable of int
    """
    rows = sorted(set(numbers))
    runs: list[list[int]] = []
    for number in rows:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    text = ", ".join(f"{low}" if low == high else f"{low}-{high}" for low, high in runs)
    return f"face {text}" if len(rows) == 1 else f"faces {text}"
