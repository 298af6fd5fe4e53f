"""Other files that a STEP text refers to for its geometry."""

import re
from collections.abc import Iterator

from toolaxis.cad.step.entities import Entities

_SECTION = re.compile(rb"\bREFERENCE\s*;(.*?)\bENDSEC\s*;", re.DOTALL)
_TARGET = re.compile(rb"<\s*([^<>#]+)")
_STRING = re.compile(rb"'((?:[^']|'')*)'")
_DOCUMENT = re.compile(rb"(?<![A-Z_])DOCUMENT\s*\(\s*'((?:[^']|'')*)'")
_UNICODE = re.compile(r"\\X2\\((?:[0-9A-F]{4})+)\\X0\\")
_BYTE = re.compile(r"\\X\\([0-9A-F]{2})")
_SHIFTED = re.compile(r"\\S\\(.)")

#: Endings of files with geometry; other documents are drawings and the like.
GEOMETRY = (".stp", ".step", ".p21", ".stpz", ".stpx", ".prt", ".asm", ".sldprt", ".sldasm", ".catpart", ".catproduct",
            ".ipt", ".iam", ".x_t", ".x_b", ".jt", ".igs", ".iges", ".brep", ".sat", ".model", ".par", ".psm")


def find_linked_files(entities: Entities) -> list[str]:
    """Names of the files that a text refers to.

    Parameters
    ----------
    entities : Entities
    """
    return list(dict.fromkeys(_names(entities)))


def with_geometry(names: list[str]) -> list[str]:
    """Those names that are of files with geometry.

    Parameters
    ----------
    names : list of str
    """
    return [name for name in names if name.lower().endswith(GEOMETRY)]


def list_names(names: list[str]) -> str:
    """The first three names, and how many more there are.

    Parameters
    ----------
    names : list of str
    """
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _names(entities: Entities) -> Iterator[str]:
    content = entities.content
    for entity in entities.of("DOCUMENT_FILE", "APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT"):
        name = _STRING.search(content, entity.start, entity.end)
        if name and name.group(1):
            yield plain(name.group(1))
    for entity in entities.complex_of("DOCUMENT_FILE"):
        name = _DOCUMENT.search(content, entity.start, entity.end)
        if name and name.group(1):
            yield plain(name.group(1))
    for section in _SECTION.finditer(content, 0, max(entities.data, 0)):
        for target in _TARGET.findall(section.group(1)):
            yield plain(target.strip())


def plain(text: bytes) -> str:
    """A string of a STEP text as people read it.

    Parameters
    ----------
    text : bytes
        Without its outer quotes.

    Examples
    --------
    >>> plain(b"it''s Fl\\\\X2\\\\00E4\\\\X0\\\\che")
    "it's Fläche"
    """
    try:
        name = text.decode()
    except UnicodeDecodeError:
        name = text.decode("latin-1")
    name = _UNICODE.sub(lambda code: bytes.fromhex(code.group(1)).decode("utf-16-be", errors="replace"), name)
    name = _BYTE.sub(lambda code: chr(int(code.group(1), 16)), name)
    name = _SHIFTED.sub(lambda code: chr(ord(code.group(1)) + 128), name)
    return name.replace("''", "'").replace("\\\\", "\\")
