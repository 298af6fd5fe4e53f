"""What a job is asked for in words: face lists, tools, holders and limits, resolved and checked."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, isnan, nan, pi
from numbers import Integral, Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.job.inputs.tool_file import load_holder, load_tool
from toolaxis.plan.plan import PlanInputs
from toolaxis.shape.allowances import Allowances
from toolaxis.shape.face import Face
from toolaxis.shape.joining.closed_rings import ring_around
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER
from toolaxis.shape.part import AVOIDED_TOO, Part
from toolaxis.skin.find import find_skins
from toolaxis.skin.join import join, with_skins
from toolaxis.tools.tool import Tool

Numbers = tuple[int | tuple[int, ...], ...]

_ALLOWANCE_FORM = "is not understood: write numbers and a length in mm such as 3,5-8=0.3"


class SomeSkins(NamedTuple):
    """Some of a part's skins: their numbers, as `toolaxis inspect` lists them."""

    numbers: tuple[int, ...]


@dataclass(frozen=True)
class Spec:
    """A planning job as the command's user writes it; lengths in mm, angles in degrees.

    Attributes
    ----------
    part : str
        Path of a STEP file.
    tool : str
        Short form, file, or name from the library.
    inputs : PlanInputs
    faces : str
        "3,5-8", "3+4,7" with faces to be joined, "all", "skins", "skins 1,3", or empty for the sculptured faces.
    holder : str
        File or rows "r,z;r,z"; empty for the tool file's own, or none.
    stickout : float or None
    obstacles : tuple of str
        Paths of STEP files.
    regions : int, "auto" or None
        Sub-surfaces for each face; None leaves faces whole.
    orientations : int, "auto" or None
        Greatest number of different axes.
    machine : str
        Name in the library, or file; empty for none.
    offset : str
        Place of the part on the machine's table, "X,Y,Z"; empty where it is not known.
    """

    part: str
    tool: str
    inputs: PlanInputs
    faces: str = ""
    holder: str = ""
    stickout: float | None = None
    obstacles: tuple[str, ...] = ()
    regions: int | str | None = None
    orientations: int | str | None = None
    machine: str = ""
    offset: str = ""

    def resolved_tool(self) -> Tool:
        """The tool with its holder.

        Raises
        ------
        InvalidInput
            When tool, holder and stick-out do not make one, or the scallop is not below the cutter's radius.
        """
        body = load_holder(self.holder) if self.holder else {}
        if self.stickout is not None:
            body["stickout"] = self.stickout
        tool = load_tool(self.tool, **body)
        self.inputs.check_tool(tool)
        return tool

    @property
    def place(self) -> NDArray[np.float64] | None:
        """The place of the part on the machine's table, as `toolaxis.plan` takes it.

        Raises
        ------
        InvalidInput
            When there are not three finite numbers.
        """
        return offset_from(self.offset) if self.offset else None

    @property
    def numbers(self) -> "Numbers | SomeSkins | str | None":
        """The face list as `toolaxis.plan` takes it."""
        return parse_faces(self.faces) if self.faces else None


def parse_faces(text: str) -> Numbers | SomeSkins | str:
    """Face numbers from their short form.

    Parameters
    ----------
    text : str
        "3,5-8", "all", or "skins"; "3+4,7" for faces that are to be joined; "skins 1,3" for some skins.

    Returns
    -------
    tuple or str
        Numbers, and tuples of numbers for faces that are to be joined; "all" or "skins" as they are.

    Raises
    ------
    InvalidInput
        When the text is not of that form.
    """
    plain = text.strip().lower()
    if plain in ("all", "skins"):
        return plain
    if plain.startswith("skins "):
        wanted = parse_faces(plain.removeprefix("skins"))
        if isinstance(wanted, str | SomeSkins) or not all(isinstance(number, int) for number in wanted):
            raise InvalidInput(f"skins {plain.removeprefix('skins').strip()!r} is not understood: write 1,3-5")
        return SomeSkins(tuple(int(number) for number in wanted if isinstance(number, int)))
    numbers: list[int | tuple[int, ...]] = []
    for piece in text.split(","):
        members = [number.strip() for number in piece.split("+")]
        low, dash, high = members[0].partition("-")
        wrong = not low.isdigit() or (dash and not high.isdigit()) or (dash and int(high) < int(low))
        if wrong or (len(members) > 1 and not all(number.isdigit() for number in members)):
            raise InvalidInput(f"faces {text!r} is not understood at {piece!r}: write 3,5-8, 3+4 to join faces, all or "
                               "skins")
        largest = max(int(number) for number in (low, high or low, *members[1:]))
        if largest > 10**6:
            raise InvalidInput(f"face {largest} is out of range: see toolaxis inspect for the part's faces")
        numbers += [tuple(map(int, members))] if len(members) > 1 else range(int(low), int(high or low) + 1)
    return tuple(dict.fromkeys(numbers))


def parse_avoided(text: str) -> tuple[int, ...]:
    """Numbers of faces to be avoided from their short form.

    Parameters
    ----------
    text : str
        "3,5-8"; empty for none.

    Raises
    ------
    InvalidInput
        When the text is not of that form.
    """
    if not text.strip():
        return ()
    plain = [piece.strip() for piece in text.split(",")]
    if not all(piece.replace("-", "", 1).isdigit() for piece in plain):
        raise InvalidInput(f"faces to be avoided {text!r} are not understood: write numbers such as 3,5-8")
    found = parse_faces(text)
    return tuple(number for number in found if isinstance(number, int))


def numbers_to_avoid(given: Iterable[int] | int | str | None) -> tuple[int, ...]:
    """Numbers of the faces to be avoided, each once.

    Parameters
    ----------
    given : int, iterable of int, text such as "3,5-8", or None

    Raises
    ------
    InvalidInput
        When one is no number of a face.
    """
    if isinstance(given, str):
        return tuple(sorted(parse_avoided(given)))
    found = () if given is None else tuple(given) if isinstance(given, Iterable) else (given,)
    wrong = [number for number in found if isinstance(number, bool) or not isinstance(number, Integral)]
    if wrong:
        raise InvalidInput(f"face {wrong[0]!r} to be avoided is no number of a face: give whole numbers from 1")
    return tuple(sorted({int(number) for number in found}))


def parse_allowances(given: Mapping[Any, float] | Iterable[Any] | str | None) -> tuple[tuple[int, float], ...]:
    """Faces with an allowance of their own, each once, by their numbers.

    Parameters
    ----------
    given : mapping of int to float, text such as "3,5-8=0.3;9=0.1", iterable of such texts or of pairs, or None

    Raises
    ------
    InvalidInput
        When it is not of that form, or a face has two different ones.
    """
    pairs: list[tuple[int, float]] = []
    rows: list[Any] = [given] if isinstance(given, str) else list(given.items()) if isinstance(
        given, Mapping) else list(given or ())
    for row in rows:
        if isinstance(row, str):
            for piece in filter(None, map(str.strip, row.split(";"))):
                pairs += _allowance_in(piece)
        elif isinstance(row, Sequence) and len(row) == 2 and isinstance(row[0], str):
            pairs += _allowance_in(f"{row[0]}={row[1]}")
        elif isinstance(row, Sequence) and len(row) == 2 and isinstance(row[1], Real):
            pairs.append((row[0], float(row[1])))
        else:
            raise InvalidInput(f"allowance on faces {row!r} {_ALLOWANCE_FORM}")
    found: dict[int, float] = {}
    for number, value in pairs:
        if found.setdefault(number, value) != value:
            raise InvalidInput(f"face {number} is to keep an allowance of {found[number]:g} mm and one of {value:g} "
                               "mm: give one of them")
    Allowances(0.0, found)
    return tuple(sorted(found.items()))


def _allowance_in(piece: str) -> list[tuple[int, float]]:
    """Faces and their allowance in a text such as "3,5-8=0.3"."""
    faces, _, value = piece.partition("=")
    plain = [number.strip() for number in faces.split(",")]
    try:
        left = float(value)
    except ValueError:
        left = nan
    if isnan(left) or not all(number.replace("-", "", 1).isdigit() for number in plain):
        raise InvalidInput(f"allowance on faces {piece!r} {_ALLOWANCE_FORM}")
    return [(number, left) for number in parse_faces(faces) if isinstance(number, int)]


def offset_from(text: str) -> NDArray[np.float64]:
    """A work offset from three numbers X,Y,Z, mm.

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When there are not three finite numbers.
    """
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not all(isfinite(value) for value in values):
        raise InvalidInput(f"offset {text!r} is none: give the part's origin on the table, three numbers X,Y,Z in mm")
    return np.array(values)


def choose_faces(part: Part, faces: Iterable[int] | int | str | None) -> tuple[Face, ...]:
    """The faces to machine.

    Parameters
    ----------
    part : Part
    faces : int, iterable of int, "all", a text such as "3,5-8", or None
        None stands for the faces that were picked when the part was loaded, else for the sculptured ones.

    Raises
    ------
    InvalidInput
        When a number is out of range or no whole number, or there is no sculptured face.
    """
    asked: Any = parse_faces(faces) if isinstance(faces, str) else faces
    if isinstance(asked, SomeSkins):
        raise InvalidInput("skins are chosen before faces: give toolaxis.plan the list itself")
    if isinstance(asked, str):
        found = tuple(face for face in part.faces if face.number not in part.avoided)
        if not found:
            raise InvalidInput(f"all {len(part.faces)} faces of the part are to be avoided: leave one at least to be "
                               "machined")
        return found
    if asked is None:
        found = tuple(part.face(number) for number in part.selected) or part.sculptured
        if not found and part.avoided:
            raise InvalidInput("all sculptured faces of the part are to be avoided: leave one at least, or choose "
                               "faces by number")
        if not found:
            raise InvalidInput(f"none of the part's {len(part.faces)} faces is sculptured (all are planes, cylinders "
                               "or cones): choose faces by number, or all")
        check_not_avoided(part, found)
        return found
    numbers = list(asked) if isinstance(asked, Iterable) else [asked]
    if not numbers:
        raise InvalidInput("the list of faces is empty: choose at least one face, or all")
    wrong = [number for number in numbers if not isinstance(number, Integral)]
    if wrong:
        raise InvalidInput(f"face {wrong[0]!r} is no number of a face: give whole numbers from 1, or all")
    chosen = tuple(part.face(int(number)) for number in dict.fromkeys(numbers))
    check_not_avoided(part, chosen)
    return chosen


def check_not_avoided(part: Part, faces: Iterable[Face]) -> None:
    """Check that no face that is to be machined is to be avoided too.

    Parameters
    ----------
    part : Part
    faces : iterable of Face
        Of the part.

    Raises
    ------
    InvalidInput
        When one is.
    """
    avoided = [face for face in faces if face.number in part.avoided]
    if avoided:
        raise InvalidInput(f"face {avoided[0].label} {AVOIDED_TOO}")


def with_joined(part: Part, faces: Iterable[int | Iterable[int]] | int | str | None,
                corner: float = GREATEST_CORNER, width: float = 0.0, asked: bool = True) -> tuple[Part, Any]:
    """The part with the faces joined that are asked for as one, and the list of faces that is left for `choose_faces`.

    Parameters
    ----------
    part : Part
    faces : int, iterable of int and of iterables of int, text or None
        "skins" joins all that can be joined of the sculptured faces, and warns of what cannot.
    corner : float
        Greatest angle by which iso-parametric lines may turn across joins that are asked for, rad.
    width : float
        Planes, cylinders and cones narrower than that belong to the skins that they continue, mm.
    asked : bool
        Whether somebody asked for skins: then it is told where there are none.

    Raises
    ------
    InvalidInput, UnsupportedGeometry
        When a list is not understood, or faces cannot be joined.
    """
    if isinstance(faces, str):
        faces = parse_faces(faces)
    if faces == "skins":
        found = find_skins(part, width)
        part = with_skins(part, found.faces)
        alone = () if found.joined or not asked else (
            f"--faces skins joins nothing: each of the {len(found.single)} sculptured faces is machined by itself"
            + _where_apart(found.reasons),)
        return replace(part, selected=()).with_warnings(*alone, *found.reasons), None
    if isinstance(faces, SomeSkins):
        skins = _skins_by_number(part, faces.numbers)
        return with_skins(part, skins), [skin.number for skin in skins]
    if not isinstance(faces, Iterable) or isinstance(faces, str):
        return part, faces
    rows: list[Any] = []
    for row in faces:
        if isinstance(row, Iterable) and not isinstance(row, str):
            members = tuple(row)
            part = join(part, members, corner=corner)
            row = members[0]
        rows.append(row)
    return part, rows


def _skins_by_number(part: Part, numbers: Iterable[int]) -> tuple[Face, ...]:
    """Some skins, each as one face, by the numbers that `toolaxis inspect` gives them."""
    found = find_skins(replace(part.avoid_faces(()), allowances=None)).faces  # numbered as for the part alone
    for number in numbers:
        if not 1 <= number <= len(found):
            raise InvalidInput(f"skin {number} does not exist: the part has {len(found)} of two faces or more, see "
                               "toolaxis inspect")
    skins = tuple(found[number - 1] for number in numbers)
    avoided = [number for skin in skins for number in skin.numbers if number in part.avoided]
    if avoided:
        raise InvalidInput(f"face {avoided[0]} {AVOIDED_TOO}")
    return skins


def _where_apart(reasons: tuple[str, ...]) -> str:
    """What follows where no skin is found: nothing where reasons follow that say why."""
    return "" if reasons else ", since none continues another one smoothly"


def with_rings(part: Part, faces: Any) -> tuple[Part, Any]:
    """The part with the rings joined in which chosen faces lie, and the list of faces that is left for `choose_faces`.

    Parameters
    ----------
    part : Part
    faces : as `with_joined` leaves them
        Faces that close by themselves, are joined already, or lie in no ring stay as they are.

    Raises
    ------
    InvalidInput, UnsupportedGeometry
        When a face is not there, or those of a ring cannot be joined.
    """
    left: dict[int, None] = {}
    within: set[int] = set()
    for face in choose_faces(part, faces):
        if face.number in within:
            continue
        ring = () if face.members else ring_around(part, face.number)
        if ring:
            part = join(part, ring, corner=pi)
            within.update(ring)
        left[face.number] = None
    return part, list(left)
