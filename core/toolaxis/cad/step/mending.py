"""Changes to a STEP text, so that every kernel reads the same: lists without some members, and entities added."""

from collections.abc import Iterable
from itertools import count

from toolaxis.cad.step.entities import Entities
from toolaxis.cad.step.faces import REPRESENTATIONS, SETS, SHELLS


class Mending:
    """Changes to a text, and sentences about them.

    Parameters
    ----------
    entities : Entities

    Attributes
    ----------
    notes : list of str
        What was mended.
    """

    def __init__(self, entities: Entities) -> None:
        self.entities = entities
        self.notes: list[str] = []
        self._lists: dict[int, list[int]] = {}
        self._added: list[bytes] = []
        self._numbers = count(max(entities.definitions, default=0) + 1)

    @property
    def changed(self) -> bool:
        """Whether anything is to be changed."""
        return bool(self._lists or self._added)

    def members(self, holder: int) -> list[int]:
        """The first list of an entity, as it is to be.

        Parameters
        ----------
        holder : int
            Entity number.
        """
        known = self._lists.get(holder)
        return self.entities.members(self.entities.table[holder]) if known is None else known

    def set_members(self, holder: int, members: Iterable[int]) -> None:
        """Give an entity another first list.

        Parameters
        ----------
        holder : int
            Entity number.
        members : iterable of int
        """
        self._lists[holder] = list(members)

    def add(self, keyword: str, parameters: str) -> int:
        """Add an entity at the end of the data; its number.

        Parameters
        ----------
        keyword : str
            Empty for a complex entity.
        parameters : str
        """
        number = next(self._numbers)
        self._added.append(f"#{number}={keyword}({parameters});\n".encode())
        return number

    def content(self) -> bytes:
        """The text as it is to be read."""
        content, bare = self.entities.content, self.entities.bare
        end = bare.rfind(b"ENDSEC")
        pieces = {(end, end): b"".join(self._added)}
        for holder, members in self._lists.items():
            entity = self.entities.table[holder]
            start = bare.find(b"(", entity.start, entity.end) + 1
            pieces[start, bare.find(b")", start, entity.end)] = format_entities(members).encode()
        whole, place = [], 0
        for (start, stop), text in sorted(pieces.items()):
            whole += [content[place:start], text]
            place = stop
        return b"".join([*whole, content[place:]])


def format_entities(numbers: Iterable[int]) -> str:
    """Entity numbers as a list in a STEP text.

    Parameters
    ----------
    numbers : iterable of int
    """
    return ",".join(f"#{number}" for number in numbers)


def leave_out(mending: Mending, faces: Iterable[int]) -> None:
    """Take faces out of every shell, set and representation.

    Parameters
    ----------
    mending : Mending
    faces : iterable of int
        Entity numbers.
    """
    unwanted = set(faces)
    if not unwanted:
        return
    for holder in mending.entities.of(*SHELLS, *SETS, *REPRESENTATIONS):
        members = mending.members(holder.number)
        if unwanted.intersection(members):
            mending.set_members(holder.number, (number for number in members if number not in unwanted))
