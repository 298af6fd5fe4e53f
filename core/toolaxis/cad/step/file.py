"""The bytes of a STEP file as plain text, or one sentence about what the file is instead."""

from pathlib import Path

from toolaxis.errors import InvalidInput

BOM = b"\xef\xbb\xbf"

#: How other files begin, and what they are.
FOREIGN = (
    (b"\x1f\x8b", "packed with gzip: unpack it first"),
    (b"pk\x03\x04", "a zip archive: unpack it first"),
    (b"7z\xbc\xaf", "a 7-Zip archive: unpack it first"),
    (b"version https://git-lfs", "a pointer of Git LFS: fetch the file itself with git lfs pull"),
    (b"<!doctype html", "a web page: download the file itself"),
    (b"<html", "a web page: download the file itself"),
    (b"<?xml", "an XML file: an assembly in XML (.stpx) only refers to other files; open it in the CAD system and "
               "export it as one STEP file"),
    (b"%pdf", "a PDF document: export the part as STEP"),
    (b"dbrep_drawableshape", "a BREP file of Open CASCADE: export the part as STEP"),
    (b"cascade topology", "a BREP file of Open CASCADE: export the part as STEP"),
    (b"solid", "an STL mesh without exact surfaces: export the part as STEP"),
    (b"**abcdefghijklmnopqrstuvwxyz", "a Parasolid file: export the part as STEP"),
)

#: Encodings of two and four bytes a character, by their mark or by the zeros in the first letters.
WIDE = (
    (b"\xff\xfe\x00\x00", "utf-32"), (b"\x00\x00\xfe\xff", "utf-32"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"),
    (b"I\x00S\x00", "utf-16-le"), (b"\x00I\x00S", "utf-16-be"), (b"I\x00\x00\x00", "utf-32-le"),
    (b"\x00\x00\x00I", "utf-32-be"),
)

EXPORT = "export the part as STEP (AP203, AP214 or AP242)"


def file_bytes(path: Path) -> bytes:
    """Everything in a file.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InvalidInput
        When it is missing, a folder, not readable or empty.
    """
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


def plain_text(path: Path, content: bytes) -> tuple[bytes, list[str]]:
    """The content in an encoding with one byte for each letter of the alphabet, and what had to be done for it.

    Parameters
    ----------
    path : Path
        For the sentence.
    content : bytes

    Raises
    ------
    InvalidInput
        When it begins like a file of another kind.
    """
    if content.startswith(BOM):
        return content[len(BOM):], []
    for mark, encoding in WIDE:
        if content.startswith(mark):
            return _narrow_text(path, content, encoding)
    start = content[:200].lstrip().lower()
    for mark, what in FOREIGN:
        if start.startswith(mark):
            raise InvalidInput(f"{path} is not a STEP file but {what}")
    return content, []


def _narrow_text(path: Path, content: bytes, encoding: str) -> tuple[bytes, list[str]]:
    name = encoding.upper()[:6]
    try:
        text = content.decode(encoding).removeprefix("\ufeff")
    except UnicodeDecodeError as reason:
        raise InvalidInput(f"{path} begins in {name} and is no text at byte {reason.start}: {EXPORT}") from reason
    return text.encode(), [f"the file is written in {name}, which STEP does not allow: it was read all the same"]
