"""What the text of a STEP file says before any kernel sees it: is it whole, and how many faces must come out."""

import re
from dataclasses import dataclass
from pathlib import Path

from toolaxis.errors import InvalidInput

BOM = b"\xef\xbb\xbf"
_NOISE = re.compile(rb"'(?:[^']|'')*'|/\*.*?\*/", re.DOTALL)
_START = re.compile(rb"\s*ISO-10303-21\s*;")
_END = re.compile(rb"END-ISO-10303-21\s*;")
_DATA = re.compile(rb"\bDATA\s*(?:\([^;]*\))?;")
_NOT_FINITE = re.compile(rb"(?<=[(,\s])[+-]?(?:nan|inf|infinity|\d+\.#(?:ind|inf|qnan|snan)\w*)(?=[\s,)])", re.I)
_DEFINITION = re.compile(rb"#(\d+)\s*=")
_REFERENCE = re.compile(rb"#(\d+)")
_FACE = re.compile(rb"#(\d+)\s*=\s*(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")
_SHELL = re.compile(rb"=\s*(?:CLOSED_SHELL|OPEN_SHELL|CONNECTED_FACE_SET)\s*\(([^;]*)\)\s*;")
_CONTEXT = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)")
_LENGTH = re.compile(rb"#(\d+)\s*=\s*\(([^;]*?\bLENGTH_UNIT\b[^;]*)\)\s*;")
_BASED = re.compile(rb"CONVERSION_BASED_UNIT\s*\(\s*'([^']*)'")
_METRIC = re.compile(rb"SI_UNIT\s*\(\s*(?:\$|\.(\w+)\.)\s*,\s*\.(\w+)\.")


@dataclass(frozen=True)
class StepText:
    """What the text promises.

    Attributes
    ----------
    content : bytes
        Of the file, without byte-order mark.
    marked : bool
        A byte-order mark was there.
    faces : frozenset of int
        Entity numbers of the faces.
    dangling : tuple of int
        Entity numbers that are referred to but not defined.
    """

    content: bytes
    marked: bool
    faces: frozenset[int]
    dangling: tuple[int, ...]


def read_text(path: Path) -> StepText:
    """Read a STEP file and check its text.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When the file is missing, a directory, empty, not readable, not STEP, cut short, without data or faces, or
        holds numbers that are not finite.
    """
    content = _content(path)
    marked = content.startswith(BOM)
    content = content[len(BOM):] if marked else content
    bare = _NOISE.sub(b"' '", content)
    if not _START.match(bare):
        raise InvalidInput(f"{path} is not a STEP file: it does not begin with ISO-10303-21; "
                           "export the part as STEP (AP203, AP214 or AP242)")
    data = _DATA.search(bare)
    if not _END.search(bare):
        raise InvalidInput(f"{path} is cut short: END-ISO-10303-21 is missing at its end; copy or export it again")
    definitions = {int(n) for n in _DEFINITION.findall(bare, data.end())} if data else set()
    if data is None or not definitions:
        raise InvalidInput(f"{path} has a header but no data: export the part again")
    broken = _NOT_FINITE.search(bare, data.end())
    if broken:
        entity = _DEFINITION.findall(bare, data.end(), broken.start())[-1:]
        raise InvalidInput(f"{path} holds {broken.group().decode()} in entity #{int(entity[0]) if entity else '?'}: "
                           "every number must be finite; repair the geometry and export it again")
    faces = _faces(content)
    if not faces:
        raise InvalidInput(f"{path} holds no faces with exact geometry: export solids or surfaces, not meshes, "
                           "wires or drawings")
    referred = {int(n) for n in _REFERENCE.findall(bare, data.end())}
    return StepText(content, marked, faces, tuple(sorted(referred - definitions)))


def declared_unit(content: bytes) -> str:
    """The length units that the contexts of a STEP text declare, such as "millimetre" or "inch"; "not declared".

    Parameters
    ----------
    content : bytes
    """
    lengths = {int(number): body for number, body in _LENGTH.findall(content)}
    names = []
    for members in _CONTEXT.findall(content):
        names += [_unit_name(lengths[n]) for n in map(int, _REFERENCE.findall(members)) if n in lengths]
    return ", ".join(dict.fromkeys(filter(None, names))) or "not declared"


def _unit_name(body: bytes) -> str:
    based, metric = _BASED.search(body), _METRIC.search(body)
    if based:
        return based.group(1).decode(errors="replace").lower()
    return b"".join(word or b"" for word in metric.groups()).decode().lower() if metric else ""


def _content(path: Path) -> bytes:
    if not path.exists():
        raise InvalidInput(f"{path} does not exist: check the path")
    if not path.is_file():
        raise InvalidInput(f"{path} is a folder: name a STEP file in it")
    try:
        content = path.read_bytes()
    except OSError as reason:
        raise InvalidInput(f"{path} cannot be read: {reason.strerror}") from reason
    if not content.strip():
        raise InvalidInput(f"{path} is empty: export the part again")
    return content


def _faces(content: bytes) -> frozenset[int]:
    """Entities that are faces, or stand where a shell needs one; strings too, as a lost quote swaps in and out."""
    faces = {int(n) for n in _FACE.findall(content)}
    for members in _SHELL.findall(content):
        faces |= {int(n) for n in _REFERENCE.findall(members)}
    return frozenset(faces)
