"""What is left on a part on purpose: faces that keep an allowance, and the allowance of all others."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite

from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.shape.stock import MOST_STOCK, format_faces

#: Allowances that differ by no more are the same, mm.
SAME = 1e-9


@dataclass(frozen=True)
class Allowances:
    """How much is left on each face of a part.

    Attributes
    ----------
    on_others : float
        On faces that are not named, mm.
    on : mapping of int to float
        On faces by their numbers, those of joined faces one by one, mm.

    Raises
    ------
    InvalidInput
        When one is below zero, not finite or too large, or no number of a face.
    """

    on_others: float = 0.0
    on: Mapping[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for number, value in self.on.items():
            if isinstance(number, bool) or not isinstance(number, int) or number < 1:
                raise InvalidInput(f"face {number!r} with an allowance is no number of a face: give whole numbers "
                                   "from 1")
            if not (isfinite(value) and 0 <= value <= MOST_STOCK):
                raise InvalidInput(f"allowance on face {number} is {value} mm: it must be zero or more, and at most "
                                   f"{MOST_STOCK:g} mm")

    def of(self, face: Face) -> float:
        """What is left on a face, or on all faces of a joined one, mm.

        Parameters
        ----------
        face : Face
        """
        return self.on.get(face.numbers[0], self.on_others)

    def check_alike(self, face: Face) -> None:
        """Check that all faces of which one is made keep the same.

        Parameters
        ----------
        face : Face

        Raises
        ------
        InvalidInput
            When two differ.
        """
        first = self.of(face)
        for number in face.numbers:
            own = self.on.get(number, self.on_others)
            if abs(own - first) > SAME:
                raise InvalidInput(f"face {face.numbers[0]} keeps an allowance of {first:g} mm and face {number} one "
                                   f"of {own:g} mm: machine them apart, or give both the same allowance")

    @property
    def described(self) -> str:
        """All of them in words: "0.3 mm on faces 3, 5-8, 0 mm on all others"."""
        values = sorted(set(self.on.values()))
        rows = [f"{value:g} mm on {format_faces(n for n, own in self.on.items() if own == value)}" for value in values]
        return ", ".join([*rows, f"{self.on_others:g} mm on all others"])
