"""A part: faces, the edges between them, and the bodies they bound."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.adjacency import Edge, edges_from_borders
from toolaxis.shape.allowances import Allowances
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HalfSpace
from toolaxis.shape.joining.edge_matching import match_edges, sides_of
from toolaxis.shape.seams import Seam, seam_warnings, seams
from toolaxis.shape.stock import Stock

Array = NDArray[np.float64]

PLAIN_KINDS = ("plane", "cylinder", "cone")

#: How the warning about a face that cannot be used goes on after its name.
LEFT_OUT = "was left out"
#: What is said of a face that is asked for though no tool may touch it.
AVOIDED_TOO = "is to be machined and to be avoided: take it out of one of the two lists"


@dataclass(frozen=True)
class Body:
    """Faces that belong together.

    Attributes
    ----------
    kind : str
        "solid", "shell" or "faces".
    faces : tuple of int
        Numbers.
    closed : bool
        Whether they bound a volume.
    """

    kind: str
    faces: tuple[int, ...]
    closed: bool


@dataclass(frozen=True, eq=False)
class Part:
    """What is to be machined.

    Attributes
    ----------
    faces : tuple of Face
        In the file's order.
    edges : tuple of Edge
    bodies : tuple of Body
    source : str
        Path of the file, or what it was made from.
    sha256 : str
        Of the file; empty where there is none.
    unit : str
        Length unit that the file declares; all numbers here are mm.
    warnings : tuple of str
    selected : tuple of int
        Numbers of the faces that the caller picked; empty where nothing was picked.
    original : Part or None
        The part as it came, where faces of it were joined, see `toolaxis.skin.join.join`.
    avoided : tuple of int
        Numbers of the faces that no tool may touch: they are walls to all others, however they meet them.
    held : HalfSpace or None
        The side that is held in the clamping: nothing of a tool may go there.
    stock : Stock or None
        What roughing left on its faces; None where they are taken as finished.
    allowances : Allowances or None
        What is left on faces on purpose, where that is not the same for all of them.

    Raises
    ------
    InvalidInput
        Without faces, with a face number twice, or with an edge to a face that is not there.
    """

    faces: tuple[Face, ...]
    edges: tuple[Edge, ...] = ()
    bodies: tuple[Body, ...] = ()
    source: str = ""
    sha256: str = ""
    unit: str = "mm"
    warnings: tuple[str, ...] = ()
    selected: tuple[int, ...] = ()
    original: "Part | None" = None
    avoided: tuple[int, ...] = ()
    held: HalfSpace | None = None
    stock: Stock | None = None
    allowances: Allowances | None = None

    def __post_init__(self) -> None:
        if not self.faces:
            raise InvalidInput("a part needs at least one face")
        numbers = [face.number for face in self.faces]
        twice = [number for number in numbers if numbers.count(number) > 1] if len(set(numbers)) < len(numbers) else []
        if twice:
            raise InvalidInput(f"face number {twice[0]} occurs twice: give every face of a part its own number")
        named = [number for edge in self.edges for number in edge.faces]
        named += [*self.selected, *self.avoided, *(number for body in self.bodies for number in body.faces)]
        missing = sorted(set(named) - set(numbers))
        if missing:
            raise InvalidInput(f"face {missing[0]} is named by an edge, a body or the selection but is not in the part")

    @classmethod
    def from_faces(cls, faces: Sequence[Face], edges: Sequence[Edge] | None = None, source: str = "") -> "Part":
        """A part from faces alone, numbered from 1 in their order.

        Parameters
        ----------
        faces : sequence of Face
        edges : sequence of Edge
            How they meet, by those new numbers; found by the position of their borders unless given.
        source : str

        Raises
        ------
        InvalidInput
            Without faces.
        """
        numbered = tuple(_number_face(face, k + 1) for k, face in enumerate(faces))
        body = Body("faces", tuple(face.number for face in numbered), False)
        if edges is None:
            whole = cls(numbered)
            sides = [side for face in numbered for side in sides_of(face)] if len(numbered) > 1 else []
            edges = edges_from_borders(numbered, match_edges(sides, whole.diagonal)) if sides else ()
        return cls(numbered, tuple(edges), (body,), source, warnings=seam_warnings(edges))

    def __repr__(self) -> str:
        """One line: all arrays written out are thousands."""
        return f"<Part of {len(self.faces)} faces, {len(self.sculptured)} sculptured>"

    @cached_property
    def _by_number(self) -> dict[int, Face]:
        return {face.number: face for face in self.faces}

    @cached_property
    def edges_to_touch(self) -> tuple[Edge, ...]:
        """The edges along which a tool may touch both faces: all but those of faces that are to be avoided."""
        return tuple(edge for edge in self.edges if not set(edge.faces) & set(self.avoided))

    @cached_property
    def ends_to_touch(self) -> Array:
        """Both ends of each of `edges_to_touch`, (edges, 2, 3) mm."""
        return np.array([edge.polyline[[0, -1]] for edge in self.edges_to_touch]).reshape(-1, 2, 3)

    @cached_property
    def _adjacent(self) -> dict[int, list[tuple[int, str]]]:
        table: dict[int, list[tuple[int, str]]] = {}
        for edge in self.edges_to_touch:
            a, b = edge.faces
            if a != b:
                table.setdefault(a, []).append((b, edge.kind))
                table.setdefault(b, []).append((a, edge.kind))
        return table

    def face(self, number: int) -> Face:
        """The face with a number, from 1.

        Raises
        ------
        InvalidInput
            When the part has no such face.
        """
        if number not in self._by_number:
            whole = [face for face in self.faces if number in face.numbers]
            if whole:
                raise InvalidInput(f"face {number} is joined to face {whole[0].label}: name that one by its first "
                                   f"number, {whole[0].number}")
            raise InvalidInput(f"face {number} does not exist: the part has {len(self.faces)} faces, "
                               f"{self.faces[0].number} to {self.faces[-1].number}")
        return self._by_number[number]

    def neighbours(self, number: int, kind: str | None = None) -> tuple[int, ...]:
        """Numbers of the faces that share an edge with a face, of one kind of edge if given; none that is avoided."""
        self.face(number)
        return tuple(sorted({other for other, how in self._adjacent.get(number, ()) if kind in (None, how)}))

    def skin(self, number: int) -> tuple[Face, ...]:
        """The face and all that continue it tangentially, directly or over others, itself first.

        Parameters
        ----------
        number : int

        Raises
        ------
        InvalidInput
            When the part has no such face.
        """
        reached, front = [number], [number]
        while front:
            new = [n for n in self.neighbours(front.pop(), "tangent") if n not in reached]
            reached += new
            front += new
        return tuple(self.face(n) for n in [number, *sorted(reached[1:])])

    def surroundings(self, number: int) -> tuple[Face, ...]:
        """All faces that are not in the skin of a face.

        Parameters
        ----------
        number : int

        Raises
        ------
        InvalidInput
            When the part has no such face.
        """
        own = {face.number for face in self.skin(number)}
        return tuple(face for face in self.faces if face.number not in own)

    @property
    def sculptured(self) -> tuple[Face, ...]:
        """The faces that are not planes, cylinders or cones, without those that are to be avoided."""
        return tuple(face for face in self.faces
                     if face.kind not in PLAIN_KINDS and face.number not in self.avoided)

    @cached_property
    def seams(self) -> tuple[Seam, ...]:
        """Pairs of faces that do not quite meet along an edge, the widest gap first."""
        return seams(self.edges)

    @cached_property
    def box(self) -> Array:
        """Lower and upper corner of the box around sampled points of all faces, (2, 3) mm."""
        boxes = np.array([face.box for face in self.faces])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    @cached_property
    def diagonal(self) -> float:
        """Length of the diagonal of `box`, mm."""
        return float(np.linalg.norm(self.box[1] - self.box[0]))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Warnings about faces of the file that could not be used: nothing is kept clear of them."""
        return tuple(warning for warning in self.warnings if LEFT_OUT in warning)

    def avoid_faces(self, numbers: Sequence[int]) -> "Part":
        """The part with faces that no tool may touch.

        Parameters
        ----------
        numbers : sequence of int
            A joined face stands for all faces that it consists of.

        Raises
        ------
        InvalidInput
            When the part has no such face.
        """
        found = {self.face(number) for number in numbers}
        own = {number for face in found for number in face.numbers}
        original = None if self.original is None else self.original.avoid_faces(sorted(own))
        return replace(self, avoided=tuple(sorted(face.number for face in found)), original=original)

    def hold_side(self, side: HalfSpace | None) -> "Part":
        """The part with a side that is held.

        Parameters
        ----------
        side : HalfSpace or None
        """
        return replace(self, held=side, original=None if self.original is None else self.original.hold_side(side))

    @cached_property
    def faces_of_held_side(self) -> tuple[Face, ...]:
        """The plane in which the held side ends, as a face that stands in the way of tools; none where none is held."""
        return () if self.held is None else (self.held.plane_beside(self.box),)

    def with_warnings(self, *warnings: str) -> "Part":
        """The part with further warnings."""
        return replace(self, warnings=(*self.warnings, *warnings))

    def with_stock(self, height: float, faces: Iterable[int]) -> "Part":
        """The part with stock on some of its faces.

        Parameters
        ----------
        height : float
            How far it stands above the finished surface, mm.
        faces : iterable of int
            Numbers, those of joined faces one by one.

        Raises
        ------
        InvalidInput
            When the height is not above zero or larger than the part, or the part has no such face.
        """
        stock = Stock(float(height), frozenset(faces))
        if stock.height >= self.diagonal:
            raise InvalidInput(f"stock is {stock.height:g} mm and the whole part measures {self.diagonal:.3g} mm: give "
                               "what roughing left above the finished faces")
        missing = sorted(stock.faces - {number for face in self.faces for number in face.numbers})
        if missing:
            raise InvalidInput(f"face {missing[0]} is said to carry stock and is not in the part: name its faces only")
        return replace(self, stock=stock)

    def stock_on(self, face: Face) -> float:
        """How far stock stands above a face of the part, mm; 0 where it is taken as finished.

        Parameters
        ----------
        face : Face
        """
        carries = self.stock is not None and not self.stock.faces.isdisjoint(face.numbers)
        return self.stock.height if self.stock is not None and carries else 0.0

    def leave_allowances(self, on_others: float, on: Mapping[int, float]) -> "Part":
        """The part with faces on which an allowance of their own is left.

        Parameters
        ----------
        on_others : float
            What is left on all other faces, mm.
        on : mapping of int to float
            By numbers of faces, mm; where there are none, nothing is kept of either.

        Raises
        ------
        InvalidInput
            When the part has no such face, or one is to be avoided too.
        """
        if not on:
            return self
        there = {number for face in self.faces for number in face.numbers}
        missing = sorted(set(on) - there)
        if missing:
            raise InvalidInput(f"face {missing[0]} is to keep an allowance and is not in the part: see toolaxis "
                               "inspect for the part's faces")
        avoided = sorted(set(on) & set((self.original or self).avoided))
        if avoided:
            raise InvalidInput(f"face {avoided[0]} is to keep an allowance and to be avoided: leave out one of both")
        kept = Allowances(on_others, dict(on))
        return replace(self, allowances=kept,
                       original=None if self.original is None else replace(self.original, allowances=kept))

    def allowance_on(self, face: Face) -> float:
        """What is left on a face of the part on purpose, mm; 0 where no face has an allowance of its own.

        Parameters
        ----------
        face : Face
        """
        return 0.0 if self.allowances is None else self.allowances.of(face)

    def transformed(self, matrix: ArrayLike) -> "Part":
        """The part moved by an affine map.

        Parameters
        ----------
        matrix : (4, 4) array_like
        """
        m = np.asarray(matrix, dtype=float)
        faces = tuple(face.transformed(m) for face in self.faces)
        scale = float(np.cbrt(abs(np.linalg.det(m[:3, :3]))))
        edges = tuple(replace(edge, polyline=edge.polyline @ m[:3, :3].T + m[:3, 3], gap=scale * edge.gap,
                              step=scale * edge.step) for edge in self.edges)
        original = None if self.original is None else self.original.transformed(m)
        held = None if self.held is None else self.held.transformed(m)
        return replace(self, faces=faces, edges=edges, original=original, held=held)


def _number_face(face: Face, number: int) -> Face:
    return replace(face, number=number, label=str(number) if face.label == str(face.number) else face.label)
