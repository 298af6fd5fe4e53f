"""Which faces a STEP text promises, where they hang, and in which order a kernel numbers them."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from toolaxis.cad.shape_data import ShapeRecord, Transfer, left_out
from toolaxis.cad.step.entities import Entities, Entity

FACES = ("ADVANCED_FACE", "FACE_SURFACE")
SHELLS = ("CLOSED_SHELL", "OPEN_SHELL", "CONNECTED_FACE_SET", "CONNECTED_FACE_SUB_SET")
SETS = ("GEOMETRIC_SET", "GEOMETRIC_CURVE_SET")
REPRESENTATIONS = (
    "SHAPE_REPRESENTATION", "ADVANCED_BREP_SHAPE_REPRESENTATION", "FACETED_BREP_SHAPE_REPRESENTATION",
    "MANIFOLD_SURFACE_SHAPE_REPRESENTATION", "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION",
    "NON_MANIFOLD_SURFACE_SHAPE_REPRESENTATION", "EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION",
    "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
)
#: Representations of what only helped to construct the part, which no kernel reads.
HELPERS = ("CONSTRUCTIVE_GEOMETRY_REPRESENTATION",)
#: Surfaces with an end of their own, which are faces where they stand in a set.
BOUNDED = ("CURVE_BOUNDED_SURFACE", "RECTANGULAR_TRIMMED_SURFACE", "B_SPLINE_SURFACE_WITH_KNOTS", "BEZIER_SURFACE",
           "UNIFORM_SURFACE", "QUASI_UNIFORM_SURFACE", "RECTANGULAR_COMPOSITE_SURFACE")


class FaceLists(NamedTuple):
    """Faces as they hang in shells, sets and representations.

    Attributes
    ----------
    lists : tuple of tuple of int
        Entity numbers, a list for each shell, set or representation that holds faces, each face once.
    faces : frozenset of int
        All that a kernel has to make a face of.
    """

    lists: tuple[tuple[int, ...], ...]
    faces: frozenset[int]


def is_bounded_surface(entities: Entities, number: int) -> bool:
    """Whether an entity is a surface with an end of its own.

    Parameters
    ----------
    entities : Entities
    number : int
    """
    kind = entities.kind(number)
    return kind in BOUNDED or ("+" in kind and "B_SPLINE_SURFACE" in kind.split("+"))


def own_face(entities: Entities, number: int) -> int:
    """The face itself where another one only turns it over.

    Parameters
    ----------
    entities : Entities
    number : int
    """
    if entities.kind(number) != "ORIENTED_FACE":
        return number
    return (entities.references(entities.table[number]) or [number])[-1]


def face_lists(entities: Entities) -> FaceLists:
    """The faces of a text and the lists that they stand in.

    Parameters
    ----------
    entities : Entities
    """
    groups = [[own_face(entities, number) for number in entities.members(shell)] for shell in entities.of(*SHELLS)]
    for holder in entities.of(*SETS):
        groups.append([number for number in entities.members(holder) if is_bounded_surface(entities, number)])
    for holder in entities.of(*REPRESENTATIONS):
        groups.append([number for number in entities.members(holder)
                       if entities.kind(number) in FACES or is_bounded_surface(entities, number)])
    groups.append([face.number for face in entities.of(*FACES)])
    helping = _helping(entities)
    seen: set[int] = set()
    lists = []
    for group in groups:
        own = tuple(dict.fromkeys(number for number in group if number not in seen and number not in helping))
        seen.update(own)
        if own:
            lists.append(own)
    return FaceLists(tuple(lists), frozenset(seen))


def _helping(entities: Entities) -> set[int]:
    """Faces that hang in nothing but what helped to construct the part."""
    helpers = list(entities.of(*HELPERS))
    if not helpers:
        return set()
    holders = [holder for kind in REPRESENTATIONS for holder in entities.of(kind)]
    wanted = FACES + BOUNDED
    return find_referring(entities, helpers, wanted) - find_referring(entities, holders, wanted)


def find_referring(entities: Entities, starts: Iterable[Entity], wanted: Sequence[str]) -> set[int]:
    """Entities of some kinds that others refer to, directly or over more; what they refer to is not followed.

    Parameters
    ----------
    entities : Entities
    starts : iterable of Entity
    wanted : sequence of str
        Keywords.
    """
    found: set[int] = set()
    seen: set[int] = set()
    front = [entity.number for entity in starts]
    while front:
        number = front.pop()
        if number in seen or number not in entities.table:
            continue
        seen.add(number)
        if entities.kind(number) in wanted or is_bounded_surface(entities, number):
            found.add(number)
        else:
            front += entities.references(entities.table[number])
    return found


@dataclass(frozen=True)
class FaceOrder:
    """What says which face of a text a kernel's face is, and which number it has.

    Attributes
    ----------
    definitions : tuple of int
        Entity numbers in the order of the text that the kernel reads.
    lists : tuple of tuple of int
        As `FaceLists` has them.
    left : mapping of int to str
        Faces that the kernel does not get, and why.
    """

    definitions: tuple[int, ...]
    lists: tuple[tuple[int, ...], ...]
    left: Mapping[int, str] = field(default_factory=dict)

    def origins(self, ranks: Sequence[int], count: int) -> list[int]:
        """Entity numbers of the kernel's faces, 0 where unknown.

        Parameters
        ----------
        ranks : sequence of int
            Place of each face's entity in the text, from 1; 0 where unknown.
        count : int
            How many entities the kernel has found in the text.
        """
        if count != len(self.definitions):
            return [0] * len(ranks)
        return [self.definitions[rank - 1] if rank else 0 for rank in ranks]

    @property
    def promised(self) -> int:
        """How many different faces the kernel is to make."""
        return sum(map(len, self.lists)) - len(self.left)

    def guessed(self, count: int) -> list[int]:
        """Entity numbers of the kernel's faces where it does not tell them: known where all hang in one list.

        Parameters
        ----------
        count : int
            How many faces the kernel has made.
        """
        rest = [number for number in self.lists[0] if number not in self.left] if len(self.lists) == 1 else []
        return rest if len(rest) == count else [0] * count


class Numbers(NamedTuple):
    """Numbers of faces in their file.

    Attributes
    ----------
    made : list of int
        Of the kernel's faces, in its order.
    missing : dict of int to int
        Of faces that the kernel has not made, by entity number: where they would stand.
    """

    made: list[int]
    missing: dict[int, int]


def number_faces(order: FaceOrder, origins: Sequence[int]) -> Numbers:
    """The numbers that faces have in the whole file, where a kernel has made some of them only.

    Parameters
    ----------
    order : FaceOrder
    origins : sequence of int
        Entity numbers of the kernel's faces; 0 where unknown.

    Notes
    -----
    A kernel goes through the lists one by one, and through each in its order; a list that stands in several places
    comes once for each.  Where no face is missing, or not all origins are known, its own order is kept as it is.
    """
    absent = {number for group in order.lists for number in group} - set(origins)
    if not absent or 0 in origins:
        return Numbers(list(range(1, len(origins) + 1)), {})
    home = {number: k for k, group in enumerate(order.lists) for number in group}
    turn: Counter[int] = Counter()
    places: dict[tuple[int, int], dict[int, int]] = {}
    for index, origin in enumerate(origins):
        key = (home.get(origin, -1), turn[origin])
        turn[origin] += 1
        places.setdefault(key, {})[origin] = index
    for k, group in enumerate(order.lists):
        if not set(group) - absent:
            places[k, 0] = {}
    made, missing, count = [0] * len(origins), dict[int, int](), 0
    for (k, _), found in places.items():
        for number in order.lists[k] if k >= 0 else found:
            if number in found or number in absent:
                count += 1
            if number in found:
                made[found[number]] = count
            elif number in absent:
                missing.setdefault(number, count)
    return Numbers(made, missing)


def warn_of_lost_faces(record: ShapeRecord, copies: Sequence[int], order: FaceOrder, numbers: Numbers,
                       origins: Sequence[int]) -> Transfer:
    """What a kernel has made of a file, with a warning for each face that it was not given.

    Parameters
    ----------
    record : ShapeRecord
    copies : sequence of int
        Numbers from 1 of the kernel's faces, the same for copies of one in several places.
    order : FaceOrder
    numbers : Numbers
    origins : sequence of int
        Entity numbers of the kernel's faces; 0 where unknown.
    """
    for entity, why in order.left.items():
        number = numbers.missing.get(entity)
        name = f"face {number} (#{entity})" if number else f"face #{entity} of the file"
        record.warnings.append(left_out(name, why))
    lost = {entity: number for entity, number in numbers.missing.items() if entity not in order.left}
    pieces = Counter(dict(zip(copies, origins, strict=True)).values())
    split = {entity: times for entity, times in pieces.items() if entity and times > 1}
    return Transfer(record, len(set(copies)) - record.endless, lost, split)
