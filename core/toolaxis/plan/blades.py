"""What a plan says of a part with blades: faces of each, operations that are turned copies, what is near."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: What the faces of a blade are called.
SIDES = ("suction", "pressure", "leading", "trailing", "fillet", "tip", "hub", "other")


@dataclass(frozen=True)
class PlannedBlade:
    """One blade and what the plan leaves of it.

    Attributes
    ----------
    faces : dict of str to tuple of int
        Numbers of its faces by what they are, see `SIDES`; "hub" is the piece of the hub that goes with it.
    area : float
        Area of those faces that are to be machined, mm^2.
    left : float
        Area of these that is left as rest material, or for which there is no axis, mm^2.
    """

    faces: dict[str, tuple[int, ...]]
    area: float = 0.0
    left: float = 0.0

    @property
    def numbers(self) -> tuple[int, ...]:
        """All its faces, its piece of the hub apart."""
        return tuple(sorted(n for name, faces in self.faces.items() if name != "hub" for n in faces))


@dataclass(frozen=True, eq=False)
class Gap:
    """The least distance between a blade and the next one, fillets at their roots apart.

    Attributes
    ----------
    distance : float
        mm
    places : (2, 3) array
        A point of each, mm.
    """

    distance: float
    places: Array


@dataclass(frozen=True, eq=False)
class BladeClearance:
    """The least distance of one component of the tool to what stands around the planned blade.

    Attributes
    ----------
    to : str
        "neighbouring blade" or "hub".
    component : str
        "cutter", "shank" or "holder".
    distance : float
        Lower bound over all motions of the planned blade's operations, mm; the cutter's to the hub without those
        operations that machine the hub or what joins it smoothly.
    operation : int
        Number of the operation in which it comes so near; 0 where nothing is nearer than `distance`.
    face : int
        Number of the face that it comes so near to; 0 likewise.
    """

    to: str
    component: str
    distance: float
    operation: int = 0
    face: int = 0


@dataclass(frozen=True, eq=False)
class Blades:
    """Blades around an axis: one was planned, its operations were turned to the others and proven there.

    Attributes
    ----------
    point, axis : (3,) array
        A point of the axis, mm, and its direction.
    hub : tuple of int
        Faces of the hub.
    blades : tuple of PlannedBlade
        In the order of a right-handed turn; the first is the one that was planned.
    gap : Gap
    copies : dict of int to int
        Number of an operation to the number of the one that it is a turned copy of.
    searched : tuple of int
        Operations on other blades than the first for which the proof refused the turned axis, searched anew.
    room : tuple of BladeClearance
    """

    point: Array
    axis: Array
    hub: tuple[int, ...]
    blades: tuple[PlannedBlade, ...]
    gap: Gap
    copies: dict[int, int]
    searched: tuple[int, ...] = ()
    room: tuple[BladeClearance, ...] = ()

    @cached_property
    def _owner(self) -> dict[int, tuple[int, str]]:
        return {n: (k, name) for k, blade in enumerate(self.blades) for name, faces in blade.faces.items()
                for n in faces}

    def blade_of(self, number: int) -> int | None:
        """Which blade a face belongs to, from 1, its piece of the hub included; None where to none.

        Parameters
        ----------
        number : int
        """
        found = self._owner.get(number)
        return None if found is None else found[0] + 1

    def side_of(self, number: int) -> str:
        """What a face is of its blade, one of `SIDES`; empty where it belongs to none.

        Parameters
        ----------
        number : int
        """
        found = self._owner.get(number)
        return "" if found is None else found[1]

    def apart(self, part: Part, number: int) -> Part:
        """The part with all blades but a face's own joined to nothing, so that they count as obstacles.

        Where fillets join blades and hub smoothly, all of them are one skin, of which the cutter may graze any face;
        a neighbouring blade is to be kept clear of.

        Parameters
        ----------
        part : Part
        number : int
            Of the face that is machined; where it belongs to no blade, the part stays as it is.

        Raises
        ------
        InvalidInput
            When the part has no such face.
        """
        part.face(number)
        own = self._owner.get(number)
        if own is None:
            return part
        strangers = {n for k, blade in enumerate(self.blades) if k != own[0] for n in blade.numbers}
        return replace(part, edges=tuple(edge for edge in part.edges
                                         if (edge.faces[0] in strangers) == (edge.faces[1] in strangers)))

    def renumbered(self, numbers: Mapping[int, int]) -> "Blades":
        """Itself after operations got other numbers.

        Parameters
        ----------
        numbers : mapping of int to int
            From old numbers of operations to new ones; others keep theirs.
        """
        return replace(self, copies={numbers.get(copy, copy): numbers.get(source, source)
                                     for copy, source in self.copies.items()},
                       searched=tuple(sorted(numbers.get(one, one) for one in self.searched)),
                       room=tuple(replace(one, operation=numbers.get(one.operation, 0)) for one in self.room))

    def checked(self, operations: int) -> "Blades":
        """Itself, when what it says of operations can be.

        Parameters
        ----------
        operations : int
            How many the plan has.

        Raises
        ------
        InvalidInput
            When a copy or its original is not among them.
        """
        named = [*self.copies, *self.copies.values(), *self.searched]
        wrong = [n for n in named if not 1 <= n <= operations]
        if wrong:
            raise InvalidInput(f"the plan's blades name operation {wrong[0]}: there are {operations}")
        return self
