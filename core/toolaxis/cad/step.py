"""STEP files, read by a kernel in a process of its own so that a crash or a hang stays there; by FreeCAD inside it."""

import hashlib
import os
import pickle
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any

import toolaxis
from toolaxis.cad.assembling import part_from_record
from toolaxis.cad.records import ShapeRecord
from toolaxis.cad.steptext import StepText, read_text
from toolaxis.cad.units import unit_warnings
from toolaxis.errors import InvalidInput, MissingBackend, UnsupportedGeometry
from toolaxis.shape.part import Part

COMMAND = ("-m", "toolaxis.cad.transfer")


def read_step(path: str | PathLike[str], time_limit: float | None = None, accept_lost_faces: bool = False) -> Part:
    """Read a part from a STEP file.

    Parameters
    ----------
    path : path
    time_limit : float, optional
        s for the CAD kernel; a minute and another 20 s for each megabyte unless given.
    accept_lost_faces : bool
        Go on, with a warning, when faces of the file did not survive the transfer.

    Raises
    ------
    InvalidInput
        When the file is missing, empty, cut short, not STEP, holds numbers that are not finite, hangs or crashes
        the kernel, or lost faces.
    UnsupportedGeometry
        When none of its faces can be used.
    MissingBackend
        When no CAD kernel is installed.
    """
    file = Path(path)
    text = read_text(file)
    record, transferred = _transferred(file, text, time_limit)
    lost = _lost(file, text, transferred)
    if lost and not accept_lost_faces:
        raise InvalidInput(f"{lost}; repair it in the CAD system and export it again, or accept_lost_faces")
    record.warnings += [lost] if lost else _dangling(text)
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    part = part_from_record(record, str(file), digest)
    return part.with_warnings(*unit_warnings(part))


def _transferred(file: Path, text: StepText, time_limit: float | None) -> tuple[ShapeRecord, int]:
    """What the kernel makes of a file, and how many different faces came out."""
    if find_spec("OCP") is not None:
        return _in_child(file, text, 60.0 + 20.0 * len(text.content) / 1e6 if time_limit is None else time_limit)
    if "FreeCAD" not in sys.modules:
        raise MissingBackend("reading STEP files needs a CAD kernel: pip install 'toolaxis[cadquery]'")
    from toolaxis.cad.freecad_shapes import step_record

    try:
        return step_record(file, text)
    except (InvalidInput, UnsupportedGeometry) as reason:
        raise type(reason)(f"{file}: {reason}") from reason


def _in_child(file: Path, text: StepText, limit: float) -> tuple[ShapeRecord, int]:
    with tempfile.TemporaryDirectory(prefix="toolaxis-") as folder:
        source, target = file, Path(folder) / "outcome"
        if text.marked:
            source = Path(folder) / "without-mark.step"
            source.write_bytes(text.content)
        outcome = _outcome(_run([str(source.resolve()), str(target)], file, limit), target, file)
    if outcome[0] == "failed":
        raise outcome[1](f"{file}: {outcome[2]}")
    return outcome[1], outcome[2]


def _run(arguments: list[str], file: Path, limit: float) -> "subprocess.CompletedProcess[bytes]":
    root = str(Path(toolaxis.__file__).parents[1])
    paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "TOOLAXIS_NUMBA": "0"}
    command = [sys.executable, *COMMAND, *arguments]
    try:
        # In a session of its own: Ctrl-C in a terminal goes to every process of the group, and would look like a crash.
        return subprocess.run(command, env=environment, capture_output=True, timeout=limit, check=False,
                              stdin=subprocess.DEVNULL, start_new_session=True)
    except subprocess.TimeoutExpired as reason:
        raise InvalidInput(f"{file} kept the CAD kernel busy for more than {limit:.0f} s: repair the geometry, or "
                           "raise time_limit") from reason


def _outcome(child: "subprocess.CompletedProcess[bytes]", target: Path, file: Path) -> tuple[Any, ...]:
    if child.returncode == 0 and target.exists():
        outcome: tuple[Any, ...] = pickle.loads(target.read_bytes())
        return outcome
    last = child.stderr.decode(errors="replace").strip().splitlines()[-1:]
    why = f"signal {-child.returncode}" if child.returncode < 0 else (last[0] if last else f"exit {child.returncode}")
    raise InvalidInput(f"{file} crashed the CAD kernel ({why}): repair the geometry and export it again")


def _lost(file: Path, text: StepText, transferred: int) -> str:
    missing = len(text.faces) - transferred
    if missing <= 0:
        return ""
    cause = f" (its text refers to #{text.dangling[0]}, which is not defined)" if text.dangling else ""
    return f"{file} lost {missing} of its {len(text.faces)} faces in transfer{cause}"


def _dangling(text: StepText) -> list[str]:
    if not text.dangling:
        return []
    return [f"the file refers to #{text.dangling[0]}, which it does not define; no face was lost"]
