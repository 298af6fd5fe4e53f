"""What the text of a STEP file says before any kernel sees it: is it whole, and which faces must come out."""

import re
from dataclasses import dataclass
from pathlib import Path

from toolaxis.cad.step.damage import damaged_entities, faces_with, far_entities, place_damage, text_damage
from toolaxis.cad.step.entities import Entities
from toolaxis.cad.step.faces import FaceLists, FaceOrder, face_lists
from toolaxis.cad.step.file import EXPORT, file_bytes, plain_text
from toolaxis.cad.step.homes import give_models, give_products
from toolaxis.cad.step.links import find_linked_files, list_names, with_geometry
from toolaxis.cad.step.mending import Mending, leave_out
from toolaxis.cad.step.units import length_units, unit_fault
from toolaxis.errors import InvalidInput

_START = re.compile(rb"\s*ISO-10303-21\s*;")
_END = re.compile(rb"(ENDSEC\s*;\s*)?END-ISO-10303-21\s*;")
_NAMED_DATA = re.compile(rb"\bDATA\s*\([^;]*\)\s*;")

UNDECLARED = "not declared"
ACCEPT = "repair it in the CAD system and export it again, or pass accept_lost_faces=True in Python"


@dataclass(frozen=True)
class StepText:
    """What the text promises.

    Attributes
    ----------
    content : bytes
        As a kernel is to read it.
    changed : bool
        It is not what the file holds.
    faces : frozenset of int
        Entity numbers of the faces.
    order : FaceOrder
        Which of them a kernel's faces are; those that it does not get, and why.
    dangling : tuple of int
        Entity numbers that are referred to but not defined.
    unit : str
        The declared length units, such as "millimetre" or "inch"; "not declared".
    notes : tuple of str
        Sentences about what was mended, or is not as it should be.
    homeless : frozenset of int
        Faces that stand in no product of the file: kernels do not read them.
    """

    content: bytes
    changed: bool
    faces: frozenset[int]
    order: FaceOrder
    dangling: tuple[int, ...]
    unit: str
    notes: tuple[str, ...]
    homeless: frozenset[int] = frozenset()


def read_text(path: Path, accept_lost_faces: bool = False) -> StepText:
    """Read a STEP file, check its text and mend it where its faces are not in doubt.

    Parameters
    ----------
    path : Path
    accept_lost_faces : bool
        Leave out faces that are damaged instead of refusing the file.

    Raises
    ------
    InvalidInput
        When the file is missing, a directory, empty, not readable, not STEP, cut short, without data or faces, only
        refers to other files, or holds numbers that are not finite, numbers of entities twice, unknown units or
        faces that are damaged.
    """
    raw = file_bytes(path)
    content, notes = plain_text(path, raw)
    entities = _entities(path, content)
    fault = text_damage(entities)
    if fault:
        raise InvalidInput(f"{path} {fault}")
    promised, links = face_lists(entities), find_linked_files(entities)
    if not promised.faces:
        raise InvalidInput(f"{path} {_nothing(entities, links)}")
    left = _faces_to_leave_out(path, entities, promised, accept_lost_faces)
    fault = unit_fault(entities) or place_damage(entities)
    if fault:
        raise InvalidInput(f"{path} {fault}")
    mending = Mending(entities)
    leave_out(mending, left)
    give_models(mending)
    homeless = give_products(mending, promised.faces.difference(left))
    mended = Entities(mending.content()) if mending.changed else entities
    dangling = tuple(sorted(mended.dangling))
    unit = _unit(entities)
    notes += [*mending.notes, *_reservations(unit, links)]
    order = FaceOrder(mended.definitions, promised.lists, left)
    changed = mended.content != raw
    return StepText(mended.content, changed, promised.faces, order, dangling, unit, tuple(notes), homeless)


def find_declared_unit(content: bytes) -> str:
    """The length units that the contexts of a STEP text declare, such as "millimetre" or "inch"; "not declared".

    Parameters
    ----------
    content : bytes
    """
    return _unit(Entities(content))


def _unit(entities: Entities) -> str:
    return ", ".join(dict.fromkeys(length_units(entities).values())) or UNDECLARED


def _reservations(unit: str, links: list[str]) -> list[str]:
    """What is not certain about a file that can be read."""
    found = ["the file declares no length unit: its numbers were taken for mm"] if unit == UNDECLARED else []
    elsewhere = with_geometry(links)
    if elsewhere:
        found.append(f"the file also refers to {list_names(elsewhere)}; what stands there is not read: "
                     "export everything as one STEP file")
    return found


def _entities(path: Path, content: bytes) -> Entities:
    """The entities of a text that is whole, from its first line to its last."""
    entities = Entities(content)
    if not _START.match(entities.bare):
        raise InvalidInput(f"{path} is not a STEP file: it does not begin with ISO-10303-21; {EXPORT}")
    end = _END.search(entities.bare)
    if not end:
        raise InvalidInput(f"{path} is cut short: END-ISO-10303-21 is missing at its end; copy or export it again")
    if not entities.definitions:
        raise InvalidInput(f"{path} has a header but no data: export the part again")
    if not end.group(1):
        raise InvalidInput(f"{path} is cut short: ENDSEC is missing before END-ISO-10303-21; copy or export it again")
    if not _NAMED_DATA.search(entities.bare):
        return entities
    # Named sections came with a later edition of the format, and the kernel's parser knows none.
    plain = bytearray(content)
    for section in _NAMED_DATA.finditer(entities.bare):
        plain[section.start():section.end()] = b"DATA;".ljust(section.end() - section.start())
    return Entities(bytes(plain))


def _nothing(entities: Entities, links: list[str]) -> str:
    """Why a text holds no faces, and what to do."""
    if links:
        return (f"holds no geometry itself: it refers to other files, {list_names(links)}; open it in the CAD system "
                "and export everything as one STEP file")
    other = {"TESSELLATED": "a mesh", "TRIANGULATED": "a mesh", "POLY_LOOP": "a mesh", "CURVE": "curves",
             "B_SPLINE_SURFACE": "surfaces that no face uses"}
    kinds = {entity.keyword for entity in entities.table.values()}
    found = dict.fromkeys(what for word, what in other.items() if any(word in kind for kind in kinds))
    only = f" but {' and '.join(found)}" if found else ""
    return f"holds no faces with exact geometry{only}: export solids or surfaces, not meshes, wires or drawings"


def _faces_to_leave_out(path: Path, entities: Entities, promised: FaceLists, accept: bool) -> dict[int, str]:
    """Faces that no kernel is to see, and why: with absurd lengths, and damaged ones where that is accepted."""
    faces = [number for group in promised.lists for number in group]
    far = faces_with(entities, faces, far_entities(entities))
    damaged = faces_with(entities, [number for number in faces if number not in far], damaged_entities(entities))
    if damaged and not accept:
        first, *others = damaged
        more = f", and {len(others)} more face{'s' * (len(others) > 1)}: first," if others else ":"
        raise InvalidInput(f"{path}: {_face_name(promised, first)} is damaged{more} {damaged[first]}; {ACCEPT}")
    left = {face: f"{why}: repair the face in the CAD system" for face, why in {**far, **damaged}.items()}
    if len(left) == len(faces):
        raise InvalidInput(f"{path} has no face that can be used; {_face_name(promised, faces[0])}: {left[faces[0]]}")
    return left


def _face_name(promised: FaceLists, number: int) -> str:
    """What people call a face: by its number where it is certain before a kernel has numbered the whole."""
    return f"face {promised.lists[0].index(number) + 1} (#{number})" if len(promised.lists) == 1 else f"face #{number}"
