"""The entities of a STEP text: where each stands, what it is, and what it refers to."""

import re
from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

# A string ends at a quote before a comma or a bracket, as the CAD kernel reads it: many files hold 'Bob's part'.  None
# holds the beginning of the next entity, so that a lost quote harms no more than its own entity.
_NOISE = re.compile(rb"'(?:[^';]|''|'(?!\s*[,)])|;(?!\s*#\d+\s*=))*+'(?=\s*[,)])|/\*.*?\*/", re.DOTALL)
_DATA = re.compile(rb"\bDATA\s*(?:\([^;]*\))?;")
_DEFINITION = re.compile(rb"#(\d+)\s*=")
_REFERENCE = re.compile(rb"#(\d+)")
_STATEMENT = re.compile(rb"#(\d+)\s*=\s*(!?[A-Z_0-9]*)\s*\(([^;]*);")
_KEYWORD = re.compile(rb"([A-Z_0-9]+)\s*\(")
_TOKEN = re.compile(rb"'[^']*'|[()]|[^(),\s]+")

Nested = list["bytes | Nested"]


class Entity(NamedTuple):
    """One entity.

    Attributes
    ----------
    number : int
    keyword : str
        Empty for a complex entity, which has several.
    start, end : int
        Of what stands after the opening bracket, up to and without the semicolon.
    """

    number: int
    keyword: str
    start: int
    end: int


def without_noise(content: bytes) -> bytes:
    """The text with its strings and comments blanked, every byte where it was.

    Parameters
    ----------
    content : bytes
    """
    return _NOISE.sub(_blank, content)


def _blank(noise: "re.Match[bytes]") -> bytes:
    text = noise.group()
    inner = b" " * (len(text) - 2)
    return b"'" + inner + b"'" if text.startswith(b"'") else b"  " + inner


class Entities:
    """All entities of a text.

    Parameters
    ----------
    content : bytes

    Attributes
    ----------
    content : bytes
    bare : bytes
        The content with strings and comments blanked.
    data : int
        Where the data begin; -1 where there are none.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.bare = without_noise(content)
        data = _DATA.search(self.bare)
        self.data = data.end() if data else -1

    @cached_property
    def definitions(self) -> tuple[int, ...]:
        """Numbers of what is defined, in the order of the text."""
        if self.data < 0:
            return ()
        return tuple(int(number) for number in _DEFINITION.findall(self.bare, self.data))

    @cached_property
    def referred(self) -> set[int]:
        """Numbers that stand anywhere in the data."""
        return {int(number) for number in set(_REFERENCE.findall(self.bare, self.data))}

    @cached_property
    def dangling(self) -> frozenset[int]:
        """Numbers that are referred to and not defined."""
        return frozenset(self.referred.difference(self.definitions))

    @cached_property
    def table(self) -> dict[int, Entity]:
        """Every entity that can be read, by its number."""
        found = {}
        for match in _STATEMENT.finditer(self.bare, max(self.data, 0)):
            number = int(match.group(1))
            found[number] = Entity(number, match.group(2).decode(), match.start(3), match.end(3))
        return found

    @cached_property
    def _by_kind(self) -> dict[str, list[Entity]]:
        kinds: dict[str, list[Entity]] = {}
        for entity in self.table.values():
            kinds.setdefault(entity.keyword, []).append(entity)
        return kinds

    def of(self, *keywords: str) -> Iterator[Entity]:
        """Simple entities of some kinds, in the order of the kinds and of the text.

        Parameters
        ----------
        *keywords : str
        """
        for keyword in keywords:
            yield from self._by_kind.get(keyword, ())

    def complex_of(self, keyword: str) -> Iterator[Entity]:
        """Complex entities that have a keyword among theirs.

        Parameters
        ----------
        keyword : str
        """
        return iter(self._by_part.get(keyword, ()))

    @cached_property
    def _by_part(self) -> dict[str, list[Entity]]:
        parts: dict[str, list[Entity]] = {}
        for entity in self._by_kind.get("", ()):
            for word in set(_KEYWORD.findall(self.body(entity))):
                parts.setdefault(word.decode(), []).append(entity)
        return parts

    def body(self, entity: Entity) -> bytes:
        """What stands in an entity's brackets, strings blanked, with the closing bracket.

        Parameters
        ----------
        entity : Entity
        """
        return self.bare[entity.start:entity.end]

    def references(self, entity: Entity) -> list[int]:
        """Numbers that an entity refers to, in their order.

        Parameters
        ----------
        entity : Entity
        """
        return [int(number) for number in _REFERENCE.findall(self.bare, entity.start, entity.end)]

    def members(self, entity: Entity) -> list[int]:
        """Numbers in the first list of an entity.

        Parameters
        ----------
        entity : Entity
        """
        start = self.bare.find(b"(", entity.start, entity.end)
        end = self.bare.find(b")", start, entity.end)
        return [int(number) for number in _REFERENCE.findall(self.bare, start, end)] if 0 <= start < end else []

    def kind(self, number: int) -> str:
        """The keyword of an entity, all of them for a complex one, empty where it is not defined.

        Parameters
        ----------
        number : int
        """
        entity = self.table.get(number)
        if entity is None:
            return ""
        return entity.keyword or "+".join(word.decode() for word in _KEYWORD.findall(self.body(entity)))

    def parameters(self, entity: Entity) -> Nested:
        """The parameters of a simple entity as nested lists of their words.

        Parameters
        ----------
        entity : Entity
        """
        return parse_lists(b"(" + self.body(entity))

    def parts(self, entity: Entity) -> dict[str, Nested]:
        """The parameters of a complex entity, by keyword.

        Parameters
        ----------
        entity : Entity
        """
        found: dict[str, Nested] = {}
        words = parse_lists(b"(" + self.body(entity))
        for word, following in pairwise(words):
            if isinstance(word, bytes) and isinstance(following, list):
                found[word.decode()] = following
        return found


def parse_lists(text: bytes) -> Nested:
    """The lists of a text in brackets, one in another.

    Parameters
    ----------
    text : bytes
        Begins with an opening bracket; what stands after its closing one is not read.

    Examples
    --------
    >>> nested(b"(2,(#1,#2),.F.)")
    [b'2', [b'#1', b'#2'], b'.F.']
    >>> nested(b"()")
    []
    """
    stack: list[Nested] = [[]]
    for token in _TOKEN.findall(text):
        if token == b"(":
            stack.append([])
        elif token == b")":
            if len(stack) < 3:
                return stack[-1]
            closed = stack.pop()
            stack[-1].append(closed)
        else:
            stack[-1].append(token)
    return stack[-1]
