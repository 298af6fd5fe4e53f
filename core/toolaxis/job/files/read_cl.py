"""Cutter locations made elsewhere, from their file."""

import re
from pathlib import Path

from numpy.typing import ArrayLike

from toolaxis.cad.machines import load_machine
from toolaxis.errors import InvalidInput
from toolaxis.machine.machine import Machine
from toolaxis.post.cl_points import CutterLocations
from toolaxis.post.read_apt import read_apt
from toolaxis.post.read_nc import read_nc

#: What moves an axis in a program.
_NC = re.compile(r"(^|[\s\d])(G0?[01]\b|L[NP]?\s).*[XYZ]\s*=?[-+.\d]", re.IGNORECASE | re.MULTILINE)
#: What only APT files say.
_APT = re.compile(r"^\s*(GOTO|MULTAX|PARTNO|FINI|TOOL PATH|UNITS)\b", re.IGNORECASE | re.MULTILINE)


def read_cl(path: str | Path, machine: Machine | str | None = None, *, offset: ArrayLike | None = None,
            tool_length: float = 0.0, axes: bool = True) -> CutterLocations:
    """Cutter locations from a file that any system wrote: APT, or the NC program of a five-axis machine.

    Parameters
    ----------
    path : str or Path
        An APT CL file, or a program in G-code or Klartext.
    machine : Machine or str, optional
        The machine that a program is for, its name or its file; APT files need none.
    offset : (3,) or (4, 4) array_like, optional
        Where the part stands on that machine's table, all axes at zero; needed for programs without control of the tip
        (G43.4, TRAORI, M128).
    tool_length : float
        From the gauge point to the tip, mm; of matter for programs without control of the tip where the head turns.
    axes : bool
        Whether the file must tell tool axes.

    Returns
    -------
    CutterLocations
        Tips and axes in the file's own coordinates, those of a program from the origin of its work offset; its `path`
        is a `ToolPath`.

    Raises
    ------
    InvalidInput
        When the file cannot be read, is cut short, or says something that is not understood, with the line.
    """
    text = _text(Path(path))
    if _APT.search(text):
        found = read_apt(text)
        if axes and not found.told:
            raise InvalidInput(f"{path} tells no tool axes: no GOTO has i,j,k; write it with MULTAX/ON")
        return found
    if not _NC.search(text):
        raise InvalidInput(f"{path} is no APT CL file, for it has no GOTO, and no NC program, for it moves no axis")
    if machine is None:
        raise InvalidInput(f"{path} is an NC program: name the machine that it is for")
    known = load_machine(machine) if isinstance(machine, str) else machine
    if axes and len(known.rotary) < 1:
        raise InvalidInput(f"{path} tells no tool axes: {known.name} has no rotary axis")
    return read_nc(text, known, offset, tool_length)


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError as reason:
        raise InvalidInput(f"{path} cannot be read: {reason.strerror}") from reason
