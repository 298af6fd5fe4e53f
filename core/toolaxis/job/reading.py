"""Cutter locations made elsewhere, from their file."""

import re
from pathlib import Path

from toolaxis.errors import InvalidInput
from toolaxis.post.apt_reading import read_apt
from toolaxis.post.locations import CutterLocations

#: What only APT files say.
_APT = re.compile(r"^\s*(GOTO|MULTAX|PARTNO|FINI|TOOL PATH|UNITS)\b", re.IGNORECASE | re.MULTILINE)


def read_cl(path: str | Path, *, axes: bool = True) -> CutterLocations:
    """Cutter locations from a file that any system wrote.

    Parameters
    ----------
    path : str or Path
        An APT CL file.
    axes : bool
        Whether the file must tell tool axes.

    Returns
    -------
    CutterLocations
        Tips and axes in the file's own coordinates; its `path` is a `ToolPath`.

    Raises
    ------
    InvalidInput
        When the file cannot be read, is cut short, or says something that is not understood, with the line.
    """
    text = _text(Path(path))
    if not _APT.search(text):
        raise InvalidInput(f"{path} is no APT CL file: it has no GOTO")
    found = read_apt(text)
    if axes and not found.told:
        raise InvalidInput(f"{path} tells no tool axes: no GOTO has i,j,k; write it with MULTAX/ON")
    return found


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError as reason:
        raise InvalidInput(f"{path} cannot be read: {reason.strerror}") from reason
